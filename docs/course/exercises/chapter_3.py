"""Exercises of chapter 3, a zone.

Fill in the functions; ``python docs/course/check.py 3`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def clipped(p: np.ndarray, q: np.ndarray, normals: np.ndarray, offsets: np.ndarray) -> tuple[float, float] | None:
    """(begin, end) of the t between 0 and 1 with n.X(t) <= c for all normals n (k, 3) and offsets c (k,); or None.

    X(t) = P + t (Q - P). Mind lines that are parallel to a plane.
    """
    raise NotImplementedError


def united(intervals: np.ndarray) -> np.ndarray:
    """(m, 2) the union of intervals (k, 2), as intervals that are apart, ascending.

    Those that touch become one. No loop over intervals is needed: sort, and np.maximum.accumulate.
    """
    raise NotImplementedError


def counted(intervals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By how many intervals (k, 2) each piece of 0 to 1 is covered: (m+1,) where pieces begin and end, and (m,) counts.

    The intervals lie within 0 to 1. Neighbouring pieces differ in their counts; no piece has the length 0.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_clipped(answer: Callable[..., tuple[float, float] | None]) -> None:
    """Against many points of the line."""
    rng = np.random.default_rng(1)
    t = (np.arange(2000) + 0.5) / 2000
    for case in range(80):
        p, q = rng.normal(size=(2, 3)) * 2
        normals, offsets = rng.normal(size=(5, 3)), rng.uniform(-0.3, 2.0, 5)
        if case % 4 == 0:
            normals[0] = np.cross(q - p, normals[1])
            offsets[0] = (normals[0] * p).sum() + (1.0 if case % 8 else -1.0)
        inside = ((p + t[:, None] * (q - p)) @ normals.T <= offsets).all(axis=1)
        found = answer(p, q, normals, offsets)
        if found is None:
            assert not inside.any(), f"t = {t[inside.argmax()]:.3f} is inside, found None"
            continue
        begin, end = found
        assert 0.0 <= begin <= end <= 1.0, f"0 <= begin <= end <= 1, found {found}"
        sure = (np.abs(t - begin) > 1e-3) & (np.abs(t - end) > 1e-3)
        wrong = np.flatnonzero(sure & (inside != ((t > begin) & (t < end))))
        assert not len(wrong), f"t = {t[wrong[0]]:.3f} is {'inside' if inside[wrong[0]] else 'outside'}, found {found}"


def check_united(answer: Callable[..., np.ndarray]) -> None:
    """Cases by hand, and random ones on a grid, where touching is frequent."""
    for given, expected in (
        ([(0, 1), (2, 3)], [(0, 1), (2, 3)]),
        ([(2, 3), (0, 1), (1, 2)], [(0, 3)]),
        ([(0, 9), (1, 2), (3, 4)], [(0, 9)]),
        ([(0, 9), (1, 2), (3, 10), (11, 12)], [(0, 10), (11, 12)]),
    ):
        found = np.asarray(answer(np.array(given, dtype=float)))
        assert found.tolist() == np.array(expected, dtype=float).tolist(), f"{given}: expected {expected}"
    assert np.asarray(answer(np.zeros((0, 2)))).shape == (0, 2), "of no intervals: an array (0, 2)"
    rng = np.random.default_rng(2)
    for _ in range(50):
        low = rng.integers(0, 40, 8)
        given = np.stack([low, low + rng.integers(1, 6, 8)], axis=1)
        covered = np.zeros(48, dtype=int)
        for a, b in given.tolist():
            covered[a:b] = 1
        steps = np.diff(np.r_[0, covered, 0])
        expected = np.stack([np.flatnonzero(steps > 0), np.flatnonzero(steps < 0)], axis=1)
        found = np.asarray(answer(given.astype(float)))
        assert found.shape == expected.shape and (found == expected).all(), f"{given.tolist()}: {expected.tolist()}"


def check_counted(answer: Callable[..., tuple[np.ndarray, np.ndarray]]) -> None:
    """Against the definition, in the middle of every piece."""
    rng = np.random.default_rng(3)
    for k in (0, 1, 2, 5, 9, 9, 9, 9):
        given = np.sort(rng.integers(0, 13, (k, 2)), axis=1) / 12.0
        given = given[given[:, 0] < given[:, 1]]
        cuts, counts = (np.asarray(found) for found in answer(given))
        assert len(cuts) == len(counts) + 1 and cuts[0] == 0 and cuts[-1] == 1, "from 0 to 1, a count for each piece"
        assert (np.diff(cuts) > 0).all(), "no piece has the length 0"
        assert (np.diff(counts) != 0).all(), "neighbouring pieces with the same count are one piece"
        middle = (cuts[1:] + cuts[:-1]) / 2.0
        expected = ((given[:, :1] < middle) & (middle < given[:, 1:])).sum(axis=0)
        assert (counts == expected).all(), f"{given.round(3).tolist()}: expected {expected}, found {counts}"
        every = (np.arange(240) + 0.5) / 240.0
        true = ((given[:, :1] < every) & (every < given[:, 1:])).sum(axis=0)
        of = np.searchsorted(cuts, every) - 1
        assert (counts[of] == true).all(), f"{given.round(3).tolist()}: a change is missing"
