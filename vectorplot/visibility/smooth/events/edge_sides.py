"""To which side of its edges a sheet lies in the image."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.sheets.sheet import Sheet
from vectorplot.words import LineKind


def covered_sides(
    view: View, sheets: tuple[Sheet, ...], number: Ints, kind: Ints, points: Floats, places: Floats, slopes: Floats
) -> Ints:
    """(k,) 1 where the image of a sheet lies to the left of its edge, -1 where to the right, 0 where neither is told.

    number (k,): of the sheet; kind (k,): CONTOUR for a fold, which the sheet bends away from to the side of its normal
    or against it; BOUNDARY for a border, which it lies inside of; CREASE for a cuspidal edge, from which both wings go
    the same way; points, places, slopes (k,3) on the edge and along it.
    """
    covered = np.zeros_like(points)
    way = projection.sight(view, points)
    for one in np.unique(number).tolist():
        sheet, own = sheets[one], number == one
        fold = np.flatnonzero(own & (kind == LineKind.CONTOUR))
        covered[fold] = np.sign(sheet.bends(places[fold], way[fold]))[:, None] * sheet.normals(places[fold])
        border = np.flatnonzero(own & (kind == LineKind.BOUNDARY))
        covered[border] = sheet.inwards(places[border])
        cuspidal = np.flatnonzero(own & (kind == LineKind.CREASE))
        covered[cuspidal] = sheet.turnings(places[cuspidal])
    side = turn(projection.image_slopes(view, points, slopes), projection.image_slopes(view, points, covered))
    return np.where(np.isfinite(side), np.sign(side), 0.0).astype(np.intp)


def turn(a: Floats, b: Floats) -> Floats:
    """(k,) the areas that vectors a and b (k,2) span, positive for a turn to the left."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
