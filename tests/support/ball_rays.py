"""Whether balls and boxes hide points, by sight rays in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.camera import Camera


@dataclass(frozen=True, eq=False)
class Sight:
    """By how many of the bodies each point (k,3) is hidden, and (k,) how close that is to being otherwise."""

    hidden_by: np.ndarray
    margin: np.ndarray


def sight(camera: Camera, points: np.ndarray, balls, boxes=()) -> Sight:
    """Rays from points to the eye among balls (centre, frame) and boxes (low, high)."""
    target, eye = np.asarray(camera.target), np.asarray(camera.eye)
    towards = np.broadcast_to(eye - target, points.shape) if camera.parallel else eye - points
    longest = np.inf if camera.parallel else 1.0
    count, margin, lies_on = np.zeros(len(points), dtype=int), np.full(len(points), np.inf), np.zeros(len(points))
    for centre, frame in balls:
        inverse = np.linalg.inv(frame)
        s, d = (points - centre) @ inverse, towards @ inverse
        a, b, c = (d * d).sum(1), (s * d).sum(1), (s * s).sum(1) - 1.0
        root = b * b - a * c
        # A point on the ball is hidden by it where it lies on its far side.
        on = np.abs(c) < 1e-6
        with np.errstate(invalid="ignore"):
            far = (-b + np.sqrt(root)) / a
            near = (-b - np.sqrt(root)) / a
        hidden = np.where(on, b < 0.0, (root > 0.0) & (far > 0.0) & (near < longest))
        count += hidden
        outline = np.minimum(np.abs(root) / a, np.where(root > 0.0, np.abs(c), np.inf))
        close = np.where(on, np.abs(b) / np.sqrt(a), outline)
        margin = np.minimum(margin, close)
        lies_on += on
    # Where three balls meet one of them begins to hide the curve of the others.
    margin[lies_on > 2] = 0.0
    for low, high in boxes:
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (low - points) / towards, (high - points) / towards
        enter, leave = np.nanmax(np.minimum(one, two), axis=1), np.nanmin(np.maximum(one, two), axis=1)
        inside = np.minimum(leave, longest) - np.maximum(enter, 0.0)
        count += inside > 0.0
        margin = np.minimum(margin, np.abs(inside))
    return Sight(count, margin)
