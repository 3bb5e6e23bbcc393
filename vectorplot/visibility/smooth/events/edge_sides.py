"""To which side of its edges a sheet lies in the image."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.words import LineKind


def covered_sides(
    view: View, sheets: Sheets, number: Ints, kind: Ints, points: Floats, places: Floats, slopes: Floats
) -> Ints:
    """(k,) 1 where the image of a sheet lies to the left of its edge, -1 where to the right, 0 where neither is told.

    number (k,): of the sheet; kind (k,): CONTOUR for a fold, which the sheet bends away from to the side of its normal
    or against it; BOUNDARY for a border, which it lies inside of; CREASE for a cuspidal edge, from which both wings go
    the same way; points, places, slopes (k,3) on the edge and along it.
    """
    covered = np.zeros_like(points)
    way = sight_lines.sight(view, points)
    at = np.flatnonzero(kind == LineKind.CONTOUR)
    bends, normals = sheets.bends(number[at], places[at], way[at]), sheets.normals(number[at], places[at])
    covered[at] = np.sign(bends)[:, None] * normals
    at = np.flatnonzero(kind == LineKind.BOUNDARY)
    covered[at] = sheets.inwards(number[at], places[at])
    at = np.flatnonzero(kind == LineKind.CREASE)
    covered[at] = sheets.turnings(number[at], places[at])
    return _sides(view, points, slopes, covered)


def sides_of_rims(
    view: View, sheets: Sheets, number: tuple[Ints, Ints], points: Floats, places: tuple[Floats, Floats], slopes: Floats
) -> Ints:
    """(k,) 1 where the images of both sheets that meet at a sharp edge lie to the left of it, -1 where to the right.

    number (k,) and places (k,3) of the one sheet and of the other; points and slopes (k,3) on the edge and along it,
    where it is an outline: seen edge-on, a sheet tells nothing, but the other one does.
    """
    inwards = [sheets.inwards(*of) for of in zip(number, places, strict=True)]
    one, two = (way / np.linalg.norm(way, axis=1, keepdims=True).clip(LEAST_DIVISOR) for way in inwards)
    return _sides(view, points, slopes, one + two)


def _sides(view: View, points: Floats, slopes: Floats, covered: Floats) -> Ints:
    """(k,) the sides of edges to which directions (k,3) lead."""
    side = turn(sight_lines.image_slopes(view, points, slopes), sight_lines.image_slopes(view, points, covered))
    return np.where(np.isfinite(side), np.sign(side), 0.0).astype(np.intp)


def turn(a: Floats, b: Floats) -> Floats:
    """(k,) the areas that vectors a and b (k,2) span, positive for a turn to the left."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
