"""Lines of a scene as they are seen on rays that are bent or reflected by what is curved, or bent in a perspective.

Where things seem to be, each on its straight ray, is a scene of its own: polygons become finely cut triangles, their
sides keep their neighbours, and lines are found on it, and hidden by it, as on any other. Sides that are lines are
those that are so in the scene as it is; contours are those of the seeming scene, where bent rays graze the true one.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputWarning
from vectorplot.features.edge_splitting import FIRST, divided
from vectorplot.features.mesh_edge_lines import Faces, mesh_edges
from vectorplot.geometry import chord_refinement, ragged, records
from vectorplot.geometry.budget import in_turn, unresolved
from vectorplot.geometry.chord_refinement import Traces, straight_between
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.geometry.vectors import normalize
from vectorplot.pictures.line_sources import LineSources, seen_parts, traceable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.pictures.reflected_lines import Depth, Window
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.shading.facet_resolution import Coarse, faceted
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines, in_window, items_wanting, joined_lines, straight_lines
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import LineKind

FINER = 0.25
"""Triangles and chords are off what they stand for by this part of the tolerance: they decide what is hidden."""

ASIDE = 2.0
"""Lines are tested so many tolerances before where they seem to be: so they are seen on what they lie on, also from the
side, off by FINER as both are."""

FACETS = 2.0
"""Triangles of smooth surfaces are off these by so many tolerances of chords at most, which are half of what is asked
for: much more than where they seem to be is off, so that their contours are those of the surface."""

ROUNDS = 40
"""So often sides are halved at most, where it takes that."""

BORDER = 1.0 / 256.0
"""Sides beyond one end of which nothing is seen are halved until they are no longer, in units of the scene."""

BLIND = 0.25
"""The same of sides where nothing is seen, at their ends or in their middle."""


class BentRays(Protocol):
    """Sight rays that are bent or reflected on their way: where they show things."""

    def virtual(self, view: View, points: Floats, way: Ints) -> tuple[Floats, Bools]:
        """(3,n) where points (3,n) seem to be, each on the straight ray on which the eye sees it, at a depth that keeps
        the order along bent rays; and (n,) which are seen at all. way (n,): of the rays, of each point."""

    def seen_parts(self, view: View, start: Floats, end: Floats) -> tuple[Ints, Floats, Floats]:
        """The parts of segments from start to end (3,n) that are seen on the first way: which (k,) each is of, and its
        ends (3,k)."""


# What there is to be seen.


@dataclass(frozen=True, eq=False)
class Things:
    """What bent rays may show of a scene. view: of it, smooth surfaces as triangles; drawn (c,): whether the sides of
    faces that begin at corners are lines; lines: all that are no sides; outlined (i,): items whose contours are
    drawn."""

    view: View
    drawn: Bools
    lines: Lines
    outlined: Bools

    def __len__(self) -> int:
        """How much there is of it."""
        return self.view.face_count + len(self.lines)


def things_of(
    shapes: LineSources,
    scene: Scene,
    how: Depth,
    facets: float,
    left_out: Callable[[View, Lines], Bools] | None = None,
) -> Things:
    """What there is of a scene in the view of another one. facets: by how many tolerances triangles may be off smooth
    surfaces; left_out: which lines (n,) of a view are none."""
    outlined = items_wanting(LineKind.CONTOUR, scene, shapes.kinds)
    bare = replace(scene, items=tuple(replace(item, lines=_no_contours(item.lines)) for item in scene.items))
    kinds = shapes.kinds - {LineKind.CONTOUR, LineKind.OUTLINE}
    # As in a wireframe nothing is hidden yet.
    pipeline = Pipeline(plan_draw(bare, kinds, "none", 0.0, "wireframe"), None, None)
    view = view_of(bare, shapes.view)
    sources = traceable(pipeline, bare, view, project_faces(view), kinds, how.crease_angle_deg, how.budget)
    lines = replace(sources.lines(how.tolerance, how.budget), chords=None)
    if left_out is not None:
        lines = lines.take(~left_out(view, lines))
    off = facets * how.tolerance * view.scale
    meshes = faceted(bare, lambda item: Coarse((off,)), how.budget).scene
    view = view_of(meshes, shapes.view)
    drawn, sides = _on_sides(view, lines)
    return Things(view, drawn, lines.take(~sides), outlined)


def _no_contours(lines: tuple[str, ...] | None) -> tuple[str, ...] | None:
    return None if lines is None else tuple(word for word in lines if word != LineKind.CONTOUR.word)


def _on_sides(view: View, lines: Lines) -> tuple[Bools, Bools]:
    """(c,) which sides of faces, that begin at corners, are lines of the same item, and (n,) which lines are sides."""
    owner = np.repeat(view.face_item, view.face_sizes)
    ends = view.points[:, view.corners], view.points[:, view.corners[ragged.following(view.offsets)]]
    parts = [(ends[0], owner), (ends[1], owner), (lines.start, lines.item), (lines.end, lines.item)]
    rows = np.concatenate([np.concatenate([item[None], points + 0.0]) for points, item in parts], axis=1)
    number, count = _numbered(rows)
    a, b, c, d = np.split(number, np.cumsum([len(owner), len(owner), len(lines)]))
    sides, wanted = (np.minimum(x, y) * count + np.maximum(x, y) for x, y in ((a, b), (c, d)))
    return np.isin(sides, wanted) & ~view.inner, np.isin(wanted, sides)


def _numbered(rows: Floats) -> tuple[Ints, int]:
    """(n,) equal numbers for equal columns of rows (k,n), ascending with them, and how many there are."""
    order = np.lexsort(rows[::-1])
    new = np.append(True, (rows[:, order[1:]] != rows[:, order[:-1]]).any(axis=0))[: len(order)]
    number = np.empty(len(order), dtype=np.intp)
    number[order] = np.cumsum(new) - 1
    return number, int(new.sum())


# Where it seems to be.


@dataclass(frozen=True, eq=False)
class Vertices(Elements):
    """Corners of triangles: points (3,v) where they are, seeming (3,v) where they seem to be, seen (v,): whether they
    are seen at all."""

    points: Floats = field(metadata=IN_COLUMNS)
    seeming: Floats = field(metadata=IN_COLUMNS)
    seen: Bools

    @classmethod
    def of(cls, view: View, rays: BentRays, points: Floats) -> Vertices:
        """Those of some points (3,v)."""
        return cls(points, *rays.virtual(view, points, np.zeros(points.shape[1], dtype=np.intp)))


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles (t,3) of vertices, item (t,) of each; drawn (s,): sides that are lines, see keys_of."""

    vertices: Vertices
    triangles: Ints
    item: Ints
    drawn: Ints


