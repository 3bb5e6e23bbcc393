"""The verb technical_sheet: views, sections, dimensions and centre lines of a part on one sheet; and turntables."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.batch.running import results
from vectorplot.batch.tasks import Submits
from vectorplot.drawing.dashes import CHAIN_MM, dashed
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.labels import HALO_MM, NO_ITEM
from vectorplot.drawing.layers import PENS as PENS_of_layers
from vectorplot.drawing.letters import lettered
from vectorplot.drawing.sheets import (
    BLOCK_MM,
    DrawingScale,
    Sheet,
    TitleBlock,
    drawing_space,
    frame_layers,
    page_strokes,
)
from vectorplot.drawing.text_along import grown, outside_boxes
from vectorplot.effects.cuts import InSpace, cut, cut_scene
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import VIEWS, Camera, Point
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot
from vectorplot.io.anything import scene_of
from vectorplot.io.mesh_file import stood_up
from vectorplot.pictures.draw import draw
from vectorplot.pictures.pipeline import StageReport, stoppable
from vectorplot.scene.annotations import (
    CROSS,
    annotation_points,
    centre_line,
    centre_mark,
    dimension,
    is_annotation,
    leader_tips,
)
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.item import Item
from vectorplot.scene.labels import Along, AtVertex, Label, OnCurve
from vectorplot.scene.page import MM_PER_INCH, Page
from vectorplot.scene.placement import camera_of, page_of
from vectorplot.scene.scene import Scene, together
from vectorplot.tolerances import ROUND_OF_RADIUS, SAME_PLANE_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.words import check_word, unknown

# Where views of a part stand on a sheet: in line with each other, with the free room spread evenly around them.

THIRD_ANGLE = {"front": (0, 0), "right": (1, 0), "left": (-1, 0), "top": (0, 1), "bottom": (0, -1), "back": (2, 0)}
"""Column and row of main views, rightwards and upwards from the front, where each is on the side it is seen from."""

FIRST_ANGLE = {view: (x if view == "back" else -x, -y) for view, (x, y) in THIRD_ANGLE.items()}
"""The same where each is on the side opposite to that it is seen from."""

PICTORIAL = ((1, -1), (1, 1), (-1, -1), (-1, 1), (1, 0), (0, -1), (-1, 0), (0, 1), (0, 0), (2, 0))
"""Where an isometric view may stand, the best first."""

GAP_MM = 8.0
"""No less is between views, and between them and what is around them."""

Cell = tuple[int, int]


@dataclass(frozen=True, eq=False)
class SheetView:
    """A view on a sheet.

    name: of the main view, or the letter of a section; cell: column and row; world (2,2): how far what it shows reaches
    from the middle of the part, to the left and down, and to the right and up, in units of the world; mm (2,2): how far
    what is around it reaches beyond that.
    """

    name: str
    camera: Camera
    cell: Cell
    world: Floats
    mm: Floats

    def reach_mm(self, factor: float) -> Floats:
        """(2,2) how far it reaches on paper, where a unit of the world is so many mm."""
        return factor * self.world + self.mm


def cells_of(names: Sequence[str], sections: Sequence[str], first_angle: bool) -> dict[str, Cell]:
    """The cells of main views, and of sections, each by the letter and with the main view that it is like.

    sections: that view for each. Empty columns and rows take no room.
    """
    places = FIRST_ANGLE if first_angle else THIRD_ANGLE
    cells = {name: places[name] for name in names if name in places}
    columns, rows = ({cell[axis] for cell in cells.values()} for axis in (0, 1))
    if "iso" in names:
        free = [cell for cell in PICTORIAL if cell not in cells.values()]
        cells["iso"] = min(free, key=lambda cell: (cell[0] not in columns) + (cell[1] not in rows))
    for number, like in enumerate(sections):
        row = cells.get(like, (0, 0))[1]
        # Beyond all that is in its row.
        last = max((x for x, y in cells.values() if y == row), default=-1)
        cells[LETTERS[number]] = (last + 1, row)
    across, upwards = (sorted({cell[axis] for cell in cells.values()}) for axis in (0, 1))
    return {name: (across.index(x), upwards.index(y)) for name, (x, y) in cells.items()}


LETTERS = "ABCDEFGHJKLMNPRSTUVWXYZ"
"""The names of sections, without letters that look like figures."""


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Views in the columns and rows of a space (2,2) on the page, in mm."""

    views: tuple[SheetView, ...]
    space: Floats

    def largest_factor(self) -> float:
        """The largest factor at which all views have room: infinite for views without extent, and negative where there
        is no room at all."""
        factors = [math.inf]
        for axis in (0, 1):
            sizes = self._bands(axis, lambda view: view.world)
            mm = self._bands(axis, lambda view: view.mm)
            left = float(np.ptp(self.space[:, axis])) - (len(sizes) + 1) * GAP_MM - float(mm.sum())
            whole = float(sizes.sum())
            factors.append(left / whole if whole > 0.0 else math.copysign(math.inf, left))
        return min(factors)

    def middles(self, factor: float) -> list[tuple[float, float]]:
        """Where the middle of the part is in every view."""
        found = []
        for axis in (0, 1):
            bands = self._bands(axis, lambda view: view.reach_mm(factor))
            low = float(self.space[0, axis])
            gap = (float(np.ptp(self.space[:, axis])) - float(bands.sum())) / (len(bands) + 1)
            ends = low + gap * np.arange(1, len(bands) + 1) + np.cumsum(bands.sum(axis=1)) - bands[:, 1]
            found.append(ends.tolist())
        return [(found[0][view.cell[0]], found[1][view.cell[1]]) for view in self.views]

    def _bands(self, axis: int, reach: Callable[[SheetView], Floats]) -> Floats:
        """(k,2) how far the columns, or rows, reach to both sides of the middle of the part."""
        cells = np.array([view.cell[axis] for view in self.views])
        most = np.zeros((int(cells.max()) + 1, 2))
        np.maximum.at(most, cells, np.array([reach(view)[:, axis] for view in self.views]))
        return most


