"""What changes along keys: values at some times, and what is between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.splines.kinds import AkimaSpline, CubicSpline
from vectorplot.curves.splines.spline_curve import SplineCurve, spline_curve
from vectorplot.errors import InputError

WAYS = ("akima", "cubic", "linear")
"""How values run between keys: the first one where nothing is said."""

FEWEST_CLOSED = {"akima": 3, "cubic": 3, "linear": 2}
"""Keys of a track that is closed."""

PERIOD = 1.0
"""The time after which what is closed comes again."""


@dataclass(frozen=True, eq=False)
class Track:
    """Numbers or points that depend on time: keys (n,) times, values (n, 1) or (n, 3), a word of WAYS.

    Before the first key and behind the last one values stay; of what is closed the first key follows the last one, one
    unit of time after it was there.
    Errors: InputError for times that do not rise or leave 0 to 1, and for too few keys.
    Source: Glaeser, section 9.1, errata G9-01 to G9-05.
    """

    times: Floats
    values: Floats
    way: str = WAYS[0]
    closed: bool = False

    def __post_init__(self) -> None:
        times = self.times
        if not ((times >= 0.0) & (times <= PERIOD)).all() or not (np.diff(times) > 0.0).all():
            raise InputError("times of keys must rise, from 0 to 1")
        if self.closed and len(times) < FEWEST_CLOSED[self.way]:
            raise InputError(f"closed: {len(times)} keys, expected {FEWEST_CLOSED[self.way]} or more")
        if self.closed and times[-1] - times[0] >= PERIOD:
            raise InputError("closed: the last key stands where the first one comes again")

    def at(self, time: float) -> Floats:
        """(1,) or (3,) the value at a time."""
        first, last = float(self.times[0]), float(self.times[-1])
        moment = first + (time - first) % PERIOD if self.closed else min(max(time, first), last)
        if len(self.times) == 1:
            return np.asarray(self.values[0])
        if self.way == "linear":
            times, values = self._around
            return np.array([np.interp(moment, times, column) for column in values.T])
        return np.asarray(self._spline.points(np.array(moment))[: self.values.shape[1]])

    @property
    def _around(self) -> tuple[Floats, Floats]:
        """Times and values, of what is closed with the first key again at the end."""
        if not self.closed:
            return self.times, self.values
        return np.append(self.times, self.times[0] + PERIOD), np.concatenate([self.values, self.values[:1]])

    @cached_property
    def _spline(self) -> SplineCurve:
        kind = AkimaSpline if self.way == "akima" else CubicSpline
        points = np.zeros((len(self.values), 3))
        points[:, : self.values.shape[1]] = self.values
        return spline_curve(points, kind(closed=self.closed, parameters=self._around[0]))
