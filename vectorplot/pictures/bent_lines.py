"""Lines of a scene as they are seen on rays that are bent or reflected by what is curved, or bent in a perspective.

Where things seem to be, each on its straight ray, is a scene of its own: polygons become finely cut triangles, their
sides keep their neighbours, and lines are found on it, and hidden by it, as on any other. Sides that are lines are those
that are so in the scene as it is; contours are those of the seeming scene, where bent rays graze the true one.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.refraction import BentRays, Soup, Triangles, bent_triangles, fans
from vectorplot.errors import InputWarning
from vectorplot.features.mesh_edge_lines import Faces, mesh_edges
from vectorplot.geometry import chord_refinement, ragged, records
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, straight_between
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

ASIDE = 2.0
"""Lines are tested so many tolerances before where they seem to be: triangles of what touches are off by one each."""

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])
"""The window of an image without borders: smallest and largest x, smallest and largest y."""


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
    shapes: LineSources, scene: Scene, how: Depth, left_out: Callable[[View, Lines], Bools] | None = None
) -> Things:
    """What there is of a scene in the view of another one. left_out: which lines (n,) of a view are none."""
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
    off = how.tolerance * view.scale
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


def bent_faces(things: Things, rays: BentRays, box: Floats, how: Depth) -> Triangles:
    """The faces as rays show them, of the sources that their items are, whose outer sides are lines. box (4,):
    smallest and largest x, smallest and largest y of what is looked at.

    Warns: InputWarning where the budget does not do for the tolerance.
    """
    view, tolerance = things.view, how.tolerance
    item = view.face_item
    soup = Soup(view.points[:, view.corners], view.offsets, item, np.zeros_like(item))
    triangles, (corner, _) = fans(soup), ragged.fans(view.offsets)
    triangles = replace(triangles, outer=triangles.outer & things.drawn[corner.T])
    most = how.budget.facets
    fine, enough = bent_triangles(view, rays, triangles, box[:, None], tolerance, tolerance, _in_space, most)
    if not enough:
        warnings.warn(unresolved("what is seen on bent rays is coarser than the tolerance"), InputWarning, stacklevel=2)
    return fine


def _in_space(points: Floats) -> Floats:
    return points


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
    fine = chord_refinement.refined(traces, straight_between, image, how.tolerance, how.budget.points, none[: len(which)])
    there, last = image(fine.lines.points).T, fine.lines.last
    first = np.flatnonzero(~last)
    own = np.repeat(np.arange(len(which)), np.diff(np.flatnonzero(last), prepend=-1) - 1)
    kept = np.isfinite(there[0, first]) & np.isfinite(there[0, first + 1])
    first, own = first[kept], which[own[kept]]
    found = straight_lines(there[:, first], there[:, first + 1], lines.kind[own], lines.item[own], np.zeros_like(own))
    return replace(found, smooth=np.ones(len(own), dtype=np.bool_), lamp=lines.lamp[own])


@dataclass(frozen=True, eq=False)
class Seeming:
    """A scene where it seems to be: view, and its faces in the image, triangles among them its own; lines: of it; nobody
    knows what is solid."""

    view: View
    faces: ProjectedFaces
    triangles: Triangles
    lines: Lines

    def seen(self, hidden: str) -> Visibility:
        """Which parts of the lines are seen, or, with a word of draw for hidden lines, by how many items hidden."""
        pipeline = Pipeline(plan_draw(Scene(()), frozenset(), hidden, 0.0), None, None)
        return seen_parts(pipeline, self.view, self.faces, np.zeros(len(self.view.occludes), dtype=np.bool_), self.lines)


def seeming(
    things: Things, rays: BentRays, box: Floats, window: Window | None, how: Depth, before: Sequence[Triangles] = ()
) -> Seeming:
    """What rays show of things in a window of the image, box (4,) or larger; before: other triangles that only hide,
    the sources being their items."""
    view = things.view
    own, items = bent_faces(things, rays, box, how), len(view.occludes)
    parts = [own, *(replace(one, source=one.source + items, outer=np.zeros_like(one.outer)) for one in before)]
    every = records.joined(parts)
    mixed = _view_of_triangles(view, every, np.tile(view.occludes, 2 if before else 1))
    faces = project_faces(mixed)
    outlined = np.concatenate([things.outlined, np.zeros(len(mixed.occludes) - items, dtype=np.bool_)])
    lines = joined_lines([_edges(mixed, faces, every, outlined), bent_lines(view, rays, things.lines, how)])
    lines = in_window(mixed, lines, window)
    return Seeming(mixed, faces, own, replace(lines, aside=_aside(mixed, lines, ASIDE * how.tolerance)))


def _view_of_triangles(view: View, triangles: Triangles, occludes: Bools) -> View:
    """The view of triangles whose sources are items; equal corners of one item are one."""
    points = triangles.corners.transpose(0, 2, 1).reshape(3, -1)
    rows = np.concatenate([np.repeat(triangles.source, 3)[None], points + 0.0])
    number, count = _numbered(rows)
    vertices = np.empty((4, count))
    vertices[:, number] = rows
    return replace(
        view,
        points=np.ascontiguousarray(vertices[1:]),
        corners=number.reshape(-1, 3)[_by_item(triangles)].ravel(),
        offsets=3 * np.arange(len(triangles.source) + 1),
        inner=np.zeros(len(number), dtype=np.bool_),
        face_item=np.sort(triangles.source),
        item_vertices=np.searchsorted(vertices[0], np.arange(len(occludes) + 1)),
        occludes=occludes,
        face_look=None,
    )


def _by_item(triangles: Triangles) -> Ints:
    return np.argsort(triangles.source, kind="stable")


def _edges(view: View, faces: ProjectedFaces, triangles: Triangles, outlined: Bools) -> Lines:
    """The sides of triangles that are lines or contours, each once."""
    outer = triangles.outer[:, _by_item(triangles)].T.ravel()
    side = np.flatnonzero(outer)
    a, b, item = view.corners[side], view.corners[view.after(side)], view.face_item[side // 3]
    of_all = Faces(view.points, view.corners, view.offsets, view.inner, faces.facing)
    edges = mesh_edges(of_all, {LineKind.CONTOUR}, 180.0)
    edges = records.take(edges, outlined[view.face_item[edges.face]])
    a, b = np.concatenate([a, edges.start]), np.concatenate([b, edges.end])
    item = np.concatenate([item, view.face_item[edges.face]])
    _, first = np.unique(np.minimum(a, b) * view.points.shape[1] + np.maximum(a, b), return_index=True)
    a, b, item = a[first], b[first], item[first]
    kind = np.full(len(first), int(LineKind.CONTOUR))
    lines = straight_lines(view.points[:, a], view.points[:, b], kind, item, np.zeros_like(item))
    return replace(lines, smooth=np.ones(len(first), dtype=np.bool_))


def _aside(view: View, lines: Lines, length: float) -> Floats:
    """(3,n) ways of some length from lines towards the eye."""
    if view.eye is None:
        return np.tile([[0.0], [0.0], [length]], len(lines))
    return np.asarray(length * normalize((view.eye[:, None] - 0.5 * (lines.start + lines.end)).T).T)