def roomiest(page: Page | str, views: tuple[SheetView, ...], frame: bool, below: float) -> tuple[Page, Arrangement]:
    """The sheet, and the views on it; a named one lies as gives them more room. below: the mm below the views that the
    title block takes."""
    given = page_of(page, Scene(()))
    turned = isinstance(page, str) and len(page.split()) == 1 and "x" not in page.lower()
    papers = (given.landscape, given) if turned else (given,)
    above = np.array([(0.0, below), (0.0, 0.0)])
    tried = [(paper, Arrangement(views, drawing_space(paper, frame) + above)) for paper in papers]
    paper, arranged = max(tried, key=lambda pair: pair[1].largest_factor())
    if not arranged.largest_factor() > 0.0:
        taken = " above the title block" if below else ""
        raise InputError(f"page {paper.width_mm:g}x{paper.height_mm:g} mm: no room for {len(views)} views{taken}")
    return paper, arranged


def fitting_scale(asked: DrawingScale | None, arranged: Arrangement, paper: Page) -> DrawingScale:
    """The scale asked for, or the largest standard one that fits. Errors: InputError for one that is too large."""
    room = arranged.largest_factor()
    if asked is None:
        return DrawingScale.largest_standard(room) if math.isfinite(room) else DrawingScale(1.0, 1.0)
    if asked.factor > room:
        largest = DrawingScale.largest_standard(room)
        raise InputError(
            f"scale {asked}: too large for {len(arranged.views)} views on {paper.width_mm:g}x{paper.height_mm:g} mm; "
            f"the largest standard scale that fits is {largest}"
        )
    return asked


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


# Section views on a sheet: where they cut, and the line in another view that says so.
#
# Source: ISO 128-40 (cuts and sections), ISO 128-24 (cutting planes).

SEEN_AS = (("left", "right"), ("front", "back"), ("top", "bottom"))
"""The main views that a section across x, y and z is like, the usual one first."""

TOLD_IN = (("front", "back", "top", "bottom"), ("top", "bottom", "left", "right"), ("front", "back", "left", "right"))
"""The views in which one sees a plane across x, y and z as a line, the best first."""

BEYOND_MM, WIDE_MM = 8.0, 6.0
"""How far a cutting line goes on beyond the part, and how long its wide ends are."""

