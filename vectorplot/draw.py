"""The verb draw: a scene becomes strokes on a page."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Drawing, Layer, Paths
from vectorplot.drawing.duplicates import without_duplicates
from vectorplot.drawing.join import joined
from vectorplot.drawing.layers import layers_by_colour, layers_by_kind, layers_by_object
from vectorplot.drawing.page import centred, fitted
from vectorplot.drawing.pen_order import pen_ordered
from vectorplot.drawing.pieces import chosen, concatenated
from vectorplot.drawing.simplify import without_collinear_points
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.geometry.strokes import LineKind
from vectorplot.plan import StageReport, Walk, plan_draw
from vectorplot.scene.scene import Page, Scene
from vectorplot.scene.view import View, look
from vectorplot.visibility.framing import inside, near_plane, reaches_too_far, window_planes
from vectorplot.visibility.hidden_lines import Visibility, counted_parts, visible_parts
from vectorplot.visibility.lines import Lines, edge_lines, intersection_lines, joined_lines, pattern_lines
from vectorplot.visibility.occluders import solid_items
from vectorplot.visibility.pairs import Segments
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

DRAWN = ("contour", "boundary", "crease", "intersection", "pattern")
"""The kinds of lines that are drawn where nothing else is said."""


COINCIDENT_MM = 1e-4
"""Strokes that are no further apart than this lie on each other, ends on the same point."""

COLLINEAR_MM = 1e-3
"""A point that is no further from the straight line between its neighbours is left out: the last digit of the files."""

DASH_MM = (2.0, 1.0)
"""Dash and gap of hidden lines."""


def default_camera(scene: Scene) -> Camera:
    """A central projection of the whole scene from the front, the right and above."""
    low, high = scene.bounds
    centre, size = (low + high) / 2.0, math.dist(low, high)
    direction = np.array([0.45, -0.8, 0.45]) / np.linalg.norm([0.45, -0.8, 0.45])
    eye = centre + direction * 2.2 * (size if size > 0.0 else 1.0)
    return Camera(eye=tuple(eye.tolist()), target=tuple(centre.tolist()))


def draw(
    scene: Scene,
    camera: Camera | None = None,
    *,
    page: Page | None = None,
    fit: bool = True,
    lines: Iterable[str] = DRAWN,
    crease_angle_deg: float = 25.0,
    hidden: Literal["none", "dashed", "solid"] = "none",
    halo_mm: float = 0.0,
    layers: Literal["kind", "object", "colour"] = "kind",
    tolerance_mm: float = 0.02,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The scene as strokes on a page, hidden lines found by geometry.

    camera and page: those of the scene where None, else default_camera and A4. fit: the picture fills the page but
    for its margin; otherwise the page centre is the target and the page height the camera's picture height. lines:
    words of LineKind; an item's own come first. crease_angle_deg: sharper edges are creases. hidden: hidden lines are
    left out, dashed, or solid on a layer of their own. halo_mm: lines end so far beside what is in front of them.
    layers: what shares a layer. tolerance_mm: for approximations; straight lines are exact. progress(stage, fraction)
    and explain(report) are called while it works.
    Errors: InputError for unknown words, impossible cameras, and widths and angles out of range.
    Degenerate: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees
    off the principal ray, a fitted picture shows the camera's field of vision.
    Source: Glaeser, sections 2.1 and 7.2.
    """
    _check_options(hidden, halo_mm, crease_angle_deg)
    kinds = frozenset(map(LineKind.from_word, lines))
    camera = camera or scene.camera or default_camera(scene)
    page = page or scene.page or Page()
    walk = Walk(plan_draw(scene, kinds, hidden, halo_mm), explain, progress)
    view = walk.run("look", look, scene, camera)
    faces = walk.run("faces", project_faces, view)
    solid = solid_items(view, faces)
    found = []
    if walk.calls_for("edges"):
        backs = ~solid if hidden == "none" else np.ones(len(solid), dtype=np.bool_)
        found.append(walk.run("edges", edge_lines, scene, view, faces, kinds, crease_angle_deg, backs))
    if walk.calls_for("intersections"):
        found.append(walk.run("intersections", intersection_lines, scene, view, faces, kinds, solid))
    if walk.calls_for("patterns"):
        found.append(walk.run("patterns", pattern_lines, scene, view, kinds))
    framed, whole = walk.run("frame", in_frame, view, joined_lines(found), page, fit)
    seen = _visibility(walk, view, faces, solid, framed)
    page_from_image = _page_from_image(view, framed, seen, page, fit, whole)
    if walk.calls_for("halo"):
        from vectorplot.effects.halo import halo

        seen = walk.run("halo", halo, view, framed, seen, halo_mm / page_from_image[0, 0])
    strokes = walk.run("strokes", strokes_on_page, view, framed, seen, page_from_image)
    sorted_layers = walk.run("layers", _layers, scene, strokes, layers)
    inked = walk.run("pen", _inked, sorted_layers, hidden, strokes.page_from_world)
    names = tuple(item.name for item in scene.items)
    return Drawing(page.width_mm, page.height_mm, inked, names, scene.title, strokes.page_from_world)


