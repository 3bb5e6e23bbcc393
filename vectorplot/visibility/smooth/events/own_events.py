"""Where a curve passes the contour of a sheet that it lies on, and the cusps of contours."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import EDGE_ON_SINE
from vectorplot.visibility.smooth.events.events import Events, all_events
from vectorplot.visibility.smooth.events.roots import roots_along
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.sheets.family import Along
from vectorplot.visibility.smooth.sheets.sheet import Sheet
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind


def edge_on_curves(view: View, sheets: tuple[Sheet, ...], curves: Curves) -> Bools:
    """(m,) the curves that lie on the contour of their own sheet all along.

    Contours do, whatever rounding makes of normals close to singular points.
    """
    contour = (curves.kind == LineKind.CONTOUR) & (curves.sheet >= 0)
    return np.asarray(contour | ~np.isin(np.arange(len(curves)), curves.owner[~_is_edge_on(view, sheets, curves)]))


def _is_edge_on(view: View, sheets: tuple[Sheet, ...], curves: Curves) -> Bools:
    """(n,) the points at which the sheet is seen edge-on."""
    facing = np.full(len(curves.points), np.inf)
    own = curves.sheet[curves.owner]
    for number in np.unique(own[own >= 0]).tolist():
        at = np.flatnonzero(own == number)
        facing[at] = _facing(view, sheets[number], curves.points[at], curves.places[at])
    return np.asarray(~(np.abs(facing) > EDGE_ON_SINE))


def _facing(view: View, sheet: Sheet, points: Floats, places: Floats) -> Floats:
    """(k,) cosines of the angles between normals and sight lines."""
    way = projection.sight(view, points)
    return np.asarray(dot(sheet.normals(places), way) / np.linalg.norm(way, axis=1))


def own_events(view: View, sheets: tuple[Sheet, ...], curves: Curves, edge_on: Bools) -> Events:
    """The events where curves pass the contours of their own sheets, and cusps of curves that are contours.

    edge_on (m,): as edge_on_curves tells.
    """
    parts = []
    for number, sheet in enumerate(sheets):
        if not sheet.hides:
            continue
        first = (curves.sheet == number) & ~edge_on
        numbers = np.flatnonzero(first)
        parts.append(_passings(view, sheet, curves.some(numbers), numbers, curves, _first_places))
        contours = (curves.sheet == number) & edge_on
        parts.append(_cusps(view, sheet, curves.some(np.flatnonzero(contours)), np.flatnonzero(contours), curves))
        second = curves.second_sheet == number
        numbers = np.flatnonzero(second)
        parts.append(_passings(view, sheet, curves.some(numbers), numbers, curves, _second_places))
    return all_events(parts)


def _first_places(of: Curves | Along) -> Floats:
    return of.places


def _second_places(of: Curves | Along) -> Floats:
    return of.second_places


def _passings(
    view: View,
    sheet: Sheet,
    own: Curves,
    numbers: Ints,
    curves: Curves,
    places: Callable[[Curves | Along], Floats],
) -> Events:
    """Where a curve goes over from a part of a sheet that it sees to one that the sheet itself hides, or back.

    places: of curves on that sheet.
    """

    def facing(_: Ints, at: Along) -> Floats:
        return _facing(view, sheet, at.points, places(at))

    roots = roots_along(own, facing, _facing(view, sheet, own.points, places(own)))
    at = own.at(roots.chord, roots.part)
    chord = _chords(own, numbers, curves, roots.chord)
    return _passed(view, sheet, at.points, places(at), roots.falls, chord, roots.part)


def _chords(own: Curves, numbers: Ints, curves: Curves, chord: Ints) -> Ints:
    """Chords of some of the curves as chords of all of them."""
    owner = own.owner[chord]
    return np.asarray(chord - own.offsets[owner] + curves.offsets[numbers[owner]])


def _passed(
    view: View, sheet: Sheet, points: Floats, places: Floats, falls: Bools, chord: Ints, part: Floats
) -> Events:
    """Near the contour the sight line meets the sheet once more, at twice facing by bend: in front of the curve where
    that is positive; unless the sheet ends there."""
    way = projection.sight(view, points)
    bend = sheet.bends(places, way)
    change = np.where(falls, -1, 1) * np.sign(bend).astype(np.intp)
    change[dot(sheet.inwards(places), way) < 0.0] = 0
    return Events(chord, part, np.full(len(chord), sheet.item), change)


def _cusps(view: View, sheet: Sheet, own: Curves, numbers: Ints, curves: Curves) -> Events:
    """Where the sight line is an asymptotic direction: the image of the contour has a cusp, its visibility ends."""

    def bending(_: Ints, at: Along) -> Floats:
        return sheet.bends(at.places, projection.sight(view, at.points))

    values = sheet.bends(own.places, projection.sight(view, own.points))
    roots = roots_along(own, bending, values)
    at = own.at(roots.chord, roots.part)
    leaving = dot(at.slopes, projection.sight(view, at.points)) > 0.0
    change = np.where(leaving, -1, 1)
    chord = _chords(own, numbers, curves, roots.chord)
    return Events(chord, roots.part, np.full(len(chord), sheet.item), change)
