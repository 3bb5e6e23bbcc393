"""Seams of arrays: what lies in one place under several numbers is drawn as what has one number there."""

import numpy as np
import pytest
import trimesh
from support.drawn import drawn

import vectorplot as vp
from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import is_closed_oriented, joined_seams, mesh_report
from vectorplot.io.description import describe
from vectorplot.testing import assert_drawings_equal
from vectorplot.testing.shapes import box, bumpy_icosphere, grid_graph, moebius_strip, prism, torus_mesh, without

CAMERA = vp.Camera((5.0, -7.0, 4.0))
SHAPES = {
    "box": box((-1, -1, -1), (1, 2, 1)),
    "hollow box": without(box((-1, -1, -1), (1, 2, 1)), 1),
    "notched prism": prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 1.0),
    "torus": torus_mesh(16, 9),
    "icosphere": bumpy_icosphere(2),
    "graph": grid_graph(8),
    "Moebius strip": moebius_strip(),
}


def soup(mesh: Mesh) -> Mesh:
    """Every corner a vertex of its own, as where faces have normals of their own."""
    return Mesh(mesh.vertices[mesh.corners], np.arange(len(mesh.corners)), mesh.offsets, mesh.present)


def cut_up(mesh: Mesh, pieces: int) -> Mesh:
    """Faces of different random pieces share no vertices, as where textures have seams."""
    piece = np.random.default_rng(pieces).integers(0, pieces, mesh.face_count)[mesh.corner_face]
    pairs, corners = np.unique(np.stack([mesh.corners, piece]), axis=1, return_inverse=True)
    return Mesh(mesh.vertices[pairs[0]], corners.ravel(), mesh.offsets, mesh.present)


def rolled(rows: int, columns: int, closed: bool) -> Mesh:
    """A sphere of triangles as a grid of parameters: one meridian twice, the poles as often as there are meridians; or
    the grid with its seam closed."""
    u, v = np.meshgrid(np.arange(columns + 1) % columns * 2.0 * np.pi / columns, np.arange(rows + 1), indexing="ij")
    v = (v / rows - 0.5) * np.pi
    width = np.where(np.abs(v) < 0.499 * np.pi, np.cos(v), 0.0)
    points = np.stack([width * np.cos(u), width * np.sin(u), np.sin(v)], axis=-1)
    at = np.arange(points[..., 0].size).reshape(u.shape)
    if closed:
        at[-1], at[:, 0], at[:, -1] = at[0], at[0, 0], at[0, -1]
    cells = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    triangles = np.concatenate([cells[:, :3], cells[:, [0, 2, 3]]])
    if closed:
        triangles = triangles[[len(set(t)) == 3 for t in triangles.tolist()]]
    return Mesh.from_triangles(points.reshape(-1, 3), triangles)


def scene(*meshes: Mesh) -> vp.Scene:
    return vp.Scene(tuple(vp.Item(f"BODY{k}", mesh) for k, mesh in enumerate(meshes)))


@pytest.mark.slow
@pytest.mark.hard(73)
@pytest.mark.spread
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("pieces", [2, 5, None])
def test_seams_of_arrays_are_no_boundaries_in_any_verb(name: str, pieces: int | None) -> None:
    whole = SHAPES[name]
    seamed = soup(whole) if pieces is None else cut_up(whole, pieces)
    (joined,) = joined_seams([seamed])
    assert np.array_equal(joined.vertices[joined.corners], seamed.vertices[seamed.corners])
    assert is_closed_oriented(joined) == is_closed_oriented(whole)
    for options in ({}, {"lines": ("boundary", "edges"), "hidden": "solid"}):
        drawings = [vp.draw(scene(mesh), CAMERA, **options) for mesh in (seamed, whole)]
        assert_drawings_equal(*drawings)
    painted = [vp.paint(scene(mesh), CAMERA).layers[0].fills[0] for mesh in (seamed, whole)]
    assert np.array_equal(painted[0].offsets, painted[1].offsets)
    rendered = [vp.render(scene(mesh), CAMERA, size=(60, 45)).pixels for mesh in (seamed, whole)]
    assert np.array_equal(*rendered)
    assert describe(scene(seamed)) == describe(scene(whole))


@pytest.mark.hard(73)
@pytest.mark.parametrize("size", [(4, 5), (9, 16), (16, 9)])
def test_the_meridian_and_the_poles_of_a_rolled_grid_are_no_boundaries(size: tuple[int, int]) -> None:
    rolled_up, closed = rolled(*size, closed=False), rolled(*size, closed=True)
    for camera in (CAMERA, vp.Camera((0.3, 0.2, 6.0)), vp.Camera((0.0, -1.0, -5.0), parallel=True)):
        lines = ("contour", "boundary", "crease")
        one, two = (vp.draw(scene(mesh), camera, lines=lines, crease_angle_deg=50.0) for mesh in (rolled_up, closed))
        assert_drawings_equal(one, two)
    assert describe(scene(rolled_up))[0] == describe(scene(_compact(closed)))[0]