def _check_options(hidden: str, halo_mm: float, crease_angle_deg: float) -> None:
    if hidden not in ("none", "dashed", "solid"):
        raise InputError(f"hidden {hidden!r}: expected none, dashed or solid")
    if not 0.0 <= halo_mm < np.inf:
        raise InputError(f"a halo of {halo_mm:g} mm: expected a width that is finite and not negative")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")


def in_frame(view: View, lines: Lines, page: Page, fit: bool) -> tuple[Lines, bool]:
    """The lines in front of the eye and inside the picture, and whether all of them fit a page.

    Without fit, and where the scene reaches too far to be fitted, the picture is the camera's field of vision.
    """
    fitted = fit and not reaches_too_far(view, lines.start, lines.end)
    planes = near_plane(view)
    if not fitted:
        width, height = page.width_mm - 2.0 * page.margin_mm, page.height_mm - 2.0 * page.margin_mm
        unit = view.picture_height / (height if fit else page.height_mm)
        planes = np.concatenate([planes, window_planes(view, unit * width / 2.0, unit * height / 2.0)])
    if len(planes):
        low, high = inside(planes, lines.start, lines.end)
        kept = np.flatnonzero(low < high)
        lines, low, high = lines.some(kept), low[kept], high[kept]
        along = lines.end - lines.start
        start = np.where(low > 0.0, lines.start + low * along, lines.start)
        end = np.where(high < 1.0, lines.start + high * along, lines.end)
        lines = Lines(start, end, lines.kind, lines.item, lines.side)
    return lines, fitted


def _visibility(walk: Walk, view: View, faces: ProjectedFaces, solid: Bools, lines: Lines) -> Visibility:
    segments = Segments(lines.start, lines.end)
    if walk.calls_for("visible lines"):
        return walk.run("visible lines", visible_parts, view, faces, solid, segments, walk.fraction("visible lines"))
    return walk.run("counted lines", counted_parts, view, faces, solid, segments, walk.fraction("counted lines"))


def _page_from_image(view: View, lines: Lines, seen: Visibility, page: Page, fit: bool, whole: bool) -> Floats:
    """(3,3) matrix from image to page."""
    if not fit:
        return centred(page, view.picture_height, page.height_mm)
    if not whole:
        return centred(page, view.picture_height, page.height_mm - 2.0 * page.margin_mm)
    if not len(seen.segment):
        return fitted(page, np.zeros(2), np.zeros(2))
    start, end = _part_ends(lines, seen)
    images = np.concatenate([view.image_of(start), view.image_of(end)], axis=1)
    low, high = images.min(axis=1), images.max(axis=1)
    if (high - low).max() <= view.tolerance:
        # Lines along the sight rays: their image is a point, and rounding must not fill the page.
        return fitted(page, low, low)
    return fitted(page, low, high)


