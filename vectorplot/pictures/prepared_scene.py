"""The scene of a picture as it is seen, with its camera, and the room for title, frame and colour bar around it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.pens import FRAME_PEN
from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import projection_of
from vectorplot.io.anything import scene_of
from vectorplot.pictures.pipeline import Pipeline, StageReport
from vectorplot.pictures.plan import plan_cuts
from vectorplot.scene.annotations import LabelAnchors, label_anchors
from vectorplot.scene.colour_scales import ScaleBar
from vectorplot.scene.item import Item
from vectorplot.scene.light import Exposure, Light
from vectorplot.scene.page import Page
from vectorplot.scene.pens import DepthCue, depth_cue_of
from vectorplot.scene.placement import FittedPage, Placement, allowed_in_space, camera_of, fitted_with_room
from vectorplot.scene.scene import Scene, tell_what_is_cut_off
from vectorplot.scene.view import View, without_seams
from vectorplot.tolerances import OFF_PAGE_MM

if TYPE_CHECKING:
    from vectorplot.drawing.labels import SceneLabels
    from vectorplot.effects.colour_maps import ColourBar, Scaled


# Items without faces that stand for the looks of single faces: whatever asks an item how it looks asks them too.

_NO_FACES = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


def with_face_looks(scene: Scene) -> Scene:
    """The scene with an item without faces for every look of faces, behind all others; without looks the scene itself.

    What the faces of these items look like is asked of such an item, where they are and what they hide of their own.
    """
    if not any(item.face_looks is not None for item in scene.items):
        return scene
    items, added = [], list[Item]()
    for item in scene.items:
        looks = item.face_looks
        if looks is None or not isinstance(item.shape, Mesh):
            items.append(item)
            continue
        items.append(replace(item, face_looks=replace(looks, first=len(scene.items) + len(added))))
        for look in looks.looks:
            colour = item.colour if look.colour is None else look.colour
            material = item.material if look.material is None else look.material
            added.append(Item(item.name, _NO_FACES, colour, material, hatch=item.hatch, occludes=item.occludes))
    return replace(scene, items=(*items, *added))


# What a picture is of: the scene as it is seen, the camera, and what the scene was before it was cut.


@dataclass(frozen=True)
class Paper:
    """What a picture goes on: a page, whether it fills that, and how large a mm of its pens is there."""

    page: Page
    fit: bool
    mm: float = 1.0

    def seen_from(self, camera: Camera) -> Callable[[Scene], Callable[[Floats], Floats]]:
        """How long a mm of pens is at points in space, for a scene of which a camera makes the picture."""
        return lambda scene: allowed_in_space(scene, projection_of(camera, scene.bounds), self.page, self.fit, self.mm)


@dataclass(frozen=True, eq=False)
class PreparedScene:
    """What is seen of a scene, without seams, and from where; what labels name in the scene as it was given; and the
    chart that its colouring and its box make of it, if it has one of these."""

    scene: Scene
    camera: Camera
    anchors: LabelAnchors
    chart: Scaled | None

    @property
    def bar(self) -> ColourBar | None:
        """What explains the colours, where numbers give them."""
        return None if self.chart is None else self.chart.bar

    def around(self, placement: Placement, view: View, page: Page, mm: float = 1.0) -> Placement:
        """The place of a picture that fills a page, with room for the numbers of a box, if there is one, else for the
        labels that would leave the page; mm: see Scaled.around."""
        placed = placement if self.chart is None else self.chart.around(placement, view, page, mm)
        if placed is not placement or placement.filled is None or not len(self.anchors) or isinstance(page, FittedPage):
            return placed
        from vectorplot.drawing.labels import rooms_of_labels

        world = np.where(np.isfinite(self.anchors.points), self.anchors.points, self.scene.bounds[0])
        points = view.points_of(world)
        if view.reaches_too_far(points):
            return placed
        image = np.where(np.isfinite(self.anchors.points).all(axis=1), view.image_of(points), np.nan)
        some, low, high = rooms_of_labels(self.anchors, image.T, placement.filled, page.margin_mm / mm, mm)
        on_page, edge = placement.on_page(image[:, some]), np.array(page.margin_mm)
        right = np.array([placement.page.width_mm, placement.page.height_mm]) - edge
        if (on_page + low >= edge - OFF_PAGE_MM).all() and (on_page + high <= right + OFF_PAGE_MM).all():
            return placed
        corners = np.concatenate([placement.filled.T, image[:, some]], axis=1)
        nothing = np.zeros((2, 2))
        rooms = (np.concatenate([nothing, one]).T for one in (low, high))
        return fitted_with_room(view, page, corners, *rooms)


def prepared_scene(
    scene: object,
    camera: Camera | str | None,
    paper: Paper,
    explain: Callable[[StageReport], None] | None,
    progress: Callable[[str, float], None] | None,
    *,
    lights: Sequence[Light] | None = None,
    exposure: Exposure | None = None,
    background: str | None = None,
    depth_cue: DepthCue | str | None = None,
) -> PreparedScene:
    """What a picture of anything that has a shape is of. paper: what it goes on; lights, exposure, background,
    depth_cue: in place of those of the scene.

    Errors: see scene_of, camera_of and scaled.
    """
    given = scene_of(scene)
    if given.explosion is not None:
        from vectorplot.scene.exploded import shown_apart

        given = shown_apart(given)
    chart = _chart_of(given, camera, paper)
    given, camera = (given, camera) if chart is None else (chart.scene, chart.camera)
    given = given if background is None else replace(given, background=background)
    given = given if exposure is None else replace(given, exposure=exposure)
    given = given if depth_cue is None else replace(given, depth_cue=depth_cue_of(depth_cue))
    seamless = without_seams(given if lights is None else replace(given, lights=tuple(lights)))
    tell_what_is_cut_off(seamless)
    anchors, seen_from = label_anchors(given), camera_of(camera, seamless)
    seen = with_face_looks(_seen_part(seamless, seen_from, paper, explain, progress))
    return PreparedScene(seen, seen_from, anchors, chart)


def _chart_of(scene: Scene, camera: Camera | str | None, paper: Paper) -> Scaled | None:
    """The scene with what its colouring and its box ask for, if it has one."""
    if scene.colouring is None and scene.box is None:
        return None
    from vectorplot.effects.colour_maps import scaled

    return scaled(scene, camera, paper.seen_from(camera_of(camera, scene)))


def _seen_part(
    scene: Scene,
    camera: Camera,
    paper: Paper,
    explain: Callable[[StageReport], None] | None,
    progress: Callable[[str, float], None] | None,
) -> Scene:
    """What cuts, and the camera's near and far plane, leave of a scene."""
    pipeline = Pipeline(plan_cuts(scene, camera), explain, progress)
    if pipeline.calls_for("cuts"):
        from vectorplot.effects.cuts import cut_scene

        scene = pipeline.run("cuts", cut_scene, scene, camera, paper.seen_from(camera))
    if pipeline.calls_for("near and far"):
        from vectorplot.effects.cuts import between_planes

        scene = pipeline.run("near and far", between_planes, scene, camera)
    return scene


