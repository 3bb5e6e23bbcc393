"""The smooth parts of surfaces with sharp edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.surfaces.families.capped import Capped
from vectorplot.surfaces.placed import PlacedSurface
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.trimmed import TrimmedSurface


@dataclass(frozen=True, eq=False)
class SmoothPart:
    """A part of a surface that is smooth up to its borders; creases: the v at which another part follows behind a
    sharp edge; is_cap: whether it is a flat end, on which there are no parameter lines."""

    surface: Surface
    creases: tuple[float, ...] = ()
    is_cap: bool = False


def smooth_parts(surface: Surface) -> tuple[SmoothPart, ...]:
    """The smooth parts of a surface in the order of v: one, the surface itself, unless it has sharp edges."""
    if isinstance(surface, Capped):
        return tuple(SmoothPart(part, part.creases, part.part != "mantle") for part in surface.parts)
    if isinstance(surface, PlacedSurface):
        inner = smooth_parts(surface.surface)
        if len(inner) > 1:
            return tuple(
                SmoothPart(PlacedSurface(part.surface, surface.matrix, surface.shift), part.creases, part.is_cap)
                for part in inner
            )
    if isinstance(surface, TrimmedSurface):
        inner = smooth_parts(surface.surface)
        if len(inner) > 1:
            return tuple(found for part in inner if (found := _trimmed(part, surface)))
    return (SmoothPart(surface),)


def creases(surface: Surface) -> Floats:
    """(k,) the v, inside the domain, at which the parts of a surface meet."""
    found = {v for part in smooth_parts(surface) for v in part.creases}
    domain = surface.domain
    return np.array(sorted(v for v in found if domain.v_start < v < domain.v_end))


def _trimmed(part: SmoothPart, whole: TrimmedSurface) -> SmoothPart | None:
    """What is left of a part."""
    domain, own = whole.domain, part.surface.domain
    v = max(domain.v_start, own.v_start), min(domain.v_end, own.v_end)
    try:
        surface = TrimmedSurface(part.surface, whole.u, v)
    except InputError:
        return None
    return SmoothPart(surface, tuple(c for c in part.creases if domain.v_start < c < domain.v_end), part.is_cap)
