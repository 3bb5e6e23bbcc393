"""Whatever stands in the world is moved, turned and scaled by the same words."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle, CubicSpline, Helix, Line, Loxodrome, curve_of_function, spline_curve
from vectorplot.errors import InputError
from vectorplot.geometry import box, rotation_about
from vectorplot.scene import FieldLines, GeodesicLines
from vectorplot.surfaces import (
    Cone,
    Domain,
    Frustum,
    HyperbolicParaboloid,
    ImplicitTorus,
    Sphere,
    Torus,
    dupin_cyclide,
    graph,
    implicit_of_function,
    implicit_sphere,
    landscape,
    surface_of_function,
)
from vectorplot.surfaces.swept import tube

SURFACES = [
    Sphere(1.0),
    Torus(3, 1),
    Cone(1.0),
    Frustum(1.0, 0.5, 1.0),
    HyperbolicParaboloid(),
    dupin_cyclide(3, 1, (1, 0, 0), 2.0),
    graph(lambda x, y: x * y, Domain(0, 1, 0, 1)),
    landscape([[0, 1, 2], [1, 3, 1], [0, 1, 0]], x=(0, 2), y=(0, 2)),
    surface_of_function(lambda u, v: (u, v, u - v), Domain(0, 1, 0, 1)),
    tube(Circle(), 0.1),
]
IMPLICIT = [
    implicit_sphere(1.0),
    ImplicitTorus(3, 1),
    implicit_of_function(lambda x, y, z: x + y**2 + z, [(-1,) * 3, (1,) * 3]),
]
CURVES = [
    Circle(),
    Helix(1.0, 0.5),
    Line((0, 0, 0), (1, 2, 3)),
    Loxodrome(1.0, 1.4),
    spline_curve([(0, 0, 0), (1, 1, 0), (2, 0, 1)], CubicSpline()),
    curve_of_function(lambda t: (t, t * t, 1.0), 0.0, 1.0),
]
named = {"ids": lambda shape: type(shape).__name__}


def wanted(points):
    """Doubled, turned about z, and moved."""
    return 2.0 * points @ rotation_about((0, 0, 1), np.radians(30.0)) + (1.0, 2.0, 3.0)


def placed(thing):
    return thing.scaled(2.0).turned("z", 30.0).moved(1.0, 2.0, 3.0)


@pytest.mark.parametrize("surface", SURFACES, **named)
def test_surfaces_move(surface):
    u, v = (axis.ravel() for axis in np.meshgrid(*surface.domain.grid(3, 3)))
    found = placed(surface)
    assert np.allclose(found.points(u, v), wanted(surface.points(u, v)), equal_nan=True)
    assert found.surface is surface, "a single placement"


@pytest.mark.parametrize("surface", IMPLICIT, **named)
def test_implicit_surfaces_move(surface):
    points = np.random.default_rng(1).uniform(-1, 1, (20, 3))
    found = placed(surface)
    assert np.allclose(found.values(wanted(points)), surface.values(points))
    assert found.surface is surface


@pytest.mark.parametrize("curve", CURVES, **named)
def test_curves_move(curve):
    t = np.linspace(curve.start, curve.end, 7)
    found = placed(curve)
    assert np.allclose(found.points(t), wanted(curve.points(t)))
    assert found.curve is curve


def test_meshes_items_and_scenes_move():
    cube = box((1, 1, 1))
    vertices = wanted(cube.vertices)
    assert np.allclose(placed(cube).vertices, vertices)
    item = vp.Item("cube", cube, "red", lines=("contour",))
    assert np.allclose(placed(item).mesh.vertices, vertices) and placed(item).colour == "red"
    scene = vp.Scene((item, vp.Item("ball", Sphere(1.0))), camera=vp.Camera((3, 3, 3)))
    assert np.allclose(placed(scene).items[0].mesh.vertices, vertices) and placed(scene).camera is scene.camera


def test_shapes_of_users_move_with_their_items():
    class Plane:
        domain = Domain(0, 1, 0, 1)

        def points(self, u, v):
            return np.stack([u, v, 0.0 * u], axis=-1)

    moved = vp.Item("plane", Plane()).moved(z=4.0).shape
    assert moved.points(np.array(1.0), np.array(0.5)).tolist() == [1.0, 0.5, 4.0]


def test_lines_on_an_item_move_with_it():
    lines = vp.SurfaceLines(
        sections=(vp.Section((1, 2, 2), (0.25, 0.5), slices=True),),
        integral=(GeodesicLines(((0.0, 0.0, 1.0),), length=2.0), FieldLines(None, apart=0.5)),
    )
    item = vp.Item("ball", Sphere(1.0), curves=lines)
    found = placed(item).curves
    (section,) = found.sections
    inside = np.array([(0.75, 0.0, 0.0), (0.25, 0.25, 0.0), (0.0, 0.0, 0.375)])
    assert np.allclose(wanted(inside) @ section.normal, section.offsets[0]) and section.slices
    assert (found.integral[0].length, found.integral[1].apart) == pytest.approx((4.0, 1.0))
    stretched = vp.Section((1, 1, 0), (1.0,)).transformed(np.diag([2.0, 1.0, 1.0, 1.0]))
    assert np.allclose(np.array([(2 * 2**0.5, 0, 0), (0, 2**0.5, 0)]) @ stretched.normal, stretched.offsets[0])


def test_patterns_grow_with_their_item():
    pattern = vp.Pattern("window", "blue", 0, np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)]))
    item = vp.Item("cube", box((1, 1, 1)), patterns=(pattern,))
    assert item.moved(1, 2, 3).patterns == (pattern,)
    assert item.scaled(3.0).patterns[0].points[1, 0] == pytest.approx(1.5)


def test_quarter_turns_are_exact_and_mirrors_keep_the_outside_outside():
    assert Sphere(1.0).turned("x", 90).matrix.tolist() == [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    mirrored = box((1, 1, 1)).scaled(-1.0, 1.0, 1.0)
    assert (
        np.einsum("ij,ij->i", mirrored.area_vectors, mirrored.vertices[mirrored.corners[::4]] - (-0.5, 0.5, 0.5)) > 0
    ).all()


@pytest.mark.parametrize("way", [lambda m: m.scaled(0.0), lambda m: m.scaled(1, 2), lambda m: m.turned("w", 3)])
def test_what_is_no_motion_is_refused(way):
    with pytest.raises(vp.InputError):
        way(box((1, 1, 1)))


def test_a_vector_in_place_of_three_numbers_and_ways_without_end_are_told():
    cube = box((1, 1, 1))
    with pytest.raises(TypeError, match=r"moved\(\*vector\)"):
        cube.moved((1, 2, 3))
    with pytest.raises(TypeError, match=r"scaled\(\*vector\)"):
        cube.scaled((1, 2, 3))
    with pytest.raises(InputError, match="moved: expected finite numbers"):
        cube.moved(np.inf)
    with pytest.raises(InputError, match="turned: an angle of nan"):
        cube.turned("z", np.nan)
