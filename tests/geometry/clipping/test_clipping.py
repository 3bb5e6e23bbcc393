from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.effort import several

from vectorplot.errors import InputError
from vectorplot.geometry import clipping as clip_windows
from vectorplot.geometry import clipping as clipped_lines
from vectorplot.geometry import clipping as clipped_polygons
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.clipping import Box, Polygons, Window
from vectorplot.geometry.projections import CoordinateSystem, collineate, depth_of
from vectorplot.textbook.viewing import Frustum, clip_and_draw, clip_lines_3d, clip_polygons_3d

HUNDRED = Window(0, 100, 0, 100)
SCREEN = CoordinateSystem.of_screen(Camera(eye=(9, -7, 6), target=(1, 0, 1), twist_deg=15), PixelWindow(800, 600))
BOX = Box(Window.of_size(800, 600))
number = st.integers(-300, 300).map(float)


def liang_barsky(p, q, window):
    """The clipped parameters of one segment, by the other classic method."""
    low, high = 0.0, 1.0
    d = q - p
    for rise, gap in (
        (-d[0], p[0] - window.min_x),
        (d[0], window.max_x - p[0]),
        (-d[1], p[1] - window.min_y),
        (d[1], window.max_y - p[1]),
    ):
        if rise == 0.0:
            if gap < 0.0:
                return None
        elif rise < 0.0:
            low = max(low, gap / rise)
        else:
            high = min(high, gap / rise)
    return (low, high) if low <= high else None


def area(polygon):
    x, y = (polygon - polygon[0])[:, :2].T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


@pytest.mark.capability("G2.5-region")
def test_nine_region_codes():
    grid = np.array([[(x, y) for x in (-5, 50, 105)] for y in (105, 50, -5)])
    assert clip_windows.region_codes(grid, HUNDRED).tolist() == [
        [0b0101, 0b0100, 0b0110],
        [0b0001, 0, 0b0010],
        [0b1001, 8, 0b1010],
    ]
    assert (clip_windows.LEFT, clip_windows.RIGHT, clip_windows.ABOVE, clip_windows.BELOW) == (1, 2, 4, 8)
    assert clip_windows.region_codes([(0, 0), (100, 100)], HUNDRED).tolist() == [0, 0]
    depths = [(50, 50, z) for z in (-1.5, -0.9, -0.8, 0, 4, 4.1)]
    assert clip_windows.region_codes(depths, Box(HUNDRED)).tolist() == [
        clip_windows.INFRONT,
        clip_windows.BEHIND,
        0,
        0,
        0,
        clip_windows.INFRONT,
    ]


@pytest.mark.capability("G2.5-clip2d-line")
def test_tv15_line_in_a_window():
    lines = clipped_lines.clip_lines_2d([(-50, 20)], [(200, 80)], HUNDRED)
    assert np.allclose([lines.start[0], lines.end[0]], [(0, 32), (100, 56)], rtol=0, atol=1e-12)
    assert lines.exists[0] and lines.clipped[0]
    # Erratum G2-07: the left-hand point goes to the left side.
    lines = clipped_lines.clip_lines_2d([(-20, 10)], [(50, 40)], HUNDRED)
    assert np.allclose(lines.start[0], (0, 10 + 30 * 20 / 70), atol=1e-12)


@pytest.mark.capability("G2.5-clip2d-line")
@given(st.lists(st.tuples(number, number, number, number), min_size=1, max_size=20))
def test_lines_in_a_window_agree_with_liang_barsky(rows):
    p, q = np.array(rows)[:, :2], np.array(rows)[:, 2:]
    lines = clipped_lines.clip_lines_2d(p, q, HUNDRED)
    for k in range(len(p)):
        part = liang_barsky(p[k], q[k], HUNDRED)
        if part is None or part[1] - part[0] < 1e-9:
            # Rounding may decide about a segment that touches a corner.
            assert part is not None or not lines.exists[k] or np.abs(lines.start[k] - lines.end[k]).max() < 1e-9
            continue
        assert lines.exists[k]
        assert np.allclose(lines.start[k], p[k] + part[0] * (q[k] - p[k]), atol=1e-9)
        assert np.allclose(lines.end[k], p[k] + part[1] * (q[k] - p[k]), atol=1e-9)
    outside = clip_windows.region_codes(lines.start[lines.exists], HUNDRED) | clip_windows.region_codes(
        lines.end[lines.exists], HUNDRED
    )
    assert not outside.any()


