"""Scenes whose parts are moved apart along an axis, with traces of where they belong."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.curves.families.line import Line
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.motions.movable import shift_matrix
from vectorplot.scene.cuts.explosion import direction_of
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def exploded(scene: Scene, axis: str | ArrayLike = "z", factor: float = 1.5, *, traces: bool = True) -> Scene:
    """The scene with its parts moved apart along an axis, in their order along it.

    Parameters
    ----------
    scene : Scene
        Its items are the parts, those of one group one part; curves that are in no group with a body stay, if there
        are bodies.
    axis : {"x", "y", "z"} or (3,) array_like of float
        The first part stays, the others move along it.
    factor : float
        Between neighbours is room for this times a part of mean length, less one: at 1 they touch; 1 or more.
    traces : bool
        Thin chain lines show the way on which each part was moved.

    Returns
    -------
    Scene
        With the items in the same order; then the traces.

    Raises
    ------
    InputError
        For another axis, and a factor out of range.

    Notes
    -----
    Parts are in the order of the middles of their boxes; parts that are farther apart than that already stay so.

    Degenerate: parts with the same middle come in the order of the scene.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1)).moved(0, 0, z)) for name, z in (("a", 0), ("b", 1)))
    >>> apart = vp.exploded(vp.Scene(cubes), "z", 1.5)
    >>> [item.name for item in apart.items], apart.items[1].shape.bounds[:, 2].tolist()
    (['a', 'b', 'b trace'], [1.5, 2.5])
    """
    way = direction_of(axis)
    if not 1.0 <= factor < np.inf:
        raise InputError(f"explode: a factor of {factor:g}: expected a finite number, 1 or more")
    keys = [item.group or f"{number} {item.name}" for number, item in enumerate(scene.items)]
    bodies = [key for key, item in zip(keys, scene.items, strict=True) if not is_curve(item.shape)] or keys
    parts = {key: [n for n, own in enumerate(keys) if own == key] for key in dict.fromkeys(bodies)}
    boxes = {key: _box([scene.items[n] for n in which]) for key, which in parts.items()}
    spans = {key: _span([scene.items[n] for n in which], way) for key, which in parts.items()}
    order = sorted(parts, key=lambda key: float(spans[key].sum()))
    room = (factor - 1.0) * float(np.mean([high - low for low, high in spans.values()])) if parts else 0.0
    shifts: dict[str, float] = {}
    reached, moved = -np.inf, 0.0
    for key in order:
        low, high = spans[key].tolist()
        moved = max(moved, reached + room - low) if shifts else 0.0
        shifts[key], reached = moved, high + moved
    steps = [shifts.get(key, 0.0) * way for key in keys]
    items = [item.transformed(shift_matrix(*step)) for item, step in zip(scene.items, steps, strict=True)]
    extent = float(np.ptp(scene.bounds, axis=0).max())
    for before, key in pairwise(order):
        low, step = spans[key][0], shifts[key] - shifts[before]
        if not traces or step <= ZERO_OF_EXTENT * extent:
            continue
        middle = boxes[key].mean(axis=0)
        foot = middle + (low - float(middle @ way)) * way
        line = Line.through(foot + shifts[before] * way, foot + shifts[key] * way)
        name = scene.items[parts[key][0]].name
        items.append(Item(f"{name} trace", line, "black", lines=("trace",), occludes=False))
    return replace(scene, items=tuple(items), explosion=None)


def shown_apart(scene: Scene) -> Scene:
    """The scene with its parts moved apart, if it says so itself."""
    return scene if scene.explosion is None else exploded(scene, scene.explosion.way, scene.explosion.factor)


def _box(items: list[Item]) -> Floats:
    """(2,3) smallest and largest coordinates of some items."""
    bounds = [item.shape.bounds if isinstance(item.shape, Mesh) else smooth_bounds(item.shape) for item in items]
    low, high = np.array(bounds).transpose(1, 0, 2)
    return np.stack([low.min(axis=0), high.max(axis=0)])


def _span(items: list[Item], way: Floats) -> Floats:
    """(2,) from where to where some items reach along a direction: those of polyhedra exactly, else of their boxes."""
    heights = []
    for item in items:
        box = _box([item])
        corners = box[np.array(list(np.ndindex(2, 2, 2))), np.arange(3)]
        points = item.shape.vertices if isinstance(item.shape, Mesh) and len(item.shape.vertices) else corners
        heights.append(points @ way)
    every = np.concatenate(heights)
    return np.array([every.min(), every.max()])
