"""Curves in which quadrics meet, and planes do: between their points they lie on both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import cross, dot
from vectorplot.tolerances.of_lengths import FAMILY_SETTLED, MISSED_OF_CHORD
from vectorplot.visibility.smooth.sheets.family import FARTHEST, ROUNDS, Along, Chords, no_longer


@dataclass(frozen=True, eq=False)
class QuadricsMeet:
    """Curves of pairs of quadrics, forms (k,2,4,4): x form x = 0 for homogeneous points x of the view. The first
    coordinate of the places of a curve is the number of its pair."""

    forms: Floats
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords: in the plane across the chord to where both quadrics are, by Newton's
        method. Degenerate: where they touch, the chord."""
        start, end = chords.points
        way = end - start
        base, size = start + part[:, None] * way, np.sqrt(dot(way, way))
        forms = self.forms[chords.places[0][:, 0].astype(np.intp)]
        found, last = base.copy(), np.zeros(len(base))
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                values, (n, m) = _at(forms, found)
                across_n, across_m = cross(m, way), cross(way, n)
                ahead = dot(base - found, way)[:, None] * cross(n, m)
                step = (ahead - values[:, :1] * across_n - values[:, 1:] * across_m) / dot(n, across_n)[:, None]
                step = no_longer(np.where(np.isfinite(step), step, 0.0), FARTHEST * size)
                found, last = found + step, np.sqrt(dot(step, step))
                if (last <= FAMILY_SETTLED * size).all():
                    break
            _, (n, m) = _at(forms, found)
            tangent = cross(n, m)
            tangent *= (dot(way, way) / dot(tangent, way))[:, None]
        met = (last <= MISSED_OF_CHORD * size)[:, None]
        along = np.isfinite(tangent).all(axis=1, keepdims=True)
        return Along(chords.places[0], np.where(met, found, base), np.where(met & along, tangent, way))


def _at(forms: Floats, points: Floats) -> tuple[Floats, tuple[Floats, Floats]]:
    """The values (n,2) of pairs of forms (n,2,4,4) at points (n,3), and the gradients (n,3) of both."""
    x = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    half = np.einsum("nkij,nj->nki", forms, x)
    return np.einsum("nki,ni->nk", half, x), (2.0 * half[:, 0, :3], 2.0 * half[:, 1, :3])
