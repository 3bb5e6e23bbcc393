"""Implicit surfaces as triangles."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.features.implicit.polygonize import polygonized
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.families.torus import ImplicitTorus

TORUS = ImplicitTorus(3.0, 1.2)

LOOKS = 6
"""The surface is compared in so many points along each side of a triangle, and between the sides."""


def _study() -> Study:
    extent = float(np.ptp(np.asarray(TORUS.box), axis=0).max())
    a, b = np.array([(i, j) for i in range(LOOKS + 1) for j in range(LOOKS + 1 - i)]).T / LOOKS
    weights = np.stack([a, b, 1.0 - a - b], axis=1)

    def error(mesh: Mesh) -> float:
        points = np.einsum("kc,tcd->tkd", weights, mesh.vertices[mesh.corners.reshape(-1, 3)])
        ring = np.hypot(points[..., 0], points[..., 1]) - TORUS.major
        return 100.0 * float(np.abs(np.hypot(ring, points[..., 2]) - TORUS.minor).max()) / extent

    ways = (Way("triangles", lambda cells: polygonized(TORUS, int(cells)), -2.0),)
    return Study(ways, error, lambda mesh: mesh.face_count)


POLYGONISED = Approximation(
    name="polygonised",
    title="Implicit surfaces as triangles",
    about="A torus by its equation alone, polygonised. Vertices are exact; the error is the largest distance of points "
    "of triangles from the torus, in per cent of the side of its box.",
    knob="cells along the box",
    values=(16, 32, 64, 128),
    limits=(8, 256),
    unit="% of the box",
    counts="triangles",
    study=_study,
)
