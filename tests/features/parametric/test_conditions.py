"""The conditions of curves on surfaces: values at known places, slopes against differences."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.features.conditions import (
    CentralContour,
    ImplicitSection,
    Isophote,
    MeetsPlane,
    PointIsophote,
)
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.quadrics import Cone, Ellipsoid, HyperbolicParaboloid, Sphere, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus

SURFACES = {
    "torus": Torus(3.0, 1.0),
    "ellipsoid": Ellipsoid((3, 2, 1)),
    "saddle": HyperbolicParaboloid(1, 2, 2, 1),
    "cone": Cone.standing(2, 3),
    "graph": graph(lambda x, y: np.sin(x) * np.cos(2 * y), Domain(-1, 1, 0, 2)),
    "function": surface_of_function(lambda u, v: (u * np.cos(v), u * np.sin(v), v), Domain(0.5, 2, 0, 6)),
}
EYE = (8.0, -3.0, 6.0)
LIGHT = (2.0, 1.0, 3.0)
CONDITIONS = {
    "central contour": lambda s: CentralContour(s, EYE),
    "parallel contour": lambda s: Isophote(s, EYE),
    "isophote": lambda s: Isophote(s, LIGHT, 0.3),
    "point isophote": lambda s: PointIsophote(s, LIGHT, 0.3),
    "implicit section": lambda s: ImplicitSection(s, ImplicitTorus(2.0, 1.0)),
    "plane section": lambda s: ImplicitSection(s, MeetsPlane(LIGHT, 0.3)),
}
every_condition = pytest.mark.parametrize("condition", CONDITIONS.values(), ids=CONDITIONS.keys())
every_surface = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES.keys())


def inner_parameters(domain):
    u = domain.u_start + domain.size[0] * (np.arange(7) + 0.437) / 7
    v = domain.v_start + domain.size[1] * (np.arange(8) + 0.391) / 8
    return np.meshgrid(u, v, indexing="ij")


def differences(f, h):
    p = [f(k * h) for k in (-2, -1, 1, 2)]
    return (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h)


@every_surface
@every_condition
def test_slopes_are_the_derivatives_of_the_values(surface, condition):
    f, (u, v) = condition(surface), inner_parameters(surface.domain)
    by_u, by_v = f.slopes(u, v)
    scale = max(1.0, np.abs(by_u).max(), np.abs(by_v).max())
    a, b = (1e-4 * size for size in surface.domain.size)
    assert np.abs(by_u - differences(lambda h: f.values(u + h, v), a)).max() < 1e-7 * scale
    assert np.abs(by_v - differences(lambda h: f.values(u, v + h), b)).max() < 1e-7 * scale


@every_condition
def test_values_and_slopes_have_the_shape_of_the_parameters(condition):
    for shape in ((), (0,), (3,), (2, 3)):
        u, v = np.full(shape, 0.4), np.full(shape, 1.1)
        f = condition(SURFACES["torus"])
        assert f.values(u, v).shape == shape
        assert all(slope.shape == shape for slope in f.slopes(u, v))


def test_values_on_a_sphere_in_closed_form():
    sphere, eye, light = Sphere(2.0), np.array(EYE), np.array(LIGHT) / np.sqrt(14.0)
    u, v = inner_parameters(sphere.domain)
    n = sphere.points(u, v) / 2.0
    assert np.abs(CentralContour(sphere, EYE).values(u, v) - (2.0 - n @ eye)).max() < 1e-13
    assert np.abs(Isophote(sphere, 3.0 * eye).values(u, v) - n @ eye / np.linalg.norm(eye)).max() < 1e-14
    assert np.abs(Isophote(sphere, LIGHT, 0.25).values(u, v) - (n @ light - 0.25)).max() < 1e-14
    far = np.linalg.norm(eye - 2.0 * n, axis=-1)
    assert np.abs(PointIsophote(sphere, EYE, -0.5).values(u, v) - ((n @ eye - 2.0) / far + 0.5)).max() < 1e-14
    assert np.abs(ImplicitSection(sphere, MeetsPlane(LIGHT, 0.5)).values(u, v) - (2.0 * n @ light - 0.5)).max() < 1e-14
    assert np.abs(ImplicitSection(sphere, implicit_sphere(1.0)).values(u, v)).min() > 0.1


@pytest.mark.slow
@given(st.floats(0.0, 6.2), st.sampled_from([-1.0, 1.0]))
def test_at_the_poles_of_a_sphere_slopes_are_the_limits(u, end):
    # There N = (cos v cos u, cos v sin u, sin v) does not turn with u, and with v by -sin v (cos u, sin u, 0).
    at = np.array(u), np.array(end * np.pi / 2)
    by_u, by_v = Isophote(Sphere(2.0), (3.0, 0.0, 4.0)).slopes(*at)
    assert abs(by_u) < 2e-5 and abs(by_v + 0.6 * end * np.cos(u)) < 2e-5
    for condition in (CentralContour(Sphere(2.0), EYE), PointIsophote(Sphere(2.0), EYE, 0.1)):
        assert np.isfinite([condition.values(*at), *condition.slopes(*at)]).all()


def test_at_the_apex_of_a_cone_the_normal_turns_with_the_ruling():
    cone, u = Cone.standing(2.0, 3.0), np.linspace(0.1, 6.0, 9)
    height = cone.domain.v_end
    by_u, by_v = Isophote(cone, (1.0, 0.0, 0.0)).slopes(u, np.full(9, height))
    near = Isophote(cone, (1.0, 0.0, 0.0)).slopes(u, np.full(9, 0.5 * height))
    assert np.abs(by_u - near[0]).max() < 1e-5 and np.abs(by_v).max() < 1e-8


@pytest.mark.parametrize("scale", [1e-60, 1e-6, 1e6, 1e60])
def test_slopes_of_scaled_surfaces_scale_with_them(scale):
    u, v = inner_parameters(Torus(3.0, 1.0).domain)
    plain = CentralContour(Torus(3.0, 1.0), EYE).slopes(u, v)
    scaled = CentralContour(Torus(3.0 * scale, scale), scale * np.array(EYE)).slopes(u, v)
    assert all(np.allclose(b / scale, a, rtol=1e-12, atol=1e-13) for a, b in zip(plain, scaled, strict=True))


def test_bad_conditions_are_refused():
    torus = Torus(3.0, 1.0)
    for bad in (
        lambda: CentralContour(torus, (1, 2, np.nan)),
        lambda: Isophote(torus, (0, 0, 0)),
        lambda: Isophote(torus, LIGHT, 1.5),
        lambda: PointIsophote(torus, LIGHT, np.nan),
        lambda: ImplicitSection(torus, MeetsPlane(LIGHT, np.inf)),
    ):
        with pytest.raises(InputError):
            bad()
