"""The verb technical_sheet: views, sections, dimensions and centre lines of a part on one sheet; and turntables."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any, Literal, cast, get_args

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.batch.running import results
from vectorplot.batch.tasks import Submits
from vectorplot.drawing.dashes import CHAIN_MM, dashed
from vectorplot.drawing.drawing import Drawing, Layer, Paths
from vectorplot.drawing.labels import LETTERS as LETTERS_OF
from vectorplot.drawing.sheets import Sheet, page_strokes
from vectorplot.drawing.strokes import clipped, inside_ring, outside_ring
from vectorplot.drawing.title_block import (
    ASME_STEPS,
    BLOCK,
    ISO_STEPS,
    DrawingScale,
    Plain,
    TitleBlock,
    drawing_space,
    frame_layers,
    read_template,
)
from vectorplot.effects.cuts import InSpace, cut, cut_scene
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import VIEWS, Camera, Point
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.io.anything import scene_of
from vectorplot.io.mesh_file import stood_up
from vectorplot.pictures.draw import draw
from vectorplot.pictures.pipeline import StageReport, stoppable
from vectorplot.pictures.sheet_annotations import (
    BALLOONS_ROOM_MM,
    NUMBERED,
    TEXT_MM,
    Annotation,
    AssemblyPart,
    OverallDimension,
    RoundEdge,
    balloon_layers,
    centre_lines_of,
    clear_of_each_other,
    label_moved,
    level_measures,
    moved_together,
    overall_dimensions,
    parts_of,
    round_edges,
    views_of,
    without_annotations,
    written_on,
)
from vectorplot.pictures.sheet_views import (
    LARGER,
    LETTERS,
    ROOM_MM,
    THIN,
    Arrangement,
    Interruptions,
    SheetSection,
    SheetView,
    StandardScales,
    ViewCircle,
    Zone,
    break_line,
    fitting_scale,
    named_layer,
    roomiest,
    sections_of,
)
from vectorplot.scene.annotations import annotation_points, only_annotations
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.item import Item
from vectorplot.scene.labels import Along, AtVertex, Measures, OnCurve
from vectorplot.scene.page import MM_PER_INCH, Page, SheetSettings
from vectorplot.scene.placement import camera_of, page_of
from vectorplot.scene.scene import Scene, together
from vectorplot.scene.surface_lines import NO_LINES
from vectorplot.tolerances import EDGE_ON_SINE, SAME_PLANE_OF_EXTENT
from vectorplot.words import TEXT_WORDS, LineKind, check_word, unknown

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

USUAL_MM = 200.0
"""How large a part is on paper before its scale is known."""

SCALES_TRIED = 3
"""How often a scale is chosen anew for dimensions that need more room in it."""

SEAM_MM = 4.0
"""How far the centre line of a half section goes on beyond the part."""


Hidden = Literal["none", "dashed", "solid"]
Curves = Literal["bezier", "polyline", "arcs"]


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
    details: tuple[ViewCircle, ...]
    breakouts: tuple[ViewCircle, ...]
    level: bool
    parts: tuple[AssemblyPart, ...]
    left_out: Interruptions
    uncut: frozenset[str]

    @property
    def balloons_in(self) -> str:
        """The view that has the balloons of parts: the pictorial one, or else the first."""
        return "iso" if "iso" in self.names else self.names[0]

    @property
    def bounds(self) -> Floats:
        return self.scene.bounds

    @property
    def middle(self) -> Floats:
        """(3,) of the part."""
        return np.asarray(self.bounds.mean(axis=0))

    def whole_reach(self, camera: Camera) -> Floats:
        """(2,2) how far it reaches from its middle across a view, with nothing left out."""
        return np.tile(matmul(np.abs(camera.axes[:2]), 0.5 * np.ptp(self.bounds, axis=0)), (2, 1))

    def shown(self, points: Floats, factor: float) -> Floats:
        """(n,3) where points are in what is shown of the part, from its middle."""
        return np.asarray(self.left_out.moved(points, factor) - self.shown_middle(factor))

    def shown_bounds(self, factor: float) -> Floats:
        """(2,3) of what is shown of the part, moved together."""
        return self.left_out.moved(self.bounds, factor)

    def shown_middle(self, factor: float) -> Floats:
        """(3,) of that."""
        return np.asarray(self.shown_bounds(factor).mean(axis=0))

    def notes(self, factor: float) -> dict[str, list[Annotation]]:
        """The annotations of each view, clear of each other where a unit of the world is so many mm on paper, and
        centre lines of each section; a pictorial view has none."""
        flat = [(name, camera) for name, camera in zip(self.names, self.cameras, strict=True) if name != "iso"]
        extent = float(np.ptp(self.bounds, axis=0).max())
        found = views_of(self.annotations, [camera for _, camera in flat], extent, self.edges)
        notes = {
            name: clear_of_each_other(own, camera, factor) for (name, camera), own in zip(flat, found, strict=True)
        }
        notes |= {section.letter: self.centre_lines_in(section, extent) for section in self.sections}
        return {name: [] for name in self.names} | notes

    def centre_lines_in(self, section: SheetSection, extent: float) -> list[Annotation]:
        """The centre lines that a section shows: those in its planes, and the marks of circles behind these."""
        camera, zero = camera_of(section.like, self.scene), SAME_PLANE_OF_EXTENT * extent
        known = [one for one in self.annotations if one.is_in_every_view]
        if section.hinge is not None:
            moved = [
                (zone, replace(one, scene=section.shown(one.scene, zone))) for zone in section.zones for one in known
            ]
            known = [one for zone, one in moved if zone.holds(one.points[:, section.across], zero)]
        square = [one for one in known if one.is_square_to(camera, extent)]
        marks = [one.is_mark and self._is_behind(one, section, camera, zero) for one in square]
        off = [float(section.offset_near(one.points).max()) for one in square]
        return [one for one, kept, far in zip(square, marks, off, strict=True) if kept or far <= zero]

    def _is_behind(self, mark: Annotation, section: SheetSection, camera: Camera, zero: float) -> bool:
        """Whether a section leaves something of the circles along the axis of a centre mark."""
        axis, centre = section.axis, mark.points.mean(axis=0)
        offset = section.zone_at(centre).offset
        if offset is None or section.hinge is not None:
            return True
        along = [edge.centre for edge in self.edges if edge.axis == axis]
        places = [place[axis] for place in along if float(np.abs(np.delete(centre - place, axis)).max()) <= zero]
        towards = float(camera.axes[2, axis])
        # Marks of no round edges are where the user wants them.
        return not places or min(towards * (place - offset) for place in places) <= zero

    def reach(self, camera: Camera, scenes: Iterable[Scene], factor: float) -> Floats:
        """(2,2) how far scenes reach from the middle of the part across a view, in the world."""
        found = []
        for scene in scenes:
            bounds = self.left_out.moved(scene.bounds, factor)
            middle, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
            flat = camera.axes[:2]
            away, wide = matmul(flat, middle - self.shown_middle(factor)), matmul(np.abs(flat), half)
            found.append([wide - away, wide + away])
        return np.asarray(np.max(found, axis=0))

    def views(self, factor: float) -> tuple[SheetView, ...]:
        """How far each view reaches, and what is around it, with annotations as at a factor of the scale."""
        notes = self.notes(factor)
        found = []
        for name, camera in zip(self.names, self.cameras, strict=True):
            rooms = [one.line_room_mm(camera) for one in self.sections if one.told_in(self.names) == name]
            world = self.reach(camera, [self.scene], factor)
            if self.parts and name == self.balloons_in:
                rooms.append(np.tile([BALLOONS_ROOM_MM, 0.0], (2, 1)))
            found.append(self._view(name, camera, "", world, notes[name], rooms, factor))
        above = [np.array([(0.0, 0.0), (0.0, ROOM_MM)])]
        for section in self.sections:
            camera = camera_of(section.like, self.scene)
            world = self.reach(camera, [section.shown(self.scene, zone) for zone in section.zones], factor)
            beyond = [np.array([(0.0, 0.0), (0.0, ROOM_MM + SEAM_MM * section.is_half)])]
            found.append(self._view(section.letter, camera, section.like, world, notes[section.letter], beyond, factor))
        for one in self.details:
            scale = 0.0 if one.scale is None else one.scale.factor
            world = np.full((2, 2), LARGER * one.radius * (one.scale is None))
            mm = np.full((2, 2), scale * one.radius) + above[0]
            like = next((section.like for section in self.sections if section.letter == one.view), one.view)
            camera = self.camera(one.view)
            found.append(SheetView(one.letter, camera, like, world, mm))
        return tuple(found)

    def _view(
        self,
        name: str,
        camera: Camera,
        like: str,
        world: Floats,
        notes: Sequence[Annotation],
        rooms: Sequence[Floats],
        factor: float,
    ) -> SheetView:
        """A view that reaches so far with its annotations; rooms: what is around it."""
        for one in notes:
            places = matmul(self.shown(one.points, factor), camera.axes[:2].T)
            world = np.maximum(world, [-places.min(axis=0), places.max(axis=0)])
        # Cutting lines end outside of dimensions.
        mm = np.maximum(TEXT_MM if notes or self.scene.labels else 0.0, self.overall_room_mm(name, camera))
        return SheetView(name, camera, like, world, mm + np.max([np.zeros((2, 2)), *rooms], axis=0))

    def camera(self, view: str) -> Camera:
        """That of a main view or a section."""
        named = dict(zip(self.names, self.cameras, strict=True))
        like = next((section.like for section in self.sections if section.letter == view), view)
        return named[like] if like in named else camera_of(like, self.scene)

    def overall_room_mm(self, name: str, camera: Camera) -> Floats:
        """(2,2) what the dimensions of the whole part need around it in a view."""
        rooms = [one.room_mm(camera) for one in self.overall if one.view == name]
        return np.asarray(np.max([np.zeros((2, 2)), *rooms], axis=0))

    def on_page(self, camera: Camera, point: Sequence[float] | Floats, factor: float) -> Floats:
        """(2,) where a point of the world is in a view, in mm from the middle of the part."""
        return factor * matmul(camera.axes[:2], self.shown(np.array([point], dtype=np.float64), factor)[0])


@dataclass(frozen=True, eq=False)
class _Views:
    """The views of a part at a scale, as drawings on pages of their own; factor: mm on paper for a unit of the world.

    hidden: what becomes of hidden lines in main views; curves: how those leave that are whole; options: those of draw
    for every view; spacing_mm: of hatches, see cut.
    """

    part: _Part
    factor: float
    spacing_mm: float | None
    hidden: Hidden
    curves: Curves
    options: Mapping[str, Any]

    def drawing(self, view: SheetView, notes: Sequence[Scene]) -> Drawing:
        """A view with its notes, whose middle is that of the part."""
        page = self._page(view.reach_mm(self.factor))
        if self.part.left_out.ranges:
            moved = partial(self.part.left_out.moved, factor=self.factor)
            bare = replace(self, part=replace(self.part, scene=_labels_alone(self.part.scene, moved)))
            near = [moved_together(one, moved) for one in notes]
            return bare._with_notes([self._interrupted(view, notes, page)], self._aimed(view.camera), page, near)
        section = self._section(view)
        if any(one.view == view.name for one in self.part.breakouts) or (section and len(section.zones) > 1):
            return self._with_notes(self._parts(view, notes, page), view.camera, page, notes)
        return self._drawn(self._cut_scene(view), view.camera, page, notes, self._hidden(view))

    @staticmethod
    def _page(reach_mm: Floats) -> Page:
        """A page for what reaches so far (2,2) from its middle, with a border."""
        width, height = (2.0 * (reach_mm.max(axis=0) + BORDER_MM)).tolist()
        return Page(width, height, 0.0)

    def _section(self, view: SheetView) -> SheetSection | None:
        return next((one for one in self.part.sections if one.letter == view.name), None)

    def _hidden(self, view: SheetView) -> Hidden:
        return self.hidden if view.name in self.part.names and view.name != "iso" else "none"

    def _cut_scene(self, view: SheetView) -> Scene:
        """The part, in a section behind its plane."""
        section = self._section(view)
        scene = self.part.scene
        if section is None:
            return scene
        (zone, *_) = section.zones
        return self._cut(section.shown(scene, zone), section.axis, zone.offset, view.camera)

    def _parts(self, view: SheetView, notes: Sequence[Scene], page: Page) -> list[Drawing]:
        """What a view shows without its notes, which are there, as polylines on a page."""
        part, section = self.part, self._section(view)
        if section is not None and len(section.zones) > 1:
            found = [self._zone(section, zone, view.camera, page) for zone in section.zones]
            return [*found, *self._seam(section, view, notes, page)]
        whole = self._drawn(
            replace(self._cut_scene(view), labels=()), view.camera, page, (), self._hidden(view), curves="polyline"
        )
        found = []
        middle = 0.5 * np.array([page.width_mm, page.height_mm])
        for one in (one for one in part.breakouts if one.view == view.name):
            away = self.factor * matmul(view.camera.axes[:2], np.array(one.centre) - part.middle)
            ring = one.waving_ring(middle + away, self.factor * one.radius)
            axis = int(np.argmax(np.abs(view.camera.axes[2])))
            opened = self._cut(part.scene, axis, one.centre[axis], view.camera)
            inner = self._drawn(replace(opened, labels=()), view.camera, page, (), "none", curves="polyline")
            found.append(_of_strokes(inner, partial(inside_ring, ring=ring)))
            whole = _of_strokes(whole, partial(outside_ring, ring=ring))
            found.append(self._border(ring, view.camera, page))
        return [whole, *found]

    def _interrupted(self, view: SheetView, notes: Sequence[Scene], page: Page) -> Drawing:
        """What a view shows of an interrupted part, moved together, with break lines; without its notes."""
        camera = view.camera
        flat = np.argmax(np.abs(camera.axes[:2]), axis=1)
        if float(np.abs(camera.axes[[0, 1], flat]).min()) < 1.0 - EDGE_ON_SINE:
            return self._drawn(self._in_pieces(camera), self._aimed(camera), page, (), self._hidden(view))
        whole = self._page(self.factor * np.maximum(view.world, self.part.whole_reach(camera)) + view.mm)
        parts = self._parts(view, notes, whole)
        columns, rows = (self._bands(camera, row, whole, page) for row in (0, 1))
        sheet = Sheet(page)
        for column, row in product(columns, rows):
            box = (column.low, row.low, column.high, row.high)
            for one in parts:
                sheet = sheet.place(_of_strokes(one, partial(clipped, rectangle=box)), column.shift, row.shift)
        outline = self._outline(camera, whole)
        lines = [
            *_break_lines(outline, columns, rows, upright=True),
            *_break_lines(outline, rows, columns, upright=False),
        ]
        breaks = Drawing(page.width_mm, page.height_mm, (Layer("thin", THIN, (page_strokes(lines),)),), ())
        return sheet.place(breaks, 0.0, 0.0).drawing()

    def _bands(self, camera: Camera, row: int, whole: Page, page: Page) -> list[_Band]:
        """What is shown of the part, in a direction on the page (0: rightwards, 1: upwards) along one of its axes."""
        part = self.part
        axis = int(np.argmax(np.abs(camera.axes[row])))
        scale = math.copysign(self.factor, camera.axes[row, axis])
        sizes = [(one.width_mm, one.height_mm)[row] for one in (whole, page)]
        middles = [float(middle[axis]) for middle in (part.middle, part.shown_middle(self.factor))]
        found = []
        for ends in part.left_out.kept(axis):
            places = [0.5 * sizes[0] + scale * (end - middles[0]) for end in ends]
            low, high = (min(max(place, 0.0), sizes[0]) for place in sorted(places))
            one = next((end for end in ends if math.isfinite(end)), middles[0])
            moved = float(part.left_out.moved(np.full((1, 3), one), self.factor)[0, axis])
            shift = 0.5 * (sizes[1] - sizes[0]) + scale * ((moved - middles[1]) - (one - middles[0]))
            breaks = tuple(place for place in places if math.isfinite(place))
            found.append(_Band(low, high, shift, breaks))
        return found

    def _in_pieces(self, camera: Camera) -> Scene:
        """What is shown of an interrupted part, in space."""
        part, pieces = self.part, []
        for kept in product(*(part.left_out.kept(axis) for axis in range(3))):
            sides = [(axis, sign, end) for axis, ends in enumerate(kept) for sign, end in zip("<>", ends, strict=True)]
            gone = [f"{'xyz'[axis]} {sign} {end!r}" for axis, sign, end in sides if math.isfinite(end)]
            left = cut_scene(cut(replace(part.scene, labels=()), gone), camera, _page_at(self.factor))
            items = [replace(one, curves=NO_LINES) if one.is_cut_face else one for one in left.items]
            at = np.array([[next((end for end in ends if math.isfinite(end)), 0.0) for ends in kept]])
            way = (part.left_out.moved(at, self.factor) - at)[0]
            pieces.append(replace(left, items=tuple(items)).moved(*way.tolist()))
        return together(pieces)

    def _aimed(self, camera: Camera) -> Camera:
        """A camera of a view, at the middle of what is shown of the part."""
        way = self.part.shown_middle(self.factor) - self.part.middle
        (x, y, z), (u, v, w) = ((np.asarray(place) + way).tolist() for place in (camera.eye, camera.target))
        return replace(camera, eye=(x, y, z), target=(u, v, w))

    def detail(self, one: ViewCircle, notes: Sequence[Scene]) -> Drawing:
        """A detail with its circle, in the middle of its page; notes: the centre lines of its view."""
        factor = one.factor(self.factor)
        radius = factor * one.radius
        page = Page(2.0 * radius + 1.0, 2.0 * radius + 1.0, 0.0)
        camera = self.part.camera(one.view)
        larger = replace(self, factor=factor)
        way = np.array(one.centre) - self.part.middle
        (x, y, z), (u, v, w) = ((np.asarray(place) + way).tolist() for place in (camera.eye, camera.target))
        moved = replace(camera, eye=(x, y, z), target=(u, v, w))
        scene = replace(self.part.scene, labels=())
        section = next((section for section in self.part.sections if section.letter == one.view), None)
        if section is not None:
            zone = section.zone_at(one.centre)
            scene = section.shown(scene, zone)
            scene = larger._cut(scene, section.axis, zone.offset, camera)
        hidden: Hidden = "none" if section is not None or one.view == "iso" else self.hidden
        drawn = larger._drawn(scene, moved, page, notes, hidden, curves="polyline")
        ring = one.ring(np.full(2, radius + 0.5), radius)
        inner = _of_strokes(drawn, partial(inside_ring, ring=ring))
        return replace(inner, layers=(*inner.layers, Layer("thin", THIN, (page_strokes([], [ring]),))))

    def _drawn(
        self,
        scene: Scene,
        camera: Camera,
        page: Page,
        notes: Sequence[Scene],
        hidden: Hidden,
        curves: Curves | None = None,
    ) -> Drawing:
        """What a camera sees of a scene, the middle of which is that of the page."""
        return draw(
            together([scene, *notes]),
            replace(camera, height=page.height_mm / self.factor),
            page=page,
            fit=False,
            lines=LINES,
            hidden=hidden,
            pens=PENS,
            dashes=DASHES,
            curves=curves or self.curves,
            # Views are of parts, not of what these show.
            reflections=0,
            **self.options,
        )

    def _cut(self, scene: Scene, axis: int, offset: float | None, camera: Camera) -> Scene:
        """What is left of a scene behind a plane across an axis; all of it where there is no plane."""
        if offset is None:
            return scene
        left = [item for item in scene.items if item.name in self.part.uncut]
        through = {item.name for item in left if np.ptp(np.sign(Scene((item,)).bounds[:, axis] - offset)) == 2.0}
        items = [item.name for item in scene.items if item.name not in through]
        condition = f"{'xyz'[axis]} = {offset!r}"
        return cut_scene(
            cut(scene, [condition], items=items, spacing_mm=self.spacing_mm), camera, _page_at(self.factor)
        )

    def _zone(self, section: SheetSection, zone: Zone, camera: Camera, page: Page) -> Drawing:
        """What a section shows in one of its zones."""
        scene = replace(section.shown(self.part.scene, zone), labels=())
        scene = self._cut(scene, section.axis, zone.offset, camera)
        drawn = self._drawn(scene, camera, page, (), "none", curves="polyline")
        level, along = (camera.axes[axis, section.across] for axis in (0, 1))
        axis, sign = (0, level) if abs(level) > abs(along) else (1, along)
        size = (page.width_mm, page.height_mm)
        ends = [
            0.5 * size[axis] + self.factor * (place - self.part.middle[section.across]) * math.copysign(1.0, sign)
            for place in (zone.low, zone.high)
        ]
        low, high = max(min(ends), 0.0), min(max(ends), size[axis])
        box = (low, 0.0, high, size[1]) if axis == 0 else (0.0, low, size[0], high)
        return _of_strokes(drawn, partial(clipped, rectangle=box))

    def _seam(self, section: SheetSection, view: SheetView, notes: Sequence[Scene], page: Page) -> list[Drawing]:
        """The centre line between the halves of a half section, unless its view has one there."""
        if not section.is_half:
            return []
        place = self.part.middle.copy()
        place[section.across] = section.zones[0].high
        low, high = (
            place + sign * (0.5 * float(np.ptp(self.part.bounds[:, section.turn_axis])) + SEAM_MM / self.factor) * way
            for way in (np.eye(3)[section.turn_axis],)
            for sign in (-1.0, 1.0)
        )
        flat = view.camera.axes[:2]
        ends = matmul(np.array([low, high]) - self.part.middle, flat.T)
        zero = SAME_PLANE_OF_EXTENT * float(np.ptp(self.part.bounds, axis=0).max())
        for scene in notes:
            across = matmul(annotation_points(scene) - self.part.middle, flat.T) - ends[0]
            if (np.abs(across[:, int(np.argmin(np.abs(np.ptp(ends, axis=0))))]) <= zero).all():
                return []
        line = 0.5 * np.array([page.width_mm, page.height_mm]) + self.factor * ends
        strokes = dashed(page_strokes([line]), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2])
        return [Drawing(page.width_mm, page.height_mm, (Layer("thin", THIN, (strokes,)),), ())]

    def _border(self, ring: Floats, camera: Camera, page: Page) -> Drawing:
        """The border of a local section, as far as it is on the part."""
        import shapely

        line = shapely.line_merge(shapely.intersection(shapely.LinearRing(ring), self._outline(camera, page)))
        parts = [shapely.get_coordinates(part) for part in shapely.get_parts(line)]
        layer = Layer("thin", THIN, (page_strokes([part for part in parts if len(part) > 1]),))
        return Drawing(page.width_mm, page.height_mm, (layer,), ())

    def _outline(self, camera: Camera, page: Page) -> Any:
        """The region of shapely that the part covers in a view."""
        import shapely

        items = self.part.scene.items
        outline = draw(
            replace(self.part.scene, labels=(), items=tuple(replace(item, lines=None, exact=None) for item in items)),
            replace(camera, height=page.height_mm / self.factor),
            page=page,
            fit=False,
            lines="outline",
            curves="polyline",
        )
        region = shapely.Polygon()
        for paths in (paths for layer in outline.layers for paths in layer.strokes):
            for stroke in np.split(paths.points, paths.offsets[1:-1]):
                region = shapely.symmetric_difference(region, shapely.Polygon(stroke))
        return region

    def _with_notes(self, drawings: Sequence[Drawing], camera: Camera, page: Page, notes: Sequence[Scene]) -> Drawing:
        """Drawings on one page, and notes of the view over them."""
        sheet = Sheet(page)
        for one in drawings:
            sheet = sheet.place(one, 0.0, 0.0)
        if notes or self.part.scene.labels:
            with_lines = only_annotations(together([self.part.scene, *notes]))
            sheet = sheet.place(self._drawn(with_lines, camera, page, (), "none"), 0.0, 0.0)
        return sheet.drawing()


@dataclass(frozen=True)
class _Band:
    """What is shown of an interrupted part: from low to high on the page of the whole, in one direction; how far it is
    moved to its page; and where its breaks are on that of the whole."""

    low: float
    high: float
    shift: float
    breaks: tuple[float, ...]


def _break_lines(region: Any, bands: Sequence[_Band], across: Sequence[_Band], *, upright: bool) -> list[Floats]:
    """Break lines (k,2) at the ends of bands, where a region of shapely is in bands across them."""
    import shapely

    found = []
    for band, side in product(bands, across):
        for place in band.breaks:
            ends = np.array([(place, side.low), (place, side.high)])
            line = shapely.intersection(region, shapely.LineString(ends if upright else ends[:, ::-1]))
            for part in shapely.get_parts(line):
                along = shapely.get_coordinates(part)[:, 1 if upright else 0]
                if len(along) < 2:
                    continue
                low, high = float(along.min()), float(along.max())
                points = break_line(low + side.shift, high + side.shift) + np.array([place + band.shift, 0.0])
                found.append(points if upright else points[:, ::-1])
    return found


def _labels_alone(scene: Scene, moved: Callable[[Floats], Floats]) -> Scene:
    """The labels of a part without it, where its points (n,3) have moved.

    Errors: InputError for labels of curves."""
    items = {item.name: item for item in scene.items}
    labels = []
    for label in scene.labels:
        if isinstance(label.at, OnCurve | Along):
            raise InputError(f"label {label.name}: no curve of an interrupted part has labels")
        if isinstance(label.at, AtVertex) and label.at.item in items:
            x, y, z = items[label.at.item].mesh.vertices[label.at.vertex].tolist()
            label = replace(label, at=(x, y, z))
        labels.append(label_moved(label, moved))
    return replace(scene, items=(), labels=tuple(labels))


def _of_strokes(drawing: Drawing, kept: Callable[[Paths], Paths]) -> Drawing:
    """A drawing of polylines alone, with the parts of them that are kept."""
    layers = [
        replace(layer, marks=tuple(kept(mark) for mark in layer.marks if isinstance(mark, Paths)))
        for layer in drawing.layers
    ]
    return replace(drawing, layers=tuple(layers))


@stoppable
def technical_sheet(
    scene: object,
    *,
    views: str | Iterable[str] | None = None,
    up: Point | None = None,
    scale: str | None = None,
    unit: str | None = None,
    standard: Literal["iso", "asme"] | None = None,
    measured_in: str | None = None,
    decimals: int | None = None,
    zeros: bool | None = None,
    comma: bool | None = None,
    projection: Literal["first", "third"] | None = None,
    page: Page | str | None = None,
    section: str | Iterable[str] | None = None,
    uncut: str | Iterable[str] | None = None,
    cut_spacing_mm: float | None = None,
    detail_view: str | Iterable[str] | None = None,
    breakout: str | Iterable[str] | None = None,
    interrupted: str | Iterable[str] | None = None,
    dimensions: bool | None = None,
    centre_lines: bool | None = None,
    frame: bool | None = None,
    block: bool | None = None,
    title: str | None = None,
    author: str | None = None,
    date: str | None = None,
    sheet: str = "1",
    fields: Mapping[str, str] | None = None,
    block_template: str | os.PathLike[str] | None = None,
    balloons: bool | None = None,
    parts_list: bool | None = None,
    made_of: Mapping[str, str] | None = None,
    hidden: Hidden | None = None,
    text: Literal["strokes", "real"] = "strokes",
    crease_angle_deg: float = 25.0,
    curves: Curves = "bezier",
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
    standard : {"iso", "asme"}
        What is usual where nothing else is said: first angle, A3, scales of ISO 5455, measures above their lines; or
        third angle, tabloid, scales of 1, 2, 4 and 8, level measures that interrupt their lines, and in inches zeros
        at the end of decimals and none before the point.
    measured_in : {"mm", "cm", "m", "in"}, optional
        The unit that measures are written in, all of them; where None mm.
    decimals, zeros, comma : int, bool and bool, optional
        How they are written, see Measures; where None as the scene says, or as is usual.
    projection : {"first", "third"}, optional
        First or third angle: whether a view stands opposite to the side it is seen from, as in Europe, or on that
        side, as in America.
    page : Page or str, optional
        Or its name or size, such as "A3" or "200x150"; one that is named lies on the side that gives the views more
        room.
    section : str or iterable of str
        Planes such as y=12, each of which gives a view of the part without what lies before the plane, like the main
        view of that direction: A-A, B-B, and so on. Cut faces are hatched; in a view that sees the plane edge-on a line
        with arrows shows where it is. "half y=12" cuts what is at the right in its view, "y=12 | x=20 | y=30" goes on
        in another plane at a step, and "aligned z at 0,0 from 180 to 60" has two planes through an axis parallel to z,
        at these angles, of which both are shown in full. "x+y=30" or a plane of any other direction is shown in full
        too: the part is turned, on the shortest way, so that it is across x, y or z.
    uncut : str or iterable of str
        Parts, or items and groups, that sections leave whole, such as bolts and shafts; a name is also that of those
        that have a number behind it.
    cut_spacing_mm : float, optional
        From stroke to stroke of these hatches, 0.1 or more; where None about 2.4, on narrow faces half as much.
    detail_view : str or iterable of str
        Circles in views, such as "front:20,0,8,6": a view or a section, a point and a radius. What is inside is shown
        apart, larger, at the next standard scale or at one of its own, as in "A:20,0,8,6,5:1".
    breakout : str or iterable of str
        The same, for local sections: inside of the circle the part is cut through the point, across the view.
    interrupted : str or iterable of str
        What is left out of a long part, such as "x=40..160": the rest moves together, with break lines between, and
        measures stay what they are. Aligned and oblique sections do not go with it.
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
    fields : mapping of str to str, optional
        Free fields of the title block, by their names: each where the template names it, else in a row on top.
    block_template : path, optional
        A TOML file that says which rows and cells the title block has; where None one after ISO 7200.
    balloons : bool
        The pictorial view, or else the first one, has the numbers of parts around it, with lines to their edges.
    parts_list : bool
        A list of these parts stands on the title block, with how many there are of each: items of one group are one
        part, those whose names differ by a number at the end and that have one shape are the same.
    made_of : mapping of str to str, optional
        The materials of parts, by their names: a column of that list.
    hidden : {"none", "dashed", "solid"}, optional
        See draw, of main views; where None dashed.
    text : {"strokes", "real"}
        See draw.
    crease_angle_deg : float
        See draw.
    curves : {"bezier", "polyline", "arcs"}
        See draw; views that are cut by circles and zones are polylines.
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
        See draw; for views that are unknown, twice or none; for sections that are none, or beside the part; for details
        and local sections that are none, or of no view; for a
        scale that is too large for the page, with the largest that fits; for a page without room, and a title without
        room in its block; for an unknown unit.

    Warns
    -----
    InputWarning
        Of dimensions that are square to none of the views: they are not shown.

    Notes
    -----
    What is None is as the scene says (`Scene.sheet`), or else as is usual. The isometric view is a projection at the
    same scale: edges along the axes are 0.816 times as long in it.

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
    shown = shown_apart(scene_of(scene))
    of_scene = shown.sheet or SheetSettings()
    asked = SheetSettings(
        views=_texts(views, ","),
        scale=scale,
        unit=unit,
        standard=standard,
        measured_in=measured_in,
        projection=projection,
        section=_texts(section),
        uncut=_texts(uncut),
        detail_view=_texts(detail_view),
        breakout=_texts(breakout),
        interrupted=_texts(interrupted),
        dimensions=dimensions,
        centre_lines=centre_lines,
        frame=frame,
        block=block,
        author=author,
        date=date,
        fields=tuple({**dict(of_scene.fields or ()), **(fields or {})}.items()),
        made_of=tuple({**dict(of_scene.made_of or ()), **(made_of or {})}.items()),
        block_template=None if block_template is None else os.fspath(block_template),
        balloons=balloons,
        parts_list=parts_list,
        hidden=hidden,
    )
    told = asked.or_else(of_scene).or_else(USUAL)
    names = _view_names(told.views or ())
    check_word("standard", told.standard, STANDARDS)
    check_word("text", text, TEXT_WORDS)
    check_word("hidden", told.hidden, get_args(Hidden))
    check_word("curves", curves, get_args(Curves))
    usual = STANDARDS[str(told.standard)]
    way = told.projection or usual.projection
    check_word("projection", way, ("first", "third"))
    page = page or of_scene.page or usual.page
    check_word("unit", told.unit, MM_PER)
    written_unit = told.measured_in or "mm"
    check_word("measured_in", written_unit, MM_PER)
    wanted_scale = None if told.scale is None or told.scale == "fit" else DrawingScale.of(told.scale)
    per_unit = MM_PER[str(told.unit)]
    given = shown if per_unit == 1.0 else shown.scaled(per_unit)
    # Sheets have pens of their own.
    given = given if up is None else stood_up(given, up)
    given = replace(given, inks=None, items=tuple(map(_with_lines_of_sheets, given.items)))
    given = replace(given, measures=_measures(given.measures, usual, written_unit, decimals, zeros, comma))
    solid, annotations = without_annotations(given)
    edges: tuple[RoundEdge, ...] = ()
    if told.centre_lines or any(one.may_be_of_circle for one in annotations):
        edges = _round_edges(solid, crease_angle_deg)
    left_out = Interruptions.of(told.interrupted or (), solid.bounds)
    if told.centre_lines and edges:
        # Without its gaps.
        extent = float(np.ptp(left_out.moved(given.bounds, math.inf), axis=0).max())
        solid, annotations = without_annotations(together([given, *centre_lines_of(edges, extent)]))
    cameras = tuple(camera_of(name, solid) for name in names)
    overall = overall_dimensions(names, _without_traces(solid).bounds) if told.dimensions else ()
    sections = sections_of(told.section or (), names, solid.bounds)
    circled = (*names, *(one.letter for one in sections))
    texts = told.detail_view or ()
    letters = LETTERS[len(sections) :]
    if len(texts) > len(letters):
        raise InputError(f"{len(sections)} sections and {len(texts)} details: expected at most {len(LETTERS)}")
    details = tuple(ViewCircle.of(text, "detail", circled, one) for text, one in zip(texts, letters, strict=False))
    breakouts = tuple(
        ViewCircle.of(text, "breakout", [name for name in names if name != "iso"]) for text in told.breakout or ()
    )
    for what, place in [
        *((f"detail {one.letter}", one.centre) for one in details),
        *(("breakout", one.centre) for one in breakouts),
    ]:
        left_out.check_shown(np.array([place]), what)
    _check_sections(sections, left_out)
    listed = parts_of(solid) if told.balloons or told.parts_list else ()
    part = _Part(
        solid,
        annotations,
        names,
        cameras,
        overall,
        sections,
        edges,
        details,
        breakouts,
        usual.level,
        listed if told.balloons else (),
        left_out,
        _uncut(solid, told.uncut or ()),
    )
    given_page, first = page, way == "first"
    size = page.strip().split()[0].upper() if isinstance(page, str) else f"{page.width_mm:g}x{page.height_mm:g}"
    said = given.title if title is None else title
    known = {
        "title": said,
        "author": told.author or "",
        "date": told.date or "",
        "sheet": sheet,
        "unit": written_unit,
        "size": size,
    }
    template = BLOCK if told.block_template is None else read_template(told.block_template)
    rows = _rows_of_list(listed, dict(told.made_of or ())) if told.parts_list else ()
    words = TitleBlock(known, way, dict(told.fields or ()), template, rows)
    taken = np.array(words.size_mm if told.block else (0.0, 0.0))

    def room(views: Sequence[SheetView], allowed: StandardScales) -> tuple[Page, Arrangement]:
        return roomiest(given_page, views, bool(told.frame), first, taken, allowed)

    paper, arranged, chosen = _arranged(part, StandardScales(usual.steps, wanted_scale), room)
    factor = chosen.factor
    words = replace(words, words={**known, "scale": str(chosen)})
    plain = LETTERS_OF[text].plain
    # A title that nobody asked for here may be too long, or in letters without strokes.
    written_in = words.layers_titled_if_possible if title is None else words.layers
    layers = written_in(drawing_space(paper, bool(told.frame)), plain) if told.block else ()
    done = Sheet(paper, f"{said}, {chosen}" if said else str(chosen))
    notes = part.notes(factor)
    _tell_left_out(annotations, notes.values())
    options = {"crease_angle_deg": crease_angle_deg, "text": text, "progress": progress, "explain": explain}
    options["shortest_mm"] = shortest_mm
    drawer = _Views(part, factor, cut_spacing_mm, cast(Hidden, told.hidden), curves, options)
    placed = {view.name: (view, place) for view, place in zip(arranged.views, arranged.middles(factor), strict=True)}
    written: dict[str, Floats] = {}
    around: list[Layer] = []
    measured = _without_traces(solid)
    for one in details:
        centres = [note.before(placed[one.letter][0].camera, part.bounds) for note in notes[one.view] if note.is_centre]
        drawn = drawer.detail(one, centres)
        x, y = placed[one.letter][1]
        done = done.place(drawn, x - 0.5 * drawn.width_mm, y - 0.5 * drawn.height_mm)
    for view, (x, y) in (placed[name] for name in placed if name not in {one.letter for one in details}):
        added = [one.before(view.camera, part.bounds) for one in notes[view.name]]
        added += [
            one.annotation(view.camera, measured, part.middle, factor, view.world).scene
            for one in part.overall
            if one.view == view.name
        ]
        added = [level_measures(one, factor) for one in added] if part.level else added
        drawn = drawer.drawing(view, added)
        corner = (x - 0.5 * drawn.width_mm, y - 0.5 * drawn.height_mm)
        written[view.name] = written_on(drawn) + corner
        done = done.place(drawn, *corner)
        if told.balloons and view.name == part.balloons_in:
            moved = Sheet(paper).place(drawn, *corner).drawing()
            around += balloon_layers(listed, moved, view.reach_mm(factor) - [BALLOONS_ROOM_MM, 0.0], (x, y), plain)
    around += _around(part, placed, factor, written, done.drawing(), plain)
    borders = (*(frame_layers(paper, plain, (taken[0], taken[1])) if told.frame else ()), *layers)
    return done.place(Drawing(paper.width_mm, paper.height_mm, (*around, *borders), ()), 0.0, 0.0).drawing()


def _arranged(
    part: _Part,
    scales: StandardScales,
    room: Callable[[Sequence[SheetView], StandardScales], tuple[Page, Arrangement]],
) -> tuple[Page, Arrangement, DrawingScale]:
    """The paper, the views on it and their scale. Dimensions that make room for each other take the more of it the
    smaller the scale is: so it may be smaller than without them."""
    extent = float(np.ptp(part.bounds, axis=0).max())
    factor = USUAL_MM / extent if extent > 0.0 else 1.0
    for _ in range(SCALES_TRIED):
        paper, arranged = room(part.views(factor), scales)
        chosen = fitting_scale(scales, arranged, paper)
        if chosen.factor == factor:
            return paper, arranged, chosen
        factor = chosen.factor
    paper, arranged = room(part.views(factor), replace(scales, asked=chosen))
    return paper, arranged, fitting_scale(replace(scales, asked=chosen), arranged, paper)


def _around(
    part: _Part,
    placed: Mapping[str, tuple[SheetView, tuple[float, float]]],
    factor: float,
    written: Mapping[str, Floats],
    drawn: Drawing,
    plain: Plain,
) -> tuple[Layer, ...]:
    """The lines of sections and the circles of details in other views, and the names of both; written: the boxes
    (b,2,2) of letters in each view; drawn: all views; plain: what sets letters."""
    found: list[Layer] = []
    strokes = [paths for layer in drawn.layers for paths in layer.strokes]
    lines = np.concatenate([np.zeros((0, 2, 2)), *(paths.points[segments(paths)] for paths in strokes)])
    for section in part.sections:
        view, (x, y) = placed[section.letter]
        top = y + factor * float(view.world[1, 1]) + (SEAM_MM if section.is_half else 0.0)
        found.append(section.name_layer((x, top), written[view.name], plain))
        name = section.told_in(part.names)
        if name is not None:
            other, place = placed[name]
            room, shown = part.overall_room_mm(name, other.camera), part.shown_bounds(factor)
            line = section.interrupted(part.left_out, factor)
            found += line.line_layers(other.camera, view.camera, shown, place, factor, room, written[name], plain)
    for one in part.details:
        x, y = placed[one.letter][1]
        top = y + one.factor(factor) * one.radius
        found.append(named_layer(f"{one.letter} ({one.scale_text(factor)})", (x, top), np.zeros((0, 2, 2)), plain))
        view, place = placed[one.view]
        middle = np.array(place) + part.on_page(view.camera, one.centre, factor)
        found += one.layers(middle, factor * one.radius, lines, plain)
    return tuple(found)


USUAL = SheetSettings(
    views=("front", "top", "left", "iso"), scale="fit", unit="mm", standard="iso", block=True, hidden="dashed"
)
"""What sheets are like where nothing else is said."""


@dataclass(frozen=True)
class _Standard:
    """What is usual on sheets of a standard; level: measures are level and interrupt their lines."""

    projection: Literal["first", "third"]
    page: str
    steps: tuple[int, ...]
    level: bool


STANDARDS = {
    "iso": _Standard("first", "A3", ISO_STEPS, False),
    "asme": _Standard("third", "tabloid", ASME_STEPS, True),
}


def _measures(
    given: Measures | None,
    usual: _Standard,
    unit: str,
    decimals: int | None,
    zeros: bool | None,
    comma: bool | None,
) -> Measures:
    """How measures are written: as it is asked for, else as the scene says, else as is usual."""
    own = Measures() if given is None else given
    inches = usual.level and unit == "in"
    return replace(
        own,
        decimals=own.decimals if decimals is None else decimals,
        zeros=(own.zeros or inches) if zeros is None else zeros,
        comma=own.comma if comma is None else comma,
        per_unit=1.0 / MM_PER[unit],
        leading=not inches,
    )


def _rows_of_list(parts: Sequence[AssemblyPart], made_of: Mapping[str, str]) -> tuple[tuple[str, ...], ...]:
    """Number, quantity and name of each part, and what it is made of if that is said of any.

    Errors: InputError for what is said of no part."""
    names = [one.name for one in parts]
    for name in made_of:
        if name not in names:
            raise unknown("made of: part", name, names)
    rows = [(str(k), str(len(one.pieces)), one.name) for k, one in enumerate(parts, start=1)]
    return tuple((*row, made_of.get(row[2], "")) for row in rows) if made_of else tuple(rows)


def _tell_left_out(annotations: Iterable[Annotation], notes: Iterable[Iterable[Annotation]]) -> None:
    """An InputWarning that names the annotations, but for centre lines, which are in no view."""
    shown = {one.name for view in notes for one in view}
    names = [one.name for one in annotations if not one.is_in_every_view and one.name not in shown]
    if names:
        warnings.warn(f"square to no view and not shown: {', '.join(names)}", InputWarning, stacklevel=3)


def _check_sections(sections: Iterable[SheetSection], left_out: Interruptions) -> None:
    """InputError for sections in what is left out, and aligned ones of an interrupted part."""
    for section in sections if left_out.ranges else ():
        if section.hinge is not None:
            name = f"{section.letter}-{section.letter}"
            raise InputError(f"section {name}: aligned or oblique sections and interrupted views exclude each other")
        for zone in section.zones:
            for axis, place in ((section.axis, zone.offset), (section.across, zone.high)):
                if place is not None and math.isfinite(place):
                    at = np.full((1, 3), math.nan)
                    at[0, axis] = place
                    left_out.check_shown(at, f"section {section.letter}-{section.letter}")


def _page_at(factor: float) -> Callable[[Scene], InSpace]:
    """A page on which a unit of the world is so many mm, as cut_scene takes it."""
    return lambda scene: lambda points: np.full(len(points), 1.0 / factor)


def _uncut(scene: Scene, asked: Iterable[str]) -> frozenset[str]:
    """The names of the items that sections leave whole. Errors: InputError for a name of none."""
    names: dict[str, set[str]] = {}
    for item in scene.items:
        for name in filter(None, (item.name, item.group)):
            names.setdefault(name, set()).add(item.name)
            names.setdefault(NUMBERED.sub("", name), set()).add(item.name)
    asked = tuple(asked)
    for name in asked:
        if name not in names:
            raise unknown("uncut: part", name, dict.fromkeys(item.group or item.name for item in scene.items))
    return frozenset().union(*(names[name] for name in asked))


def _without_traces(scene: Scene) -> Scene:
    """What there is to measure of a scene whose parts are moved apart."""
    return replace(scene, items=tuple(item for item in scene.items if item.lines != (LineKind.TRACE.word,)))


def _with_lines_of_sheets(item: Item) -> Item:
    """An item that has kinds of lines of its own where nobody asks for any has no others on a sheet: where parts touch,
    as a pin in its bore, their triangles pierce."""
    if item.default_lines is None or item.lines is not None:
        return item
    return replace(item, lines=tuple(word for word in LINES.split(",") if word in item.default_lines))


def _round_edges(scene: Scene, crease_angle_deg: float) -> tuple[RoundEdge, ...]:
    """Those of all polyhedra."""
    meshes = [item.shape for item in scene.items if isinstance(item.shape, Mesh)]
    return tuple(edge for mesh in meshes for edge in round_edges(mesh, crease_angle_deg))


def _texts(given: str | Iterable[str] | None, between: str = "") -> tuple[str, ...] | None:
    """Texts that are one, with signs between them if there are such, or several."""
    if given is None:
        return None
    if not isinstance(given, str):
        return tuple(given)
    return tuple(given.split(between)) if between else (given,)


def _view_names(views: Iterable[str]) -> tuple[str, ...]:
    names = tuple(word.strip() for word in views)
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
