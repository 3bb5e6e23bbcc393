"""What is shown while the picture moves: few lines of the scene in the world, which a browser projects itself."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats
from vectorplot.draw import draw
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.adjacency import mesh_edges
from vectorplot.geometry.vectors import norm
from vectorplot.scene.scene import Scene
from vectorplot.shading.light.palettes import palette

MOST_SEGMENTS = 12_000
"""So many lines a browser draws fifteen times a second, on one core."""

MOST_BOXES = 500
"""Of scenes with more items the boxes of the first ones are shown."""

MOST_COLOURS = 32
"""So many colours of items are shown."""

COARSE_MM = 0.5
"""How far off lines on smooth surfaces may be while they move."""

SHADES = 16
"""Of each colour that is shown."""


@dataclass(frozen=True, eq=False)
class Moving:
    """Lines in the world and what is shown over pictures.

    segments (n,2,3); boxes (m,2,3) lowest and highest corners of items; thinned: the segments are some of many.
    """

    segments: Floats
    boxes: Floats
    thinned: bool
    colours: tuple[tuple[str, tuple[str, ...]], ...]


def moving(scene: Scene) -> Moving:
    """The edges of meshes and the lines on smooth surfaces, no more than MOST_SEGMENTS, evenly chosen; the boxes round
    items; the shades of their colours, darkest first.

    Degenerate: nothing for an empty scene.
    """
    meshes = [item for item in scene.items if isinstance(item.shape, Mesh)]
    others = tuple(item for item in scene.items if not isinstance(item.shape, Mesh))
    parts = [_edges(item.shape) for item in meshes if isinstance(item.shape, Mesh)]
    if others:
        parts.append(_lines(Scene(others)))
    segments = np.concatenate([np.zeros((0, 2, 3)), *parts])
    step = -(-len(segments) // MOST_SEGMENTS)
    chosen = segments[:: max(step, 1)]
    return Moving(chosen, _boxes(scene), step > 1, _colours(scene))


def _edges(mesh: Mesh) -> Floats:
    return mesh.vertices[mesh_edges(mesh)]


def _lines(scene: Scene) -> Floats:
    """What a wireframe from afar shows of surfaces and curves."""
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(norm(high - low)) or 1.0
    x, y, z = (middle + size * np.array([2.0, -3.0, 2.0])).tolist()
    camera = Camera((x, y, z), tuple(middle.tolist()), parallel=True, height=size)
    found = []
    for layer in draw(scene, camera, style="wireframe", curves="polyline", tolerance_mm=COARSE_MM).layers:
        for paths in layer.strokes:
            follows = np.ones(len(paths.points3d), dtype=bool)
            follows[paths.offsets[1:] - 1] = False
            start = np.flatnonzero(follows)
            found.append(np.stack([paths.points3d[start], paths.points3d[start + 1]], axis=1))
            whole = np.flatnonzero(paths.closed)
            ends = paths.offsets[whole + 1] - 1, paths.offsets[whole]
            found.append(np.stack([paths.points3d[end] for end in ends], axis=1))
    segments = np.concatenate([np.zeros((0, 2, 3)), *found])
    return np.asarray(segments[np.isfinite(segments).all(axis=(1, 2))])


def _boxes(scene: Scene) -> Floats:
    found = []
    for item in islice(scene.items, MOST_BOXES):
        try:
            found.append(item.shape.bounds if isinstance(item.shape, Mesh) else Scene((item,)).bounds)
        except InputError:
            continue
    return np.array(found).reshape(-1, 2, 3)


def _colours(scene: Scene) -> tuple[tuple[str, tuple[str, ...]], ...]:
    names = dict.fromkeys(item.colour for item in scene.items)
    return tuple((name, tuple(_hex(shade) for shade in palette(name, SHADES))) for name in islice(names, MOST_COLOURS))


def _hex(shade: NDArray[np.uint8]) -> str:
    return "#" + "".join(f"{part:02x}" for part in shade.tolist())
