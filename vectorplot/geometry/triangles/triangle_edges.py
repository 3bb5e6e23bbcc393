"""The edges that triangles share."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints


def edges_of(triangles: Ints, count: int) -> tuple[Ints, Ints, Ints]:
    """The edges (e,2) of triangles (t,3) of points 0 to count; (t,3) the edge from every corner to the next; (e,) how
    many triangles an edge has."""
    after = np.roll(triangles, -1, axis=1)
    key = np.minimum(triangles, after) * count + np.maximum(triangles, after)
    keys, sides, uses = np.unique(key.ravel(), return_inverse=True, return_counts=True)
    return np.stack(np.divmod(keys, max(count, 1)), axis=1), sides.reshape(-1, 3), uses