@pytest.mark.capability("G2.5-clip2d-line")
def test_exists_and_was_clipped():
    start = [(10.0, 10.0), (-10.0, 50.0), (-10.0, 50.0), (-10, 90), (0.0, 0.0), (-5.0, -5.0)]
    end = [(20.0, 30.0), (-20.0, 60.0), (50.0, 50.0), (20, 150), (100.0, 0.0), (-5.0, -5.0)]
    lines = clipped_lines.clip_lines_2d(start, end, HUNDRED)
    assert lines.exists.tolist() == [True, False, True, False, True, False]
    assert lines.clipped.tolist() == [False, True, True, True, False, True]
    assert lines.start[2].tolist() == [0.0, 50.0]
    none = clipped_lines.clip_lines_2d(np.zeros((0, 2)), np.zeros((0, 2)), HUNDRED)
    assert len(none.exists) == 0


@pytest.mark.capability("G2.5-clip2d-line")
def test_depth_goes_along_linearly():
    lines = clipped_lines.clip_lines_2d([(-50, 20, 0.0)], [(200, 80, 10.0)], HUNDRED)
    assert np.allclose((lines.start[0, 2], lines.end[0, 2]), (2.0, 6.0), atol=1e-14)


@pytest.mark.capability("G2.5-xy-region")
def test_the_region_is_the_whole_window_or_what_the_user_says():
    assert Window.of_size(800, 600) == Window(0, 800, 0, 600)
    assert BOX.window == Window(0, 800, 0, 600)
    lines = clipped_lines.clip_lines_2d([(0.0, 0.0)], [(100.0, 100.0)], Window(20, 40, -50, 30))
    assert (lines.start[0].tolist(), lines.end[0].tolist()) == ([20.0, 20.0], [30.0, 30.0])
    for empty in ((1, 1, 0, 5), (0, 5, 3, 2), (0, float("nan"), 0, 1)):
        with pytest.raises(InputError, match="window"):
            Window(*empty)


@pytest.mark.capability("G2.5-clip-draw-line")
def test_any_clipping_goes_with_any_drawing():
    inside, across, outside = [(1.0, 2.0), (3.0, 4.0)], [(-50.0, 50.0), (50.0, 50.0)], [(-9.0, -9.0), (-1.0, -2.0)]
    start, end = (np.array([line[k] for line in (inside, across, outside)]) for k in (0, 1))

    def window(p, q):
        return clipped_lines.clip_lines_2d(p, q, HUNDRED)

    def solid(p, q):
        return [("line", *a, *b) for a, b in zip(p.tolist(), q.tolist(), strict=True)]

    def length(p, q):
        return float(np.linalg.norm(q - p, axis=1).sum())

    def nothing_clipped(p, q):
        return clipped_lines.ClippedLines(p, q, np.ones(len(p), dtype=bool), np.zeros(len(p), dtype=bool))

    assert clip_and_draw(start, end, window, solid) == [("line", 1, 2, 3, 4), ("line", 0, 50, 50, 50)]
    assert clip_and_draw(start, end, window, length) == pytest.approx(50 + 8**0.5)
    assert len(clip_and_draw(start, end, nothing_clipped, solid)) == 3


@pytest.mark.capability("G2.5-z-region")
def test_initial_near_and_far_planes_lie_at_minus_four_and_four_fifths_of_the_distance():
    d = 12.4096736459909
    assert (BOX.min_z, BOX.max_z) == (-0.8, 4.0)
    assert np.allclose(depth_of([BOX.min_z, BOX.max_z], d), (-49.6386945839634, 9.92773891679269), rtol=0, atol=1e-12)
    assert np.allclose(Frustum(SCREEN, BOX).depths, (-4 * SCREEN.distance, 0.8 * SCREEN.distance), rtol=1e-15)
    with pytest.raises(InputError, match="min_z"):
        Box(HUNDRED, 2.0, 1.0)
    with pytest.raises(InputError, match="neutral"):
        Frustum(SCREEN, Box(HUNDRED, -1.5, 1.0))


