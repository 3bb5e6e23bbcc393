"""Curves on a parametrised sheet that are known by points and by their directions there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import dot, from_components
from vectorplot.surfaces.jets import first_jets
from vectorplot.visibility.smooth.sheets.family import Along, Chords
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised, inside

STEEPEST = 2.0
"""Where the parameters change faster at an end of a chord than so many times what they do along it, or not forwards,
their change says nothing of what is between, as beside a pole."""


@dataclass(frozen=True, eq=False)
class DirectedCurves:
    """Curves of which second places are directions: how the parameters grow by the length. Between two points they are
    cubic in the parameters, and straight where a direction is not known."""

    surface: OnParametrised
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords.

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        start, end = chords.places
        surface = self.surface.surface_at(start)
        size = np.broadcast_to(from_components(*surface.domain.size), (len(part), 2))
        way = (end - start)[:, :2] / size
        one, two = (each[:, :2] / size for each in chords.second_places)
        both, far = one + two, STEEPEST * np.sqrt(dot(way, way))
        with np.errstate(all="ignore"):
            # As long as the way is if the parameters grow by the mean of both.
            long = 2.0 * dot(way, both) / dot(both, both)
            speed = long * np.sqrt(np.maximum(dot(one, one), dot(two, two)))
            known = (long > 0.0) & (speed <= far) & (dot(one, way) > 0.0) & (dot(two, way) > 0.0)
            leaving, arriving = (np.where(known[:, None], long[:, None] * each, way) for each in (one, two))
        t = part[:, None]
        bent, turned = 3.0 * way - 2.0 * leaving - arriving, leaving + arriving - 2.0 * way
        at = start + np.concatenate([t * (leaving + t * (bent + t * turned)) * size, 0.0 * t], axis=1)
        moved = (leaving + t * (2.0 * bent + 3.0 * t * turned)) * size
        u, v = inside(surface.domain, at)
        points, along_u, along_v = first_jets(surface, u, v)
        with np.errstate(all="ignore"):
            directions = np.where(known[:, None], np.insert(moved / long[:, None], 2, 0.0, axis=1), np.nan)
        return Along(at, points, moved[:, :1] * along_u + moved[:, 1:] * along_v, directions)
