"""Measures what accuracy costs, and writes the page that shows it, docs/accuracy.md, with its plots.

``python docs/accuracy.py`` measures everything, which takes a minute or two; ``python docs/accuracy.py spline-fit``
measures this one, and leaves the rest of the page as it is. Errors are the same on every run, times are not.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path

import vectorplot as vp
from vectorplot.accuracy import plot
from vectorplot.accuracy.results import Accuracy, ErrorCurve, Sample
from vectorplot.accuracy.verb import APPROXIMATIONS

DOCS = Path(__file__).resolve().parent

INTRO = """# What accuracy costs

    vectorplot accuracy
    vectorplot accuracy zero-manifold depth-buffer -o accuracy
    vectorplot accuracy bezier-fit --values 1,0.3,0.1,0.03

`vectorplot accuracy` measures every approximation of the package over its knob: the error of each result, and the
time it took, beside the exact result or the finest one that there is. All of them take half a minute, one of them
seconds. It prints tables; `-o` writes them as `table.csv` and `table.json` into a folder, with a plot for each
approximation, drawn by vectorplot itself. `vectorplot accuracy --list` lists the names. In Python
`vp.accuracy("zero-manifold")` gives the same as values, and `vectorplot.accuracy.plot` a drawing of each.

* Errors are measured, not derived: distances on the page in mm, lengths that are wrong in per cent of all, pixels
  that are wrong. Truth is a closed form, a ray for each place, or the same curve a hundred times finer. They are
  the same on every run.
* Times are those of the processor on one thread, the shortest of a few, in milliseconds. Those below are from a
  machine with two processors that had much else to do: their ratios hold elsewhere.
* A slope is the power of the knob that errors went like, all values taken together; in plots, dashed lines have the
  slope of theory. -2 means that twice as many cells leave a quarter of the error.

`--off-by 0.01mm` and `--within 0.5s` choose from these curves, and measure what they reached:
[accuracy that is kept](command.md#accuracy-that-is-kept). What these numbers mean for a picture stands in
[accuracy and limits](accuracy-and-limits.md), and the time of whole pictures in [speed](speed.md). This page and its
plots are written by `python docs/accuracy.py`; how to add an approximation is told in
[CONTRIBUTING](../CONTRIBUTING.md#a-new-approximation).
"""

NOTES = {
    "bezier-fit": "Ten times the accuracy costs three times as many chords, but only half as many segments more: so "
    "drawings leave as curves.",
    "spline-fit": "The natural cubic has no curvature at its ends, and the curve has: what is lost there nothing "
    "inside makes good. Akima's rule trades a power for tangents that feel five points only.",
    "zero-manifold": "The book's cubic parabola through values and average normals gains a power over the chord, true "
    "slopes gain another one. Refining every point on the function itself costs little, and is exact.",
    "field-steps": "The book's step is off by millimetres at the end. The four tangents of Runge and Kutta take three "
    "times as long, and are off by less than any pen shows.",
    "integral-curves": "Where nothing else is said the package takes 1e-9. Above 1e-8 nothing is saved: no step is "
    "longer than a sixth of the extent, so that none jumps over what lies between.",
    "painted-outline": "Polygons are compared with the surface at a few places of each side: outlines may be off by "
    "a tenth more than the tolerance.",
    "depth-buffer": "Exact hidden lines of these boxes take the time of a buffer of 500 x 500 pixels.",
    "snapping": "With vertices off by 1e-10 all places are decided rightly at 1e-9, and up to a thousand times that.",
    "shadow-maps": "For few faces exact shadows cost less than a large map.",
}


def page(measured: Sequence[Accuracy], before: str = "") -> str:
    """The text of docs/accuracy.md; what was not measured is as on the page before."""
    parts = {part.split("`")[1]: part for part in re.split(r"\n(?=## )", before)[1:]}
    parts |= {one.name: section(one) for one in measured}
    return "\n".join([INTRO, *(parts[one.name] for one in APPROXIMATIONS)])


def section(one: Accuracy) -> str:
    """An approximation: what it is, its plot, its errors and times, and what they say."""
    head = [one.knob, *(curve.way for curve in one.curves)]
    knobs = [f"{sample.knob:g}" for sample in one.curves[0].samples]
    rows = [[knob, *(cell(curve.samples[k]) for curve in one.curves)] for k, knob in enumerate(knobs)]
    if any(curve.theory is not None for curve in one.curves):
        rows.append(["slope, and that of theory", *map(slopes, one.curves)])
    table = [head, ["---"] * len(head), *rows]
    lines = [f"## {one.title}", "", f"`{one.name}`: {one.about}", "", f"![{one.title}](accuracy/{one.name}.svg)", ""]
    lines += [f"Errors in {one.unit}, and ms:", "", *("| " + " | ".join(row) + " |" for row in table), ""]
    if one.exact is not None:
        lines += [f"Beside them the exact result: {cell(one.exact)}.", ""]
    return "\n".join(lines + ([NOTES[one.name], ""] if one.name in NOTES else []))


def cell(sample: Sample) -> str:
    """An error, and the time in ms."""
    ms = 1000.0 * sample.seconds
    return f"{sample.error:.2g} ({f'{ms:.2g}' if ms < 10.0 else f'{ms:.0f}'} ms)"


def slopes(curve: ErrorCurve) -> str:
    """What was found, and what theory says."""
    return "" if curve.theory is None or curve.slope is None else f"{curve.slope:.2f}, {curve.theory:g}"


def main() -> None:
    """Measure, and write the page and the plots."""
    names = sys.argv[1:]
    before = (DOCS / "accuracy.md").read_text(encoding="utf-8") if names else ""

    def progress(name: str, part: float) -> None:
        print(f"\r{100 * part:3.0f} % {name:24}", end="", flush=True)

    measured = vp.accuracy(*names, progress=progress)
    (DOCS / "accuracy").mkdir(exist_ok=True)
    for one in measured:
        vp.save(plot(one), DOCS / "accuracy" / f"{one.name}.svg")
    (DOCS / "accuracy.md").write_text(page(measured, before), encoding="utf-8")
    print(f"\r{len(measured)} approximations")


if __name__ == "__main__":
    main()
