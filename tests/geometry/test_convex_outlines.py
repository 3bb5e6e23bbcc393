"""Whether an outline is convex, of meshes with many faces: as all distances say, without taking all of them."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry import solids
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import has_convex_outline


def ball(rows, columns):
    """The quadrangles of a ball without its caps."""
    u = 2.0 * np.pi * np.arange(columns) / columns
    v = np.linspace(-1.4, 1.4, rows)[:, None]
    points = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v) + 0.0 * u], axis=-1).reshape(-1, 3)
    return Mesh.from_polygons(points, quadrangles(rows, columns, columns))


def sheet(rows, columns):
    """A flat grid, tilted."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    points = np.stack([x.ravel(), y.ravel(), 0.3 * x.ravel() + 0.7 * y.ravel()], axis=-1)
    return Mesh.from_polygons(points, quadrangles(rows, columns, columns - 1))


def quadrangles(rows, columns, count):
    return [
        (columns * i + j, columns * i + (j + 1) % columns, columns * (i + 1) + (j + 1) % columns, columns * (i + 1) + j)
        for i in range(rows - 1)
        for j in range(count)
    ]


def sheets(*heights):
    """A square above another, both turned the same way."""
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    points = np.concatenate([np.add(square, (0.0, 0.0, height)) for height in heights])
    return Mesh.from_polygons(points, [tuple(range(4 * k, 4 * k + 4)) for k in range(len(heights))])


def dented(mesh, depth):
    points = mesh.vertices.copy()
    points[len(points) // 2] *= 1.0 - depth
    return Mesh(points, mesh.corners, mesh.offsets)


SHAPES = {
    "ball": (ball(9, 12), True),
    "ball inside out": (ball(9, 12).reversed(), False),
    "dented ball": (dented(ball(9, 12), 1e-6), False),
    "hardly dented ball": (dented(ball(9, 12), 1e-12), True),
    "bumped ball": (dented(ball(9, 12), -1e-3), False),
    "sheet": (sheet(7, 9), True),
    "two sheets": (sheets(0.0, 1.0), False),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3)])
def test_the_hull_says_what_all_distances_say(monkeypatch, name, scale, offset):
    mesh, convex = SHAPES[name]
    placed = Mesh(mesh.vertices * scale + offset, mesh.corners, mesh.offsets)
    monkeypatch.setattr(solids, "DISTANCES_AT_ONCE", 50)
    assert has_convex_outline(placed) == convex
    monkeypatch.undo()
    assert has_convex_outline(placed) == convex


@pytest.mark.parametrize("make", [ball, sheet])
def test_no_face_of_a_large_convex_mesh_is_held_against_all_vertices(monkeypatch, make):
    doubtful = []
    real = solids._touch_hull

    def counted(*arguments):
        found = real(*arguments)
        doubtful.append(int((~found).sum()))
        return found

    monkeypatch.setattr(solids, "_touch_hull", counted)
    assert has_convex_outline(make(60, 80))
    assert doubtful == [0]
