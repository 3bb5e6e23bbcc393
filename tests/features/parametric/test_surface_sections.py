"""Sections of surfaces against closed forms."""

import warnings

import numpy as np
import pytest

from vectorplot.errors import InputWarning
from vectorplot.features.contours_and_isophotes import plane_sections, section_by_implicit
from vectorplot.features.curve_tracing import Tracing
from vectorplot.surfaces.quadrics import (
    Cylinder,
    HyperbolicParaboloid,
    Hyperboloid,
    Quadric,
    Sphere,
    implicit_cylinder,
    implicit_plane,
    implicit_sphere,
)
from vectorplot.surfaces.tori import ImplicitTorus, Torus

BOX = [[-9.0] * 3, [9.0] * 3]


@pytest.mark.capability("G8.4-intersection")
@pytest.mark.parametrize(("offset", "size"), [(0.0, 1.0), (1e6, 1.0), (0.0, 1e-6), (0.0, 1e6)])
def test_two_spheres_meet_in_a_circle(offset, size):
    far = np.array([offset, 0.0, 0.0])
    other = implicit_sphere(2.0 * size, (offset + size, 0.5 * size, 0.0))
    curves = section_by_implicit(Sphere(2.0 * size, far), other)
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts
    off = (curves.points - far) / size @ (1.0, 0.5, 0.0) - 0.625
    assert np.abs(off).max() < (1e-10 if offset == 0.0 else 1e-8)
    # Touching is told apart from missing at any size.
    with pytest.warns(InputWarning, match="in a single point"):
        assert len(section_by_implicit(Sphere(size, far), implicit_sphere(size, (offset + 2.0 * size, 0, 0)))) == 0


@pytest.mark.capability("G8.4-intersection")
def test_steinmetz_curve_is_two_ellipses_through_two_nodes():
    curves = section_by_implicit(Cylinder(1.0, -2.0, 2.0), implicit_cylinder(1.0, (0, 0, 0), (1, 0, 0), BOX))
    x, y, z = curves.points.T
    assert np.abs(x * x + y * y - 1).max() < 1e-12 and np.abs(y * y + z * z - 1).max() < 1e-11
    assert len(curves) == 2 and curves.closed.all() and len(curves.nodes) == 2
    nodes = Cylinder().points(*curves.nodes.T)
    assert np.abs(np.abs(nodes) - (0, 1, 0)).max() < 1e-9
    # A branch goes straight on through a node: each is a plane ellipse z = x or z = -x.
    for k in range(2):
        p = curves[k]
        assert min(np.abs(p[:, 2] - p[:, 0]).max(), np.abs(p[:, 2] + p[:, 0]).max()) < 1e-9


@pytest.mark.capability("G8.4-intersection")
def test_viviani_curve_on_the_cylinder_and_on_the_sphere():
    on_cylinder = section_by_implicit(Cylinder(1.0, -3.0, 3.0, (1, 0, 0)), implicit_sphere(2.0))
    on_sphere = section_by_implicit(Sphere(2.0), implicit_cylinder(1.0, (1, 0, 0), (0, 0, 1), BOX))
    for curves in (on_cylinder, on_sphere):
        x, y, z = curves.points.T
        assert np.abs((x - 1) ** 2 + y * y - 1).max() < 1e-10 and np.abs(x * x + y * y + z * z - 4).max() < 1e-10
        assert len(curves.nodes) == 1 and curves.closed.all()
        # The length by the closed form (1 + cos t, sin t, 2 sin(t/2)).
        t = np.linspace(0, 4 * np.pi, 20001)
        true = np.stack([1 + np.cos(t), np.sin(t), 2 * np.sin(t / 2)], axis=1)
        length = np.linalg.norm(np.diff(true, axis=0), axis=1).sum()
        found = sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves)))
        assert abs(found - length) < 0.02


@pytest.mark.capability("G8.4-intersection")
def test_hyperboloid_and_torus():
    torus, other = Torus(3.0, 1.0), ImplicitTorus(3.0, 1.0)
    # With a common axis they meet in two circles: of rho^2 = 9 + z^2 and (rho - 3)^2 + z^2 = 1.
    ring = Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -9), BOX)
    rho = (6.0 + np.sqrt(44.0)) / 4.0
    for curves in (section_by_implicit(torus, ring), section_by_implicit(Hyperboloid((3.0, 3.0, 3.0), -3, 3), other)):
        assert len(curves) == 2 and curves.closed.all() and not curves.doubts
        assert np.abs(np.hypot(*curves.points[:, :2].T) - rho).max() < 1e-10
        assert np.sort(curves.points[[curves.offsets[0], curves.offsets[1]], 2]) == pytest.approx(
            [-np.sqrt(rho**2 - 9), np.sqrt(rho**2 - 9)], abs=1e-10
        )
    # Beside each other: on both surfaces, and the same curves whichever of them is traced on.
    beside = Quadric((1, 1, -1, 0, 0, 0, -2, 0, 0, -3), BOX)  # (x - 1)^2 + y^2 - z^2 = 4
    on_torus = section_by_implicit(torus, beside)
    on_ring = section_by_implicit(Hyperboloid((2.0, 2.0, 2.0), -3, 3, (1, 0, 0)), other)
    lengths = []
    for curves in (on_torus, on_ring):
        assert len(curves) == len(on_torus) > 0 and curves.closed.all()
        assert np.abs(beside.values(curves.points)).max() < 1e-9 and np.abs(other.values(curves.points)).max() < 1e-8
        lengths.append(sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves))))
    assert lengths[0] == pytest.approx(lengths[1], rel=2e-3)