def inside_by_sampling(p, q, frustum):
    """Bounds of the parameters of a segment that lie in the frustum, by planes in the world."""
    mesh = frustum.mesh
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    a, b = (-((x - first) * mesh.face_normals).sum(axis=1) for x in (p, q))
    low = max([0.0, *(a / (a - b))[(a < 0) & (b >= 0)]])
    high = min([1.0, *(a / (a - b))[(b < 0) & (a >= 0)]])
    return (low, high) if low <= high and not ((a < 0) & (b < 0)).any() else None


@pytest.mark.slow
@pytest.mark.capability("G2.5-clip3d-line")
@pytest.mark.hard(5)
def test_lines_after_t2_agree_with_the_frustum_in_the_world_also_across_the_eye():
    frustum = Frustum(SCREEN, BOX)
    rng = np.random.default_rng(9)
    count = several(500, long=2000)
    p, q = rng.uniform(-14, 14, (2, count, 3)) + SCREEN.centre / 2
    assert SCREEN.forbidden(p).sum() > 0.15 * count
    lines = clip_lines_3d(SCREEN.homogeneous(p), SCREEN.homogeneous(q), BOX)
    found = 0
    for k in range(len(p)):
        part = inside_by_sampling(p[k], q[k], frustum)
        if part is None:
            assert not lines.exists[k]
            continue
        found += 1
        assert lines.exists[k]
        ends = p[k] + np.array(part)[:, None] * (q[k] - p[k])
        expected = collineate(SCREEN.rotated(ends), SCREEN.distance)
        expected[:, :2] = SCREEN.from_world(ends)[:, :2]
        assert np.allclose([lines.start[k], lines.end[k]], expected, rtol=1e-9, atol=1e-9)
    assert found > 0.05 * count
    eye_crossing = SCREEN.forbidden(p) != SCREEN.forbidden(q)
    assert (lines.exists & eye_crossing).sum() > 0.005 * count
    assert np.array_equal(lines.clipped, ~(frustum.contains(p) & frustum.contains(q)))


@pytest.mark.capability("G2.5-clip3d-line")
def test_both_images_beyond_the_right_edge_yet_the_line_crosses_the_window():
    # Erratum G2-09: the image of a point behind the eye is mirrored.
    system = CoordinateSystem.of_screen(Camera(eye=(0, 0, 10), up=(0, 1, 0)), PixelWindow(600, 600))
    p, q = np.array([[4.0, 0.0, 0.0]]), np.array([[-3.0, 0.0, 14.0]])
    raw = np.concatenate([system.homogeneous(p), system.homogeneous(q)])
    assert (raw[:, 0] / raw[:, 3] > 600).all()
    lines = clip_lines_3d(raw[:1], raw[1:], Box(Window.of_size(600, 600)))
    assert lines.exists[0] and lines.start[0, 0] == pytest.approx(600) and lines.end[0, 0] < 600
    # A point in the neutral plane itself does no harm.
    level = clip_lines_3d(raw[:1], system.homogeneous([[1.0, 0.0, 10.0]]), Box(Window.of_size(600, 600)))
    assert np.isfinite(level.end).all()


@pytest.mark.capability("G2.5-clip3d-line")
def test_a_parallel_projection_is_clipped_in_its_own_depths():
    system = CoordinateSystem.of_image(Camera.view("top"))
    lines = clip_lines_3d(
        system.homogeneous([[0.5, 0.5, -9.0]]), system.homogeneous([[0.5, 0.5, 9.0]]), Box(Window.of_size(1, 1), -2, 3)
    )
    assert np.allclose([lines.start[0], lines.end[0]], [(0.5, 0.5, -2), (0.5, 0.5, 3)], atol=1e-15)


