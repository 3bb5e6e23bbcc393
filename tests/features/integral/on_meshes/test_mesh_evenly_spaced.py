"""Integral curves that cover meshes evenly."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from vectorplot import Mesh, features
from vectorplot.errors import InputError
from vectorplot.features.mesh_streamlines import _away, evenly_spaced_mesh_curves
from vectorplot.surfaces.quadrics import implicit_sphere
from vectorplot.testing import assert_integral_curve
from vectorplot.testing.shapes import box

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


def along(curves, step):
    """Points along every curve, a step apart."""
    for k in range(len(curves)):
        line = curves[k]
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        at = np.linspace(0.0, run[-1], max(int(run[-1] / step), 2))
        yield np.stack([np.interp(at, run, x) for x in line.T], axis=1)


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1.0, 1e6)])
def test_they_follow_the_field_keep_apart_and_leave_no_wide_gaps(scale, offset):
    ball = features.polygonized(implicit_sphere(1.0), 10)
    ball = Mesh(ball.vertices * scale + offset, ball.corners, ball.offsets)
    field, apart = features.TurnedField(features.SteepestSlope(), 1.2), 0.3 * scale
    found = evenly_spaced_mesh_curves(ball, field, apart)
    assert len(found) > 5
    if offset == 0.0:
        assert_integral_curve([found[k] for k in range(len(found))], ball, field, 1e-7)
    lines = list(along(found, 0.1 * apart))
    places = np.concatenate(lines)
    owner = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    near = cKDTree(places).query_pairs(0.25 * apart, output_type="ndarray")
    assert (owner[near[:, 0]] == owner[near[:, 1]]).all()
    centres = ball.vertices[np.abs(ball.vertices[:, 2] - offset) < 0.9 * scale]
    assert cKDTree(places).query(centres)[0].max() < 2.0 * apart


@pytest.mark.capability("G9.4-polyhedron")
def test_large_faces_are_covered_and_lines_without_end_are_not_too_many():
    found = evenly_spaced_mesh_curves(CUBE, features.SteepestSlope(), 0.2)
    upright = [found[k].round(12) for k in range(len(found))]
    assert all(np.array_equal(np.ptp(line, axis=0), (0.0, 0.0, 2.0)) for line in upright)
    for axis in (0, 1):
        for side in (-1.0, 1.0):
            wall = np.sort([line[0, 1 - axis] for line in upright if line[0, axis] == side])
            gaps = np.diff(np.concatenate([[-1.0], wall, [1.0]]))
            assert len(wall) >= 7 and gaps.max() < 0.4 and np.diff(wall).min() > 0.1


def test_mistakes_about_them_are_told():
    slope = features.SteepestSlope()
    for call, cause in (
        (lambda: evenly_spaced_mesh_curves(CUBE, slope, 0.0), "distance"),
        (lambda: evenly_spaced_mesh_curves(CUBE, slope, 1e-3), "expected 0.004 or more"),
        (lambda: evenly_spaced_mesh_curves(CUBE, features.loxodromes(1.0), 0.1), "only surfaces with param"),
    ):
        with pytest.raises(InputError, match=cause):
            call()
    assert len(evenly_spaced_mesh_curves(Mesh.from_polygons(CUBE.vertices, []), slope, 0.1)) == 0


@pytest.mark.slow
def test_every_part_of_a_mesh_of_many_is_covered_with_one_even_family_a_face():
    away = 4.0 * np.stack(np.meshgrid(np.arange(5), np.arange(5), [0.0]), axis=-1).reshape(-1, 3)
    count = len(CUBE.vertices)
    town = Mesh(
        (CUBE.vertices + away[:, None]).reshape(-1, 3),
        (CUBE.corners + count * np.arange(len(away))[:, None]).ravel(),
        np.append((CUBE.offsets[:-1] + len(CUBE.corners) * np.arange(len(away))[:, None]).ravel(), len(away) * 24),
    )
    found = evenly_spaced_mesh_curves(town, features.SteepestSlope(), 0.2)
    walls = np.flatnonzero(np.abs(town.face_normals[:, 2]) < 0.5)
    lines = np.bincount(found.faces[found.offsets[:-1]], minlength=town.face_count)[walls]
    assert lines.min() >= 9 and lines.max() <= 11


def test_how_far_gaps_are_is_exact_where_they_are_near_and_known_roughly_elsewhere():
    turns = np.linspace(0.0, 6.0 * np.pi, 4000)
    taken = np.stack([np.cos(turns), np.sin(turns), 0.1 * turns, *np.zeros((3, len(turns)))], axis=1)
    where = np.random.default_rng(2).uniform(-9.0, 9.0, (500, 6)) * (1.0, 1.0, 1.0, 0.1, 0.1, 0.1)
    where[0] = (0.0, 0.0, 0.5, 0.0, 0.0, 0.0)  # as far from everything around it
    tree = cKDTree(taken)
    exact, away = tree.query(where)[0], _away(tree, where, 0.4)
    assert (away >= exact).all()
    assert (away <= 1.25 * exact).all()
    assert np.array_equal(away[exact < 0.4], exact[exact < 0.4])
    assert len(_away(tree, where[:0], 0.4)) == 0
