"""The verb accuracy: all approximations that are measured, by name, run over their knobs."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from vectorplot.accuracy.approximation import Approximation, Study, Way, check_values
from vectorplot.accuracy.of_curves import (
    ARC_FIT,
    BEZIER_FIT,
    DRAWN_CURVES,
    FIELD_STEPS,
    INTEGRAL_CURVES,
    SPLINE_FIT,
    ZERO_MANIFOLD,
)
from vectorplot.accuracy.of_light import REFRACTION, SHADOW_MAPS
from vectorplot.accuracy.of_surfaces import MESH_CONTOUR, PAINTED_COLOURS, PAINTED_OUTLINE, POLYGONISED
from vectorplot.accuracy.of_visibility import DEPTH_BUFFER, SAMPLED_VISIBILITY, SNAPPING
from vectorplot.accuracy.results import Accuracy, ErrorCurve, Sample
from vectorplot.geometry.budget import unheard
from vectorplot.words import unknown

# Runs approximations over their knobs: times every result, and measures its error.

REPEAT_SECONDS, MOST_TIMES = 0.1, 5
"""A result is made again until that has taken so long, or so many times in all; the shortest time counts."""


def measured(
    approximation: Approximation,
    values: Sequence[float] | None = None,
    progress: Callable[[float], None] = unheard,
) -> Accuracy:
    """The errors and times of an approximation.

    Parameters
    ----------
    approximation : Approximation
        What is measured.
    values : sequence of float, optional
        Of the knob, from coarse to fine; its own where None.
    progress : callable, optional
        Called with the part that is done, 0 to 1.

    Returns
    -------
    Accuracy
        A curve for each way, all over the same values.

    Raises
    ------
    InputError
        For values that the knob does not take.

    Notes
    -----
    Errors are the same on every run. Seconds are those of the processor, the shortest of up to five times; the first
    result of each way is made once more beforehand, so that what loads at first use does not count.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.accuracy import Approximation, Study, Way, measured
    >>> polygon = Way("polygon", lambda corners: corners, slope=-2.0)
    >>> study = Study((polygon,), error=lambda corners: 1.0 - np.cos(np.pi / corners), count=int)
    >>> words = ("circle", "A circle as a polygon", "By its sag.", "corners", (8, 16, 32), (3, 1e6), "radii", "corners")
    >>> circle = measured(Approximation(*words, study=lambda: study))
    >>> round(circle.curves[0].slope, 1)
    -2.0
    """
    chosen = tuple(map(float, approximation.values if values is None else values))
    check_values(approximation, chosen)
    progress(0.0)
    study = approximation.study()
    steps = len(study.ways) * (len(chosen) + 1) + 1
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        progress(done / steps)

    curves = tuple(_curve(study, way, chosen, step) for way in study.ways)
    exact = None
    if study.exact is not None:
        study.exact()
        exact = _sample(study, 0.0, study.exact)
    progress(1.0)
    words = (approximation.name, approximation.title, approximation.about, approximation.knob, approximation.unit)
    return Accuracy(*words, approximation.counts, curves, exact)


def _curve(study: Study, way: Way, values: Sequence[float], step: Callable[[], None]) -> ErrorCurve:
    way.result(values[0])
    step()
    samples = []
    for value in values:
        samples.append(_sample(study, value, lambda value=value: way.result(value)))  # type: ignore[misc]
        step()
    return ErrorCurve(way.name, way.slope, tuple(samples))


def _sample(study: Study, knob: float, action: Callable[[], Any]) -> Sample:
    times: list[float] = []
    while len(times) < MOST_TIMES and sum(times) < REPEAT_SECONDS:
        start = time.process_time()
        result = action()
        times.append(time.process_time() - start)
    # What is over between two ticks of the clock took a tick at most, and no time has no logarithm.
    tick = time.get_clock_info("process_time").resolution
    return Sample(knob, max(min(times), tick), float(study.error(result)), int(study.count(result)))


# All approximations of the package whose accuracy is measured.

APPROXIMATIONS: tuple[Approximation, ...] = (
    *(DRAWN_CURVES, BEZIER_FIT, ARC_FIT, SPLINE_FIT, ZERO_MANIFOLD, FIELD_STEPS, INTEGRAL_CURVES),
    *(MESH_CONTOUR, POLYGONISED, PAINTED_OUTLINE, PAINTED_COLOURS),
    *(DEPTH_BUFFER, SAMPLED_VISIBILITY, SNAPPING),
    *(SHADOW_MAPS, REFRACTION),
)
"""Each approximation once, those of curves first; a new one is a file in the room of its kind, and a name here."""


def accuracy(
    *names: str,
    values: Sequence[float] | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> tuple[Accuracy, ...]:
    """What accuracy costs in time: the measured errors of the package's approximations over their knobs.

    Parameters
    ----------
    names : str
        Of approximations, as in `vectorplot.accuracy.APPROXIMATIONS`; all of them where none is given.
    values : sequence of float, optional
        Of the knob, from coarse to fine, for each of these; its own where None.
    progress : callable, optional
        progress(name, fraction) is called while it works.

    Returns
    -------
    tuple of Accuracy
        One for each approximation, in the order of the names.

    Raises
    ------
    InputError
        For a name that none has, and values that the knob of one does not take.

    Notes
    -----
    Errors are measured against the truth, not derived; they are the same on every run. Seconds are those of the
    processor on one thread. All together takes a few minutes.

    Examples
    --------
    >>> import vectorplot as vp
    >>> (fit,) = vp.accuracy("bezier-fit", values=(1.0, 0.1))
    >>> [(curve.way, [sample.error < sample.knob for sample in curve.samples]) for curve in fit.curves]
    [('chords', [True, True]), ('Béziers', [True, True])]
    """
    chosen = [_named(name) for name in names] or list(APPROXIMATIONS)
    for one in chosen:
        check_values(one, one.values if values is None else values)
    told = progress or (lambda name, fraction: None)
    found = []
    for number, one in enumerate(chosen):

        def step(part: float, one: Approximation = one, number: int = number) -> None:
            told(one.name, (number + part) / len(chosen))

        found.append(measured(one, values, step))
    return tuple(found)


def _named(name: str) -> Approximation:
    """The approximation of that name. Errors: InputError for another one, with the name it may have meant."""
    for one in APPROXIMATIONS:
        if one.name == name:
            return one
    raise unknown("approximation", name, [one.name for one in APPROXIMATIONS])
