"""Scenes with the colours and the box that they ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vectorplot.arrays import Floats
from vectorplot.effects.cutting.cut_scenes import cut_scene
from vectorplot.effects.cutting.hatches import InSpace, usual_page
from vectorplot.effects.scales.box_axes import with_box
from vectorplot.effects.scales.coloured_scene import ColourBar, coloured
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, fitted_picture
from vectorplot.scene.point_of_view import camera_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View


@dataclass(frozen=True, eq=False)
class Scaled:
    """A scene as a chart: the scene with what its colouring and its box ask for, the camera that looks at it, the bar
    that explains its colours, if it has a colouring, and reach (k,3): what a picture with a box has to hold."""

    scene: Scene
    camera: Camera
    bar: ColourBar | None
    reach: Floats

    def around(self, placement: Placement, view: View, page: Page, border: float = 0.0) -> Placement:
        """The place of a picture of faces that fills a page, with room for the box; page, border: as it had them."""
        points = view.points_of(self.reach)
        if not len(self.reach) or not placement.whole or view.reaches_too_far(points):
            return placement
        return fitted_picture(view, page, view.image_of(points), border)


def scaled(scene: Scene, camera: Camera | str | None, page: Callable[[Scene], InSpace] = usual_page) -> Scaled:
    """The scene as a chart, after its cuts; page: as of cut_scene. Errors: InputError as of coloured."""
    seen_from, bar = camera_of(camera, scene), None
    if scene.colouring is not None or scene.box is not None:
        # Bands of closed bodies are open, and no cut goes through a box with ticks.
        scene = cut_scene(scene, seen_from, page)
    if scene.colouring is not None:
        scene, bar = coloured(scene, scene.colouring)
    boxed, reach = with_box(scene, seen_from)
    return Scaled(boxed, seen_from, bar, reach)
