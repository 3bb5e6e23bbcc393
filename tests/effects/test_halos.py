import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.effects.halos import outer_zones
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box

TOP = Camera.view("top", (0.0, 0.0, 0.0), 10.0)
PAGE = Page(200.0, 200.0, 10.0)


def cross() -> Scene:
    """A bar along x above a longer bar along y."""
    return Scene((Item("upper", box((-3, -1, 1), (3, 1, 2))), Item("lower", box((-0.5, -9, -1), (0.5, 9, 0)))))


def gaps(halo_mm: float) -> tuple[float, float]:
    """How far the sides of the lower bar end from the upper one, in mm, above and below it."""
    drawing = draw(cross(), TOP, page=PAGE, halo_mm=halo_mm)
    scale = 180.0 / 18.0
    sides = []
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero(paths.item == 1):
                sides.append(paths.points[paths.offsets[k] : paths.offsets[k + 1]] - 100.0)
    ends = np.concatenate(sides)
    ends = ends[np.abs(np.abs(ends[:, 0]) - 0.5 * scale) < 1e-6]
    above, below = ends[ends[:, 1] > 0.0, 1].min(), -ends[ends[:, 1] < 0.0, 1].max()
    return above - scale, below - scale


@pytest.mark.capability("G7.2-aura")
@pytest.mark.parametrize("halo_mm", [0.0, 0.5, 2.0])
def test_lines_end_the_width_of_the_halo_before_what_is_in_front(halo_mm: float) -> None:
    assert np.allclose(gaps(halo_mm), halo_mm, atol=1e-6)


def test_the_outline_itself_stays_whole() -> None:
    drawing = draw(cross(), TOP, page=PAGE, halo_mm=2.0)
    upper = 0.0
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero(paths.item == 0):
                points = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
                closed = np.concatenate([points, points[:1]]) if paths.closed[k] else points
                upper += np.hypot(*np.diff(closed, axis=0).T).sum()
    assert np.isclose(upper, 10.0 * 2.0 * (6.0 + 2.0))


@pytest.mark.parametrize("halo_mm", [90.0, 1e6, 1e300])
def test_a_halo_wider_than_a_stroke_takes_all_of_it(halo_mm: float) -> None:
    drawing = draw(cross(), TOP, page=PAGE, halo_mm=halo_mm)
    assert all((paths.item == 0).all() for layer in drawing.layers for paths in layer.strokes)


POINT = st.tuples(st.floats(-3, 3), st.floats(-3, 3))


@given(POINT, POINT, POINT, POINT, st.sampled_from([-1, 1]), st.floats(0.05, 2.0))
def test_zones_hold_the_near_points_on_the_outer_side(p0, p1, q0, q1, side, width) -> None:
    a, b, c, d = (np.array(p)[:, None] for p in (p0, p1, q0, q1))
    if np.hypot(*(b - a))[0] < 1e-3 or np.hypot(*(d - c))[0] < 1e-3:
        return
    low, high = outer_zones(a, b, c, d, np.array([side]), width)
    at = np.linspace(0.0, 1.0, 101)
    points = a + at * (b - a)
    axis = d - c
    foot = np.clip(((points - c) * axis).sum(axis=0) / (axis * axis).sum(), 0.0, 1.0)
    away = np.hypot(*(points - c - foot * axis))
    height = (axis[0] * (points - c)[1] - axis[1] * (points - c)[0]) / np.hypot(*axis)
    margin = 1e-6
    surely = (away < width - margin) & (side * height < -margin)
    never = (away > width + margin) | (side * height > margin)
    within = (low[0] - margin <= at) & (at <= high[0] + margin)
    assert within[surely].all()
    inside = (low[0] + margin < at) & (at < high[0] - margin)
    assert not inside[never].any()
