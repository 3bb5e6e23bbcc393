"""What errors are measured with: places on the page, and distances of points from curves."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.unit_projection import projection_of
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import box_corners, fitted_picture
from vectorplot.testing.curve_distance import Segments, Tree
from vectorplot.testing.curve_points import Curves


def page_from_world(camera: Camera, bounds: Floats) -> Floats:
    """(4,4) the matrix from the world to mm on the usual sheet, which the box bounds (2,3) fills."""
    projection = projection_of(camera, bounds)
    image = projection.image_of(projection.points_of(box_corners(bounds)))
    return fitted_picture(projection, Page(), image).page_from_world


def on_page(matrix: Floats, points: Floats) -> Floats:
    """(...,2) points (...,3) of the world in mm."""
    place = matmul(np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1), matrix.T)
    return np.asarray(place[..., :2] / place[..., 3:])


def farthest(points: Floats, curves: Curves) -> float:
    """How far that of the points (n,d) is from curves that is farthest from them."""
    return float(Tree(Segments.of(curves, False).ends).nearest(points, 0.0)[0].max(initial=0.0))
