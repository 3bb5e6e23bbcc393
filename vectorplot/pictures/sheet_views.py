"""The views of a part on a technical sheet: where they stand, sections, and the lines that say where these cut."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.dashes import CHAIN_MM, dashed
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.labels import HALO_MM
from vectorplot.drawing.letters import Lettering
from vectorplot.drawing.sheets import letter_layer, page_strokes
from vectorplot.drawing.text_along import grown, inside_box, near_boxes, outside_boxes
from vectorplot.drawing.title_block import DrawingScale, Plain, drawing_space
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.rotations import upright_turn
from vectorplot.geometry.vectors import normalize
from vectorplot.scene.cuts import Cut
from vectorplot.scene.page import Page
from vectorplot.scene.placement import page_of
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import EDGE_ON_SINE

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

    name: of the main view, or the letter of a section or a detail; like: the main view right of which it stands best,
    of those that are in line with no other; world (2,2): how far what it shows reaches from the middle of the part, to
    the left and down, and to the right and up, in units of the world; mm (2,2): how far what is around it reaches
    beyond that; cell: column and row.
    """

    name: str
    camera: Camera
    like: str
    world: Floats
    mm: Floats
    cell: Cell = (0, 0)

    def reach_mm(self, factor: float) -> Floats:
        """(2,2) how far it reaches on paper, where a unit of the world is so many mm."""
        return factor * self.world + self.mm


def cells_of(names: Sequence[str], first_angle: bool) -> dict[str, Cell]:
    """The cells of those of some views that stand in line with each other."""
    places = FIRST_ANGLE if first_angle else THIRD_ANGLE
    return {name: places[name] for name in names if name in places}


def wanted_cells(view: str, like: str, cells: Mapping[str, Cell]) -> tuple[Cell, ...]:
    """The free cells in which a view may stand that is in line with no other, the best first.

    like: the main view that it is like, right of which it stands best; none for views in a corner; cells: those that
    are taken.
    """
    taken = set(cells.values())
    columns, rows = ({cell[axis] for cell in taken} or {0} for axis in (0, 1))
    near = [(x, y) for y in range(min(rows) - 1, max(rows) + 2) for x in range(min(columns) - 1, max(columns) + 2)]
    free = [cell for cell in near if cell not in taken]
    if not like:
        best = [cell for cell in PICTORIAL if cell in free]
        best.sort(key=lambda cell: (cell[0] not in columns) + (cell[1] not in rows))
        return tuple(dict.fromkeys([*best, *free]))
    row = cells.get(like, (0, 0))[1]
    # Beyond all that is in its row.
    last = (max((x for x, y in taken if y == row), default=-1) + 1, row)
    return tuple(dict.fromkeys([last, *(cell for cell in free if cell[0] > min(columns) - 1)]))


def in_rows(cells: Mapping[str, Cell]) -> dict[str, Cell]:
    """The cells without empty columns and rows, which take no room."""
    across, upwards = (sorted({cell[axis] for cell in cells.values()}) for axis in (0, 1))
    return {name: (across.index(x), upwards.index(y)) for name, (x, y) in cells.items()}


LETTERS = "ABCDEFGHJKLMNPRSTUVWXYZ"
"""The names of sections and details, without letters that look like figures."""


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


def arranged_in(views: Sequence[SheetView], space: Floats, first_angle: bool, scales: StandardScales) -> Arrangement:
    """The views in a space: main views in line with each other, the others one after another where the standard scale
    that fits is the largest."""
    cells: dict[str, Cell] = cells_of([view.name for view in views], first_angle)
    placed = [view for view in views if view.name in cells]

    def tried(more: Sequence[SheetView], found: Mapping[str, Cell]) -> Arrangement:
        closed = in_rows(found)
        return Arrangement(tuple(replace(view, cell=closed[view.name]) for view in more), space)

    for view in (view for view in views if view.name not in cells):
        # No place gives more than there is without the view: the first that gives as much is taken.
        bound = _worth(tried(placed, cells), scales) if placed else math.inf
        placed.append(view)
        best, most = (0, 0), -math.inf
        for cell in wanted_cells(view.name, view.like, cells):
            worth = _worth(tried(placed, {**cells, view.name: cell}), scales)
            if worth > most:
                best, most = cell, worth
            if worth >= bound:
                break
        cells[view.name] = best
    order = {view.name: number for number, view in enumerate(views)}
    return tried(sorted(placed, key=lambda view: order[view.name]), cells)


