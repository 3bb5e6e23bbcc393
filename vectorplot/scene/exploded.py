"""Scenes whose parts are moved apart along an axis, with traces of where they belong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import is_curve, vector
from vectorplot.curves.families import Line
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame, shift_matrix
from vectorplot.geometry.vectors import norm
from vectorplot.scene.annotations import leader_tips
from vectorplot.scene.cuts import direction_of
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import ZERO_OF_EXTENT
from vectorplot.words import unknown

PARTS_AT_ONCE = 1 << 9
"""So many parts are looked at together for one that another stands over: it is mostly among the last ones."""


def exploded(
    scene: Scene,
    axis: str | ArrayLike | Mapping[str, ArrayLike] = "z",
    factor: float = 1.5,
    *,
    traces: bool = True,
) -> Scene:
    """The scene with its parts moved apart along an axis, in their order along it, or each along its own direction.

    Parameters
    ----------
    scene : Scene
        Its items are the parts, those of one group one part; curves that are in no group with a body stay, if there
        are bodies, but for leaders: these go with the part that they point at.
    axis : {"x", "y", "z"}, (3,) array_like of float, or mapping of str to (3,) array_like of float
        The first part stays, the others move along it. Or how far each of some parts is moved, in world units, by the
        names of items or groups; all others stay.
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
        For another axis, and a factor out of range; for moves of parts that are not there, or that are not finite.
    TypeError
        For what is no scene.

    Notes
    -----
    Parts are in the order of the middles of their boxes; parts that are farther apart than that already stay so. Parts
    beside each other that reach equally far along the axis, such as the bolts of a lid, move as one. A leader points at
    the smallest part in whose box its tip lies.

    Edge cases: other parts with the same middle come in the order of the scene.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1)).moved(0, 0, z)) for name, z in (("a", 0), ("b", 1)))
    >>> apart = vp.exploded(vp.Scene(cubes), "z", 1.5)
    >>> [item.name for item in apart.items], apart.items[1].shape.bounds[:, 2].tolist()
    (['a', 'b', 'b trace'], [1.5, 2.5])
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"exploded takes a Scene, such as vectorplot.io.scene_of(parts), not {type(scene).__name__}")
    if isinstance(axis, Mapping):
        return _moved_apart(scene, axis, traces)
    way = direction_of(axis)
    if not 1.0 <= factor < np.inf:
        raise InputError(f"explode: a factor of {factor:g}: expected a finite number, 1 or more")
    keys = [item.group or f"{number} {item.name}" for number, item in enumerate(scene.items)]
    bodies = [key for key, item in zip(keys, scene.items, strict=True) if not is_curve(item.shape)] or keys
    parts: dict[str, list[int]] = {key: [] for key in bodies}
    for n, key in enumerate(keys):
        if key in parts:
            parts[key].append(n)
    boxes = {key: _box([scene.items[n] for n in which]) for key, which in parts.items()}
    zero = ZERO_OF_EXTENT * float(np.ptp(scene.bounds, axis=0).max())
    ways = np.array([way, *axis_frame(way)[:2]])
    found = {key: _spans([scene.items[n] for n in which], ways) for key, which in parts.items()}
    order = sorted(parts, key=lambda key: float(found[key][0].sum()))
    spans = np.array([found[key] for key in order]).reshape(-1, 3, 2)
    room = (factor - 1.0) * float(np.mean(np.ptp(spans[:, 0], axis=1))) if parts else 0.0
    shifts = dict(zip(order, _shifts(spans, room, zero), strict=True))
    owners = {name: _part_at(tip, boxes, zero) for name, tip in leader_tips(scene).items()}
    steps = [
        shifts.get(owners.get(item.name, key) if is_curve(item.shape) else key, 0.0) * way
        for key, item in zip(keys, scene.items, strict=True)
    ]
    items = [item.transformed(shift_matrix(*step)) for item, step in zip(scene.items, steps, strict=True)]
    for number, key in enumerate(order):
        if not traces or shifts[key] <= zero:
            continue
        under = _under(spans[:number], spans[number], zero)
        low, start = spans[number, 0, 0], 0.0 if under is None else shifts[order[under]]
        if shifts[key] - start <= zero:
            continue
        middle = boxes[key].mean(axis=0)
        foot = middle + (low - float(matmul(middle, way))) * way
        items.append(_trace(scene.items[parts[key][0]].name, foot + start * way, foot + shifts[key] * way))
    return replace(scene, items=tuple(items), explosion=None)