def _compact(mesh: Mesh) -> Mesh:
    used, corners = np.unique(mesh.corners, return_inverse=True)
    return Mesh(mesh.vertices[used], corners, mesh.offsets)


@pytest.mark.hard(73)
def test_meshes_of_other_libraries_have_no_seams() -> None:
    ball = trimesh.creation.icosphere(subdivisions=2)
    split = trimesh.Trimesh(ball.triangles.reshape(-1, 3), np.arange(3 * len(ball.faces)).reshape(-1, 3), process=False)
    drawings = [vp.draw(scene(Mesh.from_triangles(mesh.vertices, mesh.faces)), CAMERA) for mesh in (split, ball)]
    assert_drawings_equal(*drawings)


@pytest.mark.hard(73)
def test_seams_are_joined_wherever_the_scene_is_and_whatever_its_size() -> None:
    for size in (1e-6, 1.0, 1e6):
        for offset in (0.0, 1e6 * size):
            place = np.diag([size, size, size, 1.0])
            place[:3, 3] = offset
            (joined,) = joined_seams([soup(torus_mesh(12, 7)).transformed(place)])
            assert mesh_report(joined).boundary_edges == 0


def test_a_mesh_without_seams_is_returned_itself() -> None:
    meshes = [*SHAPES.values(), Mesh.from_polygons(np.zeros((0, 3)), [])]
    assert all(one is other for one, other in zip(meshes, joined_seams(meshes), strict=True))
    assert joined_seams([]) == ()


def test_only_edges_of_one_mesh_in_exactly_one_place_are_joined() -> None:
    one, two = cut_up(grid_graph(4), 3), cut_up(grid_graph(4), 4)
    assert [mesh_report(mesh).boundary_edges for mesh in joined_seams([one, two])] == [16, 16]
    moved = soup(box((0, 0, 0), (1, 1, 1)))
    moved = Mesh(moved.vertices + 1e-15 * np.arange(24)[:, None], moved.corners, moved.offsets)
    assert joined_seams([moved])[0] is moved


def test_vertices_in_one_place_that_no_common_edge_joins_stay_apart() -> None:
    left = grid_graph(2)
    right = Mesh(left.vertices @ np.diag([1.0, -1.0, 1.0]) + (2.0, 2.0, 0.0), left.corners, left.offsets)
    right = Mesh(np.where(np.arange(9)[:, None] == 0, left.vertices[8], right.vertices), right.corners, right.offsets)
    both = Mesh.from_triangles(
        np.concatenate([left.vertices, right.vertices]),
        np.concatenate([left.corners, right.corners + 9]).reshape(-1, 3),
    )
    assert joined_seams([both])[0] is both


@pytest.mark.parametrize("separate", [True, False])
def test_a_sheet_with_two_faces_at_every_place_shows_no_triangulation(separate: bool) -> None:
    sheet = mesh_of_grid(np.stack(np.meshgrid(np.arange(4.0), np.arange(5.0), [0.0], indexing="ij"), axis=-1)[:, :, 0])
    back = sheet.reversed()
    vertices = np.concatenate([sheet.vertices, back.vertices]) if separate else sheet.vertices
    corners = np.concatenate([sheet.corners, back.corners + (len(sheet.vertices) if separate else 0)])
    offsets = np.concatenate([sheet.offsets, back.offsets[1:] + sheet.offsets[-1]])
    found = drawn(vp.draw(scene(Mesh(vertices, corners, offsets)), CAMERA))
    assert np.isclose(found.length, 14.0, rtol=1e-12), "its outline, and that once"


@pytest.mark.parametrize("name", ["box", "hollow box", "torus"])
def test_many_copies_are_joined_as_each_alone(name: str) -> None:
    """One closed body stands for its copies; an open one does not, and equal corners need not lie in equal places."""
    closed, apart = SHAPES[name], soup(SHAPES[name])
    spread = Mesh(apart.vertices + np.arange(len(apart.vertices))[:, None], apart.corners, apart.offsets)
    meshes = [Mesh(m.vertices + k, m.corners, m.offsets) for k in range(20) for m in (closed, apart, spread)]
    together = joined_seams(meshes)
    for mesh, joined in zip(meshes, together, strict=True):
        (alone,) = joined_seams([mesh])
        assert np.array_equal(joined.corners, alone.corners) and np.array_equal(joined.offsets, alone.offsets)
    assert is_closed_oriented(together[1]) == is_closed_oriented(closed) and not is_closed_oriented(together[2])
