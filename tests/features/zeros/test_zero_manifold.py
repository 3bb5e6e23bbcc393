"""The zero manifold against curves known in closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.errors import InputError
from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-1, 1, -1, 1)
TURN = 2 * np.pi
EYE = np.array([8.0, -3.0, 6.0])


def torus(u, v):
    """Points and unit normals of the torus with radii 3 and 2."""
    r = 3 + 2 * np.cos(v)
    normal = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
    return np.stack([r * np.cos(u), r * np.sin(u), 2 * np.sin(v)], axis=-1), normal


def torus_contour(u, v):
    x, n = torus(u, v)
    return ((x - EYE) * n).sum(axis=-1)


def area(p):
    x, y = p.T
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


@pytest.mark.capability("G8.4-zero-manifold")
def test_circle_is_one_closed_branch_refined_to_rounding():
    curve = zero_manifold_of_f_uv(lambda u, v: u * u + v * v - 0.5, SQUARE, columns=30, rows=30)
    assert len(curve) == 1 and curve.closed.all() and not curve.doubts
    assert np.abs(np.hypot(*curve.points.T) - np.sqrt(0.5)).max() < 1e-12
    # Positive outside: the outside is on the left, so the circle is run clockwise.
    assert abs(area(curve[0][:-1]) + np.pi / 2) < 2e-2
    triangles, normals = curve.triangulation
    assert triangles.shape == (2 * 30 * 30, 3)
    # At every inner point of the grid (u, v, f(u, v)) the normal of the graph, to the square of a step.
    u, v = np.meshgrid(np.linspace(-1, 1, 31), np.linspace(-1, 1, 31), indexing="ij")
    assert np.allclose(curve.grid[..., :2], np.stack([u, v], axis=-1)) and normals.shape == (31, 31, 3)
    assert np.allclose(np.linalg.norm(normals, axis=2), 1.0)
    slopes = (-normals[..., :2] / normals[..., 2:])[1:-1, 1:-1]
    assert np.abs(slopes - 2 * np.stack([u, v], axis=-1)[1:-1, 1:-1]).max() < (2 / 30) ** 2


@pytest.mark.capability("G8.4-zero-manifold")
def test_several_closed_branches():
    curve = zero_manifold_of_f_uv(lambda u, v: np.sin(9 * u) * np.sin(9 * v) - 0.5, SQUARE, columns=50, rows=50)
    f = np.sin(9 * curve.points[:, 0]) * np.sin(9 * curve.points[:, 1]) - 0.5
    assert np.abs(f).max() < 1e-12
    # Same signs of both factors: 9 whole lobes and pieces at the border.
    centres = np.array([curve[k].mean(axis=0) for k in range(len(curve)) if curve.closed[k]])
    peaks = [(a * np.pi / 18, b * np.pi / 18) for a in range(-5, 6, 2) for b in range(-5, 6, 2)]
    whole = [p for p in peaks if np.sin(9 * p[0]) * np.sin(9 * p[1]) > 0 and max(map(abs, p)) < 0.8]
    assert len(centres) >= len(whole)
    assert all(np.hypot(*(centres - p).T).min() < 0.02 for p in whole)


@pytest.mark.parametrize(("size", "offset", "unit"), [(1e-6, 0, 1e9), (1e6, 0, 1e-9), (1, 1e6, 1), (1e-3, 1e3, 1)])
def test_a_scaled_and_shifted_function_has_the_same_curve(size, offset, unit):
    def f(u, v):
        return u * u + 2 * v * v - 0.4

    plain = zero_manifold_of_f_uv(f, SQUARE, columns=20, rows=20)
    far = Domain(offset - size, offset + size, -size, size)
    moved = zero_manifold_of_f_uv(
        lambda u, v: unit * f((u - offset) / size, v / size), far, columns=20, rows=20, tolerance=1e-3 * size
    )
    assert len(plain) == len(moved) == 1 and plain.closed.all() and moved.closed.all() and not moved.doubts
    rounding = 1e-15 * max(1.0, offset / size)
    assert np.abs(f(*((moved.points - (offset, 0)) / size).T)).max() < 100 * rounding + 1e-12


def test_same_input_same_bytes():
    one, two = (zero_manifold_of_f_uv(torus_contour, torus_domain(), columns=30, rows=30) for _ in range(2))
    assert one.points.tobytes() == two.points.tobytes()


def test_a_given_gradient_finds_the_same_node():
    def gradient(u, v):
        return v, u

    curve = zero_manifold_of_f_uv(lambda u, v: u * v, SQUARE, columns=11, rows=11, gradient=gradient)
    assert np.abs(curve.nodes).max() < 1e-12


def torus_domain():
    return Domain(1.0, 1.0 + TURN, -np.pi, np.pi, closed_u=True, closed_v=True)


def meridian(points, u):
    """The v at which a curve was met on the grid line u."""
    turned = (points[:, 0] - u) / TURN
    v = points[np.abs(turned - np.round(turned)) < 1e-12, 1]
    return np.unique(np.round((v + np.pi) % TURN - np.pi, 12))


def test_contour_condition_of_the_torus_at_the_test_values():
    assert abs(torus_contour(np.array(0.4), np.array(-1.1)) - 5.89563091788613) < 1e-12


@pytest.mark.capability("G8.4-zero-manifold")
def test_contour_of_the_torus_on_the_meridian_of_the_test_values():
    curve = zero_manifold_of_f_uv(torus_contour, torus_domain(), columns=24, rows=24)
    assert len(curve) == 2 and curve.closed.all()
    on_start = meridian(curve.points, 1.0)
    assert np.allclose(on_start, (0.530672447122628, 3.00635055049926), atol=1e-10)


def test_isophote_of_the_torus_on_the_meridian_of_the_test_values():
    light = np.array([2.0, 1.0, 3.0]) / np.sqrt(14.0)
    curve = zero_manifold_of_f_uv(
        lambda u, v: torus(u, v)[1] @ light - np.cos(0.8), torus_domain(), columns=24, rows=24
    )
    on_start = meridian(curve.points, 1.0)
    assert np.allclose(on_start, (0.250947749701766, 1.75103718202499), atol=1e-10)


@pytest.mark.parametrize("unit", [True, False])
def test_contour_of_the_sphere_is_a_circle_and_the_poles_make_no_spikes(unit):
    eye = np.array([1.5, 1.0, 2.0])
    domain = Domain(0, TURN, -np.pi / 2, np.pi / 2, closed_u=True)

    def point(u, v):
        return np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)

    def f(u, v):
        normal = point(u, v) * np.cos(v)[..., None]
        if unit:
            normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        return ((point(u, v) - eye) * normal).sum(axis=-1)

    curve = zero_manifold_of_f_uv(f, domain, columns=36, rows=18)
    assert len(curve) == 1 and curve.closed.all()
    x = point(*curve.points.T)
    assert np.abs(x @ eye - 1).max() < 1e-10
    assert np.linalg.norm(np.diff(x, axis=0), axis=1).max() < 0.3


def deviation_from_circle(p, centre, radius):
    """Largest distance of chords from a circle."""
    middle = (p[1:] + p[:-1]) / 2
    return np.abs(np.hypot(*(middle - centre).T) - radius).max()


@pytest.mark.parametrize("tolerance", [1.0, 0.02, 1e-4])
def test_chords_stay_within_the_tolerance_on_the_page(tolerance):
    centre = (0.1, -0.2)
    curve = zero_manifold_of_f_uv(
        lambda u, v: np.hypot(u - centre[0], v - centre[1]) - 0.6,
        SQUARE,
        columns=8,
        rows=8,
        positions=lambda u, v: 100 * np.stack([u, v], axis=-1),
        tolerance=tolerance,
    )
    assert len(curve) == 1 and curve.closed.all()
    assert deviation_from_circle(100 * curve[0], 100 * np.array(centre), 60.0) <= tolerance
    assert np.abs(np.hypot(*(curve.points - centre).T) - 0.6).max() < 1e-11
    # No more points than a curve of that radius needs, give or take: a chord of length c is off by c^2 / (8 r).
    assert len(curve.points) < 60 + 5 * TURN / np.sqrt(8 * tolerance / 60)


def test_chords_follow_a_waving_curve_between_two_grid_points():
    curve = zero_manifold_of_f_uv(lambda u, v: v - 0.05 * np.sin(20 * u), SQUARE, columns=20, rows=20, tolerance=1e-5)
    p = curve[0]
    fine = np.concatenate([p[:-1] + s * np.diff(p, axis=0) for s in (0.25, 0.5, 0.75)])
    assert np.abs(fine[:, 1] - 0.05 * np.sin(20 * fine[:, 0])).max() < 2e-5


@pytest.mark.slow
@given(st.floats(0, np.pi), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
@settings(max_examples=examples(12))
def test_the_two_lines_of_a_random_cross_meet_in_their_node(angle, a, b):
    def f(u, v):
        x, y = np.cos(angle) * (u - a) + np.sin(angle) * (v - b), np.cos(angle) * (v - b) - np.sin(angle) * (u - a)
        return x * y

    curve = zero_manifold_of_f_uv(f, SQUARE, columns=14, rows=14)
    assert len(curve.nodes) == 1 and np.abs(curve.nodes[0] - (a, b)).max() < 1e-9
    assert len(curve) == 2 and not curve.closed.any()


@pytest.mark.parametrize(("columns", "closed"), [(1, False), (2, True)])
def test_too_few_cells(columns, closed):
    with pytest.raises(InputError, match="columns"):
        zero_manifold_of_f_uv(lambda u, v: u, Domain(0, 1, 0, 1, closed_u=closed), columns=columns, rows=9)


def test_a_function_that_does_not_give_one_value_each():
    with pytest.raises(InputError, match="one value for each"):
        zero_manifold_of_f_uv(lambda u, v: np.stack([u, v]), SQUARE, columns=4, rows=4)


def test_a_curve_that_leaves_the_domain_between_two_grid_points_is_cut_there():
    top = 1.001
    curve = zero_manifold_of_f_uv(lambda u, v: v + (u - 0.025) ** 2 - top, SQUARE, columns=20, rows=20, tolerance=1e-4)
    assert len(curve) == 2 and np.abs(curve.points).max() <= 1 + 1e-12 and not curve.doubts
    ends = np.concatenate([curve[k][[0, -1]] for k in range(2)])
    on_top = np.sort(ends[ends[:, 1] > 0.999, 0])
    assert np.allclose(on_top, 0.025 + np.array([-1, 1]) * np.sqrt(top - 1), atol=1e-9)


@pytest.mark.capability("G8.4-zero-manifold")
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("seed", range(12))
def test_random_waves_have_the_same_branches_as_on_a_much_finer_grid(seed):
    waves = np.random.default_rng(seed).normal(size=(2, 9, 9))
    domain = Domain(0, TURN, 0, TURN, closed_u=seed % 3 > 0, closed_v=seed % 3 > 1)

    def f(u, v):
        k = np.arange(-4, 5)
        along_u, along_v = np.exp(1j * np.multiply.outer(k, u)), np.exp(1j * np.multiply.outer(k, v))
        return np.einsum("ij,ik,jk->k", waves[0] + 1j * waves[1], along_u, along_v).real

    curve = zero_manifold_of_f_uv(f, domain, columns=30, rows=30, tolerance=1e-3)
    fine = zero_manifold_of_f_uv(f, domain, columns=150, rows=150)
    assert len(curve) == len(fine) and sorted(curve.closed) == sorted(fine.closed) and not curve.doubts
    assert np.abs(f(*curve.points.T)).max() < 1e-11 * np.abs(curve.grid[..., 2]).max()
    ends = np.concatenate([curve[k][[0, -1]] for k in range(len(curve)) if not curve.closed[k]] or [np.zeros((0, 2))])
    on_border = (np.abs(ends / TURN - 0.5) >= 0.5 - 1e-9) & ~np.array([domain.closed_u, domain.closed_v])
    assert on_border.any(axis=1).all()
