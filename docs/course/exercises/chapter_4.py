"""Exercises of chapter 4, a zero manifold.

Fill in the functions; ``python docs/course/check.py 4`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np


def crossings(f: Callable[..., np.ndarray], a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(k, 2) a zero of f(u, v) on each segment from a to b, (k, 2) each, to 1e-12 of its length.

    f takes arrays u, v (k,), is continuous, and has different signs at a and b. Do not call it more than 100 times.
    """
    raise NotImplementedError


def in_triangles(corners: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(s, 2, 2) the segments along which linear functions vanish in triangles (m, 3, 2).

    values (m, 3) are those at the corners. A triangle whose values have one sign has none; no value is 0. They come in
    the order of the triangles; the ends of each may be swapped.
    """
    raise NotImplementedError


def branches(segments: np.ndarray) -> tuple[int, int]:
    """How many open and how many closed curves segments (s, 2, 2) make up.

    Ends that meet are exactly equal, and at most two meet in a point. np.unique with axis=0 and return_inverse numbers
    the points.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_crossings(answer: Callable[..., np.ndarray]) -> None:
    """Of several functions, steep and flat ones."""
    rng = np.random.default_rng(1)
    calls = []
    for power in (1, 3, 7):

        def f(u: np.ndarray, v: np.ndarray, power: int = power) -> np.ndarray:
            calls.append(1)
            return (np.hypot(u, v) - 1.0) ** power

        turn = rng.uniform(0, 2 * np.pi, 50)
        way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        a, b = way * rng.uniform(0.0, 0.99, (50, 1)), way * rng.uniform(1.01, 3.0, (50, 1))
        swap = rng.random((50, 1)) < 0.5
        a, b = np.where(swap, b, a), np.where(swap, a, b)
        calls.clear()
        found = np.asarray(answer(f, a.copy(), b.copy()))
        assert len(calls) <= 100, f"f was called {len(calls)} times"
        assert found.shape == (50, 2), f"expected an array (50, 2), found {found.shape}"
        off = np.linalg.norm(found - way, axis=1).max()
        assert off < 1e-11, f"(r - 1)^{power}: up to {off:.2g} from the zero"


def check_in_triangles(answer: Callable[..., np.ndarray]) -> None:
    """Ends lie on sides, and the function vanishes there."""
    rng = np.random.default_rng(2)
    corners, values = rng.normal(size=(200, 3, 2)), rng.normal(size=(200, 3))
    found = np.asarray(answer(corners.copy(), values.copy()))
    mixed = (values > 0).any(axis=1) & (values < 0).any(axis=1)
    assert found.shape == (mixed.sum(), 2, 2), f"expected an array {(int(mixed.sum()), 2, 2)}, found {found.shape}"
    rows = np.concatenate([corners[mixed].transpose(0, 2, 1), np.ones((len(found), 1, 3))], axis=1)
    ends = np.concatenate([found, np.ones((len(found), 2, 1))], axis=2).transpose(0, 2, 1)
    weights = np.linalg.solve(rows, ends)
    assert np.abs((weights * values[mixed][:, :, None]).sum(axis=1)).max() < 1e-8, "the function is not 0 at an end"
    assert np.abs(np.sort(weights, axis=1)[:, 0]).max() < 1e-8, "an end lies on no side of its triangle"
    assert (np.linalg.norm(found[:, 0] - found[:, 1], axis=1) > 0).all(), "both ends are the same"
    assert len(np.asarray(answer(corners[~mixed], values[~mixed]))) == 0, "triangles with values of one sign have none"


def check_branches(answer: Callable[..., tuple[int, int]]) -> None:
    """Chains and rings, in any order."""
    rng = np.random.default_rng(3)
    assert tuple(answer(np.zeros((0, 2, 2)))) == (0, 0), "of no segments: no curves"
    for opened, closed in ((1, 0), (0, 1), (3, 2), (2, 5), (0, 4)):
        segments = []
        for _ in range(opened):
            line = rng.normal(size=(rng.integers(2, 9), 2))
            segments += list(pairwise(line))
        for _ in range(closed):
            line = rng.normal(size=(rng.integers(3, 9), 2))
            segments += list(zip(line, np.roll(line, -1, axis=0), strict=True))
        mixed = np.array(segments)[rng.permutation(len(segments))]
        mixed = np.where(rng.random((len(mixed), 1, 1)) < 0.5, mixed[:, ::-1], mixed)
        found = tuple(int(count) for count in answer(mixed))
        assert found == (opened, closed), f"expected {(opened, closed)} open and closed ones, found {found}"
