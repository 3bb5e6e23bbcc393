"""Exercises of chapter 7, a shadow.

Fill in the functions; ``python docs/course/check.py 7`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def sun_shadow(points: np.ndarray, to_sun: np.ndarray) -> np.ndarray:
    """(n, 3) the shadows of points (n, 3) on the ground z = 0, in light from the direction to_sun (3,)."""
    raise NotImplementedError


def lamp_shadow(points: np.ndarray, lamp: np.ndarray, normal: np.ndarray, c: float) -> np.ndarray:
    """(n, 3) the shadows of points (n, 3) on the plane normal.x = c, in the light of a lamp (3,); NaN where none falls.

    None falls from points that are farther from the lamp than the plane is, on their ray, nor from those whose rays run
    away from the plane or along it.
    """
    raise NotImplementedError


def lit(points: np.ndarray, lamp: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) whether a lamp (3,) reaches points (n, 3) past triangles (m, 3, 3).

    No point lies on a triangle. Try it without a loop: arrays (n, m).
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_sun_shadow(answer: Callable[..., np.ndarray]) -> None:
    """Shadows lie on the ground, and on the rays."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        points, sun = rng.normal(size=(9, 3)) + np.array([0, 0, 4]), rng.normal(size=3)
        sun[2] = abs(sun[2]) + 0.2
        found = np.asarray(answer(points, sun))
        assert found.shape == (9, 3), f"expected an array (9, 3), found {found.shape}"
        assert np.allclose(found[:, 2], 0.0), "a shadow does not lie on the ground"
        assert np.allclose(np.cross(points - found, sun), 0.0, atol=1e-9), "a shadow does not lie on the ray"
    assert np.allclose(answer(np.array([(1.0, 2.0, 3.0)]), np.array([0.0, 0.0, 5.0])), [(1, 2, 0)]), "the sun overhead"


def check_lamp_shadow(answer: Callable[..., np.ndarray]) -> None:
    """Shadows lie on the plane, on the rays, and beyond the points."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        points, lamp, normal, c = rng.normal(size=(30, 3)) * 3, rng.normal(size=3) * 3, rng.normal(size=3), 0.7
        with np.errstate(all="ignore"):
            found = np.asarray(answer(points, lamp, normal, c))
        over, lamp_over = points @ normal - c, float(lamp @ normal - c)
        falls = (over * lamp_over > 0) & (np.abs(over) < abs(lamp_over))
        assert found.shape == (30, 3), f"expected an array (30, 3), found {found.shape}"
        wrong = np.isfinite(found).all(axis=1) != falls
        assert not wrong.any(), f"lamp {lamp_over:.2f} over the plane, point {over[wrong][:1].round(2)}: shadow or none"
        assert np.allclose(found[falls] @ normal, c), "a shadow does not lie in the plane"
        ray, own = found[falls] - lamp, points[falls] - lamp
        assert np.allclose(np.cross(ray, own) / np.linalg.norm(ray, axis=1, keepdims=True), 0, atol=1e-8), "off its ray"
    along = np.asarray(answer(np.array([(1.0, 0.0, 2.0)]), np.array([0.0, 0.0, 2.0]), np.array([0.0, 0.0, 1.0]), 0.0))
    assert not np.isfinite(along).any(), "a ray along the plane throws no shadow"


def check_lit(answer: Callable[..., np.ndarray]) -> None:
    """Against signs of volumes, one pair after the other."""
    rng = np.random.default_rng(3)
    for m in (0, 1, 6, 6):
        points, lamp, triangles = rng.normal(size=(60, 3)) * 2, rng.normal(size=3) * 5, rng.normal(size=(m, 3, 3)) * 2
        expected = np.ones(60, dtype=bool)
        for k, x in enumerate(points):
            for a, b, c in triangles:
                six = [np.linalg.det(np.array(t)) for t in ((a - x, b - x, c - x), (a - lamp, b - lamp, c - lamp))]
                round_ = [np.linalg.det(np.array([x - lamp, s - lamp, t - lamp])) for s, t in ((a, b), (b, c), (c, a))]
                if six[0] * six[1] < 0 and (min(round_) > 0 or max(round_) < 0):
                    expected[k] = False
        found = np.asarray(answer(points, lamp, triangles))
        assert found.shape == (60,), f"expected an array (60,), found {found.shape}"
        wrong = np.flatnonzero(found != expected)
        assert not len(wrong), f"{m} triangles: point {points[wrong[0]].round(2)} is lit: {expected[wrong[0]]}"
