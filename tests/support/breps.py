"""Bodies by their trimmed faces, made by hand: what tests of them look at without OpenCASCADE."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

import vectorplot as vp
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.brep import Brep, BrepEdges, BrepFace, Plane, TurnedLine
from vectorplot.surfaces.parameter_regions import parameter_region
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain

RADIUS, HEIGHT = 1.0, 2.0
ROWS = 129


def straight(corners: list[tuple[float, float]]) -> np.ndarray:
    """(k,4,2) the sides of a polygon as cubic pieces."""
    start = np.array(corners, dtype=float)
    way = np.roll(start, -1, axis=0) - start
    return np.stack([start, start + way / 3.0, start + 2.0 * way / 3.0, start + way], axis=1)


def hermite(values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """(k,4,2) the cubic pieces between rows."""
    return np.stack([values[:-1], values[:-1] + slopes[:-1] / 3.0, values[1:] - slopes[1:] / 3.0, values[1:]], axis=1)


@cache
def rod() -> Brep:
    """A cylinder about the z-axis from z = 0 to HEIGHT, with its two ends: three faces, two circles for edges."""
    t = np.linspace(0.0, 2.0 * math.pi, ROWS)
    step = 2.0 * math.pi / (ROWS - 1)
    x, y = np.cos(t), np.sin(t)
    x[-1], y[-1] = 1.0, 0.0
    flat, flat_turns = RADIUS * np.stack([x, y], axis=1), RADIUS * step * np.stack([-y, x], axis=1)
    side = Domain(0.0, 2.0 * math.pi, 0.0, HEIGHT, closed_u=True)
    ring = straight([(0.0, 0.0), (2.0 * math.pi, 0.0), (2.0 * math.pi, HEIGHT), (0.0, HEIGHT)])
    faces = [
        BrepFace(
            PlacedSurface(TurnedLine(side, RADIUS), np.eye(3)),
            parameter_region(side, [ring], filled=False),
            flat=False,
            turned=False,
        )
    ]
    around = Domain(-1.1, 1.1, -1.1, 1.1)
    for z in (0.0, HEIGHT):
        region = parameter_region(around, [hermite(flat, flat_turns)], filled=False)
        plane = PlacedSurface(Plane(around), np.eye(3), (0.0, 0.0, z))
        faces.append(BrepFace(plane, region, flat=True, turned=z == 0.0))
    points, slopes, places, turns = [], [], [], []
    for face in range(4):
        z = HEIGHT * (face // 2)
        points.append(np.column_stack([flat, np.full(ROWS, z)]))
        slopes.append(np.column_stack([flat_turns, np.zeros(ROWS)]))
        on_side = face % 2 == 0
        places.append(np.column_stack([t, np.full(ROWS, z)]) if on_side else flat)
        turns.append(np.column_stack([np.full(ROWS, step), np.zeros(ROWS)]) if on_side else flat_turns)
    edges = BrepEdges(
        np.zeros(2, dtype=np.intp),
        np.zeros(2, dtype=bool),
        np.array([0, 0, 1, 1]),
        np.array([0, 1, 0, 2]),
        ROWS * np.arange(5),
        *map(np.concatenate, (points, slopes, places, turns)),
    )
    rim = [(RADIUS * math.cos(a), RADIUS * math.sin(a), z) for z in (0.0, HEIGHT) for a in t[:-1].tolist()]
    n, k = ROWS - 1, np.arange(ROWS - 1)
    after = (k + 1) % n
    triangles = np.concatenate(
        [
            np.stack([k, after, n + k], axis=1),
            np.stack([after, n + after, n + k], axis=1),
            np.stack([0 * k[1:-1], after[1:-1], k[1:-1]], axis=1),
            np.stack([n + 0 * k[1:-1], n + k[1:-1], n + after[1:-1]], axis=1),
        ]
    )
    return Brep(tuple(faces), edges, Mesh.from_triangles(rim, triangles))


def rod_item(name: str = "rod", **more: object) -> vp.Item:
    """The rod as an item, with the lines of parts."""
    body = rod()
    return vp.Item(name, body.mesh, exact=body, default_lines=("contour", "boundary", "crease", "tangent"), **more)
