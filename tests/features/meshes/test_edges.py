import numpy as np
import pytest

from vectorplot.features.mesh_edge_lines import Edges, Faces, mesh_edges
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, bumpy_icosphere, moebius_strip, torus_mesh
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind

ALL = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE, LineKind.EDGES})
CAMERA = Camera((5.0, -7.0, 4.0))


def edges_of(mesh: Mesh, kinds: frozenset[LineKind] = ALL, camera: Camera = CAMERA, angle: float = 25.0) -> Edges:
    view = look(Scene((Item("mesh", mesh),)), camera)
    facing = project_faces(view).facing
    faces = Faces(view.points, view.corners, view.offsets, view.inner, facing)
    return mesh_edges(faces, kinds, angle)


def count(edges: Edges) -> dict[str, int]:
    return {kind.word: int((edges.kind == kind).sum()) for kind in LineKind if (edges.kind == kind).any()}


def test_a_box_seen_from_a_corner_has_six_contour_edges_and_six_creases() -> None:
    assert count(edges_of(box((-1, -1, -1), (1, 1, 1)))) == {"contour": 6, "crease": 6}


def test_a_box_without_its_top_has_four_boundary_edges() -> None:
    closed = box((-1, -1, -1), (1, 1, 1))
    top = int(np.argmax(closed.face_normals[:, 2]))
    opened = Mesh.from_polygons(closed.vertices, [f for k, f in enumerate(closed.polygons()) if k != top])
    assert count(edges_of(opened))["boundary"] == 4


def test_no_edge_comes_twice_and_none_is_lost() -> None:
    mesh = torus_mesh()
    edges = edges_of(mesh)
    pairs = np.sort(np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1), axis=1)
    expected = np.unique(pairs, axis=0)
    assert np.array_equal(np.unique(np.column_stack([edges.start, edges.end]), axis=0), expected)
    assert len(edges.start) == len(expected)


@pytest.mark.parametrize("mesh", [torus_mesh(), bumpy_icosphere(3), moebius_strip(), box((0, 0, 0), (1, 2, 3))])
def test_the_quick_search_finds_what_the_full_one_finds(mesh: Mesh) -> None:
    few = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE})
    quick, full = edges_of(mesh, few), edges_of(mesh)
    kept = full.kind != LineKind.EDGES
    for name in ("start", "end", "kind", "side"):
        assert np.array_equal(getattr(quick, name), getattr(full, name)[kept])


@pytest.mark.capability("G9.3-contour")
@pytest.mark.hard(28)
def test_the_contour_of_a_faceted_sphere_is_a_closed_loop() -> None:
    sphere = bumpy_icosphere(3, bump=0.0)
    contour = edges_of(sphere, frozenset({LineKind.CONTOUR}))
    degree = np.bincount(np.concatenate([contour.start, contour.end]))
    assert set(degree[degree > 0]) == {2}


def test_creases_turn_by_more_than_the_angle() -> None:
    hexagon = [(np.cos(a), np.sin(a)) for a in np.arange(6) * np.pi / 3.0]
    vertices = [(x, y, z) for z in (0.0, 1.0) for x, y in hexagon]
    sides = [[k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6] for k in range(6)]
    prism = Mesh.from_polygons(vertices, [*sides, [5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]])
    only = frozenset({LineKind.CREASE})
    assert len(edges_of(prism, only, angle=59.0).kind) == 18
    assert len(edges_of(prism, only, angle=61.0).kind) == 12


@pytest.mark.hard(14)
def test_a_moebius_strip_is_drawn_whatever_its_winding() -> None:
    strip = moebius_strip(24)
    kinds = count(edges_of(strip))
    assert kinds["boundary"] == 48
    turned = Mesh.from_polygons(strip.vertices, [f[::-1] if k % 3 == 0 else f for k, f in enumerate(strip.polygons())])
    assert count(edges_of(turned)) == kinds