@dataclass(frozen=True)
class StandardScales:
    """The scales that a sheet may have: the figures of standard ones, and the one that is asked for, if any."""

    steps: Sequence[int]
    asked: DrawingScale | None

    def best(self, room: float) -> DrawingScale:
        """The scale asked for, or the largest standard one with a factor no larger than one that is positive."""
        if self.asked is not None:
            return self.asked
        return DrawingScale.largest_standard(room, self.steps) if math.isfinite(room) else DrawingScale(1.0, 1.0)


def _worth(arranged: Arrangement, scales: StandardScales) -> float:
    """The scale at which views have room; none where there is no room."""
    room = arranged.largest_factor()
    return min(room, scales.best(room).factor) if room > 0.0 else room


def roomiest(
    page: Page | str,
    views: Sequence[SheetView],
    frame: bool,
    first_angle: bool,
    taken: Floats,
    scales: StandardScales,
) -> tuple[Page, Arrangement]:
    """The sheet, and the views on it; a named one lies as gives them more room.

    taken: how wide and how high the title block is, with the parts list on it: no view is below, or none beside it.
    """
    given = page_of(page, Scene(()))
    turned = isinstance(page, str) and len(page.split()) == 1 and "x" not in page.lower()
    papers = (given.landscape, given) if turned else (given,)
    tried = []
    for paper in papers:
        (left, low), (right, top) = drawing_space(paper, frame).tolist()
        spaces = [np.array([(left, low + taken[1]), (right, top)])]
        if 0.0 < taken[0] < right - left:
            spaces.append(np.array([(left, low), (right - taken[0], top)]))
        tried += [(paper, arranged_in(views, space, first_angle, scales)) for space in spaces]
    # Rather above the block than beside it, if that costs nothing.
    paper, arranged = max(tried, key=lambda pair: _worth(pair[1], scales))
    if not arranged.largest_factor() > 0.0:
        above = " above the title block" if taken.any() else ""
        raise InputError(f"page {paper.width_mm:g}x{paper.height_mm:g} mm: no room for {len(views)} views{above}")
    return paper, arranged


def fitting_scale(scales: StandardScales, arranged: Arrangement, paper: Page) -> DrawingScale:
    """The scale asked for, or the largest standard one that fits. Errors: InputError for one that is too large."""
    room = arranged.largest_factor()
    chosen = scales.best(room)
    if chosen.factor > room:
        largest = DrawingScale.largest_standard(room, scales.steps)
        raise InputError(
            f"scale {chosen}: too large for {len(arranged.views)} views on {paper.width_mm:g}x{paper.height_mm:g} mm; "
            f"the largest standard scale that fits is {largest}"
        )
    return chosen


# Section views on a sheet: where they cut, and the line in another view that says so.
#
# Source: ISO 128-40 (cuts and sections), ISO 128-24 (cutting planes).

SEEN_AS = (("left", "right"), ("front", "back"), ("top", "bottom"))
"""The main views that a section across x, y and z is like, the usual one first."""

TOLD_IN = (("front", "back", "top", "bottom"), ("top", "bottom", "left", "right"), ("front", "back", "left", "right"))
"""The views in which one sees a plane across x, y and z as a line, the best first."""

SEEN_ALONG = {"front": 1, "back": 1, "left": 0, "right": 0, "top": 2, "bottom": 2}
"""The axis along which one looks in a main view."""

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
class Zone:
    """What a section shows in a part of its view: what is behind a plane, or (offset: None) what is seen from outside.

    low, high: from where to where it reaches, along the axis across which its parts are; turn_deg: about how much the
    part is turned first, about the axis of an aligned section.
    """

    offset: float | None
    low: float = -math.inf
    high: float = math.inf
    turn_deg: float = 0.0

    def holds(self, places: Floats, zero: float) -> bool:
        """Whether places (n,) along that axis are in it; of what lies on its border the part before it."""
        low, high = float(places.min()), float(places.max())
        return self.low - zero <= low and self.low + zero < high <= self.high + zero


@dataclass(frozen=True)
class LineEnd:
    """An end of a cutting line: from a point of it in the world along a direction (3,); way (3,): of its arrow, if it
    has one."""

    origin: Floats
    direction: Floats
    way: Floats | None


