"""Strokes that are known as Bézier curves, as fewer of them within a tolerance."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.bezier.fit import fitted_paths
from vectorplot.curves.bezier.paths import BezierPaths
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import some

FIT_OF_KNOWN = 0.9
"""The part of the tolerance for the fit, where the curve is known: chords take hardly any of it."""

SAG_OF_KNOWN = 0.03
"""The part of the tolerance that the samples which the fit goes by are apart from the curve in their middles."""

CORNER_ANGLE = np.radians(1.0)
"""Known directions that differ by more at one point are those of a corner."""

MOST_SAMPLES = 1024
"""Of one curve, at most: one that would need more is drawn far beyond any page, and stays."""


def fewer_cubics(paths: BezierPaths, tolerance: float) -> BezierPaths:
    """The paths, those that fewer curves serve within the tolerance as these, with their error.

    They are sampled, with their true tangents, so closely that chords are nowhere farther off than a part of the
    tolerance, and the fit goes by the samples: it begins and ends in points of the paths, in their directions.
    Source: Farin, Curves and Surfaces for CAGD, section 6.9: a chord is off its curve by no more than an eighth of
    the second derivative.
    """
    count, samples = np.diff(paths.offsets), _samples_needed(paths, SAG_OF_KNOWN * tolerance)
    too_large = np.bincount(ragged.owner(count)[samples > MOST_SAMPLES], minlength=len(count)) > 0
    which = np.flatnonzero((count > 1) & ~too_large)
    if not len(which):
        return paths
    many = some(paths, which)
    points, offsets, tangents = _samples(many, SAG_OF_KNOWN * tolerance)
    found = fitted_paths(
        points,
        offsets,
        many.closed,
        tangents,
        tolerance=FIT_OF_KNOWN * tolerance,
        corner_angle=CORNER_ANGLE,
        sag=SAG_OF_KNOWN * tolerance,
    )
    better = (np.diff(found.offsets) < count[which]) & (found.error <= FIT_OF_KNOWN * tolerance)
    return _put(paths, which[better], some(found, np.flatnonzero(better)))


def _put(paths: BezierPaths, which: Ints, others: BezierPaths) -> BezierPaths:
    """The paths with others in the places of some of them."""
    count, error = np.diff(paths.offsets), paths.error.copy()
    kept = np.ones(len(count), dtype=np.bool_)
    kept[which] = False
    own = ragged.owner(count)
    control = np.concatenate([paths.control[kept[own]], others.control])
    owner = np.concatenate([own[kept[own]], which[ragged.owner(np.diff(others.offsets))]])
    count[which], error[which] = np.diff(others.offsets), others.error
    order = np.argsort(owner, kind="stable")
    return BezierPaths(control[order], ragged.offsets(count), paths.closed, error)


def _samples(paths: BezierPaths, sag: float) -> tuple[Floats, Ints, Floats]:
    """Points (p,2) on paths, their offsets (m+1,), and the tangents (p,2,2) with which the paths arrive and leave."""
    control, pieces = paths.control, np.diff(paths.offsets)
    count = _samples_needed(paths, sag).astype(np.intp)
    own, part = ragged.owner(count), ragged.place(count) / count[ragged.owner(count)]
    points, leaving = _at(control[own], part)
    first = ragged.starts(count)
    arriving = leaving.copy()
    before = ragged.preceding(paths.offsets)
    arriving[first] = _at(control[before], np.ones(len(before)))[1]
    # An open path begins with nothing behind, and ends in a point of its own.
    line = ragged.owner(pieces)
    begins, ends = paths.offsets[:-1][~paths.closed], paths.offsets[1:][~paths.closed] - 1
    arriving[first[begins]] = leaving[first[begins]]
    last, last_way = _at(control[ends], np.ones(len(ends)))
    rank = np.concatenate([np.arange(len(own)), first[ends] + count[ends] - 0.5])
    owner = np.concatenate([line[own], line[ends]])
    order = np.argsort(rank, kind="stable")
    ways = np.stack([np.concatenate([arriving, last_way]), np.concatenate([leaving, last_way])], axis=1)[order]
    # Where a curve stands still nothing is known of its direction.
    ways[(ways == 0.0).all(axis=2)] = np.nan
    sizes = np.bincount(owner, minlength=len(pieces))
    return np.concatenate([points, last])[order], ragged.offsets(sizes), ways


def _samples_needed(paths: BezierPaths, sag: float) -> Floats:
    """(s,) into how many parts of equal parameters each curve has to go for chords to be no farther off."""
    control = paths.control
    bend = np.linalg.norm(control[:, 2:] - 2.0 * control[:, 1:-1] + control[:, :-2], axis=2).max(axis=1, initial=0.0)
    return np.asarray(np.maximum(np.ceil(np.sqrt(0.75 * bend / sag)), 1.0))


def _at(control: Floats, part: Floats) -> tuple[Floats, Floats]:
    """(k,2) points of curves (k,4,2) at parameters (k,), and their derivatives."""
    t = part[:, None]
    two = [control[:, k] + t * (control[:, k + 1] - control[:, k]) for k in range(3)]
    one = [two[k] + t * (two[k + 1] - two[k]) for k in range(2)]
    return one[0] + t * (one[1] - one[0]), 3.0 * (one[1] - one[0])
