"""Triangles divided by new vertices on their sides, so that neighbours share all of them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints


def divided(triangles: Ints, middle: Ints, points: Floats) -> tuple[Ints, Ints]:
    """Triangles (t,3) of points (n,d) divided by points middle (t,3) on their sides, -1 for none on the side from a
    corner on; and (m,) the triangle that each is a part of. They turn as before.

    Of a triangle with two such points the shorter diagonal of what is left beside its corner is taken.
    """
    count = (middle >= 0).sum(axis=1)
    rows = [np.flatnonzero(count == k) for k in range(4)]
    parts = [triangles[rows[0]]]
    # Turned round so that the first side is split and, of two, the last one is not.
    first = np.select(
        [(count == 1) | (count == 3), (count == 2)],
        [np.argmax(middle >= 0, axis=1), (np.argmin(middle >= 0, axis=1) + 1) % 3],
    )
    turn = (first[:, None] + np.arange(3)) % 3
    corner, middle = np.take_along_axis(triangles, turn, axis=1), np.take_along_axis(middle, turn, axis=1)
    (a, b, c), (d, _, _) = corner[rows[1]].T, middle[rows[1]].T
    parts += [np.stack((a, d, c), axis=1), np.stack((d, b, c), axis=1)]
    (a, b, c), (d, e, _) = corner[rows[2]].T, middle[rows[2]].T
    parts.append(np.stack((d, b, e), axis=1))
    quad = np.stack((a, d, e, c))
    with np.errstate(invalid="ignore"):
        p = points[quad]
        other = np.linalg.norm(p[1] - p[3], axis=-1) < np.linalg.norm(p[0] - p[2], axis=-1)
    parts += [np.where(other, (a, d, c), (a, d, e)).T, np.where(other, (d, e, c), (e, c, a)).T]
    (a, b, c), (d, e, f) = corner[rows[3]].T, middle[rows[3]].T
    parts += [np.stack(some, axis=1) for some in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))]
    return np.concatenate(parts), np.concatenate([np.tile(row, max(k + 1, 1)) for k, row in enumerate(rows)])