@dataclass(frozen=True)
class SheetSection:
    """A section of a part across an axis (0, 1, 2), called by a letter, like one of the main views.

    zones: side by side along the axis across, more than one for half, offset and aligned sections; hinge: a point of
    the axis about which the part is turned in aligned sections; arms: the directions of its two planes there, degrees;
    normal: of the plane of an oblique section, through the hinge, about which the part is turned until the plane is
    across the axis.
    """

    letter: str
    axis: int
    like: str
    zones: tuple[Zone, ...]
    across: int
    hinge: tuple[float, float, float] | None = None
    arms: tuple[float, float] = (180.0, 0.0)
    normal: tuple[float, float, float] | None = None

    @property
    def turn_axis(self) -> int:
        """The axis about which the part is turned in an aligned section."""
        return 3 - self.axis - self.across

    @property
    def is_half(self) -> bool:
        """Whether some of it is seen from outside."""
        return any(zone.offset is None for zone in self.zones)

    def shown(self, scene: Scene, zone: Zone) -> Scene:
        """The part as a zone shows it before it is cut."""
        if self.hinge is None or (self.normal is None and zone.turn_deg == 0.0):
            return scene
        x, y, z = self.hinge
        if self.normal is not None:
            cycle = np.roll(np.eye(3), 2 - self.axis, axis=0)
            matrix = np.eye(4)
            matrix[:3, :3] = matmul(cycle.T, matmul(upright_turn(np.roll(self.normal, 2 - self.axis)), cycle))
            return scene.moved(-x, -y, -z).transformed(matrix).moved(x, y, z)
        turned = scene.moved(-x, -y, -z).turned("xyz"[self.turn_axis], zone.turn_deg)
        return turned.moved(x, y, z)

    def interrupted(self, left_out: Interruptions, factor: float) -> SheetSection:
        """It where it is in the shorter part."""

        def moved(place: float, axis: int) -> float:
            return float(left_out.moved(np.full((1, 3), place), factor)[0, axis]) if math.isfinite(place) else place

        zones = tuple(
            replace(
                zone,
                offset=None if zone.offset is None else moved(zone.offset, self.axis),
                low=moved(zone.low, self.across),
                high=moved(zone.high, self.across),
            )
            for zone in self.zones
        )
        if self.hinge is None:
            return replace(self, zones=zones)
        x, y, z = left_out.moved(np.array([self.hinge]), factor)[0].tolist()
        return replace(self, zones=zones, hinge=(x, y, z))

    def zone_at(self, point: Sequence[float]) -> Zone:
        """The zone that shows a point of the part, as it is turned there."""
        return next(zone for zone in self.zones if point[self.across] <= zone.high)

    def told_in(self, names: Sequence[str]) -> str | None:
        """The view that shows where it is, of those that are named."""
        simple = len(self.zones) == 1
        seen = [name for name in TOLD_IN[self.axis] if simple or SEEN_ALONG[name] == self.turn_axis]
        if self.normal is not None:
            seen = [name for name in seen if abs(self.normal[SEEN_ALONG[name]]) <= EDGE_ON_SINE]
        return next((name for name in seen if name in names), None)

    def offset_near(self, places: Floats) -> Floats:
        """(n,) how far places (n,3) are from its planes."""
        off = [np.abs(places[:, self.axis] - zone.offset) for zone in self.zones if zone.offset is not None]
        return np.asarray(np.min(off, axis=0))

    def line_room_mm(self, camera: Camera) -> Floats:
        """(2,2) what its line needs around the part in a view."""
        if len(self.zones) > 1 or self.normal is not None:
            return np.full((2, 2), ROOM_MM)
        return np.tile(np.where(np.abs(camera.axes[:2, self.axis]) > math.sqrt(0.5), 0.5, 1.0) * ROOM_MM, (2, 1))

    def line(self, camera: Camera, sight: Camera, centre: Floats) -> tuple[tuple[LineEnd, LineEnd], Floats]:
        """Both ends of its line in a view that sees its plane edge-on, and the corners (k,3) between them; sight: the
        camera of the section; centre (3,): of the part."""
        look = -np.asarray(sight.direction)
        if self.normal is not None:
            normal, origin = np.array(self.normal), np.array(self.hinge)
            course, way = normalize(np.cross(normal, camera.axes[2])), float(look[self.axis]) * normal
            return (LineEnd(origin, -course, way), LineEnd(origin, course, way)), np.zeros((0, 3))
        if self.hinge is not None:
            one, other = np.eye(3)[(self.turn_axis + 1) % 3], np.eye(3)[(self.turn_axis + 2) % 3]
            ends = []
            for zone, arm in zip(self.zones, self.arms, strict=True):
                (c, s), (c_arm, s_arm) = (
                    (float(np.cos(turn)), float(np.sin(turn))) for turn in np.radians([zone.turn_deg, arm])
                )
                seen, aside = float(matmul(look, one)), float(matmul(look, other))
                way = (c * seen + s * aside) * one + (c * aside - s * seen) * other
                ends.append(LineEnd(np.array(self.hinge), c_arm * one + s_arm * other, way))
            return (ends[0], ends[1]), np.array([self.hinge])
        seen = int(np.argmax(np.abs(camera.axes[2])))
        step = np.eye(3)[3 - self.axis - seen]
        corners: list[Floats] = []
        for zone, after in zip(self.zones, self.zones[1:], strict=False):
            both = [one.offset for one in (zone, after) if one.offset is not None]
            corners += [self._place(centre, zone.high, offset) for offset in both]
        found = []
        for zone, sign, at in ((self.zones[0], -1.0, 0), (self.zones[-1], 1.0, -1)):
            if zone.offset is None:
                found.append(LineEnd(corners[at], -look, None))
            else:
                origin = centre.copy()
                origin[self.axis] = zone.offset
                found.append(LineEnd(origin, sign * step, look))
        return (found[0], found[1]), np.array(corners).reshape(-1, 3)

    def _place(self, centre: Floats, across: float, offset: float) -> Floats:
        found = centre.copy()
        found[self.across], found[self.axis] = across, offset
        return found

    def line_layers(
        self,
        camera: Camera,
        sight: Camera,
        bounds: Floats,
        middle: tuple[float, float],
        factor: float,
        room: Floats,
        written: Floats,
        plain: Plain,
    ) -> tuple[Layer, ...]:
        """Layers with its line, arrows and letters in a view that sees its plane edge-on.

        sight: the camera of the section; bounds (2,3): of the part, whose middle is at a place on the page; factor: mm
        on paper for a unit of the world; room (2,2): what is already beside the part, in mm; written (b,2,2): the boxes
        of letters in the view, outside of which its ends are, and before which its line is interrupted.
        """
        flat = camera.axes[:2]
        centre, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
        reach = factor * matmul(np.abs(flat), half)
        both, corners = self.line(camera, sight, centre)
        bends = np.array(middle) + factor * matmul(corners - centre, flat.T)
        ends, inner, heads, letters = [], [], [], []
        for one in both:
            place = np.array(middle) + factor * matmul(flat, one.origin - centre)
            way = matmul(flat, one.direction)
            far = _leaves(place - middle, way, reach) + BEYOND_MM
            far += float((np.abs(way) * np.where(way < 0.0, room[0], room[1])).sum())
            beside = matmul(written - place, np.array([-way[1], way[0]]))
            near = (beside.min(axis=1) < CLEAR_MM) & (beside.max(axis=1) > -CLEAR_MM)
            far = max(far, _beyond(matmul(written - place, way)[near], far))
            end = place + far * way
            ends.append(end)
            inner.append(place + (far - WIDE_MM) * way)
            if one.way is not None:
                arrow = matmul(flat, one.way)
                back, wing = end - HEAD_MM * arrow, HEAD_MM * SLOPE * np.array([-arrow[1], arrow[0]])
                heads.append(np.array([end - ARROW_MM * arrow, end, back + wing, back - wing, end]))
                letters.append(letters_at(self.letter, end - (ARROW_MM + 0.8 * LETTERS_MM) * arrow, plain))
        course = np.array([inner[0], *bends, inner[1]])
        line = dashed(page_strokes([course]), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2])
        wide = [np.array(pair) for pair in zip(inner, ends, strict=True)]
        wide += [bend for k in range(1, len(course) - 1) if len(bend := _bend(course[k - 1 : k + 2]))]
        boxes = np.stack([written[:, [0, 1, 1, 0], 0], written[:, [0, 0, 1, 1], 1]], axis=-1)
        return (
            Layer("cutting line", THIN, (outside_boxes(line, grown(boxes, HALO_MM), np.eye(4)),)),
            Layer("cutting ends", WIDE, (page_strokes(wide),)),
            letter_layer(letters, heads),
        )

    def name_layer(self, top: tuple[float, float], written: Floats, plain: Plain) -> Layer:
        """A layer with its name, above the middle of the top of its view, and of the boxes (b,2,2) of letters there."""
        return named_layer(f"{self.letter}-{self.letter}", top, written, plain)


