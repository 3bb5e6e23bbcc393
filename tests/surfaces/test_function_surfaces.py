"""Graphs, regions and surfaces of functions users write."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from vectorplot.errors import InputError, InputWarning
from vectorplot.surfaces.algebraic import gaussian_curvature, mean_curvature
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import Disc, PolygonRegion, graph, graph_over_disc
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.surface import Domain, is_hole
from vectorplot.surfaces.tori import Torus

TORUS = Torus(3, 1)
DOMAIN = TORUS.domain
U, V = np.meshgrid(np.linspace(0, 2 * np.pi, 13), np.linspace(0, 2 * np.pi, 11))


def analytic(u, v):
    return (3 - np.cos(v)) * np.cos(u), (3 - np.cos(v)) * np.sin(u), np.sin(v)


def no_complex(u, v):
    return analytic(np.arctan2(np.sin(u), np.cos(u)), v.real)


def one_point(u, v):
    return (3 - math.cos(v)) * math.cos(u), (3 - math.cos(v)) * math.sin(u), math.sin(v)


def errors(surface):
    first = [np.abs(a - b).max() for a, b in zip(surface.partials(U, V), TORUS.partials(U, V), strict=True)]
    second = zip(surface.second_partials(U, V), TORUS.second_partials(U, V), strict=True)
    return max(first), max(np.abs(a - b).max() for a, b in second)


@pytest.mark.capability("G8.2-surface")
def test_a_users_torus_is_the_torus():
    surface = surface_of_function(analytic, DOMAIN)
    assert surface.function.by_complex_step
    assert np.allclose(surface.points(U, V), TORUS.points(U, V), rtol=0, atol=1e-15)
    first, second = errors(surface)
    assert first < 1e-14
    assert second < 1e-10


@pytest.mark.capability("G8.2-surface")
def test_derivatives_by_differences_are_as_good_as_stated():
    first, second = errors(surface_of_function(no_complex, DOMAIN))
    assert first < 1e-11
    assert second < 1e-7


def test_a_scalar_surface_works_with_one_hint():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        surface = surface_of_function(one_point, DOMAIN)
        first, second = errors(surface)
    assert [w.category for w in caught] == [InputWarning]
    assert "one_point" in str(caught[0].message)
    assert first < 1e-10
    assert second < 1e-6


def test_given_partials_are_used():
    by_u = lambda u, v: tuple(np.moveaxis(TORUS.partials(u, v)[0], -1, 0))  # noqa: E731
    by_v = lambda u, v: TORUS.partials(u, v)[1]  # noqa: E731
    surface = surface_of_function(no_complex, DOMAIN, partials=(by_u, by_v))
    first, second = errors(surface)
    assert first == 0
    assert second < 1e-10
    seconds = [lambda u, v, k=k: TORUS.second_partials(u, v)[k] for k in range(3)]
    assert errors(surface_of_function(no_complex, DOMAIN, partials=(by_u, by_v), second_partials=seconds)) == (0, 0)


@pytest.mark.capability("G8.2-surface")
def test_a_general_curve_on_a_surface_is_given_by_two_functions():
    """Villarceau's circle as u(t), v(t) on the torus: a circle of the major radius."""
    t = np.linspace(0, 2 * np.pi, 50)
    x = np.stack([np.sqrt(8) * np.cos(t), 1 + 3 * np.sin(t), np.cos(t)], -1)
    u = np.arctan2(x[:, 1], x[:, 0])
    v = np.arctan2(x[:, 2], 3 - np.hypot(x[:, 0], x[:, 1]))
    assert np.allclose(TORUS.points(u, v), x, atol=1e-12)


def test_bad_functions_are_input_errors_that_name_them():
    def crooked(u, v):
        return u, v

    with pytest.raises(InputError, match="function crooked must return 3 numbers"):
        surface_of_function(crooked, DOMAIN)
    with pytest.raises(InputError, match="fails at"):
        surface_of_function(lambda u: (u, u, u), DOMAIN)
    with pytest.raises(InputError, match="both partials"):
        surface_of_function(analytic, DOMAIN, partials=(analytic,))
    with pytest.raises(InputError, match="both slopes"):
        graph(np.add, DOMAIN, slopes=(np.add,))


