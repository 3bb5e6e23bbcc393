"""Boundaries of meshes of which faces are missing, against counting: faces that meet only at vertices hide nothing."""

from collections import Counter

import numpy as np
import pytest
from support.drawn import drawn

from vectorplot.features.mesh_edge_lines import Edges, Faces, mesh_edges
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.read_file import read
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.words import LineKind

Cells = list[list[int]]
GRIDS = ("triangles", "quadrilaterals", "hexagons")


def grid(kind: str, rows: int, columns: int) -> tuple[np.ndarray, Cells]:
    """Points (n,3) of a flat grid, numbered row by row, and its cells."""
    if kind == "hexagons":
        number: dict[tuple[int, int], int] = {}
        cells = []
        for i in range(rows):
            for j in range(columns):
                x, y = 2 * j + i % 2, 3 * i
                ring = [(x, y), (x + 1, y + 1), (x + 1, y + 3), (x, y + 4), (x - 1, y + 3), (x - 1, y + 1)]
                cells.append([number.setdefault(corner, len(number)) for corner in ring])
        return np.array([(x, y, 0.0) for x, y in number], dtype=np.float64), cells
    at = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    squares = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    y, x = np.divmod(np.arange(at.size), columns + 1)
    points = np.stack([x, y, 0 * x], axis=1).astype(np.float64)
    if kind == "quadrilaterals":
        return points, squares.tolist()
    return points, np.concatenate([squares[:, :3], squares[:, [0, 2, 3]]], axis=1).reshape(-1, 3).tolist()


def counted(cells: Cells) -> tuple[set[tuple[int, int]], set[int]]:
    """The sides of one cell only, and the vertices without a side going out for each coming in."""
    sides = Counter((a, b) for cell in cells for a, b in zip(cell, [*cell[1:], cell[0]], strict=True))
    border = {(min(a, b), max(a, b)) for (a, b) in sides if sides[a, b] + sides[b, a] == 1}
    loose = {end for (a, b) in sides if sides[a, b] != sides[b, a] for end in (a, b)}
    return border, loose


def edges_of(mesh: Mesh) -> Edges:
    facing = np.ones(mesh.face_count, dtype=np.int8)
    inner = np.zeros(len(mesh.corners), dtype=np.bool_)
    faces = Faces(np.ascontiguousarray(mesh.vertices.T), mesh.corners, mesh.offsets, inner, facing)
    return mesh_edges(faces, {LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE}, 25.0)


def assert_boundary_is_counted(points: np.ndarray, cells: Cells) -> None:
    mesh = Mesh.from_polygons(points, cells)
    border, loose = counted(cells)
    assert set(np.flatnonzero(unbalanced_vertices(len(points), mesh.corners, mesh.offsets)).tolist()) == loose
    edges = edges_of(mesh)
    assert {LineKind(k) for k in set(edges.kind.tolist())} <= {LineKind.BOUNDARY}
    assert set(zip(edges.start.tolist(), edges.end.tolist(), strict=True)) == border


@pytest.mark.hard(71)
@pytest.mark.parametrize("kind", GRIDS)
def test_every_edge_of_a_checkerboard_is_drawn_whatever_its_size(kind: str) -> None:
    for rows in range(1, 20):
        points, cells = grid(kind, rows, 19)
        per_row = len(cells) // rows
        black = [cell for k, cell in enumerate(cells) if (k // per_row + k % per_row) % 2 == 0]
        assert_boundary_is_counted(points, black)


@pytest.mark.hard(71)
@pytest.mark.parametrize("kind", GRIDS)
def test_every_edge_of_holes_that_touch_diagonally_is_drawn(kind: str) -> None:
    points, cells = grid(kind, 24, 24)
    for period in range(2, 9):
        for shift in range(1, period):
            kept = [cell for k, cell in enumerate(cells) if (k // 24 + shift * k) % period]
            assert_boundary_is_counted(points, kept)


@pytest.mark.hard(71)
@pytest.mark.parametrize("kind", GRIDS)
def test_every_edge_of_random_parts_of_grids_is_drawn_however_they_are_numbered(kind: str) -> None:
    random = np.random.default_rng(7)
    for share in (0.1, 0.3, 0.5, 0.7, 0.9, 0.99):
        for stride in (1, 2, 3, 7, 64):
            points, cells = grid(kind, *random.integers(4, 24, 2).tolist())
            kept = [cell for cell in cells if random.random() < share] or cells[:1]
            # Numbers in order, at strides, and shuffled.
            number = random.permutation(len(points)) if stride == 7 else np.arange(len(points)) * stride
            spread = np.zeros((int(number.max()) + 1, 3))
            spread[number] = points
            assert_boundary_is_counted(spread, [number[cell].tolist() for cell in kept])


@pytest.mark.hard(71)
def test_a_checkerboard_is_drawn_with_every_edge_from_every_side() -> None:
    points, cells = grid("quadrilaterals", 8, 8)
    mesh = Mesh.from_polygons(points, [cell for k, cell in enumerate(cells) if (k // 8 + k % 8) % 2 == 0])
    for eye in ((3.0, -9.0, 8.0), (12.0, 5.0, -7.0), (4.0, 4.1, 20.0)):
        found = drawn(draw(Scene((Item("board", mesh),)), Camera(eye, (4.0, 4.0, 0.0))))
        assert np.isclose(found.length, 128.0, rtol=1e-9), eye


@pytest.mark.hard(71)
def test_the_light_of_the_pool_has_all_its_boundary() -> None:
    light = next(item for item in read("data/pool.scene").items if item.name == "LIGHT").mesh
    border, _ = counted(light.polygons())
    edges = edges_of(light)
    assert set(zip(edges.start.tolist(), edges.end.tolist(), strict=True)) >= border