def named_layer(text: str, top: tuple[float, float], written: Floats, plain: Plain) -> Layer:
    """A layer with the name of a view, above the middle of its top, and of the boxes (b,2,2) of letters there."""
    under = written[(np.abs(written[:, :, 0] - top[0]) < CLEAR_MM).any(axis=1), 1, 1]
    return letter_layer([letters_at(text, np.array([top[0], under.max(initial=top[1]) + 0.4 * ROOM_MM]), plain)])


def _leaves(place: Floats, way: Floats, reach: Floats) -> float:
    """How far it is from a place (2,) along a direction of length 1 out of a rectangle that reaches so far (2,) from
    its middle, from which places are counted."""
    some = np.abs(way) > EDGE_ON_SINE
    return float(((reach - np.sign(way) * place)[some] / np.abs(way[some])).min())


def _bend(corner: Floats) -> Floats:
    """(3,2) the wide corner of a cutting line between two others (3,2); nothing where it goes straight on."""
    before, after = corner[0] - corner[1], corner[2] - corner[1]
    long = [float(np.hypot(*way)) for way in (before, after)]
    if not min(long) > 0.0 or abs(before[0] * after[1] - before[1] * after[0]) <= EDGE_ON_SINE * long[0] * long[1]:
        return np.zeros((0, 2))
    one, other = (
        corner[1] + min(0.5 * WIDE_MM, 0.4 * far) / far * way for way, far in zip((before, after), long, strict=True)
    )
    return np.array([one, corner[1], other])


