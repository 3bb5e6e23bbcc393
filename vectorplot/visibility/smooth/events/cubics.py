"""Chords of curves replaced by cubic arcs: close to the curves, and cheap to search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

STEEPEST = 3.0
"""A slope longer than so many chords is none of a curve near its chord."""


@dataclass(frozen=True, eq=False)
class Cubics:
    """The cubic arcs with the ends and the directions (k,3) of some chords: in the image, and in depth."""

    start: Floats
    end: Floats
    leaving: Floats
    arriving: Floats

    def at(self, index: Ints, part: Floats) -> tuple[Floats, Floats]:
        """(k,3) images and depths of arcs, and their derivatives.

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        t = part[:, None]
        p, q, a, b = self.start[index], self.end[index], self.leaving[index], self.arriving[index]
        way = q - p
        two, three = 3.0 * way - 2.0 * a - b, a + b - 2.0 * way
        return p + t * (a + t * (two + t * three)), a + t * (2.0 * two + 3.0 * t * three)


def cubics(view: View, curves: Curves, chord: Ints) -> Cubics:
    """The cubic arcs of chords, given by the points at which they begin."""
    zero = np.zeros(len(chord))
    ends = [curves.points[chord], curves.points[chord + 1]]
    images = [np.column_stack([projection.image(view, x), projection.depth(view, x)]) for x in ends]
    way = images[1] - images[0]
    slopes = []
    for points, part in zip(ends, (zero, zero + 1.0), strict=True):
        along = curves.at(chord, part).slopes
        slope = np.column_stack([projection.image_slopes(view, points, along), -along[:, 2]])
        with np.errstate(invalid="ignore"):
            good = (np.abs(slope) <= STEEPEST * np.abs(way).max(axis=1, keepdims=True)).all(axis=1)
        slopes.append(np.where(good[:, None], slope, way))
    return Cubics(images[0], images[1], slopes[0], slopes[1])
