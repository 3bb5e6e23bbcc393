"""Parts of surfaces: the smooth ones between sharp edges, and one that covers all of the surface once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.surfaces.embedded import is_embedded
from vectorplot.surfaces.families.capped import Capped
from vectorplot.surfaces.over_domain import OverDomain
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.trims.cut_surface import CutSurface
from vectorplot.surfaces.trims.trimmed import TrimmedSurface
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

MOST_ROUNDS = 16
"""Rounds that a surface is seen to run in one direction, at most."""

FEW, MANY = 8, 512
"""Places at which a round is compared with the next one: at first, and where it agrees there."""

SCATTERED = (0.7548776662466927, 0.5698402910980532)
"""Powers of the root of x^3 = x + 1, inverted: their multiples lie scattered over the unit square."""


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
    if isinstance(surface, CutSurface):
        inner = smooth_parts(surface.surface)
        if len(inner) > 1:
            return tuple(replace(part, surface=replace(surface, surface=part.surface)) for part in inner)
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


def covered_once(surface: Surface) -> Surface:
    """The surface over a part of its domain that covers it once, closed: itself, unless it runs along itself again, as
    what a circle sweeps does that is run through four times.

    In each direction it is compared with itself a full turn on, and a half, a third, ... of the domain on.
    Degenerate: a surface that comes back mirrored, as a Möbius strip does, stays as it is, and so does one that repeats
    itself after another way.
    """
    if is_embedded(surface):
        return surface
    domain = surface.domain
    u, v = (_round(surface, axis) for axis in (0, 1))
    if u:
        domain = replace(domain, u_end=domain.u_start + u, closed_u=True)
    if v:
        domain = replace(domain, v_end=domain.v_start + v, closed_v=True)
    return OverDomain(surface, domain) if u or v else surface


def _round(surface: Surface, axis: int) -> float:
    """The shortest way along u (0) or v (1) after which the surface repeats itself, shorter than its domain; 0 where
    there is none."""
    size = surface.domain.size[axis]
    ways = size / np.arange(MOST_ROUNDS, 1, -1)
    if 2.0 * np.pi < size:
        ways = np.sort(np.append(ways, 2.0 * np.pi))
    alike = ways[_repeats(surface, axis, ways, FEW)]
    return next((way for way in alike.tolist() if _repeats(surface, axis, np.array([way]), MANY).all()), 0.0)


def _repeats(surface: Surface, axis: int, ways: Floats, count: int) -> Bools:
    """(k,) whether the surface has the same points at so many places and these ways (k,) further on."""
    domain = surface.domain
    share = np.arange(1, count + 1)[:, None] * SCATTERED % 1.0
    room = np.tile(np.array(domain.size, dtype=np.float64), (len(ways), 1, 1))
    room[:, 0, axis] -= ways
    places = np.array([domain.u_start, domain.v_start]) + share * room
    further = places.copy()
    further[..., axis] += ways[:, None]
    both = np.stack([places, further])
    with np.errstate(all="ignore"):
        one, two = np.asarray(surface.points(both[..., 0], both[..., 1]), dtype=np.float64)
    known = np.isfinite(one).all(axis=-1)
    extent = np.ptp(one[known], axis=0).max() if known.any() else 0.0
    same = (np.abs(one - two) <= ZERO_OF_EXTENT * extent).all(axis=-1) | ~(known | np.isfinite(two).all(axis=-1))
    return np.asarray(same.all(axis=1) & known.any(axis=1) & (extent > 0.0))