def _beyond(far: Floats, reach: float) -> float:
    """How far a cutting line goes that would go so far: beyond boxes from and to (b,2) along it that its end would be
    in."""
    ends = far.max(axis=1)
    # Its arrows and letters are no higher than the room beyond the part.
    return float(ends[ends > reach - WIDE_MM - BEYOND_MM].max(initial=reach - WIDE_MM - HALO_MM)) + WIDE_MM + HALO_MM


def sections_of(asked: str | Iterable[str], names: Sequence[str], bounds: Floats) -> tuple[SheetSection, ...]:
    """The sections that texts ask for, lettered in their order, each like the main view of its direction: y=12,
    x+y=30, half y=12, y=12 | x=20 | y=30, or aligned z at 0,0 from 180 to 60.

    Errors: InputError for texts that are none, planes beside the part, and more sections than letters.
    """
    texts = [asked] if isinstance(asked, str) else list(asked)
    if len(texts) > len(LETTERS):
        raise InputError(f"{len(texts)} sections: expected at most {len(LETTERS)}")
    return tuple(_section(letter, text, names, bounds) for letter, text in zip(LETTERS, texts, strict=False))


NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLANE = re.compile(rf"\s*([xyz])\s*=\s*({NUMBER})\s*")
_ALIGNED = re.compile(
    rf"\s*aligned\s+([xyz])\s+at\s+({NUMBER})\s*,\s*({NUMBER})\s+from\s+({NUMBER})\s+to\s+({NUMBER})\s*"
)

SPLIT_ALONG = (1, 0, 0)
"""The axes along which the halves of half sections across x, y and z lie."""


SPLIT_AROUND = (2, 0, 0)
"""The axes along which the halves of aligned sections about x, y and z lie."""


