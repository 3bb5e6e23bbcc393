"""Triangles of surfaces with lines on which normals turn over."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.edge_splitting import Within
from vectorplot.features.tessellation import facets
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-1.0, 1.0, -1.0, 1.0)
TAIL = surface_of_function(lambda u, v: (u, 4 * v**3 + 2 * u * v, -3 * v**4 - u * v * v), SQUARE)
BLADE = surface_of_function(lambda u, v: (v, u**2, u**3), SQUARE)
STAR = surface_of_function(
    lambda u, v: (np.cos(u) ** 3 * (2 + v), np.sin(u) ** 3, v), Domain(0.0, 2.0 * np.pi, -1.0, 1.0, closed_u=True)
)


@pytest.mark.parametrize("surface", [TAIL, BLADE, STAR], ids=["swallowtail", "blade", "star"])
def test_no_triangle_lies_across_a_line_on_which_normals_turn_over(surface) -> None:
    found = facets(surface, Within(lambda points: np.full(points.shape[:-1], 1e-2)))
    corners = found.mesh.corners.reshape(-1, 3)
    normals = np.where(found.sharp[:, None], np.nan, found.normals)[corners]
    cosine = (normals * np.roll(normals, 1, axis=1)).sum(axis=2)
    assert found.sharp.any()
    assert np.nanmin(cosine) > 0.0


def test_the_new_vertices_lie_on_the_cuspidal_edge() -> None:
    found = facets(TAIL, Within(lambda points: np.full(points.shape[:-1], 1e-2)))
    x, y, z = found.mesh.vertices[found.sharp].T
    v = np.cbrt(-y / 8.0)
    np.testing.assert_allclose(x, -6.0 * v**2, atol=1e-9)
    np.testing.assert_allclose(z, 3.0 * v**4, atol=1e-9)
