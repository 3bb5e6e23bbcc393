"""Function graphs painted slice by slice, for three places of the eye.

Through the eye go two planes, upright on the axes. They cut the graph or not: then the slices on one side of the eye
come first, towards it, after them those on the other side, and the eye's own last. The later a patch is painted, the
yellower it is here; the red dot is the eye. Source: Glaeser, section 5.4, figure 7.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import INK, RED, ROSE, drawn, line, outline, sheet, tinted, with_dots

import vectorplot as vp
from vectorplot.scene import look
from vectorplot.textbook import graph_order, graph_triangles

COUNT, SHADES = 24, 12
LINES = np.linspace(-2.0, 2.0, COUNT + 1)
EYES = {"none": (3.4, -4.0, 3.2), "one": (0.7, -4.6, 3.2), "both": (0.7, -0.4, 4.4)}
"""The eye, and how many of the two planes cut the graph."""

CAMERA = vp.Camera(eye=(-9, -15, 12), target=(0.4, -0.7, 0.7), fov_deg=30)


def f(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A hill and a valley."""
    return 1.6 * np.exp(-2 * (x - 0.5) ** 2 - 2 * y**2) - np.exp(-3 * (x + 0.9) ** 2 - 2 * (y + 0.5) ** 2)


def main(folder: Path) -> None:
    x, y = np.meshgrid(LINES, LINES, indexing="ij")
    vertices, triangles = np.stack([x, y, f(x, y)], axis=2).reshape(-1, 3), graph_triangles(COUNT, COUNT)
    lights = tuple(vp.Light(way, parallel=True, intensity=0.65) for way in ((-2, -4, 8), CAMERA.eye))
    grid = vp.Item("GRAPH", vp.Mesh.from_triangles(vertices, triangles), INK, lines=("edges", "boundary", "contour"))
    mixed = np.linspace((31, 95, 168), (255, 236, 170), SHADES).round().astype(int)
    tones = ["#" + "".join(f"{byte:02x}" for byte in tone) for tone in mixed]
    for name, eye in EYES.items():
        order = graph_order(LINES, LINES, eye)
        assert (np.sort(order) == np.arange(len(triangles))).all()
        cut = [-2 < eye[axis] < 2 for axis in (0, 1)]
        assert sum(cut) == ("none", "one", "both").index(name)

        parts = [vp.Mesh.from_triangles(vertices, triangles[part]) for part in np.array_split(order, SHADES)]
        patches = tuple(vp.Item(f"P{k}", part, tones[k]) for k, part in enumerate(parts))
        ends = ((eye[0], -4.8, eye[0], 2.4), (-2.4, eye[1], 4.2, eye[1]))
        walls = [np.array([(a, b, -0.9), (c, d, -0.9), (c, d, eye[2]), (a, b, eye[2])]) for a, b, c, d in ends]
        glass = vp.Material("transparent", 0.5)
        planes = tuple(sheet(f"PLANE{k}", wall, ROSE, material=glass) for k, wall in enumerate(walls))
        borders = [side for k, wall in enumerate(walls) for side in outline(f"W{k}", wall, RED)]
        axis = line("AXIS", eye, (*eye[:2], -0.9), RED)
        drawing = drawn(vp.Scene((grid, *borders, axis), title=name), CAMERA, vp.Page(120, 105, 4), {INK: 0.13})
        drawing = tinted(
            drawing, vp.Scene((*patches, *planes), lights), CAMERA, shadows="none", flat=("PLANE0", "PLANE1")
        )
        vp.save(with_dots(drawing, [eye], RED, 1.8), folder / f"graph_cases_{name}.svg")
        in_order(grid, eye, order)


def in_order(grid: vp.Item, eye: tuple[float, float, float], order: np.ndarray) -> None:
    """Ask that for the eye what is painted over something else is nearer."""
    up = (0, 1, 0) if eye[2] > 4 else None
    view = look(vp.Scene((grid,)), vp.Camera(eye=eye, target=(0, 0, 0.2), fov_deg=30, up=up))
    corners = view.corners.reshape(-1, 3)[order].ravel()
    points, inverse = view.image[:, corners].T, -1.0 / view.depth[corners]
    sample = np.random.default_rng(1).uniform(points.min(axis=0), points.max(axis=0), (200, 2))
    rings = points.reshape(-1, 3, 2)
    along, arm = np.roll(rings, -1, axis=1) - rings, sample[:, None, None] - rings
    side = along[..., 0] * arm[..., 1] - along[..., 1] * arm[..., 0]
    at, over = np.nonzero((side > 1e-9).all(axis=2) | (side < -1e-9).all(axis=2))
    corners = np.concatenate([rings, np.ones((len(rings), 3, 1))], axis=2)[over]
    planes = np.linalg.solve(corners, -inverse.reshape(-1, 3, 1)[over])[..., 0]
    height = (np.column_stack([sample[at], np.ones(len(at))]) * planes).sum(axis=1)
    assert (np.diff(height)[np.diff(at) == 0] >= -1e-9).all(), "what is painted over something else is nearer"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
