"""Cuspidal edges."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.surface_singularities import singular_lines
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.surfaces.trimmed import CutSurface

TURN = 2.0 * np.pi
SQUARE = Domain(-1, 1, -1, 1)
SLAB = ((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))


@pytest.mark.slow
@pytest.mark.hard(49)
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("end", [1.0, 1.3])
def test_edge_of_the_tangents_of_a_helix_is_the_helix(scale, end):
    def points(u, v):
        return scale * (np.cos(v) - u * np.sin(v)), scale * (np.sin(v) + u * np.cos(v)), scale * (v + u)

    curves = singular_lines(surface_of_function(points, Domain(-1, end, 0, 6)))
    assert len(curves) == 1 and not curves.closed.any() and not curves.doubts
    x, y, z = curves.points.T / scale
    assert np.abs(np.stack([x - np.cos(z), y - np.sin(z)])).max() < 1e-9
    assert sorted(curves.v[[0, -1]]) == [0.0, 6.0]


@pytest.mark.slow
@pytest.mark.hard(49)
@pytest.mark.parametrize("domain", [SQUARE, Domain(-1, 1.3, -0.8, 1.1)])
def test_edge_of_the_swallowtail_has_its_cusp(domain):
    tail = surface_of_function(lambda u, v: (3 * v**4 + u * v * v, 4 * v**3 + 2 * u * v, u), domain)
    curves = singular_lines(tail)
    assert len(curves) == 1 and np.abs(curves.u + 6 * curves.v**2).max() < 1e-9
    # In space the edge is (-3 v^4, -8 v^3, -6 v^2), with a cusp at v = 0 which is a point of the polyline.
    assert np.linalg.norm(curves.points, axis=1).min() < 1e-12
    assert np.abs(curves.points[:, 2].min() + 1.0) < 1e-9


@pytest.mark.slow
@pytest.mark.hard(49)
def test_edges_of_cut_surfaces_end_in_the_planes():
    tail = surface_of_function(lambda u, v: (3 * v**4 + u * v * v, 4 * v**3 + 2 * u * v, u), SQUARE)
    # Along the edge x = -3 v^4, y = -8 v^3, z = -6 v^2: what is left is -0.4 < v < 0.2, but for z between.
    cut = CutSurface(tail, (HalfSpaces(((0.0, -1.0, 0.0),), (8.0 * 0.2**3,)), HalfSpaces(SLAB, (-0.06, 0.0054))))
    cut = CutSurface(cut, (HalfSpaces(((0.0, 1.0, 0.0),), (8.0 * 0.4**3,)),))
    curves = singular_lines(cut)
    ends = np.sort(curves.v[np.concatenate([curves.offsets[:-1], curves.offsets[1:] - 1])])
    assert ends == pytest.approx([-0.4, -0.1, -0.03, 0.03, 0.1, 0.2], abs=1e-9)
    assert np.abs(curves.u + 6 * curves.v**2).max() < 1e-9


def test_a_cut_surface_of_which_no_point_is_left_on_its_singular_lines():
    """The double lines of a Roman surface, in which its borders lie, are cut away in part."""

    def roman(u, v):
        return np.sin(2 * u) * np.cos(v) ** 2, np.sin(u) * np.sin(2 * v), np.cos(u) * np.sin(2 * v)

    surface = surface_of_function(roman, Domain(0.0, np.pi, -0.5 * np.pi, 0.5 * np.pi))
    region = HalfSpaces(((np.sqrt(0.5), 0.0, np.sqrt(0.5)), (0.0, 1.0, 0.0)), (0.449 * np.sqrt(0.5), -0.238))
    curves = singular_lines(CutSurface(surface, (region,)))
    assert not region.is_inside(curves.points).any() and (np.diff(curves.offsets) > 0).all()


@pytest.mark.slow
@pytest.mark.hard(49)
def test_cusps_of_a_profile_that_is_turned_give_closed_edges():
    def points(u, v):
        radius = 3 + np.cos(u) ** 3
        return radius * np.cos(v), radius * np.sin(v), np.sin(u) ** 3

    domain = Domain(0, TURN, 0, TURN, closed_u=True, closed_v=True)
    curves = singular_lines(surface_of_function(points, domain))
    assert len(curves) == 4 and curves.closed.all()
    assert np.abs(np.sin(2 * curves.u)).max() < 1e-9


def test_lines_that_are_points_are_isolated():
    curves = singular_lines(Torus(1.0, 2.0))
    tips = Torus(1.0, 2.0).points(*curves.isolated.T)
    assert len(curves) == 0 and np.abs(np.abs(tips) - (0, 0, np.sqrt(3))).max() < 1e-9 and len(tips) == 2


@pytest.mark.parametrize(
    "surface",
    [
        Sphere(1.0),
        Torus(2.0, 1.0),
        Cylinder(),
        surface_of_function(lambda u, v: (u * v, u, v * v), SQUARE),
        surface_of_function(
            lambda u, v: ((2 + v * np.cos(u / 2)) * np.cos(u), (2 + v * np.cos(u / 2)) * np.sin(u), v * np.sin(u / 2)),
            Domain(0, TURN, -0.5, 0.5),
        ),
        surface_of_function(lambda u, v: (u, v, np.nan * u), SQUARE),
    ],
)
def test_smooth_surfaces_pinch_points_and_one_sided_ones_have_none(surface):
    curves = singular_lines(surface)
    assert len(curves) == 0 and not len(curves.isolated) and not curves.doubts


@pytest.mark.parametrize("tracing", [Tracing(columns=1), Tracing(rows=1), Tracing(columns=2), Tracing(resolution=0.0)])
def test_a_grid_that_is_too_coarse_is_refused(tracing):
    with pytest.raises(InputError, match="expected"):
        singular_lines(Torus(), tracing=tracing)


def astroidal(order):
    return lambda u, v: (np.cos(u) ** 3 * np.cos(v) ** order, np.sin(u) ** 3 * np.cos(v) ** order, np.sin(v) ** order)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("start", [-0.5 * np.pi, -1.0])
@pytest.mark.parametrize("end", [0.5 * np.pi, 1.1])
@pytest.mark.parametrize("order", [1, 3])
def test_all_edges_that_run_into_poles_are_there(order, start, end):
    """Arcs of circles, or of astroids with one round the equator, where they meet at right angles."""
    surface = surface_of_function(astroidal(order), Domain(0.0, 2.0 * np.pi, start, end, closed_u=True))
    curves = singular_lines(surface)
    length = sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves)))
    if order == 1:
        truth = 4.0 * (end - start)
    else:
        truth = 6.0 + 6.0 * (np.sin(start) ** 2 + np.sin(end) ** 2)
    assert length == pytest.approx(truth, abs=0.01)
    x, y, z = np.abs(curves.points.T)
    assert np.minimum(np.minimum(x, y), z if order == 3 else np.inf).max() < 1e-9