def shown_apart(scene: Scene) -> Scene:
    """The scene with its parts moved apart, if it says so itself."""
    said = scene.explosion
    return scene if said is None else exploded(scene, dict(said.moves) if said.moves else said.way, said.factor)


def _moved_apart(scene: Scene, moves: Mapping[str, ArrayLike], traces: bool) -> Scene:
    """The scene with some of its parts moved, each by a vector of its own."""
    parts: dict[str, list[int]] = {}
    for number, item in enumerate(scene.items):
        parts.setdefault(item.group or item.name, []).append(number)
        if item.group:
            parts.setdefault(item.name, []).append(number)
    items, added = list(scene.items), []
    zero = ZERO_OF_EXTENT * float(np.ptp(scene.bounds, axis=0).max())
    boxes = {name: _box([scene.items[k] for k in which]) for name, which in parts.items() if name in moves}
    owners = {name: _part_at(tip, boxes, zero) for name, tip in leader_tips(scene).items()}
    for name, given in moves.items():
        if name not in parts:
            raise unknown("explode: item", name, tuple(parts))
        step = vector("explode: a move", given)
        for number in parts[name]:
            items[number] = items[number].transformed(shift_matrix(*step))
        for number, item in enumerate(scene.items):
            if owners.get(item.name) == name:
                items[number] = item.transformed(shift_matrix(*step))
        if traces and float(norm(step)) > zero:
            way = step / float(norm(step))
            middle = boxes[name].mean(axis=0)
            low = _spans([scene.items[k] for k in parts[name]], way[None])[0, 0]
            foot = middle + (float(low) - float(matmul(middle, way))) * way
            added.append(_trace(name, foot, foot + step))
    return replace(scene, items=(*items, *added), explosion=None)


def _trace(name: str, start: Floats, end: Floats) -> Item:
    """The line on which a part was moved."""
    return Item(f"{name} trace", Line.through(start, end), "black", lines=("trace",), occludes=False)


def _box(items: list[Item]) -> Floats:
    """(2,3) smallest and largest coordinates of some items."""
    bounds = [item.shape.bounds if isinstance(item.shape, Mesh) else smooth_bounds(item.shape) for item in items]
    low, high = np.array(bounds).transpose(1, 0, 2)
    return np.stack([low.min(axis=0), high.max(axis=0)])


def _spans(items: list[Item], ways: Floats) -> Floats:
    """(k,2) from where to where some items reach along directions (k,3): those of polyhedra exactly, else of their
    boxes."""
    places = []
    for item in items:
        box = _box([item])
        corners = box[np.array(list(np.ndindex(2, 2, 2))), np.arange(3)]
        places.append(item.shape.vertices if isinstance(item.shape, Mesh) and len(item.shape.vertices) else corners)
    heights = matmul(np.concatenate(places), ways.T)
    return np.stack([heights.min(axis=0), heights.max(axis=0)], axis=-1)


def _beside(ones: Floats, other: Floats, zero: float) -> Bools:
    """(n,) which parts with spans (n,3,2) are apart from one with these (3,2), across the first of the directions."""
    first, last = np.maximum(ones[:, 1:, 0], other[1:, 0]), np.minimum(ones[:, 1:, 1], other[1:, 1])
    return np.asarray((first >= last - zero).any(axis=1))


def _under(ones: Floats, other: Floats, zero: float) -> int | None:
    """The last one of parts with spans (n,3,2) that one with these (3,2) stands over: there it came from."""
    for end in range(len(ones), 0, -PARTS_AT_ONCE):
        start = max(end - PARTS_AT_ONCE, 0)
        found = np.flatnonzero(~_beside(ones[start:end], other, zero))
        if len(found):
            return start + int(found[-1])
    return None


def _shifts(spans: Floats, room: float, zero: float) -> list[float]:
    """How far parts with spans (n,3,2), in their order, move along the first of the directions."""
    shifts: list[float] = []
    reached, moved, begin = -np.inf, 0.0, 0
    for number, own in enumerate(spans):
        level = spans[begin:number]
        alike = np.abs(level[:1, 0] - own[0]).max(initial=0.0) <= zero
        if number and not (alike and _beside(level, own, zero).all()):
            begin, moved = number, max(moved, reached + room - float(own[0, 0]))
        shifts.append(moved)
        reached = float(own[0, 1]) + moved
    return shifts


def _part_at(point: Floats, boxes: dict[str, Floats], zero: float) -> str:
    """The smallest part in whose box a point lies, and no name where there is none."""
    around = [key for key, (low, high) in boxes.items() if (low - zero <= point).all() and (point <= high + zero).all()]
    return min(around, key=lambda key: float(np.ptp(boxes[key], axis=0).max()), default="")
