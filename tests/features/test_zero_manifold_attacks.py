"""The zero manifold of functions that are steep, tiny, huge, broken, nearly double or of a high degree."""

import warnings

import numpy as np
import pytest

from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-1, 1, -1, 1)


def traced(f, cells=20, domain=SQUARE, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return zero_manifold_of_f_uv(f, domain, columns=cells, rows=cells, **options)


def crossings(curve):
    """How many of the segments of all branches properly cross another."""
    a, b = (np.concatenate([curve[k][s] for k in range(len(curve))]) for s in (slice(None, -1), slice(1, None)))

    def side(p, q, r):
        return (q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0]

    a, b, c, d = a[:, None], b[:, None], a[None], b[None]
    return int(((side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)).sum()) // 2


@pytest.mark.parametrize("unit", [1e-305, 1e-200, 1e-12, 1e12, 1e200, 1e305])
def test_the_unit_of_f_does_not_matter(unit):
    def gradient(u, v):
        return unit * 2 * u, -2 * unit * v

    plain, scaled = (traced(lambda u, v, s=s: s * (u * u - v * v), cells=12) for s in (1.0, unit))
    given = traced(lambda u, v: unit * (u * u - v * v), cells=12, gradient=gradient)
    for curve in (scaled, given):
        assert len(curve) == 2 and np.abs(curve.nodes).max() < 1e-9 and len(curve.points) == len(plain.points)
    assert np.allclose(scaled.grid[..., 2], unit * plain.grid[..., 2])


@pytest.mark.hard(37)
@pytest.mark.parametrize("cells", [12, 40])
@pytest.mark.parametrize("gap", [1e-8, -1e-8])
def test_branches_that_nearly_touch_stay_apart(cells, gap):
    # The parabolas v = u^2 and v = -u^2, joined up and down or left and right.
    curve = traced(lambda u, v: (v - u * u) * (v + u * u) - gap, cells, tolerance=1e-3)
    assert len(curve) == 2 and not len(curve.nodes) and crossings(curve) == 0
    assert all((np.sign(curve[k][[0, -1]]).sum(axis=0)[0] == 0) == (gap > 0) for k in range(2))


@pytest.mark.hard(39)
@pytest.mark.parametrize("gap", [1e-4, 1e-3])
def test_two_lines_nearer_than_the_resolution_are_said_to_be_and_make_no_beads(gap):
    def f(u, v):
        return (v - 0.1 * u - 0.0137) * (v - 0.1 * u - 0.0137 - gap)

    curve = traced(f, tolerance=1e-3)
    assert not curve.closed.any() and any("nearer to each other" in text for text in curve.doubts)
    u, v = curve.touching.T
    assert np.abs(v - 0.1 * u - 0.0137 - gap / 2).max() < gap


DOUBLE_LINES = {
    "upright": lambda u, v, a: (u - a) ** 2,
    "lying": lambda u, v, a: (v - a) ** 2,
    "diagonal": lambda u, v, a: (u - v - a) ** 2,
    "skew": lambda u, v, a: (u - 2 * v - a) ** 2,
    "fourfold": lambda u, v, a: (u - a) ** 4,
    "circle": lambda u, v, a: (u * u + v * v - 0.25 - a) ** 2,
}


@pytest.mark.slow
@pytest.mark.hard(39)
@pytest.mark.spread
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("at", [0.0, 0.25, 0.1])
@pytest.mark.parametrize("name", DOUBLE_LINES)
def test_double_lines_are_the_same_on_and_off_the_lattice_and_on_both_sides_of_zero(name, at, sign):
    f = DOUBLE_LINES[name]
    curve = traced(lambda u, v: sign * f(u, v, at), 8)
    assert len(curve) == 0 and len(curve.isolated) <= 2
    assert len(curve.doubts) == 1 and "without changing its sign" in curve.doubts[0]
    assert np.sqrt(np.abs(f(*curve.touching.T, at))).max() < 1e-3 and len(curve.touching) > 500


@pytest.mark.hard(39)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_curve_that_crosses_a_double_line_on_the_lattice_goes_on(sign):
    curve = traced(lambda u, v: sign * u * u * (v - 0.3), 24)
    assert len(curve) == 1 and np.abs(curve.points[:, 1] - 0.3).max() < 1e-9
    assert np.abs(np.sort(curve[0][[0, -1], 0]) - (-1, 1)).max() < 1e-9
    assert "without changing its sign" in curve.doubts[0] and np.abs(curve.touching[:, 0]).max() < 1e-3


@pytest.mark.slow
@pytest.mark.hard(39)
@pytest.mark.parametrize("gap", [1e-6, 3e-6, 1e-5, 2e-5, 3e-5, 5e-5, 1e-4])
def test_two_circles_nearer_than_the_resolution_leave_no_crumbs(gap):
    curve = traced(lambda u, v: (np.hypot(u, v) - 0.5) * (np.hypot(u, v) - 0.5 - gap), 24)
    assert len(curve) == 0 and not len(curve.isolated) and len(curve.touching) > 50
    assert any("nearer to each other" in text for text in curve.doubts)


@pytest.mark.slow
@pytest.mark.hard(40)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("radius", [0.003, 0.01])
def test_a_resolved_tiny_oval_beside_a_double_line_stays(radius):
    curve = traced(lambda u, v: -((u - 0.25) ** 2) * ((u + 0.4) ** 2 + (v - 0.3) ** 2 - radius**2), 24)
    assert len(curve) == 1 and curve.closed.all()
    assert np.abs(np.hypot(*(curve.points - (-0.4, 0.3)).T) - radius).max() < 1e-9


@pytest.mark.slow
def test_a_finer_resolution_tells_near_lines_apart():
    curve = traced(lambda u, v: (v - 0.1 * u - 0.0137) * (v - 0.1 * u - 0.0147), resolution=2.5e-4)
    assert len(curve) == 2 and not curve.doubts and not curve.closed.any()
    for k in range(2):
        off = curve[k][:, 1] - 0.1 * curve[k][:, 0]
        assert np.ptp(off) < 1e-8


@pytest.mark.hard(40)
def test_many_tiny_ovals_are_no_beads():
    curve = traced(lambda u, v: np.cos(12 * u) * np.cos(12 * v) - 0.9999, 40)
    assert len(curve) == 25 and curve.closed.all() and not curve.doubts


@pytest.mark.slow
@pytest.mark.hard(38)
@pytest.mark.parametrize("cells", [12, 40])
def test_a_rose_has_one_node_of_many_petals_and_no_points_beside_it(cells):
    def three(u, v):
        return (u * u + v * v) ** 2 - 0.8 * (u**3 - 3 * u * v * v)

    curve = traced(three, cells, tolerance=1e-3)
    assert len(curve.nodes) == 1 and np.abs(curve.nodes).max() < 1e-3 and not len(curve.isolated)
    four = traced(lambda u, v: (u * u + v * v) ** 3 - 0.7 * (u * u - v * v) ** 2, cells, tolerance=1e-3)
    assert not len(four.isolated) and not len(four.touching) and np.abs(four.nodes).max() < 0.05


@pytest.mark.hard(39)
def test_a_zero_of_third_order_changes_its_sign_and_is_a_curve():
    curve = traced(lambda u, v: (v - 0.2 * u - 0.0123) ** 3, 12)
    assert len(curve) == 1 and not len(curve.touching) and not curve.doubts
    # f is refined to a trillionth of its scale, so the curve to its third root.
    assert np.abs(curve.points[:, 1] - 0.2 * curve.points[:, 0] - 0.0123).max() < 2e-4


@pytest.mark.hard(38)
@pytest.mark.parametrize(("f", "nodes"), [(lambda u, v: v * v - u**3, 1), (lambda u, v: v * v - u**4, 1)])
def test_cusp_and_touching_parabolas_have_a_node(f, nodes):
    curve = traced(f, tolerance=1e-3)
    assert len(curve.nodes) == nodes and np.abs(curve.nodes).max() < 2e-3 and not len(curve.isolated)


@pytest.mark.slow
def test_twenty_periods():
    curve = traced(lambda u, v: np.sin(20 * np.pi * u) - np.cos(20 * np.pi * v), 40)
    assert len(curve) == 40 and len(curve.nodes) == 820 and not curve.doubts
    rings = traced(lambda u, v: np.sin(60 * np.hypot(u - 0.01, v + 0.02)), 40)
    assert rings.closed.sum() == 18
    radii = [np.hypot(*(rings[k] - (0.01, -0.02)).T) * 60 / np.pi for k in range(len(rings))]
    assert max(np.abs(r - np.round(r[0])).max() for r in radii) < 1e-10


@pytest.mark.slow
@pytest.mark.hard(69)
def test_holes_jumps_and_poles_break_nothing():
    stripes = traced(lambda u, v: np.where(np.sin(20 * u) > 0.3, np.nan, v - 0.3 * u))
    assert len(stripes) == 7 and np.abs(stripes.points[:, 1] - 0.3 * stripes.points[:, 0]).max() < 1e-12
    step = traced(lambda u, v: np.where(u > 0.1, v - 0.2, v + 0.3))
    assert len(step) == 2 and any("jumps" in text for text in step.doubts)
    steep = traced(lambda u, v: np.tanh(1e3 * (u * u + v * v - 0.4)), tolerance=1e-3)
    assert len(steep) == 1 and np.abs(np.hypot(*steep.points.T) - np.sqrt(0.4)).max() < 1e-12
    assert len(traced(lambda u, v: np.floor(5 * u + 3 * v) + 0.5)) == 0