@pytest.mark.capability("G2.5-clip2d-poly")
def test_tv72_triangle_in_a_window():
    triangle = Polygons.of([(-2, 1), (5, -3), (4, 6)])
    clipped = clipped_polygons.clip_polygons_2d(triangle, Window(0, 4, 0, 4))
    expected = [(0, 0), (0, 8 / 3), (1.6, 4), (4, 0), (4, 4)]
    assert np.allclose(sorted(clipped[0].tolist()), expected, rtol=0, atol=1e-12)
    assert area(clipped[0]) == pytest.approx(14.9333333333333, abs=1e-12)


@pytest.mark.capability("G2.5-clip2d-poly")
@pytest.mark.parametrize("way", [1, -1])
def test_depth_of_new_corners_is_linear_entering_and_leaving(way):
    # Erratum G2-11.
    corners = np.array([(-2.0, 1.0), (5.0, -3.0), (4.0, 6.0)])[::way]
    depth = corners @ (0.3, -0.7) + 2.0
    clipped = clipped_polygons.clip_polygons_2d(Polygons.of(np.column_stack([corners, depth])), Window(0, 4, 0, 4))[0]
    assert len(clipped) == 5
    assert np.allclose(clipped[:, 2], clipped[:, :2] @ (0.3, -0.7) + 2.0, atol=1e-14)
    assert np.sign(area(clipped)) == np.sign(area(corners))


@pytest.mark.capability("G2.5-clip2d-poly")
def test_many_polygons_agree_with_shapely():
    import shapely

    rng = np.random.default_rng(10)
    window = Window(-1, 1, -0.5, 0.8)
    polygons = []
    for _ in range(200):
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 9)))
        spread = rng.uniform(0.2, 1.5, (len(angles), 1))
        polygons.append(np.stack([np.cos(angles), np.sin(angles)], axis=1) * spread + rng.uniform(-1.5, 1.5, 2))
    clipped = clipped_polygons.clip_polygons_2d(Polygons.of(*polygons), window)
    assert len(clipped) == 200
    frame = shapely.box(-1, -0.5, 1, 0.8)
    empty = 0
    for k, polygon in enumerate(polygons):
        shape = shapely.Polygon(polygon)
        if not shape.is_valid:
            continue
        exact = shape.intersection(frame).area
        got = area(clipped[k]) if len(clipped[k]) else 0.0
        empty += not len(clipped[k])
        assert abs(got) == pytest.approx(exact, abs=1e-12)
        assert not len(clipped[k]) or not clip_windows.region_codes(clipped[k], window).any()
    assert empty > 5


@pytest.mark.capability("G2.5-clip2d-poly")
def test_a_side_through_corners_keeps_the_right_half():
    square = Polygons.of([(-1, 0), (0, -1), (1, 0), (0, 1)])
    half, is_new = clipped_polygons.cut_polygons(square, square.points[:, 0])
    assert half[0].tolist() == [[0, -1], [1, 0], [0, 1]] and not is_new.any()
    touching, _ = clipped_polygons.cut_polygons(square, square.points[:, 0] - 1.0)
    assert len(touching) == 1 and len(touching[0]) == 0
    two = Polygons.of(square.points, np.add(square.points, (0.5, 0.0)))
    second, _ = clipped_polygons.cut_polygons(two, two.points[:, 0] - 1.0)
    assert len(second) == 2 and len(second[0]) == 0
    assert second.points.tolist() == second[1].tolist() == [[1.0, -0.5], [1.5, 0.0], [1.0, 0.5]]


