"""What was measured of an approximation, error and time over its knob: as drawings, text, CSV, JSON and folders."""

from __future__ import annotations

import csv
import io
import json
import textwrap
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from vectorplot.accuracy.approximation import Approximation
from vectorplot.drawing.charts import Curve, Panel, chart
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.elementary import log
from vectorplot.save import write, write_whole

# What was measured of an approximation: error and time over its knob.


@dataclass(frozen=True)
class Sample:
    """What one result cost.

    knob: the value of the knob; 0 for the exact result, which has none; seconds: of the processor, the shortest of some
    times; error: against the truth, in the unit of the approximation; count: how many things the result consists of.
    """

    knob: float
    seconds: float
    error: float
    count: int


@dataclass(frozen=True)
class ErrorCurve:
    """The errors of one way over the knob.

    way: its name; theory: the power of the knob that errors go like, by theory; samples: one for each value of the
    knob, from coarse to fine.
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

    name, title, about, knob, unit, counts: of the approximation; curves: one for each of its ways; exact: the exact or
    the finest result.
    """

    name: str
    title: str
    about: str
    knob: str
    unit: str
    counts: str
    curves: tuple[ErrorCurve, ...]
    exact: Sample | None


# What was measured as a drawing: errors over the knob, and over time.

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


# What was measured as text, as CSV, and as JSON.

FORMAT, VERSION = "vectorplot-accuracy", 1

WIDTH = 100
"""Letters on a line."""

HEAD = ("approximation", "way", "knob", "value", "seconds", "error", "unit", "count", "of", "slope", "theory")


def as_text(measured: Sequence[Accuracy]) -> str:
    """Tables, one for each approximation."""
    return "\n\n".join(map(_table, measured))


def _table(one: Accuracy) -> str:
    head = f"{'way':<18} {'value':>9} {'error':>11} {'ms':>9} {one.counts:>15}"
    rows = [f"{one.name}: {one.title}", *textwrap.wrap(one.about, WIDTH), ""]
    rows += [f"error in {one.unit} over {one.knob}", head]
    for curve in one.curves:
        for number, sample in enumerate(curve.samples):
            rows.append(_row(curve.way if number == 0 else "", f"{sample.knob:g}", sample))
        if said := slopes(curve):
            rows.append(f"{'':<18} {said}")
    if one.exact is not None:
        rows.append(_row("exact", "", one.exact))
    return "\n".join(row.rstrip() for row in rows)


def _row(way: str, value: str, sample: Sample) -> str:
    return f"{way:<18} {value:>9} {sample.error:11.3g} {1000.0 * sample.seconds:9.4g} {sample.count:15,d}"


def slopes(curve: ErrorCurve) -> str:
    """The power of the knob that errors went like, and the one of theory; nothing where theory has none."""
    if curve.theory is None or curve.slope is None:
        return ""
    return f"slope {curve.slope:.2f}, by theory {curve.theory:g}"


def as_csv(measured: Sequence[Accuracy]) -> str:
    """A row for every sample, after one with the names of the columns; the exact result has no value."""
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(HEAD)
    for one in measured:
        for curve in one.curves:
            slope = "" if curve.slope is None else repr(curve.slope)
            theory = "" if curve.theory is None else repr(curve.theory)
            for sample in curve.samples:
                out.writerow(_columns(one, curve.way, repr(sample.knob), sample, slope, theory))
        if one.exact is not None:
            out.writerow(_columns(one, "exact", "", one.exact, "", ""))
    return text.getvalue()


def _columns(one: Accuracy, way: str, value: str, sample: Sample, slope: str, theory: str) -> tuple[object, ...]:
    numbers = (value, repr(sample.seconds), repr(sample.error))
    return (one.name, way, one.knob, *numbers, one.unit, sample.count, one.counts, slope, theory)


def as_json(measured: Sequence[Accuracy]) -> str:
    """All that was measured, with the slopes."""
    entries = []
    for one in measured:
        entry = asdict(one)
        for curve, found in zip(entry["curves"], one.curves, strict=True):
            curve["slope"] = found.slope
        entries.append(entry)
    document = {"format": FORMAT, "version": VERSION, "approximations": entries}
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def listed(approximations: Sequence[Approximation]) -> str:
    """A line for each approximation: its name, its knob, what its error is measured in, and what it is."""
    rows = [("name", "knob", "error in", "what it is")]
    rows += [(one.name, one.knob, one.unit, one.title) for one in approximations]
    wide = [max(len(row[k]) for row in rows) for k in range(3)]
    return "\n".join("  ".join((*(row[k].ljust(wide[k]) for k in range(3)), row[3])) for row in rows)


# A folder with all that was measured.


def write_folder(measured: Sequence[Accuracy], folder: str, format: str) -> None:
    """Write table.csv, table.json and a plot for each approximation, by its name, into a folder, which is made where
    there is none. Each file is written whole or not at all."""
    files = {"table.csv": as_csv(measured).encode(), "table.json": as_json(measured).encode()}
    files |= {f"{one.name}.{format}": write(plot(one), format) for one in measured}
    place = Path(folder)
    place.mkdir(exist_ok=True)
    for name, content in files.items():
        write_whole(str(place / name), content)
