import numpy as np
import pytest

from vectorplot.geometry.budget import threads
from vectorplot.geometry.connectivity import circulation
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import thin_faces
from vectorplot.geometry.weld import distinct_points
from vectorplot.geometry.winding import (
    consistent_winding,
    edge_uses,
    inside_out,
    is_closed_oriented,
    repeated_faces,
    signed_volumes,
    turned_faces,
)
from vectorplot.testing.shapes import bumpy_icosphere

CUBE = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]


def cube(size: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mesh:
    unit = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    return Mesh.from_polygons(unit * size + np.array(at), CUBE)


def together(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)]).tolist()
    faces = [[c + s for c in face] for mesh, s in zip(meshes, starts[:-1], strict=True) for face in mesh.polygons()]
    return Mesh.from_polygons(np.concatenate([mesh.vertices for mesh in meshes]), faces)


def moebius(count: int = 12) -> Mesh:
    angles = np.arange(count) * 2.0 * np.pi / count
    arm = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    lean = 0.3 * (arm * np.cos(angles / 2)[:, None] + np.array([0, 0, 1]) * np.sin(angles / 2)[:, None])
    faces = [[k, k + 1, k + 1 + count, k + count] for k in range(count - 1)]
    return Mesh.from_polygons(np.concatenate([arm + lean, arm - lean]), [*faces, [count - 1, count, 0, 2 * count - 1]])


def test_edges_of_a_cube() -> None:
    uses = edge_uses(cube())
    assert len(uses.count) == 12
    assert (uses.count == 2).all()
    assert uses.agree.all() and not uses.conflict.any()


def test_a_cube_is_closed_until_a_face_is_turned_or_missing() -> None:
    mesh = cube()
    assert is_closed_oriented(mesh)
    assert not is_closed_oriented(turned_faces(mesh, np.arange(6) == 2))
    assert not is_closed_oriented(Mesh.from_polygons(mesh.vertices, CUBE[1:]))
    assert is_closed_oriented(Mesh.from_triangles(mesh.vertices[:4], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))


@pytest.mark.parametrize("seed", range(5))
def test_mixed_winding_is_made_consistent(seed: int) -> None:
    mesh = together(cube(), cube(2.0, (5, 0, 0)), cube(1.0, (9, 0, 0)))
    turn = np.random.default_rng(seed).random(mesh.face_count) < 0.35
    mixed = turned_faces(mesh, turn)
    again, two_sided = consistent_winding(mixed, edge_uses(mixed))
    assert two_sided
    assert is_closed_oriented(turned_faces(mixed, again))
    # As few as possible: at most half of each cube.
    assert (again.reshape(3, 6).sum(axis=1) <= 3).all()


@pytest.mark.hard(14)
def test_a_moebius_band_is_one_sided_and_stays_as_it_is() -> None:
    band = together(moebius(), cube(1.0, (5, 0, 0)))
    mixed = turned_faces(band, np.arange(band.face_count) == 13)
    turn, two_sided = consistent_winding(mixed, edge_uses(mixed))
    assert not two_sided
    assert np.flatnonzero(turn).tolist() == [13]


def test_pieces_that_share_vertices() -> None:
    number, piece = together(cube(), cube(1.0, (3, 0, 0))).pieces
    assert number == 2
    assert piece.tolist() == [0] * 6 + [1] * 6
    shuffled = np.random.default_rng(0).permutation(16)
    mesh = together(cube(), cube(1.0, (3, 0, 0)))
    mixed = Mesh(mesh.vertices, shuffled[mesh.corners], mesh.offsets)
    assert mixed.pieces[0] == 2


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_signed_volumes_sum_to_six_volumes(offset: float) -> None:
    mesh = cube(2.0, (offset, offset, -offset))
    assert np.isclose(signed_volumes(mesh).sum(), 6.0)
    triangles = Mesh.from_triangles(mesh.vertices, [[f[0], f[k], f[k + 1]] for f in CUBE for k in (1, 2)])
    assert np.isclose(signed_volumes(triangles).sum(), 6.0)


def test_inside_out_solids_are_found_and_cavities_are_not() -> None:
    solid, cavity, wrong = cube(4.0), cube(1.0, (1, 1, 1)).reversed(), cube(1.0, (9, 0, 0)).reversed()
    mesh = together(solid, cavity, wrong)
    number, piece = mesh.pieces
    assert inside_out(mesh, piece, number).tolist() == [False] * 12 + [True] * 6


def test_repeated_faces_are_those_with_the_same_corners_the_same_way_round() -> None:
    points = np.random.default_rng(0).random((4, 3))
    mesh = Mesh.from_polygons(points, [[0, 1, 2, 3], [1, 2, 3, 0], [3, 2, 1, 0], [0, 2, 1, 3], [0, 1, 2, 3]])
    assert repeated_faces(mesh).tolist() == [False, True, False, False, True]


def test_what_is_told_of_a_large_mesh_is_the_same_on_any_number_of_threads() -> None:
    ball = bumpy_icosphere(6, bump=0.1)
    soup = ball.vertices[ball.corners]

    def told(count: int) -> list[np.ndarray]:
        with threads(count):
            first, number = distinct_points(soup)
            mesh = Mesh(soup[first], number, ball.offsets)
            around = circulation(len(first), number, ball.offsets)
            return [first, number, signed_volumes(mesh), thin_faces(mesh), around]

    assert all(np.array_equal(one, two) for one, two in zip(told(1), told(3), strict=True))
