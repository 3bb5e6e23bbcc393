"""Straight curves, a sphere and its sheet in a parallel view along z, in the coordinates of which they are given."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.visibility.smooth.curve_families import StraightLines
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.sheets import ParametricSheet
from vectorplot.visibility.smooth.traced_curves import Curves
from vectorplot.words import LineKind


def ball_from_above() -> tuple[View, ParametricSheet, float]:
    """A view from above on a sphere about the origin, its sheet, and its radius there."""
    shape = Sphere(1.0)
    view = look(
        Scene((Item("ball", shape),)), Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), parallel=True)
    )
    return view, sheets_of_parametrised(view, shape, 0, True)[0], 1.0 / view.scale


def polylines(*lines: object, closed: bool = False, kind: LineKind = LineKind.CURVE) -> Curves:
    """Curves that are their own chords."""
    arrays = [np.asarray(line, dtype=np.float64).reshape(-1, 3) for line in lines]
    points, many = np.concatenate(arrays), len(arrays)
    return Curves(
        points,
        points,
        np.full_like(points, np.nan),
        np.concatenate([[0], np.cumsum([len(a) for a in arrays])]).astype(np.intp),
        np.full(many, closed),
        np.full(many, int(kind)),
        np.zeros(many, dtype=np.intp),
        np.zeros(many, dtype=np.intp),
        np.zeros(many),
        (StraightLines(),),
    )


def around(count: int, radius: float = 1.0, height: float = 0.0) -> np.ndarray:
    """(count + 1, 3) points of a circle, the first one again at the end."""
    t = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points = np.stack([radius * np.cos(t), radius * np.sin(t), np.full_like(t, height)], axis=1)
    points[-1] = points[0]
    return points
