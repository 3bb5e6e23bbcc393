"""Places along curves on a mesh, and which of them are reached from where each curve began."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.meshes.mesh_curves import MeshCurves
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import workers

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

FIRST_LOOK = 8
"""So many places to either side of where a curve began are looked at first, twice as many each time they are free."""


@dataclass(frozen=True, eq=False)
class PlacedCurves:
    """Curves, and the places (p,) along them at which they are compared: curve (p,); along (p,), lengths from the start
    of the curve; node (p,); where (p,6). seed (m,): the place nearest to where each curve began; long (m,): how long it
    is."""

    curves: MeshCurves
    curve: Ints
    along: Floats
    node: Floats
    where: Floats
    seed: Ints
    long: Floats


def beside(tree: cKDTree, where: Floats, reach: float) -> Bools:
    """(k,) which places (k,6) are within reach of what a tree has."""
    away = tree.query(where, distance_upper_bound=reach, workers=workers(len(where)))[0]
    return np.asarray(np.isfinite(away))


def reached(found: PlacedCurves, free: Bools) -> tuple[Ints, Ints]:
    """The first and the last (m,) of the places of each curve that are reached from its seed over free ones only: of a
    closed curve, which begins at its seed, up to the end, and from the end on; none where the seed is not free."""
    count = len(found.seed)
    bounds = np.searchsorted(found.curve, np.arange(count + 1))
    taken = np.concatenate([[-1], np.flatnonzero(~free), [len(free)]])
    after = np.searchsorted(taken, found.seed, side="left")
    last = np.minimum(taken[after] - 1, bounds[1:] - 1)
    first = np.maximum(taken[after - 1] + 1, bounds[:-1])
    return first, np.where(free[found.seed], last, first - 1)


def free_around(found: PlacedCurves, tree: cKDTree | None, reach: float) -> Bools:
    """(p,) the places of each curve that are reached from its seed over such as are not within reach of what a tree
    has; only these, and a few more, are looked for there."""
    count = len(found.curve)
    if tree is None or not count:
        return np.ones(count, dtype=np.bool_)
    free = np.zeros(count, dtype=np.bool_)
    free[found.seed] = ~beside(tree, found.where[found.seed], reach)
    bounds = np.searchsorted(found.curve, np.arange(len(found.seed) + 1))
    for way in (-1, 1):
        left, look = np.flatnonzero(free[found.seed]), FIRST_LOOK
        place = found.seed[left]
        while len(left):
            room = place - bounds[left] if way < 0 else bounds[left + 1] - 1 - place
            sizes = np.minimum(room, look)
            at = np.repeat(place, sizes) + way * (1 + ragged.place(sizes))
            free[at] = ~beside(tree, found.where[at], reach)
            shut = np.bincount(ragged.owner(sizes)[~free[at]], minlength=len(left)) > 0
            onward = ~shut & (room > look)
            left, place = left[onward], place[onward] + way * look
            look *= 2
    first, last = reached(found, free)
    result = np.zeros(count, dtype=np.bool_)
    result[ragged.ranges(first, np.maximum(last - first + 1, 0))] = True
    return result


def some_places(found: PlacedCurves, free: Bools) -> tuple[PlacedCurves, Ints]:
    """The curves with those of their places alone that are free, and their seeds; and which (k,) they are."""
    chosen = free.copy()
    chosen[found.seed] = True
    at = np.flatnonzero(chosen)
    seed = np.searchsorted(at, found.seed)
    picked = replace(
        found, curve=found.curve[at], along=found.along[at], node=found.node[at], where=found.where[at], seed=seed
    )
    return picked, at
