"""Parts of parametrised surfaces: trimmed, cut by planes, smooth between creases; and which are embedded."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import parameter_range
from vectorplot.errors import InputError
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces.capped_bodies import Capped
from vectorplot.surfaces.graphs import is_graph
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import MovableSurface, PlacedSurface
from vectorplot.surfaces.surface import Domain, OverDomain, Surface
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT

# Parts of parametrised surfaces.

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class TrimmedSurface(MovableSurface):
    """The part of a parametrised surface over smaller ranges of u and v.

    Parameters
    ----------
    surface : Surface
        What is trimmed.
    u, v : (float, float), optional
        Start and end of the parameters; the whole range where None.

    Raises
    ------
    InputError
        For empty ranges, and for ranges that leave the domain or are more than one round.

    Notes
    -----
    Where the surface is closed a range may run over the seam; if it is as long as the whole one the part is closed too.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> dome = surfaces.TrimmedSurface(surfaces.Sphere(), v=(0.0, np.pi / 2))
    >>> dome.domain.v_start, dome.domain.closed_u
    (0.0, True)
    """

    surface: Surface
    u: Range | None = None
    v: Range | None = None

    def __post_init__(self) -> None:
        from vectorplot.surfaces.function_surface import with_derivatives

        object.__setattr__(self, "surface", with_derivatives(self.surface))
        # Asked once, so that a range that does not fit is an error here and now.
        _ = self.domain

    @cached_property
    def domain(self) -> Domain:
        """The smaller rectangle."""
        d = self.surface.domain
        u_start, u_end, closed_u = _part("u", self.u, d.u_start, d.u_end, d.closed_u)
        v_start, v_end, closed_v = _part("v", self.v, d.v_start, d.v_end, d.closed_v)
        return Domain(u_start, u_end, v_start, v_end, closed_u=closed_u, closed_v=closed_v)

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.surface.points(u, v)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)


def _part(name: str, wanted: Range | None, start: float, end: float, closed: bool) -> tuple[float, float, bool]:
    """Start and end of a part of a range, and whether it is closed."""
    if wanted is None:
        return start, end, closed
    low, high = parameter_range(name, *wanted)
    slack = ROUNDING * (end - start)
    if closed:
        if high - low > end - start + slack:
            raise InputError(f"{name} from {low:g} to {high:g} is more than one round of {end - start:g}")
        return low, high, high - low >= end - start - slack
    if low < start - slack or high > end + slack:
        raise InputError(f"{name} from {low:g} to {high:g} leaves the range from {start:g} to {end:g}")
    return max(low, start), min(high, end), False


# Parametrised surfaces of which parts are cut away by planes.


@dataclass(frozen=True, eq=False)
class CutSurface(MovableSurface):
    """What is left of a parametrised surface outside of some regions, or inside of one.

    surface: what is cut; regions: where nothing of it is left; within: and where all is that is left.
    """

    surface: Surface
    regions: tuple[HalfSpaces, ...]
    within: HalfSpaces | None = None

    @cached_property
    def domain(self) -> Domain:
        """That of the surface."""
        return self.surface.domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points; NaN where the surface is cut away."""
        points = np.asarray(self.surface.points(u, v), dtype=np.float64)
        gone = np.zeros(points.shape[:-1], dtype=np.bool_)
        with np.errstate(invalid="ignore"):
            for region in self.regions:
                gone |= region.is_inside(points)
            if self.within is not None:
                gone |= (self.within.heights(points) < 0.0).any(axis=0)
        return np.where(gone[..., None], np.nan, points)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)


def uncut(surface: Surface) -> Surface:
    """The whole surface with the same parameters, of one that planes have cut, wherever it was moved since."""
    if isinstance(surface, CutSurface):
        return uncut(surface.surface)
    if isinstance(surface, PlacedSurface | TrimmedSurface | InvertedSurface | OverDomain):
        whole = uncut(surface.surface)
        return surface if whole is surface.surface else replace(surface, surface=whole)
    return surface


def cuts_of(surface: Surface) -> list[CutSurface]:
    """The cuts through a surface, the last one first, each through the whole surface as it was then."""
    found: list[CutSurface] = []
    while isinstance(surface, PlacedSurface | TrimmedSurface | InvertedSurface | OverDomain | CutSurface):
        if isinstance(surface, CutSurface):
            found.append(replace(surface, surface=uncut(surface)))
        surface = surface.surface
    return found


# Whether a surface is known to be embedded: it meets itself nowhere, and has a tangent plane everywhere.


def is_embedded(shape: object) -> bool:
    """Whether a parametrised surface is known never to meet itself, and to have a tangent plane everywhere but in poles
    at its border: a graph, one whose family says so (its attribute `embedded`), or such a one that was moved, turned,
    scaled, inverted, trimmed or cut.

    Of others nothing is known: they may.
    """
    if isinstance(shape, PlacedSurface | TrimmedSurface | CutSurface | InvertedSurface):
        return is_embedded(shape.surface)
    return bool(getattr(shape, "embedded", False)) or is_graph(shape)


# Parts of surfaces: the smooth ones between sharp edges, and one that covers all of the surface once.

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
    what a circle swept several times does. Compared with itself a full turn, a half, a third, ... of the domain on.
    Edge cases: a surface that comes back mirrored (Möbius strip), or repeats otherwise, stays.
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
