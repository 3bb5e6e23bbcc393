"""How a curve f(u, v) = 0 is found: the graph of f over a grid, its average normals, and the refined curve.

Each cell is cut along the diagonal whose two triangles agree better with the average normals. Where an edge has ends of
different sign lies a point of the curve; more are put in between, each exactly on it.
Source: Glaeser, section 8.4, figures 11 and 12.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.features import mesh_of_grid, triangulate_surface, zero_manifold_of_f_uv
from vectorplot.surfaces import Domain, graph
from vectorplot.testing import branch_count, curves_in_space

CELLS, SQUARE = 12, Domain(-1.5, 1.5, -1.1, 1.1)
EDGES = ("contour", "boundary", "edges", "intersection")


def f(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Two hills with a saddle between them, a little below zero."""
    return np.exp(-3 * ((u - 0.7) ** 2 + v**2)) + np.exp(-2.5 * ((u + 0.7) ** 2 + v**2)) - 0.55


def main(folder: Path) -> None:
    found = zero_manifold_of_f_uv(f, SQUARE, columns=CELLS, rows=CELLS, tolerance=1e-4)
    triangles, normals = triangulate_surface(found.grid)
    mesh = mesh_of_grid(found.grid)
    flat = replace(mesh, vertices=mesh.vertices * (1, 1, 0))
    needles = zip(found.grid.reshape(-1, 3), normals.reshape(-1, 3), strict=True)
    hair = tuple(vp.Item(f"N{k}", Line.through(p, p + 0.2 * n)) for k, (p, n) in enumerate(needles))
    triangulated = vp.Item("GRAPH", mesh, lines=EDGES)
    corners = [(u, v, 0) for u, v in ((-1.6, -1.2), (1.6, -1.2), (1.6, 1.2), (-1.6, 1.2))]
    plane = vp.Item("PLANE", vp.Mesh.from_polygons(corners, [range(4)]), occludes=False)
    exact = vp.Item("CURVE", graph(f, SQUARE), lines=("intersection",), occludes=False)
    aside = vp.Camera(eye=(3, -8, 6), fov_deg=24)
    above = vp.Camera(eye=(0, 0, 5), up=(0, 1, 0), parallel=True)
    pictures = {
        "graph": (vp.Scene((triangulated, plane)), aside),
        "normals": (vp.Scene((triangulated, *hair)), aside),
        "curve": (vp.Scene((vp.Item("GRID", flat, lines=EDGES), exact)), above),
    }
    for name, (scene, camera) in pictures.items():
        drawing = vp.draw(
            replace(scene, title="Tracing a curve"), camera, page=vp.Page(110, 90, 5), crease_angle_deg=180
        )
        vp.save(drawing, folder / f"curve_tracing_{name}.svg")

    assert len(triangles) == 2 * CELLS**2 and np.allclose(np.linalg.norm(normals, axis=2), 1)
    assert found.closed.tolist() == [True, True]
    assert np.abs(f(*found.points.T)).max() < 1e-11
    drawn = curves_in_space(drawing, kind="intersection")
    assert branch_count(drawn) == (2, 0, 0)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