def test_curvatures_of_a_sphere_and_a_torus():
    u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(-1.5, 1.5, 7))
    assert np.allclose(gaussian_curvature(Sphere(2), u, v), 1 / 4)
    assert np.allclose(mean_curvature(Sphere(2), u, v), -1 / 2)
    assert np.allclose(gaussian_curvature(TORUS, U, V), -np.cos(V) / (3 - np.cos(V)))
    # At the pole the first form vanishes: no curvature, and no warning.
    assert np.isfinite(mean_curvature(Sphere(2), np.zeros(1), np.full(1, 1.5707))).all()


def bowl(x, y):
    return x * x + 2 * y * y


def test_a_graph_over_a_rectangle():
    surface = graph(bowl, Domain(-1, 1, 0, 2))
    p = surface.points(np.array([0.5]), np.array([1.5]))
    assert np.array_equal(p, [(0.5, 1.5, 4.75)])
    along_u, along_v = surface.partials(np.array([0.5]), np.array([1.5]))
    assert np.allclose([*along_u, *along_v], [(1, 0, 1), (0, 1, 6)], rtol=1e-15)
    assert (np.cross(along_u, along_v)[:, 2] > 0).all()
    given = graph(bowl, Domain(-1, 1, 0, 2), slopes=(lambda x, y: 2 * x, lambda x, y: 4 * y))
    assert np.array_equal(given.partials(np.array([0.5]), np.array([1.5]))[1], [(0, 1, 6)])


def test_a_graph_over_a_region_has_a_hole_outside_it_and_is_not_asked_there():
    def dome(x, y):
        if np.any(x.real**2 + y.real**2 > 1 + 1e-9):
            raise ValueError("asked outside")
        return np.sqrt(np.maximum(1 - x * x - y * y, 0))

    surface = graph(dome, Disc(1))
    assert surface.domain == Domain(-1, 1, -1, 1)
    x, y = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    p = surface.points(x, y)
    assert np.array_equal(is_hole(p), np.hypot(x, y) > 1)
    assert np.allclose(np.linalg.norm(p[~is_hole(p)], axis=-1), 1)
    assert np.isnan(surface.partials(np.array([0.9]), np.array([0.9]))[0]).all()
    along_u, _ = surface.partials(np.array([0.5]), np.array([0.3]))
    assert np.allclose(along_u, [(1, 0, -0.5 / np.sqrt(1 - 0.34))], rtol=1e-13)


def test_a_scalar_graph_over_a_region():
    with pytest.warns(InputWarning, match="one number at a time"):
        surface = graph(lambda x, y: math.sqrt(2 - x * x - y * y), Disc(1.2))
    p = surface.points(np.array([0.5, 1.0]), np.array([0.5, 1.0]))
    assert np.allclose(p[0], (0.5, 0.5, np.sqrt(1.5)))
    assert np.isnan(p[1]).all()


def test_a_polar_graph_ends_at_its_circle():
    surface = graph_over_disc(bowl, Disc(2, (1, 0)))
    d = surface.domain
    assert (d.u_end, d.closed_u, d.closed_v) == (2, False, True)
    v = np.linspace(0, 2 * np.pi, 33)
    border = surface.points(np.full(33, 2.0), v)
    assert np.allclose(np.hypot(border[:, 0] - 1, border[:, 1]), 2)
    assert np.allclose(border[:, 2], bowl(border[:, 0], border[:, 1]))
    for derivative in surface.partials(np.full(33, 2.0), v):
        assert np.isfinite(derivative).all()
    with pytest.raises(InputError, match="hole"):
        graph_over_disc(bowl, Disc(2), hole=2)


L_SHAPE = PolygonRegion([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])


