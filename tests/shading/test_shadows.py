"""Shadow buffers and exact shadows: against rays, and the buffers against the exact ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.pixel_rays import stopped
from support.shaded_scenes import (
    COLUMNS,
    FIELD_CAMERA,
    ROWS,
    box,
    camera_of,
    field,
    floor,
    sample,
    triangles_of,
    visible,
)

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.scene.light import Light, is_amid
from vectorplot.shading import shadow_maps as maps
from vectorplot.shading.map_settings import MapSettings
from vectorplot.shading.screen import raster_system
from vectorplot.shading.seen_region import focus_of_depths, region_in_picture, seen_region
from vectorplot.shading.shadow_maps import (
    LONGEST,
    ShadowBuffer,
    aimed_system,
    in_texels,
    light_plane,
    perspective_frame,
    shadow_buffer,
    shadow_map,
    shape_of,
    standard_frame,
    trapezoid_frame,
)
from vectorplot.shading.shadow_rays import blocked_exactly
from vectorplot.shading.trapezoids import focus_area, projective_images
from vectorplot.testing.shapes import bumpy_icosphere
from vectorplot.textbook.trapezoid_maps import texels_per_unit, vertices_with_own_depth

SUN = Light((1.0, -1.5, 2.0), parallel=True)
FAR_LAMP = Light((20.0, -30.0, 40.0))
LAMPS = [SUN, FAR_LAMP, Light((0.4, 0.3, 1.9))]


def bounds(points):
    return np.array([points.min(axis=0), points.max(axis=0)])


@pytest.mark.spread
@pytest.mark.parametrize("light", LAMPS, ids=["sun", "lamp", "lamp in the scene"])
@pytest.mark.parametrize("seed", [0, 2, 3, 4])
def test_exact_shadows_are_those_of_rays(seed, light):
    points, corners = sample(seed)
    found, places, normals = visible(points, corners, camera_of(points, seed))
    rays, facing = stopped(points, corners, places, normals, light)
    exact = blocked_exactly(light, places, found.triangle, points, corners)
    # Rays of single precision start a little above the faces: they differ along the shadows' borders.
    assert (exact != rays)[facing].mean() < 0.003
    assert exact[facing].any() or seed == 3, "the graph is too flat"


@pytest.mark.slow
@pytest.mark.capability("G8.6-shadow-buffer")
@pytest.mark.spread
@pytest.mark.parametrize("light", LAMPS, ids=["sun", "lamp", "lamp in the scene"])
@pytest.mark.parametrize("seed", [0, 2, 3])
def test_shadow_buffers_agree_with_exact_shadows_and_larger_ones_more(seed, light):
    points, corners = sample(seed)
    found, places, normals = visible(points, corners, camera_of(points, seed))
    exact = blocked_exactly(light, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, light)
    wrong = [
        (shadow_buffer(light, points, corners, size=size).blocks(places, normals) != exact)[facing].mean()
        for size in (128, 256, 1024)
    ]
    assert wrong[2] < 0.004
    assert wrong[0] > wrong[1] > wrong[2] or wrong[0] < 1e-4


@pytest.mark.capability("G8.6-shadow-buffer")
def test_small_buffers_of_16_and_8_bits():
    points, corners = sample(2)
    found, places, normals = visible(points, corners, camera_of(points, 2))
    exact = blocked_exactly(SUN, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, SUN)
    wrong = {}
    for bits, size in ((32, 500), (16, 500), (8, 250)):
        buffer = shadow_buffer(SUN, points, corners, size=size, bits=bits)
        assert buffer.maps[0].code.dtype == np.dtype(f"uint{bits}")
        wrong[bits] = (buffer.blocks(places, normals) != exact)[facing].mean()
    assert wrong[16] < 1.2 * wrong[32] + 1e-3
    assert wrong[8] < 0.02


def test_the_bias_follows_the_slope():
    points, corners = triangles_of(bumpy_icosphere(4))
    found, places, normals = visible(points, corners, camera_of(points, 1))
    exact = blocked_exactly(SUN, places, found.triangle, points, corners)
    buffer = shadow_buffer(SUN, points, corners, size=256)
    _, facing = stopped(points, corners, places, normals, SUN)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(maps, "SLOPE_BIAS", 0.0)
        patch.setattr(maps, "MAP_BIAS", 0.0)
        acne = (buffer.blocks(places, normals) & ~exact)[facing].mean()
    assert acne > 0.25, "without any bias a good part of what is lit hides itself"
    assert (buffer.blocks(places, normals) & ~exact)[facing].mean() < 0.02


def test_a_convex_body_casts_no_shadow_on_itself():
    points, corners = triangles_of(box((0, 0, 0), (1, 2, 3)))
    for light in (SUN, FAR_LAMP):
        found, places, normals = visible(points, corners, Camera((4, -9, 7), (0.5, 1, 1.5)))
        _, facing = stopped(points, corners, places, normals, light)
        assert not shadow_buffer(light, points, corners, size=300).blocks(places, normals)[facing].any()
        assert not blocked_exactly(light, places, found.triangle, points, corners)[facing].any()


@pytest.mark.slow
@pytest.mark.capability("N6-z", "N2-orientation")
@pytest.mark.spread
@pytest.mark.parametrize("frame", ["standard", "trapezoid"])
@pytest.mark.parametrize("light", [SUN, FAR_LAMP], ids=["parallel", "lamp"])
@pytest.mark.parametrize("seed", range(3))
def test_faces_that_turn_away_need_no_margin_and_all_faces_do(frame, light, seed):
    """Closed bodies on a closed floor: front faces culled while the map is made, no acne without any correction."""
    random = np.random.default_rng(seed)
    lows = np.concatenate([random.uniform(-2, 2, (5, 2)), np.zeros((5, 1))], axis=1)
    boxes = [box(low, low + random.uniform(0.3, 1.2, 3)) for low in lows]
    points, corners = triangles_of(box((-5, -5, -0.6), (5, 5, -0.1)), *boxes)
    camera = Camera((5, -9, 8), (0.5, 0.5, 0))
    found, places, normals = visible(points, corners, camera)
    exact = blocked_exactly(light, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, light)
    region = seen_region(raster_system(camera, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points))
    options = {"size": 512, "frame": frame, "region": region}
    away = shadow_buffer(light, points, corners, casting="away", **options)
    assert not away.maps[0].biased
    assert (away.blocks(places, normals) != exact)[facing].mean() < 0.02
    acne = shadow_buffer(light, points, corners, **options)
    acne = ShadowBuffer(tuple(replace(one, biased=False) for one in acne.maps))
    assert (acne.blocks(places, normals) != exact)[facing].mean() > 0.1


@pytest.mark.capability("N6-z")
@pytest.mark.parametrize("shift", [0.0, 1e3, 1e6])
def test_the_scene_is_centred_before_a_light(shift):
    """Wherever it stands, depths count from the middle of the scene: nothing of their digits is lost."""
    points, corners = triangles_of(box((0, 0, 0), (1, 1, 1)), floor(4.0, -0.5))
    one, other = (shadow_buffer(SUN, points + move, corners, size=64).maps[0] for move in (0.0, shift))
    middle = points.mean(axis=0)
    assert np.allclose(other.system.rotated(middle + shift), one.system.rotated(middle), atol=1e-6)
    assert (one.code > 0).mean() == pytest.approx((other.code > 0).mean(), abs=0.01)


@pytest.mark.hard(18, 19)
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_scale_and_place_change_no_shadow(scale, shift):
    points, corners = sample(2)
    camera = camera_of(points, 2)
    moved = Camera(
        tuple(scale * np.array(camera.eye) + shift),
        tuple(scale * np.array(camera.target) + shift),
        fov_deg=35.0,
        parallel=camera.parallel,
    )
    results = []
    for s, t, eye in ((1.0, 0.0, camera), (scale, shift, moved)):
        p = s * points + t
        found, places, normals = visible(p, corners, eye)
        light = Light(tuple(s * np.array(FAR_LAMP.position) + t))
        shadows = [shadow_buffer(light, p, corners, size=256).blocks(places, normals)]
        shadows.append(blocked_exactly(light, places, found.triangle, p, corners))
        pictures = np.zeros((2, ROWS * COLUMNS), dtype=bool)
        pictures[:, found.pixel] = shadows
        results.append(pictures)
    assert (results[0] != results[1]).mean(axis=1).max() < 2e-4


@pytest.mark.capability("N2-ppsl")
def test_the_lamps_plane_of_sun_and_lamp():
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (20, 3))
    system = CoordinateSystem.of_light((3, 4, 12), (0, 0, 0))
    images = light_plane(system, points)
    shadow = system.to_world(np.column_stack([images, np.zeros(20)]))
    lamp = np.array([3.0, 4.0, 12.0])
    assert np.abs(shadow @ (lamp / 13.0)).max() < 1e-12, "in the plane through the target"
    assert np.abs(np.cross(points - lamp, shadow - lamp)).max() < 1e-10, "lamp, point and shadow on a line"
    sun = CoordinateSystem.of_parallel_light((3, 4, 12))
    shadow = sun.to_world(np.column_stack([light_plane(sun, points), np.zeros(20)]))
    assert np.abs(np.cross(points - shadow, lamp)).max() < 1e-12
    with pytest.raises(InputError, match="neutral plane"):
        light_plane(system, [(6, 8, 24)])


@pytest.mark.slow
@pytest.mark.capability("R-zcorr")
@pytest.mark.parametrize("light", [SUN, Light((60.0, -90.0, 150.0))], ids=["sun", "lamp"])
def test_depths_of_a_tapered_map_are_the_lamps_own(light):
    points, corners = field()
    region = seen_region(raster_system(FIELD_CAMERA, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points))
    system = aimed_system(light, points)
    tapered = shadow_map(system, trapezoid_frame(system, region, 0.8), points, corners, 700, 700)
    assert np.ptp(tapered.texel_from_light[2, :2]) > 0.0, "it has a taper"
    row, column = np.nonzero(tapered.code)
    at = np.column_stack([column, row, np.ones(len(row))]) @ tapered.light_from_texel.T
    places = system.to_world(np.column_stack([at[:, :2] / at[:, 2:], unscaled(system, tapered.depth[row, column])]))
    assert (np.abs(places[:, 2]) < 1e-3).mean() > 0.5, "the floor is where it is, near the eye and far away"
    assert places[:, 2].min() > -1e-3
    assert places[:, 2].max() < points[:, 2].max() + 1e-3


@pytest.mark.capability("R-zcorr")
@pytest.mark.parametrize("light", [SUN, Light((60.0, -90.0, 150.0))], ids=["sun", "lamp"])
def test_depths_put_right_at_the_vertices_are_right_only_there(light):
    points, corners = triangles_of(floor(100.0, 0.0))
    region = seen_region(
        raster_system(FIELD_CAMERA, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points) + np.array([[0.0], [4.0]])
    )
    system = aimed_system(light, points)
    tapered = shadow_map(system, trapezoid_frame(system, region, 0.8), points, corners, 200, 200)
    inner = np.array([(x, y, 0.0) for x in (-5.0, 5.0) for y in (-80.0, -40.0, 20.0)])
    true = system.homogeneous(inner)
    found = vertices_with_own_depth(system, tapered.texel_from_light, inner)
    assert np.allclose(found[:, 2] / found[:, 3], true[:, 2] / true[:, 3], rtol=1e-12, atol=1e-12)
    # Between the corners of the large floor such depths bend, those of the map do not.
    column, row = np.rint(found[:, :2] / found[:, 3:]).astype(int).T
    at = np.column_stack([column, row, np.ones(len(row))]) @ tapered.light_from_texel.T
    places = np.column_stack([at[:, :2] / at[:, 2:], unscaled(system, tapered.depth[row, column])])
    assert np.abs(system.to_world(places)[:, 2]).max() < 3e-3
    rim = vertices_with_own_depth(system, tapered.texel_from_light, points[corners[0]])
    flat = np.column_stack([rim[:, :2] / rim[:, 3:], np.ones(3)])
    bent = np.column_stack([column, row, np.ones(len(row))]) @ np.linalg.solve(flat, rim[:, 2] / rim[:, 3])
    assert np.abs(bent - tapered.depth[row, column]).max() > 100 * tapered.depth_code.step


def unscaled(system, depth):
    """Depth in the system of depths after T2."""
    return depth if not np.isfinite(system.distance) else system.distance * depth / (1.0 + depth)


@pytest.mark.slow
@pytest.mark.capability("R-two-pass", "RN-in-B8.6", "R-demos", "N2-eta", "R-psm")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize(
    "light",
    [SUN, Light((-1.0, -0.3, 1.2), parallel=True), Light((0.05, 1.0, 0.8), parallel=True), Light((60.0, -90.0, 150.0))],
    ids=["behind", "side", "against", "lamp"],
)
def test_the_trapezoid_shows_more_of_what_is_near_and_the_same_shadows(light):
    points, corners = field()
    found, places, normals = visible(points, corners, FIELD_CAMERA, 200, 150)
    region = seen_region(raster_system(FIELD_CAMERA, 200, 150), 200, 150, bounds(points))
    exact = blocked_exactly(light, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, light)
    distance = np.linalg.norm(places - FIELD_CAMERA.eye, axis=1)
    near = distance <= np.quantile(distance, 0.1)
    texels, wrong, shadows = {}, {}, {}
    for frame in ("standard", "box", "trapezoid", "perspective"):
        buffer = shadow_buffer(light, points, corners, size=1024, frame=frame, region=region)
        shadows[frame] = buffer.blocks(places, normals)
        texels[frame] = texels_per_unit(buffer.maps[0], places[near]).mean()
        coarse = shadow_buffer(light, points, corners, size=256, frame=frame, region=region)
        bad = coarse.blocks(places, normals) != exact
        wrong[frame] = (bad[near & facing].mean(), bad[facing].mean())
    plain = shadow_buffer(light, points, corners, size=2048).blocks(places, normals)
    assert (shadows["trapezoid"] == plain)[facing].mean() > 0.98
    assert (shadows["perspective"] == plain)[facing].mean() > 0.98
    assert texels["perspective"] > 4.0 * texels["trapezoid"]
    assert texels["trapezoid"] > 8.0 * texels["standard"]
    assert texels["trapezoid"] > 4.0 * texels["box"] >= 4.0 * texels["standard"]
    # One pixel of all that is near may be wrong by chance.
    assert wrong["trapezoid"][0] < 0.6 * wrong["standard"][0] + 1.5 / (near & facing).sum(), "near the eye"
    assert wrong["trapezoid"][1] < wrong["standard"][1], "and in all"
    assert wrong["perspective"][0] < 0.6 * wrong["standard"][0] + 1.5 / (near & facing).sum()
    assert wrong["perspective"][1] < wrong["standard"][1]


@pytest.mark.capability("R-psm")
@pytest.mark.parametrize("side", [0.0, 0.7, -2.0])
def test_a_perspective_map_shows_the_ground_as_evenly_as_the_picture_does(side):
    points, corners = triangles_of(floor(30.0, 0.0))
    camera = Camera((0.0, -40.0, 3.0), (0.0, 0.0, 3.0), fov_deg=40.0)
    system = raster_system(camera, 300, 200)
    region = region_in_picture(system, 300, 200, points, corners)
    # Across the view, so that the perspective leaves its rays parallel.
    lamp = aimed_system(Light((side, 0.0, 1.0), parallel=True), points)
    frame = perspective_frame(lamp, region)
    x, y = np.meshgrid([-3.0, 0.0, 3.0], [-20.0, -5.0, 25.0])
    ground = np.column_stack([x.ravel(), y.ravel(), np.zeros(9)])
    image = system.homogeneous(ground)
    image = image[:, :2] / image[:, 3:]
    found = projective_images(frame, light_plane(lamp, ground))
    affine = np.linalg.lstsq(np.column_stack([image, np.ones(9)]), found, rcond=None)
    assert np.abs(np.column_stack([image, np.ones(9)]) @ affine[0] - found).max() < 1e-9
    shown = projective_images(frame, light_plane(lamp, region.points))
    assert np.allclose([shown.min(axis=0), shown.max(axis=0)], [(-1, -1), (1, 1)])
    far = np.append(light_plane(lamp, region.points), np.ones((len(region.points), 1)), axis=1) @ frame[2]
    assert far.min() == pytest.approx(1.0)
    assert np.linalg.det(frame) > 0.0, "it is not mirrored"


@pytest.mark.capability("R-psm")
def test_a_perspective_map_that_would_look_along_a_side_of_what_is_seen_is_the_box():
    points, corners = triangles_of(floor(300.0, 0.0), floor(300.0, 12.0))
    camera = Camera((0.0, -290.0, 6.0), (0.0, 0.0, 6.0), fov_deg=60.0)
    region = region_in_picture(raster_system(camera, 90, 60), 90, 60, points, corners)
    # The one sun stands behind the eye and beside what is seen: after the perspective close to it.
    edge, side = (Light(way, parallel=True) for way in ((-0.8, -1.0, 0.001), (1.0, 0.1, 1.0)))
    (one, box_), (two, other) = (
        [
            shadow_buffer(light, points, corners, frame=frame, size=128, region=region).maps[0].texel_from_light
            for frame in ("perspective", "box")
        ]
        for light in (edge, side)
    )
    assert (one == box_).all()
    assert not (two == other).all() and np.abs(two[2, :2]).max() > 0.0
    with pytest.raises(InputError, match="needs the region"):
        shadow_buffer(side, points, corners, frame="perspective")
    with pytest.raises(InputError, match="tapered"):
        MapSettings(tapered="round")


@pytest.mark.slow
@pytest.mark.parametrize(("away", "factor"), [(25.0, 0.5), (60.0, 0.7), (400.0, 1.4)])
def test_focus_by_depth_gains_in_deep_views_and_loses_little_in_shallow_ones(away, factor):
    points, corners = field(150)
    camera = Camera((0.0, -60.0 - 0.95 * away, 0.3 * away), (0.0, -60.0, 0.0), fov_deg=40.0)
    found, places, normals = visible(points, corners, camera)
    region = region_in_picture(raster_system(camera, COLUMNS, ROWS), COLUMNS, ROWS, points, corners)
    wrong = {"standard": 0.0, "trapezoid": 0.0}
    for light in (SUN, Light((-1.0, -0.3, 1.2), parallel=True), Light((60.0, -90.0, 150.0))):
        exact = blocked_exactly(light, places, found.triangle, points, corners)
        _, facing = stopped(points, corners, places, normals, light)
        for frame in ("standard", "trapezoid"):
            buffer = shadow_buffer(light, points, corners, size=384, frame=frame, region=region)
            wrong[frame] += (buffer.blocks(places, normals) != exact)[facing].mean()
    assert wrong["trapezoid"] < factor * wrong["standard"]


def test_the_region_in_the_picture_is_what_the_frustum_leaves_of_the_triangles():
    points, corners = triangles_of(floor(30.0, 0.0))
    camera = Camera((0, 0, 10), (0, 1e-9, 0), fov_deg=90.0)
    region = region_in_picture(raster_system(camera, 200, 100), 200, 100, points, corners)
    assert np.allclose(np.sort(np.abs(bounds(region.points))), [(0, 10, 20), (0, 10, 20)], atol=1e-6)
    assert np.allclose([region.near, region.far], 0.0, atol=1e-6), "the floor has no depth"
    behind = region_in_picture(raster_system(camera, 9, 9), 9, 9, points + np.array((0, 0, 20)), corners)
    assert not len(behind.points)
    turned = Camera((0.0, -50.0, 5.0), (0.0, 0.0, 5.0), fov_deg=90.0)
    region = region_in_picture(raster_system(turned, 300, 300), 300, 300, points, corners)
    assert np.allclose([region.near, region.far], [(0, -30, 5), (0, 30, 5)], atol=1e-6)
    share = focus_of_depths(20.0, 80.0)
    assert np.allclose(region.focus, (0, -30 + 60 * share, 5), atol=1e-6)
    assert share == pytest.approx(0.8 / 1.2), "the base is twice as wide as the top line"
    parallel = Camera((0, -50, 5), (0, 0, 5), parallel=True, height=20.0)
    region = region_in_picture(raster_system(parallel, 300, 300), 300, 300, points, corners)
    assert np.allclose(bounds(region.points), [(-10, -30, 0), (10, 30, 0)], atol=1e-6)


@pytest.mark.capability("R-nonsquare")
def test_texels_are_as_square_as_what_the_map_shows_allows():
    wide = standard_frame(np.array([(-8.0, -4.0), (8.0, 4.0)]))
    columns, rows = shape_of(wide, 1000)
    assert columns / rows == pytest.approx(2.0, rel=1e-2)
    assert columns * rows == pytest.approx(1e6, rel=1e-2)
    line = standard_frame(np.array([(0.0, -4.0), (0.0, 4.0)]))
    columns, rows = shape_of(line, 1000)
    assert rows / columns == pytest.approx(LONGEST, rel=1e-2)


@pytest.mark.hard(33)
@pytest.mark.parametrize("frame", ["trapezoid", "perspective"])
@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.01, 0.1, np.pi - 0.1, np.pi - 1e-4, np.pi])
def test_a_light_that_faces_the_eye_has_the_right_shadows(angle, frame):
    points, corners = triangles_of(box((-1, -1, -1), (1, 1, 1)), box((1.5, 1, -1), (2, 3, 1)), floor(8.0, -1.2))
    camera = Camera((0, -14, 1), (0, 0, 1), fov_deg=50.0)
    right, _, back = camera.axes
    light = Light(tuple(np.cos(angle) * back + np.sin(angle) * right + (0.0, 0.0, 0.2)), parallel=True)
    found, places, normals = visible(points, corners, camera)
    exact = blocked_exactly(light, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, light)
    region = seen_region(raster_system(camera, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points))
    buffer = shadow_buffer(light, points, corners, size=1024, frame=frame, region=region)
    assert np.isfinite(buffer.maps[0].texel_from_light).all()
    assert (buffer.blocks(places, normals) != exact)[facing].mean() < 0.02


@pytest.mark.hard(33)
def test_a_lamp_in_the_scene_casts_shadows_away_from_itself_on_all_sides():
    room = box((-4, -4, -4), (4, 4, 4))
    points, corners = triangles_of(
        room, *(box(c - 0.5, c + 0.5) for c in 2.0 * np.concatenate([np.eye(3), -np.eye(3)]))
    )
    lamp = Light((0.0, 0.0, 0.0))
    assert is_amid(lamp, points)
    # A point on each wall, behind a box, and one beside its shadow.
    ways = np.concatenate([np.eye(3), -np.eye(3)])
    behind, beside = 4.0 * ways, 4.0 * ways + 2.5 * np.roll(ways, 1, axis=1)
    places, normals = np.concatenate([behind, beside]), np.concatenate([-ways, -ways])
    expected = np.repeat([True, False], 6)
    buffer = shadow_buffer(lamp, points, corners, size=512)
    assert len(buffer.maps) == 6
    assert (buffer.blocks(places, normals) == expected).all()
    assert (blocked_exactly(lamp, places, np.full(12, -1), points, corners) == expected).all()


@pytest.mark.hard(34)
def test_a_frustum_without_taper_falls_to_the_rectangle():
    points, corners = sample(2)
    camera = Camera((0, -1e7, 3e6), (0, 0, 0), fov_deg=1e-4)
    region = seen_region(raster_system(camera, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points))
    system = aimed_system(SUN, points)
    matrix = trapezoid_frame(system, region, 0.8)
    assert np.isfinite(matrix).all()
    assert np.linalg.matrix_rank(matrix) == 3
    buffer = shadow_buffer(SUN, points, corners, size=512, frame="trapezoid", region=region)
    assert np.isfinite(buffer.maps[0].depth_code.maximum)


@pytest.mark.capability("R-nonsquare")
@pytest.mark.parametrize("light", [SUN, Light((150.0, -200.0, 250.0))], ids=["parallel", "lamp"])
def test_maps_grow_as_their_focus_shrinks(light):
    points, corners = triangles_of(box((0, 0, 0), (1, 1, 1)), box((0, 30, 0), (1, 31, 1)), floor(40.0, -0.1))
    texels = []
    for height in (12.0, 6.0, 3.0, 1.5):
        camera = Camera((0, -9, height), (0, 10, 0), fov_deg=50.0)
        region = seen_region(raster_system(camera, COLUMNS, ROWS), COLUMNS, ROWS, bounds(points))
        given = {"size": 256, "frame": "trapezoid", "region": region}
        plain, grown = (shadow_buffer(light, points, corners, **given, **more) for more in ({}, {"wanted_focus": 0.6}))
        (one,), (two,) = plain.maps, grown.maps
        assert one.code.size <= two.code.size <= 16.1 * one.code.size
        texels.append(two.code.size / one.code.size)
        frame = np.linalg.inv(in_texels(np.eye(3), *two.code.shape[::-1])) @ two.texel_from_light
        share = focus_area(frame, light_plane(two.system, region.focus_points))
        assert share * two.code.size >= 0.58 * 256**2 or two.code.size >= 15.9 * one.code.size
    assert max(texels) > 1.05, "one of these views needs more"
    with pytest.raises(InputError, match="out of range"):
        shadow_buffer(light, points, corners, **given, wanted_focus=1.5)
    with pytest.raises(InputError, match="casting"):
        shadow_buffer(light, points, corners, casting="front")


@pytest.mark.capability("R-nonsquare")
def test_maps_need_not_be_square():
    points, corners = sample(2)
    found, places, normals = visible(points, corners, camera_of(points, 2))
    exact = blocked_exactly(SUN, places, found.triangle, points, corners)
    _, facing = stopped(points, corners, places, normals, SUN)
    wide = shadow_buffer(SUN, points, corners, size=1024, rows=256)
    assert wide.maps[0].code.shape == (256, 1024)
    assert (wide.blocks(places, normals) != exact)[facing].mean() < 0.01


def test_nothing_casts_no_shadow_and_impossible_maps_are_refused():
    points, corners = sample(2)
    none = shadow_buffer(SUN, np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp))
    assert not none.blocks([(0.0, 0.0, 0.0)], [(0.0, 0.0, 1.0)]).any()
    flat = shadow_map(
        aimed_system(SUN, points), standard_frame(np.eye(2)), points[:0], np.zeros((0, 3), dtype=np.intp), 64, 64
    )
    assert not flat.code.any()
    for options in ({"bits": 12}, {"frame": "round"}, {"frame": "box"}, {"size": 2}, {"size": 10**6}):
        with pytest.raises(InputError):
            shadow_buffer(SUN, points, corners, **options)
    with pytest.raises(InputError, match="focus"):
        seen_region(raster_system(FIELD_CAMERA, 10, 10), 10, 10, bounds(points), 1.5)


def test_the_seen_region_is_the_frustum_within_the_box():
    camera = Camera((0, -10, 0), (0, 0, 0), fov_deg=90.0)
    region = seen_region(raster_system(camera, 200, 100), 200, 100, [(-1, -1, -1), (1, 1, 1)], 0.25)
    assert np.allclose(bounds(region.points), [(-1, -1, -1), (1, 1, 1)], atol=1e-7), "all of a small box"
    assert np.allclose([region.near, region.far, region.focus], [(0, -1, 0), (0, 1, 0), (0, -0.5, 0)], atol=1e-7)
    assert np.allclose(bounds(region.focus_points)[1], (1, -0.5, 1), atol=1e-7)
    wide = seen_region(raster_system(camera, 200, 100), 200, 100, [(-99, -5, -99), (99, 5, 99)])
    assert np.allclose(bounds(wide.points), [(-30, -5, -15), (30, 5, 15)], atol=1e-4)
    camera = Camera((0, -10, 0), parallel=True, height=4.0)
    parallel = seen_region(raster_system(camera, 200, 100), 200, 100, [(-9, -9, -9), (9, 9, 9)])
    assert np.allclose([parallel.near, parallel.far], [(0, -9, 0), (0, 9, 0)], atol=1e-7)
    camera = Camera((0, -10, 0), (0, 0, 0), fov_deg=90.0)
    assert np.allclose(bounds(parallel.points), [(-4, -9, -2), (4, 9, 2)], atol=1e-6)
    behind = seen_region(raster_system(camera, 200, 100), 200, 100, [(-1, -20, -1), (1, -15, 1)])
    assert not len(behind.points)
