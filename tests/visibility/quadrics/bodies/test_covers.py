"""What balls hide, as boxes in the image and as signs of forms."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import ball_of
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.visibility.quadrics.bodies import balls_of
from vectorplot.visibility.quadrics.occlusion_volumes import ball_occlusion_volumes, disc_boxes


def balls_at(shapes, camera):
    items = [Item(str(k), shape) for k, shape in enumerate(shapes)]
    view = look(Scene(tuple(items)), camera)
    return balls_of(view, items, np.arange(len(items)), [ball_of(shape) for shape in shapes])


CAMERAS = [Camera(eye=(9, -7, 4)), Camera(eye=(9, -7, 4), parallel=True), Camera(eye=(9e4, -7e4, 4e4))]


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-6])
def test_boxes_of_outlines_are_reached_and_not_left_however_small(camera, size):
    shapes = [Ellipsoid((size, 2.0 * size, 0.5 * size), centre) for centre in ((0, 0, 0), (1, 2, -1), (-3, 0.5, 0.7))]
    balls = balls_at(shapes, camera)
    middle, first, second = balls.contours(np.arange(3))
    low, high = disc_boxes(balls.sight, middle, first, second)
    t = np.linspace(0.0, 2.0 * np.pi, 2001)[:, None, None]
    arm = np.cos(t) * first + np.sin(t) * second
    depth = middle[:, 2:] + arm[..., 2:] if balls.sight.central else np.ones_like(arm[..., 2:])
    # From the image of the middle, for the sizes are far below the digits of the places.
    start = middle[:, :2] / (middle[:, 2:] if balls.sight.central else 1.0)
    image = (arm[..., :2] - (start * arm[..., 2:] if balls.sight.central else 0.0)) / depth
    extent = np.ptp(image, axis=0).max()
    assert low.T - start == pytest.approx(image.min(axis=0), abs=1e-5 * extent + 1e-15)
    assert high.T - start == pytest.approx(image.max(axis=0), abs=1e-5 * extent + 1e-15)


@pytest.mark.parametrize("camera", CAMERAS[:2])
def test_forms_are_positive_in_what_is_hidden_and_nowhere_else(camera):
    balls = balls_at([Ellipsoid((1.0, 2.0, 0.5), (1, 1, 0)), Sphere(1.5, (-2, 0, 0))], camera)
    behind, inside = ball_occlusion_volumes(balls, np.arange(2))
    reach, centre = balls.reach.max(), balls.centre.mean(axis=0)
    points = centre + np.random.default_rng(2).uniform(-4.0, 4.0, (20000, 3)) * reach
    for k in range(2):
        s = (points - balls.centre[k]) @ balls.inverse[k]
        towards = balls.eye[k] - s if balls.sight.central else np.broadcast_to(balls.eye[k], s.shape)
        a, b, c = (towards * towards).sum(axis=1), (s * towards).sum(axis=1), (s * s).sum(axis=1) - 1.0
        with np.errstate(invalid="ignore"):
            leaving = (-b + np.sqrt(b * b - a * c)) / a
        truth = leaving > 0.0
        if balls.sight.central:
            truth &= ((-b - np.sqrt(np.maximum(b * b - a * c, 0.0))) / a) < 1.0
        one = np.concatenate([points, np.ones((len(points), 1))], axis=1)
        hidden = np.zeros(len(points), dtype=bool)
        for volume in (behind, inside):
            square = (one @ volume.squares[0, :, k]) ** 2 - sum((one @ form[:, k]) ** 2 for form in volume.squares[1:])
            hidden |= (square > 0.0) & (one @ volume.linear[:, :, k].T > 0.0).all(axis=1)
        assert (hidden == truth).all()


def test_tiny_balls_far_away_are_hidden_as_large_ones_nearby():
    def picture(size):
        rng = np.random.default_rng(8)
        places, radii = rng.uniform(-1.0, 1.0, (25, 3)) * size, rng.uniform(0.1, 0.4, 25) * size
        items = [
            Item(str(k), Sphere(r, c)) for k, (r, c) in enumerate(zip(radii.tolist(), places.tolist(), strict=True))
        ]
        return draw(Scene(tuple(items)), Camera(eye=(4.0e5, -9.0e5, 3.0e5)), curves="polyline")

    one, two = (
        [(len(paths), paths.points) for layer in picture(size).layers for paths in layer.strokes] for size in (1.0, 1e2)
    )
    assert [count for count, _ in one] == [count for count, _ in two]
