"""Time of the processor, and memory, that something takes."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from vectorplot.stages.walk import peak_mb

_RESET = Path("/proc/self/clear_refs")
"""Where Linux forgets the peak of a process's memory so far."""


def cpu_seconds(action: Callable[[], object], repeat: int = 3) -> float:
    """The shortest of a few times, of the processor: those of other programs do not count."""
    return _shortest(action, repeat, time.process_time)


def wall_seconds(action: Callable[[], object], repeat: int = 3) -> float:
    """The shortest of a few times, of the clock: what several threads do at once counts once."""
    return _shortest(action, repeat, time.perf_counter)


def _shortest(action: Callable[[], object], repeat: int, clock: Callable[[], float]) -> float:
    times = []
    for _ in range(repeat):
        start = clock()
        action()
        times.append(clock() - start)
    return min(times)


def peak_of(action: Callable[[], object]) -> float:
    """The memory in MB that something needed at most beyond what there was; where the system does not forget earlier
    peaks, beyond these."""
    try:
        _RESET.write_text("5")
    except OSError:
        pass
    before = peak_mb()
    action()
    return peak_mb() - before
