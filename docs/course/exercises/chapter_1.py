"""Exercises of chapter 1, a projection.

Fill in the functions; ``python docs/course/check.py 1`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import vectorplot as vp


def parallel(points: np.ndarray, eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(n, 2) the images x, y of points (n, 3) by rays parallel to eye - target, in the frame of the camera.

    The origin is the target, y is as near to the z-axis of the world as it can be. No perspective: nothing shrinks.
    """
    raise NotImplementedError


def vanishing_point(direction: np.ndarray, eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(2,) where the images of all lines of a direction (3,) run to, in the plane through the target.

    Hint: take the image of target + s direction and let s grow without bound.
    """
    raise NotImplementedError


def nearest_distance(points: np.ndarray, towards_eye: np.ndarray, fov_deg: float) -> float:
    """The least distance of the eye from the origin at which no point (n, 3) is above or below the picture.

    The eye stands in the direction towards_eye (3,) from the origin and looks there; the picture shows fov_deg over its
    height. Hint: each point says how far away the eye must be at least.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def _frame(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    return vp.Camera(eye=tuple(eye.tolist()), target=tuple(target.tolist())).axes


def check_parallel(answer: Callable[..., np.ndarray]) -> None:
    """Against the axes of a camera."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        eye, target, points = rng.normal(size=3) * 9, rng.normal(size=3), rng.normal(size=(7, 3))
        expected = np.stack([((points - target) * axis).sum(axis=1) for axis in _frame(eye, target)[:2]], axis=1)
        found = np.asarray(answer(points, eye, target))
        assert found.shape == (7, 2), f"expected an array (7, 2), found {found.shape}"
        assert np.allclose(found, expected), f"eye {eye.round(2)}, point {points[0].round(2)}: expected {expected[0]}"


def check_vanishing_point(answer: Callable[..., np.ndarray]) -> None:
    """Against images of points that are very far away, on two lines."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        eye, target, direction = rng.normal(size=3) * 9, rng.normal(size=3), rng.normal(size=3)
        frame, d = _frame(eye, target), np.linalg.norm(eye - target)
        away = -np.sign((direction * frame[2]).sum()) * direction
        far = np.array([(1e10 * away + off) for off in (np.zeros(3), rng.normal(size=3))])
        x, y, z = ((far * axis[None]).sum(axis=1) for axis in frame)
        expected = np.stack([x, y], axis=1) * (d / (d - z))[:, None]
        found = np.asarray(answer(direction, eye, target))
        assert found.shape == (2,), f"expected an array (2,), found {found.shape}"
        assert np.allclose(found, expected, rtol=1e-6, atol=1e-6), f"direction {direction.round(2)}: {expected[0]}"
        assert np.allclose(found, answer(-3.0 * direction, eye, target)), "length and sense of a direction do not count"


def check_nearest_distance(answer: Callable[..., float]) -> None:
    """From there all is on the page, and from a little nearer it is not."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        points, towards, fov = rng.normal(size=(30, 3)), rng.normal(size=3), float(rng.uniform(10, 60))
        frame, found = _frame(towards, np.zeros(3)), answer(points, towards, fov)
        _, y, z = ((points * axis).sum(axis=1) for axis in frame)
        for d, inside in ((found * (1.0 + 1e-9), True), (found * (1.0 - 1e-6), False)):
            seen = (d > z).all() and (np.abs(y) * d <= d * np.tan(np.radians(fov) / 2.0) * (d - z)).all()
            assert seen == inside, "a point is off the page" if inside else "the eye could be nearer"
