"""A function graph as a polyhedron: its contour polygon, and its sections with level planes, face by face.

The contour runs along edges, between faces that look at the eye and faces that look away. It leaps to and fro, but its
image comes close to the true contour, since these faces are seen almost edge-on: twice as many rows and columns leave
less than half of the error. The second picture shows the surface itself. Source: Glaeser, section 9.3, figure 7.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import mesh_of_grid
from vectorplot.surfaces import Domain, graph
from vectorplot.testing import curves_in_space, hausdorff

SQUARE, LEVELS = Domain(-3, 3, -3, 3), tuple(np.linspace(-0.9, 0.9, 13).tolist())
CAMERA, PAGE = vp.Camera(eye=(7, -18, 6), fov_deg=24), vp.Page(130, 90, 5)


def waves(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Hills and hollows."""
    return np.sin(1.3 * x + 0.4) * np.cos(1.1 * y)


def polyhedron(cells: int) -> vp.Mesh:
    """The graph over a grid of so many cells each way, in triangles."""
    u, v = np.meshgrid(np.linspace(-3, 3, cells + 1), np.linspace(-3, 3, cells + 1), indexing="ij")
    return mesh_of_grid(np.stack([u, v, waves(u, v)], axis=-1))


def drawing_of(shape: vp.Mesh, levels: tuple[float, ...]) -> vp.Drawing:
    """The shape with its level lines."""
    lines = vp.SurfaceLines(sections=(vp.Section((0, 0, 1), levels),) if levels else ())
    scene = vp.Scene((vp.Item("GRAPH", shape, curves=lines),), title="Function graph")
    return vp.draw(scene, CAMERA, page=PAGE, crease_angle_deg=60)


def contour_image(drawing: vp.Drawing) -> list[np.ndarray]:
    """The strokes of borders and contour, in millimetres."""
    paths = next(layer for layer in drawing.layers if layer.name == "contour").strokes
    return [part.points[a:b] for part in paths for a, b in pairwise(part.offsets)]


def main(folder: Path) -> None:
    shapes = {"polyhedron": polyhedron(40), "surface": graph(waves, SQUARE)}
    for name, shape in shapes.items():
        drawing = drawing_of(shape, LEVELS)
        vp.save(drawing, folder / f"function_graph_{name}.svg")
        heights = np.concatenate(curves_in_space(drawing, kind="section"))[:, 2]
        assert np.abs(heights[:, None] - LEVELS).min(axis=1).max() < 1e-9, "every vertex lies in a plane"

    true = contour_image(drawing)
    coarse, middle, fine = (hausdorff(contour_image(drawing_of(polyhedron(n), ())), true) for n in (20, 40, 80))
    assert coarse > 2 * middle > 4 * fine, "the polygon's image converges to the true contour"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
