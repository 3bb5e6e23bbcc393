"""Contours of meshes that stand for a smooth surface."""

from __future__ import annotations

from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.truth import on_page, page_from_world
from vectorplot.arrays import Floats
from vectorplot.features.meshes.mesh_lines import mesh_contour_across_faces
from vectorplot.features.parametric.contour import contour
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.zeros.grid_triangulation import mesh_of_grid
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.geometry.vectors import dot
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.curve_distance import hausdorff
from vectorplot.tolerances.of_measuring import CONTOUR_ACCURACY_MM, TRUE_CONTOUR

TORUS, EYE = Torus(3.0, 1.2), np.array([7.0, -5.0, 14.0])


def _study() -> Study:
    matrix = page_from_world(Camera(eye=tuple(EYE)), np.array([(-4.2, -4.2, -1.2), (4.2, 4.2, 1.2)]))

    def smooth(tolerance: float | None = None) -> list[Floats]:
        found = contour(TORUS, EYE, tracing=Tracing(tolerance=tolerance))
        return [found[k] for k in range(len(found))]

    truth = [on_page(matrix, line) for line in smooth(TRUE_CONTOUR)]

    def error(lines: list[Floats]) -> float:
        return hausdorff([on_page(matrix, line) for line in lines], truth, accuracy=CONTOUR_ACCURACY_MM)

    def count(lines: list[Floats]) -> int:
        return sum(len(line) - 1 for line in lines)

    ways = (Way("along edges", edge_contour, -2.0), Way("across faces", contour_across_faces, -2.0))
    return Study(ways, error, count, exact=partial(smooth, CONTOUR_ACCURACY_MM))


def torus_of(cells: float) -> Mesh:
    """The torus as triangles with so many cells around its tube, and twice as many along it."""
    u, v = (2.0 * np.pi * np.arange(n + 1) / n for n in (2 * int(cells), int(cells)))
    return mesh_of_grid(TORUS.points(*np.meshgrid(u, v, indexing="ij")), closed_u=True, closed_v=True)


def edge_contour(cells: float) -> list[Floats]:
    """The edges of the mesh between a face that looks at the eye and one that looks away, (2,3) each."""
    mesh = torus_of(cells)
    front = dot(mesh.face_normals, EYE - mesh.vertices[mesh.corners[mesh.offsets[:-1]]]) > 0.0
    uses = edge_uses(mesh)
    one, two = uses.corner[uses.first], uses.corner[uses.first + 1]
    turns = one[front[mesh.corner_face[one]] != front[mesh.corner_face[two]]]
    ends = np.stack([mesh.corners[turns], mesh.corners[mesh.next_corner[turns]]], axis=1)
    return list(mesh.vertices[ends])


def contour_across_faces(cells: float) -> list[Floats]:
    """The curves across the faces of the mesh on which normals averaged at the vertices turn away, (n,3) each."""
    found = mesh_contour_across_faces(torus_of(cells), EYE)
    parts = np.split(found.points, found.offsets[1:-1])
    return [
        np.concatenate([part, part[:1]]) if closed else part for part, closed in zip(parts, found.closed, strict=True)
    ]


MESH_CONTOUR = Approximation(
    name="mesh-contour",
    title="Contours of meshes",
    about="The contour of a torus from meshes of it: the edges where faces turn away, or curves across the faces by "
    "averaged normals. The error is the Hausdorff distance from the contour of the true torus on the page.",
    knob="cells around the tube",
    values=(16, 32, 64, 128, 256),
    limits=(8, 512),
    unit="mm",
    counts="chords",
    study=_study,
)
