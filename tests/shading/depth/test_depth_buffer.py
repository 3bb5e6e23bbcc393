"""What is in front in each pixel: against rays, in any order, in strips, in 16 bits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.pixel_rays import beside_edges, first_triangles, pixel_rays
from support.shaded_scenes import COLUMNS, ROWS, camera_of, floor, sample, triangles_of

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box
from vectorplot.scene.item import Item
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.shading.depth_buffers import DepthCode, depth_buffer, depth_range, strips
from vectorplot.shading.screen import front_facing, raster_system, screen_triangles


def buffer_of(points, corners, camera, columns=COLUMNS, rows=ROWS, **options):
    flat = screen_triangles(raster_system(camera, columns, rows).homogeneous(points), corners)
    return depth_buffer(flat, columns, rows, **options)


@pytest.mark.capability("G7.3-zbuffer")
@pytest.mark.parametrize("seed", range(16))
def test_rays_see_the_same_triangles_but_next_to_edges(seed):
    points, corners = sample(seed)
    camera = camera_of(points, seed)
    seen = buffer_of(points, corners, camera).source
    origin, way = pixel_rays(camera, COLUMNS, ROWS)
    rays = first_triangles(points, corners, origin, way).reshape(ROWS, COLUMNS)
    assert (seen >= 0).mean() > 0.1
    assert (seen == rays).mean() > 0.95
    # A disagreement needs the other triangle, or the background, in a neighbouring pixel of one of the two pictures.
    wrong = seen != rays
    near = np.zeros_like(wrong)
    for picture, other in ((seen, rays), (rays, seen)):
        padded = np.pad(picture, 1, mode="edge")
        for down in range(3):
            for along in range(3):
                near |= padded[down : down + ROWS, along : along + COLUMNS] == other
    assert not (wrong & ~near & ~(beside_edges(seen) & beside_edges(rays))).any()


@pytest.mark.capability("G7.3-zbuffer")
@pytest.mark.parametrize("seed", [0, 3])
def test_the_order_of_the_triangles_changes_nothing(seed):
    points, corners = sample(seed)
    camera = camera_of(points, seed)
    order = np.random.default_rng(seed).permutation(len(corners))
    one, other = buffer_of(points, corners, camera), buffer_of(points, corners[order], camera)
    assert (one.code == other.code).all()
    assert (one.source == np.where(other.source >= 0, order[other.source], -1)).mean() > 0.999


@pytest.mark.capability("G7.3-zbuffer")
def test_of_equally_deep_triangles_the_first_is_kept():
    points = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], dtype=np.float64)
    camera = Camera((0, 0, 5), up=(0, 1, 0))
    seen = buffer_of(points, np.array([(0, 1, 2), (0, 1, 2)]), camera).source
    assert set(np.unique(seen)) == {-1, 0}


@pytest.mark.slow
@pytest.mark.capability("G7.3-strips")
@pytest.mark.parametrize("count", [2, 7, 120])
def test_strips_together_are_the_whole_picture(count):
    points, corners = sample(0)
    columns, rows = 160, 120
    flat = screen_triangles(raster_system(camera_of(points, 0), columns, rows).homogeneous(points), corners)
    whole = depth_buffer(flat, columns, rows)
    parts = list(strips(flat, columns, rows, count))
    assert [part.top for part in parts] == [rows * k // count for k in range(count)]
    assert (np.concatenate([part.code for part in parts]) == whole.code).all()
    assert (np.concatenate([part.triangle for part in parts]) == whole.triangle).all()


@pytest.mark.capability("G7.3-ushort")
def test_the_code_of_16_bits():
    code = DepthCode.ushort(-0.8, 4.0)
    assert code.code(0.37) == 16600, "test value TV70"
    assert code.code([-0.8, 4.0]).tolist() == [1000, 65000]
    rng = np.random.default_rng(1)
    depth = rng.uniform(-0.8, 4.0, 1000)
    assert (np.abs(code.depth(code.code(depth)) - depth) <= code.step).all()
    with pytest.raises(InputError, match="outside the range"):
        code.code(4.1)


def test_16_bits_show_the_wrong_triangle_in_few_pixels():
    points, corners = sample(1)
    camera = camera_of(points, 1)
    flat = screen_triangles(raster_system(camera, COLUMNS, ROWS).homogeneous(points), corners)
    fine = depth_buffer(flat, COLUMNS, ROWS)
    coarse = depth_buffer(flat, COLUMNS, ROWS, depth_code=DepthCode.ushort(*depth_range(flat)))
    assert coarse.code.max() <= 65000
    assert coarse.code[coarse.code > 0].min() >= 1000
    different = fine.source != coarse.source
    assert 0 < different.mean() < 0.01 or not different.any()
    assert (np.abs(fine.depth[fine.code > 0] - coarse.depth[fine.code > 0]) <= 2.0 * coarse.depth_code.step).all()


@pytest.mark.capability("G7.3-backface")
def test_back_faces_of_closed_convex_bodies_may_be_skipped():
    points, corners = triangles_of(box((1, 2, 3)))
    camera = Camera((5, -7, 6), (0.5, 1, 1.5))
    kept = front_facing(points, corners, (*camera.eye, 1.0))
    assert 0 < kept.sum() < len(corners)
    all_of_it, fronts = buffer_of(points, corners, camera), buffer_of(points, corners[kept], camera)
    assert ((all_of_it.code > 0) == (fronts.code > 0)).all()
    assert (np.flatnonzero(kept)[fronts.source[fronts.source >= 0]] == all_of_it.source[all_of_it.source >= 0]).all()


@pytest.mark.hard(5)
@pytest.mark.parametrize("seed", range(6))
def test_what_reaches_behind_the_eye_is_cut_and_the_rest_is_right(seed):
    rng = np.random.default_rng(seed)
    points, corners = triangles_of(floor(50.0, -1.0), box((1, 1, 1)), floor(20.0, 1.5))
    camera = Camera((*rng.uniform(-3, 3, 2), 0.4), (0.5, 0.5, 0.2), fov_deg=60.0)
    seen = buffer_of(points, corners, camera).source
    origin, way = pixel_rays(camera, COLUMNS, ROWS)
    rays = first_triangles(points, corners, origin, way).reshape(ROWS, COLUMNS)
    wrong = (seen != rays) & ~beside_edges(seen) & ~beside_edges(rays)
    assert not wrong.any()
    assert (seen >= 0).mean() > 0.5


def test_cut_neighbours_leave_no_gap():
    rng = np.random.default_rng(5)
    line = np.linspace(-4.0, 4.0, 30)
    x, y = np.meshgrid(line, line, indexing="ij")
    flat = np.stack([x + rng.uniform(-0.05, 0.05, x.shape), y, np.full(x.shape, -0.3)], axis=-1).reshape(-1, 3)
    at = np.arange(900).reshape(30, 30)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    camera = Camera((0, 0, 0.3), (0, 1, -2), fov_deg=100.0)
    inside = buffer_of(flat, corners, camera, 400, 400).source >= 0
    rows = np.flatnonzero(inside.any(axis=1))
    for row in rows[5:]:
        columns = np.flatnonzero(inside[row])
        assert len(columns) == columns[-1] - columns[0] + 1, "no hole within a row"


@pytest.mark.hard(18, 19)
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_scale_and_place_of_the_scene_change_nothing(scale, shift):
    points, corners = sample(0)
    camera = camera_of(points, 0)
    moved = Camera(
        tuple(scale * np.array(camera.eye) + shift), tuple(scale * np.array(camera.target) + shift), fov_deg=35.0
    )
    one = buffer_of(points, corners, camera).source
    other = buffer_of(scale * points + shift, corners, moved).source
    assert ((one == other) | beside_edges(one)).all()


def test_nothing_at_all_and_what_is_refused():
    none = np.zeros((0, 3))
    camera = Camera((0, 0, 5), up=(0, 1, 0))
    empty = buffer_of(none, np.zeros((0, 3), dtype=np.intp), camera)
    assert not empty.code.any()
    assert (empty.triangle == -1).all()
    assert (empty.depth == -np.inf).all()
    with pytest.raises(InputError, match="finite"):
        buffer_of([(np.nan, 0, 0)] * 3, [(0, 1, 2)], camera)
    with pytest.raises(InputError, match="names point"):
        buffer_of([(0, 0, 0)] * 3, [(0, 1, 7)], camera)
    with pytest.raises(InputError, match="raster"):
        buffer_of(none, [], camera, 0, 10)
    with pytest.raises(InputError, match="too large"):
        buffer_of(none, [], camera, 32000, 32000)


@pytest.mark.parametrize("bits", range(16, 63))
def test_a_code_has_room_for_the_numbers_of_the_triangles_or_is_refused(bits):
    camera = Camera((0, 0, 10), up=(0, 1, 0))
    points = [(x, y, z) for z in (0, 1) for x, y in ((-9, -9), (9, -9), (0, 9))]
    code = DepthCode.fine(-1.0, 1.0, bits)
    if bits >= 60:
        with pytest.raises(InputError, match="no room for the numbers of 2 triangles"):
            buffer_of(points, [(0, 1, 2), (3, 4, 5)], camera, depth_code=code)
    else:
        found = buffer_of(points, [(0, 1, 2), (3, 4, 5)], camera, depth_code=code)
        assert found.triangle[ROWS // 2, COLUMNS // 2] == 1


def test_the_default_camera_sees_all_of_a_mesh():
    points, corners = sample(2)
    camera = default_camera(Scene((Item("all", Mesh.from_triangles(points, corners)),)))
    seen = buffer_of(points, corners, camera).source
    assert not (seen[[0, -1]] >= 0).any()
    assert (seen >= 0).any()


@pytest.mark.hard(24)
@pytest.mark.parametrize("seed", range(6))
def test_depths_are_those_of_the_true_triangle_wherever_its_corners_are_snapped_to(seed):
    """As steep as they come, down to the rounding of doubles: so the nearer of two planes is known at any gap."""
    random = np.random.default_rng(seed)
    corners = random.uniform((0.0, 0.0, -1.0), (COLUMNS, ROWS, 1.0), (12, 3, 3))
    points = np.concatenate([corners.reshape(-1, 3), np.ones((36, 1))], axis=1)
    points[:, 2] *= 10.0 ** random.uniform(-3, 3)
    flat = screen_triangles(points, np.arange(36).reshape(-1, 3))
    for number in range(len(flat)):
        one = replace(flat, corners=flat.corners[number : number + 1], source=flat.source[number : number + 1])
        found = depth_buffer(one, COLUMNS, ROWS)
        row, column = np.nonzero(found.triangle >= 0)
        a, b, c = one.points[one.corners[0]]
        by_x, by_y = np.linalg.solve(np.array([b - a, c - a])[:, :2], np.array([b - a, c - a])[:, 2])
        true = a[2] + by_x * (column - a[0]) + by_y * (row - a[1])
        longest = max(np.hypot(*(p - q)[:2]) for p, q in ((a, b), (b, c), (c, a)))
        thin = abs(np.linalg.det(np.array([b - a, c - a])[:, :2])) / longest
        if thin > 0.1:
            assert np.abs(found.depth[row, column] - true).max() < 1e-11 * np.ptp(one.points[:, 2])
