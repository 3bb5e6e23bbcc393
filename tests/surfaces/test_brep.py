"""The surfaces of faces of bodies, and bodies that are moved."""

from __future__ import annotations

import numpy as np
import pytest
from support.breps import rod

from vectorplot.curves.splines import SplineCurve
from vectorplot.surfaces.brep import Plane, TurnedCircle, TurnedLine
from vectorplot.surfaces.surface import Domain, Transposed, first_jets, second_jets
from vectorplot.surfaces.swept import Screw, Swept

DOMAIN = Domain(0.0, 2.0, -1.0, 1.0)
MERIDIAN = SplineCurve([(2, 0, 0), (3, 0, 1), (1, 0, 2), (2, 0, 3)], [-1, -1, -1, -1, 1, 1, 1, 1], 4)
FACES = {
    "plane": Plane(DOMAIN, 2.0),
    "cylinder": TurnedLine(DOMAIN, 3.0),
    "cone": TurnedLine(DOMAIN, 3.0, 0.6, 0.8),
    "ball": TurnedCircle(DOMAIN, 0.0, 2.0),
    "torus": TurnedCircle(DOMAIN, 3.0, 1.0),
    "turned spline": Transposed(Swept(MERIDIAN, Screw(), 0.0, 2.0 * np.pi), DOMAIN, embedded=True),
}


@pytest.mark.parametrize("name", list(FACES))
def test_derivatives_are_those_of_differences(name: str):
    surface, u, v, h = FACES[name], np.array([0.3, 1.1]), np.array([-0.4, 0.7]), 1e-5
    by_u = (surface.points(u + h, v) - surface.points(u - h, v)) / (2.0 * h)
    by_v = (surface.points(u, v + h) - surface.points(u, v - h)) / (2.0 * h)
    assert np.allclose(surface.partials(u, v), (by_u, by_v), atol=1e-8)
    one, two = (
        (surface.partials(u + h, v), surface.partials(u - h, v)),
        (
            surface.partials(u, v + h),
            surface.partials(u, v - h),
        ),
    )
    uu, uv = ((one[0][k] - one[1][k]) / (2.0 * h) for k in (0, 1))
    vv = (two[0][1] - two[1][1]) / (2.0 * h)
    assert np.allclose(surface.second_partials(u, v), (uu, uv, vv), atol=1e-8)
    assert np.array_equal(first_jets(surface, u, v)[1], surface.partials(u, v)[0])
    assert np.array_equal(second_jets(surface, u, v)[5], surface.second_partials(u, v)[2])


def test_a_moved_body_has_its_edges_on_its_faces():
    matrix = np.array([(0.0, -2.0, 0.0, 5.0), (2.0, 0.0, 0.0, -1.0), (0.0, 0.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0)])
    moved = rod().transformed(matrix)
    edges = moved.edges
    for use, face in enumerate(edges.face.tolist()):
        rows = slice(edges.offsets[use], edges.offsets[use + 1])
        on = moved.trimmed_faces[face].surface.points(*edges.places[rows].T)
        assert np.allclose(on, edges.points[rows], atol=1e-12)
    assert np.allclose(moved.bounds, [(3.0, -3.0, 3.0), (7.0, 1.0, 7.0)])
    assert np.allclose(moved.mesh.vertices, rod().mesh.transformed(matrix).vertices)
