"""How far points of the plane are from lines."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import shapely


def distances(points: np.ndarray, lines: Iterable[np.ndarray]) -> np.ndarray:
    """(n,) distances of points (n,2) from the nearest of polylines (k,2), however long these are."""
    sides = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in map(np.asarray, lines)])
    tree = shapely.STRtree(shapely.linestrings(sides))
    return tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)[1]
