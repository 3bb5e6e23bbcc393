"""What mirrors show where there is nothing before them: the paper."""

import numpy as np
import pytest
from support.top_fills import colours_at, fills_of, top_at

import vectorplot as vp
from vectorplot.pictures.fills import PAPER
from vectorplot.shading.palettes import palette
from vectorplot.testing.shapes import box

PAGE = vp.Page(100.0, 100.0, 0.0)
CAMERAS = [vp.Camera((0.0, -9.0, 2.0)), vp.Camera((2.0, -9.0, 5.0), parallel=True, height=8.0)]
SUN = vp.Light((-1.0, -2.0, 3.0), parallel=True)


def scene_of(colour: str, background: str | None, lights: tuple[vp.Light, ...]) -> vp.Scene:
    """A mirror, a ball high above it whose shadow falls on it, and a plate behind."""
    mirror = vp.Item("MIRROR", box((-2, 0, -2), (2, 0.1, 2)), colour, vp.Material("mirror"))
    above = vp.Item("ABOVE", box((-0.7, -1.5, 2.5), (0.3, -0.5, 3.0)), "red")
    return vp.Scene((mirror, above), lights, background=background)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("camera", CAMERAS, ids=["central", "parallel"])
@pytest.mark.parametrize("colour", ["cyan", "black", "darkorange"])
@pytest.mark.parametrize("background", [None, "cyan", "darkblue"])
@pytest.mark.parametrize("lights", [(), (SUN,)], ids=["dark", "lit"])
def test_an_empty_mirror_shows_the_paper(camera, colour, background, lights) -> None:
    scene = scene_of(colour, background, lights)
    paper = palette(background or PAPER)[-1].astype(float)
    painted = vp.paint(scene, camera, page=PAGE, fit=False)
    pixels = vp.render(scene, camera, size=(200, 200), fit=False).pixels.astype(float)
    fills, near = fills_of(painted), 0
    for x, y in np.random.default_rng(1).uniform(20.0, 80.0, (60, 2)):
        place = np.array([[x, y]])
        top = top_at(fills, place)
        if top[0] < 0 or fills.item[top[0]] != 0 or fills.opacity[top[0]] < 1.0:
            continue
        shown = colours_at(fills, top, place)[0]
        assert (np.abs(shown - paper) <= 0.15 * 255.0 + 1.0).all()
        pixel = pixels[200 - int(2 * y) - 1, int(2 * x)]
        near += bool((np.abs(shown - pixel) <= 6.0).all())
    assert near >= 8