@pytest.mark.parametrize("region", [L_SHAPE, PolygonRegion(np.asarray(L_SHAPE.corners)[::-1])])
def test_inside_of_a_polygon_that_is_not_convex(region):
    x, y = np.meshgrid(np.arange(-0.5, 3, 0.25), np.arange(-0.5, 3, 0.25))
    expected = (x >= 0) & (y >= 0) & (((x <= 2) & (y <= 1)) | ((x <= 1) & (y <= 2)))
    assert np.array_equal(region.contains(x, y), expected)
    assert region.domain == Domain(0, 2, 0, 2)


def test_a_polygon_agrees_with_shapely():
    shapely = pytest.importorskip("shapely")
    random = np.random.default_rng(1)
    angles = np.sort(random.uniform(0, 2 * np.pi, 17))
    corners = random.uniform(0.2, 1, (17, 1)) * np.stack([np.cos(angles), np.sin(angles)], -1)
    x, y = random.uniform(-1, 1, (2, 4000))
    assert np.array_equal(PolygonRegion(corners).contains(x, y), shapely.intersects_xy(shapely.Polygon(corners), x, y))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Disc(0), "positive"),
        (lambda: Disc(1, (np.nan, 0)), "finite"),
        (lambda: PolygonRegion([(0, 0), (1, 1)]), "three corners"),
        (lambda: PolygonRegion([(0, 0), (1, 1), (np.inf, 0)]), "three corners"),
        (lambda: graph(lambda x, y: (x, y), DOMAIN), "lambda must return one number"),
        (lambda: graph(lambda x, y: 1j * x, DOMAIN), "complex"),
    ],
)
def test_bad_regions_and_graphs_are_input_errors(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_a_graph_drops_periods():
    closed = Domain(0.0, 2.0 * np.pi, -1.0, 1.0, closed_u=True)
    surface = graph(lambda x, y: np.cos(x) + y, closed)
    assert surface.domain == Domain(0.0, 2.0 * np.pi, -1.0, 1.0)
    # Derivatives on the border are those of the function, not across a seam.
    assert np.allclose(surface.partials(np.array([2.0 * np.pi]), np.array([0.0]))[0], (1.0, 0.0, 0.0), atol=1e-6)


@pytest.mark.parametrize("direction", ["u", "v"])
def test_a_function_that_does_not_come_back_does_not_close(direction):
    def strip(u, v):
        r = 2.0 + v * np.cos(0.5 * u)
        return r * np.cos(u), r * np.sin(u), v * np.sin(0.5 * u)

    def turned(u, v):
        return strip(v, u)

    function, size = (strip, (0.0, 2.0 * np.pi, -1.0, 1.0)) if direction == "u" else (turned, (-1, 1, 0, 2.0 * np.pi))
    surface_of_function(function, Domain(*size))
    with pytest.raises(InputError, match=f"closed in {direction}, but the surface ends up to 2 from"):
        surface_of_function(function, Domain(*size, closed_u=direction == "u", closed_v=direction == "v"))


def test_a_constant_graph_is_flat():
    surface = graph(lambda x, y: 2.0, Domain(0, 1, 0, 1))
    assert np.array_equal(surface.points(U[:2] / 7, V[:2] / 7)[..., 2], np.full((2, 13), 2.0))
    assert np.array_equal(surface.partials(np.array([0.5]), np.array([0.5]))[0], [(1, 0, 0)])


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_graph_over_a_ring_is_not_asked_in_its_hole_and_not_cut_off_for_a_pole_there(scale):
    asked = []

    def hill(x, y):
        asked.append(np.hypot(x - 3.0 * scale, y).min())
        return scale * scale / np.hypot(x - 3.0 * scale, y)

    ring = graph_over_disc(hill, Disc(2.0 * scale, (3.0 * scale, 0.0)), hole=0.1 * scale)
    turn = np.linspace(0.0, 2.0 * np.pi, 13)
    rim = ring.points(np.full(13, 0.1 * scale), turn)
    assert np.allclose(rim[:, 2], 10.0 * scale) and all(
        np.isfinite(d).all() for d in ring.partials(rim[:, 0] * 0 + 0.1 * scale, turn)
    )
    assert min(asked) > 0.0999 * scale
