"""How a curve f(u, v) = 0 is found: the graph of f over a grid, its average normals, and the refined curve.

Each cell is cut along the diagonal whose two triangles agree better with the average normals. Where an edge has ends of
different sign lies a point of the curve, black here; more are put in between, each exactly on it: red.
Source: Glaeser, section 8.4, figures 11 and 12.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, CREAM, GREY, INK, RED, SKY, drawn, line, sheet, shown, tinted, with_arrows, with_dots

import vectorplot as vp
from vectorplot.features import mesh_of_grid, triangulate_surface, zero_manifold_of_f_uv
from vectorplot.surfaces import Domain, graph
from vectorplot.testing import branch_count, curves_in_space

CELLS, SQUARE = 12, Domain(-1.5, 1.5, -1.1, 1.1)
EDGES = ("contour", "boundary", "edges", "intersection")


def f(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Two hills with a saddle between them, a little below zero."""
    return np.exp(-3 * ((u - 0.7) ** 2 + v**2)) + np.exp(-2.5 * ((u + 0.7) ** 2 + v**2)) - 0.55


def edge_points(grid: np.ndarray) -> np.ndarray:
    """(n,3) where f is zero between neighbours of the grid that have different signs."""
    pairs = [(grid[:-1], grid[1:]), (grid[:, :-1], grid[:, 1:])]
    one, two = (np.concatenate([pair[k].reshape(-1, 3) for pair in pairs]) for k in (0, 1))
    signs = one[:, 2] * two[:, 2] < 0
    part = (one[signs, 2] / (one[signs, 2] - two[signs, 2]))[:, None]
    return one[signs] + part * (two[signs] - one[signs])


def main(folder: Path) -> None:
    found = zero_manifold_of_f_uv(f, SQUARE, columns=CELLS, rows=CELLS, tolerance=1e-4)
    triangles, normals = triangulate_surface(found.grid)
    mesh = mesh_of_grid(found.grid)
    flat = replace(mesh, vertices=mesh.vertices * (1, 1, 0))
    feet = found.grid.reshape(-1, 3)
    tips = feet + 0.24 * normals.reshape(-1, 3)
    hair = tuple(line(f"N{k}", foot, tip, RED) for k, (foot, tip) in enumerate(zip(feet, tips, strict=True)))
    triangulated = vp.Item("GRAPH", mesh, INK, lines=EDGES)
    corners = [(u, v, 0) for u, v in ((-1.6, -1.2), (1.6, -1.2), (1.6, 1.2), (-1.6, 1.2))]
    plane = sheet("PLANE", corners, BLUE, occludes=False)
    exact = vp.Item("CURVE", graph(f, SQUARE), RED, lines=("intersection",), occludes=False)
    aside = vp.Camera(eye=(3, -8, 6), fov_deg=24)
    above = vp.Camera(eye=(0, 0, 5), up=(0, 1, 0), parallel=True)
    lamp = vp.Light((-4, -3, 6), parallel=True, intensity=1.0)
    surface = vp.Item("GRAPH", mesh, CREAM)
    water = sheet("PLANE", corners, SKY, material=vp.Material("transparent", 0.6))
    pictures = {
        "graph": ((triangulated, plane), (surface, water), aside),
        "normals": ((triangulated, *hair), (surface,), aside),
        "curve": ((exact, vp.Item("GRID", flat, GREY, lines=EDGES)), (), above),
    }
    widths = {INK: 0.18, RED: 0.45, BLUE: 0.5, GREY: 0.18}
    for name, (lines, painted, camera) in pictures.items():
        scene = vp.Scene(lines, title="Tracing a curve")
        drawing = drawn(scene, camera, vp.Page(140, 100, 5), widths, crease_angle_deg=180)
        if painted:
            drawing = tinted(drawing, vp.Scene(painted, (lamp,)), camera, shadows="none", smooth=False, flat=("PLANE",))
        if name == "normals":
            seen = shown(drawing, tips)
            drawing = with_arrows(drawing, feet[seen], tips[seen], RED, 1.5)
        if name == "curve":
            drawing = with_dots(drawing, edge_points(found.grid), INK, 0.6)
        vp.save(drawing, folder / f"curve_tracing_{name}.svg")

    assert len(triangles) == 2 * CELLS**2 and np.allclose(np.linalg.norm(normals, axis=2), 1)
    assert found.closed.tolist() == [True, True]
    assert np.abs(f(*found.points.T)).max() < 1e-11
    curves = curves_in_space(drawing, item="CURVE")
    assert branch_count(curves) == (2, 0, 0)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