@pytest.mark.hard(12)
def test_an_edge_of_three_faces_is_drawn() -> None:
    vertices = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (-1, 0.2, 0), (-1, -0.2, 0)]
    fins = Mesh.from_polygons(vertices, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    edges = edges_of(fins)
    shared = (edges.start == 0) & (edges.end == 1)
    assert shared.sum() == 1
    assert LineKind(int(edges.kind[shared][0])) in (LineKind.CREASE, LineKind.CONTOUR)


@pytest.mark.hard(12)
@pytest.mark.parametrize("layers", [(2, 2), (2, 1), (3, 2)])
@pytest.mark.parametrize("angle", [0.0, 20.0, 30.0, 80.0])
def test_an_edge_of_sheets_in_layers_is_a_crease_where_they_turn(layers: tuple[int, int], angle: float) -> None:
    """Two directions, each of one face or more: an edge within a sheet that lies there twice is none."""
    across = (np.cos(np.radians(angle)), -np.sin(np.radians(angle)))
    vertices = [(0, 0, 0), (0, 1, 0), (-1, 0, 0), (-1, 1, 0), *((across[0], y, across[1]) for y in (0, 1))]
    faces = [[0, 1, 3, 2]] * layers[0] + [[1, 0, 4, 5]] * layers[1]
    edges = edges_of(Mesh.from_polygons(vertices, faces), camera=Camera((0.1, 0.5, 9.0), (0.0, 0.5, 0.0)))
    shared = (edges.start == 0) & (edges.end == 1)
    assert edges.kind[shared].tolist() == [LineKind.CREASE if angle > 25.0 else LineKind.EDGES]
    # A face that stands on them is a third direction.
    standing = Mesh.from_polygons([*vertices, (0.1, 0, 1), (0.1, 1, 1)], [*faces, [0, 1, 7, 6]])
    edges = edges_of(standing, camera=Camera((0.1, 0.5, 9.0), (0.0, 0.5, 0.0)))
    shared = (edges.start == 0) & (edges.end == 1)
    assert LineKind(int(edges.kind[shared][0])) in (LineKind.CREASE, LineKind.CONTOUR)


def test_the_surface_lies_on_the_stated_side_of_an_outline() -> None:
    camera = Camera((0.0, 0.0, 9.0), up=(0.0, 1.0, 0.0), parallel=True)
    square = Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [[0, 1, 2, 3]])
    edges = edges_of(square, camera=camera)
    middle = square.vertices.mean(axis=0)[:2]
    start, end = square.vertices[edges.start, :2], square.vertices[edges.end, :2]
    along, arm = end - start, middle - start
    assert np.array_equal(np.sign(along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]).astype(int), edges.side)


def test_the_diagonal_of_a_cut_quadrilateral_is_no_edge_but_may_be_a_contour() -> None:
    saddle = Mesh.from_polygons([(0, 0, 0), (1, 0, 1), (1, 1, 0), (0, 1, 1)], [[0, 1, 2, 3]])
    above = edges_of(saddle, camera=Camera((0.5, 0.5, 9.0), (0.5, 0.5, 0.5), up=(0.0, 1.0, 0.0)))
    assert count(above) == {"boundary": 4}
    grazing = edges_of(saddle, camera=Camera((9.0, -8.2, 0.6), (0.5, 0.5, 0.5)))
    assert count(grazing) == {"contour": 1, "boundary": 4}


def test_vertices_of_a_closed_mesh_are_balanced() -> None:
    mesh = torus_mesh()
    assert not unbalanced_vertices(len(mesh.vertices), mesh.corners, mesh.offsets).any()
    opened = Mesh.from_polygons(mesh.vertices, mesh.polygons()[1:])
    unbalanced = unbalanced_vertices(len(opened.vertices), opened.corners, opened.offsets)
    assert set(np.flatnonzero(unbalanced)) == set(mesh.polygons()[0])