def keys_of(one: Ints, other: Ints) -> Ints:
    """(n,) numbers of sides between vertices (n,): the smaller one of each in the upper half of the bits."""
    return np.minimum(one, other) << 32 | np.maximum(one, other)


def bent_faces(things: Things, rays: BentRays, box: Floats, how: Depth) -> Triangles:
    """The faces as rays show them, cut until their sides are straight enough: each for both of its triangles or none.
    box (4,): smallest and largest x, smallest and largest y of what is looked at.

    Warns: InputWarning where the budget does not do for the tolerance.
    """
    view, tolerance = things.view, FINER * how.tolerance
    corner, face = ragged.fans(view.offsets)
    begin = np.flatnonzero(things.drawn)
    drawn = np.unique(keys_of(view.corners[begin], view.corners[view.after(begin)]))
    found = Triangles(Vertices.of(view, rays, view.points), view.corners[corner], view.face_item[face], drawn)
    known, known_off = np.zeros(0, dtype=np.intp), np.zeros(0)
    for _ in in_turn(range(ROUNDS)):
        vertices, triangles = found.vertices, found.triangles
        edges, sides, _ = edges_of(triangles, len(vertices.seen))
        key = keys_of(*edges.T)
        order = np.argsort(key, kind="stable")
        place = np.minimum(np.searchsorted(known, key), max(len(known) - 1, 0))
        new = np.flatnonzero(known[place] != key) if len(known) else np.arange(len(key))
        middle = Vertices.of(view, rays, 0.5 * (vertices.points[:, edges[new, 0]] + vertices.points[:, edges[new, 1]]))
        off = known_off[place] if len(known) else np.zeros(len(key))
        off[new] = _off(vertices.take(edges[new, 0]), middle, vertices.take(edges[new, 1]))
        of_sides = off[sides] / tolerance
        coarse = (of_sides > 1.0) & (of_sides >= FIRST * of_sides.max(axis=1)[:, None])
        coarse &= _looked_at(view, vertices, triangles, off[sides].max(axis=1), box)[:, None]
        split = _with_longest(vertices, edges, sides, coarse)
        which = np.flatnonzero(split)
        if not len(which):
            break
        if len(triangles) + int(split[sides].sum()) > how.budget.facets:
            text = unresolved("what is seen on bent rays is coarser than the tolerance")
            warnings.warn(text, InputWarning, stacklevel=2)
            break
        found = _halved(view, rays, found, edges, sides, which)
        known, known_off = key[order], off[order]
    return found


