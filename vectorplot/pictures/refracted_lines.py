"""The lines that are seen bent in parallel pictures: in transparent convex solids, and behind them.

Parallel rays are parallel behind a plane that bends them: what is seen through a face of a solid is a parallel picture
again, in another direction, of what the solid holds; and through the face by which rays leave, one of what is behind
it. Each is drawn as any other picture, and each of its lines is seen in its face as lines are in mirrors.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.effects.cuts import between
from vectorplot.effects.glass import refracting_items
from vectorplot.effects.mirrors import Mirrors, mirrors_of
from vectorplot.effects.refraction import refracted
from vectorplot.errors import InputWarning
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, unresolved
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.vectors import normalize
from vectorplot.pictures.line_sources import LineSources
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.pictures.reflected_lines import (
    Beyond,
    Depth,
    Doubles,
    Window,
    doubles_of,
    no_doubles,
    nothing_of,
    seen_beyond,
    shown_lines,
    with_more,
)
from vectorplot.scene.added_lines import default_light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances import CUT_EDGE_OF_EXTENT, EDGE_ON_SINE
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind

ALONG = np.array([0.0, 0.0, -1.0])
"""The way of the rays of a parallel picture, in its view."""

WIDER = 10.0
"""Windows are so many tolerances wider than their panes."""


def beside_glass(shapes: LineSources, lines: Lines) -> Lines:
    """The parts of framed lines that no refracting solid stands before: what is behind one is seen bent, or not."""
    bends = _bending(shapes)
    view = replace(shapes.view, occludes=bends)
    pipeline = Pipeline(plan_draw(Scene(()), frozenset(), "none", 0.0), None, None)
    alone = replace(shapes, pipeline=pipeline, view=view, solid=bends, sheets=(), balls=None)
    seen = alone.seen(lines)
    return lines.cut(shapes.view, seen.segment, seen.low, seen.high)


def with_refractions(
    shapes: LineSources, lines: Lines, seen: Visibility, window: Window | None, how: Depth
) -> tuple[Lines, Visibility]:
    """Lines, with what is seen of them, and those that refracting solids show: of what is in them, and behind them.

    Warns: InputWarning where they have more faces than the budget allows to look through.
    """
    how = replace(how, scene=replace(how.scene, lights=how.scene.lights or (default_light(shapes.view),)))
    found, panes, items = list[Doubles](), list[Mirrors](), np.flatnonzero(_bending(shapes)).tolist()
    for item in items:
        face = np.flatnonzero((shapes.view.face_item == item) & (shapes.faces.facing > 0))
        panes.append(mirrors_of(shapes.view, face))
    every = sum(map(len, panes))
    within, first = how.beyond(every), 0
    for item, fronts in zip(in_turn(items), panes, strict=True):
        for number in range(min(len(fronts), how.most - first)):
            doubles = _inside(shapes, fronts, number, item, within)
            found.append(replace(doubles, mirror=doubles.mirror + first))
        first += len(fronts)
    if every > how.most:
        _tell_what_is_left()
    return with_more(lines, seen, shown_lines(shapes, _joined(panes), found, LineKind.REFRACTED, window, how))


def _in_window(sources: LineSources, panes: Mirrors, window: Window) -> list[int]:
    """The panes whose images reach into a window."""
    left, right, low, high = sources.faces.box[:, panes.face]
    (x, y), (x_end, y_end) = window
    reaches = (right >= x) & (left <= x_end) & (high >= y) & (low <= y_end)
    found: list[int] = np.unique(panes.plane[reaches]).tolist()
    return found


def _tell_what_is_left() -> None:
    text = unresolved("there are faces of glass that are not looked through for lines")
    warnings.warn(text, InputWarning, stacklevel=2)


def _bending(shapes: LineSources) -> Bools:
    """(i,) the items that bend rays."""
    return refracting_items(shapes.scene, shapes.view, shapes.faces)


def _joined(parts: list[Mirrors]) -> Mirrors:
    first = np.cumsum([0, *map(len, parts)])
    return Mirrors(
        np.concatenate([np.zeros((3, 0)), *(part.normal for part in parts)], axis=1),
        np.concatenate([np.zeros((3, 0)), *(part.point for part in parts)], axis=1),
        np.concatenate([np.zeros(0, dtype=np.intp), *(part.face for part in parts)]),
        np.concatenate([np.zeros(0, dtype=np.intp), *(part.plane + n for part, n in zip(parts, first, strict=False))]),
    )


def _turned(view: Projection, way: Floats) -> Projection:
    """The parallel projection in another direction (3,) of the view."""
    right = normalize(cross(np.eye(3)[np.abs(way).argmin()][:, None], way[:, None])[:, 0])
    back = -way
    up = cross(back[:, None], right[:, None])[:, 0]
    return Projection(
        eye=None,
        target=np.zeros(3),
        focus=view.focus,
        near=view.near,
        picture_height=view.picture_height,
        tolerance=view.tolerance,
        centre=view.centre,
        scale=view.scale,
        axes=matmul(np.stack([right, up, back]), view.axes),
    )


def _part(how: Depth, normals: Floats, points: Floats, tolerance: float) -> Scene:
    """What of the scene is on the sides of all of some planes that unit normals (n,3) lead to from points (n,3) of them
    in the world; items keep their numbers."""
    heights = np.stack([matmul(how.corners - point, normal) for normal, point in zip(normals, points, strict=True)])
    may: Bools = np.all((heights >= -tolerance).any(axis=2), axis=0)
    items = [
        between(item, normals, points, tolerance) if some else nothing_of(item)
        for item, some in zip(how.scene.items, may.tolist(), strict=True)
    ]
    return replace(how.scene, items=tuple(items))


def _made_by_cuts(view: View, lines: Lines, how: Depth, normals: Floats, points: Floats) -> Bools:
    """(n,) which lines are borders that items have only since they were cut at planes as of _part."""
    ends = [view.world_of(side) for side in (lines.start, lines.end)]
    made, off = np.zeros(len(lines), dtype=np.bool_), CUT_EDGE_OF_EXTENT * view.scale
    for normal, point in zip(normals, points, strict=True):
        heights = matmul(how.corners - point, normal)
        crossed: Bools = np.any(heights > off, axis=1) & np.any(heights < -off, axis=1)
        made |= crossed[lines.item] & np.logical_and(*(np.abs(matmul(end - point, normal)) <= off for end in ends))
    return np.asarray(made & (lines.kind == LineKind.BOUNDARY))


@dataclass(frozen=True, eq=False)
class _Bend:
    """A pane at which parallel rays are bent: panes and number: which, its normal to the eye; constant: of the
    refraction; way (3,): of the rays behind it, in the view; projection: along them."""

    view: View
    panes: Mirrors
    number: int
    constant: float
    way: Floats
    projection: Projection

    @classmethod
    def of(cls, view: View, panes: Mirrors, number: int, constant: float) -> _Bend | None:
        """Nothing where no rays go through."""
        normal = panes.normal[:, number]
        way, total = refracted(ALONG, normal, constant)
        if total or min(float(normal[2]), -float(matmul(way, normal))) <= EDGE_ON_SINE:
            return None
        return cls(view, panes, number, constant, way, _turned(view, way))

    @property
    def finer(self) -> float:
        """By how much lines are shorter behind the pane than in the image before it, at most."""
        normal = self.panes.normal[:, self.number]
        return min(1.0, -float(matmul(self.way, normal)) / float(normal[2]))

    @property
    def window(self) -> Window:
        """The rectangle of the image of the rays behind the pane that the pane takes up."""
        corner, _ = ragged.take(self.view.offsets, self.panes.face[self.panes.plane == self.number])
        world = self.view.world_of(self.view.points[:, self.view.corners[corner]])
        image, margin = self.projection.image_of(self.projection.points_of(world)), WIDER * self.view.tolerance
        return image.min(axis=1) - margin, image.max(axis=1) + margin

    def moved(self, points: Floats) -> Floats:
        """Where points (3,n) of the projection seem to be: on the straight rays, as far away as light takes time."""
        there = matmul(matmul(self.view.axes, self.projection.axes.T), points)
        path = self.panes.heights(self.number, there) / float(matmul(self.panes.normal[:, self.number], self.way))
        return there - self.way[:, None] * path + ALONG[:, None] * (path / self.constant)

    def seen(self, shapes: LineSources, scene: Scene, how: Depth) -> tuple[LineSources, Lines, Visibility]:
        """The lines of a scene behind the pane, and what is seen of them there, with what they are traced on."""
        return seen_beyond(shapes, Beyond(scene, self.projection, self.window, self.moved), how)

    def doubles(self, sources: LineSources, lines: Lines, seen: Visibility) -> Doubles:
        """What is seen behind the pane where it seems to be."""
        return doubles_of(self.view, self.panes, self.number, self.moved, sources.view, lines, seen)


def _inside(shapes: LineSources, fronts: Mirrors, number: int, item: int, how: Depth) -> Doubles:
    """All that is seen through one of the front faces of a solid, in it and behind it."""
    view, constant = shapes.view, shapes.scene.items[item].material.refraction
    bend = _Bend.of(view, fronts, number, constant)
    if bend is None:
        return no_doubles()
    sides = mirrors_of(view, np.flatnonzero(view.face_item == item))
    inwards, points = matmul(view.axes.T, -sides.normal).T, view.world_of(sides.point)
    finer = replace(how, tolerance=how.tolerance * bend.finer)
    sources, lines, seen = bend.seen(shapes, _part(how, inwards, points, view.tolerance * view.scale), finer)
    made = _made_by_cuts(sources.view, lines, how, inwards, points)
    seen = records.take(seen, ~made[seen.segment])
    backs = mirrors_of(sources.view, np.flatnonzero((sources.view.face_item == item) & (sources.faces.facing < 0)))
    backs = replace(backs, normal=-backs.normal)
    seen_through = _in_window(sources, backs, bend.window)
    found = [_behind(sources, backs, back, item, finer) for back in seen_through[: how.most]]
    if len(seen_through) > how.most:
        _tell_what_is_left()
    lines, seen = with_more(lines, seen, shown_lines(sources, backs, found, LineKind.REFRACTED, bend.window, finer))
    return bend.doubles(sources, lines, seen)


def _behind(sources: LineSources, backs: Mirrors, number: int, item: int, how: Depth) -> Doubles:
    """All that is seen through one of the faces by which rays leave a solid."""
    view = sources.view
    bend = _Bend.of(view, backs, number, 1.0 / how.scene.items[item].material.refraction)
    if bend is None:
        return no_doubles()
    outwards, base = matmul(view.axes.T, -backs.normal[:, number])[None], view.world_of(backs.point[:, number, None])
    scene = _part(how, outwards, base, view.tolerance * view.scale)
    items = (nothing_of(one) if k == item else one for k, one in enumerate(scene.items))
    finer = replace(how, tolerance=how.tolerance * bend.finer)
    return bend.doubles(*bend.seen(sources, replace(scene, items=tuple(items)), finer))
