import numpy as np
import pytest

from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import Mending, is_closed_oriented, mesh_report, repaired

EPS32 = 2.0**-23
CUBE = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
UNIT = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)


def soup(vertices: np.ndarray, faces: list[list[int]]) -> Mesh:
    """The faces with no shared vertices."""
    points = vertices[[c for face in faces for c in face]]
    offsets = np.cumsum([0, *map(len, faces)])
    return Mesh(points, np.arange(len(points)), offsets)


def test_a_closed_mesh_is_left_as_it_is() -> None:
    mesh = Mesh.from_polygons(UNIT, CUBE)
    after, mending = repaired(mesh, EPS32)
    assert mending == Mending()
    assert str(mending) == ""
    assert np.array_equal(after.corners, mesh.corners) and np.array_equal(after.vertices, mesh.vertices)


def test_touching_closed_bodies_keep_their_own_vertices() -> None:
    mesh = Mesh.from_polygons(
        np.concatenate([UNIT, UNIT + np.array([1, 0, 0])]), CUBE + [[c + 8 for c in f] for f in CUBE]
    )
    after, mending = repaired(mesh, EPS32)
    assert len(after.vertices) == 16
    assert mending == Mending()


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_a_soup_is_welded_exactly(scale: float, offset: float) -> None:
    after, mending = repaired(soup((UNIT + offset) * scale, CUBE), EPS32)
    assert len(after.vertices) == 8
    assert mending == Mending(welded=16)
    assert is_closed_oriented(after)


def test_a_border_is_welded_within_the_precision_of_the_file() -> None:
    torn = soup(UNIT + 5.0, CUBE)
    noise = np.random.default_rng(0).uniform(-1, 1, torn.vertices.shape) * EPS32 * 6.0 * 0.5
    shaken = Mesh(torn.vertices + noise, torn.corners, torn.offsets)
    after, mending = repaired(shaken, EPS32)
    assert len(after.vertices) == 8 and mending == Mending(welded=16)
    left, mending = repaired(shaken, 2.0**-52)
    assert len(left.vertices) == 24 and mending.boundary_edges == 24


@pytest.mark.hard(13)
def test_open_mesh_is_kept_and_its_boundary_counted() -> None:
    after, mending = repaired(Mesh.from_polygons(UNIT, CUBE[:1] + CUBE[2:]), EPS32)
    assert after.face_count == 5
    assert str(mending) == "open mesh (4 boundary edges)"


@pytest.mark.hard(14)
def test_mixed_winding_is_made_consistent_and_outwards() -> None:
    for turned in ([0], [0, 1, 2], [0, 1, 2, 3, 4], [0, 1, 2, 3, 4, 5]):
        faces = [face[::-1] if k in turned else face for k, face in enumerate(CUBE)]
        after, mending = repaired(Mesh.from_polygons(UNIT, faces), EPS32)
        assert mending.turned == len(turned)
        assert np.allclose((after.face_normals * (after.vertices[after.corners[::4]] - 0.5)).sum(axis=1), 0.5)


@pytest.mark.hard(15)
def test_welded_soup_of_triangles_has_the_edges_of_the_solid() -> None:
    triangles = [[f[0], f[k], f[k + 1]] for f in CUBE for k in (1, 2)]
    report = mesh_report(repaired(soup(UNIT, triangles), EPS32)[0])
    assert (report.vertices, report.edges, report.faces) == (8, 18, 12)
    assert report.closed and report.oriented and report.convex


