"""Hatching along the lines of surfaces: on the surface, on its visible side, as dark as the light leaves it."""

from __future__ import annotations

import io

import cairo
import numpy as np
import pytest

import vectorplot as vp
from vectorplot.backends.cairo import png_bytes
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces import Sphere

SUN = vp.Light((2.0, -3.0, 4.0), parallel=True, intensity=1.0)
CAMERA = vp.Camera((3.0, -6.0, 3.0), parallel=True, height=2.2)
PAGE = vp.Page(66.0, 66.0, 0.0)


def drawn(scene: vp.Scene, **how: object) -> vp.Drawing:
    hatching, coarse = vp.Hatching("tone", along="surface", **how), {"curves": "polyline", "tolerance_mm": 0.1}
    return vp.draw(scene, CAMERA, page=PAGE, fit=False, lines="none", hatch=hatching, **coarse)


def ink(drawing: vp.Drawing) -> np.ndarray:
    surface = cairo.ImageSurface.create_from_png(io.BytesIO(png_bytes(drawing, 10.0 * 25.4)))
    pixels = np.frombuffer(surface.get_data(), dtype=np.uint8).reshape(surface.get_height(), surface.get_width(), 4)
    return 1.0 - pixels[..., 0] / 255.0


def asked(page: np.ndarray, darkest: float) -> tuple[np.ndarray, np.ndarray]:
    """The share of ink that a unit sphere in the sun asks for at places (n,2) of the page, and whether it is there."""
    right, up, back = CAMERA.axes
    x, y = (page - 33.0).T / 30.0
    r = np.hypot(x, y)
    z = np.sqrt(np.maximum(1.0 - r * r, 0.0))
    normal = x[..., None] * right + y[..., None] * up + z[..., None] * back
    cosine = normal @ np.array(SUN.position) / np.linalg.norm(SUN.position)
    light = np.where(cosine > 0.0, cosine, -0.3 * cosine)
    return 0.8 * (1.0 - light) * darkest, r < 1.0


@pytest.mark.slow
def test_a_ball_is_as_dark_as_the_light_leaves_it() -> None:
    cross = True
    ball = vp.Scene((vp.Item("ball", Sphere(1.0)),), (SUN,))
    drawing = drawn(ball, spacing_mm=0.5, cross=cross)
    found = ink(drawing)
    size = len(found)
    rows, columns = np.indices(found.shape)
    places = np.stack([columns + 0.5, size - rows - 0.5], axis=2).reshape(-1, 2) * PAGE.width_mm / size
    wanted, inside = asked(places, vp.Hatching(spacing_mm=0.5, cross=cross).darkest)
    block = (np.floor(places / 11.0) @ (6, 1)).astype(int)
    count = np.bincount(block[inside], minlength=36)
    full = count > 0.8 * (11.0 * size / PAGE.width_mm) ** 2
    means = [
        np.bincount(block[inside], some[inside], minlength=36)[full] / count[full] for some in (found.ravel(), wanted)
    ]
    assert full.sum() >= 12
    assert np.abs(means[0] - means[1]).max() < 0.03


@pytest.mark.slow
def test_strokes_lie_on_the_sides_that_one_sees_and_behind_nothing() -> None:
    """Two balls, one of them before the other."""
    right, _, back = CAMERA.axes
    near = 0.9 * right * 0.5 + 2.5 * back
    scene = vp.Scene((vp.Item("far", Sphere(1.0)), vp.Item("near", Sphere(0.5)).moved(*near.tolist())), (SUN,))
    (paths,) = [
        paths for layer in drawn(scene, spacing_mm=1.5, cross=True).layers for paths in layer.strokes if len(paths)
    ]
    first, sizes = paths.offsets[:-1], np.diff(paths.offsets)
    keep = np.ones(len(paths.points), dtype=bool)
    keep[first] = keep[paths.offsets[1:] - 1] = False
    item = np.repeat(paths.item, sizes)[keep]
    point = paths.points3d[keep]
    assert set(item.tolist()) == {0, 1}
    radius = np.where(item == 0, np.linalg.norm(point, axis=1), 2.0 * np.linalg.norm(point - near, axis=1))
    assert np.abs(radius - 1.0).max() < 1e-3
    normal = np.where((item == 0)[:, None], point, point - near)
    assert (normal @ back).min() > -0.01
    beside = point[item == 0] - near
    beside -= np.outer(beside @ back, back)
    assert np.linalg.norm(beside, axis=1).min() > 0.5 - 1e-3


def test_nothing_to_see_is_nothing_to_hatch() -> None:
    none = vp.Scene((vp.Item("ball", Sphere(1.0), hatch=vp.Hatching("none")),), (SUN,))
    assert not any(len(paths) for layer in drawn(none).layers for paths in layer.strokes)


@pytest.mark.slow
def test_flat_ends_of_round_bodies_are_hatched_as_planes() -> None:
    text = "light L direction 0 0 1\nA gray surface cylinder radius 1 top 2 capped\ncamera eye 4 -6 -5 target 0 0 1\n"
    scene = parse_scene(text)
    hatching = vp.Hatching("tone", spacing_mm=0.6, along="surface")
    drawing = vp.draw(scene, page=PAGE, lines="none", hatch=hatching)
    (paths,) = [paths for layer in drawing.layers for paths in layer.strokes if len(paths)]
    height = paths.points3d[:, 2]
    assert (height < 1e-3).sum() > 20 and (height[height > 1e-3] > 1.0).sum() > 20
