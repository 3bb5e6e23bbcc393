"""Evenly spaced integral curves on a mesh: places along curves, and where they begin and end beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import (
    FaceFieldFlow,
    MeshSides,
    face_field_flow,
    led_curves,
    mesh_sides,
    starts_in_faces,
)
from vectorplot.features.mesh_lines import NO_FACE, FaceTriangles, MeshCurves, all_mesh_curves, face_triangles
from vectorplot.features.streamlines import (
    MOST_LINES,
    NEAREST,
    ROUGHLY,
    SAMPLES,
    SEPARATE,
    WIDEST,
    SampledCurves,
    beside_each_other,
    taken_in_turn,
    widest_first,
)
from vectorplot.features.surface_points import USUAL_CREASE_DEG, BentFaces, FaceSites, unit
from vectorplot.features.tangent_fields import TangentField, TurnedField
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.budget import in_turn, may_stop, workers
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import closed_round, joined, take
from vectorplot.geometry.vectors import norm
from vectorplot.geometry.weld import one_each

if TYPE_CHECKING:
    from scipy.spatial import cKDTree


# A mesh and a field of directions as what curves are to cover evenly: places on it, and curves through them.

MOST_PLACES = 40_000
"""Places at which gaps are looked for, at most, as far as triangles need not be divided for them."""


@dataclass(frozen=True, eq=False)
class StreamlineMesh:
    """A mesh (bent: and how it bends), a field, and the distance of curves; turned: the flow at right angles to that of
    the field; longest: how long curves are to either side of where they begin at most, None: as of integral curves.

    Places are x, y, z and the number of the face (k,4); nodes (k,) count the points of curves that are led round, and
    what part of the way to the next one.
    """

    bent: BentFaces
    field: TangentField
    apart: float
    sides: MeshSides
    flow: FaceFieldFlow
    turned: FaceFieldFlow
    longest: float | None = None

    @property
    def mesh(self) -> Mesh:
        """On which they run."""
        return self.bent.mesh

    @property
    def extent(self) -> float:
        """Of the mesh."""
        return self.sides.extent

    @cached_property
    def normals(self) -> Floats:
        """(f,3) of the faces, zero of those without area."""
        return np.nan_to_num(unit(self.mesh.face_normals))

    def over(self) -> Floats:
        """Places all over the mesh where the field has a direction."""
        points, face = _all_over(face_triangles(self.mesh), self.apart)
        sites = FaceSites(points, unit(self.mesh.face_normals)[face], self.bent, face)
        known = np.isfinite(self.field.tangents(sites)[0]).all(axis=1)
        return np.asarray(np.column_stack([points, face])[known])

    def where(self, places: Floats) -> Floats:
        """(k,6) points, and normals of the length of the distance."""
        return np.concatenate([places[:, :3], self.apart * self.normals[places[:, 3].astype(np.intp)]], axis=1)

    def along(self, places: Floats) -> MeshCurves:
        """Curves of the field through places."""
        return self._led(self.flow, places, self.longest)

    def across(self, places: Floats) -> MeshCurves:
        """Curves at right angles to the field."""
        return self._led(self.turned, places, self.extent)

    def _led(self, flow: FaceFieldFlow, places: Floats, length: float | None) -> MeshCurves:
        face, own = starts_in_faces(
            "evenly spaced curves", self.mesh, self.sides, places[:, 3].astype(np.intp), places[:, :3]
        )
        return led_curves(self.sides, flow, face, own, flow.candidates[0, face], length, True, NEAREST * self.apart)

    def at(self, curves: MeshCurves, node: Floats) -> Floats:
        """(k,4) the places at nodes of curves."""
        rounds = closed_round(curves)
        points = _between(curves.points[rounds.index], node)
        return np.column_stack([points, self._faces(curves, rounds.index, node)])

    def _faces(self, curves: MeshCurves, index: Ints, node: Floats) -> Ints:
        """(k,) the faces at nodes of curves that are led round; at the ends that of the last segment."""
        face = curves.faces[index]
        own = face[np.floor(node).astype(np.intp)]
        return np.where(own == NO_FACE, face[np.maximum(np.floor(node).astype(np.intp) - 1, 0)], own)

    def parts(self, curves: MeshCurves, line: Ints, first: Floats, last: Floats) -> MeshCurves:
        """Parts of curves as open ones, from node to node."""
        node, offsets = _inner_nodes(line, first, last)
        places = self.at(curves, node)
        faces = places[:, 3].astype(np.intp)
        faces[offsets[1:] - 1] = NO_FACE
        return MeshCurves(
            np.ascontiguousarray(places[:, :3]),
            offsets,
            np.zeros(len(line), dtype=np.bool_),
            faces,
            curves.levels[line],
        )


def _all_over(faces: FaceTriangles, apart: float) -> tuple[Floats, Ints]:
    """Points (k,3) about half a distance from each other all over triangles, and the face (k,) of each."""
    corners = faces.mesh.vertices[faces.triangles]
    longest = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
    rows = np.maximum(np.ceil(2.0 * longest / apart), 1.0)
    rows = np.maximum(np.floor(rows * np.sqrt(min(1.0, MOST_PLACES / (rows * rows).sum()))), 1.0).astype(np.intp)
    # Of the small triangles that each is divided into, row by row from its first corner, the middles.
    count = rows * rows
    place, own = ragged.place(count), ragged.owner(count)
    row = np.floor(np.sqrt(place)).astype(np.intp)
    column, upside = np.divmod(place - row * row, 2)
    down, aside = (3 * row + 2 - upside) / 3.0, (3 * column + 1 + upside) / 3.0
    weights = np.stack([rows[own] - down, down - aside, aside], axis=1) / rows[own, None]
    points = np.einsum("ij,ijk->ik", weights, corners[own])
    # Where triangles are smaller than needed, one of those that are as good as in one place is enough.
    cell = np.floor((points - faces.mesh.bounds[0]) / (0.5 * apart)).astype(np.int64)
    normals = np.nan_to_num(unit(faces.mesh.face_normals))[faces.face[own]]
    _, first = np.unique(np.column_stack([cell, np.rint(2.0 * normals)]), axis=0, return_index=True)
    first.sort()
    return points[first], faces.face[own][first]


def _inner_nodes(line: Ints, first: Floats, last: Floats) -> tuple[Floats, Ints]:
    """The nodes (n,) at the ends of parts of curves and at all points between, part after part, and offsets (k+1,)."""
    inner = np.floor(first).astype(np.intp) + 1
    sizes = np.maximum(np.ceil(last).astype(np.intp) - inner, 0)
    node = np.concatenate([first, ragged.ranges(inner, sizes).astype(np.float64), last])
    owner = np.concatenate([np.arange(len(line)), ragged.owner(sizes), np.arange(len(line))])
    order = np.lexsort((node, owner))
    return node[order], ragged.offsets(sizes + 2)


def _between(nodes: Floats, node: Floats) -> Floats:
    """(k,d) what is on the way from one of the points (n,d) of curves to the next one."""
    low = np.floor(node).astype(np.intp)
    high = np.minimum(low + 1, len(nodes) - 1)
    begin = nodes[low]
    return np.asarray(begin + (node - low)[:, None] * (nodes[high] - begin))


# Cubes in which places lie, to tell most of what is far from others without comparing any.


@dataclass(frozen=True, eq=False)
class PlaceCells:
    """Cubes of a side over a box: low (3,), its lowest corner; counts (3,), how many there are along each axis."""

    low: Floats
    side: float
    counts: Ints

    @classmethod
    def over(cls, points: Floats, side: float) -> PlaceCells:
        """Over points (n,3). As many as the box has cubes: memory grows with these, one byte each. One of no points."""
        if not len(points):
            return cls(np.zeros(3), side, np.ones(3, dtype=np.intp))
        low = points.min(axis=0)
        return cls(low, side, ((points.max(axis=0) - low) / side).astype(np.intp) + 1)

    def of(self, points: Floats) -> Ints:
        """(n,) the numbers of the cubes of points (n,3); of points outside those of the nearest ones."""
        column = np.clip(((points - self.low) / self.side).astype(np.intp), 0, self.counts - 1)
        return np.asarray((column[:, 0] * self.counts[1] + column[:, 1]) * self.counts[2] + column[:, 2], dtype=np.intp)

    def near(self, points: Floats, reach: float) -> Bools:
        """(cubes,) which of them have something within reach, no more than a side, of points (n,3)."""
        found = np.zeros(int(np.prod(self.counts)), dtype=np.bool_)
        # A cube around a point, no larger than two cells, is in the cells of its corners and its middle.
        steps = (-reach, 0.0, reach) if 2.0 * reach > self.side else (-reach, reach)
        for aside in product(steps, repeat=3):
            found[self.of(points + np.array(aside))] = True
        return found


# Places along curves on a mesh, and which of them are reached from where each curve began.

FIRST_LOOK = 8
"""So many places to either side of where a curve began are looked at first, twice as many each time they are free."""


@dataclass(frozen=True, eq=False)
class PlacedCurves(SampledCurves):
    """Places along curves: node (p,), where (p,6); lengths are from the start of each curve, and it began near the
    place that seeds (c,) name."""

    curves: MeshCurves
    node: Floats
    where: Floats
    seeds: Ints


def beside(trees: Sequence[cKDTree], where: Floats, reach: float) -> Bools:
    """(k,) which places (k,6) are within reach of what trees have."""
    found = np.zeros(len(where), dtype=np.bool_)
    for tree in trees:
        left = np.flatnonzero(~found)
        away = tree.query(where[left], distance_upper_bound=reach, workers=workers(len(left)))[0]
        found[left] = np.isfinite(away)
    return found


def free_around(found: PlacedCurves, trees: Sequence[cKDTree], reach: float) -> Bools:
    """(p,) the places of each curve that are reached from its seed over such as are not within reach of what trees
    have; only these, and a few more, are looked for there."""
    count = len(found.curve)
    if not trees or not count:
        return np.ones(count, dtype=np.bool_)
    free = np.zeros(count, dtype=np.bool_)
    free[found.seeds] = ~beside(trees, found.where[found.seeds], reach)
    bounds = found.offsets
    for way in (-1, 1):
        left, look = np.flatnonzero(free[found.seeds]), FIRST_LOOK
        place = found.seeds[left]
        while len(left):
            may_stop()
            room = place - bounds[left] if way < 0 else bounds[left + 1] - 1 - place
            sizes = np.minimum(room, look)
            at = np.repeat(place, sizes) + way * (1 + ragged.place(sizes))
            free[at] = ~beside(trees, found.where[at], reach)
            shut = np.bincount(ragged.owner(sizes)[~free[at]], minlength=len(left)) > 0
            onward = ~shut & (room > look)
            left, place = left[onward], place[onward] + way * look
            look *= 2
    first, last = found.reached(free)
    result = np.zeros(count, dtype=np.bool_)
    result[ragged.ranges(first, np.maximum(last - first + 1, 0))] = True
    return result


def some_places(found: PlacedCurves, free: Bools) -> tuple[PlacedCurves, Ints]:
    """The curves with those of their places alone that are free, and their seeds; and which (k,) they are."""
    chosen = free.copy()
    chosen[found.seeds] = True
    at = np.flatnonzero(chosen)
    offsets, seeds = np.searchsorted(at, found.offsets), np.searchsorted(at, found.seeds)
    picked = replace(
        found, offsets=offsets, along=found.along[at], node=found.node[at], where=found.where[at], seeds=seeds
    )
    return picked, at


# How curves cover a mesh evenly: where they begin, and where they end beside each other. Each is taken as on smooth
# surfaces (streamlines.taken_in_turn). The rounds differ: here what is taken is one tree, as near places are near along
# a mesh too, and boxes and cells spare most looks; on surfaces each look asks for the sheet, and itself costs most.

MOST_SAMPLES = 16
"""And so many at most, however near each other its points are."""

MOST_ROUNDS = 24
"""Gaps are filled so many times at most; each time they are about half as wide."""

MOST_AT_ONCE = 1000
"""And so many at a time."""

FARTHER = 4.0
"""Times as far one looks for what is taken where nothing is near enough."""

CELL = 2.0
"""Times the distance of curves that the cells are large by which is told what is near what is taken."""

PLACES_AT_ONCE = 1 << 20
"""About so many places of curves of a known length are looked at in one go: where they would begin beside those of the
last one, they are not led at all."""

GROUP = 1 << 14
"""So many places of curves are compared with each other at a time."""


def placed_streamlines(shape: StreamlineMesh) -> MeshCurves:
    """Curves of its field that cover a mesh evenly.

    Errors: InputError for a distance of less than a five-hundredth of the extent of the mesh.
    Source: see evenly_spaced_curves.
    """
    apart, size = shape.apart, shape.extent
    if size > MOST_LINES * apart:
        raise InputError(
            f"evenly spaced curves {apart:g} apart on a surface of {size:g}: expected {size / MOST_LINES:g} or more"
        )
    from scipy.spatial import cKDTree

    some = None if shape.longest is None else max(1, int(PLACES_AT_ONCE * apart / (2.0 * SAMPLES * shape.longest)))
    places = shape.over()
    where = shape.where(places)
    taken = np.zeros((0, 6))
    found: list[MeshCurves] = [all_mesh_curves([])]
    for _ in in_turn(range(MOST_ROUNDS)):
        tree = cKDTree(taken, balanced_tree=False) if len(taken) else None
        if tree is not None:
            open_ = ~beside([tree], where, WIDEST * apart)
            places, where = places[open_], where[open_]
        gaps = _gaps(where, tree, apart)
        if not len(gaps):
            break
        trees = [] if tree is None else [tree]
        seeds, spots = _seeds(shape, places[gaps], trees)
        # A gap that nothing fits into is one no more.
        every = [taken, where[gaps]]
        while len(seeds):
            may_stop()
            new = _compared(shape, shape.along(seeds[:some]), spots[:some])
            kept, own = _without_dense_groups(shape, new, trees)
            found += kept
            every.append(own)
            trees.append(cKDTree(own, balanced_tree=False))
            if some is None:
                break
            seeds, spots = seeds[some:], spots[some:]
            open_ = ~beside(trees[-1:], spots, WIDEST * apart)
            seeds, spots = seeds[open_], spots[open_]
        taken = np.concatenate(every)
    return joined(found)


def _gaps(where: Floats, tree: cKDTree | None, apart: float) -> Ints:
    """Which of the places that are away from all that is taken are so from one another, the farthest ones first."""
    if not len(where):
        return np.zeros(0, dtype=np.intp)
    if tree is None:
        middle = np.median(where, axis=0)
        return np.array([np.argmin(norm(where[:, :3] - middle[:3]))])
    return widest_first(where, _away(tree, where, SEPARATE * apart), apart, MOST_AT_ONCE)


def _away(tree: cKDTree, where: Floats, near: float) -> Floats:
    """(k,) how far places where (k,6) are from what a tree has: exact up to near, else larger by a part, ROUGHLY, at
    most.

    On shapes with flat sides much of what is far is equally far, and a tree must look at all of it: so the farther one
    looks, the fewer stand for all.
    """
    from scipy.spatial import cKDTree

    away = np.full(len(where), np.inf)
    left = np.arange(len(where))
    while True:
        away[left] = tree.query(where[left], distance_upper_bound=near, workers=workers(len(left)))[0]
        left = left[~np.isfinite(away[left])]
        if not len(left):
            return away
        taken = np.asarray(tree.data)
        # The longest way within a cube is a part of the distance from which on it counts.
        tree = cKDTree(taken[one_each(taken, ROUGHLY * near / np.sqrt(taken.shape[1]))])
        near *= FARTHER


def _seeds(shape: StreamlineMesh, gaps: Floats, trees: Sequence[cKDTree]) -> tuple[Floats, Floats]:
    """Places (k,d) in the gaps, the distance apart across the field, and where (k,6) they are."""
    apart = shape.apart
    lines = shape.across(gaps)
    if not len(lines):
        return gaps, shape.where(gaps)
    found = _compared(shape, lines, shape.where(gaps))
    signed = found.from_seed
    rounds = np.abs(np.rint(signed / apart))
    near = np.abs(np.abs(signed) - rounds * apart) <= 0.5 * apart / SAMPLES
    # Only in the gap itself: from its middle to the first place that is taken.
    near &= free_around(found, trees, WIDEST * apart)
    keys = np.stack([found.curve, np.rint(signed / apart)], axis=1)[near]
    _, first = np.unique(keys, axis=0, return_index=True)
    at = np.flatnonzero(near)[np.sort(first)]
    order = np.argsort(rounds[at], kind="stable")
    at = at[order]
    return shape.at(lines, found.node[at]), found.where[at]


def _compared(shape: StreamlineMesh, curves: MeshCurves, spots: Floats) -> PlacedCurves:
    """The curves with places along them; spots: where (k,6) the places are that their levels number."""
    apart = shape.apart
    rounds = closed_round(curves)
    points = curves.points[rounds.index]
    if not len(points):
        none = np.zeros(0)
        return PlacedCurves(np.zeros(1, dtype=np.intp), none, none, curves, none, np.zeros((0, 6)), ragged.owner([]))
    ends = rounds.offsets[1:] - 1
    begins = np.delete(np.arange(len(points)), ends)
    steps = norm(points[begins + 1] - points[begins])
    rise = np.zeros(len(points))
    rise[begins + 1] = steps
    total = np.cumsum(rise)
    counts = np.diff(rounds.offsets)
    total -= np.repeat(total[rounds.offsets[:-1]], counts)
    # Between two points of a curve as many places as its chord is long; and the ends of open curves.
    cell = np.floor(total * MOST_SAMPLES / apart)
    fresh = cell[begins + 1] != cell[begins]
    fresh[np.searchsorted(begins, rounds.offsets[:-1])] = True
    count = np.where(fresh, np.maximum(np.ceil(steps * SAMPLES / apart), 1), 0).astype(np.intp)
    node = np.concatenate(
        [np.repeat(begins, count) + ragged.place(count) / np.repeat(count, count), ends[~curves.closed]]
    )
    node.sort()
    along = np.interp(node, np.arange(len(points)), total)
    owner = ragged.owner(counts)[np.floor(node).astype(np.intp)]
    where = shape.where(shape.at(curves, node))
    away = norm(where - spots[curves.levels.astype(np.intp)][owner])
    offsets = np.searchsorted(owner, np.arange(len(curves) + 1))
    nearest = np.flatnonzero(away == np.minimum.reduceat(away, offsets[:-1])[owner])
    seeds = nearest[np.searchsorted(owner[nearest], np.arange(len(curves)))]
    return PlacedCurves(offsets, along, np.where(curves.closed, total[ends], np.inf), curves, node, where, seeds)


def _without_dense_groups(
    shape: StreamlineMesh, lines: PlacedCurves, trees: Sequence[cKDTree]
) -> tuple[list[MeshCurves], Floats]:
    """The curves, one after the other, as far as they are not too near what is taken, which trees have, to those
    before, and to themselves; and where (k,6) they are.

    Groups of curves are compared with each other, the later ones only as far as those before leave room: where many run
    together, as water in a valley, they are never compared all at once.
    """
    from scipy.spatial import cKDTree

    apart = shape.apart
    free = free_around(lines, trees, NEAREST * apart)
    found, places = some_places(lines, free)
    free = free[places]
    own = [np.zeros((0, 6))]
    spans = [np.zeros((0, 3), dtype=np.intp)]
    bounds = found.offsets
    low, high = _boxes(found.where, bounds[:-1])
    cells = PlaceCells.over(found.where[:, :3], CELL * apart)
    cell = cells.of(found.where[:, :3])
    left = np.flatnonzero(free[found.seeds])
    while len(left):
        may_stop()
        group, left = np.split(left, [max(1, int(np.searchsorted(np.cumsum(np.diff(bounds)[left]), GROUP)))])
        kept = _kept(found, group, free, apart)
        if not len(kept):
            continue
        spans.append(kept)
        own.append(found.where[ragged.ranges(kept[:, 1], kept[:, 2] - kept[:, 1] + 1)])
        last = cKDTree(own[-1], balanced_tree=False)
        left = left[~beside([last], found.where[found.seeds[left]], WIDEST * apart)]
        about = _boxes(own[-1], ragged.starts(kept[:, 2] - kept[:, 1] + 1))
        reach = NEAREST * apart
        near = left[np.unique(overlapping_boxes(low[:, left], high[:, left], about[0] - reach, about[1] + reach)[0])]
        at = ragged.ranges(bounds[near], bounds[near + 1] - bounds[near])
        at = at[free[at] & cells.near(own[-1][:, :3], reach)[cell[at]]]
        free[at] = ~beside([last], found.where[at], reach)
    line, first, end = np.concatenate(spans).T
    if not len(line):
        return [], np.zeros((0, 6))
    return _cut(shape, lines, line, places[first], places[end]), np.concatenate(own)


def _boxes(where: Floats, starts: Ints) -> tuple[Floats, Floats]:
    """The lowest and the highest corners (3,m) of curves whose places (p,6) begin at starts (m,)."""
    points = where[:, :3]
    return np.minimum.reduceat(points, starts).T, np.maximum.reduceat(points, starts).T


def _kept(found: PlacedCurves, lines: Ints, free: Bools, apart: float) -> Ints:
    """(s,3) which of some lines to keep, and their first and last places, see taken_in_turn. What is near on a mesh
    is so along it: the normals of thin shapes' two sides tell them apart."""
    first, last = (ends[lines] for ends in found.reached(free))
    at = ragged.ranges(first, np.maximum(last - first + 1, 0))
    pairs, seeds = beside_each_other(
        found, found.where, lines, at, apart, lambda one, two, reach: np.ones(len(one), dtype=np.bool_)
    )
    return taken_in_turn(found, lines, free, pairs, seeds, apart)