@pytest.mark.hard(16)
def test_zero_area_and_repeated_index_faces_are_dropped_and_counted() -> None:
    faces = [*CUBE, [0, 0, 1], [0, 1, 1, 0], [2, 2, 2]]
    after, mending = repaired(Mesh.from_polygons(UNIT, faces), EPS32)
    assert after.face_count == 6 and mending == Mending(degenerate=3)
    assert str(mending) == "dropped 3 degenerate faces"
    line = np.array([[0, 0, 0], [1, 1, 1], [2, 2, 2], [1, 0, 0]]) * 1e-6 + 1.0
    after, mending = repaired(Mesh.from_triangles(line, [[0, 1, 2], [0, 1, 3]]), EPS32)
    assert after.face_count == 1 and mending.degenerate == 1


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_sliver_of_one_to_1e8_is_no_degenerate_face(scale: float) -> None:
    sliver = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-8, 0]]) * scale
    assert repaired(Mesh.from_triangles(sliver, [[0, 1, 2]]), EPS32)[1].degenerate == 0
    assert repaired(Mesh.from_triangles(sliver, [[0, 2, 1]]), EPS32)[0].face_count == 1


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_degenerate_triangle_in_an_edge_leaves_no_hole(scale: float) -> None:
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 0, 0]]) * scale
    # The edge from 0 to 1 is split at 4 on the one side only; a triangle without area fills the gap.
    faces = [[0, 2, 1], [0, 4, 3], [4, 1, 3], [1, 2, 3], [2, 0, 3], [0, 1, 4]]
    assert is_closed_oriented(Mesh.from_triangles(points, faces))
    after, mending = repaired(Mesh.from_triangles(points, faces), EPS32)
    assert mending.degenerate == 1
    assert is_closed_oriented(after)
    assert after.is_triangular
    assert np.isclose(np.linalg.norm(after.area_vectors, axis=1).sum(), (3 * 4 + 4 * np.sqrt(3)) * scale**2)


@pytest.mark.hard(12)
def test_edges_of_three_faces_are_kept_and_counted() -> None:
    points = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, -1, 0]], dtype=float)
    after, mending = repaired(Mesh.from_triangles(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]), EPS32)
    assert after.face_count == 3
    assert str(mending) == "open mesh (6 boundary edges), 1 non-manifold edge"
    assert len(after.vertices) == 5


def test_faces_listed_twice_are_dropped() -> None:
    after, mending = repaired(Mesh.from_polygons(UNIT, CUBE + CUBE[:2]), EPS32)
    assert mending == Mending(repeated=2) and is_closed_oriented(after)


def test_report_of_a_cube() -> None:
    report = mesh_report(Mesh.from_polygons(UNIT * [1, 2, 3], CUBE))
    assert (report.vertices, report.edges, report.faces, report.components) == (8, 12, 6, 1)
    assert report.closed and report.oriented and report.convex
    assert report.bounds == ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_convexity(scale: float) -> None:
    dented = UNIT.copy()
    dented[6] = [0.4, 0.4, 0.4]
    triangles = [[f[0], f[k], f[k + 1]] for f in CUBE for k in (1, 2)]
    assert mesh_report(Mesh.from_triangles(UNIT * scale + scale, triangles)).convex
    assert not mesh_report(Mesh.from_triangles(dented * scale, triangles)).convex
    assert not mesh_report(Mesh.from_polygons(UNIT * scale, CUBE[1:])).convex
    assert not mesh_report(Mesh.from_polygons(UNIT * scale, CUBE).reversed()).convex


def test_a_pentagram_bipyramid_is_convex_at_every_edge_but_not_convex() -> None:
    angle = np.arange(5) * 4.0 * np.pi / 5.0
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]])
    faces = [[k, (k + 1) % 5, 5] for k in range(5)] + [[(k + 1) % 5, k, 6] for k in range(5)]
    report = mesh_report(Mesh.from_triangles(points, faces))
    assert report.closed and report.oriented and not report.convex


def test_mesh_without_faces() -> None:
    report = mesh_report(Mesh.from_polygons(np.zeros((0, 3)), []))
    assert (report.faces, report.components, report.convex) == (0, 0, False)


def test_pieces_that_touch_in_a_point_share_no_vertex() -> None:
    tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    shape = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    faces = tetrahedron + [[c + 4 for c in face] for face in tetrahedron]
    after, mending = repaired(soup(np.concatenate([shape, -shape]), faces), EPS32)
    assert len(after.vertices) == 8 and mending.boundary_edges == mending.nonmanifold_edges == 0
    assert set(after.corners[:12]).isdisjoint(after.corners[12:])
    assert mesh_report(after).components == 2
