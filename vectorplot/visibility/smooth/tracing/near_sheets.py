"""Which of many sheets come near each other, judged by the points of their tessellations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.bounds.slab_hulls import SlabHulls
from vectorplot.geometry.components import all_finite

SLACK = 0.01
"""Part of its size that a tessellation may lie inside of its sheet."""


def near_sheets(points: Sequence[Floats]) -> list[tuple[int, int]]:
    """The pairs of sheets, each once and in order, that their hulls do not separate; points (k,3): of the tessellation
    of each, NaN in holes.

    Degenerate: a sheet without points is near none.
    """
    finite = [own[all_finite(own)] for own in points]
    known = np.flatnonzero([len(own) > 0 for own in finite])
    if not len(known):
        return []
    hulls = SlabHulls.of(np.concatenate(finite), np.array([len(finite[k]) for k in known.tolist()]))
    hulls = hulls.widened(SLACK * (hulls.high - hulls.low)[:3].max(axis=0))
    one, two = hulls.near(hulls)
    one, two = known[one[one < two]], known[two[one < two]]
    order = np.lexsort((two, one))
    return list(zip(one[order].tolist(), two[order].tolist(), strict=True))
