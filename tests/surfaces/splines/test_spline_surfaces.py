"""Splines as surfaces: grids, kinds for each direction, weights."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
import pytest

from vectorplot.curves import AkimaSpline, ApproximatingSpline, BSpline, CubicSpline, InterpolatingSpline, spline_curve
from vectorplot.errors import InputError
from vectorplot.surfaces import SplineSurface, nurbs_surface, spline_surface

RANDOM = np.random.default_rng(1).normal(size=(7, 6, 3))
U, V = np.meshgrid(np.arange(7.0), np.arange(6.0), indexing="ij")
THROUGH = [
    AkimaSpline(),
    AkimaSpline(closed=True),
    CubicSpline(),
    CubicSpline(closed=True),
    InterpolatingSpline(3),
    InterpolatingSpline(5, closed=True),
]
KINDS = [*THROUGH, BSpline(3), BSpline(4, closed=True), ApproximatingSpline(5, 3)]
ROOT = 0.5**0.5


def places(surface: SplineSurface, count: int = 60) -> tuple[np.ndarray, np.ndarray]:
    u, v = np.random.default_rng(2).uniform(size=(2, count))
    domain = surface.domain
    return domain.u_start + u * domain.size[0], domain.v_start + v * domain.size[1]


@pytest.mark.capability("G9.1-surface")
@pytest.mark.parametrize(("u", "v"), list(product(THROUGH[::2], THROUGH)))
def test_the_surface_runs_through_its_grid_and_along_the_curves_of_its_lines(u, v):
    surface = spline_surface(RANDOM, u, v)
    np.testing.assert_allclose(surface.points(U, V), RANDOM, atol=1e-13)
    a, b = places(surface)
    for j in (0, 3):
        np.testing.assert_allclose(surface.points(a, 0 * a + j), spline_curve(RANDOM[:, j], u).points(a), atol=1e-12)
        np.testing.assert_allclose(surface.points(0 * b + j, b), spline_curve(RANDOM[j], v).points(b), atol=1e-12)


@pytest.mark.capability("G9.1-surface")
@pytest.mark.capability("G9.2-dispatch")
@pytest.mark.parametrize(("u", "v"), list(product(KINDS[::3], KINDS)))
def test_it_does_not_matter_which_direction_is_first(u, v):
    one, other = spline_surface(RANDOM, u, v), spline_surface(RANDOM.swapaxes(0, 1), v, u)
    a, b = places(one)
    np.testing.assert_allclose(one.points(a, b), other.points(b, a), atol=1e-13)
    assert one.domain.closed_u == u.closed and one.domain.closed_v == v.closed


@pytest.mark.capability("G9.2-dispatch")
@pytest.mark.parametrize(("u", "v"), list(pairwise(KINDS)))
def test_derivatives_are_those_of_the_points(u, v):
    surface, h = spline_surface(RANDOM, u, v), 1e-5
    a, b = places(surface)
    by_u, by_v = surface.partials(a, b)
    np.testing.assert_allclose((surface.points(a + h, b) - surface.points(a - h, b)) / (2 * h), by_u, atol=1e-6)
    np.testing.assert_allclose((surface.points(a, b + h) - surface.points(a, b - h)) / (2 * h), by_v, atol=1e-6)
    found = np.stack(surface.second_partials(a, b))
    ways = [(h, 0, 0), (0, h, 0), (0, h, 1)]
    truth = [(surface.partials(a + p, b + q)[k] - surface.partials(a - p, b - q)[k]) / (2 * h) for p, q, k in ways]
    away = np.minimum(
        *(np.abs(x[:, None] - knots).min(axis=1) for x, knots in zip((a, b), surface.breaks, strict=True))
    )
    np.testing.assert_allclose(np.stack(truth)[:, away > 2 * h], found[:, away > 2 * h], atol=1e-5)


@pytest.mark.capability("G9.2-surface")
def test_a_b_spline_surface_has_the_value_of_the_source():
    grid = [[(i, j, np.sin(i) * np.cos(j)) for j in range(6)] for i in range(5)]
    surface = spline_surface(grid, BSpline(3), BSpline(4))
    np.testing.assert_allclose(surface.points(np.array(1.7), np.array(0.6)), (2.2, 1.35, 0.13465203125253), rtol=1e-12)


@pytest.mark.capability("G9.2-surface")
def test_parts_patches_and_more_knots_are_the_same_surface():
    surface = spline_surface(RANDOM, CubicSpline(), BSpline(3, closed=True))
    finer, part = surface.with_knots([1.5, 2.2, 2.2], [0.3]), surface.part((1.2, 3.3), (0.5, 4.5))
    a, b = np.linspace(1.2, 3.3, 12)[:, None], np.linspace(0.5, 4.5, 13)
    a, b = np.broadcast_arrays(a, b)
    np.testing.assert_allclose(finer.points(a, b), surface.points(a, b), atol=1e-13)
    np.testing.assert_allclose(part.points(a, b), surface.points(a, b), atol=1e-13)
    patches, weights = surface.bezier_patches()
    assert patches.shape == (6, 6, 4, 3, 3) and (weights == 1).all()
    np.testing.assert_allclose(
        patches[:, :, 0, 0], surface.points(*np.meshgrid(U[:6, 0], V[0], indexing="ij")), atol=1e-13
    )


@pytest.mark.capability("G9.2-surface")
def test_weights_make_a_torus_that_is_one():
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    w = np.array([1, ROOT] * 4 + [1])
    x = np.array([1, 1, 0, -1, -1, -1, 0, 1, 1.0])
    y = np.array([0, 1, 1, 1, 0, -1, -1, -1, 0.0])
    grid = np.stack(np.broadcast_arrays((3 + x) * x[:, None], (3 + x) * y[:, None], y), axis=-1)
    surface = nurbs_surface(grid, w[:, None] * w, orders=(3, 3), knots=(knots, knots), closed=(True, True))
    u, v = places(surface)
    found = surface.points(u, v)
    away = np.hypot(np.hypot(found[:, 0], found[:, 1]) - 3, found[:, 2])
    np.testing.assert_allclose(away, 1.0, atol=1e-14)
    normal = np.cross(*surface.partials(u, v))
    ring = found[:, :2] / np.linalg.norm(found[:, :2], axis=1, keepdims=True) * 3
    np.testing.assert_allclose(np.cross(normal, found - np.column_stack([ring, 0 * u])), 0.0, atol=1e-12)
    h = 1e-5
    uu, uv, vv = surface.second_partials(u, v)
    np.testing.assert_allclose((surface.partials(u + h, v)[0] - surface.partials(u - h, v)[0]) / (2 * h), uu, atol=1e-5)
    np.testing.assert_allclose((surface.partials(u, v + h)[0] - surface.partials(u, v - h)[0]) / (2 * h), uv, atol=1e-5)
    np.testing.assert_allclose((surface.partials(u, v + h)[1] - surface.partials(u, v - h)[1]) / (2 * h), vv, atol=1e-5)


@pytest.mark.parametrize(("size", "far"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
@pytest.mark.parametrize("kind", [AkimaSpline(), CubicSpline(closed=True), BSpline()])
def test_scale_and_place_do_not_matter(kind, size, far):
    one, other = spline_surface(RANDOM, kind), spline_surface(size * RANDOM + far, kind)
    a, b = places(one)
    slack = 1e-12 + 1e-15 * far
    np.testing.assert_allclose((other.points(a, b) - far) / size, one.points(a, b), atol=slack)
    np.testing.assert_allclose(other.partials(a, b)[0] / size, one.partials(a, b)[0], atol=10 * slack)


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (lambda: spline_surface(RANDOM[0]), "a grid of points"),
        (lambda: spline_surface([[(0, 0, 0)], [(0, 0, 0), (1, 1, 1)]]), "all its lines equally long"),
        (lambda: spline_surface(np.where(RANDOM == RANDOM[1, 0], np.nan, RANDOM)), "point 2 , 1 is not finite"),
        (lambda: spline_surface(RANDOM[:3]), "takes at least 4 points, not 3"),
        (lambda: nurbs_surface(RANDOM, np.ones((6, 7))), "6 by 7 weights for 7 by 6 points"),
        (lambda: nurbs_surface(RANDOM, -np.ones((7, 6))), "must be positive"),
        (lambda: nurbs_surface(RANDOM, orders=(3, 40)), "order 40 must be a whole number"),
        (
            lambda: nurbs_surface(RANDOM, knots=([0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4], None), closed=(True, False)),
            "closed in u, but does not end",
        ),
        (lambda: spline_surface(RANDOM).part((0, 9), (0, 1)), "is no part"),
        (lambda: spline_surface(RANDOM).with_knots(u=[0.0]), "new u lie between"),
    ],
)
def test_what_makes_no_surface_is_refused_with_its_cause(make, cause):
    with pytest.raises(InputError, match=cause):
        make()
