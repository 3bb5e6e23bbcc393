"""The rims of the holes of a surface as lines, and triangles in its domain cut along them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent, no_curves
from vectorplot.features.edge_splitting import divided
from vectorplot.features.holes import (
    around,
    beside_rim_chords,
    inside,
    into_surface,
    is_known,
    just_inside,
    last_alike,
    ways_between,
    wrapped,
)
from vectorplot.features.patches import cell_corners
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, bisected, refined, straight_between
from vectorplot.geometry.connectivity import concat, edges_of
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import all_components, any_component, cross
from vectorplot.surfaces.parameter_regions import ParameterRegions
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.trimmed import trims_of, uncut
from vectorplot.tolerances import CHORD_OF_EXTENT, PLACES_IN_CELLS, REPEATED_OF_DOMAIN

# Triangles in the domain of a surface divided where they meet holes, until one straight rim runs through each.

ROUNDS = 12
"""Times that triangles are divided: around a corner of a rim, or where two of them cross, they then are a four
thousandth as large."""

LOOKS = np.arange(1, 8) / 8
"""Parts of a side, or of a way along a rim, at which is looked for what is there."""

HALVINGS = 12
"""Steps to the places at which the rim leaves a triangle, to tell how straight it is."""

STRAIGHT = 1.0 / 8.0
"""Part of its length by which a rim may be off the way straight through a triangle."""


@dataclass(frozen=True, eq=False)
class Resolved:
    """Triangles (t,3) of places (n,2) in which holes begin along one nearly straight line, as far as that is found;
    known (n,): the places that are in none; of (t,): the triangle that each is, or is a part of."""

    places: Floats
    triangles: Ints
    known: Bools
    of: Ints


def resolved(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Resolved:
    """Triangles (t,3) of places (n,2), divided where a rim in them has a corner or crosses another one, and where a
    side leads over a hole from surface to surface; known (n,): places that are in no hole.

    Holes are looked for in triangles with a corner in one, and in those around them.
    Edge cases: sides that lead over a hole in the end, and their triangles, are left out.
    """
    near = _around(triangles, _mixed(triangles, known))
    pool = _around(triangles, near)
    rest, rest_of = triangles[~pool], np.flatnonzero(~pool)
    triangles, of, near = triangles[pool], np.flatnonzero(pool), near[pool]
    for number in range(ROUNDS + 1):
        edges, sides, _ = edges_of(triangles, len(places))
        asked = np.zeros(len(edges), dtype=np.bool_)
        asked[sides[near]] = True
        hole = _holes(surface, places, edges, asked & known[edges].all(axis=1))
        over = np.isfinite(hole[:, 0])
        if number == ROUNDS:
            kept = ~over[sides].any(axis=1)
            triangles, of = triangles[kept], of[kept]
            break
        crooked = np.flatnonzero(_mixed(triangles, known))
        crooked = crooked[~_is_straight(surface, places, triangles[crooked], known)]
        split = over.copy()
        split[sides[crooked]] = True
        if not split.any():
            break
        halved = np.flatnonzero(split & ~over)
        start = places[edges[halved, 0]]
        hole[halved] = start + 0.5 * ways_between(surface.domain, start, places[edges[halved, 1]])
        new = np.stack(wrapped(surface.domain, *hole[split].T), axis=1)
        middle = np.full(len(edges), -1)
        middle[split] = len(places) + np.arange(len(new))
        places, known = np.concatenate([places, new]), np.append(known, is_known(surface, new))
        # Which diagonal is shorter is told in parts of the domain: the units of u and of v have nothing in common.
        triangles, part_of = divided(triangles, middle[sides], places / surface.domain.size)
        of, near = of[part_of], near[part_of]
    return Resolved(places, np.concatenate([rest, triangles]), known, np.concatenate([rest_of, of]))


def _mixed(triangles: Ints, known: Bools) -> Bools:
    """(t,) the triangles with corners on the surface and in holes."""
    count = known[triangles].sum(axis=1)
    return np.asarray((count == 1) | (count == 2), dtype=np.bool_)


def _around(triangles: Ints, some: Bools) -> Bools:
    """(t,) the triangles that share a corner with some of them."""
    if not some.any():
        return some
    used = np.zeros(int(triangles.max()) + 1, dtype=np.bool_)
    used[triangles[some]] = True
    return np.asarray(any_component(used[triangles]))


def _holes(surface: Surface, places: Floats, edges: Ints, asked: Bools) -> Floats:
    """(e,2) places in holes on some sides between places on the surface; NaN where there are none."""
    found = np.full((len(edges), 2), np.nan)
    both = np.flatnonzero(asked)
    start = places[edges[both, 0]]
    tried = start + LOOKS[:, None, None] * ways_between(surface.domain, start, places[edges[both, 1]])
    inside = is_known(surface, tried)
    over = np.flatnonzero(~inside.all(axis=0))
    found[both[over]] = tried[np.argmin(inside[:, over], axis=0), over]
    return found


def _is_straight(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Bools:
    """(t,) whether all is surface on one side of one straight line, and all hole on the other, as far as is looked, in
    triangles (t,3) with corners in both."""
    if not len(triangles):
        return np.zeros(0, dtype=np.bool_)
    inside = known[triangles]
    odd = np.argmax(inside == (inside.sum(axis=1) == 1)[:, None], axis=1)
    corner, *others = np.take_along_axis(triangles, (odd[:, None] + np.arange(3)) % 3, axis=1).T
    size = np.array(surface.domain.size)
    base, alone = places[corner], known[corner]
    ways, ends = [ways_between(surface.domain, base, places[other]) for other in others], []
    at_corners = np.ones(len(base), dtype=np.bool_)
    for way in ways:

        def goes_on(which: Ints, part: Floats, way: Floats = way) -> Bools:
            return np.asarray(is_known(surface, base[which] + part[:, None] * way[which]) == alone[which])

        low, high = bisected(goes_on, np.zeros(len(base)), np.ones(len(base)), HALVINGS)
        ends.append(0.5 * (low + high)[:, None] * way / size)
        at_corners &= np.where(alone, low == 0.0, high == 1.0)
    chord = ends[1] - ends[0]
    along = ends[0] + LOOKS[:, None, None] * chord
    # The corner that differs lies to the right of the way, which turns as the triangle does.
    turn = np.sign(ends[0][:, 0] * ends[1][:, 1] - ends[0][:, 1] * ends[1][:, 0])[:, None]
    aside = STRAIGHT * turn * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    beyond, before = (is_known(surface, base + size * (along + way)) for way in (aside, -aside))
    straight = ((before == alone) & (beyond != alone)).all(axis=0)
    bare = np.flatnonzero(~straight & at_corners)
    straight[bare] = _is_bare(surface, base[bare], *(way[bare] for way in ways))
    return np.asarray(straight)


def _is_bare(surface: Surface, corner: Floats, one: Floats, two: Floats) -> Bools:
    """(t,) whether all is hole between the sides of triangles, as far as is looked; corner (t,2), one and two (t,2) the
    ways from it to the others. Where a surface is a line or a point and no more, triangles beside it would be divided
    for ever."""
    first, second = np.meshgrid(LOOKS, LOOKS)
    within = first + second < 1.0
    looks = corner + first[within][:, None, None] * one + second[within][:, None, None] * two
    return np.asarray(~is_known(surface, looks).any(axis=0))


# Triangles in the domain of a surface, cut along the rims of its holes.

RIM_HALVINGS = 30
"""Halvings of a side along a line with no surface beside it, until its first place without one is known."""


@dataclass(frozen=True, eq=False)
class CutTriangles:
    """Triangles (t,3) of places (n,2) in a domain, none of them with a corner in a hole; rims (r,2): the sides that lie
    along a rim, with the hole to their right; of (t,): the triangle that each is, or is a part of; on_rim (n,): the
    places at the ends of sides along rims."""

    places: Floats
    triangles: Ints
    rims: Ints
    of: Ints

    @property
    def on_rim(self) -> Bools:
        """(n,) the ends of sides along rims."""
        result = np.zeros(len(self.places), dtype=np.bool_)
        result[self.rims] = True
        return result


def cut_at_holes(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> CutTriangles:
    """Triangles (t,3) of places (n,2), those with some corners in holes cut along the rims; known (n,): places that are
    in none. They turn as before.

    A corner that lies on a rim to within 1e-9 of a side is taken for a place on it.
    Edge cases: lines and points without a surface on either side have no rim: they count as parts of the hole.
    """
    known = _with_surface(surface, places, triangles, known)
    finer = resolved(surface, places, triangles, known)
    places, triangles = finer.places, finer.triangles
    known = _with_surface(surface, places, triangles, finer.known)
    inside = known[triangles].sum(axis=1)
    whole, cut_up = np.flatnonzero(inside == 3), np.flatnonzero((inside == 1) | (inside == 2))
    if not len(cut_up):
        return CutTriangles(places, triangles[whole], np.zeros((0, 2), dtype=np.intp), finer.of[whole])
    mixed = triangles[cut_up]
    # Turned so that the last corner is the one that differs from the two others.
    count = known[mixed].sum(axis=1)
    odd = np.argmax(known[mixed] == (count == 1)[:, None], axis=1)
    a, b, c = np.take_along_axis(mixed, (odd[:, None] + 1 + np.arange(3)) % 3, axis=1).T
    new, end = _crossings(surface, places, known, np.concatenate([a, b]), np.concatenate([c, c]))
    on_a, on_b = np.split(end, 2)
    alone = count == 1
    # Beside the rim stands the triangle with the corner that is farther from it: a narrow one may reach over the hole.
    far = (_steps(places, new, a, on_a) > _steps(places, new, b, on_b))[~alone, None]
    one, two, three, four = (
        np.stack(some, axis=1)[~alone] for some in ((a, b, on_b), (b, on_b, on_a), (a, on_b, on_a), (a, b, on_a))
    )
    parts = [np.stack([c, on_a, on_b], axis=1)[alone], np.where(far, one, two), np.where(far, three, four)]
    every = np.concatenate([triangles[whole], *parts])
    of = np.concatenate([whole, cut_up[alone], cut_up[~alone], cut_up[~alone]])
    kept = all_components(every != np.roll(every, 1, axis=1))
    rims = np.where(alone[:, None], np.stack([on_a, on_b], axis=1), np.stack([on_b, on_a], axis=1))
    return CutTriangles(np.concatenate([places, new]), every[kept], _once(rims), finer.of[of[kept]])


def _with_surface(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Bools:
    """(n,) the known places but those beside holes around which nothing is known: x^y at whole y and x < 0."""
    mixed = triangles[any_component(known[triangles]) & ~all_components(known[triangles])]
    beside = np.unique(mixed[known[mixed]])
    result = known.copy()
    result[beside] = _has_surface(surface, places[beside])
    return result


def _has_surface(surface: Surface, places: Floats) -> Bools:
    """(k,) which places (k,2) have something known around them."""
    return np.asarray(is_known(surface, around(surface, places)).any(axis=0), dtype=np.bool_)


def _crossings(surface: Surface, places: Floats, known: Bools, one: Ints, two: Ints) -> tuple[Floats, Ints]:
    """The places (m,2) that are new, and the numbers (k,) of those at which sides between places one and two (k,), one
    of which is in a hole, leave the surface: of a place that there was, or of a new one."""
    pair, side = np.unique(np.stack([one, two], axis=1).min(axis=1) << 32 | np.maximum(one, two), return_inverse=True)
    low, high = pair >> 32, pair & 0xFFFFFFFF
    start, end = np.where(known[low], low, high), np.where(known[low], high, low)
    way = ways_between(surface.domain, places[start], places[end])
    part, _ = last_alike(surface, places[start], way, np.zeros(len(pair)), np.ones(len(pair)))
    # A side along a line with values and no surface beside them: all of it is known.
    line = np.flatnonzero(part >= 1.0 - REPEATED_OF_DOMAIN)

    def has_surface(which: Ints, at: Floats) -> Bools:
        return _has_surface(surface, places[start[line[which]]] + at[:, None] * way[line[which]])

    inner, _ = bisected(has_surface, np.zeros(len(line)), np.ones(len(line)), RIM_HALVINGS)
    part[line] = np.where(_has_surface(surface, places[end[line]]), part[line], inner)
    # Sides that end in one place have one crossing where the rim runs through it.
    number = len(places) + np.arange(len(pair))
    through = part >= 1.0 - REPEATED_OF_DOMAIN
    first = np.full(len(places), -1)
    first[end[through][::-1]] = number[through][::-1]
    number = np.where(part <= REPEATED_OF_DOMAIN, start, np.where(through, first[end], number))
    found = places[start] + part[:, None] * way
    return just_inside(surface, found, into_surface(surface, found)), number[side]


def _steps(places: Floats, new: Floats, start: Ints, end: Ints) -> Floats:
    """(k,) how far it is from places (n,2), numbered start (k,), to these, or new ones (m,2), numbered end."""
    every = np.concatenate([places, new])
    return np.asarray(np.hypot(*(every[end] - every[start]).T))


def _once(rims: Ints) -> Ints:
    """The sides (r,2) that are more than a point, and not there the other way round too."""
    rims = rims[rims[:, 0] != rims[:, 1]]
    key = rims.min(axis=1) << 32 | rims.max(axis=1)
    _, where, uses = np.unique(key, return_inverse=True, return_counts=True)
    return np.asarray(rims[uses[where] == 1])


# Triangles in the domain of a surface, cut along the curves that trim it.

TRIMS_STRAIGHT = 1.0 / 512.0
"""Part of a cell by which sides of triangles may be off the curves between their ends."""


def cut_at_trims(region: ParameterRegions, u: Floats, v: Floats) -> CutTriangles:
    """The triangles of the cells of a grid of parameters u (m,) and v (n,), those that trims cross cut along them; of:
    the cell of each. The corners of the grid are the first m n places; ends of sides along trims lie on these."""
    import shapely

    a, b, c, d = cell_corners(len(u) - 1, len(v) - 1)
    places = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    crossed = region.borders_within(places[a], places[c])
    middle = 0.5 * (places[a] + places[c])
    whole = np.flatnonzero(~crossed & region.contains(middle[:, 0], middle[:, 1]))
    triangles = [np.stack([a, b, c], axis=1)[whole], np.stack([a, c, d], axis=1)[whole]]
    cut_up = np.flatnonzero(crossed)
    low, size = np.array([u[0], v[0]]), np.array([u[-1] - u[0], v[-1] - v[0]])
    scaled = np.round((places - low) / size / PLACES_IN_CELLS)
    cells = shapely.box(*(scaled[a[cut_up]] * PLACES_IN_CELLS).T, *(scaled[c[cut_up]] * PLACES_IN_CELLS).T)
    straight = TRIMS_STRAIGHT / max(len(u) - 1, len(v) - 1)
    parts = shapely.intersection(cells, region.polygons(straight), grid_size=PLACES_IN_CELLS)
    parts, own = shapely.get_parts(parts, return_index=True)
    areas = np.flatnonzero(shapely.get_dimensions(parts) == 2)
    pieces, part = shapely.get_parts(shapely.constrained_delaunay_triangles(parts[areas]), return_index=True)
    own = own[areas[part]]
    corners = shapely.get_coordinates(shapely.get_exterior_ring(pieces)).reshape(-1, 4, 2)[:, :3]
    turns = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners, own = np.where((turns < 0.0)[:, None, None], corners[:, ::-1], corners)[turns != 0.0], own[turns != 0.0]
    # Which of the corners are those of the grid, if they are left, and which are new.
    every = np.concatenate([scaled, np.round(corners / PLACES_IN_CELLS).reshape(-1, 2)])
    every = np.where(region.closed[0], every % (1.0 / PLACES_IN_CELLS), every)
    first, number = np.unique(every, axis=0, return_index=True, return_inverse=True)[1:]
    index = first[number.ravel()[len(places) :]]
    old = index < len(places)
    old[old] = region.contains(*places[index[old]].T)
    fresh, where = np.unique(index[~old], return_inverse=True)
    new = region.onto_borders(every[fresh] * PLACES_IN_CELLS * size + low)
    index[~old] = len(places) + where
    triangles.append(index.reshape(-1, 3))
    found, of = np.concatenate(triangles), np.concatenate([whole, whole, cut_up[own]])
    kept = all_components(found != np.roll(found, 1, axis=1))
    on_rim = len(places) + np.arange(len(new))
    rims = np.stack([on_rim, on_rim], axis=1)
    return CutTriangles(np.concatenate([places, new]), found[kept], rims, of[kept])


# The rims of the holes of a surface: lines inside its domain at which it ends.

FINER = 2
"""Times as many columns and rows as other curves are traced on: a hole that no point of them is in may be missed."""


def grid_triangles(columns: int, rows: int) -> Ints:
    """(2 columns rows,3) the corners, among the (columns+1) (rows+1) points of a grid, of the lower and then the upper
    triangles of its cells."""
    a, b, c, d = cell_corners(columns, rows)
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def hole_rims(surface: Surface, tracing: Tracing) -> SurfaceCurves:
    """The lines inside the domain at which a surface ends, because its points are not finite beyond: the rims of its
    holes, and of what is cut off where it runs to infinity; the hole is to their right.

    Edge cases: rims that run over a seam are cut there; holes smaller than half a cell of the grid may be missed. Of a
    surface that is trimmed by curves and not cut otherwise they are these, however small; see `trim_borders`.
    """
    domain, region = surface.domain, trims_of(surface)
    if region is not None:
        return trim_borders(surface, region, tracing)
    columns, rows = FINER * tracing.columns, FINER * tracing.rows
    places = np.stack(np.meshgrid(*domain.grid(columns, rows), indexing="ij"), axis=-1).reshape(-1, 2)
    known = is_known(surface, places)
    if known.all() or not known.any():
        return no_curves()
    cut = cut_at_holes(surface, places, grid_triangles(columns, rows), known)
    if not len(cut.rims):
        return no_curves()
    branches = concat(cut.rims)
    lines = Traces.of(cut.places[branches.points], closed_round(branches))
    size = extent(surface)[0]
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance

    def image(places: Floats) -> Floats:
        points = surface.points(*wrapped(domain, *places.T))
        return points if tracing.picture is None else tracing.picture(points)

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return beside_rim_chords(surface, start, end, part)

    # Without a tolerance nothing is cut.
    finer = refined(lines, between, image, tolerance or np.inf, tracing.budget.points)
    kept, offsets = finer.lines.unrepeated(branches.closed)
    u, v = np.ascontiguousarray(finer.lines.points[kept].T)
    enough = bool(finer.enough.all())
    return replace(
        no_curves() if enough else no_curves((unresolved("rims of holes are off by more than the tolerance"),)),
        u=u,
        v=v,
        points=surface.points(*wrapped(domain, u, v)),
        offsets=offsets,
        closed=branches.closed,
        turns=np.zeros((len(branches), 2), dtype=np.intp),
        levels=np.zeros(len(branches)),
    )


# The curves that trim a surface, as lines.

FIRST_CHORDS = 16
"""So many chords of a border are looked at first, besides those that corners make."""


def trim_borders(surface: Surface, region: ParameterRegions, tracing: Tracing) -> SurfaceCurves:
    """The borders that curves in u and v make of a surface, every point on them; what is left of it is not trimmed
    otherwise, see trims_of. Their directions are the numbers of places as `RegionBorders` has them, and NaN."""
    borders, domain = region.borders, surface.domain
    if not len(borders.closed):
        return no_curves()
    size = np.diff(borders.offsets)
    place = ragged.place(size)
    step = np.maximum(size // FIRST_CHORDS, 1)[ragged.owner(size)]
    first = np.flatnonzero(borders.corners | (place % step == 0))
    # Each border once more at its end. A row is where its chord begins, and how far along it is from there.
    owner = ragged.owner(size)[first]
    behind = np.flatnonzero(np.append(owner[1:] != owner[:-1], True)) + 1
    rows = np.insert(first, behind, borders.offsets[1:]).astype(np.float64)
    last = np.zeros(len(rows), dtype=np.bool_)
    last[np.cumsum(np.bincount(owner) + 1) - 1] = True
    begin = np.repeat(borders.offsets[:-1], np.bincount(owner) + 1).astype(np.float64)
    whole = uncut(surface)
    extent_, most = extent(whole)[0], tracing.budget.points
    tolerance = CHORD_OF_EXTENT * extent_ if tracing.tolerance is None else tracing.tolerance

    def points_of(rows: Floats) -> Floats:
        return whole.points(*inside(domain, borders.at(rows[:, 0], rows[:, 1] - rows[:, 0])[0]))

    def image(rows: Floats) -> Floats:
        points = points_of(rows)
        return points if tracing.picture is None else tracing.picture(points)

    lines = Traces(np.stack([begin, rows], axis=1), last)
    finer = refined(lines, straight_between, image, tolerance or np.inf, most)
    kept, offsets = finer.lines.unrepeated(borders.closed)
    rows = finer.lines.points[kept]
    places = borders.at(rows[:, 0], rows[:, 1] - rows[:, 0])[0]
    enough = bool(finer.enough.all())
    return replace(
        no_curves() if enough else no_curves((unresolved("trims are off by more than the tolerance"),)),
        u=np.ascontiguousarray(places[:, 0]),
        v=np.ascontiguousarray(places[:, 1]),
        points=points_of(rows),
        directions=np.stack([rows[:, 1], np.full(len(rows), np.nan)], axis=1),
        offsets=offsets,
        closed=borders.closed,
        turns=np.where(borders.closed[:, None], borders.turns, 0),
        levels=np.zeros(len(borders.closed)),
    )
