"""Splines in scene files: curves through points, surfaces through grids, and their kinds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.splines.basis import MOST_CONTROLS
from vectorplot.curves.splines.kinds import (
    AkimaSpline,
    ApproximatingSpline,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    SplineKind,
)
from vectorplot.curves.splines.spline_curve import SplineCurve, nurbs_curve, spline_curve
from vectorplot.errors import InputError
from vectorplot.io.scenes.scene_slots import (
    Family,
    Slot,
    read_family,
    read_flag,
    read_number,
    read_numbers,
    read_whole,
)
from vectorplot.io.scenes.scene_words import Words
from vectorplot.surfaces.splines.landscape import landscape
from vectorplot.surfaces.splines.spline_surface import SplineSurface, nurbs_surface, spline_surface


def read_points(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(n,3) points with commas between them."""
    columns, at = words.points(at, 3, owner, what)
    if len(columns[0]) > MOST_CONTROLS:
        words.fail(at, f"{owner}{what}: {len(columns[0])} of them, expected at most {MOST_CONTROLS}")
    return np.array(columns).T, at


def read_list(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(n,) numbers with blanks or commas between them."""
    value, at = read_number(words, at, owner, what)
    values = [value]
    while words.words[at] == "," or words.is_number(at) or words.words[at].startswith('"'):
        value, at = read_number(words, at + (words.words[at] == ","), owner, what)
        values.append(value)
    return np.array(values), at


def read_rows(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(m,n) numbers, a comma between rows."""
    rows: list[list[float]] = [[]]
    start = at
    while True:
        value, at = read_number(words, at, owner, what)
        rows[-1].append(value)
        if words.words[at] == ",":
            rows.append([])
            at += 1
        elif not words.is_number(at) and not words.words[at].startswith('"'):
            break
    _check_lengths(words, start, owner, f"row %d of {what}", [len(row) for row in rows])
    return np.array(rows), at


def read_lines(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(m,n,3) the points of a grid, line after line, the word before each."""
    start = at
    lines: list[Floats] = []
    while not lines or words.words[at] == what:
        points, at = read_points(words, at + bool(lines), owner, f"a point of a {what}")
        lines.append(points)
    _check_lengths(words, start, owner, f"{what} %d", [len(line) for line in lines])
    return np.stack(lines), at


def read_kind(words: Words, at: int, owner: str, what: str) -> tuple[SplineKind, int]:
    """A kind of spline, its word included."""
    word = words.words[at]
    if word not in _KINDS:
        words.fail(at, f"{owner}{what}: expected one of {', '.join(_KINDS)}, got {words.shown(at)}")
    return read_family(words, at + 1, owner, word, _KINDS)


def _read_named_kind(words: Words, at: int, owner: str, what: str) -> tuple[SplineKind, int]:
    """A kind of spline whose word stands before."""
    return read_family(words, at, owner, what, _KINDS)


def _check_lengths(words: Words, at: int, owner: str, what: str, lengths: list[int]) -> None:
    """All lines must be equally long."""
    for number, length in enumerate(lengths, start=1):
        if length != lengths[0]:
            words.fail(at, f"{owner}{what % number} has {length}, {what % 1} has {lengths[0]}")


_FLAG = Slot(read_flag, False)
_ORDER = Slot(read_whole, 4)
_THROUGH = {"closed": _FLAG, "parameters": Slot(read_list)}
_POINTS = Slot(read_points, needed=True)
_LIST = Slot(read_list)


def _cubic(*, tangents: tuple[float, ...] | None, **values: Any) -> CubicSpline:
    return CubicSpline(tangents=None if tangents is None else (tangents[:3], tangents[3:]), **values)


def _approximating(*, controls: int, **values: Any) -> ApproximatingSpline:
    return ApproximatingSpline(controls, **values)


_KINDS = {
    "akima": Family(_THROUGH, (), AkimaSpline),
    "cubic": Family({**_THROUGH, "tangents": Slot(read_numbers(6))}, (), _cubic),
    "bspline": Family({"order": _ORDER, "closed": _FLAG}, (), BSpline),
    "interpolating": Family({"order": _ORDER, **_THROUGH}, (), InterpolatingSpline),
    "approximating": Family(
        {"controls": Slot(read_whole, needed=True), "order": _ORDER, **_THROUGH}, (), _approximating
    ),
}
"""Kinds of splines, by their words."""


def _curve_of(kind: Callable[..., SplineKind]) -> Callable[..., SplineCurve]:
    """How to build a curve of a kind."""

    def build(*, points: Floats, **values: Any) -> SplineCurve:
        return spline_curve(points, kind(**values))

    return build


SPLINE_CURVES = {
    **{
        word: Family({"points": _POINTS, **family.slots}, ("points",), _curve_of(family.build))
        for word, family in _KINDS.items()
    },
    "nurbs": Family(
        {"points": _POINTS, "order": _ORDER, "weights": _LIST, "knots": _LIST, "closed": _FLAG},
        ("points",),
        lambda points, **values: nurbs_curve(points, **values),
    ),
}
"""Splines as curves, by their words."""


def _surface(*, grid: Floats, kind: SplineKind | None, u: SplineKind | None, v: SplineKind | None) -> SplineSurface:
    return spline_surface(grid, u or kind, v or kind)


def _nurbs(
    *,
    grid: Floats,
    orders: tuple[float, ...],
    weights: Floats | None,
    knots_u: Floats | None,
    knots_v: Floats | None,
    closed_u: bool,
    closed_v: bool,
) -> SplineSurface:
    if not all(order.is_integer() for order in orders):
        raise InputError(f"nurbs: orders {orders[0]:g} and {orders[1]:g} must be whole numbers")
    if weights is not None and weights.size != grid[..., 0].size:
        raise InputError(f"nurbs: {weights.size} weights for {grid[..., 0].size} points")
    return nurbs_surface(
        grid,
        None if weights is None else weights.reshape(grid.shape[:2]),
        orders=(int(orders[0]), int(orders[1])),
        knots=(knots_u, knots_v),
        closed=(closed_u, closed_v),
    )


def _landscape(*, heights: Floats, kind: SplineKind | None, **values: Any) -> SplineSurface:
    # Rows are written from south to north, each from west to east.
    return landscape(heights.T, kind=kind, **values)


_LINES = Slot(read_lines, needed=True, into="grid")
_KIND = dict.fromkeys(_KINDS, Slot(_read_named_kind, into="kind"))

SPLINE_SURFACES = {
    "spline": Family({"line": _LINES, **_KIND, "u": Slot(read_kind), "v": Slot(read_kind)}, (), _surface),
    "nurbs": Family(
        {
            "line": _LINES,
            "orders": Slot(read_numbers(2), (4.0, 4.0)),
            "weights": _LIST,
            "knots_u": _LIST,
            "knots_v": _LIST,
            "closed_u": _FLAG,
            "closed_v": _FLAG,
        },
        (),
        _nurbs,
    ),
    "landscape": Family(
        {
            "heights": Slot(read_rows, needed=True),
            "x": Slot(read_numbers(2), needed=True),
            "y": Slot(read_numbers(2), needed=True),
            **_KIND,
        },
        ("heights",),
        _landscape,
    ),
}
"""Splines as surfaces, by their words."""
