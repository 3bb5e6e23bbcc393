"""Curves f(u, v) = 0 on a rectangle, traced whole: branches, double points, holes, and what could not be decided."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import triangulate_surface
from vectorplot.features.scalar_fields import (
    Function,
    Functions,
    Gradient,
    Gradients,
    Positions,
    ScalarFields,
    default_sizes,
    grid_points,
    in_units,
    moved,
    number,
    of_lines,
    refined_on_curve,
    scalar_fields,
    sizes_of_zeros,
    units_of_values,
    up_to_holes,
    without_poles,
    without_repeats,
)
from vectorplot.features.zero_cells import (
    Cells,
    Lattice,
    Segments,
    Subdivision,
    beside,
    crossing_segments,
    flat_cells,
    near_cells,
    subdivided,
    triangles_near,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import symmetric_eigen
from vectorplot.geometry.budget import USUAL, Budget, unresolved
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import DOUBTS, EACH_LINE, EACH_POINT, closed_round
from vectorplot.geometry.records import APART
from vectorplot.geometry.vectors import all_components, all_finite, component_sum
from vectorplot.geometry.weld import close_points
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import (
    ABOVE_WHOLE,
    FLAT_NODE,
    GRID_NOISE,
    NODE_OF_VALUES,
    NODE_SETTLED_OF_CELL,
    ON_BORDER_OF_DOMAIN,
    RESOLUTION,
    ROUNDING_OF_DOMAIN,
    STEEP_DIRECTION,
)

# Areas in which a curve f(u, v) = 0 turns more often than the smallest cells can tell: nothing of it is kept there.

REACH = 3
"""A tangle has no square smaller than this many cells to each side of one: about a double point of a curve, or along a
line that it touches, fewer stay odd."""


def without_unresolved(subdivision: Subdivision, traced: Segments) -> tuple[Subdivision, Segments, Floats]:
    """The subdivision without the ambiguous cells of unresolved regions, the segments without those inside them, and
    (s,) the part of each domain that these cover.

    A tangle is the opening of the odd cells of the last level by a square. Across seams it does not go on.
    Source: Serra, Image Analysis and Mathematical Morphology, 1982, chapter II (opening).
    """
    lattice, odd = subdivision.lattice, subdivision.odd
    columns, rows = lattice.columns << lattice.levels, lattice.rows << lattice.levels
    # A margin of cells on all sides: no run of cells goes over into the next column, or into another domain.
    m, n = columns + 2 * REACH, rows + 2 * REACH
    tall = len(lattice.field) * m
    core = _eroded(np.unique((odd.of * m + odd.i + REACH) * n + odd.j + REACH))
    core = _turned(_eroded(_turned(core, n, tall)), tall, n)
    if not len(core):
        return subdivision, traced, np.zeros(len(lattice.field))
    column, j = np.divmod(_turned(_dilated(_turned(_dilated(core), n, tall)), tall, n), n)
    cells = Cells(column // m, column % m - REACH, j - REACH)
    tangle = lattice.keys(cells, lattice.levels)
    kept = ~np.isin(lattice.keys(odd, lattice.levels), tangle)
    middle = traced.points[traced.pairs].mean(axis=1)
    of = number(middle)
    part: Floats = (middle[:, :2] - lattice.field.start[of]) / lattice.field.size[of]
    at = np.clip((part * (columns, rows)).astype(np.intp), 0, (columns - 1, rows - 1))
    inside = np.isin(lattice.keys(Cells(of, at[:, 0], at[:, 1]), lattice.levels), tangle)
    covered = np.bincount(cells.of, minlength=len(lattice.field)) / (columns * rows)
    return replace(subdivision, odd=odd.take(kept)), replace(traced, pairs=traced.pairs[~inside]), covered


def _eroded(keys: Ints) -> Ints:
    """Those of ascending numbers (k,) whose neighbours up to REACH are all there."""
    width = 2 * REACH
    return keys[REACH:-REACH][keys[width:] - keys[:-width] == width] if len(keys) > width else keys[:0]


def _dilated(keys: Ints) -> Ints:
    """The numbers (k,) and their neighbours up to REACH, ascending."""
    return np.unique(keys[:, None] + np.arange(-REACH, REACH + 1))


def _turned(keys: Ints, rows: int, columns: int) -> Ints:
    """The numbers i rows + j of cells as j columns + i, ascending."""
    i, j = np.divmod(keys, rows)
    return np.sort(j * columns + i)


# What could not be decided of curves f = 0, in words.

JUMPS = "f changes its sign without being zero"
"""How the doubt about poles and jumps of f begins."""

ALONG_A_LINE = "f touches zero along a line without changing its sign"
"""How the doubt about places where branches should be begins."""

EVERYWHERE = "f is zero all over its domain, which is no curve"
"""The doubt about f that is nothing but zero."""


def doubts_of_one(
    flat: int, cells: int, found: Sequence[int], complete: bool, unsure: int, enough: bool, left_out: float
) -> tuple[str, ...]:
    """What could not be decided of one function, a sentence each; flat: cells, of so many, in which it is
    zero; found: a row of the counts of what was found."""
    poles, missed, spurious, touching = found
    line = touching - spurious
    texts = [
        (flat == cells, EVERYWHERE),
        (0 < flat < cells, f"f is zero all over {flat} cells: only the border towards negative values is a curve"),
        (poles > 0, f"{JUMPS} at {poles} places: poles or jumps, not part of the curve"),
        (
            left_out > 0.0,
            f"curves that wind more finely than the resolution are left out in {100.0 * left_out:.1g} % of the domain",
        ),
        (not complete, unresolved("branches of a curve are too small or too many")),
        (not enough, unresolved("curves are off by more than the tolerance")),
        (unsure > 0, f"{unsure} chords may be off by more than the tolerance: the curve was not found beside them"),
        (missed > 0, "closed branches smaller than the resolution are missing: ask for a finer one"),
        (
            spurious > 0,
            "branches nearer to each other than the resolution are given as points of them; ask for a finer one",
        ),
        (line > 0, f"{ALONG_A_LINE}: points of it are given, no curve"),
    ]
    return tuple(text for said, text in texts if said)


# Where a curve f(u, v) = 0 crosses itself, touches itself or is a point: f and its gradient are both zero.

NODE_RADIUS = 2.0
"""Smallest cells around a node in which its branches are replaced by straight pieces to the node."""

WIDEST = 12.0
"""Smallest cells that the radius of a node grows to where its branches enclose a small angle: between them, nearer to
the node, there are too few lattice points to tell them apart."""

BENT = 0.1
"""Part of the curvature at the start of a search below which that at its end shows a node of more than two branches."""

MOST_ALONE = 16
"""More flat double points of one function than this are a line of them."""


MANY_IN_STRIPS = 8
"""So many points in each strip along one direction, and it is seen whether there are fewer along the other."""


@dataclass(frozen=True, eq=False)
class DoublePoints:
    """points (k,3) where f and its gradient vanish; flat (k,): f has no curvature in some direction there, as along a
    line where f touches zero, or in a cusp. radii (k,): smallest cells within which branches are not told apart.
    ovals (o,3): middles of closed branches smaller than a cell."""

    points: Floats
    flat: Bools
    radii: Floats
    ovals: Floats


def double_points(field: ScalarFields, starts: Floats, cell: Floats, zero: Floats, noise: Floats) -> DoublePoints:
    """The double points near starts (k,3), found by Newton on the gradient.

    cell (s,2) is the size of the cells of each domain that the starts are the middles of; values up to zero (s,) count
    as zero; points around which values up to noise (s,) fill a whole sector lie in or at an area where f is zero, and
    are none.
    """
    if not len(starts):
        none = np.zeros(0)
        return DoublePoints(starts, none > 0.0, none, starts)
    points, curvature, bent = _critical(field, starts, cell)
    of = number(starts)
    zero = zero[of]
    away = np.abs((points - starts)[:, :2] / cell[of]).max(axis=1, initial=0.0)
    with np.errstate(invalid="ignore"):
        w, least = field.values(points), np.abs(curvature).min(axis=1)
        good = (away <= 3.0) & (np.abs(w) <= zero) & np.isfinite(curvature).all(axis=1)
        # A hollow that dips below zero, or a hill that rises above it, within less than a cell.
        dips = (curvature * w[:, None] < 0.0).all(axis=1) & (2.0 * np.abs(w) < least)
    ovals = points[(away <= 3.0) & (np.abs(w) > zero) & dips]
    good &= ~_in_area(field, points, cell, noise)
    points, curvature, bent = points[good], curvature[good], bent[good]
    size = np.sort(np.abs(curvature), axis=1)
    flat = size[:, 0] <= FLAT_NODE * size[:, 1]
    many = (size[:, 1] <= BENT * bent) & ~flat
    in_line = in_dense_groups(number(points), flat)
    kept = _singled(field, points, cell, flat | many, in_line)
    return DoublePoints(points[kept], np.asarray(flat[kept], dtype=np.bool_), _radii(curvature[kept]), ovals)


def in_dense_groups(of: Ints, some: Bools) -> Bools:
    """(k,) whether the function with this number has more than MOST_ALONE of what is marked among them (k,)."""
    return np.asarray((np.bincount(of[some], minlength=int(of.max(initial=0)) + 1) > MOST_ALONE)[of], dtype=np.bool_)


def _singled(field: ScalarFields, points: Floats, cell: Floats, slow: Bools, line: Bools) -> Ints:
    """Positions of points (k,3), one of each; along a line of flat ones many."""
    first = _apart(field, points, cell, 0.05)
    # Newton comes to a flat point, and to one of many branches, slowly and from several sides.
    slow = (slow & ~line)[first]
    kept = first[slow][_apart(field, points[first[slow]], cell, 1.0)]
    return np.sort(np.concatenate([first[~slow], kept]))


def _radii(curvature: Floats) -> Floats:
    """(k,) cells around nodes of principal curvatures (k,2) within which two branches are not told apart."""
    size = np.sort(np.abs(curvature), axis=1)
    crossing = (curvature[:, 0] * curvature[:, 1] < 0.0) & (size[:, 0] > FLAT_NODE * size[:, 1])
    # Half the angle between the branches has the tangent sqrt(size0 / size1) or its inverse.
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.sqrt(size[:, 0] / (size[:, 0] + size[:, 1]))
        radii = np.clip(1.0 / sine, NODE_RADIUS, WIDEST)
    return np.where(crossing, radii, NODE_RADIUS)


def _apart(field: ScalarFields, points: Floats, cell: Floats, cells: float) -> Ints:
    """Positions of points that are further apart than a number of cells: the first of each cluster."""
    of = number(points)
    # Those of different functions are farther apart than any number of cells that is asked for.
    at = np.concatenate([_around(field, points) / cell[of], 4.0 * of[:, None]], axis=1)
    return np.unique(close_points(at, cells), return_index=True)[1]


def _in_area(field: ScalarFields, points: Floats, cell: Floats, noise: Floats) -> Bools:
    """(k,) whether f is zero in three or more of eight places around points; off the axes, where nodes have zeros."""
    angle, of = 0.4142 + np.arange(8) * np.pi / 4.0, number(points)
    steps = np.stack([np.cos(angle), np.sin(angle)], axis=1) * cell[of, None]
    ring = moved(np.repeat(points[:, None], 8, axis=1), steps)
    w = field.values(ring.reshape(-1, 3)).reshape(-1, 8)
    return np.asarray((np.abs(w) <= noise[of, None]).sum(axis=1) >= 3, dtype=np.bool_)


def _around(field: ScalarFields, points: Floats) -> Floats:
    """(k,2) the parameters of points from the start of their domains, those at the end of a closed direction at its
    start."""
    of = number(points)
    at, size = field.wrapped(points)[:, :2] - field.start[of], field.size[of]
    for axis in (0, 1):
        if field.closed[axis]:
            at[:, axis] = np.where(at[:, axis] > size[:, axis] * (1.0 - ON_BORDER_OF_DOMAIN), 0.0, at[:, axis])
    return at


def _critical(field: ScalarFields, starts: Floats, cell: Floats) -> tuple[Floats, Floats, Floats]:
    """Points where the gradient vanishes, the two principal curvatures of f there, and the larger one at the starts,
    all in units of cells."""
    points, curvature = starts.copy(), np.full((len(starts), 2), np.nan)
    bent, of = np.full(len(starts), np.nan), number(starts)
    low, high = np.where(field.closed, -np.inf, field.low), np.where(field.closed, np.inf, field.high)
    active = np.arange(len(starts))
    for _ in range(60):
        if not len(active):
            break
        own = cell[of[active]]
        g = field.gradients(points[active]) * own
        h = field.hessians(points[active]) * (own[:, :, None] * own[:, None, :])
        sound = all_finite(g) & np.isfinite(h).all(axis=(1, 2))
        active, g, h = active[sound], g[sound], h[sound]
        bend, axes = symmetric_eigen(h)
        curvature[active] = bend
        bent[active] = np.where(np.isnan(bent[active]), np.abs(bend).max(axis=1, initial=0.0), bent[active])
        # Along a flat direction there is nothing to solve for, and the difference quotients are noise.
        steep = np.abs(bend) > STEEP_DIRECTION * np.abs(bend).max(axis=1, initial=0.0)[:, None]
        along = np.einsum("kji,kj->ki", axes, g)
        step = -np.einsum("kij,kj->ki", axes, np.where(steep, along / np.where(steep, bend, 1.0), 0.0))
        length = np.sqrt((step * step).sum(axis=1))
        step /= np.maximum(length, 1.0)[:, None]
        own, whose = cell[of[active]], of[active]
        points[active, :2] = np.clip(points[active, :2] + step * own, low[whose], high[whose])
        strayed = np.abs((points[active] - starts[active])[:, :2] / own).max(axis=1, initial=0.0) > 4.0
        active = active[(length > NODE_SETTLED_OF_CELL) & ~strayed]
    return points, curvature, bent


@dataclass(frozen=True, eq=False)
class Joined:
    """points (p,3) and segments (q,2) of a curve whose branches meet in nodes; meets (k,): how many branches end at
    each double point; around (r,): the double point within whose reach each of the points before lay, or -1."""

    points: Floats
    segments: Ints
    meets: Ints
    around: Ints


def joined_at_nodes(field: ScalarFields, points: Floats, segments: Ints, nodes: Floats, reach: Floats) -> Joined:
    """The curve with its branches led through nodes (k,3): what lies within reach (k,2) of one is dropped, and the
    ends left over are joined to the node.

    Ends that are opposite in the cyclic order around a node are joined to each other, so that branches go straight on.
    """
    if not len(nodes):
        return Joined(points, segments, np.zeros(0, dtype=np.intp), np.full(len(points), -1))
    inside = _node_around(field, points, nodes, reach)
    at_node = inside[segments]
    broken = (at_node[:, 0] < 0) != (at_node[:, 1] < 0)
    outer = np.where(at_node[broken, 0] < 0, 0, 1)
    row = np.arange(len(outer))
    end, node = segments[broken][row, outer], at_node[broken][row, 1 - outer]
    d = _difference(field, points[end], nodes[node]) / reach[node]
    order = np.lexsort((arctan2(d[:, 1], d[:, 0]), node))
    end, node, outer = end[order], node[order], outer[order]
    meets = np.bincount(node, minlength=len(nodes))
    rank = np.arange(len(node)) - ragged.starts(meets)[node]
    # Each pair of opposite ends has a copy of the node to itself.
    copies = (meets + 1) // 2
    copy = len(points) + ragged.starts(copies)[node] + rank % np.maximum(copies[node], 1)
    new = np.where((outer == 0)[:, None], np.stack([end, copy], axis=1), np.stack([copy, end], axis=1))
    kept = segments[(at_node < 0).all(axis=1)]
    return Joined(
        np.concatenate([points, np.repeat(nodes, copies, axis=0)]),
        np.concatenate([kept, new]),
        np.asarray(meets),
        inside,
    )


def _node_around(field: ScalarFields, points: Floats, nodes: Floats, reach: Floats) -> Ints:
    """(p,) the node within whose reach a point lies, the last of several, or -1."""
    inside = np.full(len(points), -1)
    node, point = within(field, points, nodes, reach)
    np.maximum.at(inside, point, node)
    return inside


def within(field: ScalarFields, points: Floats, centres: Floats, reach: Floats) -> tuple[Ints, Ints]:
    """Pairs of a centre (k,3) and a point (p,3) in the ellipse about it with the half axes reach (k,2), seams or
    not."""
    if not len(centres) or not len(points):
        return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
    strips = _strips(field, points, centres, reach, 0)
    if strips.pairs > MANY_IN_STRIPS * (len(points) + len(centres)):
        # Points of a line along which u stays are all in each other's strips.
        strips = min(strips, _strips(field, points, centres, reach, 1), key=lambda each: each.pairs)
    centre, point = strips.found()
    d = _difference(field, points[point], centres[centre]) / reach[centre]
    near = component_sum(d * d) <= 1.0
    return centre[near], point[near]


@dataclass(frozen=True, eq=False)
class _Strips:
    """Strips about centres, and, in a closed direction, about these a turn further: in order (p,), from first to last
    (t,k), the points that are in them."""

    order: Ints
    first: Ints
    last: Ints

    @property
    def pairs(self) -> int:
        """How many pairs of a centre and a point there are."""
        return int((self.last - self.first).sum())

    def found(self) -> tuple[Ints, Ints]:
        """The pairs."""
        count = (self.last - self.first).ravel()
        strip = ragged.owner(count)
        return strip % self.first.shape[1], self.order[ragged.place(count) + self.first.ravel()[strip]]


def _strips(field: ScalarFields, points: Floats, centres: Floats, reach: Floats, axis: int) -> _Strips:
    """The strips in which parameters of an axis are within reach (k,2) of those of centres."""
    of, at = number(centres), _sort_keys(number(points), field.wrapped(points)[:, axis])
    order = np.argsort(at, kind="stable")
    at = at[order]
    ends = np.searchsorted(at.real, of, side="right")
    turns = np.array([-1.0, 0.0, 1.0] if field.closed[axis] else [0.0])[:, None] * field.size[of, axis]
    first, last = (
        np.stack([np.searchsorted(at, _sort_keys(of, x)) for x in field.wrapped(centres)[:, axis] + side + turns])
        for side in (-reach[:, axis], reach[:, axis])
    )
    # One place more: the bounds are rounded.
    return _Strips(order, first, np.maximum(np.minimum(last + 1, ends), first))


def _sort_keys(of: Ints, x: Floats) -> NDArray[np.complex128]:
    """(k,) keys that sort by the numbers of (k,), and those of one number by x (k,)."""
    keys = np.zeros(len(x), dtype=np.complex128)
    keys.real, keys.imag = of, x
    return keys


def without_points_near(field: ScalarFields, centres: Floats, points: Floats, reach: Floats) -> Bools:
    """(k,) centres (k,3) with none of the points (p,3) in the ellipse with the half axes reach (k,2)."""
    free = np.ones(len(centres), dtype=np.bool_)
    free[within(field, points, centres, reach)[0]] = False
    return free


def _difference(field: ScalarFields, points: Floats, origin: Floats) -> Floats:
    """(k,2) points minus origin, the short way round in closed directions."""
    d, size = (points - origin)[:, :2], field.size[number(origin)]
    return np.asarray(d - np.where(field.closed, np.round(d / size), 0.0) * size)


# Segments of curves f = 0 joined to branches, through double points and up to borders and holes.

FAR_APART = 32.0
"""Smallest cells beyond which what looks like a part of one line belongs to another."""


@dataclass(frozen=True, eq=False)
class FoundBranches:
    """The curves before their chords are looked at: polylines, those of one function after those of another; the double
    points of ZeroManifold; and as points (k,3), the changes of sign that are no zeros, closed branches that are smaller
    than a cell, and the places that touch where two branches cannot be told apart."""

    lines: Traces
    nodes: Floats
    isolated: Floats
    touching: Floats
    poles: Ints
    missed: Floats
    spurious: Floats

    def counts(self, count: int) -> Ints:
        """(count, 4) of each function: the changes of sign, the small branches, these places, and all that touch."""
        sorts = (self.missed, self.spurious, self.touching)
        each = (np.bincount(number(points), minlength=count) for points in sorts)
        return np.stack([self.poles, *each], axis=1)


def found_branches(subdivision: Subdivision, traced: Segments, scale: Floats) -> FoundBranches:
    """The segments joined to polylines, through the double points among the odd cells."""
    lattice, odd = subdivision.lattice, subdivision.odd
    field, cell = lattice.field, lattice.cell()
    u, v = (field.start[odd.of, axis] + (at + 0.5) * cell[odd.of, axis] for axis, at in enumerate((odd.i, odd.j)))
    zero = np.maximum(NODE_OF_VALUES * scale, sizes_of_zeros(field, scale))
    doubles = double_points(field, np.stack([u, v, odd.of], axis=1), cell, zero, GRID_NOISE * scale)
    line = doubles.flat & in_dense_groups(number(doubles.points), doubles.flat)
    single, touching = doubles.points[~line], doubles.points[line]
    own = cell[number(single)]
    joined = joined_at_nodes(field, traced.points, traced.pairs, single, doubles.radii[~line, None] * own)
    lines, dots = without_repeats(_polylines(field, joined.points, joined.segments), field.size)
    lines, spurious = _without_spurious_loops(field, lines, cell, touching)
    # A point beside a curve, or one of a line that goes over into a curve, is not alone; what went round it and shrank
    # to it does not count.
    apart = np.where(doubles.flat[~line], FAR_APART, 3.0)[:, None] * own
    near, point = within(field, traced.points, single, apart)
    alone = joined.meets == 0
    alone[near[joined.around[point] != near]] = False

    def free(centres: Floats, points: Floats, cells: float) -> Floats:
        return centres[without_points_near(field, centres, points, cells * cell[number(centres)])]

    dots = field.wrapped(free(dots, doubles.points, 2.0))
    dotted = in_dense_groups(number(dots), np.ones(len(dots), dtype=np.bool_))
    return FoundBranches(
        lines,
        single[joined.meets > 0],
        np.concatenate([single[alone], dots[~dotted]]),
        np.concatenate([free(touching, lines.points, 1.5), dots[dotted], spurious]),
        traced.poles,
        free(doubles.ovals, traced.points, 2.0),
        spurious,
    )


def _without_spurious_loops(
    field: ScalarFields, lines: Traces, cell: Floats, touching: Floats
) -> tuple[Traces, Floats]:
    """The polylines without the closed ones that are thinner than a cell (s,2) and stand in a row, or have no area
    where many are that thin or f touches zero in many places touching (t,3); and the middles (k,3) of these: they are
    what lattice points between two branches that cannot be told apart make of them."""
    first, last = lines.starts, lines.ends
    p, whose = lines.points, of_lines(lines)
    counted = np.concatenate([whose, number(touching)])
    many = in_dense_groups(counted, np.ones(len(counted), dtype=np.bool_))[: len(whose)]
    if not many.any():
        return lines, p[:0]
    path = ragged.owner(last - first + 1)
    q = (p - p[first[path]])[:, :2] / cell[whose[path]]
    step = np.diff(q, axis=0)
    inner = ~lines.last[:-1]
    turn = q[:-1, 0] * q[1:, 1] - q[1:, 0] * q[:-1, 1]
    area, length = (
        np.abs(np.bincount(path[:-1][inner], weights=x[inner], minlength=len(first)))
        for x in (0.5 * turn, np.sqrt((step * step).sum(axis=1)))
    )
    back = np.abs(p[last] - p[first])[:, :2] / field.size[whose]
    is_thin = (back <= ROUNDING_OF_DOMAIN).all(axis=1) & (2.0 * area < length) & (last - first > 1)
    thin = np.flatnonzero(is_thin & many)
    sums = [np.bincount(path, weights=x, minlength=len(first))[thin] for x in p.T[:2]]
    middles = np.stack([*(total / (last - first + 1)[thin] for total in sums), whose[thin]], axis=1)
    middles = field.wrapped(middles)
    near = within(field, middles, middles, FAR_APART * cell[whose[thin]])[0]
    dense = (np.bincount(near, minlength=len(thin)) > 1) | (area[thin] < 1.0)
    counted = np.concatenate([whose[thin], number(touching)])
    marked = np.concatenate([dense, np.ones(len(touching), dtype=np.bool_)])
    dense &= in_dense_groups(counted, marked)[: len(thin)]
    gone = np.zeros(len(first), dtype=np.bool_)
    gone[thin[dense]] = True
    return lines.take(~gone[path]), middles[dense]


def _polylines(field: ScalarFields, points: Floats, segments: Ints) -> Traces:
    """The segments joined to polylines whose parameters run on over seams, those of one function after those of
    another; closed ones repeat their first point."""
    branches = concat(segments)
    rounds = closed_round(branches)
    along = points[branches.points[rounds.index]]
    order, offsets = ragged.take(rounds.offsets, np.argsort(number(along[rounds.offsets[:-1]]), kind="stable"))
    run_on = along[order]
    path = ragged.owner(np.diff(offsets))
    for axis in (0, 1):
        if field.closed[axis] and len(run_on):
            x, size = run_on[:, axis], field.size[number(run_on), axis]
            jump = np.concatenate([[0.0], -np.round(np.diff(x) / size[1:])])
            jump[offsets[:-1]] = 0.0
            turned = np.cumsum(jump)
            run_on[:, axis] = x + (turned - turned[offsets[path]]) * size
    last = np.zeros(len(run_on), dtype=np.bool_)
    last[offsets[1:] - 1] = True
    return Traces(run_on, last)


def led_to_holes(field: ScalarFields, lines: Traces, holes: Bools, cell: Floats, zero: Floats) -> Traces:
    """The polylines with open ends inside the domain led on to the border of the hole there; holes (s,): which
    functions have any."""
    p, starts, lasts = lines.points, lines.starts, lines.ends
    # The last point of a polyline before the first one of the next: so they are put in.
    end, before = np.concatenate([lasts, starts]), np.concatenate([lasts - 1, starts + 1])
    free = np.tile(~ends_meet(field, p[starts], p[lasts]) & holes[of_lines(lines)], 2) & ~_on_border(field, p[end])
    after = np.repeat([1, 0], len(starts))[free]
    end, before = end[free], before[free]
    more, goes = up_to_holes(field, p[end], p[before], cell[number(p[end])], zero)
    at = end[goes]
    return Traces(np.insert(p, at + after[goes], more[goes], axis=0), np.insert(lines.last, at, False))


def _on_border(field: ScalarFields, points: Floats) -> Bools:
    """(k,) points on an open border of the domain."""
    of = number(points)
    part = (points[:, :2] - field.start[of]) / field.size[of]
    return np.asarray(
        ((np.abs(part - 0.5) >= 0.5 - ON_BORDER_OF_DOMAIN) & ~np.array(field.closed)).any(axis=1), dtype=np.bool_
    )


def ends_meet(field: ScalarFields, first: Floats, last: Floats) -> Bools:
    """(b,) polylines that end where they start, whole periods aside."""
    turned = (last - first)[:, :2] / field.size[number(first)]
    return np.asarray(
        all_components(np.abs(turned - np.where(field.closed, np.round(turned), 0.0)) <= ROUNDING_OF_DOMAIN)
    )


# Curves f(u, v) = 0 on a rectangle of parameters, traced whole: branches, nodes, double points.


@dataclass(frozen=True, eq=False)
class ZeroManifold:
    """The curve f(u, v) = 0 over a domain, with all branches. points (p,2): u, v; offsets (b+1,); closed (b,): the last
    point joins the first, which is not repeated; turns (b,2): periods that a closed branch has run through; nodes
    (n,2): where branches meet; isolated (i,2): zeros without a change of sign; grid (columns+1, rows+1, 3): u, v and
    f.
    Source: Glaeser, section 8.4, figures 11 and 12; errata G8-08 to G8-14.
    """

    domain: Domain
    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    turns: Ints = field(metadata=EACH_LINE)
    nodes: Floats = field(metadata=APART)
    isolated: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)
    grid: Floats

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, branch: int) -> Floats:
        """(k,2) the points of a branch; a closed one ends with its first point, moved by its turns."""
        own = self.points[self.offsets[branch] : self.offsets[branch + 1]]
        if not self.closed[branch]:
            return own
        return np.concatenate([own, own[:1] + self.turns[branch] * np.array(self.domain.size)])

    @cached_property
    def triangulation(self) -> tuple[Ints, Floats]:
        """The optimised triangles of the graph w = f(u, v) over the grid, and its average normals."""
        return triangulate_surface(self.grid, closed_u=self.domain.closed_u, closed_v=self.domain.closed_v)


def zero_manifold_of_f_uv(
    f: Function,
    domain: Domain,
    *,
    columns: int,
    rows: int,
    gradient: Gradient | None = None,
    resolution: float = RESOLUTION,
    positions: Function | None = None,
    tolerance: float | None = None,
    budget: Budget = USUAL,
) -> ZeroManifold:
    """The curve f(u, v) = 0 over a domain, all its branches, each point refined on f to 1e-12 of the scale of f.

    Parameters
    ----------
    f : callable
        Takes arrays u, v (k,) and returns (k,) values; in closed directions it is periodic.
    domain : Domain
        Where f is defined.
    columns, rows : int
        Cells of the grid on which it is looked at first.
    gradient : callable, optional
        Takes arrays u, v (k,) and returns the two derivatives (k,) by u and by v; by differences where None.
    resolution : float
        The part of the domain down to which cells are subdivided where values and slopes leave open more than a single
        arc.
    positions : callable, optional
        Takes arrays u, v (k,) to where the tolerance is measured, (k, 2) or (k, 3), for example millimetres on a page;
        without it in u and v themselves. Where positions jump from one point to the next the curve is interrupted.
    tolerance : float, optional
        Points are put in until chords stay within this distance of the curve; none where None.
    budget : Budget
        How much work it may be.

    Returns
    -------
    ZeroManifold
        Branches, nodes, isolated points, and doubts.

    Raises
    ------
    InputError
        For fewer than two columns or rows, three in a closed direction, and a resolution that is not positive.

    Notes
    -----
    The scale of f is what nineteen in twenty values on the grid do not exceed. A closed branch that is larger than the
    resolution is found if the grid feels it, that is if slopes of the size met at the corners of a cell could reach
    zero inside it.

    Edge cases: f of one sign gives no branch; a change of sign through a pole or a jump is none either; where f is not
    finite there is a hole, and branches end at its border; zeros at grid points count as positive, which gives one
    polyline for a curve along grid lines; a border all along which f is zero is a pole of the surface, not a curve.

    Source: Glaeser, section 8.4, figures 11 and 12; errata G8-08 to G8-14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> square = surfaces.Domain(-2, 2, -2, 2)
    >>> circle = features.zero_manifold_of_f_uv(lambda u, v: u**2 + v**2 - 1, square, columns=8, rows=8, tolerance=0.01)
    >>> circle.closed.tolist(), bool(np.allclose(np.linalg.norm(circle.points, axis=1), 1.0))
    ([True], True)
    """
    (found,) = zero_manifolds(
        lambda u, v, of: f(u, v),
        [domain],
        columns=columns,
        rows=rows,
        gradient=None if gradient is None else lambda u, v, of: gradient(u, v),
        resolution=resolution,
        positions=None if positions is None else lambda u, v, of: positions(u, v),
        tolerances=None if tolerance is None else [tolerance],
        budget=budget,
    )
    return found


def zero_manifolds(
    f: Functions,
    domains: Sequence[Domain],
    *,
    columns: int,
    rows: int,
    gradient: Gradients | None = None,
    resolution: float = RESOLUTION,
    positions: Positions | None = None,
    tolerances: Sequence[float] | None = None,
    values: Floats | None = None,
    budget: Budget = USUAL,
) -> list[ZeroManifold]:
    """The curves f(u, v) = 0 of many functions, each over a domain of its own, all traced at once.

    values: (s, columns+1, rows+1) those of f on the grids, where they are known already.
    Source: see `zero_manifold_of_f_uv`.
    """
    for domain in domains:
        check_grid(domain, columns, rows, resolution)
    field = scalar_fields(f, domains, gradient)
    field, w = without_poles(field, field.on_grid(columns, rows) if values is None else values)
    scale = default_sizes(field, w)
    unit = units_of_values(scale)
    field, w, scale = in_units(field, unit), w / unit[:, None, None], scale / unit
    zero = sizes_of_zeros(field, scale)
    w[np.abs(w) <= GRID_NOISE * scale[:, None, None]] = 0.0
    near, odd = near_cells(w, field.closed)
    lattice = Lattice(field, columns, rows, _levels(columns, rows, resolution))
    flat = flat_cells(lattice, w, GRID_NOISE * scale)
    # Along the border of an area where f is zero slopes say nothing.
    subdivision = subdivided(lattice, odd & ~beside(flat, field.closed), GRID_NOISE * scale, budget.cells)
    traced = crossing_segments(lattice, triangles_near(subdivision, w, near), scale, zero)
    subdivision, traced, left_out = without_unresolved(subdivision, traced)
    found = found_branches(subdivision, traced, scale)
    holes: Bools = np.asarray(np.isnan(w).any(axis=(1, 2)))
    lines = found.lines if not holes.any() else led_to_holes(field, found.lines, holes, lattice.cell(), zero)
    unsure, enough = np.zeros(len(field), dtype=np.intp), np.ones(len(field), dtype=np.bool_)
    if tolerances is not None:
        measure = positions or (lambda u, v, of: np.stack([u, v], axis=-1))
        limits = np.array(tolerances, dtype=np.float64)
        lines, unsure, enough = refined_on_curve(field, lines, measure, limits, zero, budget.points)
    doubts = [
        doubts_of_one(*faults)
        for faults in zip(
            flat.sum(axis=(1, 2)).tolist(),
            [flat[0].size] * len(field),
            found.counts(len(field)).tolist(),
            subdivision.complete.tolist(),
            unsure.tolist(),
            enough.tolist(),
            left_out.tolist(),
            strict=True,
        )
    ]
    grid = grid_points(field, columns, rows)
    grid[..., 2] = unit[:, None, None] * w
    return _results(field, domains, lines, found, doubts, grid)


def check_grid(domain: Domain, columns: int, rows: int, resolution: float) -> None:
    """An InputError for fewer than two columns or rows, three in a closed direction, and a resolution not positive."""
    for count, closed, word in ((columns, domain.closed_u, "columns"), (rows, domain.closed_v, "rows")):
        if count < 2 + closed:
            raise InputError(f"{count} {word} of cells: expected {2 + closed} or more")
    if not 0.0 < resolution:
        raise InputError(f"resolution {resolution:g}: expected a positive part of the domain")


def _levels(columns: int, rows: int, resolution: float) -> int:
    """How often a cell is halved until it is no larger than resolution."""
    return int(np.clip(np.ceil(np.log2(1.0 / (min(columns, rows) * resolution)) - ABOVE_WHOLE), 0, 20))


def _results(
    field: ScalarFields,
    domains: Sequence[Domain],
    lines: Traces,
    found: FoundBranches,
    doubts: Sequence[tuple[str, ...]],
    grid: Floats,
) -> list[ZeroManifold]:
    """The manifolds of these polylines; of closed ones the repeated point is dropped."""
    first, last = lines.starts, lines.ends
    ends, of = (lines.points[first], lines.points[last]), of_lines(lines)
    closed = ends_meet(field, *ends) & (last - first > 1)
    turned = np.round((ends[1] - ends[0])[:, :2] / field.size[of])
    turns = np.where(closed[:, None], turned, 0.0).astype(np.intp)
    kept, offsets = lines.unrepeated(closed)
    points = lines.points[kept, :2]
    bounds = np.searchsorted(of, np.arange(len(field) + 1))
    nodes, isolated, touching = (_of_each(sort, len(field)) for sort in (found.nodes, found.isolated, found.touching))
    return [
        ZeroManifold(
            domain,
            points[offsets[a] : offsets[b]],
            offsets[a : b + 1] - offsets[a],
            closed[a:b],
            turns[a:b],
            nodes[k],
            isolated[k],
            touching[k],
            doubts[k],
            grid[k],
        )
        for k, (domain, (a, b)) in enumerate(zip(domains, pairwise(bounds.tolist()), strict=True))
    ]


def _of_each(points: Floats, count: int) -> list[Floats]:
    """The parameters (k,2) among points (p,3) of each of so many functions."""
    of = number(points)
    order = np.argsort(of, kind="stable")
    return np.split(points[order, :2], np.searchsorted(of[order], np.arange(1, count)))
