"""The lines that plane mirrors show: those of the scene as the mirrored eye sees it, in the windows that mirrors are.

What an eye sees in a mirror, the mirrored eye sees beyond the mirror's plane: its contours, its isophotes in the light
as it is, what hides what. A line is seen where the point of the mirror is that shows it: a double, joined with the eye,
meets the plane of the mirror in a segment, and that is a line like others, on a face of the scene.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.cuts import before_plane
from vectorplot.effects.mirrors import Mirrors, mirror_faces, mirrors_of
from vectorplot.errors import InputWarning
from vectorplot.geometry import intervals, ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.budget import Budget, in_turn, unresolved
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.pictures.line_sources import LineSources, balls, traceable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.scene.added_lines import default_light
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import NOTHING, View, view_of
from vectorplot.tolerances import CUT_EDGE_OF_EXTENT
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines, in_window, straight_lines
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind

Window = tuple[Floats, Floats]
"""A rectangle of the image plane, from one corner (2,) to the other."""

WIDER = 0.02
"""Boxes around smooth surfaces are taken so much of their extent wider: they are known to a thousandth."""


@dataclass(frozen=True, eq=False)
class Doubles(Elements):
    """Straight lines (n,) as they are seen in mirrors and other panes, in the view. start, end (3,n): where they seem
    to be; here, there (3,n): where panes show their ends; nearer (2,n): after which part of the ways to these; item
    (n,): whose they are; smooth (n,): chords of curves; hidden_by (n,): how many items hide them; mirror (n,).
    """

    start: Floats = field(metadata=IN_COLUMNS)
    end: Floats = field(metadata=IN_COLUMNS)
    here: Floats = field(metadata=IN_COLUMNS)
    there: Floats = field(metadata=IN_COLUMNS)
    nearer: Floats = field(metadata=IN_COLUMNS)
    item: Ints
    smooth: Bools
    hidden_by: Ints
    mirror: Ints

    def __len__(self) -> int:
        return len(self.item)


@dataclass(frozen=True)
class Depth:
    """How far lines are followed into mirrors. scene: of the picture, of which each mirror shows what is before it;
    corners (i,8,3): see corners_of; reflections: so many times from mirror to mirror; most: mirrors that are looked
    into; hidden: whether hidden lines are wanted too, a word of draw; tolerance: of chords, in the image."""

    scene: Scene
    corners: Floats
    reflections: int
    most: int
    hidden: str
    crease_angle_deg: float
    tolerance: float
    budget: Budget

    def beyond(self, mirrors: int) -> Depth:
        """What is left of it in each of some mirrors of one view."""
        left = max(self.most - mirrors, 0) // max(mirrors, 1)
        return replace(self, reflections=self.reflections - 1, most=left)


# What of a scene a mirror may show, and the eye behind it.


def mirrored_projection(view: Projection, normal: Floats, point: Floats) -> Projection:
    """The projection of the eye behind a mirror with a unit normal (3,) and a point (3,) in the view: what it has at
    (x, y, z) is seen by the eye in front of the mirror as a double at (-x, y, z). Source: Glaeser, section 6.4."""
    axis, base = matmul(view.axes.T, normal), view.world_of(point[:, None])[0]
    turned = view.axes - 2.0 * normal[:, None] * axis
    flip = np.array([-1.0, 1.0, 1.0])
    return Projection(
        eye=None if view.eye is None else flip * view.eye,
        target=flip * view.target,
        focus=view.focus,
        near=view.near,
        picture_height=view.picture_height,
        tolerance=view.tolerance,
        centre=view.centre - 2.0 * float(matmul(axis, view.centre - base)) * axis,
        scale=view.scale,
        axes=flip[:, None] * turned,
    )


def _before(
    how: Depth, view: View, mirrors: Mirrors, number: int, behind: Projection, window: Window | None
) -> Scene | None:
    """What of a scene the eye behind a mirror may see in a window; items keep their numbers. None where that is
    nothing."""
    normal, base = matmul(view.axes.T, mirrors.normal[:, number]), view.world_of(mirrors.point[:, number, None])[0]
    tolerance = view.tolerance * view.scale
    reached = (matmul(how.corners - base, normal) > tolerance).any(axis=1) & _may_be_seen(how.corners, behind, window)
    items = [
        before_plane(item, normal, base, tolerance) if may else nothing_of(item)
        for item, may in zip(how.scene.items, reached.tolist(), strict=True)
    ]
    lights = how.scene.lights or (default_light(view),)
    return replace(how.scene, items=tuple(items), lights=lights) if reached.any() else None


def nothing_of(item: Item) -> Item:
    """An item in the place of another one that shows nothing."""
    return replace(item, shape=NOTHING, patterns=(), added_edges=None)


def _may_be_seen(corners: Floats, projection: Projection, window: Window | None) -> Bools:
    """(i,) whether boxes, of which these are the corners (i,8,3), reach into a window, as far as that can be told."""
    known = ~np.isnan(corners[:, 0, 0])
    if window is None:
        return known
    points = projection.points_of(corners.reshape(-1, 3))
    near = (projection.depth_of(points) <= projection.near).reshape(-1, 8).any(axis=1)
    image = projection.image_of(points).reshape(2, -1, 8)
    inside = (image.max(axis=2) >= window[0][:, None]) & (image.min(axis=2) <= window[1][:, None])
    return np.asarray(known & (near | inside.all(axis=0)))


def corners_of(scene: Scene) -> Floats:
    """(i,8,3) the corners of boxes around what items show in mirrors; NaN where that is nothing."""
    return np.array([box_corners(_box_of(item)) for item in scene.items]).reshape(-1, 8, 3)


def _box_of(item: Item) -> Floats:
    nothing = np.full((2, 3), np.nan)
    if is_annotation(item):
        return nothing
    low, high = item.mesh.bounds if isinstance(item.shape, Mesh) and len(item.mesh.vertices) else nothing
    if not isinstance(item.shape, Mesh):
        low, high = smooth_bounds(item.shape)
        wider = WIDER * float((high - low).max())
        low, high = low - wider, high + wider
    if item.added_edges is not None and len(item.added_edges):
        ends = item.added_edges.reshape(-1, 3)
        low, high = np.fmin(low, ends.min(axis=0)), np.fmax(high, ends.max(axis=0))
    return np.stack([low, high])


# Which mirrors are looked into.


def _looked_into(shapes: LineSources, window: Window | None, most: int) -> tuple[Mirrors, list[int], int]:
    """The mirrors of a view, those among them that are looked into, and how many more there are: those that take up
    most of a window of the image come first."""
    view, faces = shapes.view, shapes.faces
    face = mirror_faces(shapes.scene, view)
    seen = mirrors_of(view, face[faces.facing[face] > 0])
    box = faces.box[:, seen.face].astype(np.float64)
    if window is not None:
        (left, low), (right, high) = window
        box = np.stack(
            [np.maximum(box[0], left), np.minimum(box[1], right), np.maximum(box[2], low), np.minimum(box[3], high)]
        )
    wide, tall = box[1] - box[0], box[3] - box[2]
    area = np.bincount(seen.plane, np.where((wide > 0.0) & (tall > 0.0), wide * tall, 0.0), len(seen))
    order = np.argsort(-area, kind="stable")
    order = order[area[order] > 0.0]
    return seen, order[:most].tolist(), max(len(order) - most, 0)


def _window_of(view: View, faces: Ints, within: Window | None) -> Window | None:
    """The rectangle of the image that faces are in, as far as it is in another one; None where they reach too near."""
    corner, _ = ragged.take(view.offsets, faces)
    points = view.points[:, view.corners[corner]]
    if (view.depth_of(points) <= view.near).any():
        return within
    image, margin = view.image_of(points), 10.0 * view.tolerance
    low, high = image.min(axis=1) - margin, image.max(axis=1) + margin
    return (low, high) if within is None else (np.maximum(low, within[0]), np.minimum(high, within[1]))


# The lines of doubles, and where mirrors show them.


def no_doubles() -> Doubles:
    """None at all."""
    ends, none = np.zeros((3, 0)), np.zeros(0, dtype=np.intp)
    return Doubles(ends, ends, ends, ends, ends[:2], none, none.astype(np.bool_), none, none)


@dataclass(frozen=True, eq=False)
class Beyond:
    """What is seen in a pane: a scene, the projection of the eye that sees it there, the window of the image in which
    it does, and where points (3,n) of that projection seem to be to the eye before the pane."""

    scene: Scene
    projection: Projection
    window: Window | None
    moved: Callable[[Floats], Floats]


def _doubles(shapes: LineSources, mirrors: Mirrors, number: int, window: Window | None, how: Depth) -> Doubles:
    """All that a mirror shows, as if nothing stood before it and it had no end but that of a window of the image."""
    view = shapes.view
    window = _window_of(view, mirrors.face[mirrors.plane == number], window)
    behind = mirrored_projection(view, mirrors.normal[:, number], mirrors.point[:, number])
    seen_in = None
    if window is not None:
        (left, low), (right, high) = window
        seen_in = np.array([-right, low]), np.array([-left, high])
    scene = _before(how, view, mirrors, number, behind, seen_in)
    if scene is None:
        return no_doubles()
    sources, lines, seen = seen_beyond(shapes, Beyond(scene, behind, seen_in, _flipped), how)
    if how.reflections:
        lines, seen = with_reflections(sources, lines, seen, seen_in, how)
    return doubles_of(view, mirrors, number, _flipped, sources.view, lines, seen)


def _flipped(points: Floats) -> Floats:
    return np.array([[-1.0], [1.0], [1.0]]) * points


def seen_beyond(shapes: LineSources, beyond: Beyond, how: Depth) -> tuple[LineSources, Lines, Visibility]:
    """The lines beyond a pane and what is seen of them there, with what they are traced on."""
    view = view_of(beyond.scene, beyond.projection)
    pipeline = Pipeline(plan_draw(beyond.scene, shapes.kinds, how.hidden, 0.0), None, None)
    faces, wanted = project_faces(view), (shapes.kinds, how.crease_angle_deg, how.budget)
    sources = traceable(pipeline, beyond.scene, view, faces, *wanted)
    lines = sources.before_balls(in_window(view, sources.lines(how.tolerance, how.budget), beyond.window))
    return sources, lines, sources.seen(lines)


def doubles_of(
    view: View,
    panes: Mirrors,
    number: int,
    moved: Callable[[Floats], Floats],
    behind: View,
    lines: Lines,
    seen: Visibility,
) -> Doubles:
    """What is seen of the lines of the view behind a pane, where it seems to be, see Beyond."""
    start, end = map(moved, lines.ends(behind, seen.segment, seen.low, seen.high))
    some = lines.take(seen.segment)
    (here, near), (there, far) = (on_plane(view, panes, number, side) for side in (start, end))
    nearer, pane = np.stack([near, far]), np.full(len(seen), number)
    found = Doubles(start, end, here, there, nearer, some.item, some.smooth, seen.hidden_by, pane)
    # What lies in the plane of the pane is seen as itself.
    off = np.maximum(*(np.abs(panes.heights(number, side)) for side in (start, end)))
    return found.take(off > CUT_EDGE_OF_EXTENT)


def on_plane(view: View, mirrors: Mirrors, number: int, points: Floats) -> tuple[Floats, Floats]:
    """(3,n) where the rays to points (3,n) behind a mirror meet its plane, and after which part of their way (n,)."""
    height = np.minimum(mirrors.heights(number, points), 0.0)
    if view.eye is None:
        way = np.array([[0.0], [0.0], [1.0]])
        return np.asarray(points - way * (height / mirrors.normal[2, number])), np.ones(len(height))
    eye = view.eye[:, None]
    above = mirrors.heights(number, eye)
    share = above / (above - height)
    return np.asarray(eye + (points - eye) * share), share


def in_faces(view: View, faces: Ints, normal: Floats, start: Floats, end: Floats) -> tuple[Ints, Floats, Floats]:
    """What of segments from start to end (3,n) in a plane with a unit normal (3,) is in convex faces there: of which
    segment each part is, and (k,) from where to where, 0 to 1."""
    position, offsets = ragged.take(view.offsets, faces)
    corners = view.points[:, view.corners[position]]
    sides = corners[:, ragged.following(offsets)] - corners
    inwards = cross(np.broadcast_to(normal[:, None], sides.shape), sides)
    first, sizes = offsets[:-1], np.diff(offsets)
    middle = np.repeat(np.add.reduceat(corners, first, axis=1) / sizes, sizes, axis=1)
    length = np.copysign(np.sqrt(dot(inwards, inwards)), dot(inwards, middle - corners))
    inwards = inwards / np.where(length != 0.0, length, 1.0)
    margin = view.tolerance
    boxes = (np.minimum.reduceat(corners, first, axis=1) - margin, np.maximum.reduceat(corners, first, axis=1) + margin)
    line, face = overlapping_boxes(np.minimum(start, end), np.maximum(start, end), *boxes)
    counts = sizes[face]
    pair, side = ragged.owner(counts), ragged.ranges(offsets[face], counts)
    way, base = inwards[:, side], corners[:, side]
    here, there = (dot(way, points[:, line[pair]] - base) for points in (start, end))
    here, there = (np.where(np.abs(one) <= margin, 0.0, one) for one in (here, there))
    crossing = here * there < 0.0
    share = here / np.where(crossing, here - there, 1.0)
    low = np.where(crossing & (here < 0.0), share, 0.0)
    high = np.where(crossing & (here > 0.0), share, 1.0)
    high = np.where((here <= 0.0) & (there <= 0.0) & ((here < 0.0) | (there < 0.0)), -1.0, high)
    if not len(pair):
        return line, np.zeros(0), np.zeros(0)
    starts = ragged.starts(counts)
    low, high = np.maximum.reduceat(low, starts), np.minimum.reduceat(high, starts)
    kept = np.flatnonzero(low < high)
    gap = np.full(start.shape[1], margin)
    return intervals.union(line[kept], low[kept], high[kept], gap)


def _in_windows(view: View, mirrors: Mirrors, doubles: Doubles) -> Lines:
    """Where panes show doubles, as lines on their faces; the item of each is the number of its double."""
    parts = []
    for number in np.unique(doubles.mirror).tolist():
        own = np.flatnonzero(doubles.mirror == number)
        start, end = doubles.here[:, own], doubles.there[:, own]
        faces = mirrors.face[mirrors.plane == number]
        line, low, high = in_faces(view, faces, mirrors.normal[:, number], start, end)
        along = (end - start)[:, line]
        begin, stop = start[:, line] + low * along, np.where(high < 1.0, start[:, line] + high * along, end[:, line])
        kind = np.full(len(line), int(LineKind.REFLECTED))
        parts.append(straight_lines(begin, stop, kind, own[line], np.zeros_like(line)))
    none = np.zeros(0, dtype=np.intp)
    return records.joined((straight_lines(np.zeros((3, 0)), np.zeros((3, 0)), none, none, none), *parts))


def _seen_windows(shapes: LineSources, lines: Lines, window: Window | None, how: Depth) -> Lines:
    """The parts of lines on mirrors before which nothing stands."""
    scene = replace(shapes.scene, items=tuple(replace(item, lines=()) for item in shapes.scene.items))
    pipeline, nothing = Pipeline(plan_draw(scene, frozenset(), "none", 0.0), None, None), frozenset[LineKind]()
    bodies = balls(pipeline, scene, shapes.view, nothing)
    alone = replace(shapes, pipeline=pipeline, scene=scene, kinds=nothing, straight=lines, balls=bodies)
    every = alone.lines(how.tolerance, how.budget)
    framed = alone.before_balls(in_window(shapes.view, every.take(every.kind == LineKind.REFLECTED), window))
    seen = alone.seen(framed)
    return framed.cut(shapes.view, seen.segment, seen.low, seen.high)


def _as_seen(doubles: Doubles, shown: Lines) -> Lines:
    """The parts of doubles that are shown on mirrors, where they seem to be."""
    some = doubles.take(shown.item)
    along = some.there - some.here
    square = dot(along, along)
    near, far = some.nearer

    def place(points: Floats) -> Floats:
        share = np.clip(dot(points - some.here, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
        weight = share * far / (share * far + (1.0 - share) * near)
        return np.asarray(some.start + weight * (some.end - some.start))

    kind = np.full(len(some), int(LineKind.REFLECTED))
    lines = straight_lines(place(shown.start), place(shown.end), kind, some.item, np.zeros_like(kind))
    return replace(lines, smooth=some.smooth, behind=some.hidden_by)


def shown_lines(
    shapes: LineSources, panes: Mirrors, found: Sequence[Doubles], kind: LineKind, window: Window | None, how: Depth
) -> Lines:
    """What panes show of all that is behind them, as far as it is in them and nothing stands before them, as lines of a
    kind where they seem to be; behind (n,): how many items hide them there."""
    doubles = records.joined([no_doubles(), *found])
    if not len(doubles):
        return straight_lines(np.zeros((3, 0)), np.zeros((3, 0)), *(np.zeros(0, dtype=np.intp) for _ in range(3)))
    lines = shown_doubles(shapes, doubles, _in_windows(shapes.view, panes, doubles), window, how)
    return replace(lines, kind=np.full(len(lines), int(kind)))


def shown_doubles(shapes: LineSources, doubles: Doubles, shown: Lines, window: Window | None, how: Depth) -> Lines:
    """Doubles as far as lines on mirrors, whose items are the numbers of doubles, show them and nothing stands before
    these, as reflected lines where they seem to be."""
    return _as_seen(doubles, _seen_windows(shapes, shown, window, how))


def with_more(lines: Lines, seen: Visibility, more: Lines) -> tuple[Lines, Visibility]:
    """Lines, with what is seen of them, and more lines, hidden by as many items as they say; all of these is seen."""
    if not len(more):
        return lines, seen
    every = records.joined([replace(lines, chords=None), more])
    if lines.chords is not None:
        none, own = np.full(len(more), -1), lines.chords
        ends = (np.concatenate([side, np.full(len(more), at)]) for side, at in ((own.begin, 0.0), (own.end, 1.0)))
        every = replace(
            every, chords=replace(own, chord=np.concatenate([own.chord, none]), begin=next(ends), end=next(ends))
        )
    return every, Visibility(
        np.concatenate([seen.segment, len(lines) + np.arange(len(more))]),
        np.concatenate([seen.low, np.zeros(len(more))]),
        np.concatenate([seen.high, np.ones(len(more))]),
        np.concatenate([seen.hidden_by, more.behind]),
    )


def with_reflections(
    shapes: LineSources, lines: Lines, seen: Visibility, window: Window | None, how: Depth
) -> tuple[Lines, Visibility]:
    """Lines, with what is seen of them, and those that mirrors show.

    window: of the image, that of the picture; how: how far they are followed.
    Warns: InputWarning where more mirrors are seen than the budget allows.
    """
    mirrors, numbers, left = _looked_into(shapes, window, how.most)
    if left:
        # In mirrors in mirrors too it is said from here, and so once.
        warnings.warn(unresolved("there are mirrors that are not looked into for lines"), InputWarning, stacklevel=2)
    within = how.beyond(len(numbers))
    found = [_doubles(shapes, mirrors, number, window, within) for number in in_turn(numbers)]
    return with_more(lines, seen, shown_lines(shapes, mirrors, found, LineKind.REFLECTED, window, how))
