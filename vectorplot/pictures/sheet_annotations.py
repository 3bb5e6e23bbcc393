"""Dimensions, centre lines and other annotations of a part on a technical sheet: which view shows them, and where."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.curves.families import Line
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.labels import NO_ITEM
from vectorplot.drawing.sheets import letter_layer, page_strokes
from vectorplot.drawing.title_block import Plain
from vectorplot.errors import InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.io.anything import scene_of
from vectorplot.scene.annotations import (
    CROSS,
    JOG,
    annotation_points,
    centre_line,
    centre_mark,
    dimension,
    is_annotation,
    leader_tips,
    spread,
)
from vectorplot.scene.item import Item
from vectorplot.scene.labels import MEASURE, Along, AtVertex, Label, OnCurve
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import OUTERMOST_OF_EXTENT, ROUND_OF_RADIUS, ZERO_OF_EXTENT

# The round edges of polyhedra, such as the rims of bores and of shafts, and the centre lines they call for.

FEWEST_SIDES = 12
"""A ring of fewer sides is a polygon, not a circle."""

BEYOND = 0.05
"""How far centre lines go on beyond what is round, as a part of the extent of the whole part."""


@dataclass(frozen=True)
class RoundEdge:
    """An edge that is a circle but for the chords of its mesh: across one of the axes (0, 1, 2)."""

    centre: tuple[float, float, float]
    radius: float
    axis: int


def round_edges(mesh: Mesh, crease_angle_deg: float) -> tuple[RoundEdge, ...]:
    """The rings of sharp edges of a mesh that are circles across a coordinate axis.

    Edge cases: rings that other sharp edges meet are none, nor are those of fewer than twelve sides.
    """
    ends = _sharp_edges(mesh, crease_angle_deg)
    if not len(ends):
        return ()
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    vertices, number = np.unique(ends, return_inverse=True)
    number = number.reshape(-1, 2)
    count = len(vertices)
    joined = coo_array((np.ones(len(ends)), (number[:, 0], number[:, 1])), shape=(count, count))
    rings, ring = connected_components(joined, directed=False)
    size = np.bincount(ring, minlength=rings)
    single = np.bincount(ring, np.bincount(number.ravel(), minlength=count) == 2, rings) == size
    points = mesh.vertices[vertices]
    totals = np.stack([np.bincount(ring, column, rings) for column in points.T], axis=1)
    centre = totals / size[:, None]
    away = points - centre[ring]
    order = np.argsort(ring, kind="stable")
    first = np.concatenate([[0], np.cumsum(size)[:-1]])
    reach = np.maximum.reduceat(np.abs(away[order]), first)
    found = []
    for axis in range(3):
        across = np.delete(away, axis, axis=1)
        far = np.hypot(*across.T)
        high, low = np.maximum.reduceat(far[order], first), np.minimum.reduceat(far[order], first)
        zero = ROUND_OF_RADIUS * high
        for k in np.flatnonzero(single & (size >= FEWEST_SIDES) & (reach[:, axis] <= zero) & (high - low <= zero)):
            x, y, z = centre[k].tolist()
            found.append(RoundEdge((x, y, z), float(high[k]), axis))
    return tuple(found)


def centre_lines_of(edges: Sequence[RoundEdge], extent: float) -> tuple[Scene, ...]:
    """The axis of every set of round edges in one line, and the centre mark of the largest of them.

    extent: of the part.
    """
    near = ROUND_OF_RADIUS * extent
    lines: dict[tuple[int, ...], list[RoundEdge]] = {}
    for edge in edges:
        across = [round(place / near) for number, place in enumerate(edge.centre) if number != edge.axis]
        lines.setdefault((edge.axis, *across), []).append(edge)
    found = []
    for same in lines.values():
        largest = max(same, key=lambda edge: edge.radius)
        along = np.eye(3)[largest.axis]
        heights = [edge.centre[largest.axis] for edge in same]
        foot = np.array(largest.centre) * (1.0 - along)
        low, high = min(heights) - BEYOND * extent, max(heights) + BEYOND * extent
        found.append(centre_line(foot + low * along, foot + high * along))
        beyond = min(BEYOND * extent, CROSS * largest.radius)
        found.append(centre_mark(largest.centre, largest.radius, along, beyond=beyond))
    return tuple(found)


def _sharp_edges(mesh: Mesh, angle_deg: float) -> Ints:
    """(k,2) the ends of edges between two faces that meet at a larger angle."""
    ends = np.sort(np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1), axis=1)
    key = ends[:, 0] * np.intp(len(mesh.vertices)) + ends[:, 1]
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    one, other = order[:-1][same], order[1:][same]
    normals: Floats = mesh.face_normals
    cosine = dot(normals[mesh.corner_face[one]], normals[mesh.corner_face[other]])
    sharp: Ints = ends[one[cosine < np.cos(np.radians(angle_deg))]]
    return sharp


# Dimensions and centre lines of a part: which view each belongs to, and those of its whole extent.

OFFSET_MM, DIMENSION_GAP_MM, LINE_BEYOND_MM = 10.0, 1.0, 2.0
"""From the part to a dimension line, to the extension lines, and from the dimension line to their ends."""

TEXT_MM = 6.0
"""What letters beside a dimension line need."""

SHOWN_IN = (("front", "top", "bottom", "back"), ("left", "right", "top", "bottom"), ("front", "left", "right", "back"))
"""The views that show the extent along x, y and z, the best first."""


@dataclass(frozen=True, eq=False)
class Annotation:
    """Lines that belong together, with their labels."""

    scene: Scene

    @cached_property
    def points(self) -> Floats:
        """(n,3) places on its lines."""
        return annotation_points(self.scene)

    @property
    def is_centre(self) -> bool:
        """Whether it is centre lines."""
        return all(item.lines == ("centre",) for item in self.scene.items)

    @property
    def name(self) -> str:
        """What it is called."""
        return self.scene.items[-1].name

    @property
    def is_leader(self) -> bool:
        """Whether it is a leader, which measures nothing."""
        return bool(leader_tips(self.scene))

    @property
    def is_thread(self) -> bool:
        """Whether it is the thin lines of a thread, or its arc."""
        return self.name.startswith(("thread line", "thread arc", "threaded hole line", "threaded hole arc"))

    @property
    def is_mark(self) -> bool:
        """Whether it is the cross in a circle."""
        return self.is_centre and len(self.scene) > 1

    @property
    def is_in_every_view(self) -> bool:
        """Whether every view shows it that it is square to."""
        return self.is_centre or self.is_thread

    @property
    def is_linear(self) -> bool:
        """Whether it is two extension lines and a dimension line."""
        kinds = [item.name.split()[0] for item in self.scene.items]
        return kinds == ["extension", "extension", "dimension"]

    @property
    def is_ordinate(self) -> bool:
        """Whether it is a running dimension."""
        return self.scene.items[0].name.startswith("ordinate ")

    def length_in(self, camera: Camera) -> float:
        """How far it reaches across a view."""
        return float(np.hypot(*np.ptp(matmul(self.points, camera.axes[:2].T), axis=0)))

    @property
    def may_be_of_circle(self) -> bool:
        """Whether it may be a radius or a diameter: it is one line, and no leader and no centre line."""
        return len(self.scene.items) == 1 and not self.is_centre and not self.is_leader

    def axes_among(self, edges: Sequence[RoundEdge]) -> set[int]:
        """The axes of those round edges of which it is a radius or a diameter, wherever along their axis."""
        ends = self.points[[0, -1]]
        found = set()
        for edge in edges if self.may_be_of_circle else ():
            away = np.delete(ends - edge.centre, edge.axis, axis=1)
            zero = ROUND_OF_RADIUS * edge.radius
            begins, middle = (float(np.hypot(*point)) for point in (away[0], 0.5 * away.sum(axis=0)))
            level = abs(float(np.diff(ends[:, edge.axis])[0])) <= zero
            if level and abs(float(np.hypot(*away[1])) - edge.radius) <= zero and min(begins, middle) <= zero:
                found.add(edge.axis)
        return found

    def before(self, camera: Camera, bounds: Floats) -> Scene:
        """It where nothing within bounds (2,3) hides it from a view, at the same place in its picture."""
        if self.name.startswith(("threaded hole", "thread arc")):
            return self.scene
        back = camera.axes[2]
        nearest = float(matmul(bounds.mean(axis=0), back) + matmul(0.5 * np.ptp(bounds, axis=0), np.abs(back)))
        way = max(nearest - float((matmul(self.points, back)).min()), 0.0) * back
        return self.scene.moved(*way.tolist()) if way.any() else self.scene

    def is_square_to(self, camera: Camera, extent: float) -> bool:
        """Whether a view shows all of it in its true shape, and not as a point."""
        seen = matmul(self.points, camera.axes.T)
        zero = ZERO_OF_EXTENT * extent
        return bool(np.ptp(seen[:, 2]) <= zero and np.ptp(seen[:, :2], axis=0).max() > zero)


def written_on(drawing: Drawing) -> Floats:
    """(b,2,2) the boxes of the letters of a drawing, and of arrowheads: smallest and largest coordinates."""
    found = [np.zeros((0, 2, 2))]
    for paths in (paths for layer in drawing.layers if layer.name == "label" for paths in layer.strokes):
        first = paths.offsets[:-1][np.diff(paths.offsets) > 0]
        if len(first):
            ends = [extreme.reduceat(paths.points, first, axis=0) for extreme in (np.minimum, np.maximum)]
            found.append(np.stack(ends, axis=1)[paths.item[np.diff(paths.offsets) > 0] == NO_ITEM])
    for texts in (texts for layer in drawing.layers if layer.name == "label" for texts in layer.texts):
        turn = np.radians(texts.turn_deg)
        along, up = (np.stack([np.cos(way), np.sin(way)], axis=1) for way in (turn, turn + 0.5 * np.pi))
        begin = texts.points - (texts.anchor * texts.room_mm)[:, None] * along
        corners = begin[:, None] + np.stack(
            [0.0 * along, texts.room_mm[:, None] * along, texts.size_mm[:, None] * up], axis=1
        )
        found.append(np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1))
    return np.concatenate(found)


# Parts of an assembly: their balloons, and the rows of their list.
#
# Source: ISO 6433 (item references), ISO 7573 (lists of parts).

BALLOON_MM, BALLOON_LETTERS_MM = 5.0, 3.5
"""The radius of a balloon, and the height of capitals in it."""

BALLOONS_APART_MM, BALLOONS_OFF_MM = 13.0, 11.0
"""From one balloon to the next, and from the view to their middles."""

BALLOONS_ROOM_MM = BALLOONS_OFF_MM + BALLOON_MM
"""What balloons need at the left and the right of a view."""


@dataclass(frozen=True)
class AssemblyPart:
    """A part of an assembly: its name, and the names of the items of each time that it is there."""

    name: str
    pieces: tuple[tuple[str, ...], ...]


def parts_of(scene: Scene) -> tuple[AssemblyPart, ...]:
    """The parts of a scene, in its order: items of one group are one part; those of one shape whose names differ by a
    number at their end are the same part. Curves are none, if there are bodies."""
    bodies = [item for item in scene.items if not is_curve(item.shape)] or list(scene.items)
    pieces: dict[str, list[Item]] = {}
    for item in bodies:
        pieces.setdefault(item.group or item.name, []).append(item)
    alike: dict[tuple[str, ...], list[str]] = {}
    for name, items in pieces.items():
        stem = NUMBERED.sub("", name) or name
        alike.setdefault((stem, *map(_shape_text, items)), []).append(name)
    return tuple(
        AssemblyPart(key[0] if len(names) > 1 else names[0], tuple(tuple(i.name for i in pieces[n]) for n in names))
        for key, names in alike.items()
    )


def part_scenes(scene: object) -> tuple[Scene, ...]:
    """A scene of each part of an assembly, for a sheet of its own.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, or several of these
        See `io.scene_of`. Its items are the parts: those of one group are one part, and those of one shape whose names
        differ by a number at their end are the same part.

    Returns
    -------
    tuple of Scene
        In the order of the list of parts; each has the name of its part as its title, and stands where the first of
        these parts stands.

    Raises
    ------
    InputError
        For what is no scene, and files that cannot be read.

    Notes
    -----
    Curves are no parts, if there are bodies.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> legs = tuple(vp.Item(f"leg {k}", box((1, 1, 9)).moved(k, 0, 0)) for k in (1, 5))
    >>> table = vp.Scene((*legs, vp.Item("top", box((9, 4, 1)).moved(0, 0, 9))))
    >>> [(one.title, len(one)) for one in vp.part_scenes(table)]
    [('leg', 1), ('top', 1)]
    """
    whole = scene_of(scene)
    items = {item.name: item for item in whole.items}
    return tuple(
        replace(whole, items=tuple(items[name] for name in part.pieces[0]), title=part.name, labels=(), explosion=None)
        for part in parts_of(whole)
    )


NUMBERED = re.compile(r"[ _.-]*\d+$")
"""A number at the end of a name."""


def _shape_text(item: Item) -> str:
    """What two items have in common that may be the same part."""
    if isinstance(item.shape, Mesh):
        mesh = item.shape
        sides = mesh.vertices[mesh.corners] - mesh.vertices[mesh.corners[mesh.next_corner]]
        return f"{len(mesh.vertices)} {mesh.face_count} {float(norm(sides).sum()):.5g}"
    return type(item.shape).__name__


def balloon_layers(
    parts: Sequence[AssemblyPart], drawing: Drawing, reach: Floats, middle: tuple[float, float], plain: Plain
) -> tuple[Layer, ...]:
    """The balloons of those parts that a view shows, at its left and right, each with a line to an edge of its part.

    drawing: of the view on the sheet; reach (2,2): how far the view reaches from the middle of the part, which is at a
    place on the sheet; no line crosses another. plain: what sets letters. An InputWarning names the parts that it does
    not show.
    """
    anchors = [(number, _anchor(part, drawing, np.array(middle))) for number, part in enumerate(parts, start=1)]
    shown = [(number, anchor) for number, anchor in anchors if anchor is not None]
    unseen = [part.name for part, (_, anchor) in zip(parts, anchors, strict=True) if anchor is None]
    if unseen:
        text = f"{', '.join(unseen)}: no balloon, for nothing is seen in that view; --explode moves parts apart"
        warnings.warn(text, InputWarning, stacklevel=3)
    if not shown:
        return ()
    from scipy.optimize import linear_sum_assignment

    places = np.array([anchor for _, anchor in shown])
    rows = max(-(-len(shown) // 2), int(float(reach[:, 1].sum()) / BALLOONS_APART_MM) + 1)
    heights = middle[1] + 0.5 * (reach[1, 1] - reach[0, 1]) + BALLOONS_APART_MM * (np.arange(rows) - 0.5 * (rows - 1))
    sides = (middle[0] - reach[0, 0] - BALLOONS_OFF_MM, middle[0] + reach[1, 0] + BALLOONS_OFF_MM)
    slots = np.array([(x, y) for x in sides for y in heights.tolist()])
    away = np.sqrt(((places[:, None] - slots) ** 2).sum(axis=2))
    # The shortest lines together cross nowhere.
    _, chosen = linear_sum_assignment(away)
    lines, heads, rings, letters = [], [], [], []
    for (number, anchor), slot in zip(shown, slots[chosen], strict=True):
        way = normalize(anchor - slot)
        wing = np.array([-way[1], way[0]])
        lines.append(np.array([slot + BALLOON_MM * way, anchor]))
        back = anchor - ARROWHEAD_MM[0] * way
        heads.append(np.array([anchor, back + ARROWHEAD_MM[1] * wing, back - ARROWHEAD_MM[1] * wing, anchor]))
        turn = 2.0 * np.pi * np.arange(64) / 64
        rings.append(slot + BALLOON_MM * np.stack([np.cos(turn), np.sin(turn)], axis=1))
        x, y = slot.tolist()
        letters.append(plain(str(number), (x, y), size_mm=BALLOON_LETTERS_MM, align="centre", level="middle"))
    return (Layer("thin", THIN, (page_strokes(lines, rings),)), letter_layer(letters, heads))


ARROWHEAD_MM = (2.8, 0.5)
"""The length of arrowheads, and half of their width."""

THIN = Pen(0.25)


def _anchor(part: AssemblyPart, drawing: Drawing, middle: Floats) -> Floats | None:
    """(2,) where a view shows an edge of a part: of the piece of which most is seen, amid a line that is farthest at
    the left or the right of the middle of the view, of those that are not much shorter than the longest."""
    pieces = [_edges(piece, drawing) for piece in part.pieces]
    lines = max(pieces, key=lambda some: float(np.hypot(*(some[:, 1] - some[:, 0]).T).sum()))
    if not len(lines):
        return None
    long = np.hypot(*(lines[:, 1] - lines[:, 0]).T)
    places = lines.mean(axis=1)
    far = np.where(long >= LONG_ENOUGH * long.max(), np.abs(places[:, 0] - middle[0]), -1.0)
    return np.asarray(places[int(np.argmax(far))])


def _edges(names: Sequence[str], drawing: Drawing) -> Floats:
    """(k,2,2) the visible edges of some items in a drawing."""
    own = [number for number, name in enumerate(drawing.items) if name in names]
    found = [np.zeros((0, 2, 2))]
    for paths in (paths for layer in drawing.layers if layer.name in BODY_LAYERS for paths in layer.strokes):
        ends = segments(paths)
        whose = np.searchsorted(paths.offsets, ends[:, 0], side="right") - 1
        found.append(paths.points[ends[np.isin(paths.item[whose], own) & (paths.hidden_by[whose] == 0)]])
    return np.concatenate(found)


LONG_ENOUGH = 0.7
"""An edge has a balloon if it is so long, as a part of the longest."""

BODY_LAYERS = ("contour", "boundary", "crease", "intersection", "cut")
"""The layers of edges of bodies."""


def without_annotations(scene: Scene) -> tuple[Scene, tuple[Annotation, ...]]:
    """A part, and its annotations, those of one group together."""
    groups: dict[str, list[Item]] = {}
    for item in filter(is_annotation, scene.items):
        groups.setdefault(item.group or item.name, []).append(item)
    owner = {item.name: name for name, items in groups.items() for item in items}
    labels: dict[str, list[Label]] = {name: [] for name in groups}
    rest: list[Label] = []
    for label in scene.labels:
        named = label.at.item if isinstance(label.at, AtVertex | OnCurve | Along) else ""
        (labels[owner[named]] if named in owner else rest).append(label)
    found = tuple(Annotation(Scene(tuple(items), labels=tuple(labels[name]))) for name, items in groups.items())
    part = replace(scene, items=tuple(item for item in scene.items if not is_annotation(item)), labels=tuple(rest))
    return part, found


def views_of(
    annotations: Sequence[Annotation], cameras: Sequence[Camera], extent: float, edges: Sequence[RoundEdge]
) -> list[list[Annotation]]:
    """The annotations of each view: dimensions in the first one that they are square to, radii and diameters of round
    edges in one that shows their circle, if there is any; centre lines in every one; leaders that are square to none
    where they look longest."""
    found: list[list[Annotation]] = [[] for _ in cameras]
    for one in annotations:
        square = [number for number, camera in enumerate(cameras) if one.is_square_to(camera, extent)]
        if one.is_leader and not square and cameras:
            square = [max(range(len(cameras)), key=lambda number: one.length_in(cameras[number]))]
        round_ = one.axes_among(edges)
        square.sort(key=lambda number: not any(abs(cameras[number].axes[2, axis]) == 1.0 for axis in round_))
        for number in square if one.is_in_every_view else square[:1]:
            found[number].append(one)
    return found


# Dimensions that keep clear of each other in a view.
#
# Source: ISO 129-1 (dimension lines are no closer than letters need), ASME Y14.5 (unidirectional dimensions).

TIER_MM = 8.0
"""From one dimension line to the next, where both run side by side."""

ORDINATE_APART_MM, ORDINATE_MM = 6.0, 14.0
"""How far the measures of a running dimension are from each other, and how long the lines beside them are."""


def clear_of_each_other(notes: Sequence[Annotation], camera: Camera, factor: float) -> list[Annotation]:
    """The annotations of a view, where dimension lines that would be on each other, or closer than their letters are
    high, are moved outwards, the longer ones farther; measures of running dimensions stand apart.

    factor: mm on paper for a unit of the world.
    """
    found = list(notes)
    linear = [number for number, one in enumerate(found) if one.is_linear]
    lines = {number: _dimension_line(found[number], camera) for number in linear}
    placed: list[tuple[Floats, Floats, float, float, float]] = []
    for number in sorted(linear, key=lambda number: lines[number].long):
        line = lines[number]
        place, step = line.place, TIER_MM / factor
        beside = sorted(
            other
            for along, out, low, high, other in placed
            if abs(float(matmul(along, line.along))) > PARALLEL
            and float(matmul(out, line.out)) > PARALLEL
            and min(high, line.high) - max(low, line.low) > OVERLAP_MM / factor
        )
        for other in beside:
            if abs(place - other) < step * CLOSE:
                place = other + step
        placed.append((line.along, line.out, line.low, line.high, place))
        if place != line.place:
            found[number] = _moved_outwards(found[number], camera, (place - line.place) * line.out)
    return [_ordinates_apart(one, factor) if one.is_ordinate else one for one in found]


PARALLEL = 0.999
"""Dimension lines with a larger cosine run side by side."""

OVERLAP_MM = 0.5
"""Dimension lines that are side by side for less are in one row."""

CLOSE = 0.95
"""Lines that are closer than so much of a step are moved."""


@dataclass(frozen=True, eq=False)
class _DimensionLine:
    """A dimension line in a view: its direction and that of its extension lines (2,), from where to where it goes along
    the one, and where it is along the other, in the world."""

    along: Floats
    out: Floats
    low: float
    high: float
    place: float

    @property
    def long(self) -> float:
        """How long it is."""
        return self.high - self.low


def _dimension_line(one: Annotation, camera: Camera) -> _DimensionLine:
    flat = camera.axes[:2]
    (begin, _), (start, end) = (_ends(one.scene.items[k]) for k in (0, 2))
    first, last, foot = (matmul(flat, point) for point in (start, end, begin))
    along = (last - first) / float(np.hypot(*(last - first)))
    # Extension lines are across the line, or slant; it moves along them as they go across.
    across = np.array([-along[1], along[0]])
    out = across if float(matmul(first - foot, across)) >= 0.0 else -across
    if (along < 0.0).all() or along[int(np.argmax(np.abs(along)))] < 0.0:
        along = -along
    low, high = sorted((float(matmul(first, along)), float(matmul(last, along))))
    return _DimensionLine(along, out, low, high, float(matmul(first, out)))


def _ends(item: Item) -> Floats:
    """(2,3) the ends of a line."""
    assert is_curve(item.shape)
    return item.shape.points(np.array([item.shape.start, item.shape.end]))


def _moved_outwards(one: Annotation, camera: Camera, step: Floats) -> Annotation:
    """A dimension with its line farther from the part by a step (2,) in a view, to which its extension lines reach."""
    way = matmul(step, camera.axes[:2])
    items = []
    for number, item in enumerate(one.scene.items):
        begin, end = _ends(item)
        items.append(replace(item, shape=Line.through(begin + (way if number == 2 else 0.0), end + way)))
    return Annotation(replace(one.scene, items=tuple(items)))


def _ordinates_apart(one: Annotation, factor: float) -> Annotation:
    """A running dimension whose measures stand as far apart as their letters need."""
    items = {item.name: item for item in one.scene.items}
    leads = [name for name in items if name.endswith(" lead")]
    feet = np.array([_ends(items[name])[0] for name in leads])
    along = normalize(feet[-1] - feet[0])
    out = normalize(np.diff(_ends(items[leads[0].removesuffix("lead") + "extension"]), axis=0)[0])
    places = matmul(feet - feet[0], along)
    moved = spread(places, ORDINATE_APART_MM / factor) - places
    for name, foot, aside in zip(leads, feet, moved.tolist(), strict=True):
        bend = foot + JOG * ORDINATE_MM / factor * out + aside * along
        end = bend + (1.0 - JOG) * ORDINATE_MM / factor * out
        measure = name.removesuffix("lead") + "measure"
        items[name] = replace(items[name], shape=Line.through(foot, bend))
        items[measure] = replace(items[measure], shape=Line.through(bend, end))
    return Annotation(replace(one.scene, items=tuple(items.values())))


def moved_together(scene: Scene, moved: Callable[[Floats], Floats]) -> Scene:
    """Annotations where points (n,3) of the part have moved; their measures stay what they are.

    Lines go from where their ends are now; other curves move as a whole."""
    items, measures = [], {}
    for item in scene.items:
        ends, points = _ends(item), annotation_points(Scene((item,)))
        long, middle = float(norm(ends[1] - ends[0])), points.mean(axis=0)
        off = norm(cross(points - ends[0], ends[1] - ends[0]))
        if long > 0.0 and float(off.max()) <= ZERO_OF_EXTENT * long * long:
            measures[item.name] = long
            items.append(replace(item, shape=Line.through(*moved(ends))))
        else:
            items.append(item.moved(*(moved(middle[None])[0] - middle).tolist()))
    labels = []
    for label in scene.labels:
        if isinstance(label.at, OnCurve | Along) and label.at.item in measures:
            told = label.measured.replace(MEASURE, f"<{measures[label.at.item]!r}>")
            label = replace(label, measured=told)
        labels.append(label_moved(label, moved))
    return replace(scene, items=tuple(items), labels=tuple(labels))


def label_moved(label: Label, moved: Callable[[Floats], Floats]) -> Label:
    """A label of a point where the point has moved."""
    if not isinstance(label.at, tuple):
        return label
    x, y, z = moved(np.array([label.at]))[0].tolist()
    return replace(label, at=(x, y, z))


def level_measures(scene: Scene, factor: float) -> Scene:
    """Annotations whose measures are level and interrupt their lines, as far as these are long enough.

    factor: mm on paper for a unit of the world.
    """
    items = {item.name: item for item in scene.items}
    labels = []
    for label in scene.labels:
        if isinstance(label.at, Along) and MEASURE in label.measured:
            long = factor * float(norm(np.diff(_ends(items[label.at.item]), axis=0)[0]))
            if long > LEVEL_ROOM * label.capitals_mm * max(len(label.text), 2):
                label = replace(label, at=OnCurve(label.at.item, label.at.part), place="centre")
        labels.append(label)
    return replace(scene, labels=tuple(labels))


LEVEL_ROOM = 1.6
"""How long a line is, at the least, whose measure interrupts it, in heights of a letter for each of its letters."""


@dataclass(frozen=True)
class OverallDimension:
    """The dimension of the whole part along an axis (0, 1, 2), in a view of that name."""

    axis: int
    view: str

    def is_level(self, camera: Camera) -> bool:
        """Whether it runs across the view, and not upwards in it."""
        return bool(abs(camera.axes[0, self.axis]) > abs(camera.axes[1, self.axis]))

    def room_mm(self, camera: Camera) -> Floats:
        """(2,2) what it needs around the part: below it, or at its left."""
        room = np.zeros((2, 2))
        room[0, 1 if self.is_level(camera) else 0] = OFFSET_MM + TEXT_MM
        return room

    def annotation(self, camera: Camera, part: Scene, centre: Floats, factor: float, world: Floats) -> Annotation:
        """It, where a unit of the world is so many mm on paper, beside a part, and beyond all that reaches so far,
        world (2,2), from a centre (3,). Extension lines begin where the part ends."""
        right, up, back = camera.axes
        middle, half = part.bounds.mean(axis=0), 0.5 * np.ptp(part.bounds, axis=0)
        low, high = (middle + sign * half[self.axis] * np.eye(3)[self.axis] for sign in (-1.0, 1.0))
        # Before the part, so that it does not lie in the dimension's way.
        nearest = float(matmul(np.abs(back), half)) * back
        level = self.is_level(camera)
        along, inwards = (right, up) if level else (up, right)
        reach = float(matmul(np.abs(inwards), half))
        start, end = sorted((low + nearest, high + nearest), key=lambda point: float(matmul(point, along)))
        others = float(world[0, 1 if level else 0]) - reach + float(matmul(middle - centre, inwards))
        off = -inwards * (max(others, 0.0) + OFFSET_MM / factor)
        gap, beyond = DIMENSION_GAP_MM / factor, LINE_BEYOND_MM / factor
        made = dimension(start - reach * inwards, end - reach * inwards, off, gap=gap, beyond=beyond)
        lines = []
        for item, point in zip(made.items, (start, end), strict=False):
            begin = point + (self._place(part, point, inwards) - gap) * inwards
            line = Line.through(begin, point - reach * inwards + off * (1.0 + beyond / float(norm(off))))
            lines.append(replace(item, shape=line))
        return Annotation(replace(made, items=(*lines, *made.items[2:])))

    def _place(self, part: Scene, end: Floats, inwards: Floats) -> float:
        """How far inwards from its middle a part comes to an end of it along the axis: where its outermost vertices
        are, or else where the box around it is."""
        middle, extent = part.bounds.mean(axis=0), np.ptp(part.bounds, axis=0)
        near = np.abs(part.vertices[:, self.axis] - end[self.axis]) <= OUTERMOST_OF_EXTENT * extent.max()
        places = matmul(part.vertices[near] - middle, inwards)
        return float(places.min()) if len(places) else -0.5 * float(matmul(np.abs(inwards), extent))


def overall_dimensions(names: Sequence[str], bounds: Floats) -> tuple[OverallDimension, ...]:
    """The dimensions of the whole part, each in one of the views that are named; none along what has no extent."""
    found = []
    for axis, views in enumerate(SHOWN_IN):
        view = next((name for name in views if name in names), None)
        if view is not None and float(np.ptp(bounds[:, axis])) > 0.0:
            found.append(OverallDimension(axis, view))
    return tuple(found)
