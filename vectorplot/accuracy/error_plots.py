"""What was measured as a drawing: errors over the knob, and over time."""

from __future__ import annotations

from vectorplot.accuracy.curves_of_error import Accuracy, ErrorCurve
from vectorplot.charts.chart import Curve, Panel, chart
from vectorplot.drawing.drawing import Drawing

BESIDE = 1.6
"""Lines of the slope of theory lie so many times above the coarsest error."""


def plot(measured: Accuracy) -> Drawing:
    """The errors of an approximation over its knob, with the slope that theory expects, and over seconds.

    Parameters
    ----------
    measured : Accuracy
        What is plotted.

    Returns
    -------
    Drawing
        Two panels with logarithmic axes; `vectorplot.save` writes it in any format.

    Notes
    -----
    Dashed lines have the slope of theory. An upright says how long the exact result takes, which has a place of its own
    only if its error is not zero. Errors of zero are marked at the foot.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.accuracy import plot
    >>> (refraction,) = vp.accuracy("refraction", values=(1, 2, 3))
    >>> [layer.name for layer in plot(refraction).layers]
    ['grid', 'axes', 'curve 0', 'curve 1', 'curve 2', 'letters']
    """
    error = f"error in {measured.unit}"
    over_knob = [_curve(curve, k, [sample.knob for sample in curve.samples]) for k, curve in enumerate(measured.curves)]
    over_time = [_curve(curve, k, [s.seconds for s in curve.samples]) for k, curve in enumerate(measured.curves)]
    theory = [line for k, curve in enumerate(measured.curves) for line in _theory(curve, k)]
    exact = () if measured.exact is None else ((measured.exact.seconds, "exact"),)
    samples = [sample for curve in measured.curves for sample in curve.samples]
    notes = ["dashed: slope of theory"] * bool(theory) + ["at the foot: no error"] * any(
        s.error == 0.0 for s in samples
    )
    panels = (Panel(measured.knob, error, (*over_knob, *theory)), Panel("seconds", error, tuple(over_time), exact))
    return chart(measured.title, panels, ", ".join(notes))


def _curve(curve: ErrorCurve, colour: int, x: list[float]) -> Curve:
    return Curve(curve.way, x, [sample.error for sample in curve.samples], colour)


def _theory(curve: ErrorCurve, colour: int) -> list[Curve]:
    """The line of the slope of theory above the errors of a curve, from the first of these to the last, if any."""
    known = [sample for sample in curve.samples if sample.error > 0.0]
    if curve.theory is None or len(known) < 2:
        return []
    first, last = known[0], known[-1]
    start = BESIDE * first.error
    end = start * (last.knob / first.knob) ** curve.theory
    return [Curve(curve.way, (first.knob, last.knob), (start, end), colour, marked=False, dashed=True)]
