import numpy as np
import pytest

from vectorplot.curves.placed_curves import curve_of_function
from vectorplot.errors import InputError
from vectorplot.geometry.rotations import rotation_about
from vectorplot.scene.extent import bounds_of_surfaces, smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Ellipsoid, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus, dupin_cyclide
from vectorplot.testing.shapes import box

SHIFT = np.array([3e6, -2.0, 1.0])


def off(found, low, high):
    """How far bounds are off, as a part of the extent."""
    true = np.array([low, high], dtype=float)
    return np.abs(found - true).max() / np.ptp(true, axis=0).max()


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_torus_reaches_as_far_as_its_radii_say(size):
    reach = np.array([4.0, 4.0, 1.0]) * size
    assert off(smooth_bounds(Torus(3.0 * size, size)), -reach, reach) < 1e-9


@pytest.mark.parametrize("angle", [0.3, 1.1, 2.5])
def test_a_turned_ellipsoid_far_away_has_the_extent_of_its_quadratic_form(angle):
    turn = rotation_about((1.0, 2.0, -0.5), angle)
    matrix = np.asarray(turn)
    axes = np.array([3.0, 2.0, 0.5])
    reach = np.sqrt(((axes[:, None] * matrix) ** 2).sum(axis=0))
    found = smooth_bounds(PlacedSurface(Ellipsoid(axes), matrix, SHIFT))
    assert off(found, SHIFT - reach, SHIFT + reach) < 1e-6


def test_a_wavy_graph_is_within_a_thousandth():
    waves = graph(lambda x, y: np.sin(7.3 * x) * np.cos(6.1 * y), Domain(-3.0, 3.0, -2.0, 2.0))
    assert off(smooth_bounds(waves), (-3, -2, -1), (3, 2, 1)) < 1e-3


def test_the_apex_and_the_border_of_a_cone_bound_it():
    assert off(smooth_bounds(Cone.standing(2.0, 3.0)), (-2, -2, 0), (2, 2, 3)) < 1e-9


@pytest.mark.hard(69)
def test_holes_do_not_count():
    half = graph(lambda x, y: np.sqrt(x), Domain(-4.0, 4.0, 0.0, 1.0))
    found = smooth_bounds(half)
    assert off(found, (0, 0, 0), (4, 1, 2)) < 1e-3
    with pytest.raises(InputError, match=r"^VOID: the surface has no finite point"):
        _ = Scene((Item("VOID", graph(lambda x, y: np.sqrt(-1.0 - x * x), Domain(0.0, 1.0, 0.0, 1.0))),)).bounds


def test_a_pole_is_cut_off_and_infinity_on_the_grid_is_an_error():
    chimney = surface_of_function(lambda u, v: (u, v, 1.0 / (u - 0.0101)), Domain(-1.0, 1.0, -1.0, 1.0))
    # Its quartiles are -2 and 2: inner fences lie one and a half times their distance beyond them.
    assert smooth_bounds(chimney)[:, 2] == pytest.approx((-8.0, 8.0), rel=0.025)
    with pytest.raises(InputError, match="infinity"):
        smooth_bounds(dupin_cyclide(3.0, 1.0, (3.0, 0.0, 1.0), 1.0))


def test_what_is_no_surface_is_said_so():
    with pytest.raises(InputError, match="a str is no mesh, no surface and no curve"):
        smooth_bounds("torus")


def test_bounds_of_a_scene_are_those_of_all_its_items():
    items = (
        Item("A", box((0, 0, 0), (1, 1, 1))),
        Item("B", Torus()),
        Item("C", ImplicitTorus(3.0, 1.0, (9.0, 0.0, 0.0))),
    )
    found = Scene(items).bounds
    assert np.allclose(found, [[-4.0, -4.1, -1.1], [13.1, 4.1, 1.1]], atol=1e-9)
    assert len(Scene(items).vertices) == 8
    assert items[1].mesh.face_count == 0 and items[0].mesh is items[0].shape


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_curve_that_runs_off_to_infinity_is_refused_one_with_a_hole_is_not(size):
    hyperbola = curve_of_function(lambda t: (t, size / t**5, 0 * t), -1.0, 1.0005)
    with pytest.raises(InputError, match="the curve runs off to infinity"):
        smooth_bounds(hyperbola)
    holed = curve_of_function(lambda t: (t * size, np.sqrt(t * t - 0.25) * size, 0 * t), -1.0, 1.0)
    assert np.allclose(
        smooth_bounds(holed), np.array([(-1, 0, 0), (1, np.sqrt(0.75), 0)]) * size, rtol=0, atol=0.05 * size
    )
    with pytest.raises(InputError, match="the curve has no finite point"):
        smooth_bounds(curve_of_function(lambda t: (t, np.log(-1 - t * t), t), -1.0, 1.0))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_an_implicit_surface_whose_place_has_no_digits_for_it_is_refused(axis, scale):
    far = np.zeros(3)
    far[axis] = 1e17 * scale
    ball = implicit_sphere(scale)
    assert np.ptp(smooth_bounds(ball), axis=0).min() > 0.0
    with pytest.raises(InputError, match="no digits left"):
        smooth_bounds(PlacedImplicit(ball, np.eye(3), far))


def test_bounds_found_together_are_those_found_alone():
    square, half = Domain(-1.0, 1.0, -1.0, 1.0), Domain(0.0, 1.0, -1.0, 1.0)
    shapes = [Torus(3.0, 1.0), Torus(1.0, 0.2), Cone.standing(2.0, 3.0), Ellipsoid((1.0, 2.0, 3.0))]
    shapes += [surface_of_function(lambda u, v: (u, v, np.sqrt(1.2 - u * u - v * v)), d) for d in (square, half)]
    placed = [PlacedSurface(shape, rotation_about((1.0, 2.0, 3.0), 0.4), (k, 0, 0)) for k, shape in enumerate(shapes)]
    both = [*shapes, *placed]
    together, alone = bounds_of_surfaces(both), np.concatenate([bounds_of_surfaces([shape]) for shape in both])
    assert np.allclose(together, alone, rtol=0.0, atol=1e-12)


def test_of_many_surfaces_the_one_that_runs_off_is_named():
    off = dupin_cyclide(3.0, 1.0, (3.0, 0.0, 1.0), 1.0)
    items = [Item(f"torus {k}", Torus()) for k in range(3)]
    with pytest.raises(InputError, match=r"^spike: .*infinity"):
        _ = Scene((*items, Item("spike", off))).bounds
