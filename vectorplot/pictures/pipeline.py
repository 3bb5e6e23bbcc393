"""The stages of a picture: run one after the other, each told with what it cost."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

from vectorplot.errors import printable
from vectorplot.geometry.budget import stopping, threads

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Stage:
    """A stage of a verb, and why the scene calls for it."""

    name: str
    why: str


@dataclass(frozen=True)
class StageReport:
    """What a stage cost: seconds, how many things came out of it, and the process's peak memory so far in MB; or, in a
    report of its own as soon as it can be told, error: what its approximation was measured to cost, in a unit."""

    name: str
    why: str
    seconds: float
    count: int
    peak_mb: float
    error: float | None = None
    unit: str = ""

    def __str__(self) -> str:
        """A line of what ``--explain`` prints."""
        cost = f"{1000.0 * self.seconds:9.1f}  {self.count:9d}  {self.peak_mb:8.1f}"
        return f"{self.name:<{STAGE_NAME}}  {cost}  {self.off:<{ERROR_WIDTH}}  {printable(self.why)}"

    @property
    def off(self) -> str:
        """The error with its unit, in two digits; empty where there is none."""
        return "" if self.error is None else f"{self.error:.2g} {self.unit}"


STAGE_NAME = 16
"""So many letters names of stages have at most, mirror light and lines on meshes among them."""

ERROR_WIDTH = 14
"""The letters of an error with its unit."""


class Pipeline:
    """Runs the stages of a plan, and only those; tells a listener about each, and a progress bar how far it is."""

    def __init__(
        self,
        stages: Sequence[Stage],
        explain: Callable[[StageReport], None] | None,
        progress: Callable[[str, float], None] | None,
        jobs: int | None = None,
    ) -> None:
        """jobs: threads that chunks of stages are done on; where None those around it."""
        self._jobs = jobs
        self._stages = {stage.name: stage for stage in stages}
        count = max(len(stages), 1)
        self._spans = {stage.name: (number / count, (number + 1) / count) for number, stage in enumerate(stages)}
        self._explain = explain
        self._progress = progress

    def calls_for(self, name: str) -> bool:
        """Whether the plan has this stage."""
        return name in self._stages

    def repetition(self, names: Sequence[str], number: int, count: int) -> Pipeline:
        """The walk of one of some repetitions, the number-th of count, of stages that follow one another."""
        spans = [self._spans[name] for name in names if name in self._spans]
        first, whole = min(begin for begin, _ in spans), sum(end - begin for begin, end in spans)
        pipeline = Pipeline(list(self._stages.values()), self._explain, self._progress, self._jobs)
        for name in pipeline._spans.keys() & set(names):
            begin, end = (first + (whole * number + place - first) / count for place in pipeline._spans[name])
            pipeline._spans[name] = (begin, end)
        return pipeline

    def fraction(self, name: str) -> Callable[[float], None]:
        """What a stage calls with the part of it that is done."""

        def report(part: float) -> None:
            if self._progress is not None:
                begin, end = self._spans[name]
                # One stage ends exactly where the next one begins.
                self._progress(name, begin * (1.0 - part) + end * part)

        return report

    def tell(self, name: str, why: str, count: int) -> None:
        """Tell the listener what came out of a stage, besides its result."""
        if self._explain is not None:
            self._explain(StageReport(name, why, 0.0, count, peak_mb()))

    def measured(
        self, name: str, unit: str, measure: Callable[P, float | None], *args: P.args, **kwargs: P.kwargs
    ) -> None:
        """Tell the listener, if there is one and the plan has the stage, what its approximation cost in some unit;
        nothing where there was nothing to approximate. It takes no time where nobody listens."""
        if self._explain is None or name not in self._stages:
            return
        start = time.perf_counter()
        error = measure(*args, **kwargs)
        if error is not None:
            seconds = time.perf_counter() - start
            self._explain(StageReport(name, self._stages[name].why, seconds, 0, peak_mb(), error, unit))

    def run(self, name: str, function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
        """The result of a stage.

        Edge cases: numbers beyond the range of floats become infinite without a warning, for every test of size takes
        infinity for large; what is not a number is still warned of.
        """
        stage = self._stages[name]
        self.fraction(name)(0.0)
        start = time.perf_counter()
        with np.errstate(over="ignore"), threads(self._jobs):
            result = function(*args, **kwargs)
        seconds = time.perf_counter() - start
        if self._explain is not None:
            self._explain(StageReport(name, stage.why, seconds, _count(result), peak_mb()))
        self.fraction(name)(1.0)
        return result


ASKED_S = 0.02
"""A listener is asked no more often whether work that has not come farther is to stop."""


def stoppable(verb: Callable[P, R]) -> Callable[P, R]:
    """The verb, which asks its progress amid stages too, wherever they may stop: it is told once more how far the work
    has come, and what it raises stops the work."""

    @wraps(verb)
    def asking(*args: P.args, **kwargs: P.kwargs) -> R:
        listener: Any = kwargs.get("progress")
        if not callable(listener):
            return verb(*args, **kwargs)
        asked = _Asked(listener)
        kwargs["progress"] = asked
        with stopping(asked.again):
            return verb(*args, **kwargs)

    return asking


class _Asked:
    """A listener, what it was told last, and when."""

    def __init__(self, listener: Callable[[str, float], None]) -> None:
        self._listener, self._told, self._when = listener, ("look", 0.0), time.perf_counter()

    def __call__(self, stage: str, fraction: float) -> None:
        self._told, self._when = (stage, fraction), time.perf_counter()
        self._listener(stage, fraction)

    def again(self) -> None:
        """Tells the same once more, if that was a while ago."""
        if time.perf_counter() - self._when > ASKED_S:
            self(*self._told)


def _count(result: Any) -> int:
    """How many things a stage made; of several results the first tells."""
    first = result[0] if isinstance(result, tuple) and result and hasattr(result[0], "__len__") else result
    return len(first) if hasattr(first, "__len__") else 1


def peak_mb() -> float:
    """Peak memory of this process; where the system does not tell it apart, of its parent too if that is larger; NaN
    where it tells nothing (Windows)."""
    import sys

    if sys.platform == "linux":
        with open("/proc/self/status") as status:
            return next((int(line.split()[1]) / 1024.0 for line in status if line.startswith("VmHWM")), 0.0)
    try:
        import resource
    except ImportError:
        return float("nan")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024.0 * 1024.0 if sys.platform == "darwin" else 1024.0)
