"""What the tests of paint paint: a cube, a table, two lights, and from where."""

from __future__ import annotations

import numpy as np

from support.top_fills import fills_of
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box

CUBE = Scene((Item("CUBE", box((-1, -1, -1), (1, 1, 1)), colour="blue"),))
SUN = Light((2.0, -3.0, 5.0), parallel=True, intensity=0.8)
LAMP = Light((-4.0, -5.0, 6.0), intensity=0.5)
TABLE = Scene(
    (
        Item("TABLE", box((-3, -3, -0.3), (3, 3, 0)), "lightgray"),
        Item("BOX", box((-1, -1, 0), (0.5, 0.5, 1)), "orange"),
        Item("POST", box((1.2, 0.2, 0), (1.5, 0.5, 2)), "green"),
    ),
    (SUN, LAMP),
)
CAMERAS = [
    Camera((6.0, -8.0, 5.0)),
    Camera((6.0, -8.0, 5.0), (0.5, 0.2, -0.1), twist_deg=15.0, fov_deg=50.0),
    Camera((6.0, -8.0, 5.0), parallel=True, height=7.0),
]
SQUARE = Page(100.0, 100.0, 0.0)


def top_view(height: float = 4.0) -> Camera:
    """Looks down on the origin; the page is a map of so many units."""
    return Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), parallel=True, height=height)


def kinds(drawing: Drawing) -> set[str]:
    """The words of the kinds of polygons in a painted picture."""
    return {FillKind(kind).word for kind in np.unique(fills_of(drawing).kind).tolist()}
