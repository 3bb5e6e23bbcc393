"""Shortest ways on meshes: closed forms, ways back, finer triangles of the same shape, and straight all along."""

import numpy as np
import pytest

from vectorplot import Mesh, features
from vectorplot.errors import InputError
from vectorplot.features import mesh_shortest_paths
from vectorplot.features.shortest_paths import mesh_distances
from vectorplot.geometry.budget import Budget
from vectorplot.surfaces.quadrics import implicit_sphere
from vectorplot.testing import assert_geodesic
from vectorplot.testing.shapes import box

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


def lengths(curves):
    return np.array([np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves))])


def from_bottom_to_top(one, two):
    """How far it is from (x, y) on the bottom of the cube to the top: over one wall, or over two next to each other."""
    found = []
    for turn in range(4):
        (x, y), (a, b) = one, two
        for _ in range(turn):
            (x, y), (a, b) = (-y, x), (-b, a)
        # The top folded down over the wall x = 1; and over this wall and the next one, to either side.
        found.append(np.hypot((1 - x) + 2 + (1 - a), b - y))
        found += [np.hypot((1 - x) + 2 + (1 - s * b), (1 - s * y) + (1 - a)) for s in (1, -1)]
    return min(found)


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
def test_on_a_cube_they_are_as_long_as_on_its_best_unfolding():
    rng = np.random.default_rng(5)
    one, two = rng.uniform(-1, 1, (2, 25, 2))
    start, end = (np.column_stack([p, np.full(len(p), z)]) for p, z in ((one, -1.0), (two, 1.0)))
    found = mesh_shortest_paths(CUBE, start, end)
    expected = [from_bottom_to_top(p, q) for p, q in zip(one, two, strict=True)]
    assert np.abs(lengths(found) - expected).max() < 1e-14 and found.levels.tolist() == list(range(25))
    assert_geodesic([found[k] for k in range(25)], CUBE, 1e-9)
    # Along a face, over an edge, and the spider and the fly of Dudeney, whose way of 40 feet crosses five of six faces.
    assert lengths(mesh_shortest_paths(CUBE, (-1, -1, -1), (1, 1, 1)))[0] == pytest.approx(np.sqrt(20), abs=1e-14)
    room = box((0.0, 0.0, 0.0), (30.0, 12.0, 12.0))
    way = mesh_shortest_paths(room, (0.0, 6.0, 11.0), (30.0, 6.0, 1.0))
    assert lengths(way)[0] == pytest.approx(40.0, abs=1e-12) and len(set(way.faces[:-1].tolist())) == 5


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize("turn", [0.5, 3.0, 6.0, 9.0])
def test_on_cones_they_are_straight_in_the_unrolled_plane_or_go_through_the_apex(turn):
    # Triangles about an apex whose angles add up to a given turn; a folded fan where this is more than a whole one.
    count = 24
    around = 2 * np.pi * np.arange(count) / count
    rise = np.where(np.arange(count) % 2, 1.0, -1.0) if turn > 2 * np.pi else np.ones(count)
    low, high = 0.0, 50.0
    for _ in range(200):
        h = 0.5 * (low + high)
        ring = np.column_stack([np.cos(around), np.sin(around), h * rise])
        ring /= np.linalg.norm(ring, axis=1)[:, None]
        angle = np.arccos((ring * np.roll(ring, -1, axis=0)).sum(axis=1)).sum()
        low, high = (h, high) if (angle < turn) == (turn > 2 * np.pi) else (low, h)
    mesh = Mesh.from_triangles(np.vstack([ring, np.zeros(3)]), [(k, (k + 1) % count, count) for k in range(count)])
    for k in range(1, count, 3):
        apart = min(k, count - k) * turn / count
        expected = 1.2 * np.sin(0.5 * apart) if apart < np.pi else 1.2
        found = mesh_shortest_paths(mesh, 0.6 * ring[0], 0.6 * ring[k])
        assert abs(lengths(found)[0] - expected) < 1e-12


