"""Surfaces that meet themselves: what lies on one of their sheets goes through the other ones."""

from __future__ import annotations

import numpy as np
import pytest
from support.effort import several

from vectorplot.geometry.camera import Camera
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.draw import draw
from vectorplot.scene.scene import Scene
from vectorplot.testing import assert_drawing_is_right

OUTLINES = ("contour", "boundary")

BENT = "T surface helicoid 2 angle 0 519 bending 70"

PAIRS = {
    "spiral tube through a bent helicoid": """
        S surface spiral 0.073 circle 0.579 centre 1.5 0 0 axis 0 1 0 angle -125 149
        T surface helicoid 1.605 angle 0 319 bending 60 rotation x 20 translation 1.585 1.433 -0.994
        """,
    "bent helicoid through a torus that meets itself": """
        S surface torus 1 1.6
        T surface helicoid 2 angle 0 359 bending 60 rotation x 40 translation 0.4 0.3 0
        """,
    "two bent helicoids": f"{BENT} U surface helicoid 2 angle 0 519 bending 60 rotation y 70 translation 0.3 0.2 0.1",
}


def seen(text: str, way: tuple[float, float, float], parallel: bool) -> tuple[Scene, Camera]:
    """The scene, and a camera that looks at its middle from some way."""
    scene = parse_scene(text)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    eye = middle + 1.7 * size * np.array(way)
    return scene, Camera(eye=tuple(eye.tolist()), target=tuple(middle.tolist()), parallel=parallel)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "parallel"), list(zip(PAIRS, (False, False, True), strict=True)))
def test_curves_in_which_sheets_meet_go_through_third_ones(name: str, parallel: bool) -> None:
    scene, camera = seen(PAIRS[name], (0.3, -0.5, 0.8), parallel)
    drawing = draw(scene, camera, hidden="dashed", lines=(*OUTLINES, "intersection"))
    assert assert_drawing_is_right(drawing, scene, camera, samples=several(200, long=400)) > 100


@pytest.mark.slow
@pytest.mark.parametrize("way", [(0.9, 0.35, -0.25), (-0.2, 0.1, 1.0)])
def test_outlines_go_through_sheets_whose_meetings_nobody_draws(way: tuple[float, float, float]) -> None:
    scene, camera = seen(BENT, way, parallel=False)
    drawing = draw(scene, camera, hidden="dashed", lines=OUTLINES)
    assert assert_drawing_is_right(drawing, scene, camera, samples=several(200, long=600)) > 100
