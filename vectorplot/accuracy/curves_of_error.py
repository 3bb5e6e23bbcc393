"""What was measured of an approximation: error and time over its knob."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vectorplot.geometry.elementary import log


@dataclass(frozen=True)
class Sample:
    """What one result cost.

    Parameters
    ----------
    knob : float
        The value of the knob; 0 for the exact result, which has none.
    seconds : float
        Of the processor, the shortest of some times.
    error : float
        Against the truth, in the unit of the approximation.
    count : int
        How many things the result consists of.

    Examples
    --------
    >>> from vectorplot.accuracy import Sample
    >>> Sample(knob=64.0, seconds=0.02, error=0.004, count=512).error
    0.004
    """

    knob: float
    seconds: float
    error: float
    count: int


@dataclass(frozen=True)
class ErrorCurve:
    """The errors of one way over the knob.

    Parameters
    ----------
    way : str
        Its name.
    theory : float, optional
        The power of the knob that errors go like, by theory.
    samples : tuple of Sample
        One for each value of the knob, from coarse to fine.

    Examples
    --------
    >>> from vectorplot.accuracy import ErrorCurve, Sample
    >>> curve = ErrorCurve("linear", -2.0, tuple(Sample(n, 1e-3 * n, 5.0 / n**2, n) for n in (8, 16, 32)))
    >>> round(curve.slope, 9), curve.falls
    (-2.0, True)
    """

    way: str
    theory: float | None
    samples: tuple[Sample, ...]

    @property
    def slope(self) -> float | None:
        """The power of the knob that errors went like: the best fit to those above zero; None for less than two."""
        known = [sample for sample in self.samples if sample.error > 0.0]
        if len(known) < 2:
            return None
        knobs, errors = log([sample.knob for sample in known]), log([sample.error for sample in known])
        return float(np.polyfit(knobs, errors, 1)[0])

    @property
    def falls(self) -> bool:
        """Whether no result is worse than the one before it."""
        errors = [sample.error for sample in self.samples]
        return all(after <= before for before, after in pairwise(errors))


@dataclass(frozen=True)
class Accuracy:
    """What accuracy costs with one approximation.

    Parameters
    ----------
    name, title, about, knob, unit, counts : str
        Of the approximation.
    curves : tuple of ErrorCurve
        One for each of its ways.
    exact : Sample, optional
        The exact or the finest result.

    Examples
    --------
    >>> import vectorplot as vp
    >>> (refraction,) = vp.accuracy("refraction", values=(1, 2))
    >>> [curve.way for curve in refraction.curves]
    ['by the angle', 'by the tangent']
    """

    name: str
    title: str
    about: str
    knob: str
    unit: str
    counts: str
    curves: tuple[ErrorCurve, ...]
    exact: Sample | None
