"""Tracing f(u, v) = 0: run with ``pytest tests/bench/bench_zero_manifold.py -s``."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.geometry.connectivity import concat
from vectorplot.surfaces.surface import Domain

pytestmark = pytest.mark.bench

TURN = 2 * np.pi
RING = Domain(0, TURN, 0, TURN, closed_u=True, closed_v=True)
EYE = np.array([8.0, -3.0, 6.0])


def contour(u, v):
    """The contour condition of a torus as for any surface: from its points and partials."""
    r = 3 + 2 * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), 2 * np.sin(v)], axis=-1)
    by_u = np.stack([-r * np.sin(u), r * np.cos(u), 0 * u], axis=-1)
    by_v = np.stack([-2 * np.sin(v) * np.cos(u), -2 * np.sin(v) * np.sin(u), 2 * np.cos(v)], axis=-1)
    return (np.cross(by_u, by_v) * (points - EYE)).sum(axis=-1)


def on_plain_grid(f, n: int):
    """The same curve by linear interpolation on triangles of a closed grid, joined to branches."""
    x = np.linspace(0, TURN, n + 1)
    u, v = np.meshgrid(x, x, indexing="ij")
    w = f(u.ravel(), v.ravel()).reshape(n + 1, n + 1)
    positive = w >= 0
    same = (positive[:-1, :-1] == positive[1:, :-1]) & (positive[:-1, 1:] == positive[1:, 1:])
    i, j = np.nonzero(~(same & (positive[:-1, :-1] == positive[:-1, 1:])))
    i, j = (
        np.concatenate([np.stack([x + a[k] for k in range(3)], axis=1) for a in steps])
        for x, steps in ((i, ((0, 1, 1), (0, 1, 0))), (j, ((0, 0, 1), (0, 1, 1))))
    )
    count = positive[i, j].sum(axis=1)
    i, j, count = (x[count % 3 != 0] for x in (i, j, count))
    sign = positive[i, j]
    lone = np.where(count == 1, sign.argmax(axis=1), (~sign).argmax(axis=1))
    row, a = np.tile(np.arange(len(lone)), 2), np.tile(lone, 2)
    b = np.concatenate([(lone + 1) % 3, (lone + 2) % 3])
    ids = (i % n) * n + j % n
    key = np.minimum(ids[row, a], ids[row, b]) * n * n + np.maximum(ids[row, a], ids[row, b])
    _, first, side = np.unique(key, return_index=True, return_inverse=True)
    start, end = (np.stack([i[row, k], j[row, k]], axis=1)[first] for k in (a, b))
    w0, w1 = w[tuple(start.T)], w[tuple(end.T)]
    points = start + (w0 / (w0 - w1))[:, None] * (end - start)
    return points[concat(np.stack([side[: len(lone)], side[len(lone) :]], axis=1)).points] * TURN / n


def best(work: Callable[[], object], times: int = 25) -> float:
    """Seconds of the processor for the fastest of several runs."""
    seconds = []
    for _ in range(times):
        start = time.process_time()
        work()
        seconds.append(time.process_time() - start)
    return min(seconds)


def trace(n: int, **options):
    return zero_manifold_of_f_uv(contour, RING, columns=n, rows=n, **options)


def test_refined_contour_costs_at_most_three_times_the_plain_one():
    print("\n     grid  plain ms  traced ms  ratio  chords 1e-4 ms  points  residual plain / traced")
    for n in (50, 100, 200):
        plain, traced, fine = (
            best(work)
            for work in (
                lambda n=n: on_plain_grid(contour, n),
                lambda n=n: trace(n),
                lambda n=n: trace(n, tolerance=1e-4),
            )
        )
        curve = trace(n)
        rest = [np.abs(contour(*p.T)).max() for p in (on_plain_grid(contour, n), curve.points)]
        print(
            f"{n:5}x{n:<4}{1e3 * plain:9.2f}{1e3 * traced:11.2f}{traced / plain:7.2f}{1e3 * fine:16.2f}"
            f"{len(curve.points):8}  {rest[0]:.1e} / {rest[1]:.1e}"
        )
        assert rest[1] < 1e-10 * np.median(np.abs(curve.grid[..., 2]))
        # On a small grid the calls cost more than the work in them.
        assert traced < (3.0 if n >= 100 else 7.0) * plain


def evaluations(n: int, resolution: float, f) -> int:
    """How many times f is evaluated beyond the grid."""
    count = [0]

    def counted(u, v):
        count[0] += len(u)
        return f(u, v)

    zero_manifold_of_f_uv(counted, Domain(-1, 1, -1, 1), columns=n, rows=n, resolution=resolution)
    return count[0] - (n + 1) ** 2


def test_evaluations_beyond_the_grid_grow_with_the_cells_near_the_curve():
    small = [evaluations(n, 1.0, lambda u, v: u * u + v * v - 0.5) for n in (50, 100, 200, 400)]
    print("\ncircle, grid 50 to 400: evaluations beyond the grid", small)
    assert all(b < 2.5 * a for a, b in pairwise(small))
    node = [evaluations(50, r, lambda u, v: (u - 0.013) * (v - 0.027)) for r in (1e-2, 1e-3, 1e-4, 1e-5)]
    print("node, resolution 1e-2 to 1e-5:", node)
    # Each halving adds the same few cells around the node.
    assert all(b - a < 700 for a, b in pairwise(node))
    double = [evaluations(50, r, lambda u, v: (v - 0.0063) ** 2) for r in (1e-2, 5e-3, 2.5e-3)]
    print("double line, resolution 1e-2 to 2.5e-3:", double)
    assert all(b < 2.5 * a for a, b in pairwise(double))