def _with_longest(vertices: Vertices, edges: Ints, sides: Ints, coarse: Bools) -> Bools:
    """(e,) the edges (e,2) that are sides of triangles, sides (t,3), that are too coarse (t,3), and the longest side of
    each triangle of which a side is halved, so that none gets narrow. Source: Rivara 1984."""
    way = vertices.points[:, edges[:, 1]] - vertices.points[:, edges[:, 0]]
    of_sides = dot(way, way)[sides]
    longest = np.take_along_axis(sides, of_sides.argmax(axis=1)[:, None], axis=1)[:, 0]
    split = np.zeros(len(edges), dtype=np.bool_)
    split[sides[coarse]] = True
    while True:
        more = longest[split[sides].any(axis=1)]
        if split[more].all():
            return split
        split[more] = True


def _off(start: Vertices, middle: Vertices, end: Vertices) -> Floats:
    """(n,) how far the middles of sides are off the straight lines between their ends in space; infinite for long sides
    that are seen only partly, or not where they might be."""
    sag = middle.seeming - 0.5 * (start.seeming + end.seeming)
    way = end.points - start.points
    length = np.sqrt(dot(way, way))
    seen = start.seen & middle.seen & end.seen
    some = start.seen | middle.seen | end.seen
    unknown = np.where(length > np.where(some, BORDER, BLIND), np.inf, 0.0)
    return np.asarray(np.where(seen, np.sqrt(dot(sag, sag)), unknown))


def _looked_at(view: View, vertices: Vertices, triangles: Ints, off: Floats, box: Floats) -> Bools:
    """(t,) which triangles may be seen in a box (4,) of the image; off (t,): how far they are off at most. Of those
    that are seen only partly, the rest is taken to be no farther away than the box is wide."""
    x, y = view.image_of(vertices.seeming)[:, triangles]
    seen = vertices.seen[triangles]
    margin = np.minimum(np.where(seen.all(axis=1), off, np.inf), max(box[1] - box[0], box[3] - box[2]))
    within = np.ones(len(off), dtype=np.bool_)
    for side, least, most in ((x, box[0], box[1]), (y, box[2], box[3])):
        within &= np.where(seen, side, -np.inf).max(axis=1) + margin >= least
        within &= np.where(seen, side, np.inf).min(axis=1) - margin <= most
    return np.asarray(within | ~seen.any(axis=1))


def _halved(view: View, rays: BentRays, found: Triangles, edges: Ints, sides: Ints, which: Ints) -> Triangles:
    """The triangles with some of their edges (e,2) halved; sides (t,3) the edges of each."""
    vertices, count = found.vertices, len(found.vertices.seen)
    a, b = edges[which].T
    more = Vertices.of(view, rays, 0.5 * (vertices.points[:, a] + vertices.points[:, b]))
    middle = np.full(len(edges), -1, dtype=np.intp)
    middle[which] = count + np.arange(len(which))
    every = records.joined([vertices, more])
    triangles, of = divided(found.triangles, middle[sides], every.points.T)
    ended = np.isin(found.drawn, keys_of(a, b))
    own = np.isin(keys_of(a, b), found.drawn)
    halves = [keys_of(side[own], middle[which[own]]) for side in (a, b)]
    drawn = np.concatenate([found.drawn[~ended], *halves])
    return Triangles(every, triangles, found.item[of], drawn)


def bent_lines(view: View, rays: BentRays, lines: Lines, how: Depth) -> Lines:
    """Lines as rays show them: chords within the tolerance."""
    which, start, end = rays.seen_parts(view, lines.start, lines.end)
    if not len(which):
        return lines.take(which)
    none = np.zeros(2 * len(which), dtype=np.intp)

    def image(points: Floats) -> Floats:
        there, seen = rays.virtual(view, np.ascontiguousarray(points.T), none[:1].repeat(len(points)))
        return np.asarray(np.where(seen, there, np.nan).T)

    ends = np.stack([start, end], axis=2).reshape(3, -1).T
    last = np.tile([False, True], len(which))
    traces = Traces(np.ascontiguousarray(ends), last)
    fine = chord_refinement.refined(
        traces, straight_between, image, FINER * how.tolerance, how.budget.points, none[: len(which)]
    )
    there, last = image(fine.lines.points).T, fine.lines.last
    first = np.flatnonzero(~last)
    own = np.repeat(np.arange(len(which)), np.diff(np.flatnonzero(last), prepend=-1) - 1)
    kept = np.isfinite(there[0, first]) & np.isfinite(there[0, first + 1])
    first, own = first[kept], which[own[kept]]
    found = straight_lines(there[:, first], there[:, first + 1], lines.kind[own], lines.item[own], np.zeros_like(own))
    return replace(found, smooth=np.ones(len(own), dtype=np.bool_), lamp=lines.lamp[own])


