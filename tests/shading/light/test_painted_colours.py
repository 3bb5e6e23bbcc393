"""Coloured light in painted pictures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.errors import InputError
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.shading.illumination import shadow_shades
from vectorplot.shading.palettes import palette, shaded_colours
from vectorplot.shading.shaded_faces import light_colours
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.testing.shapes import box

SUN = Light((-1.0, -2.0, 3.0), parallel=True, intensity=0.8)
LAMP = Light((3.0, -1.0, 5.0), intensity=0.6)
CAMERA = vp.Camera((5.0, -8.0, 6.0), fov_deg=30.0)
MIRROR = Item("M", box((-2, 2, -1), (2, 2.1, 2)), "gray", Material("mirror"))


def scene(*lights: Light, items: tuple[Item, ...] = ()) -> Scene:
    return Scene(
        (
            Item("PLATE", box((-3, -3, -1.1), (3, 3, -1)), "gray"),
            Item("BOX", box((-1, -1, -1), (0, 0, 1)), "orange"),
            Item("BALL", Sphere(0.8, (1.2, -1.0, -0.2)), "#80a0ff", Material("plastic")),
            *items,
        ),
        lights,
    )


def fills_of(picture: Scene, *, smooth: bool = True) -> Fills:
    drawing = vp.paint(picture, CAMERA, tolerance_mm=4.0, smooth=smooth)
    (fills,) = (some for layer in drawing.layers for some in layer.fills)
    return fills


def colours(picture: Scene) -> np.ndarray:
    """Of the corners of polygons, which are the same in light of every colour where none has a gradient."""
    return fills_of(picture, smooth=False).colours.astype(int)


@pytest.mark.slow
@pytest.mark.capability("G8.5-coloured-light")
@pytest.mark.parametrize("items", [(), (MIRROR,)], ids=["plain", "mirror"])
def test_painted_lights_of_three_colours_are_white_together(items):
    parts = [replace(SUN, colour=colour) for colour in ("#ff0000", "#00ff00", "#0000ff")]
    white = colours(scene(SUN, items=items))
    for channel, light in enumerate(parts):
        found = colours(scene(light, items=items))
        assert (found[:, channel] == white[:, channel]).all(), "red light changes nothing of the red"
        assert (found <= white).all()
        assert (found < white).any()
    # White light beside coloured one, each with shadows of its own.
    both = colours(scene(SUN, replace(LAMP, colour="#ffffff"), items=items))
    assert (both == colours(scene(SUN, LAMP, items=items))).all()


@pytest.mark.slow
def test_a_shadow_of_a_red_light_lacks_red():
    picture = scene(replace(SUN, colour="#ff0000"), replace(LAMP, colour="#00ffff"))
    fills = fills_of(picture)
    first = fills.colours[fills.offsets[:-1]].astype(int)
    plate = first[(fills.item == 0) & (fills.kind == FillKind.SHADOW)]
    bluish, reddish = (plate[:, 2] > plate[:, 0] + 30).any(), (plate[:, 0] > plate[:, 2] + 30).any()
    assert bluish and reddish, "where the red light does not get, and where the other one does not"


def test_shades_of_three_components():
    rng = np.random.default_rng(1)
    shares, cue = rng.uniform(0.0, 1.0, (2, 9)), rng.uniform(0.0, 0.2, 9)
    strength = light_colours([replace(SUN, colour="#ff8000"), LAMP])
    assert strength.shape == (2, 3)
    assert strength[0] == pytest.approx(0.8 * np.array((255, 128, 0)) / 255.0)
    assert light_colours([SUN, LAMP]).tolist() == [0.8, 0.6]
    lacking = rng.integers(0, 4, 9)
    found = shadow_shades(shares, strength, lacking, cue)
    for channel in range(3):
        assert (found[channel] == shadow_shades(shares, strength[:, channel], lacking, cue)).all()
    which = rng.integers(0, 2, 9)
    made = shaded_colours(["gray", "orange"], which, found, 64)
    for number, name in enumerate(["gray", "orange"]):
        for channel in range(3):
            numbers = np.clip(np.floor(found[channel] * 64 + 0.5), 0, 63).astype(int)
            assert (made[:, channel] == palette(name, 64)[numbers, channel])[which == number].all()


def test_unknown_colours_of_light_are_refused():
    with pytest.raises(InputError, match="mauve"):
        vp.paint(scene(replace(SUN, colour="mauve")), CAMERA)
