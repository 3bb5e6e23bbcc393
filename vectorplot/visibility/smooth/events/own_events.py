"""Where a curve passes the contour of a sheet that it lies on, and the cusps of contours."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import EDGE_ON_SINE
from vectorplot.visibility.smooth.events.events import Events, all_events
from vectorplot.visibility.smooth.events.roots import roots_along
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.family import Along
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind


def facing_of(view: View, sheets: Sheets, curves: Curves) -> Floats:
    """(n,) cosines of the angles between sight lines and the normals of their sheets at the points of curves; infinite
    on no sheet."""
    facing = np.full(len(curves.points), np.inf)
    number = curves.sheet[curves.owner]
    at = np.flatnonzero(number >= 0)
    facing[at] = _facing(view, sheets, number[at], curves.points.take(at, axis=0), curves.places.take(at, axis=0))
    return facing


def edge_on_curves(curves: Curves, facing: Floats) -> Bools:
    """(m,) the curves that lie on the contour of their own sheet all along; facing (n,): as `facing_of` gives it.

    Contours do, whatever rounding makes of normals close to singular points; but not the outlines along the sharp edges
    of bodies, at which two sheets meet and neither of them need turn away.
    """
    contour = (curves.kind == LineKind.CONTOUR) & (curves.sheet >= 0) & (curves.second_sheet < 0)
    straight = np.ones(len(curves), dtype=np.bool_)
    straight[curves.owner[np.abs(facing) > EDGE_ON_SINE]] = False
    return np.asarray(contour | straight)


def _facing(view: View, sheets: Sheets, number: Ints, points: Floats, places: Floats) -> Floats:
    """(k,) cosines of the angles between normals and sight lines."""
    way = sight_lines.sight(view, points)
    return np.asarray(dot(sheets.normals(number, places), way) / norm(way))


def own_events(view: View, sheets: Sheets, curves: Curves, facing: Floats, edge_on: Bools) -> Events:
    """The events where curves pass the contours of their own sheets, and cusps of curves that are contours.

    facing (n,): as `facing_of` gives it; edge_on (m,): as `edge_on_curves` tells.
    """
    hides = np.append(sheets.hides, False)
    first, second = np.flatnonzero(hides[curves.sheet] & ~edge_on), np.flatnonzero(hides[curves.second_sheet])
    folds = np.flatnonzero(hides[curves.sheet] & edge_on)
    on_first = facing[ragged.take(curves.offsets, first)[0]]
    on_second = _facing_on_second(view, sheets, curves.some(second))
    return all_events(
        [
            _passings(view, sheets, curves, first, curves.sheet, on_first, _first_places),
            _cusps(view, sheets, curves, folds),
            _passings(view, sheets, curves, second, curves.second_sheet, on_second, _second_places),
        ]
    )


def _facing_on_second(view: View, sheets: Sheets, curves: Curves) -> Floats:
    """(n,) as `facing_of`, on the second sheets that all of the curves have."""
    return _facing(view, sheets, curves.second_sheet[curves.owner], curves.points, curves.second_places)


def _first_places(of: Along) -> Floats:
    return of.places


def _second_places(of: Along) -> Floats:
    return of.second_places


def _passings(
    view: View,
    sheets: Sheets,
    curves: Curves,
    numbers: Ints,
    sheet: Ints,
    values: Floats,
    places: Callable[[Along], Floats],
) -> Events:
    """Where some of the curves, by their numbers, go over from a part of a sheet that they see to one that the sheet
    itself hides, or back.

    sheet (m,): the sheets of all curves, and places of curves on them; values: how their points face the eye.
    """
    own = curves.some(numbers)

    def facing(curve: Ints, at: Along) -> Floats:
        return _facing(view, sheets, sheet[numbers[curve]], at.points, places(at))

    roots = roots_along(own, facing, values)
    at, passed = own.at(roots.chord, roots.part), sheet[numbers[own.owner[roots.chord]]]
    chord = _chords(own, numbers, curves, roots.chord)
    return _passed(view, sheets, passed, at.points, places(at), roots.falls, chord, roots.part)


def _chords(own: Curves, numbers: Ints, curves: Curves, chord: Ints) -> Ints:
    """Chords of some of the curves as chords of all of them."""
    owner = own.owner[chord]
    return np.asarray(chord - own.offsets[owner] + curves.offsets[numbers[owner]])


def _passed(
    view: View, sheets: Sheets, number: Ints, points: Floats, places: Floats, falls: Bools, chord: Ints, part: Floats
) -> Events:
    """Near the contour the sight line meets the sheet once more, at twice facing by bend: in front of the curve where
    that is positive; unless the sheet ends there."""
    way = sight_lines.sight(view, points)
    bend = sheets.bends(number, places, way)
    change = np.where(falls, -1, 1) * np.sign(bend).astype(np.intp)
    change[dot(sheets.inwards(number, places), way) < 0.0] = 0
    return Events(chord, part, sheets.item[number], change)


def _cusps(view: View, sheets: Sheets, curves: Curves, numbers: Ints) -> Events:
    """Where the sight line is an asymptotic direction: the image of the contour has a cusp, its visibility ends."""
    own = curves.some(numbers)

    def bending(curve: Ints, at: Along) -> Floats:
        return sheets.bends(own.sheet[curve], at.places, sight_lines.sight(view, at.points))

    values = sheets.bends(own.sheet[own.owner], own.places, sight_lines.sight(view, own.points))
    roots = roots_along(own, bending, values)
    at = own.at(roots.chord, roots.part)
    leaving = dot(at.slopes, sight_lines.sight(view, at.points)) > 0.0
    change = np.where(leaving, -1, 1)
    chord = _chords(own, numbers, curves, roots.chord)
    return Events(chord, roots.part, sheets.item[own.sheet[own.owner[roots.chord]]], change)