def _section(letter: str, text: str, names: Sequence[str], bounds: Floats) -> SheetSection:
    if (aligned := _ALIGNED.fullmatch(text)) is not None:
        return _aligned(letter, "xyz".index(aligned[1]), [float(aligned[k]) for k in range(2, 6)], names)
    half = text.split()[:1] == ["half"]
    if not half and "|" not in text and not _PLANE.fullmatch(text):
        return _oblique(letter, text, names, bounds)
    planes = [_plane(part, text, bounds) for part in text.strip().removeprefix("half").split("|")]
    axis, offset = planes[0]
    usual = SEEN_AS[axis]
    like = next((name for name in usual if name in names), usual[0])
    if half:
        across = SPLIT_ALONG[axis]
        middle = 0.5 * float(bounds[:, across].sum())
        # What is at the right in its view is cut.
        cut, whole = Zone(offset), Zone(None)
        rightwards = like in ("front", "right", "top", "bottom")
        first, second = (whole, cut) if rightwards else (cut, whole)
        limited = (replace(first, high=middle), replace(second, low=middle))
        return SheetSection(letter, axis, like, limited, across)
    steps, across = planes[1::2], planes[1][0] if len(planes) > 1 else SPLIT_ALONG[axis]
    places = [place for _, place in steps]
    good = [plane[0] for plane in planes[::2]] == [axis] * (len(steps) + 1) and across != axis
    if not good or any(step[0] != across for step in steps) or places != sorted(places):
        raise InputError(f"section {text!r}: expected planes of one axis with steps between them, y=12 | x=20 | y=30")
    ends = [-math.inf, *places, math.inf]
    zones = tuple(
        Zone(place, low, high) for (_, place), low, high in zip(planes[::2], ends[:-1], ends[1:], strict=True)
    )
    return SheetSection(letter, axis, like, zones, across)


def _aligned(letter: str, turn: int, said: Sequence[float], names: Sequence[str]) -> SheetSection:
    """An aligned section: two planes through an axis, the one turned into that of the other."""
    first, second, begin, end = said
    across = SPLIT_AROUND[turn]
    axis = 3 - turn - across
    hinge = [0.0, 0.0, 0.0]
    others = [k for k in range(3) if k != turn]
    hinge[others[0]], hinge[others[1]] = first, second
    # Angles are counted from the next axis to the one after it.
    zero = 0.0 if across == (turn + 1) % 3 else 90.0
    usual = SEEN_AS[axis]
    like = next((name for name in usual if name in names), usual[0])
    low = Zone(hinge[axis], high=hinge[across], turn_deg=zero + 180.0 - begin)
    high = Zone(hinge[axis], low=hinge[across], turn_deg=zero - end)
    place = (hinge[0], hinge[1], hinge[2])
    return SheetSection(letter, axis, like, (low, high), across, place, (begin, end))


def _oblique(letter: str, text: str, names: Sequence[str], bounds: Floats) -> SheetSection:
    """A section in a plane of any direction, such as x + y = 30, like the main view that it is nearest to."""
    try:
        planes = Cut.of(text).planes
    except InputError:
        planes = ()
    if len(planes) != 1 or not planes[0].to_eye:
        raise _no_section(text)
    normal, offset = np.array(planes[0].normal), planes[0].offset
    axis = int(np.argmax(np.abs(normal)))
    sign = math.copysign(1.0, normal[axis])
    normal, offset = sign * normal, sign * offset
    middle, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
    away = offset - float(matmul(middle, normal))
    if not abs(away) < float(matmul(half, np.abs(normal))):
        raise InputError(f"section {text!r}: beside the part")
    usual = SEEN_AS[axis]
    like = next((name for name in usual if name in names), usual[0])
    hinge = middle + away * normal
    (x, y, z), (a, b, c) = hinge.tolist(), normal.tolist()
    return SheetSection(letter, axis, like, (Zone(float(hinge[axis])),), SPLIT_ALONG[axis], (x, y, z), normal=(a, b, c))


def _no_section(text: str) -> InputError:
    return InputError(
        f"section {text!r}: expected x, y or z and a number, such as y=12, x+y=30, 'half y=12', 'y=12 | x=20 | y=30' "
        "or 'aligned z at 0,0 from 180 to 60'"
    )


def _plane(part: str, text: str, bounds: Floats) -> tuple[int, float]:
    """The axis and the place that y=12 says. Errors: InputError for other texts, and planes beside the part."""
    sides = _PLANE.fullmatch(part)
    offset = float(sides[2]) if sides else math.nan
    if sides is None or not math.isfinite(offset):
        raise _no_section(text)
    axis = "xyz".index(sides[1])
    low, high = bounds[:, axis].tolist()
    if not low < offset < high:
        raise InputError(f"section {text!r}: beside the part, where {sides[1]} is {low:g} to {high:g}")
    return axis, offset