ARROW_MM, HEAD_MM, SLOPE = 9.0, 4.0, 0.18
"""The lengths of arrows and their heads, and half of the width of heads as a part of their length."""

LETTERS_MM = 5.0
"""The height of the letters of sections."""

ROOM_MM = 14.0
"""What a cutting line needs on each side of the part, and the letters over a section view."""

CLEAR_MM = 15.0
"""Letters within so much of a cutting line are between its ends, and those so far beside a name are below it."""

THIN, WIDE = Pen(0.25), Pen(0.7)


@dataclass(frozen=True)
class SheetSection:
    """A section of a part across an axis (0, 1, 2), called by a letter, like one of the main views."""

    letter: str
    axis: int
    offset: float
    like: str

    @property
    def condition(self) -> str:
        """The plane of the cut in words, whose side of the eye is taken away."""
        return f"{'xyz'[self.axis]} = {self.offset!r}"

    def told_in(self, names: Sequence[str]) -> str | None:
        """The view that shows where it is, of those that are named."""
        return next((name for name in TOLD_IN[self.axis] if name in names), None)

    def line_room_mm(self, camera: Camera) -> Floats:
        """(2,2) what its line needs around the part in a view."""
        return np.tile(np.where(np.abs(camera.axes[:2, self.axis]) > math.sqrt(0.5), 0.5, 1.0) * ROOM_MM, (2, 1))

    def line_layers(
        self,
        camera: Camera,
        sight: Camera,
        bounds: Floats,
        middle: tuple[float, float],
        factor: float,
        room: Floats,
        written: Floats,
    ) -> tuple[Layer, ...]:
        """Layers with its line, arrows and letters in a view that sees its plane edge-on.

        sight: the camera of the section; bounds (2,3): of the part, whose middle is at a place on the page; factor: mm
        on paper for a unit of the world; room (2,2): what is already beside the part, in mm; written (b,2,2): the boxes
        of letters in the view, outside of which its ends are, and before which its line is interrupted.
        """
        across = camera.axes[:2]
        normal = across[:, self.axis]
        along = np.array([abs(normal[1]), abs(normal[0])])
        way = matmul(across, -sight.direction)
        centre, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
        place = np.array(middle) + factor * (self.offset - centre[self.axis]) * normal
        reaches = factor * float(matmul(along, matmul(np.abs(across), half))) + BEYOND_MM + matmul(room, along)
        beside = matmul(written - place, np.where(along > 0.5, 0.0, 1.0))
        near = (beside.min(axis=1) < CLEAR_MM) & (beside.max(axis=1) > -CLEAR_MM)
        far = (matmul(written - place, along))[near]
        reaches = np.maximum(reaches, [_beyond(-far, reaches[0]), _beyond(far, reaches[1])])
        sides = list(zip((-1.0, 1.0), reaches.tolist(), strict=True))
        ends = [place + sign * reach * along for sign, reach in sides]
        inner = [place + sign * (reach - WIDE_MM) * along for sign, reach in sides]
        left = np.array([-way[1], way[0]])
        heads, letters = [], []
        for end in ends:
            back = end - HEAD_MM * way
            wing = HEAD_MM * SLOPE * left
            heads.append(np.array([end - ARROW_MM * way, end, back + wing, back - wing, end]))
            at = end - (ARROW_MM + 0.8 * LETTERS_MM) * way
            letters += _letters(self.letter, at)
        line = dashed(page_strokes([np.array(inner)]), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2])
        boxes = np.stack([written[:, [0, 1, 1, 0], 0], written[:, [0, 0, 1, 1], 1]], axis=-1)
        return (
            Layer("cutting line", THIN, (outside_boxes(line, grown(boxes, HALO_MM), np.eye(4)),)),
            Layer("cutting ends", WIDE, (page_strokes([np.array(pair) for pair in zip(inner, ends, strict=True)]),)),
            Layer("label", PENS_of_layers["label"], (page_strokes([*heads, *letters]),)),
        )

    def name_layer(self, top: tuple[float, float], written: Floats) -> Layer:
        """A layer with its name, above the middle of the top of its view, and of the boxes (b,2,2) of letters there."""
        under = written[(np.abs(written[:, :, 0] - top[0]) < CLEAR_MM).any(axis=1), 1, 1]
        text = _letters(f"{self.letter}-{self.letter}", np.array([top[0], under.max(initial=top[1]) + 0.4 * ROOM_MM]))
        return Layer("label", PENS_of_layers["label"], (page_strokes(text),))