# What stands around a picture on its page: a title, a frame, and a bar where colours stand for numbers.

MOST_NAMES = 3
"""So many labels are named in a warning."""


@dataclass(frozen=True, eq=False)
class Legend:
    """What stands beside and below a picture to be read with it: a bar that says which number is which colour, and one
    that shows a length; sheet: the whole one; text: a word of LETTERS."""

    sheet: Page
    bar: ColourBar | None
    scale_bar: ScaleBar | None
    text: str = "strokes"

    @property
    def room(self) -> Page:
        """The part of the sheet that is left for the picture. Errors: InputError where nothing is."""
        rest = self.sheet
        if self.bar is not None:
            from vectorplot.effects.colour_maps import narrower

            rest = narrower(rest, self.bar.colouring)
        if self.scale_bar is not None:
            from vectorplot.drawing.titles import scale_bar_strip

            rest = replace(rest, height_mm=rest.height_mm - scale_bar_strip(self.scale_bar))
        return rest

    def around(self, drawing: Drawing, paper: str | None, longest_mm: float | None = None) -> Drawing:
        """The drawing of a picture in that room on the whole sheet, or one as large as it needs; paper: the colour of
        what is added, where it has one; longest_mm: longer strokes leave in parts."""
        if self.bar is None and self.scale_bar is None:
            return drawing
        from vectorplot.shading.palettes import palette

        shade = None if paper is None else "#{:02x}{:02x}{:02x}".format(*palette(paper)[-1].tolist())
        if self.scale_bar is not None:
            from vectorplot.drawing.titles import with_scale_bar

            drawing = with_scale_bar(drawing, self.scale_bar, self.sheet.margin_mm, self.text, shade)
        if self.bar is not None:
            from vectorplot.effects.colour_maps import with_colour_bar

            # Pages that are cut to their picture are narrower than the sheet was.
            beside = self.sheet.width_mm - self.room.width_mm
            whole = drawing.width_mm + beside
            whole = self.sheet.width_mm if drawing.width_mm == self.room.width_mm else whole
            drawing = with_colour_bar(drawing, self.bar, whole, shade, longest_mm, self.text, self.sheet.margin_mm)
        return drawing


def titled(
    layers: tuple[Layer, ...],
    placement: Placement,
    title: str,
    frame: bool,
    pen: Pen = FRAME_PEN,
    longest_mm: float | None = None,
    text: str = "strokes",
) -> tuple[Layer, ...]:
    """The layers of a drawing, and one with a title and a frame where these are wanted; pen, text: of its letters."""
    if not title and not frame:
        return layers
    from vectorplot.drawing.titles import with_title

    return with_title(layers, placement, title, frame, pen, longest_mm, text)


def room_for_labels(
    layers: tuple[Layer, ...], placement: Placement, labels: SceneLabels, sheet: Page
) -> tuple[tuple[Layer, ...], Placement]:
    """The layers of a drawing, and their place, on a sheet that, where it is cut to size, has room for labels too; on
    another one an InputWarning for those that leave it."""
    if not isinstance(sheet, FittedPage):
        tell_what_leaves_page(labels)
        return layers, placement
    from vectorplot.drawing.titles import with_room

    return with_room(layers, placement, labels.every_box)


def tell_what_leaves_page(labels: SceneLabels) -> None:
    """An InputWarning that names the labels whose letters leave the page, if there are any."""
    names = labels.off_page
    if names:
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        said = ", ".join(f"label {name}" for name in names[:MOST_NAMES])
        warnings.warn(f"{said}{more}: letters leave the page", InputWarning, stacklevel=4)
