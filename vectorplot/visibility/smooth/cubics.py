"""Chords of curves replaced by cubic arcs: close to the curves, and cheap to search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth import projection
from vectorplot.visibility.smooth.curves import Curves

STEEPEST = 3.0
"""A slope longer than so many chords is none of a curve near its chord."""


@dataclass(frozen=True, eq=False)
class Cubics:
    """The cubic arcs (k,2) in the image with the ends and the directions of some chords, and their depths between."""

    start: Floats
    end: Floats
    leaving: Floats
    arriving: Floats
    depths: Floats

    def at(self, index: Ints, part: Floats) -> tuple[Floats, Floats]:
        """(k,2) points of arcs, and their derivatives.

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        t = part[:, None]
        p, q, a, b = self.start[index], self.end[index], self.leaving[index], self.arriving[index]
        way = q - p
        two, three = 3.0 * way - 2.0 * a - b, a + b - 2.0 * way
        return p + t * (a + t * (two + t * three)), a + t * (2.0 * two + 3.0 * t * three)

    def depth(self, index: Ints, part: Floats) -> Floats:
        """(k,) depths, linear along the chord."""
        near, far = self.depths[index, 0], self.depths[index, 1]
        return np.asarray(near + part * (far - near))


def cubics(view: View, curves: Curves, chord: Ints) -> Cubics:
    """The cubic arcs of chords, given by the points at which they begin."""
    zero = np.zeros(len(chord))
    ends = [curves.points[chord], curves.points[chord + 1]]
    images = [projection.image(view, points) for points in ends]
    way = images[1] - images[0]
    slopes = []
    for points, part in zip(ends, (zero, zero + 1.0), strict=True):
        slope = projection.image_slopes(view, points, curves.at(chord, part).slopes)
        with np.errstate(invalid="ignore"):
            good = (np.abs(slope) <= STEEPEST * np.abs(way).max(axis=1, keepdims=True)).all(axis=1)
        slopes.append(np.where(good[:, None], slope, way))
    depths = np.stack([projection.depth(view, points) for points in ends], axis=1)
    return Cubics(images[0], images[1], slopes[0], slopes[1], depths)
