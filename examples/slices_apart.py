"""Sliced surfaces taken apart: a function graph in slices parallel to the base, and the ribbons of a slice.

The slices of the graph are lifted one from the other. What is left of a torus between two planes falls into ribbons:
orange ones show their front, blue ones their back; above and below are the other slices. Source: Glaeser, sections
5.3 and 5.4, figures 4 and 6.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import CREAM, INK, drawn, tinted

import vectorplot as vp
from vectorplot.geometry import rotation_x
from vectorplot.surfaces import Domain, Torus, graph
from vectorplot.visibility import cut_into_slices

LEVELS = np.array([0.25, 0.5, 0.75, 1.0, 1.25])
COLOURS = ("#5b8fbd", "#93bad3", "#c6dfe0", "#f5e6b8", "#efbf93", "#dc8f70")
ROUND = ("boundary", "contour")


def hill(x, y):
    """Two hills."""
    return 1.45 * np.exp(-1.3 * ((x - 0.55) ** 2 + y**2)) + 1.1 * np.exp(-1.6 * ((x + 0.9) ** 2 + (y - 0.3) ** 2))


def pieces(surface, u: np.ndarray, v: np.ndarray, turn: np.ndarray, levels: np.ndarray):
    """The corners of the parts of a surface in slices, polygon by polygon, and the slice of each polygon."""
    points = surface.points(*np.meshgrid(u, v, indexing="ij")) @ turn
    cells = np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2).reshape(-1, 4, 3)
    triangles = np.concatenate([cells[:, :3], cells[:, [0, 2, 3]]])
    found, _, band = cut_into_slices(triangles.reshape(-1, 3), 3 * np.arange(len(triangles) + 1), 2, levels)
    polygons = np.array_split(found.points, found.offsets[1:-1])
    return polygons, band


def body(polygons: list[np.ndarray]) -> vp.Mesh:
    """A mesh of polygons whose corners are the same where they coincide."""
    points = np.concatenate(polygons)
    places, corners = np.unique(points.round(9), axis=0, return_inverse=True)
    ends = np.cumsum([len(polygon) for polygon in polygons])[:-1]
    faces = [list(dict.fromkeys(face.tolist())) for face in np.split(corners, ends)]
    return vp.Mesh.from_polygons(places, [face for face in faces if len(face) > 2])


def picture(parts, camera: vp.Camera, page: vp.Page, title: str) -> vp.Drawing:
    """Meshes with their tints, their borders and their contours."""
    lines = tuple(vp.Item(f"P{k}", mesh, INK, lines=ROUND) for k, (mesh, _) in enumerate(parts))
    faces = tuple(vp.Item(f"P{k}", mesh, colour) for k, (mesh, colour) in enumerate(parts))
    drawing = drawn(vp.Scene(lines, title=title), camera, page, {INK: 0.35})
    return tinted(drawing, vp.Scene(faces), camera, shadows="none", flat=tuple(item.name for item in faces))


def main(folder: Path) -> None:
    dome = graph(hill, Domain(-2.4, 2.2, -1.9, 1.9))
    polygons, band = pieces(dome, np.linspace(-2.4, 2.2, 47), np.linspace(-1.9, 1.9, 39), np.eye(3), LEVELS)
    slices = [[np.add(p, (0, 0, 0.45 * k)) for p, at in zip(polygons, band, strict=True) if at == k] for k in range(6)]
    assert all(slices) and sum(map(len, slices)) == len(polygons)
    camera = vp.Camera(eye=(3, -11, 5.5), target=(0, 0, 1.8), fov_deg=30)
    parts = [(body(part), COLOURS[k]) for k, part in enumerate(slices)]
    vp.save(picture(parts, camera, vp.Page(130, 120, 5), "Slices of a graph"), folder / "slices_apart_graph.svg")

    turn = rotation_x(np.radians(62))
    u, v = np.linspace(0, 2 * np.pi, 81), np.linspace(0, 2 * np.pi, 27)
    polygons, band = pieces(Torus(2.0, 0.75), u, v, turn, np.array([-0.55, 0.75]))
    eye = np.array([4.0, -11.0, 4.5])
    lift = (-0.9, 0.0, 0.9)
    groups = {"below": [], "front": [], "back": [], "above": []}
    for polygon, at in zip(polygons, band, strict=True):
        there = np.add(polygon, (0, 0, lift[at]))
        towards = np.linalg.det([there[1] - there[0], there[-1] - there[0], eye - there[0]]) < 0
        groups[("below", "front" if towards else "back", "above")[at]].append(there)
    assert groups["front"] and groups["back"], "a slice has ribbons of both kinds"
    tints = {"below": CREAM, "front": "#efae84", "back": "#8fb6d6", "above": CREAM}
    parts = [(body(group), tints[name]) for name, group in groups.items()]
    camera = vp.Camera(eye=tuple(eye), target=(0, 0, 0.1), fov_deg=30)
    vp.save(picture(parts, camera, vp.Page(130, 120, 5), "Ribbons"), folder / "slices_apart_ribbons.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
