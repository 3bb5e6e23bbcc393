"""Weights of the corners at visible points, against rays through the pixels' centres."""

from __future__ import annotations

import numpy as np
import pytest
from support.pixel_rays import pixel_rays
from support.shaded_scenes import COLUMNS, ROWS, camera_of, sample

from vectorplot.errors import InputError
from vectorplot.shading.depth_buffers import depth_buffer
from vectorplot.shading.lighting import visible_points
from vectorplot.shading.screen import raster_system, screen_triangles


@pytest.mark.parametrize("seed", range(8))
def test_visible_points_lie_on_the_rays_of_their_pixels_and_in_their_triangles(seed):
    points, corners = sample(seed)
    camera = camera_of(points, seed)
    homogeneous = raster_system(camera, COLUMNS, ROWS).homogeneous(points)
    buffer = depth_buffer(screen_triangles(homogeneous, corners), COLUMNS, ROWS)
    found = visible_points(buffer, homogeneous, corners)
    assert len(found) == (buffer.triangle >= 0).sum()
    assert (found.weights >= 0.0).all()
    assert np.abs(found.weights.sum(axis=1) - 1.0).max() < 1e-12
    space = found.interpolated(points)
    origin, way = (part[found.pixel] for part in pixel_rays(camera, COLUMNS, ROWS))
    arm = space - origin
    off = np.linalg.norm(arm - (arm * way).sum(axis=1)[:, None] * way, axis=1)
    # Well inside a triangle nothing was moved to the border.
    inner = found.weights.min(axis=1) > 1e-6
    assert inner.mean() > 0.5
    assert off[inner].max() < 1e-9 * np.ptp(points, axis=0).max()


def test_a_buffer_of_other_triangles_is_refused():
    points, corners = sample(2)
    homogeneous = raster_system(camera_of(points, 2), COLUMNS, ROWS).homogeneous(points)
    buffer = depth_buffer(screen_triangles(homogeneous, corners), COLUMNS, ROWS)
    with pytest.raises(InputError, match="other triangles"):
        visible_points(buffer, homogeneous, corners[:1])
