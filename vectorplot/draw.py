"""The verb draw: a scene becomes strokes on a page."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Literal

import numpy as np

from vectorplot.drawing.drawing import Drawing, Paths
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


def default_camera(scene: Scene) -> Camera:
    """A central projection of the whole scene from the front, the right and above."""
    low, high = scene.bounds
    centre, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
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

    camera and page: those of the scene where None, else default_camera and A4. fit: the picture fills the page but for its
    margin; otherwise the page centre is the target and the page height the camera's picture height. lines: words of
    LineKind; an item's own come first. crease_angle_deg: sharper edges are creases. hidden: hidden lines are left
    out, dashed, or solid on a layer of their own. halo_mm: lines end so far beside what is in front of them. layers: what
    shares a layer. tolerance_mm: for approximations; straight lines are exact. progress(stage, fraction) and explain(report)
    are called while it works.
    Errors: InputError for unknown words and impossible cameras.
    Degenerate: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees off the
    principal ray, a fitted picture shows the camera's field of vision.
    Source: Glaeser, sections 2.1 and 7.2.
    """
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
    framed, window = walk.run("frame", in_frame, view, joined_lines(found), page, fit)
    seen = _visibility(walk, view, faces, solid, framed)
    return walk.run("ink", ink, scene, view, framed, seen, page, window, hidden, layers)


def in_frame(view: View, lines: Lines, page: Page, fit: bool) -> tuple[Lines, bool]:
    """The lines in front of the eye and inside the picture, and whether the picture is the camera's rather than fitted.

    Without fit, and where the scene reaches too far to be fitted, the picture is the camera's field of vision.
    """
    fitted = fit and not reaches_too_far(view, lines.start, lines.end)
    planes = near_plane(view)
    if not fitted:
        half = view.picture_height / 2.0
        width, height = page.width_mm - 2.0 * page.margin_mm, page.height_mm - 2.0 * page.margin_mm
        if fit:
            planes = np.concatenate([planes, window_planes(view, half * width / height, half)])
        else:
            unit = half / (page.height_mm / 2.0)
            planes = np.concatenate([planes, window_planes(view, unit * width / 2.0, unit * height / 2.0)])
    if len(planes):
        low, high = inside(planes, lines.start, lines.end)
        kept = np.flatnonzero(low < high)
        lines, low, high = lines.some(kept), low[kept], high[kept]
        along = lines.end - lines.start
        start = np.where(low > 0.0, lines.start + low * along, lines.start)
        end = np.where(high < 1.0, lines.start + high * along, lines.end)
        lines = Lines(start, end, lines.kind, lines.item, lines.side)
    return lines, not fitted


def _visibility(walk: Walk, view: View, faces: ProjectedFaces, solid: Bools, lines: Lines) -> Visibility:
    segments = Segments(lines.start, lines.end)
    if walk.calls_for("visible lines"):
        return walk.run("visible lines", visible_parts, view, faces, solid, segments, walk.fraction("visible lines"))
    return walk.run("counted lines", counted_parts, view, faces, solid, segments, walk.fraction("counted lines"))
