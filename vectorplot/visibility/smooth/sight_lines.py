"""Sight lines and images of points, and of directions at points."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.scene.view import View
from vectorplot.tolerances import ULP


def sight(view: View, points: Floats) -> Floats:
    """(k,3) vectors to the eye, or in a parallel projection the unit vector towards it."""
    if view.eye is None:
        return np.asarray(np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape))
    return np.asarray(view.eye - points)


def rounding(view: View) -> float:
    """How large the rounding of points in the view's coordinates is: a scene far from the origin has few digits."""
    return float(ULP * (1.0 + np.abs(view.centre).max() / view.scale))


def image(view: View, points: Floats) -> Floats:
    """(k,2) images of points (k,3)."""
    return np.asarray(view.image_of(points.T).T)


def depth(view: View, points: Floats) -> Floats:
    """(k,) depths of points (k,3)."""
    return view.depth_of(points.T)


def image_slopes(view: View, points: Floats, directions: Floats) -> Floats:
    """(k,2) how the images of points (k,3) move when the points move with the velocities directions (k,3)."""
    if view.eye is None:
        return directions[:, :2]
    away = np.maximum(depth(view, points), view.near)[:, None]
    return (directions[:, :2] + (points[:, :2] - view.eye[:2]) * directions[:, 2:] / away) * (view.focus / away)
