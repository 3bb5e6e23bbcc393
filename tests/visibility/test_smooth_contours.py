"""Contours across the faces of meshes: near those of the true surface, in as many parts, and hidden as they are."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features, surfaces
from vectorplot.features.feature_lines import Sight
from vectorplot.features.mesh_feature_lines import smooth_contours
from vectorplot.geometry import box
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import with_lines

TORUS = surfaces.Torus(3.0, 1.0)
CAMERA = vp.Camera((20, 3, 8))
PAGE = vp.Page(100, 100)


def torus_mesh(rows):
    u, v = np.meshgrid(*TORUS.domain.grid(2 * rows, rows), indexing="ij")
    return features.mesh_of_grid(TORUS.points(u, v), closed_u=True, closed_v=True)


def drawn(shape, lines="contour", **how):
    scene = with_lines(vp.Scene((vp.Item("shape", shape),)), smooth_contours=True)
    return vp.draw(scene, CAMERA, lines=lines, hidden="solid", page=PAGE, fit=False, **how)


def lengths(drawing):
    """The lengths of lines that are seen and that are not, and the number of strokes."""
    found, count = [0.0, 0.0], 0
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for begin, end, closed, hidden in zip(
            paths.offsets[:-1], paths.offsets[1:], paths.closed, paths.hidden_by, strict=True
        ):
            points = paths.points[begin:end]
            points = np.concatenate([points, points[:1]]) if closed else points
            found[int(hidden > 0)] += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
            count += 1
    return np.array(found), count


@pytest.mark.slow
def test_contours_of_meshes_of_a_torus_are_seen_as_those_of_the_torus():
    true, _ = lengths(vp.draw(TORUS, CAMERA, lines="contour", hidden="solid", page=PAGE, fit=False))
    off = []
    for rows in (24, 48):
        found, count = lengths(drawn(torus_mesh(rows)))
        assert count == 5, "the outline, and the near side of the hole between two cusps, which goes on behind"
        off.append(np.abs(found - true).max() / true.sum())
    assert off[0] < 0.005 and off[1] < 0.5 * off[0]


@pytest.mark.parametrize("turned", [False, True], ids=["out", "in"])
@pytest.mark.parametrize("open_", [False, True], ids=["closed", "open"])
def test_normals_of_either_side_of_closed_and_open_meshes_make_one_picture(turned, open_):
    mesh = torus_mesh(24)
    faces = mesh.corners.reshape(mesh.face_count, -1)[int(open_) :]
    mesh = vp.Mesh.from_polygons(mesh.vertices, (faces[:, ::-1] if turned else faces).tolist())
    seen, hidden = lengths(drawn(mesh))[0]
    true_seen, true_hidden = lengths(drawn(torus_mesh(24)))[0]
    assert abs(seen - true_seen) < 0.01 * true_seen and abs(hidden - true_hidden) < 0.05 * true_hidden


@pytest.mark.parametrize("sight", ["central", "parallel"])
def test_contours_of_a_ball_come_nearer_to_its_circle_by_the_square_of_the_edges(sight):
    eye = np.array([8.0, 3.0, 4.0])
    far = np.linalg.norm(eye)
    looking = Sight(eye if sight == "central" else None, eye / far)
    off = []
    for rows in (12, 24):
        u, v = np.meshgrid(*surfaces.Sphere().domain.grid(2 * rows, rows), indexing="ij")
        ball = features.mesh_of_grid(surfaces.Sphere().points(u, v), closed_u=True)
        found = smooth_contours(ball, looking, 60.0)
        height = found.start @ eye / far - (1.0 / far if sight == "central" else 0.0)
        off.append(max(np.abs(height).max(), np.abs(np.linalg.norm(found.start, axis=1) - 1.0).max()))
        assert (np.linalg.norm(found.start + found.aside, axis=1) > 1.0).all(), "aside leads out"
    assert off[1] < 0.4 * off[0] < 0.02


def test_what_is_before_hides_smooth_contours_and_creases_stay_edges():
    wall = vp.Item("wall", box((0.2, 20, 20)).moved(6, -10, -10))
    ball = surfaces.Sphere()
    u, v = np.meshgrid(*ball.domain.grid(24, 12), indexing="ij")
    mesh = features.mesh_of_grid(ball.points(u, v), closed_u=True)
    scene = with_lines(vp.Scene((wall, vp.Item("ball", mesh))), smooth_contours=True)
    drawing = vp.draw(scene, CAMERA, lines="contour")
    assert {k for layer in drawing.layers for paths in layer.strokes for k in paths.item.tolist()} == {0}
    cube = box((2, 2, 2))
    plain = vp.draw(cube, CAMERA, page=PAGE, fit=False, hidden="solid")
    assert np.allclose(lengths(drawn(cube, lines=None))[0], lengths(plain)[0])


def test_a_smooth_surface_beside_it_changes_nothing():
    alone = lengths(drawn(torus_mesh(24)))[0]
    items = (
        vp.Item("ring", torus_mesh(24)),
        vp.Item("far", surfaces.Ellipsoid((0.3, 0.2, 0.1), (0.0, 9.0, 0.0)), lines=()),
    )
    both = with_lines(vp.Scene(items), smooth_contours=True)
    found = lengths(vp.draw(both, CAMERA, lines="contour", hidden="solid", page=PAGE, fit=False))[0]
    assert np.allclose(found, alone, rtol=1e-6)


def test_scene_files_have_the_word():
    scene = parse_scene("B box 1 1 1 smooth_contours")
    assert scene.items[0].curves.smooth_contours
    assert parse_scene(write_scene(scene)).items[0].curves.smooth_contours


@pytest.mark.parametrize("count", [32, 128])
@pytest.mark.parametrize("length", [1.0, 100.0])
def test_contours_leave_long_thin_faces_no_farther_than_these_leave_the_shape(count, length):
    turn = np.arange(count) * 2 * np.pi / count
    rims = np.stack(np.broadcast_arrays(np.cos(turn)[:, None], np.sin(turn)[:, None], [0.0, length]), axis=-1)
    faces = np.arange(2 * count).reshape(count, 2)
    quads = np.concatenate([faces, np.roll(faces, -1, axis=0)[:, ::-1]], axis=1)
    can = vp.Mesh.from_polygons(
        rims.reshape(-1, 3), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).tolist()
    )
    eye = np.array([20.0, 3.0, 8.0])
    found = smooth_contours(can, Sight(eye, eye / np.linalg.norm(eye)), 60.0)
    deviation, away = 1.0 - np.cos(np.pi / count), np.linalg.norm(found.aside, axis=1)
    assert len(found.start) and away.max() < 5.0 * deviation
    assert (np.linalg.norm((found.start + found.aside)[:, :2], axis=1) > 1.0 - 1e-12).all(), "aside leads out"
