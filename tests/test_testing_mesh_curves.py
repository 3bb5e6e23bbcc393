"""The assertions on curves of meshes hold for true curves, fail for curves that are a little wrong, and say where."""

import numpy as np
import pytest

from vectorplot import features
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import mesh_geodesics, mesh_integral_curves
from vectorplot.surfaces.quadrics import implicit_sphere
from vectorplot.testing import assert_geodesic, assert_integral_curve
from vectorplot.testing.shapes import box

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
BALL = features.polygonized(implicit_sphere(1.0), 10)
STARTS = np.arange(0, BALL.face_count, 23)
FIELDS = {
    "slope": features.SteepestSlope(),
    "helix": features.ConstantElevation(0.3),
    "own": features.VectorField(lambda points: np.cross((0.0, 0.3, 1.0), points)),
}


def lines(curves):
    return [curves[k] for k in range(len(curves))]


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize("name", FIELDS)
def test_curves_of_a_field_pass_and_those_of_another_do_not(name):
    own = lines(mesh_integral_curves(BALL, FIELDS[name], STARTS[::3], length=1.5))
    assert_integral_curve(own, BALL, FIELDS[name], 1e-7)
    turned = features.TurnedField(FIELDS[name], 0.01)
    with pytest.raises(AssertionError, match=r"segments are not on a curve of the field|run against it"):
        assert_integral_curve(own, BALL, turned, 1e-3)
    long = max(own, key=len)
    with pytest.raises(AssertionError, match="away from the mesh"):
        assert_integral_curve(1.01 * long, BALL, FIELDS[name], 1e-4)
    with pytest.raises(AssertionError, match="run against it"):
        assert_integral_curve(np.concatenate([long, long[-2::-1]]), BALL, FIELDS[name], 1e-4)


@pytest.mark.capability("G9.4-polyhedron")
def test_geodesics_pass_over_edges_and_through_vertices_and_bent_ones_do_not():
    directions = np.random.default_rng(1).normal(size=(len(STARTS), 3))
    assert_geodesic(lines(mesh_geodesics(BALL, STARTS, None, directions, length=4.0)), BALL, 1e-8)
    wall = int(np.argmin(CUBE.face_normals @ (0.0, 1.0, 0.0)))
    corner = mesh_geodesics(CUBE, wall, (0.0, -1.0, 0.0), (1.0, 0.0, 1.0), length=4.0)[0]
    assert_geodesic(corner, CUBE, 1e-9)
    for bent, cause in (
        ([(0, -1, 0), (1, -1, 0.2), (1, 0, 0.5)], "turns by 0.09"),
        ([(0, -1, 0), (0.5, -1, 0), (0.9, -1, 0.1)], "turns by 0.245"),
        ([*corner[:2].tolist(), (1.0, 0.9, 0.8)], "turns by"),
        ([(0, -1, 0), (1, -1, 0.5), (-1, 0, 0.5)], "away from the mesh"),
    ):
        with pytest.raises(AssertionError, match=cause):
            assert_geodesic(np.array(bent, dtype=float), CUBE, 1e-3)
    with pytest.raises(InputError, match="tolerance"):
        assert_geodesic(corner, CUBE, 0.0)
