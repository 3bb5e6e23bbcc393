from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.rotations import rotation_about
from vectorplot.textbook.polyhedra import contour_branches, contour_edges, counterclockwise, spatial_hull

CUBE = Mesh.from_polygons(
    [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)],
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4]],
)


def solid_of(points):
    """The convex hull of points as a mesh of triangles, counter-clockwise from outside."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    triangles = hull.simplices.copy()
    normal = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]]
    )
    inward = (normal * hull.equations[:, :3]).sum(axis=1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return Mesh.from_triangles(points, triangles)


def torus(around=24, across=12, major=3.0, minor=1.0):
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    ring = major + minor * np.cos(b)
    points = np.stack([ring * np.cos(a), ring * np.sin(a), minor * np.sin(b)], axis=-1).reshape(-1, 3)

    def at(i, j):
        return ((i % around) * across + j % across).ravel()

    faces = np.stack([at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)], axis=1)
    return Mesh.from_polygons(points, faces.tolist())


def hull_2d(points):
    from scipy.spatial import ConvexHull

    return points[ConvexHull(points).vertices]


def same_ring(a, b, tolerance):
    start = np.argmin(np.abs(b - a[0]).max(axis=1))
    return len(a) == len(b) and np.abs(a - np.roll(b, -start, axis=0)).max() <= tolerance


@pytest.mark.capability("G6.1-spatial-hull")
@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_image_of_the_spatial_hull_is_the_hull_of_the_image(scale, offset):
    rng = np.random.default_rng(14)
    offset *= scale
    for _ in range(15):
        points = scale * rng.normal(size=(30, 3)) + offset
        mesh = solid_of(points)
        eye = scale * 12 * rng.normal(size=3) + offset
        if np.linalg.norm(eye - offset) < 6 * scale:
            continue
        camera = Camera(tuple(eye), (offset,) * 3)
        sun = CoordinateSystem.of_parallel_light(eye - offset, (offset,) * 3)
        for system, centre in ((CoordinateSystem.of_image(camera), eye), (sun, np.append(eye - offset, 0.0))):
            image = system.from_world(points)[:, :2]
            ring = image[spatial_hull(mesh, centre)]
            assert same_ring(ring, hull_2d(image), 1e-8 * scale)


@pytest.mark.capability("G6.1-spatial-hull")
def test_quadrilaterals_edge_on_and_straight_views_of_a_cube():
    assert len(spatial_hull(CUBE, (5, 6, 7))) == 6
    top = spatial_hull(CUBE, (0, 0, 5))
    assert sorted(top.tolist()) == [4, 5, 6, 7]
    assert sorted(spatial_hull(CUBE, (0, 0, 1, 0)).tolist()) == [4, 5, 6, 7]
    # The eye in the plane of two faces: these count as turned away.
    assert sorted(spatial_hull(CUBE, (1, 1, 5)).tolist()) == [4, 5, 6, 7]
    image = CUBE.vertices[top][:, :2]
    assert np.array_equal(counterclockwise(image), image)
    assert len(spatial_hull(CUBE, (0.1, 0.2, 0.3))) == 0


@pytest.mark.capability("G6.1-spatial-hull")
def test_single_polygons_and_bodies_with_holes_are_closed_in_the_mind():
    # Erratum G6-01: open sheets need front and back faces.
    square = Mesh.from_polygons([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [[0, 1, 2, 3]])
    assert spatial_hull(square, (3, 4, 5)).tolist() == [0, 1, 2, 3]
    below = spatial_hull(square, (3, 4, -5))
    assert sorted(below.tolist()) == [0, 1, 2, 3]
    assert contour_branches(square, (3, 4, 0)).points.tolist() == []
    flat = CoordinateSystem.of_image(Camera((3, 4, -5))).from_world(square.vertices)[below]
    assert np.array_equal(counterclockwise(flat), flat)
    whole = spatial_hull(CUBE, (5, 6, 7)).tolist()
    missing = Mesh.from_polygons(CUBE.vertices, CUBE.polygons()[1:])
    marked = Mesh(CUBE.vertices, CUBE.corners, CUBE.offsets, np.array([True, False, True, True, True, False]))
    for eye in ((5, 6, 7), (5, 6, -7), (0.5, 0.2, -9), (-3, 9, 0.1)):
        whole = set(spatial_hull(CUBE, eye).tolist())
        assert set(spatial_hull(missing, eye).tolist()) == whole
        assert set(spatial_hull(marked, eye).tolist()) == whole


@pytest.mark.capability("G6.1-spatial-hull")
def test_a_torus_has_no_convex_outline():
    with pytest.raises(InputError, match="2 branches"):
        spatial_hull(torus(), (0.5, 1, 20))


@pytest.mark.capability("G6.1-concat")
def test_a_torus_contour_gives_two_closed_branches():
    mesh = torus()
    branches = contour_branches(mesh, (0.5, 1, 20))
    assert len(branches) == 2 and branches.closed.all()
    assert np.diff(branches.offsets).sum() == len(contour_edges(mesh, (0.5, 1, 20)))
    radii = [np.linalg.norm(mesh.vertices[branches[k]][:, :2], axis=1).mean() for k in (0, 1)]
    assert min(radii) < 2.6 and max(radii) > 3.4


def edges_of(branches):
    found = []
    for k in range(len(branches)):
        points = branches[k].tolist()
        found += list(zip(points, points[1:] + points[:1] * bool(branches.closed[k]), strict=False))
    return found


@pytest.mark.capability("G6.1-concat")
@given(st.data())
def test_shuffled_chains_and_rings_come_back_whole(data):
    sizes = data.draw(st.lists(st.tuples(st.integers(2, 9), st.booleans()), min_size=1, max_size=6))
    edges, expected, first = [], [], 0
    for size, is_ring in sizes:
        ring = is_ring and size > 2
        nodes = list(range(first, first + size))
        first += size
        pairs = list(zip(nodes, nodes[1:] + nodes[:1] * ring, strict=False))
        edges += pairs
        expected.append((ring, frozenset(frozenset(p) for p in pairs)))
    order = data.draw(st.permutations(range(len(edges))))
    flips = data.draw(st.lists(st.booleans(), min_size=len(edges), max_size=len(edges)))
    shuffled = [edges[k][::-1] if flips[k] else edges[k] for k in order]
    branches = concat(shuffled)
    got = []
    for k in range(len(branches)):
        points = branches[k].tolist()
        pairs = zip(points, points[1:] + points[:1] * bool(branches.closed[k]), strict=False)
        got.append((bool(branches.closed[k]), frozenset(frozenset(p) for p in pairs)))
        if branches.closed[k]:
            assert len(set(points)) == len(points)
    assert sorted(map(repr, map(lambda x: (x[0], sorted(map(sorted, x[1]))), got))) == sorted(
        map(repr, map(lambda x: (x[0], sorted(map(sorted, x[1]))), expected))
    )
    assert tuple(shuffled[0]) in edges_of(branches)


@pytest.mark.capability("G6.1-concat")
@given(st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=25))
@settings(deadline=None)
def test_every_edge_of_any_graph_is_used_once(edges):
    branches = concat(edges)
    found = sorted(tuple(sorted(e)) for e in edges_of(branches))
    assert found == sorted(tuple(sorted(e)) for e in edges if e[0] != e[1])
    degree = np.bincount([x for e in edges if e[0] != e[1] for x in e], minlength=1)
    assert int((~branches.closed).sum()) == int((degree % 2).sum()) // 2


@pytest.mark.capability("G6.1-concat")
def test_an_open_branch_is_continued_from_its_other_end():
    # Erratum G8-11.
    branches = concat([(5, 6), (6, 7), (4, 5), (3, 4)])
    assert branches.points.tolist() == [3, 4, 5, 6, 7] and branches.closed.tolist() == [False]
    assert concat(np.zeros((0, 2), dtype=int)).points.tolist() == []
    ring = concat([(1, 2), (3, 1), (3, 2)])
    assert ring.points.tolist() == [1, 2, 3] and ring.closed.tolist() == [True]


@pytest.mark.capability("G6.1-concat")
def test_a_hundred_thousand_edges_are_joined_in_no_loop():
    rng = np.random.default_rng(15)
    nodes = rng.permutation(100_000)
    edges = np.stack([nodes, np.roll(nodes, -1)], axis=1)[rng.permutation(100_000)]
    branches = concat(edges)
    assert len(branches) == 1 and branches.closed[0]
    start = np.flatnonzero(nodes == branches.points[0])[0]
    assert np.array_equal(branches.points, np.roll(nodes, -start))


@pytest.mark.capability("G6.1-orient")
@given(st.integers(3, 9), st.integers(-40, 40), st.booleans())
def test_polygons_are_made_counterclockwise_however_small(count, power, clockwise):
    angles = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angles), np.sin(angles), angles], axis=1) * 2.0**power
    given_ring = ring[::-1] if clockwise else ring
    turned = counterclockwise(given_ring)
    assert np.array_equal(turned[0], given_ring[0])
    assert np.array_equal(turned, np.roll(ring, 1, axis=0) if clockwise else ring)


@pytest.mark.capability("G6.1-orient")
def test_tiny_areas_far_from_the_origin_are_turned_right():
    # The area is one rounding step high; a sum of x y products would drown it.
    ulp = np.spacing(1e6)
    thin = np.array([(1e6, 1e6), (1e6 + 1, 1e6 + 1), (1e6 + 2, 1e6 + 2 + ulp), (1e6 + 1, 1e6 + 1 + ulp)])
    assert np.array_equal(counterclockwise(thin), thin)
    assert np.array_equal(counterclockwise(thin[::-1]), thin[[3, 0, 1, 2]])
    flat = np.array([(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)])
    assert np.array_equal(counterclockwise(flat), flat)


@pytest.mark.capability("G6.1-spatial-hull")
def test_the_hull_turns_with_the_body():
    turn = rotation_about((1, 2, 3), 0.8)
    turned = Mesh(CUBE.vertices @ turn, CUBE.corners, CUBE.offsets)
    eye = np.array([5.0, 6.0, 7.0])
    assert spatial_hull(turned, eye @ turn).tolist() == spatial_hull(CUBE, eye).tolist()


@pytest.mark.capability("G6.1-spatial-hull")
@pytest.mark.hard(1)
@pytest.mark.parametrize("offset", [0.0, 1e3])
def test_faces_seen_edge_on_do_not_enter_the_hull_by_rounding(offset):
    rng = np.random.default_rng(18)
    for _ in range(50):
        turn = rotation_about(rng.normal(size=3), rng.uniform(0, 6))
        turned = Mesh(CUBE.vertices @ turn + offset, CUBE.corners, CUBE.offsets)
        in_two_face_planes = np.array([1.0, -1.0, 5.0]) @ turn + offset
        assert sorted(spatial_hull(turned, in_two_face_planes).tolist()) == [4, 5, 6, 7]
