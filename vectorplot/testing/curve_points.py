"""What counts as a curve in the assertions: arrays, lists of arrays, strokes, paths, drawings."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.drawing.strokes.fewer_cubics import CORNER_ANGLE
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import Polylines, closed_round, indices_along
from vectorplot.geometry.strokes import Strokes
from vectorplot.words import LineKind

Curves = Drawing | Paths | Strokes | ArrayLike | Sequence[ArrayLike]
"""A polyline (n, 2 or 3), several of them, or what holds polylines. A closed one repeats its first point."""


def curves_in_space(drawing: Drawing, *, kind: str | None = None, item: str | None = None) -> list[Floats]:
    """The strokes of a drawing, visible and hidden ones, as polylines in the world.

    Parameters
    ----------
    drawing : Drawing
        With its strokes.
    kind : str, optional
        Only those of a LineKind, by its word.
    item : str, optional
        Only those of an item, by its name.

    Returns
    -------
    list of (n, 3) array of float
        In world units, in drawing order; closed ones repeat their first point. A smooth stroke that turns a corner is
        one for each of its sides: there the pen goes on with another curve, or the curve has no tangent.

    Raises
    ------
    InputError
        For a kind or an item that does not exist.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.testing import curves_in_space
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> [border.shape for border in curves_in_space(drawing, kind="boundary")]
    [(4, 3)]
    """
    wanted_kind = None if kind is None else int(LineKind.from_word(kind))
    if item is not None and item not in drawing.items:
        raise InputError(f"item {item!r}: the drawing has {', '.join(drawing.items) or 'none'}")
    found: list[Floats] = []
    for layer in drawing.layers:
        for paths in layer.strokes:
            kept = np.ones(len(paths), dtype=np.bool_)
            if wanted_kind is not None:
                kept &= paths.kind == wanted_kind
            if item is not None:
                kept &= np.isin(paths.item, [k for k, name in enumerate(drawing.items) if name == item])
            found += _curves_of(paths, kept)
    return found


def _curves_of(paths: Paths, kept: Bools) -> list[Floats]:
    """The curves of the paths that are kept, parted at corners."""
    lines = Polylines(paths.points3d, paths.offsets, paths.closed)
    turns = np.repeat(paths.smooth, np.diff(paths.offsets)) & _corners(paths.directions)
    if not turns.any():
        return cut(lines, kept)
    found: list[Floats] = []
    for path in np.flatnonzero(kept & (np.diff(paths.offsets) > 0)).tolist():
        index = indices_along(lines, path)
        at = np.flatnonzero(turns[index[1:-1]]) + 1
        sides = [paths.points3d[index[low : high + 1]] for low, high in pairwise([0, *at.tolist(), len(index) - 1])]
        if len(sides) > 1 and paths.closed[path] and not turns[index[0]]:
            sides[0] = np.concatenate([sides.pop(), sides[0][1:]])
        found += sides or [paths.points3d[index]]
    return found


def _corners(directions: Floats) -> Bools:
    """(p,) where curves arrive and leave in directions (p,2) that are known and differ, other than in a cusp."""
    turn = np.abs(np.remainder(directions[:, 1] - directions[:, 0] + np.pi, 2.0 * np.pi) - np.pi)
    return np.asarray((turn > CORNER_ANGLE) & (turn < np.pi - CORNER_ANGLE))


def cut(lines: Polylines, kept: Bools) -> list[Floats]:
    """The polylines that are kept, each an array; closed ones with their first point once more; those without points
    are left out."""
    rounds = closed_round(lines)
    parts = np.split(lines.points[rounds.index], rounds.offsets[1:-1])
    return [part for part, wanted in zip(parts, kept, strict=False) if wanted and len(part)]


def polylines_of(curves: Curves) -> list[Floats]:
    """The polylines (n, 2 or 3) of curves in any form; those of drawings are in the world.

    Errors: InputError for other shapes.
    """
    if isinstance(curves, Drawing):
        return curves_in_space(curves)
    if isinstance(curves, Paths):
        return _curves_of(curves, np.ones(len(curves), dtype=np.bool_))
    if isinstance(curves, Strokes):
        every = np.ones(len(curves), dtype=np.bool_)
        return cut(Polylines(curves.points, curves.offsets, ~every), every)
    if isinstance(curves, (list, tuple)) and any(np.ndim(part) == 2 for part in curves):
        return [one_polyline(part) for part in curves if len(part)]
    try:
        array = np.asarray(curves, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("curves must be arrays (n,2) or (n,3), lists of such, or a drawing") from None
    if array.ndim == 3:
        return [one_polyline(part) for part in array if len(part)]
    return [one_polyline(array)] if array.size else []


def one_polyline(points: ArrayLike) -> Floats:
    """(n, 2 or 3) a polyline; a single point is one too. Errors: InputError for other shapes."""
    array = np.atleast_2d(np.asarray(points, dtype=np.float64))
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise InputError(f"a curve is an array (n,2) or (n,3), not one of shape {np.shape(points)}")
    return array


class CurvePoints(NamedTuple):
    """points (p, 2 or 3) of curves; curve (p,) and place (p,): which curve each lies on, and its place there."""

    points: Floats
    curve: Ints
    place: Ints

    def name(self, k: int) -> str:
        """Which point that is, in words."""
        coordinates = ", ".join(f"{x:.10g}" for x in self.points[k])
        which = f" of curve {self.curve[k]}" if self.curve[-1] > 0 else ""
        return f"point {self.place[k]}{which}, ({coordinates})"


def points_of(curves: Curves) -> CurvePoints:
    """All points of curves. Errors: AssertionError if there are none, or one is not finite."""
    parts = polylines_of(curves)
    assert parts, "there are no points: nothing to verify"
    if len({part.shape[1] for part in parts}) > 1:
        raise InputError("curves must be all in the plane, or all in space")
    size = [len(part) for part in parts]
    found = CurvePoints(
        np.concatenate(parts),
        ragged.owner(size),
        np.concatenate([np.arange(count) for count in size]),
    )
    bad = np.flatnonzero(~np.isfinite(found.points).all(axis=1))
    assert not len(bad), (
        f"{len(bad)} of {len(found.points)} points are not finite, the first: {found.name(int(bad[0]))}"
    )
    return found
