"""Chords of curves replaced by cubic arcs: close to the curves, and cheap to search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import records
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.tracing.traced_curves import Curves, at_once

STEEPEST = 3.0
"""A slope longer than so many chords is none of a curve near its chord."""


Ends = tuple[list[Floats], list[Floats]]
"""Points (k,3) at both ends of chords, and the slopes (k,3) of the curves there."""


@dataclass(frozen=True, eq=False)
class Cubics:
    """Cubic arcs (k,3) by powers of the part of the arc, the constant first: in space, or in the image and in depth."""

    constant: Floats
    linear: Floats
    quadratic: Floats
    cubic: Floats

    @classmethod
    def between(cls, start: Floats, end: Floats, leaving: Floats, arriving: Floats) -> Cubics:
        """Those with these ends and directions (k,3).

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        way = end - start
        return cls(start, leaving, 3.0 * way - 2.0 * leaving - arriving, leaving + arriving - 2.0 * way)

    def some(self, which: Ints) -> Cubics:
        """Some of the arcs."""
        return records.some(self, which)

    def at(self, part: Floats) -> tuple[Floats, Floats]:
        """(k,3) a point of each arc, and the derivatives there."""
        t = part[:, None]
        a, two, three = self.linear, self.quadratic, self.cubic
        return self.constant + t * (a + t * (two + t * three)), a + t * (2.0 * two + 3.0 * t * three)


def cubics(view: View, asked: Sequence[tuple[Curves, Ints]]) -> list[Cubics]:
    """The cubic arcs of chords of each of several curves, given by the points at which they begin, in the image and in
    depth."""
    return [_in_image(view, *ends) for ends in _ends_of_each(asked)]


def _in_image(view: View, points: list[Floats], along: list[Floats]) -> Cubics:
    """The arcs with these ends and slopes in space, in the image and in depth."""
    images = [np.column_stack([sight_lines.image(view, x), sight_lines.depth(view, x)]) for x in points]
    slopes = [
        np.column_stack([sight_lines.image_slopes(view, x, way), -way[:, 2]])
        for x, way in zip(points, along, strict=True)
    ]
    return _arcs(images, slopes)


def cubics_in_space(curves: Curves, chord: Ints) -> Cubics:
    """The cubic arcs of chords, given by the points at which they begin, in space."""
    return _arcs(*_ends(curves, chord))


def _ends(curves: Curves, chord: Ints) -> Ends:
    """The points (k,3) at both ends of chords, and the slopes (k,3) of the curves there."""
    (ends,) = _ends_of_each([(curves, chord)])
    return ends


def _ends_of_each(asked: Sequence[tuple[Curves, Ints]]) -> list[Ends]:
    """The same of chords of each of several curves."""
    parts = [(curves, chord, np.full(len(chord), part)) for curves, chord in asked for part in (0.0, 1.0)]
    slopes = [found.slopes for found in at_once(parts)]
    return [
        ([curves.points[chord], curves.points[chord + 1]], slopes[2 * k : 2 * k + 2])
        for k, (curves, chord) in enumerate(asked)
    ]


def _arcs(ends: list[Floats], slopes: list[Floats]) -> Cubics:
    """The cubic arcs between ends (k,3) with these slopes (k,3), straight where a slope is none of a curve near it."""
    way = ends[1] - ends[0]
    longest = STEEPEST * np.abs(way).max(axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        leaving, arriving = (np.where((np.abs(s) <= longest).all(axis=1)[:, None], s, way) for s in slopes)
    return Cubics.between(ends[0], ends[1], leaving, arriving)