def _beyond(far: Floats, reach: float) -> float:
    """How far a cutting line goes that would go so far: beyond boxes from and to (b,2) along it that its end would be
    in."""
    ends = far.max(axis=1)
    # Its arrows and letters are no higher than the room beyond the part.
    return float(ends[ends > reach - WIDE_MM - BEYOND_MM].max(initial=reach - WIDE_MM - HALO_MM)) + WIDE_MM + HALO_MM


def sections_of(asked: str | Iterable[str], names: Sequence[str], bounds: Floats) -> tuple[SheetSection, ...]:
    """The sections that texts such as y=12 ask for, lettered in their order, each like the main view of its direction.

    Errors: InputError for texts that are none, planes beside the part, and more sections than letters.
    """
    texts = [asked] if isinstance(asked, str) else list(asked)
    if len(texts) > len(LETTERS):
        raise InputError(f"{len(texts)} sections: expected at most {len(LETTERS)}")
    found = []
    for letter, text in zip(LETTERS, texts, strict=False):
        sides = re.fullmatch(r"\s*([xyz])\s*=\s*(\S+)\s*", text)
        try:
            offset = float(sides[2]) if sides else math.nan
        except ValueError:
            offset = math.nan
        if sides is None or not math.isfinite(offset):
            raise InputError(f"section {text!r}: expected x, y or z and a number, such as y=12")
        axis = "xyz".index(sides[1])
        low, high = bounds[:, axis].tolist()
        if not low < offset < high:
            raise InputError(f"section {text!r}: beside the part, where {sides[1]} is {low:g} to {high:g}")
        usual = SEEN_AS[axis]
        found.append(SheetSection(letter, axis, offset, next((name for name in usual if name in names), usual[0])))
    return tuple(found)


def _letters(text: str, middle: Floats) -> list[Floats]:
    x, y = middle.tolist()
    lettering = lettered(text, (x, y), size_mm=LETTERS_MM, align="centre", level="middle")
    return [lettering.strokes[k] for k in range(len(lettering.strokes))]


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
    return np.concatenate(found)


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
        for number in square if one.is_centre else square[:1]:
            found[number].append(one)
    return found


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

    def annotation(self, camera: Camera, bounds: Floats, factor: float, world: Floats) -> Annotation:
        """It, where a unit of the world is so many mm on paper, beside bounds (2,3), and beyond all else that reaches
        so far, world (2,2), from the middle of these."""
        right, up, back = camera.axes
        middle, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
        low, high = (middle + sign * half[self.axis] * np.eye(3)[self.axis] for sign in (-1.0, 1.0))
        # Before the part, so that it does not lie in the dimension's way.
        nearest = float(matmul(np.abs(back), half)) * back
        level = self.is_level(camera)
        beside = -(float(matmul(np.abs(up), half)) * up if level else float(matmul(np.abs(right), half)) * right)
        ends = [point + nearest + beside for point in (low, high)]
        along = right if level else up
        start, end = sorted(ends, key=lambda point: float(matmul(point, along)))
        outwards = up if level else right
        others = float(world[0, 1 if level else 0]) - float(matmul(np.abs(outwards), half))
        off = -outwards * (max(others, 0.0) + OFFSET_MM / factor)
        gap, beyond = DIMENSION_GAP_MM / factor, LINE_BEYOND_MM / factor
        return Annotation(dimension(start, end, off, gap=gap, beyond=beyond))


def overall_dimensions(names: Sequence[str], bounds: Floats) -> tuple[OverallDimension, ...]:
    """The dimensions of the whole part, each in one of the views that are named; none along what has no extent."""
    found = []
    for axis, views in enumerate(SHOWN_IN):
        view = next((name for name in views if name in names), None)
        if view is not None and float(np.ptp(bounds[:, axis])) > 0.0:
            found.append(OverallDimension(axis, view))
    return tuple(found)


