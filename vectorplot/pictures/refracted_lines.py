"""The lines that are seen bent: in transparent convex solids, and behind them.

Parallel rays are parallel behind a plane that bends them: what is seen through a face of a solid is a parallel picture
again, in another direction, of what the solid holds; and through the face by which rays leave, one of what is behind
it. Each is drawn as any other picture, exact curves of smooth surfaces among it, and each of its lines is seen in its
face as lines are in mirrors. In a perspective things have places where they seem to be, see bent_lines: through each
face by which rays enter, and each by which they leave, others.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.cuts import between
from vectorplot.effects.glass import Solid, beams_of, refracting_items
from vectorplot.effects.mirrors import Mirrors, mirrors_of
from vectorplot.effects.refraction import SightWays, Soup, bent, refracted
from vectorplot.errors import InputWarning
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, unresolved
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.geometry.vectors import normalize
from vectorplot.pictures.bent_lines import FACETS, Seeming, Things, seeming, things_of
from vectorplot.pictures.line_sources import LineSources
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.pictures.reflected_lines import (
    Beyond,
    Depth,
    Doubles,
    Window,
    doubles_of,
    in_faces,
    no_doubles,
    nothing_of,
    on_plane,
    seen_beyond,
    shown_lines,
    with_more,
)
from vectorplot.scene.added_lines import default_light
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, pools
from vectorplot.tolerances import CUT_EDGE_OF_EXTENT, EDGE_ON_SINE
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines, items_wanting, kinds_of
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
    if shapes.view.eye is not None:
        return with_more(lines, seen, _in_perspective(shapes, window, how))
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
    more = shown_lines(_with_panes(shapes), _joined(panes), found, LineKind.REFRACTED, window, how)
    return with_more(lines, seen, more)


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


def _with_panes(shapes: LineSources) -> LineSources:
    """The same where refracting solids hide too: what a solid shows behind another one is seen through that only."""
    bends = _bending(shapes)
    view = replace(shapes.view, occludes=shapes.view.occludes | bends)
    return replace(shapes, view=view, solid=shapes.solid | bends)


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


def _with_borders(scene: Scene, kinds: frozenset[LineKind]) -> Scene:
    """A scene of _part with borders looked for wherever intersections of these kinds are: an item cut at the face of
    another one that it pierces only touches that, and meets it in its new border. See _left_out."""
    items = list[Item]()
    for item in scene.items:
        own = kinds_of(item, kinds)
        both = sorted(own | {LineKind.BOUNDARY}) if LineKind.INTERSECTION in own else []
        items.append(replace(item, lines=tuple(kind.word for kind in both)) if both else item)
    return replace(scene, items=tuple(items))


def _left_out(
    view: View, lines: Lines, how: Depth, kinds: frozenset[LineKind], normals: Floats, points: Floats
) -> Bools:
    """(n,) which lines of _with_borders are borders that nobody wants: those made by cuts, but for
    intersections with faces of something opaque, and others where no borders are asked for."""
    ends = [view.world_of(side) for side in (lines.start, lines.end)]
    made, off = np.zeros(len(lines), dtype=np.bool_), CUT_EDGE_OF_EXTENT * view.scale
    for normal, point in zip(normals, points, strict=True):
        heights = matmul(how.corners - point, normal)
        crossed: Bools = np.any(heights > off, axis=1) & np.any(heights < -off, axis=1)
        made |= crossed[lines.item] & np.logical_and(*(np.abs(matmul(end - point, normal)) <= off for end in ends))
    border = np.asarray(lines.kind == LineKind.BOUNDARY)
    which = np.flatnonzero(made & border)
    meet = np.zeros(len(lines), dtype=np.bool_)
    meet[which] = _on_opaque(how, 0.5 * (ends[0][which] + ends[1][which]), lines.item[which], off)
    asked, met = (
        items_wanting(kind, how.scene, kinds)[lines.item] for kind in (LineKind.BOUNDARY, LineKind.INTERSECTION)
    )
    return border & ~np.where(made, meet & met, asked)


def _on_opaque(how: Depth, points: Floats, item: Ints, off: float) -> Bools:
    """(n,) which points (n,3) of items (n,) are no farther off than this from faces of other meshes that are opaque."""
    found = np.zeros(len(points), dtype=np.bool_)
    if not len(points):
        return found
    opaque = np.array([isinstance(one.shape, Mesh) and one.material.opacity >= 1.0 for one in how.scene.items])
    low, high = how.corners.min(axis=1) - off, how.corners.max(axis=1) + off
    near = np.flatnonzero(opaque & ((low <= points.max(axis=0)) & (high >= points.min(axis=0))).all(axis=1))
    pool = pools(Scene(tuple(how.scene.items[k] for k in near.tolist())))
    which, face = PlacedTriangles(Mesh(pool.points, pool.corners, pool.offsets)).faces_at(points, off)
    found[which[near[pool.face_item[face]] != item[which]]] = True
    return found


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
    scene = _with_borders(_part(how, inwards, points, view.tolerance * view.scale), shapes.kinds)
    sources, lines, seen = bend.seen(shapes, scene, finer)
    gone = _left_out(sources.view, lines, how, shapes.kinds, inwards, points)
    seen = records.take(seen, ~gone[seen.segment])
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


# Lines that are seen bent in a perspective.


def _in_perspective(shapes: LineSources, window: Window | None, how: Depth) -> Lines:
    """What refracting solids show of lines."""
    view = shapes.view
    found, panes, left = list[Doubles](), list[Mirrors](), how.most
    for item in in_turn(np.flatnonzero(_bending(shapes)).tolist()):
        solid = Solid.of(view, item, shapes.scene.items[item].material.refraction)
        own = mirrors_of(view, solid.face[shapes.faces.facing[solid.face] > 0])
        first = sum(map(len, panes))
        for doubles in _Glass(shapes, item, solid, own, how).doubles(left):
            found.append(replace(doubles, mirror=doubles.mirror + first))
            left -= 1
        panes.append(own)
    return shown_lines(_with_panes(shapes), _joined(panes), found, LineKind.REFRACTED, window, how)


@dataclass(frozen=True, eq=False)
class _Glass:
    """A refracting solid in a perspective, its item, and the planes of its faces that the eye sees."""

    shapes: LineSources
    item: int
    solid: Solid
    panes: Mirrors
    how: Depth

    def doubles(self, most: int) -> Iterator[Doubles]:
        """What is seen through each pane in the solid, and then through each other plane of its faces behind it, so
        many in all."""
        panes, held, shown = self.panes, self._held(), dict[int, Seeming]()
        for number in range(min(len(panes), most)):
            rays, box = self.solid.sight_ways(self._faces(number)[:1]), self._box(number)
            shown[number] = seeming(held, rays, box, _corners(box), self.how)
            seen = shown[number].seen(self.how.hidden)
            yield doubles_of(self._view, panes, number, _unmoved, shown[number].view, shown[number].lines, seen)
        left = most - len(panes)
        ways, faces = self._ways()
        for back, beams in ways.items() if left > 0 else ():
            behind = self._behind(faces == back)
            for number, leaves, box in beams[: max(left, 0)] if len(behind) else ():
                yield self._through(number, np.flatnonzero(faces == back), leaves, box, behind, shown[number])
            left -= len(beams) if len(behind) else 0
        if left < 0 or most <= len(panes):
            _tell_what_is_left()

    @property
    def _view(self) -> View:
        return self.shapes.view

    def _faces(self, number: int) -> Ints:
        """The numbers in the solid of the faces in a pane."""
        return np.asarray(np.searchsorted(self.solid.face, self.panes.face[self.panes.plane == number]))

    def _box(self, number: int) -> Floats:
        """(4,) the box of a pane in the image."""
        box = self.shapes.faces.box[:, self.solid.face[self._faces(number)]].astype(np.float64)
        return np.array([box[0].min(), box[1].max(), box[2].min(), box[3].max()])

    def _ways(self) -> tuple[dict[int, list[tuple[int, SightWays, Floats]]], Ints]:
        """By the numbers of the planes by which rays leave the solid: by which panes they enter, how they go, and the
        box (4,) in which they are seen; and the numbers of the planes of all faces."""
        fronts = np.concatenate([np.zeros(0, dtype=np.intp), *(self._faces(k) for k in range(len(self.panes)))])
        pane = np.repeat(np.arange(len(self.panes)), [len(self._faces(k)) for k in range(len(self.panes))])
        boxes = self.shapes.faces.box[:, self.solid.face[fronts]].astype(np.float64)
        every, plane = mirrors_of(self._view, self.solid.face), np.full(len(self.solid.face), -1)
        plane[np.searchsorted(self.solid.face, every.face)] = every.plane
        found = dict[int, list[tuple[int, SightWays, Floats]]]()
        for beams in beams_of(self._view, self.solid, fronts, boxes):
            both = np.stack([plane[beams.back], pane[beams.front]])
            pairs, pair = np.unique(both, axis=1, return_inverse=True)
            for number, (back, front) in enumerate(pairs.T.tolist()):
                own = np.flatnonzero(pair == number)
                if back >= 0 and back != plane[self._faces(front)[0]]:
                    box = beams.box[:, own]
                    whole = np.array([box[0].min(), box[1].max(), box[2].min(), box[3].max()])
                    found.setdefault(back, []).append((front, beams.leaves.with_guides_of(own), whole))
        return found, plane

    def _held(self) -> Things:
        """What there is in the solid."""
        view, planes, kinds = self._view, self.solid.planes, self.shapes.kinds
        inwards, points = matmul(view.axes.T, -planes[:3]).T, view.world_of(planes[:3] * planes[3])
        scene = _with_borders(_part(self.how, inwards, points, view.tolerance * view.scale), kinds)

        def left_out(view: View, lines: Lines) -> Bools:
            return _left_out(view, lines, self.how, kinds, inwards, points)

        return things_of(self.shapes, scene, self.how, FACETS, left_out)

    def _behind(self, faces: Bools) -> Things:
        """What there is behind some faces of the solid, all in one plane; what lies in that is in the solid too."""
        view, plane, kinds = self._view, self.solid.planes[:, int(np.argmax(faces))], self.shapes.kinds
        outwards, base = matmul(view.axes.T, plane[:3])[None], view.world_of((plane[:3] * plane[3])[:, None])
        scene = _part(self.how, outwards, base, view.tolerance * view.scale)
        items = (nothing_of(one) if k == self.item else one for k, one in enumerate(scene.items))

        def left_out(view: View, lines: Lines) -> Bools:
            low = np.maximum(*(matmul(plane[:3], side) - plane[3] for side in (lines.start, lines.end)))
            in_plane: Bools = np.asarray(low <= CUT_EDGE_OF_EXTENT)
            return in_plane | _left_out(view, lines, self.how, kinds, outwards, base)

        return things_of(self.shapes, replace(scene, items=tuple(items)), self.how, FACETS, left_out)

    def _through(
        self, number: int, faces: Ints, leaves: SightWays, box: Floats, behind: Things, held: Seeming
    ) -> Doubles:
        """What is seen behind the solid through a pane and some of its faces, hidden by what it holds."""
        view, panes, how = self._view, self.panes, self.how
        shown = seeming(behind, leaves, box, _corners(box), how, held.triangles)
        outlines = self.solid.outlines(faces)
        outlines = outlines.on_ways(np.arange(len(faces)), np.zeros_like(faces))
        rays = self.solid.sight_ways(self._faces(number)[:1])
        window = bent(view, rays, outlines, self._box(number)[:, None], how.tolerance)
        seen = _in_outline(view, panes, number, window, shown, shown.seen(how.hidden))
        return doubles_of(view, panes, number, _unmoved, shown.view, shown.lines, seen)


def _unmoved(points: Floats) -> Floats:
    return points


def _corners(box: Floats) -> Window:
    """A box (4,) as a window."""
    return box[[0, 2]], box[[1, 3]]


def _in_outline(view: View, panes: Mirrors, number: int, outline: Soup, shown: Seeming, seen: Visibility) -> Visibility:
    """What is seen of lines through the image of convex polygons in a pane."""
    ends = shown.lines.ends(shown.view, seen.segment, seen.low, seen.high)
    (here, near), (there, far) = (on_plane(view, panes, number, side) for side in ends)
    corners, _ = on_plane(view, panes, number, outline.points)
    flat = replace(view, points=corners, corners=np.arange(corners.shape[1]), offsets=outline.offsets)
    part, low, high = in_faces(flat, np.arange(len(outline)), panes.normal[:, number], here, there)
    begin, length = seen.low[part], (seen.high - seen.low)[part]
    low, high = (share * far[part] / (share * far[part] + (1.0 - share) * near[part]) for share in (low, high))
    return Visibility(seen.segment[part], begin + low * length, begin + high * length, seen.hidden_by[part])
