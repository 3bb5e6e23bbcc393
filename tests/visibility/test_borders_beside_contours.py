"""Borders that go behind their own surface, beside its contour, at the place that quadratic equations tell."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn import drawn
from support.effort import several
from support.smooth_scenes import lit, mixed_scenes, views

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.surface import Domain
from vectorplot.testing.drawings import stroke_points

SIZE = 1.5
"""Half the side of the square over which graphs stand."""


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.02, 0.001])
def test_the_border_of_a_saddle_is_hidden_from_where_the_contour_ends_on_it(tolerance: float) -> None:
    """z = x^2 / a^2 - y^2 / b^2 at x = c: the sight line touches the surface where that from the eye e has a double
    root. From there on the border's image is beside the contour's, a four-thousandth of the extent at most."""
    scene = mixed_scenes()["saddle through a torus"]
    camera = next(views(scene, 2, 61))
    (x, y, z), a, b, c = camera.eye, 1.6, 1.3, 2.6
    place = y + np.sqrt(y**2 + b**2 * (z + c**2 / a**2 - 2.0 * c * x / a**2))
    drawing = draw(scene, camera, hidden="solid", lines="contour,boundary", tolerance_mm=tolerance)
    pieces = drawn(drawing).of(1).of_kind("boundary")
    pieces = pieces.where((np.abs(pieces.world[..., 0] - c) < 1e-9).all(axis=1))
    seen, hidden = (some.world[..., 1] for some in (pieces.visible, pieces.hidden))
    assert abs(seen.max() - place) < 1e-9 and abs(hidden.min() - place) < 1e-9


class HoledGraph:
    """z = (x, y, 1) Q (x, y, 1) over a square, but for an ellipse in it."""

    def __init__(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        self.form = random.normal(size=(3, 3))
        self.middle, self.half = random.uniform(-0.3, 0.3, 2), random.uniform(0.4, 0.9, 2)
        surface = graph(self.z_or_hole, Domain(-SIZE, SIZE, -SIZE, SIZE))
        self.scene = lit(Item("graph", surface))

    def z_or_hole(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.where(self.off(x, y) < 0.0, np.nan, self.z(x, y))

    def z(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        at = np.stack([x, y, np.ones_like(x)])
        return np.einsum("i...,ij,j...->...", at, self.form, at)

    def off(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Negative in the hole."""
        return ((x - self.middle[0]) / self.half[0]) ** 2 + ((y - self.middle[1]) / self.half[1]) ** 2 - 1.0

    def hidden(self, camera: Camera, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n,) whether the sight lines from points (n,3) of it meet it again, and how far from where they would not."""
        eye = np.array(camera.eye)
        way = np.broadcast_to(eye - camera.target, points.shape) if camera.parallel else eye - points
        # z is quadratic along the line, and at t = 0 it is that of the point.
        near, far = (self.z(*(points + t * way)[:, :2].T) - (points + t * way)[:, 2] for t in (-1.0, 1.0))
        t = -(far - near) / (far + near)
        x, y = (points + t[:, None] * way)[:, :2].T
        ends = [np.abs(t) * np.linalg.norm(way, axis=1), SIZE - np.abs(x), SIZE - np.abs(y), 0.3 * self.off(x, y)]
        met = (t > 0.0) & np.all([end > 0.0 for end in ends], axis=0)
        return met & (t < (np.inf if camera.parallel else 1.0)), np.min(np.abs(ends), axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_borders_and_rims_of_holes_are_hidden_as_in_closed_form(seed: int) -> None:
    shape = HoledGraph(seed)
    cameras = list(views(shape.scene, 2, seed))
    # From an eye and in parallel in turn, or both ways.
    for camera in cameras if several(1, long=2) == 2 else [cameras[seed % 2]]:
        drawing = draw(shape.scene, camera, hidden="solid", tolerance_mm=0.005)
        found = stroke_points(drawing, shape.scene, camera, 1500, seed)
        met, clear = shape.hidden(camera, found.points)
        sure = clear > np.where(found.aside > 0.0, 6e-3, 3e-4)
        assert sure.sum() > 1000
        assert np.array_equal(met[sure], found.hidden_by[sure] > 0)
