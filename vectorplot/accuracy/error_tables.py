"""What was measured as text, as CSV, and as JSON."""

from __future__ import annotations

import csv
import io
import json
import textwrap
from collections.abc import Sequence
from dataclasses import asdict

from vectorplot.accuracy.approximation import Approximation
from vectorplot.accuracy.curves_of_error import Accuracy, ErrorCurve, Sample

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
