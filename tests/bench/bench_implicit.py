"""Implicit surfaces and lines on meshes: how long they take."""

import numpy as np
import pytest

from vectorplot.features.implicit_curves import ImplicitTracing, implicit_contour, implicit_isophotes
from vectorplot.features.implicit_meshes import implicit_mesh
from vectorplot.features.mesh_lines import mesh_plane_sections
from vectorplot.features.polygonization import polygonized, settled_mesh
from vectorplot.speed.results import cpu_seconds
from vectorplot.surfaces.tori import ImplicitTorus

TORUS = ImplicitTorus(3.0, 1.0)


@pytest.mark.bench
def test_contour_and_nine_isophotes_of_an_implicit_torus():
    def lines():
        tracing = ImplicitTracing(mesh=implicit_mesh(TORUS, 64))
        implicit_contour(TORUS, (8, -3, 6), tracing=tracing)
        implicit_isophotes(TORUS, (2, 1, 3), np.linspace(-0.9, 0.9, 9), tracing=tracing)

    mesh, whole = cpu_seconds(lambda: settled_mesh(TORUS, 64)), cpu_seconds(lines)
    print(f"\n64 cells: mesh {mesh:.3f} s, with contour and 9 isophotes {whole:.3f} s")
    assert whole < 30.0 * mesh


@pytest.mark.bench
def test_sections_of_a_fine_mesh():
    counts, times = [], []
    for cells in (62, 124, 248):
        mesh = polygonized(TORUS, cells)
        counts.append(mesh.face_count)
        times.append(cpu_seconds(lambda m=mesh: mesh_plane_sections(m, (1, 2, 3), np.linspace(-2, 2, 10))))
        print(f"\n{counts[-1]} triangles: 10 sections {times[-1]:.3f} s")
    # Not more than linear in the faces, with room for noise.
    assert times[2] / times[0] < 2.0 * counts[2] / counts[0]
