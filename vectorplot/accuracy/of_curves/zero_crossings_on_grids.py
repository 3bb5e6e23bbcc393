"""Zero manifolds: an isophote of a torus, its points found on the sides of a grid's triangles in three ways."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.truth import farthest, on_page, page_from_world
from vectorplot.arrays import Floats
from vectorplot.features.parametric.conditions import Isophote
from vectorplot.features.zeros.grid_triangulation import triangulate_surface
from vectorplot.features.zeros.zero_crossings import cubic_parabola, zero_of_cubic_parabola
from vectorplot.features.zeros.zero_manifold import ZeroManifold, zero_manifold_of_f_uv
from vectorplot.geometry.budget import budget_of
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.surfaces.families.torus import Torus
from vectorplot.tolerances.of_measuring import TRUE_ISOPHOTE_MM

Slopes = Callable[[Floats, Floats], Floats]

TORUS, CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

TRUTH_BUDGET, CELLS = 4.0, 64
"""The work that the true curve takes, and the grid it is looked for on."""


def _study() -> Study:
    isophote = Isophote(TORUS, (2.0, -1.0, 3.0), 0.45)
    matrix = page_from_world(CAMERA, np.array([(-4.2, -4.2, -1.2), (4.2, 4.2, 1.2)]))

    def places(u: Floats, v: Floats) -> Floats:
        return on_page(matrix, TORUS.points(u, v))

    def manifold(tolerance: float | None = None) -> ZeroManifold:
        return zero_manifold_of_f_uv(
            isophote.values,
            TORUS.domain,
            columns=CELLS,
            rows=CELLS,
            gradient=isophote.slopes,
            positions=places,
            tolerance=tolerance,
            budget=budget_of(TRUTH_BUDGET),
        )

    def crossings(cells: float, slopes: Slopes | None) -> Floats:
        # A cell more on every side: at borders of a grid average normals lean outwards.
        turn = 2.0 * np.pi * np.arange(-1, int(cells) + 2) / int(cells)
        grid = np.stack(np.meshgrid(turn, turn, indexing="ij"), axis=-1)
        values = isophote.values(grid[..., 0], grid[..., 1])
        return zeros_on_sides(np.concatenate([grid, values[..., None]], axis=-1), slopes)

    def true_slopes(points: Floats, normals: Floats) -> Floats:
        return np.stack(isophote.slopes(*points[:, :2].T), axis=1)

    truth = manifold(TRUE_ISOPHOTE_MM)
    lines = [places(*truth[branch].T) for branch in range(len(truth))]

    def error(found: Floats | ZeroManifold) -> float:
        points = found.points if isinstance(found, ZeroManifold) else found
        return farthest(places(*points.T), lines)

    def count(found: Floats | ZeroManifold) -> int:
        return len(found.points if isinstance(found, ZeroManifold) else found)

    ways = (
        Way("linear", partial(crossings, slopes=None), -2.0),
        Way("cubic parabola", partial(crossings, slopes=slopes_of_normals), -3.0),
        Way("with true slopes", partial(crossings, slopes=true_slopes), -4.0),
    )
    return Study(ways, error, count, exact=manifold)


def slopes_of_normals(points: Floats, normals: Floats) -> Floats:
    """(n,2) the slopes by u and v of a graph with these normals (n,3)."""
    return np.asarray(-normals[:, :2] / normals[:, 2:])


def zeros_on_sides(grid: Floats, slopes: Slopes | None) -> Floats:
    """(p,2) points u, v on the sides of the optimised triangles of a grid (n,m,3) of u, v and f at which f is zero.

    slopes: of the points of the grid and their average normals; the zeros are those of the cubic parabolas through
    values and slopes, and without them those of the chords. On the outermost cells none are looked for.
    Source: Glaeser, section 8.4, figures 11 and 12.
    """
    triangles, normals = triangulate_surface(grid)
    points, inner = grid.reshape(-1, 3), np.zeros(grid.shape[:2], dtype=np.bool_)
    inner[1:-1, 1:-1] = True
    sides = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    sides = sides[inner.ravel()[sides].all(axis=1) & ((points[sides, 2] < 0.0).sum(axis=1) == 1)]
    first, last = points[sides].transpose(1, 0, 2)
    way, share = last - first, first[:, 2] / (first[:, 2] - last[:, 2])
    if slopes is not None:
        slope = slopes(points, normals.reshape(-1, 3))
        ends = [(slope[sides[:, k]] * way[:, :2]).sum(axis=1) for k in range(2)]
        share = zero_of_cubic_parabola(cubic_parabola(first[:, 2], last[:, 2], *ends))
    return np.asarray(first[:, :2] + share[:, None] * way[:, :2])


ZERO_MANIFOLD = Approximation(
    name="zero-manifold",
    title="Zero manifolds",
    about="An isophote of a torus on a grid of its parameters. The error is how far the points found on the sides of "
    "triangles are off the true curve, on the page. Exact: every point refined on the condition itself.",
    knob="cells along a side",
    values=(12, 24, 48, 96),
    limits=(8, 512),
    unit="mm",
    counts="points",
    study=_study,
)
