"""What items ask for of the lines on their bodies: which of them, planes of sections, and lights."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.item import Item
from vectorplot.scene.lines.curve_light import curve_light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.words import LineKind

Wants = Callable[[Item, LineKind], bool]
"""Whether an item wants lines of a kind."""


def wanting(items: Sequence[Item], wants: Wants, kind: LineKind) -> Ints:
    """(k,) which of the items want lines of a kind."""
    return np.array([k for k, item in enumerate(items) if wants(item, kind)], dtype=np.intp)


def section_planes(
    view: View, sight: EyeCoordinates, items: Sequence[Item], which: Ints, kind: LineKind
) -> tuple[Ints, Floats, Floats]:
    """The planes of a kind of sections: for which of the items (n,), and unit normals and points (n,3) of them in the
    coordinates of sight."""
    of: list[int] = []
    normals: list[tuple[float, float, float]] = []
    offsets: list[float] = []
    for k in which.tolist():
        for section in (s for s in items[k].curves.sections if s.kind == kind):
            of += [k] * len(section.offsets)
            normals += [section.normal] * len(section.offsets)
            offsets += section.offsets
    normal = np.array(normals).reshape(-1, 3)
    height = (np.array(offsets) - matmul(normal, view.centre)) / view.scale
    in_view = matmul(normal, view.axes.T)
    point = sight.points(in_view * height[:, None])
    return np.array(of, dtype=np.intp), sight.vectors(in_view), point


def lamps(
    scene: Scene, view: View, sight: EyeCoordinates, items: Sequence[Item], which: Ints
) -> tuple[Floats, Floats, Bools]:
    """Of the lights of isophotes the directions to those that are infinitely far, and the places of the others, (n,3)
    in the coordinates of sight; and (n,) whether they are infinitely far."""
    lights = [curve_light(scene, view, items[k]) for k in which.tolist()]
    position = np.array([light.position for light in lights]).reshape(-1, 3)
    parallel = np.array([light.parallel for light in lights], dtype=np.bool_)
    return sight.vectors(matmul(position, view.axes.T)), sight.points(view.points_of(position).T), parallel


def cosines(items: Sequence[Item], which: Ints) -> tuple[Ints, Floats]:
    """How many isophotes (n,) items ask for, and their cosines, one after the other."""
    counts = np.array([len(items[k].curves.isophotes) for k in which.tolist()], dtype=np.intp)
    return counts, np.concatenate([np.zeros(0), *(items[k].curves.isophotes for k in which.tolist())])
