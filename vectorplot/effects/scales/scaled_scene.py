"""Scenes with the colours and the box that they ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.effects.cutting.cut_scenes import cut_scene
from vectorplot.effects.cutting.hatches import InSpace, usual_page
from vectorplot.effects.scales.box_axes import with_box
from vectorplot.effects.scales.coloured_scene import ColourBar, coloured
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.naming.labels import BesidePoint
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, fitted_with_room
from vectorplot.scene.point_of_view import camera_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View


@dataclass(frozen=True, eq=False)
class Scaled:
    """A scene as a chart: the scene with what its colouring and its box ask for, the camera that looks at it, the bar
    that explains its colours, if it has a colouring, and reach (k,3): the corners of its box, if it has one."""

    scene: Scene
    camera: Camera
    bar: ColourBar | None
    reach: Floats

    def around(self, placement: Placement, view: View, page: Page, border: float = 0.0, mm: float = 1.0) -> Placement:
        """The place of a picture that fills a page, with room for the box, its numbers and names; page, border: as it
        had them; mm: how long a millimetre is in units of the page."""
        beside = [label.at for label in self.scene.labels if isinstance(label.at, BesidePoint)]
        world = np.concatenate([self.reach, np.array([at.point for at in beside]).reshape(-1, 3)])
        points, corners = view.points_of(world), np.zeros((len(self.reach), 2))
        if not len(self.reach) or not placement.whole or view.reaches_too_far(points):
            return placement
        low, high = (
            mm * np.concatenate([corners, np.array(rooms).reshape(-1, 2)]).T
            for rooms in ([at.low_mm for at in beside], [at.high_mm for at in beside])
        )
        return fitted_with_room(view, page, view.image_of(points), low, high, border)


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
