"""The letters of labels: plain ones beside points, and those along curves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.lettering.formulas import FORMULA, without_formulas_in_strokes
from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.drawing.lettering.text import Lettering, broken_at_blanks, lettered, typeset
from vectorplot.drawing.lettering.text_along import lettered_along, typeset_along
from vectorplot.errors import InputError
from vectorplot.scene.naming.labels import Label
from vectorplot.scene.placement import Placement

HALO_MM = 0.6
"""Lines end so far before the letters."""

GAP = 0.4
"""From a point to the letters beside it, in heights of capitals."""


@dataclass(frozen=True)
class Letters:
    """How texts become letters: plain ones, and those along curves."""

    plain: Callable[..., Lettering]
    along: Callable[..., Lettering]


def _stroked(text: str, *where: Any, **how: Any) -> Lettering:
    return lettered(without_formulas_in_strokes(text), *where, **how)


def _stroked_along(text: str, *where: Any, **how: Any) -> Lettering:
    return lettered_along(without_formulas_in_strokes(text), *where, **how)


LETTERS = {"strokes": Letters(_stroked, _stroked_along), "real": Letters(typeset, typeset_along)}
"""What letters are: strokes of a pen, or those of the fonts of whatever reads the file."""


def set_label(letters: Letters, label: Label, room: float, mm: float) -> Lettering:
    """A label beside a point, in several lines where it is wider than there is room; no formula is broken.

    Errors: InputError, with its name, for a character without strokes.
    """

    def set_(text: str) -> Lettering:
        return letters.plain(text, size_mm=label.size_mm * mm, align="centre")

    def fits(text: str) -> bool:
        return float(np.ptp(set_(text).bounds, axis=0)[0]) <= room

    try:
        if FORMULA.search(label.text) or fits(label.text):
            return set_(label.text)
        return set_("\n".join(broken_at_blanks(line, fits) for line in label.text.split("\n")))
    except InputError as error:
        raise InputError(f"label {label.name}: {error.cause}") from None


def course_on_page(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(n,2) on the page, the course of the curve that a label stands along."""
    course, projection = seen.anchors.courses[number], placement.projection
    assert course is not None
    points = projection.points_of(course)
    ahead = projection.depth_of(points) > projection.near
    return placement.on_page(projection.image_of(points.compress(ahead, axis=1)))


def length_of(path: Floats) -> float:
    """The length of a polyline (n,2)."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def set_along(
    letters: Letters, seen: SeenLabels, number: int, path: Floats, mm: float, place: str = "", at: float | None = None
) -> Lettering:
    """Letters along the course of a curve on the page; place and at: other ones than those of the label."""
    label = seen.anchors.labels[number]
    steps = np.hypot(*np.diff(path, axis=0).T)
    nearest = int(np.argmin(np.hypot(*(path - seen.points[number]).T)))
    whole = float(steps.sum())
    part = float(steps[:nearest].sum()) / whole if whole else 0.0
    size = label.size_mm * mm
    level, off = {"above": ("base", GAP), "below": ("top", -GAP)}.get(place or label.place, ("middle", 0.0))
    part = part if at is None else at
    try:
        return letters.along(label.text, path, size_mm=size, level=level, at=part, off_mm=off * size)
    except InputError as error:
        raise InputError(f"label {label.name}: {error.cause}") from None