def _cut(shape: StreamlineMesh, found: PlacedCurves, line: Ints, first: Ints, last: Ints) -> list[MeshCurves]:
    """Parts of curves, from one place to another; whole curves as they are."""
    bounds = found.offsets
    whole = (first == bounds[line]) & (last == bounds[line + 1] - 1)
    kept = [take(found.curves, line[whole])]
    if not whole.all():
        kept.append(shape.parts(found.curves, line[~whole], found.node[first[~whole]], found.node[last[~whole]]))
    return kept


# Integral curves of one field that cover a mesh evenly.


def evenly_spaced_mesh_curves(
    mesh: Mesh, field: TangentField, apart: float, *, crease_angle_deg: float = USUAL_CREASE_DEG
) -> MeshCurves:
    """Integral curves of a field that cover a mesh evenly."""
    return evenly_spaced_on_faces(BentFaces(mesh, crease_angle_deg), field, apart)


def evenly_spaced_on_faces(
    bent: BentFaces, field: TangentField, apart: float, longest: float | None = None
) -> MeshCurves:
    """The same on a mesh of which is known how it bends; longest: as in StreamlineMesh."""
    positive("evenly spaced curves: distance", apart)
    sides, none = mesh_sides(bent.mesh), all_mesh_curves([])
    if not bent.mesh.face_count or sides.extent == 0.0:
        return none
    flow = face_field_flow(sides, bent, field)
    across = face_field_flow(sides, bent, TurnedField(field, 0.5 * np.pi))
    result = placed_streamlines(StreamlineMesh(bent, field, apart, sides, flow, across, longest))
    return replace(result, levels=np.zeros(len(result)))
