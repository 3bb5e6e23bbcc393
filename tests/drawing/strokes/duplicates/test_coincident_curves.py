"""Curves of one item that lie on each other, or on themselves, are drawn once."""

import numpy as np
import pytest
import shapely
from support.drawn import drawn

import vectorplot as vp
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.splines import SplineSurface
from vectorplot.surfaces.surface import Domain

TURN, QUARTER = 2 * np.pi, np.pi / 2
WIDE = 0.02
"""mm by which lines are widened to see how much of the page they cover."""


def ball(u, v):
    return np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)


def ring(u, v):
    return (2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)


def klein_bottle(u, v):
    r = 3 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    return r * np.cos(u), r * np.sin(u), np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)


def roman(u, v):
    """Its border v = 0 runs along an axis there and back, twice."""
    return np.cos(u) * np.sin(u) * np.cos(v) ** 2, np.sin(u) * np.sin(v) * np.cos(v), np.cos(u) * np.sin(v) * np.cos(v)


def cross_cap(u, v):
    """Its border v = pi / 2 runs along an axis there and back, twice."""
    return np.cos(u) * np.sin(2 * v), np.sin(u) * np.sin(2 * v), np.cos(v) ** 2 - np.cos(u) ** 2 * np.sin(v) ** 2


def nurbs_ball():
    root, round_ = np.sqrt(0.5), [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    circle, arc = np.array(round_, dtype=float), np.array([(0, -1), (1, -1), (1, 0), (1, 1), (0, 1)], dtype=float)
    x, y = (circle[:, None, k] * arc[None, :, 0] for k in (0, 1))
    controls = np.stack([x, y, np.broadcast_to(arc[:, 1], x.shape)], axis=-1)
    weights = np.array([1, root] * 4 + [1])[:, None] * np.array([1, root, 1, root, 1])
    return SplineSurface(controls, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [0, 0, 0, 1, 1, 2, 2, 2], 3, 3, weights)


@pytest.mark.slow
@pytest.mark.parametrize(
    "surface",
    [
        surface_of_function(ball, Domain(0.7, 0.7 + TURN, -QUARTER, QUARTER)),
        surface_of_function(ring, Domain(0.7, 0.7 + TURN, 1, 1 + TURN)),
        surface_of_function(klein_bottle, Domain(0, TURN, 0, TURN)),
        surface_of_function(roman, Domain(0, TURN, 0, QUARTER)),
        surface_of_function(cross_cap, Domain(0, TURN, 0, QUARTER)),
        nurbs_ball(),
    ],
    ids=["ball", "ring", "klein bottle", "roman surface", "cross-cap", "spline"],
)
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
def test_borders_that_lie_on_each_other_are_drawn_once(surface):
    drawing = vp.draw(vp.Scene((vp.Item("CLOSED", surface),)), vp.Camera(eye=(5, 3, 2)))
    borders = drawn(drawing).visible.of_kind("boundary")
    assert borders.length_mm > 10.0
    ribbon = shapely.union_all(shapely.buffer(shapely.linestrings(borders.page), WIDE / 2, cap_style="flat"))
    assert abs(ribbon.area / WIDE - borders.length_mm) < 0.02 * borders.length_mm
