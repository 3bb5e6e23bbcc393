"""Curved shapes as meshes, of any size."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm


def quads(rows: int, columns: int) -> Ints:
    """(r,4) corners of the cells of a grid of vertices, row after row, counter-clockwise in (column, row)."""
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    return np.stack([first, first + 1, first + 1 + columns, first + columns], axis=1)


def mesh_of_quads(vertices: Floats, cells: Ints) -> Mesh:
    """The mesh of quadrangles (q,4)."""
    return Mesh(vertices, cells.ravel(), np.arange(0, cells.size + 1, 4))


def torus_mesh(around: int = 24, across: int = 12, major: float = 2.0, minor: float = 0.8) -> Mesh:
    """A torus about z of around times across quadrangles, which are all but planar."""
    u, v = np.meshgrid(
        2.0 * np.pi * np.arange(around) / around, 2.0 * np.pi * np.arange(across) / across, indexing="ij"
    )
    radius = major + minor * np.cos(v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), minor * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.divmod(np.arange(around * across), across)
    i1, j1 = (i + 1) % around, (j + 1) % across
    return mesh_of_quads(points, np.stack([i * across + j, i1 * across + j, i1 * across + j1, i * across + j1], axis=1))


def moebius_strip(steps: int = 24) -> Mesh:
    """A strip with one side and one border: its faces cannot be listed counter-clockwise from outside."""
    angle = 2.0 * np.pi * np.arange(steps) / steps
    sides = []
    for width in (-0.5, 0.5):
        radius = 1.5 + width * np.cos(angle / 2.0)
        sides.append(np.stack([radius * np.cos(angle), radius * np.sin(angle), width * np.sin(angle / 2.0)], axis=1))
    k = np.arange(steps)
    after = (k + 1) % steps
    swap = after < k
    low, high = np.where(swap, after + steps, after), np.where(swap, after, after + steps)
    # A strip of quadrangles would not be planar.
    triangles = np.concatenate([np.stack([k, low, high], axis=1), np.stack([k, high, k + steps], axis=1)])
    return Mesh.from_triangles(np.concatenate(sides), triangles)


def grid_graph(cells: int = 40) -> Mesh:
    """The graph of a function over a square, cells times cells pairs of triangles: an open mesh that hides itself."""
    line = np.linspace(-1.0, 1.0, cells + 1)
    y, x = np.meshgrid(line, line, indexing="ij")
    z = 0.25 * np.sin(6.0 * x) * np.cos(5.0 * y + x)
    cell = quads(cells + 1, cells + 1)
    return Mesh.from_triangles(
        np.stack([x, y, z], axis=-1).reshape(-1, 3), np.concatenate([cell[:, :3], cell[:, [0, 2, 3]]])
    )


def icosahedron() -> tuple[Floats, Ints]:
    """Vertices on the unit sphere and triangles, counter-clockwise from outside."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    flat = [(0.0, a, b) for a in (-1.0, 1.0) for b in (-golden, golden)]
    vertices = np.array([(*p[shift:], *p[:shift]) for shift in range(3) for p in flat])
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 2.1
    i, j, k = np.nonzero(near[:, :, None] & near[None, :, :] & near[:, None, :])
    outside = np.einsum("ij,ij->i", np.cross(vertices[i], vertices[j]), vertices[k]) > 1.0
    kept = outside & (i < j) & (i < k)
    return vertices / norm(vertices[0]), np.stack([i, j, k], axis=1)[kept]


def bumpy_icosphere(halvings: int = 3, bump: float = 0.15) -> Mesh:
    """A sphere with bumps, of 20 times 4 to the power of halvings triangles (5: 20,480; 8: 1.3 million)."""
    vertices, triangles = icosahedron()
    for _ in range(halvings):
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        key, index = np.unique(sides.min(axis=1) * len(vertices) + sides.max(axis=1), return_inverse=True)
        first, second = np.divmod(key, len(vertices))
        middle = vertices[first] + vertices[second]
        ab, bc, ca = (index.reshape(3, -1) + len(vertices)).astype(np.intp)
        vertices = np.concatenate([vertices, middle / norm(middle)[:, None]])
        a, b, c = triangles.T
        parts = ([a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca])
        triangles = np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3)
    waves = np.sin(5.0 * vertices[:, 0]) * np.sin(4.0 * vertices[:, 1] + 1.0) * np.cos(6.0 * vertices[:, 2])
    return Mesh.from_triangles(vertices * (1.0 + bump * waves)[:, None], triangles)
