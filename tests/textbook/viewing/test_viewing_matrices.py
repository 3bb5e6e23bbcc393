from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.textbook import viewing as vw
from vectorplot.textbook.viewing import ViewVolume

EYE, GAZE, UP, P = (3, 2, 6), (-1, -0.5, -2), (0, 1, 0), (0.5, 0.25, -1)
VOLUME = ViewVolume(-1, 1.5, -0.75, 1, -2, -20)
CAMERA = vw.camera_matrix(EYE, GAZE, UP)
vector = st.tuples(*[st.floats(-5, 5)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1)


@pytest.mark.capability("V-window2/3")
def test_tv69_windowing():
    matrix = vw.window_transform([(2, -1), (5, 3)], [(10, 100), (20, 60)])
    expected = [[10 / 3, 0, 10 / 3], [0, -10, 90], [0, 0, 1]]
    assert np.allclose(matrix, expected, rtol=0, atol=1e-12)
    assert np.allclose(vw.transformed(matrix, (3, 0)), (13.3333333333333, 90), rtol=0, atol=1e-12 * 40)


@pytest.mark.capability("V-window2/3")
def test_boxes_go_to_boxes_in_space():
    source, target = np.array([(2, -1, 0), (5, 3, 7)]), np.array([(10, 100, -1), (20, 60, 1)])
    matrix = vw.window_transform(source, target)
    assert np.allclose(vw.transformed(matrix, source), target, atol=1e-13)
    assert np.allclose(vw.transformed(matrix, source.mean(axis=0)), target.mean(axis=0), atol=1e-13)
    move, stretch, back = np.eye(4), np.diag([*((target[1] - target[0]) / (source[1] - source[0])), 1]), np.eye(4)
    move[:3, 3], back[:3, 3] = -source[0], target[0]
    assert np.allclose(matrix, back @ stretch @ move, atol=1e-13)
    with pytest.raises(InputError):
        vw.window_transform([(0, 0), (0, 1)], [(0, 0), (1, 1)])


@pytest.mark.capability("V-view")
def test_the_viewport_has_pixel_centres_at_integers():
    matrix = vw.viewport(640, 480)
    points = [(-1, -1, 0.3), (1, 1, -0.7), (0, 0, 0)]
    assert np.allclose(vw.transformed(matrix, points), [(-0.5, -0.5, 0.3), (639.5, 479.5, -0.7), (319.5, 239.5, 0)])
    with pytest.raises(InputError):
        vw.viewport(0, 480)


@pytest.mark.capability("V-orth")
def test_corners_of_the_orthographic_volume():
    corners = [(x, y, z) for x in (-1, 1.5) for y in (-0.75, 1) for z in (-20, -2)]
    expected = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    assert np.allclose(vw.transformed(VOLUME.orthographic, corners), expected, atol=1e-14)
    for bad in ((1, -1, -1, 1, -2, -20), (-1, 1, -1, 1, 2, 20), (-1, 1, -1, 1, -20, -2), (-1, 1, -1, 1, 0, -2)):
        with pytest.raises(InputError):
            ViewVolume(*bad)


@pytest.mark.capability("V-basis")
@given(vector, vector)
def test_frames_are_orthonormal_and_right_handed(a, t):
    frames = [vw.basis_of(a)]
    if np.linalg.norm(np.cross(a, t)) > 1e-3:
        frames += [vw.basis_of(a, t), vw.basis_of_gaze(-a, t)]
        assert abs(frames[1][0] @ t) < 1e-12 * 10
        assert np.allclose(frames[1], frames[2], atol=1e-15)
    for u, v, w in frames:
        assert np.allclose(np.array([u, v, w]) @ np.array([u, v, w]).T, np.eye(3), atol=1e-12)
        assert np.allclose(np.cross(u, v), w, atol=1e-12)
        assert np.linalg.norm(np.cross(w, a)) < 1e-13 * 10 and w @ a > 0
    with pytest.raises(InputError, match="one line"):
        vw.basis_of(a, -2 * a)


@pytest.mark.capability("V-frame")
def test_the_corrected_example_in_the_plane():
    # Erratum V-01.
    matrix = vw.world_from_frame((2, 2), [(1, 0), (0, -1)])
    assert matrix.tolist() == [[1, 0, 2], [0, -1, 2], [0, 0, 1]]
    assert vw.transformed(matrix, [(-1, -1), (1, 0)]).tolist() == [[1, 3], [3, 2]]


@pytest.mark.capability("V-frame")
@given(vector, vector)
def test_coordinate_changes_invert_each_other(origin, w):
    basis = vw.basis_of(w)
    there, back = vw.world_from_frame(origin, basis), vw.frame_from_world(origin, basis)
    assert np.allclose(there @ back, np.eye(4), atol=1e-13)
    assert np.allclose(vw.transformed(there, np.eye(3)), origin + basis, atol=1e-13)
    flat = np.array([[0.6, 0.8], [-0.8, 0.6]])
    assert np.allclose(
        vw.world_from_frame(origin[:2], flat) @ vw.frame_from_world(origin[:2], flat), np.eye(3), atol=1e-13
    )


@pytest.mark.capability("V-cam")
def test_tv65_camera_matrix():
    rows = [
        [0.894427190999916, 0, -0.447213595499958, 0],
        [-0.0975900072948533, 0.975900072948533, -0.195180014589707, -0.487950036474267],
        [0.436435780471985, 0.218217890235992, 0.87287156094397, -6.98297248755176],
        [0, 0, 0, 1],
    ]
    assert np.allclose(CAMERA, rows, rtol=0, atol=1e-12)
    assert np.allclose(vw.transformed(CAMERA, EYE), 0, atol=1e-14)
    ahead = vw.transformed(CAMERA, np.add(EYE, GAZE))
    assert np.allclose(ahead, (0, 0, -np.linalg.norm(GAZE)), atol=1e-14)


@pytest.mark.capability("V-cam")
def test_tv66_camera_coordinates():
    expected = (0.894427190999916, -0.0975900072948535, -7.58307168570074)
    assert np.allclose(vw.transformed(CAMERA, P), expected, rtol=0, atol=1e-12)


@pytest.mark.capability("V-homog")
@given(vector, st.floats(0.1, 10) | st.floats(-10, -0.1))
def test_a_common_factor_does_not_change_the_point(p, factor):
    assert np.allclose(vw.dehomogenized(factor * vw.homogeneous(p)), p, rtol=1e-14)
    assert vw.homogeneous(p)[3] == 1.0
    with pytest.raises(InputError, match="infinity"):
        vw.dehomogenized((*p, 0.0))


@pytest.mark.capability("V-persp")
def test_perspective_keeps_the_near_plane_the_far_depth_and_the_order():
    rng = np.random.default_rng(12)
    points = rng.uniform(-3, 3, (50, 3))
    near, far = points.copy(), points.copy()
    near[:, 2], far[:, 2] = -2, -20
    assert np.allclose(vw.transformed(VOLUME.perspective, near), near, atol=1e-14)
    image = vw.transformed(VOLUME.perspective, far)
    assert np.allclose(image, far * (0.1, 0.1, 1), atol=1e-14)
    depths = vw.transformed(VOLUME.perspective, [(0, 0, z) for z in np.linspace(-20, -2, 100)])[:, 2]
    assert (np.diff(depths) > 0).all()
    # Rays through the eye become parallel to z.
    ray = vw.transformed(VOLUME.perspective, np.outer([2, 3, 7], (0.3, -0.2, -1)))
    assert np.ptp(ray[:, :2], axis=0).max() < 1e-15


@pytest.mark.capability("V-persp")
@pytest.mark.capability("V-mper")
def test_tv67_perspective_and_orthographic_in_one():
    expected = [
        [-1.6, 0, -0.2, 0],
        [0, -2.28571428571429, -0.142857142857143, 0],
        [0, 0, -1.22222222222222, -4.44444444444444],
        [0, 0, 1, 0],
    ]
    assert np.allclose(VOLUME.orthographic_perspective, expected, rtol=0, atol=1e-12)
    assert np.allclose(VOLUME.orthographic_perspective, VOLUME.orthographic @ VOLUME.perspective, atol=1e-15)


@pytest.mark.capability("V-full")
def test_tv68_pixels_depth_and_weight():
    image = vw.homogeneous(P) @ vw.pixel_matrix(CAMERA, VOLUME, 640, 480).T
    assert image[3] == pytest.approx(-7.58307168570074, abs=1e-12)
    expected = (315.890662355929, 198.154469859322, -0.636121413914521)
    assert np.allclose(vw.dehomogenized(image), expected, rtol=1e-13, atol=1e-12)


@pytest.mark.capability("V-full")
@pytest.mark.hard(5)
def test_segments_are_cut_at_the_near_plane_before_the_division():
    eye, gaze, up = np.array(EYE, dtype=float), np.array(GAZE), np.array(UP)
    _, _, w = vw.basis_of_gaze(gaze, up)
    in_front, behind, near = eye - 5 * w + (0.3, 0.2, 0.1), eye + 4 * w + (0.1, -0.4, 0.2), eye - 2 * w
    starts = np.array([in_front, behind, behind, in_front])
    ends = np.array([behind, in_front, eye + w, near])
    p, q, seen = vw.segments_to_pixels(starts, ends, CAMERA, VOLUME, 640, 480)
    assert seen.tolist() == [True, True, False, True]
    assert np.isfinite(p).all() and np.isfinite(q).all()
    image = vw.transformed(vw.pixel_matrix(CAMERA, VOLUME, 640, 480), in_front)
    assert np.allclose(p[0], image, atol=1e-10) and np.allclose(q[1], image, atol=1e-10)
    # The cut is at the near plane, whose depth is 1, on the segment.
    assert q[0, 2] == pytest.approx(1.0, abs=1e-13) and np.allclose(q[0], p[1], atol=1e-10)
    t = (vw.transformed(CAMERA, in_front)[2] + 2) / (
        vw.transformed(CAMERA, in_front)[2] - vw.transformed(CAMERA, behind)[2]
    )
    cut = in_front + t * (behind - in_front)
    assert np.allclose(q[0], vw.transformed(vw.pixel_matrix(CAMERA, VOLUME, 640, 480), cut), atol=1e-9)
    # Dividing first would have put the point behind the eye somewhere else.
    naive = vw.transformed(vw.pixel_matrix(CAMERA, VOLUME, 640, 480), behind)
    assert np.abs(naive[:2] - q[0, :2]).max() > 1.0


@pytest.mark.capability("V-full")
def test_the_lecture_s_pixels_equal_the_book_s():
    eye, target = (10, 5, 7), (1, 2, -1)
    camera = Camera(eye, target, up=(0, 0, 1), fov_deg=30)
    screen = CoordinateSystem.of_screen(camera, PixelWindow(800, 600))
    volume = ViewVolume.of_field(30, 800 / 600, -1, -100)
    matrix = vw.pixel_matrix(vw.camera_matrix(eye, np.subtract(target, eye), (0, 0, 1)), volume, 800, 600)
    points = np.random.default_rng(13).uniform(-3, 3, (100, 3))
    # The book counts from the window's corner, the lecture from the first pixel's centre.
    assert np.allclose(vw.transformed(matrix, points)[:, :2] + 0.5, screen.from_world(points)[:, :2], atol=1e-9)