@dataclass(frozen=True, eq=False)
class Seeming:
    """A scene where it seems to be: view, and its faces in the image, triangles among them its own; lines: of it."""

    view: View
    faces: ProjectedFaces
    triangles: Triangles
    lines: Lines

    def seen(self, hidden: str) -> Visibility:
        """Which parts of the lines are seen, or, with a word of draw for hidden lines, by how many items hidden."""
        pipeline = Pipeline(plan_draw(Scene(()), frozenset(), hidden, 0.0), None, None)
        return seen_parts(
            pipeline, self.view, self.faces, np.zeros(len(self.view.occludes), dtype=np.bool_), self.lines
        )


def seeming(
    things: Things, rays: BentRays, box: Floats, window: Window | None, how: Depth, before: Triangles | None = None
) -> Seeming:
    """What rays show of things in a window of the image, box (4,) or larger; before: other triangles that only hide."""
    view, own = things.view, bent_faces(things, rays, box, how)
    parts = [own] if before is None else [own, before]
    mixed, number = _view_of_triangles(view, parts)
    faces, drawn = project_faces(mixed), keys_of(number[own.drawn >> 32], number[own.drawn & 0xFFFFFFFF])
    edges = _edges(mixed, faces, drawn, things.outlined)
    lines = joined_lines([edges, bent_lines(view, rays, things.lines, how)])
    lines = in_window(mixed, lines, window)
    return Seeming(mixed, faces, own, replace(lines, aside=_aside(mixed, lines, ASIDE * how.tolerance)))


def _view_of_triangles(view: View, parts: list[Triangles]) -> tuple[View, Ints]:
    """The view of all that is seen of triangles, with the items of each part after those of the part before; and the
    numbers (v,) there of the vertices of the first part."""
    items, count = len(view.occludes), [len(part.vertices.seen) for part in parts]
    first = ragged.starts(np.array(count))
    triangles = np.concatenate([part.triangles + at for part, at in zip(parts, first, strict=True)])
    item = np.concatenate([part.item + k * items for k, part in enumerate(parts)])
    of_vertex = np.zeros(sum(count), dtype=np.intp)
    of_vertex[triangles.ravel()] = np.repeat(item, 3)
    by_item = np.argsort(of_vertex, kind="stable")
    number = np.empty_like(by_item)
    number[by_item] = np.arange(len(by_item))
    every = records.joined([part.vertices for part in parts]).take(by_item)
    triangles = number[triangles]
    kept = np.flatnonzero(every.seen[triangles].all(axis=1))
    kept = kept[np.argsort(item[kept], kind="stable")]
    found = replace(
        view,
        points=every.seeming,
        corners=triangles[kept].ravel(),
        offsets=3 * np.arange(len(kept) + 1),
        inner=np.zeros(3 * len(kept), dtype=np.bool_),
        face_item=item[kept],
        item_vertices=np.searchsorted(of_vertex[by_item], np.arange(len(parts) * items + 1)),
        occludes=np.tile(view.occludes, len(parts)),
        face_look=None,
    )
    return found, number[: count[0]]


def _edges(view: View, faces: ProjectedFaces, drawn: Ints, outlined: Bools) -> Lines:
    """The sides of the triangles of a view that are lines, see keys_of, or contours of the first items (i,), once
    each."""
    of_all = Faces(view.points, view.corners, view.offsets, view.inner, faces.facing)
    edges = mesh_edges(of_all, {LineKind.CONTOUR}, 180.0)
    outlined = np.concatenate([outlined, np.zeros(len(view.occludes) - len(outlined), dtype=np.bool_)])
    contours = keys_of(edges.start, edges.end)[outlined[view.face_item[edges.face]]]
    begin, end = view.corners, view.corners[ragged.following(view.offsets)]
    key, first = np.unique(keys_of(begin, end), return_index=True)
    side = first[np.isin(key, np.concatenate([drawn, contours]))]
    item, ends = view.face_item[side // 3], (view.points[:, begin[side]], view.points[:, end[side]])
    lines = straight_lines(*ends, np.full(len(side), int(LineKind.CONTOUR)), item, np.zeros_like(item))
    return replace(lines, smooth=np.ones(len(side), dtype=np.bool_))


def _aside(view: View, lines: Lines, length: float) -> Floats:
    """(3,n) ways of some length from lines towards the eye."""
    if view.eye is None:
        return np.tile([[0.0], [0.0], [length]], len(lines))
    return np.asarray(length * normalize((view.eye[:, None] - 0.5 * (lines.start + lines.end)).T).T)
