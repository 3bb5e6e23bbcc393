"""Meshes of implicit surfaces led into the lines and points in which the gradient vanishes."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.polygonize import checked_values
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.implicit_function import hessians
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import VANISHED_GRADIENT

REACH = 1.5
"""Longest sides of triangles from which vertices are led there: polygonised sheets that cross keep clear of each other
by up to so much."""

FIRM = 0.03
"""Part of the largest principal second derivative below which one belongs to a direction along a singular line."""

ROUNDS = 8
"""Steps of Newton's method for where the gradient vanishes."""


def led_into_singular_set(surface: ImplicitSurface, mesh: Mesh) -> Mesh:
    """The mesh, its vertices near points of the surface in which the gradient vanishes moved there, without the
    triangles that are then no more than a part of a singular line.

    Where two sheets cross, polygonised ones turn away from each other and leave a gap: now both end on the line.
    Vertices on the sides of the box stay on them. Degenerate: cuspidal edges, across which the second derivatives
    vanish too, are left as they are.
    """
    if not mesh.face_count:
        return mesh
    x = mesh.vertices
    triangles = mesh.corners.reshape(-1, 3)
    corners = x[triangles]
    reach = REACH * float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(x), axis=1)
        usual = usual_gradient(surface, x)
        moved, there = _singular(surface, x, np.flatnonzero(~(steep > 0.5 * usual)), usual, reach)
    kept = ~there[triangles].all(axis=1)
    return Mesh.from_triangles(moved, triangles[kept])


def usual_gradient(surface: ImplicitSurface, points: Floats) -> float:
    """How long the gradient is at most of the points (n,3); 0 without any."""
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(points), axis=1)
    known = steep[np.isfinite(steep)]
    return float(np.median(known)) if len(known) else 0.0


def _singular(surface: ImplicitSurface, points: Floats, near: Ints, usual: float, reach: float) -> tuple[Floats, Bools]:
    """The points (n,3), those with the numbers near (k,) at singular points of the surface where these are within
    reach; and (n,) which are."""
    low, high = np.asarray(surface.box, dtype=np.float64)
    start = points[near]
    held = (start == low) | (start == high)
    x = start.copy()
    for _ in range(ROUNDS):
        slope = np.where(held, 0.0, np.nan_to_num(surface.gradients(x)))
        bend = np.where(held[:, None] | held[:, :, None], 0.0, np.nan_to_num(hessians(surface, x)))
        step = (np.linalg.pinv(bend, rcond=FIRM) @ slope[..., None])[..., 0]
        x = x - step * np.minimum(1.0, reach / np.maximum(np.linalg.norm(step, axis=1), LEAST_DIVISOR))[:, None]
    flat = np.linalg.norm(np.nan_to_num(surface.gradients(x), nan=np.inf), axis=1) <= VANISHED_GRADIENT * usual
    on = np.abs(checked_values(surface, x)) <= VANISHED_GRADIENT * usual * reach
    good = flat & on & (np.linalg.norm(x - start, axis=1) <= reach) & ((x >= low) & (x <= high)).all(axis=1)
    result, there = points.copy(), np.zeros(len(points), dtype=np.bool_)
    result[near[good]], there[near[good]] = x[good], True
    return result, there
