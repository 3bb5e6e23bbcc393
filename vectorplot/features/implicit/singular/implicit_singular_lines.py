"""The lines of an implicit surface along which its gradient vanishes: cuspidal edges, and where it crosses itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.implicit_conditions import SpatialCondition
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.singular.singular_equations import (
    CuspidalEdges,
    DoubleLines,
    SingularEquations,
    line_tangents,
    onto_lines,
)
from vectorplot.geometry import records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import Polylines
from vectorplot.geometry.repair.weld import chained, one_each
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances.of_extent import SAME_ON_LINE

STEPS = 48
"""Steps along the box from one point of a line to the next, before it is made finer."""

SLOW = 0.5
"""Part of the usual gradient below which singular lines are looked for."""

REACH = 6.0
"""Steps from the mesh within which they are: polygonised wings of a cuspidal edge end so far before it."""

FARTHEST = 1.7
"""Steps from a point to the next one of its line at most."""

FORWARD = 0.5
"""Cosine with the tangent above which another point lies ahead."""

MEETING_STEPS = 3
"""Steps of Newton along a line to where a condition holds, from close by."""

STRAYS = 0.5
"""Part of a step that a line may bend aside on it."""

ROUNDS = 1000
"""Points that are put to an end of a line at most."""

PARTS, CUTS = 16, 2
"""Into so many parts the last step to the end of a line is cut, and so often the first of them that leads too far."""

LAST_STEPS = 4
"""Such last steps at most: towards a swallowtail lines bend more and more."""

NONE = -1
"""No neighbour."""

GONE = -2
"""The line ends."""


@dataclass(frozen=True, eq=False)
class SingularLines:
    """The singular lines of a surface, coarsely: cuspidal edges, and double lines, where it crosses itself; with the
    equations that hold on each kind."""

    edges: Polylines
    edge_equations: CuspidalEdges
    doubles: Polylines
    double_equations: DoubleLines

    def __len__(self) -> int:
        return len(self.edges) + len(self.doubles)

    @property
    def kinds(self) -> list[tuple[SingularEquations, Polylines]]:
        """The lines of every kind that there are, with their equations."""
        both: list[tuple[SingularEquations, Polylines]] = [
            (self.edge_equations, self.edges),
            (self.double_equations, self.doubles),
        ]
        return [(equations, lines) for equations, lines in both if len(lines)]

    def onto(self, points: Floats, reach: Floats) -> tuple[Floats, Bools]:
        """Points (n,3) led onto the lines, not further than reach (n,), and which of them got there."""
        found, on = points.copy(), np.zeros(len(points), dtype=np.bool_)
        for equations, _ in self.kinds:
            rest = np.flatnonzero(~on)
            found[rest], on[rest] = onto_lines(equations, points[rest], reach[rest])
        return found, on

    def met(self, condition: SpatialCondition, points: Floats, reach: float) -> Floats:
        """Points (n,3), those nearer to a line than reach moved to where a condition holds on it; where it has no value
        there, as one about normals, onto the line."""
        result = points.copy()
        for equations, _ in self.kinds:
            start, on = onto_lines(equations, points, np.full(len(points), reach))
            row, x = np.flatnonzero(on), start[on]
            for _ in range(MEETING_STEPS):
                with np.errstate(all="ignore"):
                    tangent = line_tangents(equations, x)
                    step = -condition.values(x) / (condition.gradients(x) * tangent).sum(axis=1)
                near = np.abs(step) <= reach
                moved, there = onto_lines(
                    equations, x[near] + step[near, None] * tangent[near], reach + 0.0 * step[near]
                )
                near[near] = there
                x[near] = moved[there]
            result[row] = x
        return result


def singular_lines(surface: ImplicitSurface, mesh: Mesh) -> SingularLines:
    """The cuspidal edges and double lines of a surface within its box, polygonised as a mesh.

    They end on the sides of the box, and at points in which the equations of their kind lose their rank, known to about
    1e-4 of the extent: pinch points, swallowtails, points in which several lines meet.
    Degenerate: lines along which second derivatives vanish altogether are not found.
    """
    extent = float(np.ptp(np.asarray(surface.box, dtype=np.float64), axis=0).max())
    edges, doubles = CuspidalEdges(surface, extent), DoubleLines(surface, extent)
    start = _slow_places(surface, mesh, extent / STEPS)
    return SingularLines(_traced(edges, start), edges, _traced(doubles, start), doubles)


def usual_gradient(surface: ImplicitSurface, points: Floats) -> float:
    """How long the gradient is at most of the points (n,3); 0 without any."""
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(points), axis=1)
    known = steep[np.isfinite(steep)]
    return float(np.median(known)) if len(known) else 0.0


def _slow_places(surface: ImplicitSurface, mesh: Mesh, step: float) -> Floats:
    """(k,3) vertices of a mesh at which the gradient is small, one in each cube of a lattice."""
    if not mesh.face_count:
        return np.zeros((0, 3))
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(mesh.vertices), axis=1)
        slow = mesh.vertices[~(steep > SLOW * usual_gradient(surface, mesh.vertices))]
        slow = slow[one_each(slow, step)]
        # Second derivatives tell how far away the gradient may vanish.
        bends = np.linalg.norm(hessians(surface, slow), axis=(1, 2))
        far = np.linalg.norm(surface.gradients(slow), axis=1) > REACH * step * bends
    return np.asarray(slow[~far])


@dataclass(frozen=True, eq=False)
class _Beads:
    """Points (n,3) on lines with unit tangents (n,3); next (n,2): for each the one before it and the one behind it, by
    its tangent; NONE where that is not known yet, GONE where there is none."""

    points: Floats
    tangents: Floats
    next: Ints

    def joined(self, points: Floats, tangents: Floats) -> _Beads:
        """These and more."""
        fresh = np.full((len(points), 2), NONE)
        return records.joined((self, _Beads(points, tangents, fresh)))


def _traced(equations: SingularEquations, start: Floats) -> Polylines:
    """The lines on which equations hold, from places (k,3) near them."""
    step = equations.extent / STEPS
    found, on = onto_lines(equations, start, np.full(len(start), REACH * step))
    found = found[on & sides_of(equations.surface).has(found)]
    found = found[one_each(found, step)]
    beads = _Beads(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 2), dtype=np.intp))
    beads = beads.joined(found, line_tangents(equations, found))
    for _ in range(ROUNDS):
        beads = _linked(equations, beads, step)
        row, side = np.nonzero(beads.next == NONE)
        if not len(row):
            break
        way = beads.tangents[row] * np.where(side == 1, 1.0, -1.0)[:, None]
        new, on = _ahead(equations, beads.points[row], way, np.full(len(row), step))
        beads.next[row[~on], side[~on]] = GONE
        new = new[on]
        # Ends that come towards each other make one new point.
        new = new[one_each(new, SAME_ON_LINE * equations.extent)]
        beads = beads.joined(new, line_tangents(equations, new))
    return _polylines(equations, beads, step)


def _ahead(equations: SingularEquations, points: Floats, ways: Floats, lengths: Floats) -> tuple[Floats, Bools]:
    """(k,3) the points of lines in the planes that lie ahead of points (k,3), across unit ways (k,3), by lengths (k,);
    and which there are, in the box."""
    found, on = onto_lines(equations, points + lengths[:, None] * ways, STRAYS * lengths, across=ways)
    return found, on & sides_of(equations.surface).has(found)


def _linked(equations: SingularEquations, beads: _Beads, step: float) -> _Beads:
    """The beads with those joined that follow one another: a line that sets out from the one arrives at the other."""
    from scipy.spatial import cKDTree

    points, tangents = beads.points, beads.tangents
    pairs = cKDTree(points).query_pairs(FARTHEST * step, output_type="ndarray") if len(points) else np.zeros((0, 2))
    one, two = np.concatenate([pairs, pairs[:, ::-1]]).astype(np.intp).T
    way = points[two] - points[one]
    long = np.linalg.norm(way, axis=1)
    along = (way * tangents[one]).sum(axis=1)
    side = (along > 0.0).astype(np.intp)
    from_two = (tangents[two] * way).sum(axis=1)
    other = (from_two < 0.0).astype(np.intp)
    open_ = (beads.next[one, side] == NONE) & (np.abs(along) > FORWARD * long) & (np.abs(from_two) > FORWARD * long)
    one, two, side, other, along, long = (x[open_] for x in (one, two, side, other, along, long))
    sense = np.sign(along)
    found, on = _ahead(equations, points[one], tangents[one] * sense[:, None], np.abs(along))
    same = on & (np.linalg.norm(found - points[two], axis=1) <= SAME_ON_LINE * equations.extent)
    one, two, side, other, long = (x[same] for x in (one, two, side, other, long))
    # The nearest one follows.
    order = np.lexsort((long, 2 * one + side))
    first = np.concatenate([[True], np.diff((2 * one + side)[order]) != 0])[: len(order)]
    chosen = order[first]
    new = beads.next.copy()
    new[one[chosen], side[chosen]] = two[chosen]
    back = (new[two[chosen], other[chosen]] == one[chosen]) | (new[two[chosen], other[chosen]] < 0)
    new[two[chosen][back], other[chosen][back]] = one[chosen][back]
    return _Beads(points, tangents, new)


def _polylines(equations: SingularEquations, beads: _Beads, step: float) -> Polylines:
    """The beads on their strings, led on to where the lines end; those without neighbours that stay where they are make
    no line."""
    one, two = np.nonzero(beads.next >= 0)
    chords = [np.unique(np.sort(np.stack([one, beads.next[one, two]], axis=1), axis=1), axis=0)]
    points = [beads.points]
    row, side = np.nonzero(beads.next == GONE)
    number, last, way = row, beads.points[row], beads.tangents[row] * np.where(side == 1, 1.0, -1.0)[:, None]
    count, far = len(beads.points), np.zeros(len(beads.points))
    for _ in range(LAST_STEPS):
        new, gone = _farthest(equations, last, way, step)
        np.maximum.at(far, row, gone)
        on = gone > 0.0
        row, number, last, way, new = row[on], number[on], last[on], way[on], new[on]
        if not len(row):
            break
        after = count + np.arange(len(row))
        chords.append(np.stack([number, after], axis=1))
        points.append(new)
        tangents = line_tangents(equations, new)
        way = tangents * np.where((tangents * way).sum(axis=1) < 0.0, -1.0, 1.0)[:, None]
        number, last, count = after, new, count + len(row)
    lonely = (beads.next < 0).all(axis=1) & (far < STRAYS * step)
    pairs, string = np.concatenate(chords), np.concatenate(points)
    gone_with = np.isin(_string_of(pairs, len(string)), np.flatnonzero(lonely))
    branches = concat(pairs[~gone_with[pairs[:, 0]]])
    return Polylines(string[branches.points], branches.offsets, branches.closed)


def _string_of(pairs: Ints, count: int) -> Ints:
    """(count,) the smallest number of the points that each point hangs together with by pairs."""
    return chained(count, pairs[:, 0], pairs[:, 1])


def _farthest(equations: SingularEquations, points: Floats, ways: Floats, step: float) -> tuple[Floats, Floats]:
    """(k,3) the last points of lines ahead of points (k,3) on them, no more than a step away; and how far (k,) these
    are."""
    low, width = np.zeros(len(points)), step
    each = np.repeat(np.arange(len(points)), PARTS - 1)
    for _ in range(CUTS):
        width /= PARTS
        tried = low[:, None] + width * np.arange(1, PARTS)
        on = _ahead(equations, points[each], ways[each], tried.ravel())[1].reshape(tried.shape)
        low += width * np.logical_and.accumulate(on, axis=1).sum(axis=1)
    found, on = _ahead(equations, points, ways, low)
    side, leaves = _on_side(equations, points, ways, step)
    found = np.where(leaves[:, None], side, np.where(on[:, None], found, points))
    return found, np.linalg.norm(found - points, axis=1)


def _on_side(equations: SingularEquations, points: Floats, ways: Floats, step: float) -> tuple[Floats, Bools]:
    """(k,3) where lines ahead of points (k,3) leave the box or are cut, in the plane that the unit ways (k,3) lead to
    first; and which do within a step."""
    sides = sides_of(equations.surface)
    planes = [plane for side in range(len(sides.normals)) for plane in sides.planes(side)]
    normals, offsets = np.array([plane.normal for plane in planes]), np.array([plane.offset for plane in planes])
    with np.errstate(all="ignore"):
        lengths = (offsets - matmul(points, normals.T)) / (matmul(ways, normals.T))
    ahead = np.where(lengths >= 0.0, lengths, np.inf)
    nearest = np.argmin(ahead, axis=1)
    length = ahead[np.arange(len(points)), nearest]
    start = points + np.minimum(length, step)[:, None] * ways
    found, on = onto_lines(equations, start, np.full(len(points), step), across=normals[nearest])
    for number, plane in enumerate(planes):
        found[nearest == number] = plane.put(found[nearest == number])
    on &= (length <= step) & (length > 0.0) & sides.has(found)
    return found, on
