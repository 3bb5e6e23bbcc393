"""The pieces of a curve on a triangle mesh, between points on its edges: where values at the vertices change sign."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.components import any_component


@dataclass(frozen=True, eq=False)
class LevelSegments:
    """low, high (k,): the vertices of the edges that are crossed; pairs (s,2): segments between these crossings, values
    positive on the left seen from outside; triangle (s,): the one each segment lies in. Of curve j the n vertices are
    numbered from j n on."""

    low: Ints
    high: Ints
    pairs: Ints
    triangle: Ints


def level_segments(triangles: Ints, values: Floats) -> LevelSegments:
    """The segments in triangles (t,3) of vertex indices whose corners have values (n,) of different signs; of several
    curves, with values (c,n), those of one after those of the other.

    An edge is one for all its triangles, and so is the crossing on it. Zero counts as positive: a curve through a
    vertex or along an edge is met once, in one triangle of those around it.
    Degenerate: triangles with a value that is not a number have none.
    """
    negative = (values[..., triangles] < 0.0).reshape(-1, 3)
    count = negative.sum(axis=1)
    row = np.flatnonzero((count % 3 != 0) & ~any_component(np.isnan(values)[..., triangles]).ravel())
    alone = count[row] == 1
    lone = np.where(alone, negative[row].argmax(axis=1), (~negative[row]).argmax(axis=1))
    curve, triangle = np.divmod(row, len(triangles))
    begin = curve * values.shape[-1]
    corner, after, before = (begin + triangles[triangle, (lone + k) % 3] for k in range(3))
    a, b = np.concatenate([corner, corner]), np.concatenate([after, before])
    low, high = np.minimum(a, b), np.maximum(a, b)
    _, first, side = np.unique(low * values.size + high, return_index=True, return_inverse=True)
    out, back = side[: len(row)], side[len(row) :]
    # From the side before the lone corner to the side after it: that corner is then on the right.
    pairs = np.stack([np.where(alone, back, out), np.where(alone, out, back)], axis=1)
    return LevelSegments(low[first], high[first], pairs, triangle)


@dataclass(frozen=True, eq=False)
class Split:
    """Triangles cut finer: triangles (t,3), parent (t,) the triangle each is a part of; low, high (k,): the ends of the
    edges whose middles are new vertices, numbered on from the old ones."""

    triangles: Ints
    parent: Ints
    low: Ints
    high: Ints


def split_at_middles(triangles: Ints, chosen: Bools, count: int) -> Split:
    """The triangles (t,3) of count vertices with all the edges of the chosen ones halved.

    A triangle gets a new vertex in the middle of each of its edges that is halved, whichever triangle wanted that:
    no gaps open. The new triangles are wound as the old ones.
    """
    a, b = triangles, np.roll(triangles, -1, axis=1)
    key = np.minimum(a, b) * count + np.maximum(a, b)
    halved = np.unique(key[chosen])
    place = np.minimum(np.searchsorted(halved, key), max(len(halved) - 1, 0))
    cut = (halved[place] == key) if len(halved) else np.zeros(key.shape, dtype=np.bool_)
    middle = count + place
    number = cut.sum(axis=1)
    parts, parents = [triangles[number == 0]], [np.flatnonzero(number == 0)]
    for cuts, start_side, pieces in (
        (1, cut.argmax(axis=1), [(0, 3, 2), (3, 1, 2)]),
        (2, (~cut).argmax(axis=1), [(0, 1, 4), (0, 4, 5), (4, 2, 5)]),
        (3, np.zeros(len(triangles), dtype=np.intp), [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]),
    ):
        row = np.flatnonzero(number == cuts)
        turn = (start_side[row][:, None] + np.arange(3)) % 3
        six = np.concatenate([triangles[row[:, None], turn], middle[row[:, None], turn]], axis=1)
        parts += [six[:, piece] for piece in pieces]
        parents += [row] * len(pieces)
    return Split(np.concatenate(parts), np.concatenate(parents), halved // count, halved % count)