# The verb technical_sheet: main views of a part, side by side on one sheet, at one exact scale.

LINES = "contour,boundary,crease,intersection,curve,cut"
"""The kinds of lines of a technical drawing."""

PENS = "contour=0.5,boundary=0.5,crease=0.5,intersection=0.5,curve=0.5,cut=0.5,hidden=0.25"
"""Visible lines are wide, hidden ones narrow, as ISO 128-24 has it."""

DASHES = "hidden=3,1"

MM_PER = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": MM_PER_INCH}
"""How many mm a unit of the world may be."""

BORDER_MM = 20.0
"""What the page of a view has around the view, so that letters beside it are not cut off."""


@dataclass(frozen=True, eq=False)
class _Part:
    """What is drawn: the part, its annotations, and the views of it that were asked for."""

    scene: Scene
    annotations: tuple[Annotation, ...]
    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    overall: tuple[OverallDimension, ...]
    sections: tuple[SheetSection, ...]
    edges: tuple[RoundEdge, ...]

    @property
    def bounds(self) -> Floats:
        return self.scene.bounds

    def notes(self) -> list[list[Annotation]]:
        """The annotations of each view, and centre lines of each section; a pictorial view has none."""
        flat = [camera for name, camera in zip(self.names, self.cameras, strict=True) if name != "iso"]
        extent = float(np.ptp(self.bounds, axis=0).max())
        found = iter(views_of(self.annotations, flat, extent, self.edges))
        cut = [self.centre_lines_in(section, extent) for section in self.sections]
        return [*([] if name == "iso" else next(found) for name in self.names), *cut]

    def centre_lines_in(self, section: SheetSection, extent: float) -> list[Annotation]:
        """The centre lines that a section shows: those in its plane, and the marks of circles along it."""
        camera = camera_of(section.like, self.scene)
        square = [one for one in self.annotations if one.is_centre and one.is_square_to(camera, extent)]
        off = [float(np.abs(one.points[:, section.axis] - section.offset).max()) for one in square]
        zero = SAME_PLANE_OF_EXTENT * extent
        return [one for one, far in zip(square, off, strict=True) if len(one.scene) > 1 or far <= zero]

    def views(self, first_angle: bool) -> tuple[SheetView, ...]:
        """Where each view stands, and how far it reaches."""
        cells = cells_of(self.names, [section.like for section in self.sections], first_angle)
        named = list(zip(self.names, self.cameras, strict=True))
        named += [(section.letter, camera_of(section.like, self.scene)) for section in self.sections]
        middle, half = self.bounds.mean(axis=0), 0.5 * np.ptp(self.bounds, axis=0)
        found = []
        for (name, camera), notes in zip(named, self.notes(), strict=True):
            across = camera.axes[:2]
            world = np.tile(matmul(np.abs(across), half), (2, 1))
            beside = [matmul(one.points - middle, across.T) for one in notes]
            for places in beside:
                world = np.maximum(world, [-places.min(axis=0), places.max(axis=0)])
            # Cutting lines end outside of dimensions.
            mm = np.maximum(TEXT_MM if beside or self.scene.labels else 0.0, self.overall_room_mm(name, camera))
            rooms = [one.line_room_mm(camera) for one in self.sections if one.told_in(self.names) == name]
            rooms += [np.array([(0.0, 0.0), (0.0, ROOM_MM)]) for one in self.sections if one.letter == name]
            found.append(SheetView(name, camera, cells[name], world, mm + np.max([np.zeros((2, 2)), *rooms], axis=0)))
        return tuple(found)

    def overall_room_mm(self, name: str, camera: Camera) -> Floats:
        """(2,2) what the dimensions of the whole part need around it in a view."""
        rooms = [one.room_mm(camera) for one in self.overall if one.view == name]
        return np.asarray(np.max([np.zeros((2, 2)), *rooms], axis=0))

    def shown(self, view: SheetView, factor: float, spacing_mm: float | None) -> Scene:
        """What a view shows: the part, or what a section leaves of it, at a factor of the scale; spacing_mm: of
        hatches, see cut."""
        cuts = [section.condition for section in self.sections if section.letter == view.name]
        return (
            cut_scene(cut(self.scene, cuts, spacing_mm=spacing_mm), view.camera, _page_at(factor))
            if cuts
            else self.scene
        )

    def around_sections(self, arranged: Arrangement, factor: float, written: Mapping[str, Floats]) -> tuple[Layer, ...]:
        """The lines of sections in other views, and their names; written: the boxes (b,2,2) of letters in each view."""
        views = {view.name: (view, place) for view, place in zip(arranged.views, arranged.middles(factor), strict=True)}
        found: list[Layer] = []
        for section in self.sections:
            view, (x, y) = views[section.letter]
            top = y + factor * float(view.world[1, 1])
            found.append(section.name_layer((x, top), written[view.name]))
            name = section.told_in(self.names)
            if name is not None:
                other, place = views[name]
                room = self.overall_room_mm(name, other.camera)
                found += section.line_layers(other.camera, view.camera, self.bounds, place, factor, room, written[name])
        return tuple(found)


