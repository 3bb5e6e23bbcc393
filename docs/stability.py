"""Writes docs/stability.md: hard cases swept through their degeneracy, with plots, and the table of all hard cases.

``python docs/stability.py`` runs every sweep of tests/sweeps, some 350 drawings in half a minute, and writes
docs/stability/*.svg; docs/hard_case_pictures.py draws the pictures of the table. A test compares the page, but for the
numbers that were measured, with what this would write.
"""

from __future__ import annotations

import ast
import importlib.util
import sys
import tomllib
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from hard_case_pictures import PICTURES
from sweeps.all_sweeps import SWEEPS
from sweeps.sweep import Sweep

import vectorplot as vp
from vectorplot.drawing.charts import Curve, Panel, chart

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "stability.md"
PLOTS = ROOT / "docs" / "stability"

EXACT = 1e-17
"""Where a plot shows what is right to the last digit."""

INTRODUCTION = """# Stability

A drawing should change where the scene does, and nowhere else. So the hard cases below are not only tried: each of
them that has something to turn (a gap, an angle, a size) is swept through the place where it becomes degenerate, and
the answer is compared with the one that mathematics gives. Errors are measured; an error of zero is drawn at 1e-17.
Red are the true answer, and the error that the package promises, to which the tests hold it. An upright line is a
limit: beyond it the package takes a case for the degenerate one, by a rule that stands beside the plot; these rules
are those of [accuracy and limits](accuracy-and-limits.md), their numbers those of the
[table of tolerances](tolerances.md).

Besides, what is done to a scene and must not show (turned, a million times as large, far away, in another order, an
item twice, a face in parts) is tried in every verb, and what must show as the same thing done to the
picture (mirrored); [hostile files](accuracy-and-limits.md#hostile-input) are counted elsewhere.

Written by docs/stability.py. Sizes, gaps and distances are in sizes of the scene, about 1.
"""


def slug(name: str) -> str:
    """The name of a sweep in the name of its plot."""
    return "_".join("".join(letter if letter.isalnum() else " " for letter in name).split())


class Measured(NamedTuple):
    """The answers of a sweep at its values, the true ones, and the errors."""

    sweep: Sweep
    answers: list[float]
    truths: list[float]

    @classmethod
    def of(cls, sweep: Sweep) -> Measured:
        """A sweep that is run now."""
        values = [float(value) for value in sweep.values]
        return cls(sweep, [sweep.found(value) for value in values], [sweep.truth(value) for value in values])

    @property
    def errors(self) -> list[float]:
        """How far the answers are from the truth."""
        return [abs(answer - truth) for answer, truth in zip(self.answers, self.truths, strict=True)]

    def plot(self) -> vp.Drawing:
        """The answers, where they are not zero, and the errors over the knob, with what is promised, and the limit."""
        sweep, values = self.sweep, [float(value) for value in self.sweep.values]
        uprights = ((sweep.limit[0], "limit"),) if sweep.limit else ()
        promised = [max(sweep.room(value), EXACT) for value in values]
        errors = (
            Curve("found", values, [max(error, EXACT) for error in self.errors], 0),
            Curve("promised", values, promised, 1),
        )
        panels = [Panel(sweep.knob, "error", errors, uprights)]
        if any(self.truths):
            answers = (Curve("found", values, self.answers, 0), Curve("true", values, self.truths, 1, marked=False))
            panels.insert(0, Panel(sweep.knob, "answer", answers, uprights))
        return chart(sweep.name, panels)

    def lines(self) -> list[str]:
        """What the page says."""
        sweep = self.sweep
        hard = ", ".join(str(number) for number in sweep.hard)
        cases = f"Hard case {hard}." if len(sweep.hard) == 1 else f"Hard cases {hard}."
        beyond = f" Beyond {sweep.limit[0]:.0e}: {sweep.limit[1]}." if sweep.limit else ""
        inside = [
            e for e, value in zip(self.errors, sweep.values, strict=True) if not sweep.limit or value > sweep.limit[0]
        ]
        return [
            f"### {sweep.name.capitalize()}",
            "",
            f"{cases} Turned: {sweep.knob}, {len(inside)} values from {max(sweep.values):.0e} to"
            f" {min(sweep.values):.0e}. Measured: {sweep.answer}. Largest error: {max(inside):.1e}.{beyond}",
            "",
            f"![{sweep.name}](stability/{slug(sweep.name)}.svg)",
            "",
        ]


@cache
def proofs() -> dict[int, list[str]]:
    """The tests that carry the mark of each hard case, and the sweeps of it, as links."""
    spec = importlib.util.spec_from_file_location("coverage_page", ROOT / "docs" / "coverage.py")
    coverage_page = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(coverage_page)
    found: dict[int, list[str]] = {}
    for test in sorted((ROOT / "tests").rglob("test_*.py")):
        text = test.read_text(encoding="utf-8")
        # To read a file as Python takes long, and most hold no hard case.
        for kind, number, name in coverage_page.marks(ast.parse(text)) if "mark.hard(" in text else ():
            if kind == "hard":
                found.setdefault(int(number), []).append(f"[{name}](../{test.relative_to(ROOT).as_posix()})")
    for sweep in SWEEPS:
        for number in sweep.hard:
            found.setdefault(number, []).append(f"[{sweep.name}](#{sweep.name.replace(' ', '-').replace(',', '')})")
    return found


def table() -> Iterator[str]:
    """The lines of the table of hard cases."""
    proved = proofs()
    for room, cases in tomllib.loads((ROOT / "docs" / "hard_cases.toml").read_text(encoding="utf-8")).items():
        yield from (
            f"### {room.capitalize()}",
            "",
            "| # | what is hard | what happens | what holds it | picture |",
            "|---|---|---|---|---|",
        )
        for number, (case, answer) in cases.items():
            held = ", ".join(dict.fromkeys(proved[int(number)]))
            shown = f"![{case}](hard_cases/{number}.svg)" if int(number) in PICTURES else ""
            yield f"| {number} | {case} | {answer} | {held} | {shown} |"
        yield ""


def page(sweeps: list[str]) -> str:
    """The text of the page, with the lines about sweeps."""
    return "\n".join([INTRODUCTION, "## Sweeps", "", *sweeps, hard_cases()])


def hard_cases() -> str:
    """The part of the page that is not measured."""
    return "\n".join(["## Hard cases", "", *table()])


def main() -> None:
    """Run all sweeps, write the plots and the page."""
    PLOTS.mkdir(exist_ok=True)
    lines = []
    for sweep in SWEEPS:
        measured = Measured.of(sweep)
        vp.save(measured.plot(), PLOTS / f"{slug(sweep.name)}.svg")
        lines += measured.lines()
    PAGE.write_text(page(lines), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}: {len(SWEEPS)} sweeps")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
