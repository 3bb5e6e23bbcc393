"""The light that the isophotes of an item are of."""

from __future__ import annotations

import numpy as np

from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View

UPPER_LEFT = (-1.0, 1.0, 1.0)
"""The light of a scene without one: from the eye's upper left, in the axes of the view."""


def curve_light(scene: Scene, view: View, item: Item) -> Light:
    """The light that an item names, else the first one of the scene, else one from the eye's upper left.

    Errors: InputError, with the item's name, for a light that the scene does not have.
    """
    number = item.curves.light
    if not scene.lights and number is None:
        x, y, z = (matmul(view.axes.T, np.array(UPPER_LEFT))).tolist()
        return Light((x, y, z), parallel=True)
    if (number or 0) >= len(scene.lights):
        raise InputError(f"{item.name}: isophotes of light {number}: the scene has {len(scene.lights)} lights")
    return scene.lights[number or 0]
