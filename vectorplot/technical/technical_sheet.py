"""The verb technical_sheet: main views of a part, side by side on one sheet, at one exact scale."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing, Layer
from vectorplot.drawing.sheets.drawing_frames import drawing_space, frame_layers
from vectorplot.drawing.sheets.drawing_scales import DrawingScale
from vectorplot.drawing.sheets.sheet import Sheet
from vectorplot.drawing.sheets.title_block import BLOCK_MM, TitleBlock
from vectorplot.effects.cutting.cut_scenes import cut, cut_scene
from vectorplot.effects.cutting.hatches import InSpace
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import VIEWS, Camera, Point
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.anything import scene_of
from vectorplot.io.upwards import stood_up
from vectorplot.scene.cuts.exploded import shown_apart
from vectorplot.scene.naming.joined_scenes import together
from vectorplot.scene.pages.page import Page
from vectorplot.scene.pages.paper import MM_PER_INCH
from vectorplot.scene.point_of_view import camera_of
from vectorplot.scene.scene import Scene
from vectorplot.stages.walk import StageReport
from vectorplot.technical.arranged_views import Arrangement, SheetView, cells_of, fitting_scale, roomiest
from vectorplot.technical.round_edges import RoundEdge, centre_lines_of, round_edges
from vectorplot.technical.section_views import ROOM_MM, SheetSection, sections_of
from vectorplot.technical.view_annotations import (
    TEXT_MM,
    Annotation,
    OverallDimension,
    overall_dimensions,
    views_of,
    without_annotations,
    written_on,
)
from vectorplot.tolerances.of_extent import SAME_PLANE_OF_EXTENT
from vectorplot.words import check_word, unknown

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
        hatches, as of cut."""
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
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """Main views of a part in line with each other on one sheet, at one exact scale, hidden lines dashed.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is drawn, as of `io.scene_of`. Dimensions in it are shown in the first view that they are square to, radii
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
        As of draw.
    progress, explain : callable, optional
        As of draw, for every view.

    Returns
    -------
    Drawing
        With contours, boundaries, creases, intersections and curves, and a title block in the lower right corner.

    Raises
    ------
    InputError
        As of draw; for views that are unknown, twice or none; for sections that are none, or beside the part; for a
        scale that is too large for the page, with the largest that fits; for a page without room, and a title without
        room in its block; for an unknown unit.

    Warns
    -----
    InputWarning
        Of dimensions that are square to none of the views: they are not shown.

    Notes
    -----
    The isometric view is a projection at the same scale: edges along the axes are 0.816 times as long in it.

    Degenerate: a scene without extent is drawn 1:1.

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
