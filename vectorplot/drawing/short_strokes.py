"""Strokes too short for a pen: specks that nothing goes on from, and all below a length that is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.drawing import STROKES, Layer, Paths
from vectorplot.drawing.finishing import Grouping, by_line, long_strokes
from vectorplot.drawing.hatching import DOT_MM
from vectorplot.drawing.strokes import chosen, clusters, concatenated, connected
from vectorplot.geometry.budget import mapped
from vectorplot.tolerances import COINCIDENT_MM, LONE_STROKE_MM
from vectorplot.words import LineKind


def without_specks(layers: Sequence[Layer]) -> tuple[Layer, ...]:
    """The layers without specks: open strokes that are shorter than LONE_STROKE_MM together with all that they hang
    together with, end to end, on whichever layers.

    Edge cases: dots of stipplings are none, nor are closed strokes, which show something whole, nor what only touches
    another stroke amid its way.
    """
    parts = [paths for layer in layers for paths in layer.strokes]
    every = concatenated(tuple(parts))
    length = stroke_lengths(every)
    short = (length < LONE_STROKE_MM) & ~every.closed & (np.diff(every.offsets) > 0) & ~_dots(every, length)
    if not short.any():
        return tuple(layers)
    ends, kept = _ends(every), np.ones(len(every), dtype=np.bool_)
    kept[short] = ~_alone(ends[short], ends[~short & ~every.closed], length[short])
    return _chosen(layers, parts, np.split(kept, np.cumsum([len(paths) for paths in parts])[:-1]))


def without_short(
    layers: Sequence[Layer], shortest_mm: float, group: Grouping = by_line
) -> tuple[tuple[Layer, ...], int]:
    """The layers with strokes joined, those shorter than shortest_mm left out, and how many these are.

    group: see inked. Edge case: dots of stipplings stay.
    """
    parts = list(mapped(lambda paths: long_strokes(paths, group), [p for layer in layers for p in layer.strokes]))
    lengths = [stroke_lengths(paths) for paths in parts]
    kept = [(length >= shortest_mm) | _dots(paths, length) for paths, length in zip(parts, lengths, strict=True)]
    return _chosen(layers, parts, kept), sum(int((~some).sum()) for some in kept)


def stroke_count(layers: Sequence[Layer]) -> int:
    """How many strokes there are."""
    return sum(len(paths) for layer in layers for paths in layer.strokes)


def _chosen(layers: Sequence[Layer], parts: Sequence[Paths], kept: Sequence[Bools]) -> tuple[Layer, ...]:
    """The layers with those of these strokes, one mark after the other, that are kept."""
    left = iter([chosen(paths, some) for paths, some in zip(parts, kept, strict=True)])
    return tuple(
        replace(layer, marks=tuple(next(left) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


def _dots(paths: Paths, length: Floats) -> Bools:
    """(m,) which strokes are dots of stipplings."""
    return np.asarray((paths.kind == int(LineKind.HATCH)) & (np.abs(length - DOT_MM) < COINCIDENT_MM))


def _ends(paths: Paths) -> Floats:
    """(m,2,2) the first and the last point of every stroke; zero of those without points."""
    ends = np.zeros((len(paths), 2, 2))
    filled = np.diff(paths.offsets) > 0
    ends[filled, 0] = paths.points[paths.offsets[:-1][filled]]
    ends[filled, 1] = paths.points[paths.offsets[1:][filled] - 1]
    return ends


def _alone(ends: Floats, others: Floats, length: Floats) -> Bools:
    """(s,) which short strokes, by their ends (s,2,2), are specks: they meet no end of others (r,2,2), not even through
    each other, and what hangs together is no longer than one."""
    # Of the others few are near in x.
    x = np.sort(ends[..., 0].ravel())
    far = others[..., 0].ravel()
    near = np.searchsorted(x, far - COINCIDENT_MM) < np.searchsorted(x, far + COINCIDENT_MM, side="right")
    spots = np.concatenate([ends.reshape(-1, 2), others.reshape(-1, 2)[near]])
    x, y = (axis - axis.min() for axis in spots.T)
    place = clusters(x, y, np.zeros(len(spots), dtype=np.intp), COINCIDENT_MM)
    of_ends = place[: 2 * len(ends)].reshape(-1, 2)
    longer = of_ends[:, 0] != of_ends[:, 1]
    whole = connected(len(spots), of_ends[longer].max(axis=1), of_ends[longer].min(axis=1))[place]
    total = np.bincount(whole[: 2 * len(ends) : 2], length, len(spots))
    total[whole[2 * len(ends) :]] = np.inf
    return np.asarray(total[whole[: 2 * len(ends) : 2]] < LONE_STROKE_MM)
