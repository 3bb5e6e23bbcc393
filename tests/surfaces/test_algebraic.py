"""The equations of parametrised surfaces, and surfaces of equations."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.surfaces import (
    Domain,
    Ellipsoid,
    HyperbolicParaboloid,
    Torus,
    dupin_cyclide,
    implicit_of_function,
    implicitized,
    surface_of_function,
)

TURN = 2 * np.pi
FAMILIES = {
    "plane": (surface_of_function(lambda u, v: (u, v, 1 + u - 2 * v), Domain(0, 2, -1, 1)), 1),
    "ellipsoid": (Ellipsoid((3.0, 2.0, 1.0)), 2),
    "saddle": (HyperbolicParaboloid(1.0, 2.0, 1.5), 2),
    "torus": (Torus(3.0, 1.0), 4),
    "cyclide": (dupin_cyclide(3.0, 1.0, (0.5, 0.0, 4.0), 3.0), 4),
    "umbrella": (surface_of_function(lambda u, v: (u * v, u, v * v), Domain(-1, 1, -1, 1)), 3),
    "monkey saddle": (surface_of_function(lambda u, v: (u, v, u**3 - 3 * u * v * v), Domain(-1, 1, -1, 1)), 3),
}


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.parametrize("shift", [0.0, 1e3])
def test_points_of_a_surface_fulfil_its_equation(name, shift):
    surface, degree = FAMILIES[name]
    moved = surface.transformed(np.array([[0.6, 0.8, 0, shift], [-0.8, 0.6, 0, -shift], [0, 0, 1, 1], [0, 0, 0, 1]]))
    equation = implicitized(moved)
    assert equation.degree == degree
    random = np.random.default_rng(1)
    (u, v), domain = random.uniform(0, 1, (2, 400)), moved.domain
    points = moved.points(domain.u_start + u * domain.size[0], domain.v_start + v * domain.size[1])
    assert np.abs(equation.values(points)).max() < (1e-9 if shift == 0.0 else 1e-8)
    # What is off the surface does not.
    by_u, by_v = moved.partials(domain.u_start + u * domain.size[0], domain.v_start + v * domain.size[1])
    normals = np.cross(by_u, by_v)
    off = points + 0.01 * normals / np.linalg.norm(normals, axis=1)[:, None]
    assert np.median(np.abs(equation.values(off))) > 1e-4


def test_derivatives_of_the_equation_are_those_of_its_values():
    equation = implicitized(FAMILIES["cyclide"][0])
    same = implicit_of_function(lambda x, y, z: equation.values(np.stack([x, y, z], axis=-1)), equation.box)
    points = np.random.default_rng(2).uniform(*equation.box, (50, 3))
    assert np.allclose(equation.gradients(points), same.gradients(points), atol=1e-7)
    assert np.allclose(equation.hessians(points), same.hessians(points), atol=1e-5)


def test_the_surface_of_the_equation_is_drawn_as_the_parametrised_one():
    def length(shape):
        camera = vp.Camera((7, -9, 6), fov_deg=40)
        drawing = vp.draw(vp.Scene((vp.Item("A", shape, lines=("contour",)),)), camera, fit=False)
        paths = [paths for layer in drawing.layers for paths in layer.strokes]
        parts = [points for some in paths for points in np.split(some.points, some.offsets[1:-1])]
        return sum(np.linalg.norm(np.diff(part, axis=0), axis=1).sum() for part in parts)

    ring = Torus(3.0, 1.0)
    assert length(implicitized(ring)) == pytest.approx(length(ring), rel=1e-3)


@pytest.mark.parametrize(
    ("surface", "told"),
    [
        (surface_of_function(lambda u, v: (u, v, np.sin(u)), Domain(0, 6, 0, 1)), "no algebraic surface of degree 4"),
        (surface_of_function(lambda u, v: (u, 2 * u, 0 * v), Domain(0, 1, 0, 1)), "lie on a curve"),
        (surface_of_function(lambda u, v: (0 * u, 0 * u, 0 * v), Domain(0, 1, 0, 1)), "is a point"),
    ],
)
def test_what_has_no_equation_is_told(surface, told):
    with pytest.raises(InputError, match=told):
        implicitized(surface)
    with pytest.raises(InputError, match="degree 9"):
        implicitized(surface, most_degree=9)