@pytest.mark.capability("G2.5-clip3d-poly")
@pytest.mark.hard(5)
def test_polygons_in_the_box_agree_with_the_frustum_in_the_world():
    frustum = Frustum(SCREEN, BOX)
    rng = np.random.default_rng(11)
    triangles = rng.uniform(-14, 14, (600, 3, 3)) + SCREEN.centre / 2
    assert (SCREEN.forbidden(triangles).any(axis=1) & ~SCREEN.forbidden(triangles).all(axis=1)).sum() > 100
    count = len(triangles)
    polygons = Polygons(SCREEN.homogeneous(triangles).reshape(-1, 4), np.arange(0, 3 * count + 1, 3))
    clipped = clip_polygons_3d(polygons, BOX)
    planes, mesh = [], frustum.mesh
    for first, normal in zip(mesh.corners[mesh.offsets[:-1]], mesh.face_normals, strict=True):
        planes.append((-normal, normal @ mesh.vertices[first]))
    world = Polygons(triangles.reshape(-1, 3), np.arange(0, 3 * count + 1, 3))
    for normal, constant in planes:
        world, _ = clipped_polygons.cut_polygons(world, world.points @ normal + constant)
    filled = 0
    for k in range(count):
        if len(world[k]) == 0:
            assert len(clipped[k]) == 0
            continue
        filled += 1
        image = SCREEN.from_world(world[k])
        assert area(clipped[k]) == pytest.approx(area(image), rel=1e-9, abs=1e-7)
        low, high = clipped[k].min(axis=0), clipped[k].max(axis=0)
        assert (low >= (-1e-9, -1e-9, -0.8 - 1e-12)).all() and (high <= (800 + 1e-9, 600 + 1e-9, 4 + 1e-12)).all()
    assert filled > 60


@pytest.mark.capability("G2.5-clip3d-poly")
def test_a_polygon_around_the_eye_fills_the_window():
    system = CoordinateSystem.of_screen(Camera(eye=(0, 0, 10), up=(0, 1, 0)), PixelWindow(600, 600))
    floor = [(-1e3, -1, -1e3), (1e3, -1, -1e3), (1e3, -1, 1e3), (-1e3, -1, 1e3)]
    clipped = clip_polygons_3d(Polygons.of(system.homogeneous(floor)), Box(Window.of_size(600, 600), -0.99, 100.0))
    assert clipped[0][:, 1].min() == pytest.approx(0.0, abs=1e-9)
    assert np.abs(area(clipped[0])) == pytest.approx(600 * clipped[0][:, 1].max(), rel=1e-9)


@pytest.mark.capability("G2.5-fig11")
def test_the_frustum_becomes_a_box():
    frustum = Frustum(SCREEN, BOX)
    star = collineate(SCREEN.rotated(frustum.corners), SCREEN.distance)
    star[:, :2] = star[:, :2] * SCREEN.scale + SCREEN.middle
    assert np.allclose(star, frustum.box_mesh.vertices, rtol=1e-12, atol=1e-9)
    mesh = frustum.mesh
    for solid in (mesh, frustum.box_mesh):
        middle = solid.vertices.mean(axis=0)
        outward = ((solid.vertices[solid.corners[solid.offsets[:-1]]] - middle) * solid.face_normals).sum(axis=1)
        assert (outward > 0).all()
    edges = np.stack([frustum.corners[1::2] - frustum.corners[::2], star[1::2] - star[::2]])
    assert np.abs(np.cross(edges[1], (1, 0, 0))).max() < 1e-9
    sides, box_sides = frustum.corners[4:] - frustum.corners[:4], star[4:] - star[:4]
    assert np.abs(np.cross(box_sides, box_sides[0])).max() < 1e-8
    assert np.linalg.norm(np.cross(sides, sides[0]), axis=1).max() > 1.0
    mirrored = CoordinateSystem.of_screen(Camera(eye=(9, -7, 6)), PixelWindow(800, 600, -1))
    turned = Frustum(mirrored, BOX).mesh
    outward = turned.vertices[turned.corners[turned.offsets[:-1]]] - turned.vertices.mean(axis=0)
    assert ((outward * turned.face_normals).sum(axis=1) > 0).all()


@pytest.mark.capability("G2.2-pyramid")
def test_the_frustum_has_near_far_and_four_sides_through_the_eye():
    frustum = Frustum(SCREEN, BOX)
    mesh = frustum.mesh
    distances = ((SCREEN.centre - mesh.vertices[mesh.corners[mesh.offsets[:-1]]]) * mesh.face_normals).sum(axis=1)
    assert np.allclose(distances[2:], 0.0, atol=1e-10)
    assert np.allclose(distances[:2], (-5 * SCREEN.distance, 0.2 * SCREEN.distance), rtol=1e-12)
    inside = frustum.corners.mean(axis=0)
    assert frustum.contains(inside) and not frustum.contains(SCREEN.centre)
    assert not frustum.contains(2 * SCREEN.centre - inside)
