"""Items in the very place of other ones: of those that hide each other everywhere only the last one is seen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from dataclasses import fields, is_dataclass, replace
from hashlib import blake2b

import numpy as np

from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Scene

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


def without_twins(scene: Scene) -> Scene:
    """The scene with nothing in place of items whose shape is, to the last digit, that of a later one that hides it.

    Pictures of faces show the same: of faces in one place the last one is painted over the others. Shapes are the same
    where all that they are made of is: functions only where they are the same object.
    """
    last: dict[Hashable, int] = {}
    glances = [_glance(item.shape) for item in scene.items]
    alike = Counter(glances)
    if len(alike) == len(glances):
        return scene
    # What differs at a glance is not looked at closely.
    keys = [
        fingerprint(item.shape) if alike[glance] > 1 else glance
        for item, glance in zip(scene.items, glances, strict=True)
    ]
    for number, (key, item) in enumerate(zip(keys, scene.items, strict=True)):
        if item.hides and not item.material.is_clear and item.material.opacity == 1.0:
            last[key] = number
    covered = [last.get(key, -1) > number for number, key in enumerate(keys)]
    if not any(covered):
        return scene
    pairs = zip(scene.items, covered, strict=True)
    return replace(scene, items=tuple(replace(item, shape=NOTHING) if gone else item for item, gone in pairs))


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
