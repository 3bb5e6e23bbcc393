"""What is said of scenes that cannot be decided: one line for each item, or for each pair of them."""

import warnings

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus


def said(items, eye):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        vp.draw(vp.Scene(items), vp.Camera(eye=eye, target=(0, 0, 0)))
    return [str(warning.message) for warning in told]


@pytest.mark.parametrize(
    ("surface", "eye"), [(Sphere(1.0), (1, 0, 0)), (Sphere(3.0), (1, 2, 2)), (Torus(2.0, 1.0), (3, 0, 0))]
)
def test_an_eye_on_a_surface_is_told_in_one_line(surface, eye):
    assert said((vp.Item("BALL", surface, curves=SurfaceLines(columns=4, rows=4)),), eye) == [
        "BALL: the eye is on the surface: what this hides cannot be told"
    ]


@pytest.mark.slow
def test_surfaces_that_coincide_are_told_for_each_pair():
    wave = surface_of_function(lambda u, v: (u, v, 0.2 * np.sin(3 * u)), Domain(-1, 1, -1, 1))
    told = said(tuple(vp.Item(name, wave) for name in "ABC"), (3, 4, 5))
    assert [line.split(":")[0] for line in told] == ["A and B", "A and C", "B and C"]
    assert all("coincide in an area" in line for line in told)
