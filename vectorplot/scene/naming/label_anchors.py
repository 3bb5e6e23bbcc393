"""Where the things are that labels of a scene name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.naming.labels import Along, AtVertex, BesidePoint, Label, OnCurve, OnPage
from vectorplot.scene.scene import Scene

CHORDS = 256
"""Letters along a curve follow so many chords of it."""


@dataclass(frozen=True, eq=False)
class LabelAnchors:
    """Labels and what they name: points (l,3) in the world, NaN for those on the page; courses: the points (k,3) of the
    curve, for those on or along one."""

    labels: tuple[Label, ...]
    points: Floats
    courses: tuple[Floats | None, ...]

    def __len__(self) -> int:
        return len(self.labels)


def label_anchors(scene: Scene) -> LabelAnchors:
    """What the labels of a scene name.

    Errors: InputError, with the label's name, for an item or a vertex that the scene does not have, and for one that is
    no curve or no polyhedron.
    """
    items = {item.name: item for item in reversed(scene.items)}
    courses = tuple(
        _course(label, label.at, items) if isinstance(label.at, (Along, OnCurve)) else None for label in scene.labels
    )
    found = zip(scene.labels, courses, strict=True)
    points = [_point(label, items) if course is None else _part(label, course) for label, course in found]
    return LabelAnchors(scene.labels, np.array(points, dtype=np.float64).reshape(-1, 3), courses)


def _point(label: Label, items: dict[str, Item]) -> Floats:
    at = label.at
    if isinstance(at, OnPage):
        return np.full(3, np.nan)
    if isinstance(at, BesidePoint):
        return np.array(at.point, dtype=np.float64)
    if isinstance(at, tuple):
        return np.array(at, dtype=np.float64)
    assert isinstance(at, AtVertex)
    shape = _item(label, at.item, items).shape
    if not isinstance(shape, Mesh):
        raise InputError(f"label {label.name}: {at.item} has no vertices: it is no polyhedron")
    if not 0 <= at.vertex < len(shape.vertices):
        raise InputError(f"label {label.name}: {at.item} has {len(shape.vertices)} vertices, not {at.vertex + 1}")
    return np.asarray(shape.vertices[at.vertex])


def _course(label: Label, at: Along | OnCurve, items: dict[str, Item]) -> Floats:
    shape = _item(label, at.item, items).shape
    if not is_curve(shape):
        raise InputError(f"label {label.name}: {at.item} is no curve")
    points = shape.points(np.linspace(shape.start, shape.end, CHORDS + 1))
    return np.asarray(points[np.isfinite(points).all(axis=1)])


def _part(label: Label, course: Floats) -> Floats:
    """The point of a course at the part of its length that a label is at."""
    assert isinstance(label.at, (Along, OnCurve))
    passed = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(course, axis=0), axis=1))])
    if not len(course) or not passed[-1] > 0.0:
        raise InputError(f"label {label.name}: {label.at.item} has no length")
    at = label.at.part * passed[-1]
    return np.array([np.interp(at, passed, column) for column in course.T])


def _item(label: Label, name: str, items: dict[str, Item]) -> Item:
    if name not in items:
        raise InputError(f"label {label.name}: there is no item {name!r}")
    return items[name]