def letters_at(text: str, middle: Floats, plain: Plain) -> Lettering:
    """The name of a view about a point; plain: what sets letters."""
    x, y = middle.tolist()
    return plain(text, (x, y), size_mm=LETTERS_MM, align="centre", level="middle")


# Interrupted views: what a long part has all along is left out, and the rest moves together.
#
# Source: ISO 128-3 (interrupted views).

BETWEEN_MM = 5.0
"""How far on paper what is shown on both sides of a break is apart."""

LEAST_LEFT_OUT = 0.5
"""Gaps are no wider than so much of what they stand for."""

BREAK_BEYOND_MM, ZIGZAG_MM, ZIGZAGS_MM = 2.5, 2.0, 60.0
"""How far break lines go on beyond the part, half of the width and of the length of a zigzag in them, and how far
zigzags are apart at the least."""

_LEFT_OUT = re.compile(rf"\s*([xyz])\s*=\s*({NUMBER})\s*\.\.\s*({NUMBER})\s*")


@dataclass(frozen=True)
class Interruptions:
    """What is left out of a long part in its views: from low to high along axes (0, 1, 2), upwards along each."""

    ranges: tuple[tuple[int, float, float], ...] = ()

    @classmethod
    def of(cls, asked: str | Iterable[str], bounds: Floats) -> Interruptions:
        """Those that texts such as x=40..160 say, of a part within bounds (2,3).

        Errors: InputError for other texts, for what reaches beyond the part, and for what is left out twice.
        """
        found = []
        for text in [asked] if isinstance(asked, str) else asked:
            said = _LEFT_OUT.fullmatch(text)
            if said is None:
                raise InputError(f"interrupted {text!r}: expected an axis, from and to, such as x=40..160")
            axis, low, high = "xyz".index(said[1]), float(said[2]), float(said[3])
            least, most = bounds[:, axis].tolist()
            if not least < low < high < most:
                reach = f"where {said[1]} is {least:g} to {most:g}"
                raise InputError(f"interrupted {text!r}: expected from and to inside of the part, {reach}")
            found.append((axis, low, high))
        found.sort()
        for one, other in pairwise(found):
            if one[0] == other[0] and not one[2] < other[1]:
                raise InputError(f"interrupted: {'xyz'[one[0]]}={other[1]:g}..{other[2]:g} is left out twice")
        return cls(tuple(found))

    def moved(self, points: Floats, factor: float) -> Floats:
        """(n,3) where points (n,3) of the part are in the shorter one, at so many mm for a unit of the world; what is
        left out stands in the gaps."""
        found = np.array(points, dtype=np.float64)
        for axis, low, high in self.ranges:
            gap = min(BETWEEN_MM / factor, LEAST_LEFT_OUT * (high - low))
            found[:, axis] -= np.clip((points[:, axis] - low) / (high - low), 0.0, 1.0) * (high - low - gap)
        return found

    def check_shown(self, points: Floats, what: str) -> None:
        """InputError for points (n,3), of a thing, in what is left out."""
        for axis, low, high in self.ranges:
            if ((points[:, axis] > low) & (points[:, axis] < high)).any():
                raise InputError(f"{what}: in what is left out, {'xyz'[axis]}={low:g}..{high:g}")

    def kept(self, axis: int) -> tuple[tuple[float, float], ...]:
        """From where to where along an axis the part is shown."""
        own = [(low, high) for one, low, high in self.ranges if one == axis]
        starts, ends = [-math.inf, *(high for _, high in own)], [*(low for low, _ in own), math.inf]
        return tuple(zip(starts, ends, strict=True))


def break_line(low: float, high: float) -> Floats:
    """(k,2) a break line across a part from low to high on the page, along y: with zigzags, about x = 0."""
    count = max(1, int((high - low) / ZIGZAGS_MM))
    points = [(0.0, low - BREAK_BEYOND_MM)]
    size = min(ZIGZAG_MM, 0.25 * (high - low))
    for number in range(count):
        middle = low + (number + 0.5) * (high - low) / count
        points += [
            (0.0, middle - size),
            (-size, middle - 0.3 * size),
            (size, middle + 0.3 * size),
            (0.0, middle + size),
        ]
    return np.array([*points, (0.0, high + BREAK_BEYOND_MM)])


