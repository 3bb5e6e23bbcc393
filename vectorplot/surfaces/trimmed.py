"""Parts of parametrised surfaces: trimmed, cut by planes, smooth between creases; and which are embedded."""

from __future__ import annotations

from collections.abc import Sequence
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
from vectorplot.surfaces.parameter_regions import (
    MOST_LOOPS,
    Loop,
    ParameterRegions,
    bounds_of_loops,
    check_apart,
    led_back,
    loop_pieces,
    near_middle,
    parameter_region,
)
from vectorplot.surfaces.placed_surface import MovableSurface, PlacedSurface, placed_once
from vectorplot.surfaces.surface import Domain, OverDomain, Surface
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT

# Parts of parametrised surfaces.

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class TrimmedSurface(MovableSurface):
    """The part of a parametrised surface over smaller ranges of u and v, or within closed curves in u and v.

    Parameters
    ----------
    surface : Surface
        What is trimmed.
    u, v : (float, float), optional
        Start and end of the parameters; the whole range where None.
    trims : sequence of curves, optional
        Closed curves in u and v: what is within them is left; all, where there are none. Each is the corners (n, 2) of
        a polygon, or a curve of the room curves in the plane z = 0, x for u and y for v, which may have corners.
    holes : sequence of curves, optional
        Closed curves like these: what is within them is gone. A curve within a hole bounds what is left again.

    Raises
    ------
    InputError
        For empty ranges, and for ranges that leave the domain or are more than one round; for curves that do not close,
        are not finite, cross or touch others or themselves; where trims leave nothing.

    Notes
    -----
    Where the surface is closed a range may run over the seam; if it is as long as the whole one the part is closed too.
    There curves may run over the seam, too, and a curve may run round once and end a whole round from where it begins:
    what is to its left is within it. Parts of curves beyond the domain do not count.

    A place on a curve belongs to the surface. Curves are made of cubic pieces, off by 1e-8 of their size at most;
    polygons are exact. The domain is a little larger than what is within the trims.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> dome = surfaces.TrimmedSurface(surfaces.Sphere(), v=(0.0, np.pi / 2))
    >>> dome.domain.v_start, dome.domain.closed_u
    (0.0, True)
    >>> window = surfaces.TrimmedSurface(surfaces.Sphere(), holes=[curves.Circle((1.0, 0.5, 0.0), 0.25)])
    >>> bool(np.isnan(window.points(1.0, 0.5)).all()), bool(np.isfinite(window.points(1.0, 0.9)).all())
    (True, True)
    """

    surface: Surface
    u: Range | None = None
    v: Range | None = None
    trims: Sequence[Loop] = ()
    holes: Sequence[Loop] = ()

    def __post_init__(self) -> None:
        from vectorplot.surfaces.function_surface import with_derivatives

        object.__setattr__(self, "surface", with_derivatives(self.surface))
        for name in ("trims", "holes"):
            loops = tuple(getattr(self, name))
            if len(loops) > MOST_LOOPS:
                raise InputError(f"{len(loops)} {name}: expected at most {MOST_LOOPS}")
            object.__setattr__(self, name, loops)
        # Asked once, so that ranges and curves that do not fit are an error here and now.
        _ = self.domain
        if self.region is not None and not self.region.leaves_anything:
            raise InputError("trims and holes leave nothing of the surface")

    @cached_property
    def _ranges(self) -> Domain:
        """The part of the domain over the ranges, whatever the curves."""
        d = self.surface.domain
        u_start, u_end, closed_u = _part("u", self.u, d.u_start, d.u_end, d.closed_u)
        v_start, v_end, closed_v = _part("v", self.v, d.v_start, d.v_end, d.closed_v)
        return Domain(u_start, u_end, v_start, v_end, closed_u=closed_u, closed_v=closed_v)

    @cached_property
    def _loops(self) -> list[Floats]:
        """The closed cubic pieces of trims, and then those of holes."""
        names = [
            f"{what} {number}" for what, some in (("trim", self.trims), ("hole", self.holes)) for number in _up(some)
        ]
        pieces = [loop_pieces(*of) for of in zip(names, (*self.trims, *self.holes), strict=True)]
        pieces = [near_middle(one, self._ranges, self.surface.domain) for one in pieces]
        if pieces:
            check_apart(pieces, self.surface.domain)
        return [led_back(*of, self._ranges) for of in zip(names, pieces, strict=True)]

    @cached_property
    def domain(self) -> Domain:
        """The smaller rectangle."""
        return _around(self._ranges, self._loops[: len(self.trims)]) if self.trims else self._ranges

    @cached_property
    def region(self) -> ParameterRegions | None:
        """What trims and holes leave of the domain; None where there are none."""
        if not self._loops:
            return None
        # A smaller domain may lie over a seam.
        loops = [near_middle(loop, self.domain, self.surface.domain) for loop in self._loops[len(self.trims) :]]
        return parameter_region(self.domain, [*self._loops[: len(self.trims)], *loops], filled=not self.trims)

    @property
    def whole(self) -> TrimmedSurface:
        """The same over the whole of its domain, without trims and holes."""
        d = self.domain
        u = self.u if d.closed_u else (d.u_start, d.u_end)
        v = self.v if d.closed_v else (d.v_start, d.v_end)
        return TrimmedSurface(self.surface, u, v)

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points; NaN beyond trims and in holes."""
        points = self.surface.points(u, v)
        if self.region is None:
            return points
        return np.where(self.region.contains(u, v)[..., None], points, np.nan)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)


AROUND_TRIMS = 1.0 / 32.0
"""Part of what trims measure by which the domain goes on beyond them, where the surface does: so ends of the domain are
no tangents of curves."""


def _up(some: Sequence[Loop]) -> range:
    return range(1, len(some) + 1)


def _around(domain: Domain, trims: Sequence[Floats]) -> Domain:
    """The part of a domain around curves."""
    low, high = bounds_of_loops(trims)
    margin = AROUND_TRIMS * (high - low)
    ends: list[tuple[float, float, bool]] = []
    for own, start, end, closed in zip(
        np.array([low - margin, high + margin]).T.tolist(),
        (domain.u_start, domain.v_start),
        (domain.u_end, domain.v_end),
        (domain.closed_u, domain.closed_v),
        strict=True,
    ):
        first, last = own if closed else (max(own[0], start), min(own[1], end))
        # Curves that measure a round leave it closed; of those beyond the domain is told later that they leave nothing.
        ends.append((first, last, False) if 0.0 < last - first < end - start else (start, end, closed))
    (u_start, u_end, closed_u), (v_start, v_end, closed_v) = ends
    return Domain(u_start, u_end, v_start, v_end, closed_u=closed_u, closed_v=closed_v)


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

    @property
    def place(self) -> Floats:
        """(3,) where the surface stands that is cut."""
        return np.asarray(self._placed.shift)

    def about_origin(self) -> CutSurface:
        """The same, moved with its cuts so that the surface stands in the origin: see Centred."""
        back = np.eye(4)
        back[:3, 3] = -self.place
        within = None if self.within is None else self.within.transformed(back)
        surface = replace(self._placed, shift=np.zeros(3))
        return CutSurface(surface, tuple(region.transformed(back) for region in self.regions), within)

    @cached_property
    def _placed(self) -> PlacedSurface:
        """What is cut, in a single placement."""
        return placed_once(self.surface, np.eye(3), np.zeros(3), np.zeros(3))

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
    """The whole surface over the same domain, of one that planes have cut or curves have trimmed, wherever it was moved
    since."""
    if isinstance(surface, CutSurface):
        return uncut(surface.surface)
    if isinstance(surface, TrimmedSurface) and surface.region is not None:
        return uncut(surface.whole)
    if isinstance(surface, PlacedSurface | TrimmedSurface | InvertedSurface | OverDomain):
        whole = uncut(surface.surface)
        return surface if whole is surface.surface else replace(surface, surface=whole)
    return surface


def cuts_of(surface: Surface) -> list[CutSurface | TrimmedSurface]:
    """The cuts through a surface by planes, and its trims by curves, the last ones first, each of the whole surface as
    it was then."""
    found: list[CutSurface | TrimmedSurface] = []
    while isinstance(surface, PlacedSurface | TrimmedSurface | InvertedSurface | OverDomain | CutSurface):
        if isinstance(surface, CutSurface):
            found.append(replace(surface, surface=uncut(surface)))
        elif isinstance(surface, TrimmedSurface) and surface.region is not None:
            found.append(surface)
        surface = surface.surface
    return found


def trims_of(surface: Surface) -> ParameterRegions | None:
    """What curves leave of the domain of a surface, if it is trimmed by them once and cut by nothing else."""
    cuts = cuts_of(surface)
    if len(cuts) == 1 and isinstance(cuts[0], TrimmedSurface) and cuts[0].domain == surface.domain:
        return cuts[0].region
    return None


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
        surface = TrimmedSurface(part.surface, whole.u, v, whole.trims, whole.holes)
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
