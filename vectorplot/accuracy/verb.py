"""The verb accuracy: approximations by their names become curves of error against time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from vectorplot.accuracy.approximation import Approximation, check_values
from vectorplot.accuracy.catalogue import APPROXIMATIONS
from vectorplot.accuracy.curves_of_error import Accuracy
from vectorplot.accuracy.measuring import measured
from vectorplot.words import unknown


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
