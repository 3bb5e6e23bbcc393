"""Exercises of chapter 6, a painter.

Fill in the functions; ``python docs/course/check.py 6`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def side(face: np.ndarray, points: np.ndarray, eye: np.ndarray) -> int:
    """1 if no point (k, 3) lies beyond the plane of a face (n, 3) seen from the eye, -1 if none lies before it, else 0.

    Points in the plane count for both sides; if all lie in it the answer is 1. The face may run either way round.
    """
    raise NotImplementedError


def ordered(count: int, demands: list[tuple[int, int]]) -> list[int] | None:
    """An order of 0 to count - 1 in which b stands before a for each demand (b, a); None if there is none."""
    raise NotImplementedError


def halves(face: np.ndarray, normal: np.ndarray, c: float) -> tuple[np.ndarray, np.ndarray]:
    """The two parts (k, 3) of a convex face (n, 3): where normal.x >= c, and where normal.x <= c.

    No corner lies in the plane. A part that is not there is an array (0, 3). Both run round as the face does.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_side(answer: Callable[..., int]) -> None:
    """Faces that lie before, beyond, across and in a plane."""
    face = np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 2.0, 0.0), (0.0, 2.0, 0.0)])
    eye = np.array([1.0, -5.0, 4.0])
    for points, expected in (
        ([(0, 0, 1), (1, 0, 2), (5, 5, 1)], 1),
        ([(0, 0, -1), (1, 0, -2), (5, 5, -1)], -1),
        ([(0, 0, -1), (1, 0, 2), (5, 5, 1)], 0),
        ([(0, 0, 0), (1, 0, 2), (5, 5, 1)], 1),
        ([(0, 0, 0), (1, 0, -2), (5, 5, -1)], -1),
        ([(3, 0, 0), (4, 0, 0), (5, 5, 0)], 1),
    ):
        for corners in (face, face[::-1]):
            for up, turned in ((1.0, expected), (-1.0, -expected if np.array(points)[:, 2].any() else expected)):
                found = answer(corners, np.array(points, dtype=float), eye * (1.0, 1.0, up))
                assert found == turned, f"{points}, the eye at z = {4 * up:g}: expected {turned}, found {found}"


def check_ordered(answer: Callable[..., list[int] | None]) -> None:
    """Random demands that an order fulfils, and circles."""
    rng = np.random.default_rng(2)
    assert answer(3, [(0, 1), (1, 2), (2, 0)]) is None, "a circle of three has no order"
    assert answer(4, [(0, 1), (2, 3), (3, 2)]) is None, "a circle of two has no order, whatever the others have"
    assert list(answer(1, []) or []) == [0], "one face is in order"
    for _ in range(30):
        rank = rng.permutation(12)
        pairs = rng.integers(0, 12, (25, 2)).tolist()
        demands = [(b, a) for b, a in pairs if rank[b] < rank[a]]
        found = answer(12, demands)
        assert found is not None and sorted(found) == list(range(12)), "each number stands once"
        for b, a in demands:
            assert found.index(b) < found.index(a), f"{b} must stand before {a}: {found}"


def _area(face: np.ndarray) -> np.ndarray:
    return 0.5 * np.cross(face, np.roll(face, -1, axis=0)).sum(axis=0) if len(face) else np.zeros(3)


def check_halves(answer: Callable[..., tuple[np.ndarray, np.ndarray]]) -> None:
    """The parts lie on their sides, and their areas add up, with their directions."""
    rng = np.random.default_rng(3)
    for k in range(40):
        turn = np.sort(rng.uniform(0, 2 * np.pi, 3 + k % 5))
        flat = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
        one, other = rng.normal(size=(2, 3))
        face = flat[:, :1] * one + flat[:, 1:2] * other + rng.normal(size=3)
        normal = rng.normal(size=3)
        c = float((normal * face.mean(axis=0)).sum()) + (k % 4 == 0) * 100.0
        parts = [np.asarray(part) for part in answer(face.copy(), normal, c)]
        for part, sign in zip(parts, (1.0, -1.0), strict=True):
            assert part.ndim == 2 and part.shape[1] == 3, f"expected an array (k, 3), found {part.shape}"
            assert (sign * ((part * normal).sum(axis=1) - c) > -1e-9).all(), "a corner lies on the wrong side"
        assert np.allclose(_area(parts[0]) + _area(parts[1]), _area(face)), "the areas do not add up, with their sense"