# Details and local sections: circles in views, magnified apart, or cut open.
#
# Source: ISO 128-3 (enlarged views, local cuts).

LARGER = 2.5
"""Details without a scale of their own are no larger than so many times their view."""

RING_SIDES = 96
"""Sides of the polygon that stands for the circle around a detail."""

WAVES = ((5, 0.05, 0.0), (9, 0.03, 1.0))
"""How the border of a local section waves, as if by hand: how often, how far in radii, and where it begins."""


@dataclass(frozen=True)
class ViewCircle:
    """A circle in a view, about a point of the world: of a detail, or of a local section through that point.

    letter: of the detail; radius: in the world; scale: of the detail, if it has one of its own.
    """

    view: str
    centre: tuple[float, float, float]
    radius: float
    letter: str = ""
    scale: DrawingScale | None = None

    @classmethod
    def of(cls, text: str, what: str, names: Sequence[str], letter: str = "") -> ViewCircle:
        """The circle that a text says: front:20,0,8,6 or, for details, front:20,0,8,6,5:1. what: what it is of.

        Errors: InputError for other texts, and for views that are not on the sheet.
        """
        view, _, rest = text.partition(":")
        parts = [part.strip() for part in rest.split(",")]
        try:
            x, y, z, radius = (float(part) for part in parts[:4])
        except ValueError:
            x = y = z = radius = math.nan
        with_scale = what == "detail" and len(parts) == 5
        if not all(map(math.isfinite, (x, y, z))) or not 0.0 < radius < math.inf or len(parts) != 4 + with_scale:
            usual = "front:20,0,8,6, or front:20,0,8,6,5:1 with a scale" if what == "detail" else "front:20,0,8,6"
            raise InputError(f"{what} {text!r}: expected a view, a point and a radius such as {usual}")
        if view.strip() not in names:
            raise InputError(f"{what} {text!r}: there is no view {view.strip()!r} on the sheet: {', '.join(names)}")
        return cls(view.strip(), (x, y, z), radius, letter, DrawingScale.of(parts[4]) if with_scale else None)

    def factor(self, factor: float) -> float:
        """Mm on paper for a unit of the world in the detail; factor: in its view."""
        if self.scale is not None:
            return self.scale.factor
        return DrawingScale.largest_standard(LARGER * factor).factor

    def scale_text(self, factor: float) -> str:
        """The scale of the detail as text."""
        return str(self.scale or DrawingScale.largest_standard(LARGER * factor))

    def ring(self, middle: Floats, radius: float) -> Floats:
        """(k,2) the circle on the page."""
        turn = 2.0 * np.pi * np.arange(RING_SIDES) / RING_SIDES
        return middle + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)

    def waving_ring(self, middle: Floats, radius: float) -> Floats:
        """(k,2) the same, as if drawn by hand."""
        turn = 2.0 * np.pi * np.arange(RING_SIDES) / RING_SIDES
        waves = np.sum([height * np.sin(often * turn + begin) for often, height, begin in WAVES], axis=0)
        ways = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return np.asarray(middle + (radius * (1.0 + waves))[:, None] * ways)

    def layers(self, middle: Floats, radius: float, lines: Floats, plain: Plain) -> tuple[Layer, ...]:
        """The circle of a detail in its view, and its letter where it is on the least of lines (s,2,2) on the page."""
        ways = np.radians([45.0, 135.0, 315.0, 225.0, 0.0, 90.0, 180.0, 270.0])
        places = middle + (radius + 0.9 * LETTERS_MM) * np.stack([np.cos(ways), np.sin(ways)], axis=1)
        half = 0.7 * LETTERS_MM
        boxes = places[:, None] + half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        line, box = near_boxes(lines[:, 0], lines[:, 1], boxes)
        low, high = inside_box(lines[line, 0], lines[line, 1], boxes[box])
        within = np.maximum(high - low, 0.0) * np.hypot(*(lines[line, 1] - lines[line, 0]).T)
        best = int(np.argmin(np.bincount(box, within, minlength=len(boxes))))
        return (
            Layer("thin", THIN, (page_strokes([], [self.ring(middle, radius)]),)),
            letter_layer([letters_at(self.letter, places[best], plain)]),
        )
