"""Curves in space as items: sampled finely enough, and placed on the sheet on which they lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.breaks import breaks_of, degree_of, is_weighted, weights_of
from vectorplot.curves.curve import Curve
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between, with_standstills
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import SETTLED_ON_SHEET, ZERO_OF_EXTENT
from vectorplot.visibility.smooth.sheets.family import Along, Chords, inner_part
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

FIRST_CHORDS = 64

MOST_POINTS = 1 << 18
"""A curve that is not within tolerance with so many points is drawn with these."""

MOST_HALVINGS, UNEVEN = 24, 4.0
"""A chord is halved so often at most where a curve with weights is so many times faster or slower at one of its ends
than it runs on the whole."""

ROUNDS = 12


@dataclass(frozen=True, eq=False)
class SpaceCurve:
    """A curve in the view's coordinates; its places are (u, v, t): on the parametrised sheet that it lies on, if it
    does, and its own parameter."""

    view: View
    curve: Curve
    surface: SmoothSheet | None
    sheet: int
    second: int = -1

    @property
    def rational(self) -> bool:
        """Whether its pieces are quotients of polynomials."""
        return is_weighted(self.curve)

    def degrees(self, chords: Chords) -> Ints:
        """(k,) of which degree the polynomials are; 0 where it is none."""
        return np.full(len(chords.level), degree_of(self.curve), dtype=np.intp)

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) what the polynomials are divided by at a part (k,) of chords."""
        start, end = (places[:, 2] for places in chords.places)
        return weights_of(self.curve, np.clip(start + part * (end - start), self.curve.start, self.curve.end))

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curve at a part of its chords."""
        start, end = chords.places
        at = start + part[:, None] * (end - start)
        t = np.clip(at[:, 2], self.curve.start, self.curve.end)
        here = self.view.points_of(self.curve.points(t)).T
        slopes = matmul(self.curve.tangents(self._inside(chords, part, t)), (self.view.axes / self.view.scale).T)
        if self.surface is not None:
            at[:, :2] = _onto(self.surface, here, at)[0][:, :2]
        return Along(at, here, slopes * (end - start)[:, 2:])

    def _inside(self, chords: Chords, part: Floats, t: Floats) -> Floats:
        """(k,) parameters at which derivatives are those of the piece of the curve that the chord belongs to: at breaks
        they may jump."""
        if not len(breaks_of(self.curve)):
            return t
        start, end = (places[:, 2] for places in chords.places)
        return np.asarray(start + inner_part(part) * (end - start))


def space_curve(
    view: View,
    curve: Curve,
    item: int,
    sheets: tuple[SmoothSheet, ...],
    tracing: Tracing,
    kind: LineKind = LineKind.CURVE,
) -> Curves:
    """A curve in space as one polyline of some kind; where it is not finite it is interrupted.

    A curve that lies on a parametrised sheet, all of it, is one of its curves: the sheet does not hide it from near.
    """
    t = _sampled(view, curve, tracing)
    points = view.points_of(curve.points(t)).T
    places = np.stack([np.zeros_like(t), np.zeros_like(t), t], axis=1)
    good: Bools = np.asarray(np.isfinite(points).all(axis=1))
    number, surface = -1, None
    for other, sheet in enumerate(sheets):
        if isinstance(sheet, ParametricSheet) and good.all():
            found, off = _placed(sheet, points)
            if off <= ZERO_OF_EXTENT:
                number, surface = other, sheet
                places[:, :2] = found
                break
    start = good & ~np.concatenate([[False], good[:-1]])
    first, counts = np.flatnonzero(start), np.bincount(np.cumsum(start)[good] - 1, minlength=int(start.sum()))
    long = counts > 1
    kept = good & np.repeat(True, len(good))
    kept[first[~long]] = False
    many = int(long.sum())
    return Curves(
        points[kept],
        places[kept],
        np.full((int(kept.sum()), 3), np.nan),
        ragged.offsets(counts[long]),
        np.full(many, curve.closed and bool(good.all())),
        np.full(many, int(kind)),
        np.full(many, item, dtype=np.intp),
        np.zeros(many, dtype=np.intp),
        np.zeros(many),
        (SpaceCurve(view, curve, surface, number),),
    )


def _sampled(view: View, curve: Curve, tracing: Tracing) -> Floats:
    """(k,) parameters between which chords are within tolerance, those of cusps among them."""

    def image(t: Floats) -> Floats:
        points = view.points_of(curve.points(t[:, 0])).T
        return points if tracing.picture is None else tracing.picture(points)

    # A chord across a break would cut off a corner.
    t = np.union1d(np.linspace(curve.start, curve.end, FIRST_CHORDS + 1), breaks_of(curve))
    if is_weighted(curve):
        t = _run_evenly(curve, t)
    whole = Traces(t[:, None], np.arange(len(t)) == len(t) - 1)
    finer = refined(whole, straight_between, image, tracing.tolerance or np.inf, MOST_POINTS)
    return with_standstills(finer.lines, lambda t: curve.tangents(t[:, 0])).points[:, 0]


def _run_evenly(curve: Curve, t: Floats) -> Floats:
    """(k,) the parameters, and more, between which a curve runs about as far as its speed at both ends says: where
    weights change by thousands all that is to be seen may lie in a thousandth of the parameters."""
    for _ in range(MOST_HALVINGS):
        span = np.diff(t)
        both = t[:-1] + inner_part(np.array([[0.0], [1.0]])) * span
        said = np.linalg.norm(curve.tangents(both), axis=2) * span
        way = np.linalg.norm(np.diff(curve.points(t), axis=0), axis=1)
        uneven = np.flatnonzero((said.max(axis=0) > UNEVEN * way) | (UNEVEN * said.min(axis=0) < way))
        if not len(uneven) or len(t) > MOST_POINTS:
            break
        t = np.insert(t, uneven + 1, t[uneven] + 0.5 * span[uneven])
    return t


def _placed(sheet: ParametricSheet, points: Floats) -> tuple[Floats, float]:
    """(k,2) parameters of the nearest points of a sheet, running on over seams, and the largest distance from it."""
    from scipy.spatial import cKDTree

    finite = np.flatnonzero(np.isfinite(sheet.vertices).all(axis=1))
    if not len(finite):
        return np.zeros((len(points), 2)), np.inf
    distance, nearest = cKDTree(sheet.vertices[finite]).query(points)
    side = norm(np.ptp(sheet.vertices[finite], axis=0)) / 8.0
    if float(distance.max()) > side:
        return np.zeros((len(points), 2)), np.inf
    places, off = _onto(sheet, points, sheet.vertex_places[finite[nearest]])
    domain, found = sheet.surface.domain, places[:, :2].copy()
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        if closed:
            step = np.diff(found[:, axis], prepend=found[:1, axis])
            found[:, axis] += np.cumsum(-np.round(step / domain.size[axis])) * domain.size[axis]
    return found, float(off.max())


def _onto(sheet: SmoothSheet, points: Floats, places: Floats) -> tuple[Floats, Floats]:
    """Places (k,3) of the points of a sheet nearest to points, from places near them, and the distances (k,)."""
    away = points - sheet.points(places)
    for _ in range(ROUNDS):
        moved = sheet.moved(places, away)
        better = np.isfinite(moved).all(axis=1) & sheet.on_sheet(moved)
        places = np.where(better[:, None], moved, places)
        away = points - sheet.points(places)
        if not (dot(away, away) > (SETTLED_ON_SHEET) ** 2).any():
            break
    return places, np.asarray(np.sqrt(dot(away, away)))