@stoppable
def technical_sheet(
    scene: object,
    *,
    views: str | Iterable[str] = "front,top,left,iso",
    up: Point | None = None,
    scale: str = "fit",
    unit: str = "mm",
    projection: Literal["first", "third"] = "first",
    page: Page | str = "A3",
    section: str | Iterable[str] = (),
    cut_spacing_mm: float | None = None,
    dimensions: bool = False,
    centre_lines: bool = False,
    frame: bool = False,
    block: bool = True,
    title: str | None = None,
    author: str = "",
    date: str = "",
    sheet: str = "1",
    crease_angle_deg: float = 25.0,
    shortest_mm: float | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """Main views of a part in line with each other on one sheet, at one exact scale, hidden lines dashed.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is drawn, see `io.scene_of`. Dimensions in it are shown in the first view that they are square to, radii
        and diameters of bores in one that shows the circle, centre lines in every such view, and leaders that are
        square to none where they look longest.
    views : str or iterable of str
        Some of front, back, left, right, top, bottom, iso, each once; iso stands in a free corner, without hidden lines
        and dimensions.
    up : (float, float, float), optional
        What is upwards in the part, which is stood up so that it is along z; sections are across x, y and z of what
        stands. Where None, z.
    scale : str
        Lengths on paper to lengths of the part, such as 1:2; fit: the largest of ISO 5455 that fits.
    unit : {"mm", "cm", "m", "in"}
        What a unit of the world is; measures, sections and the scale are in mm whatever it is.
    projection : {"first", "third"}
        First or third angle: whether a view stands opposite to the side it is seen from, as in Europe, or on that
        side, as in America.
    page : Page or str
        Or its name or size, such as "A3" or "200x150"; one that is named lies on the side that gives the views more
        room.
    section : str or iterable of str
        Planes such as y=12, each of which gives a view of the part without what lies before the plane, like the main
        view of that direction: A-A, B-B, and so on. Cut faces are hatched; in a view that sees the plane edge-on a line
        with arrows shows where it is.
    cut_spacing_mm : float, optional
        From stroke to stroke of these hatches, 0.1 or more; where None about 2.4, on narrow faces half as much.
    dimensions : bool
        How long the whole part is along x, y and z, each in one view.
    centre_lines : bool
        Of bores, shafts and whatever else has edges in circles across x, y or z, polyhedra only.
    frame : bool
        The border of the drawing space, with centring marks and zones, and a wider margin at the left.
    block : bool
        The title block; without it the sheet is a figure of views, for a page of something else.
    title : str, optional
        Letters in the title block; where None those of the scene, if they have room and strokes there.
    author, date, sheet : str
        Letters in the title block.
    crease_angle_deg : float
        See draw.
    shortest_mm : float, optional
        See draw: of what shows the part in every view.
    progress, explain : callable, optional
        See draw, for every view.

    Returns
    -------
    Drawing
        With contours, boundaries, creases, intersections and curves, and a title block in the lower right corner.

    Raises
    ------
    InputError
        See draw; for views that are unknown, twice or none; for sections that are none, or beside the part; for a
        scale that is too large for the page, with the largest that fits; for a page without room, and a title without
        room in its block; for an unknown unit.

    Warns
    -----
    InputWarning
        Of dimensions that are square to none of the views: they are not shown.

    Notes
    -----
    The isometric view is a projection at the same scale: edges along the axes are 0.816 times as long in it.

    Edge cases: a scene without extent is drawn 1:1.

    Source: ISO 128-30 and ISO 5456-2 (views), ISO 5455 (scales), ISO 5457 (frames), ISO 7200 (title blocks).

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (90, 0, 0), (0, 60, 0), (0, 0, 30)]
    >>> part = vp.Mesh.from_triangles(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    >>> sheet = vp.technical_sheet(part, page="A4", title="Corner")
    >>> sheet.width_mm, sheet.height_mm, sheet.title
    (297.0, 210.0, 'Corner, 1:1')
    """
    names = _view_names(views)
    check_word("projection", projection, ("first", "third"))
    check_word("unit", unit, MM_PER)
    asked = None if scale == "fit" else DrawingScale.of(scale)
    given = shown_apart(scene_of(scene))
    given = given if unit == "mm" else given.scaled(MM_PER[unit])
    # Sheets have pens of their own.
    given = replace(given if up is None else stood_up(given, up), inks=None)
    solid, annotations = without_annotations(given)
    edges: tuple[RoundEdge, ...] = ()
    if centre_lines or any(one.may_be_of_circle for one in annotations):
        edges = _round_edges(solid, crease_angle_deg)
    if centre_lines and edges:
        extent = float(np.ptp(given.bounds, axis=0).max())
        solid, annotations = without_annotations(together([given, *centre_lines_of(edges, extent)]))
    cameras = tuple(camera_of(name, solid) for name in names)
    overall = overall_dimensions(names, solid.bounds) if dimensions else ()
    sections = sections_of(section, names, solid.bounds)
    part = _Part(solid, annotations, names, cameras, overall, sections, edges)
    paper, arranged = roomiest(page, part.views(projection == "first"), frame, BLOCK_MM[1] if block else 0.0)
    chosen = fitting_scale(asked, arranged, paper)
    factor = chosen.factor
    name = page.strip().split()[0].upper() if isinstance(page, str) else f"{paper.width_mm:g}x{paper.height_mm:g}"
    said = given.title if title is None else title
    words = TitleBlock(said, author, date, sheet, str(chosen), name, projection)
    # A title that nobody asked for here may be too long, or in letters without strokes.
    written_in = words.layers_titled_if_possible if title is None else words.layers
    layers = written_in(drawing_space(paper, frame)) if block else ()
    done = Sheet(paper, f"{said}, {chosen}" if said else str(chosen))
    notes = part.notes()
    _tell_left_out(annotations, notes)
    written: dict[str, Floats] = {}
    for number, (view, (x, y)) in enumerate(zip(arranged.views, arranged.middles(factor), strict=True)):
        added = [one.before(view.camera, part.bounds) for one in notes[number]]
        added += [
            one.annotation(view.camera, part.bounds, factor, view.world).scene
            for one in part.overall
            if one.view == view.name
        ]
        width, height = (2.0 * (view.reach_mm(factor).max(axis=0) + BORDER_MM)).tolist()
        drawn = draw(
            together([part.shown(view, factor, cut_spacing_mm), *added]),
            replace(view.camera, height=height / factor),
            page=Page(width, height, 0.0),
            fit=False,
            lines=LINES,
            hidden="dashed" if view.name in names and view.name != "iso" else "none",
            pens=PENS,
            dashes=DASHES,
            crease_angle_deg=crease_angle_deg,
            shortest_mm=shortest_mm,
            progress=progress,
            explain=explain,
        )
        corner = (x - 0.5 * width, y - 0.5 * height)
        written[view.name] = written_on(drawn) + corner
        done = done.place(drawn, *corner)
    around = part.around_sections(arranged, factor, written)
    borders = (*(frame_layers(paper) if frame else ()), *layers)
    return done.place(Drawing(paper.width_mm, paper.height_mm, (*around, *borders), ()), 0.0, 0.0).drawing()


def _tell_left_out(annotations: Iterable[Annotation], notes: Iterable[Iterable[Annotation]]) -> None:
    """An InputWarning that names the annotations, but for centre lines, which are in no view."""
    shown = {id(one) for view in notes for one in view}
    names = [one.name for one in annotations if not one.is_centre and id(one) not in shown]
    if names:
        warnings.warn(f"square to no view and not shown: {', '.join(names)}", InputWarning, stacklevel=3)


def _page_at(factor: float) -> Callable[[Scene], InSpace]:
    """A page on which a unit of the world is so many mm, as cut_scene takes it."""
    return lambda scene: lambda points: np.full(len(points), 1.0 / factor)


def _round_edges(scene: Scene, crease_angle_deg: float) -> tuple[RoundEdge, ...]:
    """Those of all polyhedra."""
    meshes = [item.shape for item in scene.items if isinstance(item.shape, Mesh)]
    return tuple(edge for mesh in meshes for edge in round_edges(mesh, crease_angle_deg))


def _view_names(views: str | Iterable[str]) -> tuple[str, ...]:
    names = tuple(word.strip() for word in (views.split(",") if isinstance(views, str) else views))
    for name in names:
        if name not in VIEWS:
            raise unknown("view", name, VIEWS)
    if not names or len(set(names)) < len(names):
        raise InputError(f"views {','.join(names)!r}: expected some of {', '.join(VIEWS)}, each once")
    return names


# A scene on a turntable: drawings from all around at one scale.

MOST = 1000
"""Drawings of one turntable."""

DISTANCE = 4.0
"""From the eye to the middle of the scene, in radii of the ball around it."""

DEFAULT_PAGE = Page(80.0, 80.0, 2.0)


def turntable(
    scene: object,
    count: int = 8,
    *,
    elevation_deg: float = 25.0,
    page: Page | str = DEFAULT_PAGE,
    executor: Submits | None = None,
    **options: Any,
) -> tuple[Drawing, ...]:
    """Drawings of a scene that turns about its vertical axis, clockwise from above, all at one scale.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        See draw.
    count : int
        How many, a whole turn in equal steps; 1 to 1000.
    elevation_deg : float
        How high the eye stands above the horizon, -89 to 89 degrees.
    page : Page or str
        Of each drawing, see draw.
    executor : Executor, optional
        Whose workers make the drawings, see `batch.run`; where None, they are made one after another.
    options : Any
        Others as in draw, but for camera and fit.

    Returns
    -------
    tuple of Drawing
        The first one from the front.

    Raises
    ------
    InputError
        For another count or elevation, and as in draw.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Torus
    >>> views = vp.turntable(Torus(3, 1), 4)
    >>> len(views), vp.contact_sheet(views).width_mm
    (4, 210.0)
    """
    if not 1 <= count <= MOST:
        raise InputError(f"a turntable of {count} drawings: expected 1 to {MOST}")
    if not abs(elevation_deg) <= 89.0:
        raise InputError(f"a turntable seen from {elevation_deg:g} degrees above: expected -89 to 89")
    shown = shown_apart(scene_of(scene))
    low, high = shown.bounds
    middle, radius = 0.5 * (low + high), 0.5 * math.dist(low, high) or 1.0
    paper = page_of(page, shown)
    # The whole page shows as much more than what its margin leaves as it is larger.
    width, height = paper.room
    share = min(width, height) / paper.height_mm
    fov = 2.0 * math.degrees(math.atan(math.tan(math.asin(1.0 / DISTANCE)) / share))
    above = math.radians(elevation_deg)
    turn = 2.0 * np.pi * np.arange(count) / count
    ways = np.stack([np.sin(turn), -np.cos(turn), np.full(count, math.tan(above))], axis=1) * math.cos(above)
    eyes = (middle + DISTANCE * radius * ways).tolist()
    target = (float(middle[0]), float(middle[1]), float(middle[2]))
    cameras = [Camera((x, y, z), target, fov_deg=fov) for x, y, z in eyes]
    calls = [partial(draw, shown, camera, page=paper, fit=False, **options) for camera in cameras]
    return tuple(call() for call in calls) if executor is None else tuple(results(calls, executor))