@pytest.mark.capability("G8.4-intersection")
def test_torus_and_plane_and_torus_and_torus():
    torus = Torus(3.0, 1.0)
    villarceau = plane_sections(torus, (0.0, -1.0, np.sqrt(8.0)), [0.0])
    assert len(villarceau.nodes) == 2 and villarceau.closed.all()
    # Two circles of radius 3 about (1, 0, 0) and (-1, 0, 0).
    p = villarceau.points
    off = [np.abs(np.linalg.norm(p - (s, 0, 0), axis=1) - 3.0) for s in (1, -1)]
    assert np.minimum(*off).max() < 1e-9
    other = ImplicitTorus(3.0, 1.0, (2.0, 0.5, 0.3))
    curves = section_by_implicit(torus, other)
    assert len(curves) and np.abs(other.values(curves.points)).max() < 1e-10 * 200
    assert curves.closed.all()


@pytest.mark.hard(43)
@pytest.mark.parametrize(
    ("point", "normal"),
    [((0, 0, 2), (0, 0, 1)), ((0, 0, -2), (0, 0, 1)), ((2, 0, 0), (1, 0, 0)), ((0, 2, 0), (0, -1, 0))],
)
def test_sphere_touching_a_plane_gives_a_point_and_a_warning(point, normal):
    sphere = Sphere(2.0)
    with pytest.warns(InputWarning, match="single point"):
        curves = section_by_implicit(sphere, implicit_plane(point, normal, BOX))
    assert len(curves) == 0 and len(curves.isolated) == 1 and not len(curves.touching)
    assert np.linalg.norm(sphere.points(*curves.isolated.T)[0] - point) < 1e-7


def test_a_plane_that_misses_gives_nothing_and_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        curves = section_by_implicit(Sphere(2.0), implicit_plane((0, 0, 3), (0, 0, 1), BOX))
    assert len(curves) == 0 and curves.points.shape == (0, 3) and not curves.doubts


def test_a_plane_through_the_poles_cuts_a_sphere_in_one_circle():
    curves = plane_sections(Sphere(2.0), (3.0, 1.0, 0.0), [0.0])
    assert len(curves) == 1 and curves.closed.all() and not len(curves.nodes)
    assert abs(np.linalg.norm(np.diff(curves[0], axis=0), axis=1).sum() - 4 * np.pi) < 0.02


def test_a_plane_through_one_pole_cuts_a_sphere_in_one_circle():
    n = np.array([1.0, 0.5, 1.0]) / 1.5
    curves = plane_sections(Sphere(1.0), n, [n[2]])
    assert len(curves) == 1 and curves.closed.all()
    assert np.abs(curves.points @ n - n[2]).max() < 1e-10
    length = np.linalg.norm(np.diff(curves[0], axis=0), axis=1).sum()
    assert abs(length - 2 * np.pi * np.sqrt(1 - n[2] ** 2)) < 0.01


def test_level_lines_of_the_saddle_are_hyperbolas_and_at_zero_two_lines():
    saddle = HyperbolicParaboloid(1.0, 1.0, 1.0, 1.0)
    heights = [-0.25, 0.0, 0.25]
    curves = plane_sections(saddle, (0, 0, 1), heights, tracing=Tracing(tolerance=1e-4))
    level = np.repeat(curves.levels, np.diff(curves.offsets))
    assert np.abs(curves.points[:, 2] - level).max() < 1e-11
    assert [int((curves.levels == h).sum()) for h in heights] == [2, 2, 2]
    assert len(curves.nodes) == 1 and np.abs(curves.nodes).max() < 1e-9


def test_coinciding_surfaces_say_so():
    curves = section_by_implicit(Sphere(2.0), implicit_sphere(2.0))
    assert len(curves) == 0 and len(curves.doubts) == 1


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_plane_that_touches_a_torus_inside_cuts_it_in_a_figure_eight(turn):
    normal = np.array([np.cos(turn), 0.0, np.sin(turn)])
    touched = np.array([2.0 - np.cos(turn), 0.0, -np.sin(turn)])
    curves = plane_sections(Torus(2.0, 1.0), normal, [normal @ touched])
    assert len(curves.nodes) == 1 and len(curves.isolated) == 0 and not curves.doubts
    found = np.concatenate([curves[k] for k in range(len(curves))])
    assert np.abs(found @ normal - normal @ touched).max() < 1e-11
    if turn == 0.0:
        # Bernoulli's lemniscate with foci at +-2.
        square = (found[:, 1:] ** 2).sum(axis=1)
        assert np.abs(square**2 - 8 * (found[:, 1] ** 2 - found[:, 2] ** 2)).max() < 1e-9
