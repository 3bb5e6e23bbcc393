"""Measures the fixed scenes and the bare costs beside them."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from vectorplot.draw import draw
from vectorplot.geometry.budget import unheard
from vectorplot.geometry.chunks import threads_of
from vectorplot.paint import paint
from vectorplot.render import render
from vectorplot.speed.clock import cpu_seconds, peak_of, wall_seconds
from vectorplot.speed.log import Log, Measured, Threads
from vectorplot.speed.operations import array_operations, call_operations, point_cost
from vectorplot.speed.scenes import SERIES, Series
from vectorplot.stages.walk import StageReport

VERBS: dict[str, Callable[..., object]] = {"draw": draw, "paint": paint, "render": render}

LONG = 0.5
"""What takes so many seconds is timed once, after it was made once untimed; what is shorter a few times."""

THREADED = ("boxes", "weave", "one mesh")
"""The pictures that are made on one thread and on several."""


def measured(series: Series, repeat: int = 2, largest: int | None = None) -> Measured:
    """What the pictures of a series cost on one thread, the shortest of some times each; largest: of its sizes no
    larger one is tried."""
    verb, times = VERBS[series.verb], []
    sizes = tuple(size for size in series.sizes if largest is None or size <= largest)
    stages: list[StageReport] = []
    memory = 0.0
    for size in sizes:
        made = partial(verb, series.scene(size), jobs=1, **series.options)
        memory = peak_of(made)
        stages = []
        once = cpu_seconds(partial(made, explain=stages.append), 1)
        once -= sum(stage.seconds for stage in stages if stage.error is not None)
        stages = [stage for stage in stages if stage.error is None]
        times.append(once if once > LONG else min(once, cpu_seconds(made, repeat)))
    whole = sum(stage.seconds for stage in stages) or 1.0
    parts = tuple((stage.name, stage.seconds / whole) for stage in stages)
    return Measured(series.name, series.verb, series.thing, sizes, tuple(times), parts, memory)


def on_threads(series: Series, count: int) -> Threads:
    """The largest picture of a series on one thread and on so many."""
    made = partial(VERBS[series.verb], series.scene(series.sizes[-1]), **series.options)
    one, several = (wall_seconds(partial(made, jobs=jobs), 1) for jobs in (1, count))
    return Threads(series.name, series.sizes[-1], count, one, several)


def measure(only: Sequence[str] = (), progress: Callable[[str, float], None] | None = None) -> Log:
    """All that is measured; only: the names of the series, all where it is empty; progress(name, part) is called while
    it works."""
    told = progress or (lambda name, part: unheard(part))
    chosen = [series for series in SERIES if not only or series.name in only]
    count = threads_of(None)
    threaded = [series for series in chosen if series.name in THREADED] if count > 1 else []
    steps = len(chosen) + len(threaded) + 1
    told("operations", 0.0)
    arrays, calls, point = array_operations(), call_operations(), point_cost()
    pictures, threads = [], []
    for number, series in enumerate(chosen):
        told(series.name, (number + 1) / steps)
        pictures.append(measured(series))
    for number, series in enumerate(threaded):
        told(f"{series.name} on {count} threads", (len(chosen) + number + 1) / steps)
        threads.append(on_threads(series, count))
    return Log(_machine(count), arrays, calls, point, tuple(pictures), tuple(threads))


def _machine(threads: int) -> str:
    python = f"Python {platform.python_version()}, numpy {np.__version__}"
    return f"{platform.system()} {platform.machine()}, {threads} processors, {python}"
