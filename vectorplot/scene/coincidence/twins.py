"""Items in the very place of other ones: they show nothing, hide nothing and meet nothing that those do not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from dataclasses import fields, is_dataclass, replace
from hashlib import blake2b
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.coincidence.same_place import are_in_one_place
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.surface import Surface, is_parametrised

_WEIGHT = float(np.sqrt(2.0))
"""Sums with irrational steps between their weights differ where bodies do, nearly always."""

BOX_ERROR = 1.0 / 250.0
"""Boxes of surfaces in one place differ by no more than this part of their extent."""

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


def without_twins(scene: Scene) -> Scene:
    """The scene with nothing in place of items whose shape is, to the last digit, that of a later one that hides it, or
    a surface made of the same points.

    Pictures of faces show the same: of faces in one place the last one is painted over the others. Shapes are the same
    where all that they are made of is: functions only where they are the same object.
    """
    last: dict[Hashable, int] = {}
    keys = _keys_of_turned(scene, _keys(scene))
    if len(set(keys)) == len(keys):
        return scene
    for number, (key, item) in enumerate(zip(keys, scene.items, strict=True)):
        if item.hides and not item.material.is_clear and item.material.opacity == 1.0:
            last[key] = number
    covered = [last.get(key, -1) > number for number, key in enumerate(keys)]
    if not any(covered):
        return scene
    pairs = zip(scene.items, covered, strict=True)
    return replace(scene, items=tuple(replace(item, shape=NOTHING) if gone else item for item, gone in pairs))


def _keys(scene: Scene) -> list[Hashable]:
    """What is equal for items of the same shape only."""
    glances = [_glance(item.shape) for item in scene.items]
    alike = Counter(glances)
    # What differs at a glance is not looked at closely.
    return [
        fingerprint(item.shape) if alike[glance] > 1 else glance
        for item, glance in zip(scene.items, glances, strict=True)
    ]


def _keys_of_turned(scene: Scene, keys: list[Hashable]) -> list[Hashable]:
    """The keys, those of parametrised surfaces in one place being that of the first."""
    shapes: dict[Hashable, Surface] = {
        key: item.shape for key, item in zip(keys, scene.items, strict=True) if is_parametrised(item.shape)
    }
    if len(shapes) < 2:
        return keys
    names, surfaces = list(shapes), list(shapes.values())
    boxes = np.array([smooth_bounds(surface) for surface in surfaces]).reshape(-1, 6)
    # Boxes are known to a thousandth.
    near = BOX_ERROR * (boxes[:, 3:] - boxes[:, :3]).max(axis=1)
    first = dict(zip(names, names, strict=True))
    for k, surface in enumerate(surfaces):
        others = np.flatnonzero((np.abs(boxes[:k] - boxes[k]) <= near[k]).all(axis=1))
        same = (m for m in others.tolist() if first[names[m]] == names[m] and are_in_one_place(surfaces[m], surface))
        first[names[k]] = names[next(same, k)]
    return [first.get(key, key) for key in keys]


def first_twins(view: View) -> Ints:
    """(i,) for every item of a view the first one that has, to the last digit, the same faces in the same place, and
    hides as it does or does not: itself where no other one is before it; smooth surfaces and empty items are their own.
    """
    items = len(view.item_vertices) - 1
    first = np.arange(items)
    offsets, faces = view.item_vertices, np.searchsorted(view.face_item, np.arange(items + 1))
    some = np.flatnonzero((np.diff(offsets) > 0) & (np.diff(faces) > 0))
    glance = [view.occludes[some], np.diff(faces)[some], np.diff(offsets)[some], *view.points[:, offsets[some]]]
    some, glance, _ = _alike(some, glance)
    if not len(some):
        return first
    some, _, leader = _alike(some, [*glance[:3], *_weighted(view, some)])
    return _checked(view, faces, some, leader, first) if len(some) else first


def _alike(items: Ints, said: list[NDArray[Any]]) -> tuple[Ints, list[NDArray[Any]], Ints]:
    """Those items (k,) of which the same is said as of another one, with what is said, and the first one of each."""
    order = np.lexsort((items, *said))
    new = np.ones(len(items), dtype=np.bool_)
    new[1:] = np.logical_or.reduce([column[order[1:]] != column[order[:-1]] for column in said])
    run = np.cumsum(new) - 1
    several = np.bincount(run, minlength=1)[run] > 1
    leader = items[order][np.flatnonzero(new)][run[several]] if len(items) else items
    return items[order][several], [column[order][several] for column in said], leader


def _weighted(view: View, items: Ints) -> list[Floats]:
    """Sums over the coordinates of each item, weighted by their places."""
    vertex, offsets = ragged.take(view.item_vertices, items)
    weight = 1.0 + _WEIGHT * ragged.place(np.diff(offsets))
    return [np.add.reduceat(weight * axis[vertex], offsets[:-1]) for axis in view.points]


def _checked(view: View, faces: Ints, items: Ints, leader: Ints, first: Ints) -> Ints:
    """The first ones (i,) with the leaders (k,) of items (k,) that are like them in all vertices and faces."""
    later = items != leader
    items, leader = items[later], leader[later]
    same = np.ones(len(items), dtype=np.bool_)
    for offsets, values in (
        (view.item_vertices, [*view.points]),
        (faces, [view.face_sizes]),
        (view.offsets[faces], [view.corners - np.repeat(view.item_vertices[view.face_item], view.face_sizes)]),
    ):
        one, runs = ragged.take(offsets, items)
        # Sizes may differ where only sums are equal.
        other = np.minimum(ragged.ranges(offsets[leader], np.diff(runs)), len(values[0]) - 1)
        differ = np.logical_or.reduce([column[one] != column[other] for column in values])
        same &= ~np.logical_or.reduceat(differ, runs[:-1])
        same &= np.diff(offsets)[items] == np.diff(offsets)[leader]
    first[items[same]] = leader[same]
    return first


def _glance(shape: object) -> Hashable:
    """What is equal for equal shapes, and seldom for others."""
    if isinstance(shape, Mesh):
        return Mesh, shape.vertices.shape, shape.corners.shape, shape.vertices[:1].tobytes()
    return type(shape).__module__, type(shape).__qualname__


def fingerprint(value: object) -> Hashable:
    """What is equal for values made of the same numbers, words and functions, however deep."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, blake2b(value.tobytes()).digest()
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), tuple(fingerprint(getattr(value, field.name)) for field in fields(value))
    if isinstance(value, tuple | list):
        return tuple(fingerprint(one) for one in value)
    if isinstance(value, str | int | float | bool | complex | type(None)):
        return type(value), value
    return id(value)