def _part_ends(lines: Lines, seen: Visibility) -> tuple[Floats, Floats]:
    """Both ends (3,k) of all parts; where a part goes on to the end of its line, exactly that end."""
    start, end = lines.start[:, seen.segment], lines.end[:, seen.segment]
    along = end - start
    return start + seen.low * along, np.where(seen.high < 1.0, start + seen.high * along, end)


@dataclass(frozen=True, eq=False)
class Strokes:
    """Straight strokes of two points on the page, how important each is (the smaller the more), and page_from_world
    (4,4)."""

    paths: Paths
    rank: Ints
    page_from_world: Floats

    def __len__(self) -> int:
        return len(self.paths)


def strokes_on_page(view: View, lines: Lines, seen: Visibility, page_from_image: Floats) -> Strokes:
    """The parts of lines as strokes on the page, each line once where several lie on each other.

    Of coincident strokes the visible one stays, then the one whose kind comes first, then the one nearer the eye.
    """
    ends = np.stack(_part_ends(lines, seen), axis=2).reshape(3, -1)
    image = view.image_of(ends)
    points = (page_from_image[:2, :2] @ image).T + page_from_image[:2, 2]
    count = len(seen.segment)
    kind, item = lines.kind[seen.segment], lines.item[seen.segment]
    offsets = np.arange(0, 2 * count + 1, 2)
    open_ = np.zeros(count, dtype=np.bool_)
    # Lines at the same depth but for rounding go by their items: so neither size nor place decides which one stays.
    depth = np.round(view.depth_of(ends).reshape(-1, 2).sum(axis=1), 8)
    order = np.lexsort((item, depth, kind, seen.hidden_by > 0))
    rank = np.empty(count, dtype=np.intp)
    rank[order] = np.arange(count)
    world = page_from_world(view, page_from_image)
    paths = Paths(points, offsets, open_, kind, item, seen.hidden_by, view.world_of(ends))
    return Strokes(without_duplicates(paths, rank, COINCIDENT_MM, world), rank, world)


def page_from_world(view: View, page_from_image: Floats) -> Floats:
    """(4,4) matrix from points (x,y,z,1) of the world to homogeneous points of the page in mm; the third row keeps
    z."""
    scaled = np.diag([1.0 / view.scale, 1.0 / view.scale, 1.0])
    rows = page_from_image @ scaled @ view.image_from_world
    return np.vstack([rows[:2], [0.0, 0.0, 1.0, 0.0], rows[2:]])


def _layers(scene: Scene, strokes: Strokes, layers: str) -> tuple[Layer, ...]:
    if layers == "object":
        return layers_by_object(strokes.paths, [item.name for item in scene.items])
    if layers == "colour":
        return layers_by_colour(strokes.paths, [item.colour for item in scene.items])
    if layers == "kind":
        return layers_by_kind(strokes.paths)
    raise InputError(f"layers {layers!r}: expected kind, object or colour")


def _inked(layers: tuple[Layer, ...], hidden: str, world: Floats) -> tuple[Layer, ...]:
    """Each layer's strokes joined, without collinear points, hidden ones dashed if asked for, in the order of the
    pen."""
    return tuple(
        replace(layer, marks=tuple(_pen_strokes(mark, hidden, world) for mark in layer.marks)) for layer in layers
    )


def _pen_strokes(paths: Paths, hidden: str, world: Floats) -> Paths:
    if not len(paths):
        return paths
    group = (paths.item * len(LineKind) + paths.kind) * (int(paths.hidden_by.max()) + 1) + paths.hidden_by
    long = without_collinear_points(joined(paths, group, COINCIDENT_MM), COLLINEAR_MM)
    if hidden == "dashed" and (long.hidden_by > 0).any():
        behind = np.flatnonzero(long.hidden_by > 0)
        dashes = dashed(chosen(long, behind), *DASH_MM, world)
        long = concatenated((chosen(long, np.flatnonzero(long.hidden_by == 0)), dashes))
    return pen_ordered(long)
