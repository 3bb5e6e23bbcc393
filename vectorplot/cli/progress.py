"""What the command says on stderr while it works, and afterwards."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Any

import click

from vectorplot.errors import InputWarning

if TYPE_CHECKING:
    from vectorplot.stages.walk import StageReport

PATIENCE_S = 0.5
"""Work shorter than this shows no bar."""

INTERVAL_S = 0.05
"""The bar moves no more often than this."""

WARNINGS = 50
"""So many warnings are printed, the others counted."""


class Progress:
    """A progress bar that appears when the work takes long; call it with a stage and the fraction done, 0 to 1."""

    def __init__(self) -> None:
        self.shown = time.perf_counter() + PATIENCE_S - INTERVAL_S
        self.bar: Any = None

    def __call__(self, stage: str, fraction: float) -> None:
        """Show the stage and how far it has come."""
        now = time.perf_counter()
        if now < self.shown + INTERVAL_S:
            return
        self.shown = now
        if self.bar is None:
            from tqdm import tqdm

            shape = "{desc} {percentage:3.0f}%|{bar}| {elapsed}"
            self.bar = tqdm(total=1.0, file=sys.stderr, leave=False, bar_format=shape)
        self.bar.set_description_str(stage, refresh=False)
        self.bar.n = min(max(fraction, 0.0), 1.0)
        self.bar.refresh()

    def close(self) -> None:
        """Take the bar away."""
        if self.bar is not None:
            self.bar.close()


@contextmanager
def progress_bar(*, quiet: bool) -> Iterator[Progress | None]:
    """A progress bar on a terminal; None where stderr is no terminal or the user wants silence."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    bar = Progress()
    try:
        yield bar
    finally:
        bar.close()


@contextmanager
def told_warnings(*, quiet: bool) -> Iterator[None]:
    """Print every InputWarning of the work, up to WARNINGS of them, as one line on stderr, after the work.

    Work that fails says why in one line, and nothing else.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        yield
    if quiet:
        return
    lines = dict.fromkeys(str(entry.message) for entry in caught if issubclass(entry.category, InputWarning))
    for line in islice(lines, WARNINGS):
        click.echo(f"vectorplot: warning: {line}", err=True)
    if len(lines) > WARNINGS:
        click.echo(f"vectorplot: warning: {len(lines) - WARNINGS} more like these", err=True)


def table(reports: Sequence[StageReport]) -> str:
    """What the stages cost, a line each: time, how much came out, the process's peak memory by then, how far off what
    they approximate was measured to be, and why they ran."""
    from vectorplot.stages.walk import ERROR_WIDTH, STAGE_NAME

    head = f"{'stage':<{STAGE_NAME}}  {'ms':>9}  {'count':>9}  {'peak MB':>8}  {'off by':<{ERROR_WIDTH}}  why"
    peak = max((report.peak_mb for report in reports), default=0.0)
    total = sum(report.seconds for report in reports if report.error is None)
    foot = f"{'total':<{STAGE_NAME}}  {1000.0 * total:9.1f}  {'':>9}  {peak:8.1f}"
    return "\n".join([head, *map(str, with_errors(reports)), foot])


def with_errors(reports: Sequence[StageReport]) -> list[StageReport]:
    """A report for each stage, with what was measured of it later on; measuring is not part of its time."""
    found: list[StageReport] = []
    last: dict[str, int] = {}
    for report in reports:
        if report.error is None or report.name not in last:
            last[report.name] = len(found)
            found.append(report)
        else:
            stage = found[last[report.name]]
            found[last[report.name]] = replace(stage, error=report.error, unit=report.unit)
    return found


def summed(reports: Sequence[StageReport]) -> list[StageReport]:
    """The reports of many pictures as of one: times and counts together, of memory and errors the largest."""
    found: dict[tuple[str, bool], StageReport] = {}
    for one in reports:
        key = one.name, one.error is None
        before = found.get(key)
        if before is None:
            found[key] = one
            continue
        found[key] = replace(
            before,
            seconds=before.seconds + one.seconds,
            count=before.count + one.count,
            peak_mb=max(before.peak_mb, one.peak_mb),
            error=None if before.error is None or one.error is None else max(before.error, one.error),
        )
    return list(found.values())