def subdivided(mesh):
    triangles = np.array(mesh.polygons())
    edges = np.sort(np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    edges, number = np.unique(edges, axis=0, return_inverse=True)
    a, b, c = np.split(len(mesh.vertices) + number.ravel(), 3)
    p, q, r = triangles.T
    parts = [np.stack(part, axis=1) for part in ((p, a, c), (a, q, b), (c, b, r), (a, b, c))]
    return Mesh.from_triangles(np.vstack([mesh.vertices, mesh.vertices[edges].mean(axis=1)]), np.concatenate(parts))


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.spread
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e3, 1e6)])
def test_on_rough_ground_with_holes_they_do_not_depend_on_its_triangles_and_are_the_same_back(seed, scale, offset):
    rng, n = np.random.default_rng(seed), 7
    x, y = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    points = np.stack([x, y, rng.uniform(0.0, (0.1, 0.4, 1.0)[seed % 3], x.shape)], axis=-1).reshape(-1, 3)
    g = np.arange(n * n).reshape(n, n)
    corners = g[:-1, :-1], g[1:, :-1], g[1:, 1:], g[:-1, 1:]
    faces = np.concatenate(
        [np.stack([corners[k] for k in part], axis=-1).reshape(-1, 3) for part in ((0, 1, 2), (0, 2, 3))]
    )
    faces = np.delete(faces, rng.integers(0, len(faces), 4), axis=0)
    mesh = Mesh.from_triangles(scale * points + offset, faces)
    finer = subdivided(mesh)
    inner = mesh.vertices[faces[rng.integers(0, len(faces), 3)]].mean(axis=1)
    ends = np.vstack([inner, mesh.vertices[faces[0, 0]], mesh.vertices[faces[-1, :2]].mean(axis=0)])
    far, fine = mesh_distances(mesh, ends[0]), mesh_distances(finer, ends[0])[: n * n]
    known = np.isfinite(far)
    error = 1e-12 * scale + 1e-14 * offset
    assert np.array_equal(known, np.isfinite(fine)) and np.abs(far[known] - fine[known]).max() < error
    ways = mesh_shortest_paths(mesh, ends, np.roll(ends, 1, axis=0))
    for others in (
        mesh_shortest_paths(mesh, np.roll(ends, 1, axis=0), ends),
        mesh_shortest_paths(finer, ends, np.roll(ends, 1, axis=0)),
    ):
        assert np.abs(lengths(ways) - lengths(others)).max() < 4.0 * error
    assert_geodesic([ways[k] for k in range(len(ways))], mesh, 1e-5)


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
def test_on_finer_and_finer_balls_they_come_near_great_circles():
    errors = []
    for n in (6, 12, 24):
        ball = features.polygonized(implicit_sphere(1.0), n)
        angle = np.arccos(np.clip(ball.vertices[:, 2] / np.linalg.norm(ball.vertices, axis=1), -1.0, 1.0))
        errors.append(np.abs(mesh_distances(ball, (0.0, 0.0, 1.0)) - angle).max())
    assert errors[1] < 0.4 * errors[0] and errors[2] < 0.4 * errors[1] and errors[2] < 0.01


@pytest.mark.capability("G9.4-polyhedron")
def test_mistakes_about_them_are_told():
    two = Mesh.from_polygons(
        np.concatenate([CUBE.vertices, CUBE.vertices + 5.0]),
        [*CUBE.polygons(), *([c + 8 for c in polygon] for polygon in CUBE.polygons())],
    )
    for call, cause in (
        (lambda: mesh_shortest_paths(two, (0, 0, 1), (5, 5, 6)), "does not join the ends of way 1"),
        (lambda: mesh_shortest_paths(CUBE, [(0, 0, 1)], [(0, 1, 0)] * 2), "1 starts and 2 ends"),
        (lambda: mesh_shortest_paths(CUBE, (0, 0, np.nan), (0, 1, 0)), "three finite numbers"),
        (lambda: mesh_distances(Mesh.from_polygons(CUBE.vertices, []), (0, 0, 1)), "no faces"),
    ):
        with pytest.raises(InputError, match=cause):
            call()
    assert len(mesh_shortest_paths(CUBE, (0, 0, 1), (0, 0, 1))) == 0
    assert np.isinf(mesh_distances(two, (0, 0, 1))[8:]).all()


@pytest.mark.slow
def test_what_is_done_is_told_grows_and_ends_the_work():
    told, early = [], []
    ends = [(0.9, 0.1, 0.2), (0.1, -0.9, 0.3)]
    mesh = features.polygonized(implicit_sphere(1.0), 12)
    mesh_shortest_paths(mesh, [(-0.9, 0.0, 0.1), (0.0, 0.9, 0.1)], ends, done=told.append)
    assert len(told) > 4 and told == sorted(told) and 0.5 < told[-1] <= 1.0

    def stop(part):
        early.append(part)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mesh_distances(mesh, (1, 0, 0), done=stop)
    assert len(early) == 1


def test_beyond_the_budget_there_is_one_line_that_says_so():
    line = r"^shortest paths on 12 triangles need more than 3 windows: .*--budget"
    with pytest.raises(InputError, match=line) as found:
        mesh_shortest_paths(CUBE, (0.2, 0.1, -1.0), (0.1, 0.3, 1.0), budget=Budget(windows=3))
    assert "\n" not in str(found.value)
    with pytest.raises(InputError, match="than 3 windows"):
        mesh_distances(CUBE, (0.2, 0.1, -1.0), budget=Budget(windows=3))
