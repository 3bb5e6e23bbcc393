"""Function graphs painted slice by slice, for three places of the eye.

Through the eye go two planes, upright on the axes. They cut the graph or not: then the slices on one side of the eye
come first, towards it, after them those on the other side, and the eye's own last. The later a patch is painted, the
brighter it is here. Source: Glaeser, section 5.4, figure 7.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.scene import look
from vectorplot.shading import shaded_colours
from vectorplot.textbook import graph_order, graph_triangles

LINES = np.linspace(-2.0, 2.0, 25)
EYES = {"none": (7.0, -9.0, 6.0), "one": (0.7, -10.0, 6.0), "both": (0.7, -0.4, 11.0)}
"""The eye, and how many of the two planes cut the graph."""


def graph() -> vp.Mesh:
    """A hill and a valley over a square."""
    x, y = np.meshgrid(LINES, LINES, indexing="ij")
    z = 1.6 * np.exp(-2 * (x - 0.5) ** 2 - 2 * y**2) - np.exp(-3 * (x + 0.9) ** 2 - 2 * (y + 0.5) ** 2)
    count = len(LINES) - 1
    return vp.Mesh.from_triangles(np.stack([x, y, z], axis=2).reshape(-1, 3), graph_triangles(count, count))


def covers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which points lie in a triangle."""
    along, arm = np.roll(corners, -1, axis=0) - corners, points[:, None] - corners
    side = along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]
    return (side > 1e-9).all(axis=1) | (side < -1e-9).all(axis=1)


def main(folder: Path) -> None:
    mesh = graph()
    scene = vp.Scene((vp.Item("GRAPH", mesh),))
    for name, eye in EYES.items():
        up = (0, 1, 0) if name == "both" else None
        view = look(scene, vp.Camera(eye=eye, target=(0, 0, 0.2), fov_deg=30, up=up))
        order = graph_order(LINES, LINES, eye)
        assert (np.sort(order) == np.arange(mesh.face_count)).all()
        inside = sum(-2 < eye[axis] < 2 for axis in (0, 1))
        assert inside == ("none", "one", "both").index(name)

        triangles = view.corners.reshape(-1, 3)[order]
        points = (45, 32) + 31.0 * view.image[:, triangles.ravel()].T
        shade = np.linspace(0.1, 1.0, len(order))
        colours = shaded_colours(["green"], np.zeros(len(order), dtype=int), shade)
        fills = Fills.flat(points, 3 * np.arange(len(order) + 1), colours)
        drawing = vp.Drawing(
            90, 66, (vp.Layer("graph", vp.Pen(), (fills,)),), title=f"Graph, planes through it: {name}"
        )
        vp.save(drawing, folder / f"graph_cases_{name}.svg")

        sample = np.random.default_rng(1).uniform(fills.points.min(axis=0), fills.points.max(axis=0), (400, 2))
        nearest = np.full(len(sample), -np.inf)
        for start, end in pairwise(fills.offsets):
            over = np.flatnonzero(covers(fills.points[start:end], sample))
            if len(over):
                plane = np.column_stack([fills.points[start:end], np.ones(3)])
                inverse = -1.0 / view.depth[triangles.ravel()[start:end]]
                height = np.column_stack([sample[over], np.ones(len(over))]) @ np.linalg.solve(plane, -inverse)
                assert (height >= nearest[over] - 1e-9).all(), "what is painted over something else is nearer"
                nearest[over] = height


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
