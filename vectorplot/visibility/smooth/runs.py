"""Runs of equally hidden pieces; those too short to be drawn go to their neighbours."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.hidden_pieces import Pieces, lengths_in_image
from vectorplot.visibility.smooth.tracing.traced_curves import Curves


def without_short_runs(view: View, curves: Curves, pieces: Pieces, hidden_by: Ints, shortest: float) -> Ints:
    """(p,) the same numbers; runs shorter than this in the image have that of the nearest longer one on their curve.

    Degenerate: a curve that has only short runs stays as it is.
    """
    if not len(pieces):
        return hidden_by
    new = np.ones(len(pieces), dtype=np.bool_)
    new[1:] = (pieces.curve[1:] != pieces.curve[:-1]) | (hidden_by[1:] != hidden_by[:-1])
    run = np.cumsum(new) - 1
    curve, value = pieces.curve[new], hidden_by[new]
    length = np.bincount(run, weights=lengths_in_image(view, curves, pieces))
    first, last = np.searchsorted(curve, curve), np.searchsorted(curve, curve, side="right") - 1
    # The first and the last run of a closed curve are one if they are equal.
    number = np.arange(len(curve))
    round_ = curves.closed[curve] & (value[first] == value[last]) & (first != last)
    around = length[first] + length[last]
    length = np.where(round_ & ((number == first) | (number == last)), around, length)
    long = length >= shortest
    before = np.maximum.accumulate(np.where(long, number, -1))
    after = np.minimum.accumulate(np.where(long, number, len(curve))[::-1])[::-1]
    has_before = (before >= first) & (before >= 0)
    has_after = after <= last
    nearer = has_before & (~has_after | (number - before <= after - number))
    source = np.where(nearer, before, np.where(has_after, after, number))
    return np.asarray(value[source][run])
