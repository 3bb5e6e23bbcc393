"""Lines clipped by windows and boxes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping.clip_windows import Box, Window, region_codes

Drawn = TypeVar("Drawn")


@dataclass(frozen=True, eq=False)
class ClippedLines:
    """Segments after clipping.

    Parameters
    ----------
    start, end : (n, k) array of float
        Rows of segments of which nothing is left have no meaning.
    exists : (n,) array of bool
        Something is left.
    clipped : (n,) array of bool
        Something is gone.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> window = geometry.Window(0, 10, 0, 10)
    >>> lines = geometry.clip_lines_2d([(5, 5), (20, 0)], [(6, 6), (20, 9)], window)
    >>> lines.exists.tolist(), lines.clipped.tolist()
    ([True, False], [False, True])
    """

    start: Floats
    end: Floats
    exists: Bools
    clipped: Bools


def clip_lines_2d(start: ArrayLike, end: ArrayLike, window: Window) -> ClippedLines:
    """The parts of segments inside a window.

    Parameters
    ----------
    start, end : (n, 2 or more) array_like of float
        Further columns, such as depth, go along linearly.
    window : Window
        The clipping region.

    Returns
    -------
    ClippedLines
        New ends lie on the window's sides to the last digit, and segments that are wholly inside keep every digit.

    Notes
    -----
    Source: Glaeser, section 2.5 (Cohen and Sutherland); errata G2-07, G2-10.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> lines = geometry.clip_lines_2d([(-5, 5)], [(15, 5)], geometry.Window(0, 10, 0, 10))
    >>> lines.start.tolist(), lines.end.tolist()
    ([[0.0, 5.0]], [[10.0, 5.0]])
    """
    p, q = (np.array(x, dtype=np.float64) for x in (start, end))
    clipped = (region_codes(p, window) | region_codes(q, window)) != 0
    gone = np.zeros(len(p), dtype=np.bool_)
    for _, axis, limit, sign in window.sides:
        for moved, fixed in ((p, q), (q, p)):
            out = sign * (moved[:, axis] - limit) < 0.0
            gone |= out & (sign * (fixed[:, axis] - limit) < 0.0)
            rows = np.flatnonzero(out & ~gone)
            a, b = moved[rows], fixed[rows]
            share = (limit - a[:, axis]) / (b[:, axis] - a[:, axis])
            moved[rows] = a + share[:, None] * (b - a)
            moved[rows, axis] = limit
    return ClippedLines(p, q, ~gone, clipped)


def clip_lines_3d(start: ArrayLike, end: ArrayLike, box: Box) -> ClippedLines:
    """The parts of segments inside a box, wherever the eye is.

    Parameters
    ----------
    start, end : (n, 4) array_like of float
        Homogeneous, as CoordinateSystem.homogeneous gives them.
    box : Box
        The clipping region.

    Returns
    -------
    ClippedLines
        Ends (n, 3) after T2.

    Notes
    -----
    Source: Glaeser, section 2.5; errata G2-08 to G2-10.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> system = geometry.CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> start, end = system.homogeneous([(0, 0, 0)]), system.homogeneous([(0, 0, 20)])
    >>> lines = geometry.clip_lines_3d(start, end, geometry.Box(geometry.Window(-1, 1, -1, 1)))
    >>> lines.start.tolist(), lines.end.round(9).tolist()
    ([[0.0, 0.0, 0.0]], [[0.0, 0.0, 4.0]])
    """
    p, q = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    low, high, exists, clipped = _inside_part(matmul(p, box.planes.T), matmul(q, box.planes.T))
    ends = [
        np.where((t < 0.5)[:, None], p + t[:, None] * (q - p), q - (1.0 - t)[:, None] * (q - p)) for t in (low, high)
    ]
    flat = [divided(e, exists) for e in ends]
    return ClippedLines(flat[0], flat[1], exists, clipped)


def _inside_part(p: Floats, q: Floats) -> tuple[Floats, Floats, Bools, Bools]:
    """From distances (n, planes) of both ends: parameters of the part inside, whether there is one, whether any is
    cut."""
    out_p, out_q = p < 0.0, q < 0.0
    share = p / np.where(out_p != out_q, p - q, 1.0)
    low = np.where(out_p & ~out_q, share, 0.0).max(axis=-1)
    high = np.where(out_q & ~out_p, share, 1.0).min(axis=-1)
    exists = ~(out_p & out_q).any(axis=-1) & (low <= high)
    return low, high, np.asarray(exists), np.asarray((out_p | out_q).any(axis=-1))


def divided(points: Floats, exists: Bools) -> Floats:
    """(n,3) homogeneous points (n,4) in space; of those that do not exist no meaning."""
    weight = np.where(exists & (points[:, 3] > 0.0), points[:, 3], 1.0)
    return np.asarray(points[:, :3] / weight[:, None])


def clip_and_draw(
    start: ArrayLike,
    end: ArrayLike,
    clip: Callable[[ArrayLike, ArrayLike], ClippedLines],
    draw: Callable[[Floats, Floats], Drawn],
) -> Drawn:
    """What draw makes of the segments that clip leaves: any way of clipping goes with any way of drawing.

    Parameters
    ----------
    start, end : (n, 2 or more) array_like of float
        The segments.
    clip : callable
        clip(start, end) gives ClippedLines.
    draw : callable
        draw(start, end) is called with the parts that exist.

    Returns
    -------
    Any
        What draw returns.

    Notes
    -----
    Segments that are not clipped are drawn as they are. Source: Glaeser, section 2.5.

    Examples
    --------
    >>> from functools import partial
    >>> from vectorplot import geometry
    >>> clip = partial(geometry.clip_lines_2d, window=geometry.Window(0, 10, 0, 10))
    >>> geometry.clip_and_draw([(-5, 5), (20, 0)], [(15, 5), (20, 9)], clip, lambda start, end: (end - start).tolist())
    [[10.0, 0.0]]
    """
    lines = clip(start, end)
    return draw(lines.start[lines.exists], lines.end[lines.exists])
