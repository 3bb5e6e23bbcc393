"""Exercises of chapter 2, a hidden line.

Fill in the functions; ``python docs/course/check.py 2`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def hidden(points: np.ndarray, triangle: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """(n,) whether a triangle (3, 3) hides points (n, 3) from the eye (3,): it meets the ray between them.

    The corners of the triangle may run either way round.
    """
    raise NotImplementedError


def changes(p: np.ndarray, q: np.ndarray, triangle: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """(k,) all t between 0 and 1 where P + t (Q - P) crosses one of the four planes of a triangle, ascending.

    Three planes go through the eye and a side, the fourth is the triangle's own.
    """
    raise NotImplementedError


def visible_length(p: np.ndarray, q: np.ndarray, triangles: np.ndarray, eye: np.ndarray) -> float:
    """The length of what is seen of the line from P to Q behind triangles (m, 3, 3), exactly.

    Use the two functions above.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def _cases(seed: int) -> list[tuple[np.ndarray, ...]]:
    rng = np.random.default_rng(seed)
    eye = np.array([0.5, -12.0, 1.0])
    return [
        (rng.normal(size=3) * 3 + (0, 3, 0), rng.normal(size=3) * 3 + (0, 3, 0), rng.normal(size=(3, 3)) * 2, eye)
        for _ in range(60)
    ]


def _by_rays(points: np.ndarray, triangle: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Solves eye + s (point - eye) = A + a (B - A) + b (C - A) by Cramer's rule."""
    ray, one, other, off = points - eye, triangle[1] - triangle[0], triangle[2] - triangle[0], eye - triangle[0]
    across = np.cross(ray, other)
    whole = (across * one).sum(axis=1)
    a = (across * off).sum(axis=1) / whole
    b = (np.cross(off, one) * ray).sum(axis=1) / whole
    s = (np.cross(off, one) * other).sum() / whole
    return (a > 0) & (b > 0) & (a + b < 1) & (s > 0) & (s < 1)


def check_hidden(answer: Callable[..., np.ndarray]) -> None:
    """Against rays."""
    for p, q, triangle, eye in _cases(1):
        points = p + np.linspace(0, 1, 41)[:, None] * (q - p)
        for corners in (triangle, triangle[::-1]):
            found, expected = np.asarray(answer(points, corners, eye)), _by_rays(points, corners, eye)
            assert found.shape == (41,), f"expected an array (41,), found {found.shape}"
            wrong = np.flatnonzero(found != expected)
            assert not len(wrong), f"triangle {corners.round(2).tolist()}: point {points[wrong[0]].round(3)}"


def check_changes(answer: Callable[..., np.ndarray]) -> None:
    """At the places that are found, and only there, the sign of one of the four volumes changes."""
    for p, q, triangle, eye in _cases(2):
        found = np.asarray(answer(p, q, triangle, eye))
        assert (np.diff(found) >= 0).all() and ((found > 0) & (found < 1)).all(), "ascending, between 0 and 1"
        three = [(eye, triangle[k], triangle[k - 1]) for k in range(3)] + [tuple(triangle)]
        expected = []
        for a, b, c in three:
            g, h = (float(np.linalg.det(np.array([b - a, c - a, x - a]))) for x in (p, q))
            expected += [g / (g - h)] if g * h < 0 else []
        assert len(found) == len(expected), f"expected {len(expected)} places, found {len(found)}"
        assert np.allclose(found, sorted(expected)), f"expected {np.sort(expected)}, found {found}"


def check_visible_length(answer: Callable[..., float]) -> None:
    """Against 4,000 rays, and for no triangles at all."""
    rng = np.random.default_rng(3)
    for p, q, _, eye in _cases(3)[:12]:
        triangles = rng.normal(size=(9, 3, 3)) * 2.0
        length = float(np.linalg.norm(q - p))
        points = p + ((np.arange(4000) + 0.5) / 4000)[:, None] * (q - p)
        seen = ~np.any([_by_rays(points, triangle, eye) for triangle in triangles], axis=0)
        found = answer(p, q, triangles, eye)
        assert abs(found - length * seen.mean()) < 0.008 * length, (
            f"about {length * seen.mean():.3f}, found {found:.3f}"
        )
        assert np.isclose(answer(p, q, np.zeros((0, 3, 3)), eye), length), "without triangles all of it is seen"
