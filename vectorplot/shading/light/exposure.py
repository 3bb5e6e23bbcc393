"""How bright a picture is made as a whole: the intensities of all lights, times one factor.

Source: Glaeser, section 4.5, equation 7.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from vectorplot.errors import InputError
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import face_shades, shows_inside, view_lights
from vectorplot.shading.light.illumination import fitting_factor, intensities
from vectorplot.visibility.painter.image_faces import outer_sides


@dataclass(frozen=True)
class ExposedLight(Light):
    """A light of a picture, its intensity times the exposure: of any size, but not negative."""

    def __post_init__(self) -> None:
        if self.intensity is not None and not 0.0 <= self.intensity < np.inf:
            raise InputError(f"light {self.name}: an exposure to {self.intensity:g} times its light is out of range")


def exposed_scene(view: View, scene: Scene) -> tuple[Scene, tuple[Light, ...]]:
    """A scene with lights as its exposure has them, and these in the view: at least one, as of view_lights.

    view: of the scene, surfaces as triangles. A fitted exposure is such that the brightest of the faces that are seen,
    wherever shadows fall, just reaches the end of the lights' part of the palette. Degenerate: in the dark it is 1.
    Source: Glaeser, section 4.5.
    """
    here = view_lights(view, scene.lights)
    if scene.exposure == 1.0:
        return scene, here
    factor = _fitted(view, scene.items, here) if scene.exposure == "fitted" else scene.exposure
    return replace(scene, lights=_exposed(scene.lights, factor)), _exposed(here, factor)


def _exposed(lights: Sequence[Light], factor: float) -> tuple[Light, ...]:
    """The lights with a factor to their intensities, of which those that say none have their share."""
    given = [{field.name: getattr(light, field.name) for field in fields(light)} for light in lights]
    strength = (factor * intensities(lights)).tolist()
    return tuple(ExposedLight(**one | {"intensity": share}) for one, share in zip(given, strength, strict=True))


def _fitted(view: View, items: Sequence[Item], lights: Sequence[Light]) -> float:
    """The factor of a fitted exposure. Of closed items the faces that turn away are not seen."""
    side = outer_sides(view)[view.face_item]
    seen = (side == 0) | (shows_inside(view) == (side < 0))
    found = face_shades(view, items, lights)
    return fitting_factor(found.shares[:, seen], found.intensity)
