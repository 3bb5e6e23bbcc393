"""Implicit surfaces: closed forms, gradients, degrees, agreement with the parametrised ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.rotations import rotation_about
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.inversion import InvertedSurface, inverted
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
    implicit_cone,
    implicit_cylinder,
    implicit_ellipsoid,
    implicit_plane,
    implicit_sphere,
)
from vectorplot.surfaces.surface import hessians
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, ImplicitTorusByDistance, Torus, dupin_cyclide

BOX = np.array([(-4, -4, -4), (4, 4, 4)])
TEN = [1, 2, 3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, -1]
CENTRE = (1, 0.5, 0.2)
TURN = rotation_about((1, 2, 3), 0.7)


def wave(x, y, z):
    return np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)


IMPLICIT = {
    "quadric": Quadric(TEN, BOX),
    "plane": implicit_plane((1, 1, 1), (1, 2, 2), BOX),
    "sphere": implicit_sphere(2, (1, 2, 3)),
    "torus": ImplicitTorus(3, 1, (0, 1, 0)),
    "torus by distance": ImplicitTorusByDistance(3, 1, (0, 1, 0)),
    "cyclide": ImplicitCyclide(3, 1, CENTRE, 2),
    "cubic cyclide": ImplicitCyclide(3, 1, (4, 0, 0), 2, BOX),
    "placed": PlacedImplicit(ImplicitTorus(3, 1), 2 * TURN, (1, 1, 1)),
    "wave": implicit_of_function(wave, BOX),
    "wave by differences": implicit_of_function(
        lambda x, y, z: wave(x, y, np.hypot(z, 0 * z)), BOX + np.array([0, 0, 4.5])
    ),
    "given": implicit_of_function(lambda x, y, z: x * y - z, BOX, gradient=lambda x, y, z: (y, x, -1.0), degree=2),
}
every_surface = pytest.mark.parametrize("surface", IMPLICIT.values(), ids=IMPLICIT.keys())


def inside(surface, count=50):
    low, high = surface.box
    return low + (high - low) * np.random.default_rng(3).uniform(0.05, 0.95, size=(count, 3))


def differences(f, h):
    columns = []
    for axis in np.eye(3):
        p = [f(k * h * axis) for k in (-2, -1, 1, 2)]
        columns.append((p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h))
    return np.stack(columns, axis=-1)


@every_surface
@pytest.mark.capability("G8.3-implicit")
def test_gradients_are_the_derivatives_of_values(surface):
    p = inside(surface)
    expected = differences(lambda d: surface.values(p + d), 1e-4)
    assert np.abs(surface.gradients(p) - expected).max() < 1e-9 * max(1, np.abs(expected).max())


@every_surface
def test_hessians_are_the_derivatives_of_gradients(surface):
    p = inside(surface)
    expected = differences(lambda d: surface.gradients(p + d), 1e-4)
    assert np.abs(hessians(surface, p) - expected).max() < 1e-8 * max(1, np.abs(expected).max())


@every_surface
def test_shapes_follow_the_points(surface):
    for shape in ((), (0,), (3,), (2, 3)):
        p = np.broadcast_to(inside(surface)[0], (*shape, 3))
        assert surface.values(p).shape == shape
        assert surface.gradients(p).shape == (*shape, 3)
        assert hessians(surface, p).shape == (*shape, 3, 3)


@pytest.mark.capability("G8.3-implicit")
def test_the_ten_coefficients_in_the_order_of_the_source():
    monomials = [
        *[lambda x, y, z: x * x, lambda x, y, z: y * y, lambda x, y, z: z * z],
        *[lambda x, y, z: x * y, lambda x, y, z: y * z, lambda x, y, z: z * x],
        *[lambda x, y, z: x, lambda x, y, z: y, lambda x, y, z: z, lambda x, y, z: 1],
    ]
    p = np.array([0.3, -1.2, 2.1])
    expected = sum(c * m(*p) for c, m in zip(TEN, monomials, strict=True))
    assert np.isclose(Quadric(TEN, BOX).values(p), expected, rtol=1e-15)
    assert Quadric(TEN, BOX).degree == 2
    assert implicit_plane((1, 1, 1), (1, 2, 2), BOX).degree == 1


QUADRICS = [
    (Sphere(2, (1, 2, 3)), implicit_sphere(2, (1, 2, 3))),
    (Ellipsoid((3, 2, 1), (1, 2, 3)), implicit_ellipsoid((3, 2, 1), (1, 2, 3))),
    (Cylinder(2, -1, 3), implicit_cylinder(2, (0, 0, 9), (0, 0, -5), BOX)),
    (Cylinder(2, -1, 3, depth=1), Quadric([1 / 4, 1, 0, *[0] * 6, -1], BOX)),
    (Cone.standing(2, 3), implicit_cone(np.arctan(2 / 3), (0, 0, 3), (0, 0, 1), BOX)),
    (Hyperboloid((1, 2, 3), -2, 2), Quadric([1, 1 / 4, -1 / 9, *[0] * 6, -1], BOX)),
    (HyperboloidSheet((1, 2, 3), 5), Quadric([1, 1 / 4, -1 / 9, *[0] * 6, 1], BOX)),
    (Paraboloid(1, 2, 3), Quadric([1, 1 / 4, 0, *[0] * 5, -1, 0], BOX)),
    (HyperbolicParaboloid(1, 2), Quadric([1, -1 / 4, 0, *[0] * 5, -1, 0], BOX)),
]


@pytest.mark.capability("G8.3-implicit")
@pytest.mark.parametrize(("surface", "implicit"), QUADRICS, ids=lambda s: type(s).__name__)
def test_parametrised_quadrics_satisfy_their_equations(surface, implicit):
    u, v = np.meshgrid(*surface.domain.grid(12, 9))
    p = surface.points(u, v)
    assert np.abs(implicit.values(p)).max() < 1e-13 * max(1, np.abs(p).max() ** 2)
    product = np.cross(np.cross(*surface.partials(u, v)), implicit.gradients(p))
    assert np.abs(product).max() < 1e-12 * max(1, np.abs(p).max() ** 3)


@pytest.mark.parametrize("surface", [s for s, _ in QUADRICS[:4]] + [QUADRICS[5][0]])
def test_normals_point_outwards(surface):
    u, v = np.meshgrid(*surface.domain.grid(12, 9))
    v = v[1:-1]
    u = u[1:-1]
    middle = np.asarray(surface.centre) * [1, 1, 0]
    outwards = (surface.points(u, v) - middle) * [1, 1, 0]
    assert (np.einsum("...i,...i", np.cross(*surface.partials(u, v)), outwards) > 0).all()


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_quadrics_far_away_keep_their_digits(offset):
    middle = np.array([offset, -offset, offset])
    u, v = np.meshgrid(*Sphere(2).domain.grid(12, 9))
    assert np.abs(implicit_sphere(2, middle).values(Sphere(2, middle).points(u, v))).max() < 1e-9


@pytest.mark.capability("G8.3-torus")
def test_tv34_and_tv35_torus():
    point = Torus(3, 2).points(np.array(0.8), np.array(2.1))
    assert np.allclose(point, (2.7935794645665, 2.87637712890178, 1.72641873329775), rtol=0, atol=1e-12)
    assert ImplicitTorus(3, 2).values(np.array([1, 2, 0.5])) == -74.9375
    assert ImplicitTorus(3, 2).degree == 4


@pytest.mark.capability("G8.3-torus")
@pytest.mark.parametrize(("a", "b"), [(3, 2), (3, 1), (2, 2), (1, 2)])
def test_torus_points_satisfy_both_equations(a, b):
    u, v = np.meshgrid(*Torus(a, b, (1, 2, 3)).domain.grid(24, 24))
    p = Torus(a, b, (1, 2, 3)).points(u, v)
    assert np.abs(ImplicitTorus(a, b, (1, 2, 3)).values(p)).max() < 1e-12
    outer = a - b * np.cos(v) >= 0
    assert np.abs(ImplicitTorusByDistance(a, b, (1, 2, 3)).values(p[outer])).max() < 1e-13


@pytest.mark.capability("G8.3-torus")
def test_the_quartic_is_the_product_of_two_distances():
    p = inside(ImplicitTorus(3, 1))
    near = ImplicitTorusByDistance(3, 1).values(p)
    far = near + 4 * 3 * np.hypot(p[:, 0], p[:, 1])
    assert np.allclose(ImplicitTorus(3, 1).values(p), near * far, rtol=1e-12)


@pytest.mark.capability("G8.3-cyclide")
def test_tv36_inversion():
    expected = (1.85714285714286, 0.285714285714286, 0.571428571428571)
    assert np.allclose(inverted((4, 1, 2), (1, 0, 0), 2), expected, rtol=0, atol=1e-14)


points = st.tuples(*[st.floats(-5, 5)] * 3).map(np.array)


@pytest.mark.slow
@pytest.mark.capability("G8.3-cyclide")
@given(points, st.floats(0.1, 5))
def test_inversion_is_an_involution_and_fixes_its_sphere(p, radius):
    c = np.array([6, 0, 1])
    assert np.allclose(inverted(inverted(p, c, radius), c, radius), p, rtol=0, atol=1e-11)
    on_sphere = c + radius * (p - c) / np.linalg.norm(p - c)
    assert np.allclose(inverted(on_sphere, c, radius), on_sphere, rtol=0, atol=1e-13)


def off_a_circle(p):
    """Largest distance of points (n, 3) from the circle through three of them."""
    a, b, c = p[0], p[len(p) // 3], p[2 * len(p) // 3]
    normal = np.cross(b - a, c - a)
    system = np.stack([b - a, c - a, normal])
    centre = np.linalg.solve(system, [(b @ b - a @ a) / 2, (c @ c - a @ a) / 2, normal @ a])
    away = np.abs((p - centre) @ normal) / np.linalg.norm(normal)
    return max(away.max(), np.ptp(np.linalg.norm(p - centre, axis=1)))


@pytest.mark.capability("G8.3-cyclide")
def test_parameter_lines_of_the_cyclide_are_circles():
    surface = dupin_cyclide(3, 1, CENTRE, 2)
    t = np.linspace(0, 2 * np.pi, 31)[:-1]
    for fixed in (0.0, 1.0, 4.0):
        assert off_a_circle(surface.points(t, np.full(30, fixed))) < 1e-12
        assert off_a_circle(surface.points(np.full(30, fixed), t)) < 1e-12
    assert off_a_circle(Ellipsoid((3, 2, 1)).points(t, np.full(30, 0.0))) > 0.1


@pytest.mark.capability("G8.3-cyclide")
@pytest.mark.parametrize("centre", [CENTRE, (0, 0, 0), (3, 0, 0), (8, 1, 2), (0, 4, 0)])
def test_the_cyclide_satisfies_its_polynomial(centre):
    implicit = ImplicitCyclide(3, 1, centre, 2, BOX)
    u, v = np.meshgrid(np.arange(0.1, 6, 0.5), np.arange(0.15, 6, 0.5))
    p = dupin_cyclide(3, 1, centre, 2).points(u, v)
    assert np.abs(implicit.values(p) / np.linalg.norm(implicit.gradients(p), axis=-1)).max() < 1e-11 * np.abs(p).max()
    free = inside(implicit)
    squared = ((free - centre) ** 2).sum(-1)
    torus = ImplicitTorus(3, 1).values(inverted(free, centre, 2))
    assert np.allclose(implicit.values(free), torus * squared**2 / 16, rtol=1e-9, atol=1e-9)


def degree_along_a_line(implicit):
    """The highest difference of F along a line that does not vanish: that of order n + 1 of degree n does."""
    line = np.array([0.1, 0.2, 0.3]) + np.arange(8)[:, None] * np.array([0.37, 0.21, 0.53])
    values = implicit.values(line)
    sizes = [np.abs(np.diff(values, k)).max() for k in range(8)]
    return max(k for k in range(8) if sizes[k] > 1e-10 * np.abs(values).max())


@pytest.mark.capability("G8.3-cyclide")
@pytest.mark.parametrize(
    ("a", "b", "centre", "degree"),
    [
        (3, 1, CENTRE, 4),
        (3, 1, (3, 0, 1), 3),
        (3, 1, (4, 0, 0), 3),
        (1, 2, (0, 0, 3**0.5), 2),
        (3, 1, (4.001, 0, 0), 4),
    ],
)
def test_degree_of_the_cyclide(a, b, centre, degree):
    implicit = ImplicitCyclide(a, b, centre, 2, BOX)
    assert implicit.degree == degree
    if centre != (4.001, 0, 0):
        assert degree_along_a_line(implicit) == degree


def test_the_box_of_a_cyclide_holds_it():
    surface, implicit = dupin_cyclide(3, 1, CENTRE, 2), ImplicitCyclide(3, 1, CENTRE, 2)
    u, v = np.meshgrid(*surface.domain.grid(300, 300))
    p = surface.points(u, v)
    assert (p > implicit.box[0]).all()
    assert (p < implicit.box[1]).all()


@pytest.mark.capability("G8.3-cyclide")
def test_a_centre_on_the_torus_makes_a_hole_and_wants_bounds():
    surface = dupin_cyclide(3, 1, (2, 0, 0), 2)
    zero = np.zeros(1)
    assert np.isnan(surface.points(zero, zero)).all()
    with pytest.raises(InputError, match="infinity"):
        ImplicitCyclide(3, 1, (2, 0, 0), 2)


def test_inverting_twice_gives_the_surface_back():
    twice = InvertedSurface(dupin_cyclide(3, 1, CENTRE, 2), CENTRE, 2)
    u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(0, 6, 11))
    torus = Torus(3, 1)
    assert np.allclose(twice.points(u, v), torus.points(u, v), atol=1e-12)
    for ours, theirs in zip(twice.second_partials(u, v), torus.second_partials(u, v), strict=True):
        assert np.allclose(ours, theirs, atol=1e-10)


def test_placed_surfaces_agree_with_placed_equations():
    place = {"matrix": 2 * TURN, "shift": (1, 2, 3)}
    u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(0, 6, 11))
    p = PlacedSurface(Torus(3, 1), **place).points(u, v)
    implicit = PlacedImplicit(ImplicitTorus(3, 1), **place)
    assert np.abs(implicit.values(p)).max() < 1e-11
    assert (p > implicit.box[0]).all()
    assert (p < implicit.box[1]).all()


@pytest.mark.capability("G8.3-implicit")
def test_a_users_function_with_its_gradient_to_rounding():
    p = inside(IMPLICIT["wave"])
    x, y, z = p.T
    expected = np.stack(
        [
            np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x),
            np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y),
            np.cos(z) * np.cos(x) - np.sin(y) * np.sin(z),
        ],
        -1,
    )
    assert np.abs(IMPLICIT["wave"].gradients(p) - expected).max() < 1e-15
    by_differences = implicit_of_function(lambda x, y, z: wave(x.real, y.real, z.real), BOX)
    assert np.abs(by_differences.gradients(p) - expected).max() < 1e-11
    assert IMPLICIT["given"].degree == 2
    assert IMPLICIT["wave"].degree is None


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Quadric([1, 2, 3], BOX), "ten finite coefficients"),
        (lambda: Quadric([0] * 9 + [1], BOX), "no surface"),
        (lambda: Quadric([np.nan] * 10, BOX), "ten finite"),
        (lambda: Quadric(TEN, BOX[::-1]), "box"),
        (lambda: implicit_plane((0, 0, 0), (0, 0, 0), BOX), "direction"),
        (lambda: implicit_cone(2, (0, 0, 0), (0, 0, 1), BOX), "half angle"),
        (lambda: implicit_sphere(-1), "positive"),
        (lambda: ImplicitTorus(0, 1), "major radius"),
        (lambda: Torus(1, -1), "minor radius"),
        (lambda: ImplicitCyclide(3, 1, CENTRE, 0), "radius"),
        (lambda: PlacedSurface(Torus(), np.zeros((3, 3))), "inverted"),
        (lambda: implicit_of_function(lambda x, y, z: (x, y), BOX), "lambda must return one number"),
        (lambda: implicit_of_function(lambda x, y, z: 1j * x, BOX), "complex"),
        (lambda: implicit_of_function(lambda x, y: x, BOX), "lambda fails"),
        (lambda: implicit_of_function(wave, BOX * np.nan), "box"),
    ],
)
def test_bad_input_is_an_input_error(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_a_scalar_equation_works_with_a_hint():
    with pytest.warns(InputWarning, match="one number at a time"):
        surface = implicit_of_function(lambda x, y, z: max(x, y) - z, BOX)
    assert np.array_equal(surface.values(np.array([(1.0, 2, 3), (2, 1, 0)])), [-1, 2])
