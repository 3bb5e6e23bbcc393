"""From small pieces to the pen's strokes: run with ``pytest tests/bench/bench_drawing.py -s``."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.duplicates import without_duplicates
from vectorplot.drawing.finishing import without_collinear_points
from vectorplot.drawing.pen_order import pen_ordered, travel_mm
from vectorplot.drawing.strokes import joined, split_long

pytestmark = pytest.mark.bench

COUNT = 500_000
TOLERANCE = 1e-4
Points = np.ndarray


def pieces(starts: Points, ends: Points) -> Paths:
    points = np.stack((starts, ends), axis=1).reshape(-1, 2)
    zeros = np.zeros(len(starts), dtype=np.intp)
    offsets = np.arange(0, len(points) + 1, 2)
    return Paths(points, offsets, zeros == 1, zeros, zeros, zeros, np.column_stack((points, np.ones(len(points)))))


def random_pieces(count: int = COUNT, length: float = 0.5) -> Paths:
    rng = np.random.default_rng(1)
    start, angle = rng.random((count, 2)) * [190, 277], rng.random(count) * 2 * np.pi
    return pieces(start, start + length * np.c_[np.cos(angle), np.sin(angle)])


def graph_pieces() -> Paths:
    """The grid lines of a function graph in oblique view, shuffled."""
    u, v = np.meshgrid(np.linspace(10, 200, 500), np.linspace(10, 280, 500), indexing="ij")
    grid = np.stack((u + 0.06 * v, 0.6 * v + 5 * np.sin(u / 10) * np.cos(v / 13)), axis=-1)
    starts = np.concatenate((grid[:-1].reshape(-1, 2), grid[:, :-1].reshape(-1, 2)))
    ends = np.concatenate((grid[1:].reshape(-1, 2), grid[:, 1:].reshape(-1, 2)))
    order = np.random.default_rng(2).permutation(len(starts))
    return pieces(starts[order], ends[order])


def box_pieces() -> Paths:
    """The edges of many boxes in parallel projection: three directions only."""
    corner = np.random.default_rng(3).random((COUNT // 12, 2)) * [190, 277]
    side = np.array([[1.0, 0.0], [0.4, 0.3], [0.0, 1.0]])
    edges = [(i, s, t) for i in range(3) for s in (0, 1) for t in (0, 1)]
    starts = [corner + s * side[(i + 1) % 3] + t * side[(i + 2) % 3] for i, s, t in edges]
    ends = [start + side[i] for start, (i, _, _) in zip(starts, edges, strict=True)]
    return pieces(np.concatenate(starts), np.concatenate(ends))


def spiral_pieces() -> Paths:
    """One chain, shuffled."""
    t = np.linspace(0, 300 * np.pi, COUNT + 1)
    line = np.c_[100 + t / 10 * np.cos(t), 140 + t / 10 * np.sin(t)]
    order = np.random.default_rng(4).permutation(COUNT)
    return pieces(line[:-1][order], line[1:][order])


def stacked_pieces() -> Paths:
    """A plane grid seen edge-on: 300 times the same 400 pieces."""
    line = np.c_[np.linspace(10, 200, 401), np.linspace(20, 90, 401)]
    return pieces(np.tile(line[:-1], (300, 1)), np.tile(line[1:], (300, 1)))


MAKERS = [random_pieces, graph_pieces, box_pieces, spiral_pieces, stacked_pieces]


def timed(call: Callable[[], Paths]) -> tuple[float, Paths]:
    times = []
    for _ in range(3):
        start = time.perf_counter()
        result = call()
        times.append(time.perf_counter() - start)
    return min(times), result


@pytest.mark.parametrize("make", MAKERS)
def test_from_pieces_to_strokes(make: Callable[[], Paths]) -> None:
    given = make()
    same = np.zeros(len(given), dtype=np.intp)
    once_s, once = timed(lambda: without_duplicates(given, np.arange(len(given)), TOLERANCE))
    join_s, long = timed(lambda: joined(once, same[: len(once)], TOLERANCE))
    thin_s, thin = timed(lambda: without_collinear_points(long, 1e-3))
    split_s, split = timed(lambda: split_long(thin, 100.0))
    print(f"\n{make.__name__}: {len(given)} pieces")
    print(f"  duplicates {once_s:.3f} s (0.3 wanted where few coincide), {len(once)} left")
    print(f"  joined     {join_s:.3f} s (1 wanted), {len(long)} strokes")
    print(f"  collinear  {thin_s:.3f} s, {len(long.points)} points to {len(thin.points)}")
    print(f"  split      {split_s:.3f} s, {len(split)} strokes")


@pytest.mark.parametrize("count", [2_000, 20_000])
def test_pen_order(count: int) -> None:
    given = random_pieces(count, 2.0)
    seconds, ordered = timed(lambda: pen_ordered(given))
    print(f"\npen order of {count} strokes: {seconds:.3f} s (0.35 wanted at 20000)", end="")
    print(f", travel {travel_mm(ordered):.0f} mm, as given {travel_mm(given):.0f} mm", end="")
    print(f", nearest neighbour {nearest_neighbour_mm(given):.0f} mm" if count <= 2_000 else "")


def nearest_neighbour_mm(paths: Paths) -> float:
    """The travel of a pen that always goes to the nearest free end."""
    ends = paths.points[:, 0] + 1j * paths.points[:, 1]
    free = np.ones(len(ends), dtype=np.bool_)
    at, total = 1, 0.0
    free[:2] = False
    for _ in range(len(paths) - 1):
        choices = np.flatnonzero(free)
        away = np.abs(ends[choices] - ends[at])
        nearest = choices[away.argmin()]
        total += float(away.min())
        free[[nearest, nearest ^ 1]] = False
        at = nearest ^ 1
    return total
