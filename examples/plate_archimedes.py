"""Plate: the thirteen solids of Archimedes and their two mirror images, seen through glass.

Each is the hull of one point and all its images under a group of rotations or reflections. Edges in front are drawn
in ink, those behind in blue.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK
from scipy.optimize import fsolve

import vectorplot as vp
from vectorplot.geometry import hull_mesh, rotation_about

GOLD, ROOT = (1 + 5**0.5) / 2, 2**0.5


def group(*steps: np.ndarray) -> np.ndarray:
    """(n,3,3) all products of some rotations."""
    found = [np.eye(3)]
    for turn in found:
        for step in steps:
            found += [] if np.isclose(turn @ step, found).all(axis=(1, 2)).any() else [turn @ step]
    return np.array(found)


THIRD, FIFTH = rotation_about((1, 1, 1), 2 * np.pi / 3), rotation_about((0, 1, GOLD), 2 * np.pi / 5)
CUBE, ICOSAHEDRON = group(rotation_about((0, 0, 1), np.pi / 2), THIRD), group(FIFTH, THIRD)


def whole(turns: np.ndarray, *point: float) -> np.ndarray:
    """The images of a point under rotations, and their mirror images."""
    points = np.concatenate([np.array(point) @ turns, np.array(point) @ turns * (-1, 1, 1)])
    return points[np.unique(points.round(9), axis=0, return_index=True)[1]]


def unequal(point: np.ndarray) -> tuple[float, ...]:
    """How much the distances of a point from its images about a corner, a face and an edge differ; its own from 1."""
    edges = [np.linalg.norm(point - point @ turn) for turn in (FIFTH, THIRD, FIFTH @ THIRD)]
    return *np.diff(edges), np.linalg.norm(point) - 1.0


def solids() -> dict[str, np.ndarray]:
    """The corners of each."""
    f, t, tetrahedron = GOLD, 1.839286755214161, whole(CUBE, 1, 1, 3)
    snub = np.array([1, 1 / t, t]) @ CUBE  # t³ = t² + t + 1
    twisted = fsolve(unequal, (0.2, 0.5, 0.84)) @ ICOSAHEDRON
    return {
        "truncated tetrahedron": tetrahedron[tetrahedron.prod(axis=1) > 0],
        "cuboctahedron": whole(CUBE, 1, 1, 0),
        "truncated cube": whole(CUBE, ROOT - 1, 1, 1),
        "truncated octahedron": whole(CUBE, 0, 1, 2),
        "rhombicuboctahedron": whole(CUBE, 1, 1, 1 + ROOT),
        "truncated cuboctahedron": whole(CUBE, 1, 1 + ROOT, 1 + 2 * ROOT),
        "snub cube": snub,
        "snub cube, mirrored": snub * (-1, 1, 1),
        "icosidodecahedron": whole(ICOSAHEDRON, 0, 0, 1),
        "truncated dodecahedron": whole(ICOSAHEDRON, 0, 2 + f, 1 / f),
        "truncated icosahedron": whole(ICOSAHEDRON, 0, 1, 3 * f),
        "rhombicosidodecahedron": whole(ICOSAHEDRON, 1, 1, f**3),
        "truncated icosidodecahedron": whole(ICOSAHEDRON, 1 / f, 1 / f, 3 + f),
        "snub dodecahedron": twisted,
        "snub dodecahedron, mirrored": twisted * (-1, 1, 1),
    }


def main(folder: Path) -> None:
    items, turn = [], rotation_about((0, 0, 1), 0.52) @ rotation_about((1, 0.3, 0.2), 0.33)
    for number, (name, points) in enumerate(solids().items()):
        row, column = divmod(number, 3)
        mesh = hull_mesh(points / np.linalg.norm(points[0]) @ turn + (2.25 * column, 0, -2.2 * row))
        assert len(mesh.vertices) - len(mesh.corners) // 2 + mesh.face_count == 2, name
        sides = mesh.vertices[mesh.corners] - mesh.vertices[mesh.corners[mesh.next_corner]]
        assert np.ptp(np.linalg.norm(sides, axis=1)) < 1e-6, "all edges are equally long"
        items.append(vp.Item(name, mesh))
    camera = vp.Camera(eye=(2.25, -60, 4), target=(2.25, 0, -4.4), fov_deg=12)
    scene = vp.Scene(tuple(items), title="The solids of Archimedes")
    drawing = vp.draw(scene, camera, page=vp.Page(420, 640, 22), crease_angle_deg=1, hidden="solid")
    pens = {"visible": vp.Pen(0.8, INK), "contour": vp.Pen(1.5, INK), "hidden": vp.Pen(0.35, BLUE)}
    layers = (replace(layer, pen=pens.get(layer.name, layer.pen), plotted=True) for layer in drawing.layers)
    drawing = replace(drawing, layers=tuple(sorted(layers, key=lambda layer: layer.pen.width_mm)))
    vp.save(drawing, folder / "plate_archimedes.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
