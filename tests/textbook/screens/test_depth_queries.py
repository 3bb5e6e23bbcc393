"""Is a point visible, which part of a line is, which plane a polygon lies in."""

from __future__ import annotations

import numpy as np
import pytest
from support.pixel_rays import beside_edges, first_triangles
from support.shaded_scenes import COLUMNS, ROWS, camera_of, floor, sample, triangles_of

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.clipping import Polygons
from vectorplot.geometry.solids import box
from vectorplot.shading.depth_buffers import depth_buffer, strip
from vectorplot.shading.screen import raster_system, screen_triangles
from vectorplot.textbook.framebuffer import depth_planes, points_visible, visible_line_pixels


def in_pixels(system, points):
    """Column, row and depth after T2."""
    h = system.homogeneous(points)
    return h[:, :3] / h[:, 3:]


@pytest.mark.capability("G7.3-visible-point")
@pytest.mark.parametrize("seed", [0, 1, 4, 5, 6, 7])
def test_points_are_visible_where_no_ray_to_the_eye_is_stopped(seed):
    points, corners = sample(seed)
    camera = camera_of(points, seed)
    system = raster_system(camera, COLUMNS, ROWS)
    buffer = depth_buffer(screen_triangles(system.homogeneous(points), corners), COLUMNS, ROWS)
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet((1, 1, 1), 3000)
    chosen = corners[rng.integers(len(corners), size=3000)]
    places = np.einsum("ik,ikj->ij", weights, points[chosen])
    seen = points_visible(buffer, in_pixels(system, places))
    way = np.broadcast_to(camera.direction, places.shape) if camera.parallel else np.asarray(camera.eye) - places
    way = way / np.linalg.norm(way, axis=1)[:, None]
    size = np.ptp(points, axis=0).max()
    origin = (places + 1e-4 * size * way).astype(np.float32)
    free = first_triangles(points, corners, origin, way) < 0
    column, row = np.rint(in_pixels(system, places)[:, :2]).astype(int).T
    inner = ~beside_edges(buffer.source)[np.clip(row, 0, ROWS - 1), np.clip(column, 0, COLUMNS - 1)]
    inside = (row >= 0) & (row < ROWS) & (column >= 0) & (column < COLUMNS)
    assert (seen == free)[inner & inside].mean() > 0.995
    assert (seen == free)[inside].mean() > 0.9
    assert not seen[~inside].any()


def test_a_point_in_front_is_visible_and_one_behind_is_not():
    points, corners = triangles_of(box((2, 2, 2)))
    camera = Camera((1, -8, 1), (1, 0, 1))
    system = raster_system(camera, COLUMNS, ROWS)
    flat = screen_triangles(system.homogeneous(points), corners)
    asked = in_pixels(system, np.array([(1, -1, 1), (1, 0, 1), (1, 1e-2, 1), (1, 4, 1), (9, 0, 1)], dtype=np.float64))
    assert points_visible(depth_buffer(flat, COLUMNS, ROWS), asked).tolist() == [True, True, False, False, False]
    lower = strip(flat, COLUMNS, ROWS, ROWS // 2, ROWS)
    assert not points_visible(lower, asked - (0, ROWS / 4, 0)).any(), "outside the strip"
    with pytest.raises(InputError, match="finite"):
        points_visible(lower, [(np.nan, 0, 0)])


@pytest.mark.capability("G7.3-line")
def test_the_hidden_part_of_a_line_is_not_set():
    points, corners = triangles_of(box((2, 2, 2)), floor(10.0, -0.5))
    camera = Camera((1, -8, 1), (1, 0, 1))
    system = raster_system(camera, COLUMNS, ROWS)
    buffer = depth_buffer(screen_triangles(system.homogeneous(points), corners), COLUMNS, ROWS)
    ends = in_pixels(system, np.array([(-1, 1, 1), (3, 1, 1), (-0.5, -1, 1), (2.5, -1, 1)], dtype=np.float64))
    behind, in_front = (visible_line_pixels(buffer, ends[k : k + 1], ends[k + 1 : k + 2]) for k in (0, 2))
    sides = in_pixels(system, np.array([(0, 0, 1), (2, 0, 1)], dtype=np.float64))[:, 0]
    middle = (behind[0] > sides[0] + 1) & (behind[0] < sides[1] - 1)
    assert not middle.any()
    assert (behind[0] < sides[0]).any()
    assert (behind[0] > sides[1]).any()
    assert len(in_front[0]) == abs(round(ends[3, 0]) - round(ends[2, 0])) + 1, "all of it, whichever way"
    assert (behind[2] == 0).all()


def test_lines_pierce_what_they_run_through():
    points, corners = triangles_of(box((2, 2, 2)))
    camera = Camera((1, -8, 1), (1, 0, 1))
    system = raster_system(camera, COLUMNS, ROWS)
    buffer = depth_buffer(screen_triangles(system.homogeneous(points), corners), COLUMNS, ROWS)
    line = in_pixels(system, np.array([(0.2, -2, 1), (1.8, 2, 1)], dtype=np.float64))
    column, _, _ = visible_line_pixels(buffer, line[:1], line[1:])
    entry = in_pixels(system, np.array([(1.0, 0, 1)], dtype=np.float64))[0, 0]
    assert abs(column.max() - entry) <= 2.0
    assert column.min() == round(line[0, 0])


@pytest.mark.capability("G7.3-plane")
def test_planes_go_through_all_corners():
    rng = np.random.default_rng(2)
    polygons, offsets, planes = [], [0], []
    for sides in rng.integers(3, 9, 200):
        a, b, c = rng.normal(size=3)
        xy = rng.uniform(-50, 50, (sides, 2))
        if sides > 4:
            xy[1] = xy[0]
            xy[2] = 2.0 * xy[3] - xy[0]
        polygons.append(np.column_stack([xy, a * xy[:, 0] + b * xy[:, 1] + c]))
        offsets.append(offsets[-1] + sides)
        planes.append((a, b, c))
    found = depth_planes(Polygons(np.concatenate(polygons), np.array(offsets)))
    assert np.abs(found - planes).max() < 1e-9


def test_a_polygon_seen_edge_on_has_no_plane():
    line = np.array([(0, 0, 1), (1, 1, 2), (3, 3, -1)], dtype=np.float64)
    found = depth_planes(Polygons(np.concatenate([line, line * (1, 2, 1) + (0, 1, 0)]), np.array([0, 0, 3, 6])))
    assert np.isnan(found).all()
