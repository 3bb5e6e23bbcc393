"""How dark shadows are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.drawing.fills import FillKind
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.shading.illumination import DIRECT_SHARE, LEVELS, shades, shadow_shades
from vectorplot.testing.shapes import box

SHARES = st.lists(st.floats(0.0, 3.0), min_size=3, max_size=3)


@pytest.mark.capability("G6.3-shadow-shade")
def test_a_shadow_of_the_only_light_has_half_of_the_reduced_palette() -> None:
    share, cue = np.array([[0.2, 0.9, 1.0]]), np.array([0.0, 0.1, 0.2])
    assert np.allclose(shadow_shades(share, [1.0], [1, 1, 1], cue), 0.5 * DIRECT_SHARE * share[0] + cue)


@pytest.mark.capability("G6.3-shadow-shade")
@given(SHARES, SHARES)
def test_shades_fall_with_every_light_that_is_lacking_and_rise_with_depth(
    share: list[float], more: list[float]
) -> None:
    one = np.array(share)[:, None]
    lit = shades(one, [0.5, 0.7, 0.4])
    grades = [shadow_shades(one, [0.5, 0.7, 0.4], [mask])[0] for mask in (0, 1, 3, 7)]
    assert np.isclose(grades[0], lit[0]) and np.isclose(grades[3], 0.5 * lit[0])
    assert all(a >= b - 1e-12 for a, b in pairwise(grades))
    if min(share) > 1e-3:
        assert grades[0] > grades[1] > grades[2] > grades[3]
    soft = [shadow_shades(one, [0.5, 0.7, 0.4], [2], dimmed=[0], step=[k])[0] for k in range(1, LEVELS)]
    full = shadow_shades(one, [0.5, 0.7, 0.4], [2])[0]
    dark = shadow_shades(one, [0.5, 0.7, 0.4], [3])[0]
    steps = np.diff([full, *soft, dark])
    assert (steps <= 1e-12).all() and steps[1:-1].min() == pytest.approx(steps[1:-1].max(), abs=1e-12)
    assert steps.min() >= 1.01 * (dark - full) / (LEVELS - 1) - 1e-12
    brighter = shadow_shades(one + np.array(more)[:, None], [0.5, 0.7, 0.4], [7])[0]
    assert brighter >= grades[3] - 1e-12
    deeper = [shadow_shades(one, [0.5, 0.7, 0.4], [3], cue)[0] for cue in (0.0, 0.1, 0.2)]
    assert deeper[0] < deeper[1] < deeper[2]


def test_in_the_dark_nothing_is_lost() -> None:
    assert shadow_shades(np.zeros((2, 1)), [1.0, 1.0], [3], 0.1).tolist() == [0.1]


ROAD = Item("ROAD", box((-3, 0, -1), (3, 60, 0)))
WALL = Item("WALL", box((1, 0, 3), (2, 60, 3.2)))
ALONG = vp.Camera((0, -10, 6), (0, 10, 0), fov_deg=50)


@pytest.mark.capability("G6.3-shadow-shade")
def test_a_large_shadow_becomes_darker_with_its_depth_in_pixels() -> None:
    scene = Scene((ROAD, WALL), (Light((0, 0, 1), parallel=True, intensity=1.0),))
    pixels = vp.render(scene, ALONG, size=(160, 120), fit=False, samples=1).pixels.astype(int)
    y = np.array([2.0, 6.0, 14.0, 30.0, 50.0])
    levels = []
    for x in (1.5, -1.5):  # Below the wall, and beside it.
        right, up, ahead = ALONG.axes @ (np.stack([np.full(5, x), y, np.zeros(5)]) - np.array(ALONG.target)[:, None])
        scale = 60.0 / np.tan(np.radians(25.0)) / (ALONG.distance - ahead)
        levels.append(pixels[np.rint(59.5 - up * scale).astype(int), np.rint(79.5 + right * scale).astype(int), 0])
    dark, lit = levels
    assert (np.diff(dark) < 0).all() and (np.diff(lit) < 0).all()
    # Half of the reduced palette is gone, at any depth.
    assert np.abs(lit - dark - 0.5 * DIRECT_SHARE * 255.0).max() <= 2.0


@pytest.mark.capability("G6.3-shadow-shade", "G4.6-depth-shade")
def test_a_large_painted_shadow_varies_as_the_light_and_the_depth_of_its_plane_do() -> None:
    """In sunlight by depth alone, below a lamp by both."""
    shades = {}
    for light in (Light((0, 0, 1), parallel=True, intensity=1.0), Light((0, 5, 9), intensity=1.0)):
        (fills,) = vp.paint(Scene((ROAD, WALL), (light,)), ALONG).layers[0].fills
        lowest = np.minimum.reduceat(fills.points3d[:, 2], fills.offsets[:-1])
        top = (lowest > -1e-9) & (fills.item == 0)
        ahead = np.linalg.norm(fills.points3d - light.position, axis=1) if not light.parallel else fills.points3d[:, 1]
        shades[light.parallel] = []
        for kind in (FillKind.SHADOW, FillKind.FACE):
            own = np.repeat(top & (fills.kind == kind), np.diff(fills.offsets))
            shades[light.parallel].append((ahead[own], fills.colours[own, 0].astype(int)))
    (far, dark), (further, lit) = shades[True]
    assert np.ptp(dark) > 25 and np.ptp(lit) > 25
    assert np.corrcoef(far, dark)[0, 1] < -0.98 and np.corrcoef(further, lit)[0, 1] < -0.98
    nearest = np.abs(far[:, None] - further).argmin(axis=1)
    beside = np.abs(far - further[nearest]) < 0.3
    assert beside.sum() > 5
    assert np.abs(lit[nearest[beside]] - dark[beside] - 0.5 * DIRECT_SHARE * 255.0).max() <= 4.0
    (far, dark), (further, lit) = shades[False]
    assert np.ptp(dark) > 40 and np.ptp(lit) > 60
    assert np.corrcoef(far, dark)[0, 1] < -0.8 and dark[far.argmin()] >= dark.max() - 8
    # Half as bright as what is lit at the same distance.
    nearest = np.abs(far[:, None] - further).argmin(axis=1)
    beside = np.abs(far - further[nearest]) < 0.3
    assert beside.sum() > 5 and (dark[beside] < 0.75 * lit[nearest[beside]] + 12).all()
