"""Seconds of a quiet machine: work that takes too long is stopped, and a slow or a busy machine alone fails no test."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import numpy as np

BARE_S = 0.002
"""CPU seconds that `bare_work` takes on a quiet machine."""


class TooLong(BaseException):
    """The time is up. No Exception, so that nothing in between takes it for one of its own."""


def bare_work() -> None:
    """What all the rest is made of: a loop over numbers, and arrays that are sorted."""
    total = 0
    for number in range(40_000):
        total += number * number % 7
    np.sort(np.arange(20_000.0) * 0.618 % 1.0)


def slowness() -> float:
    """How many times longer than on a quiet machine work takes just now; at least 1."""
    times = []
    for _ in range(3):
        start = time.process_time()
        bare_work()
        times.append(time.process_time() - start)
    return max(1.0, sorted(times)[1] / BARE_S)


@contextmanager
def cpu_seconds(most: float) -> Iterator[None]:
    """A block that is stopped by TooLong after so many CPU seconds of a quiet machine; only the main thread can be
    stopped. How slow this one is, is asked when the time would be up."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    slowest, start = 1.0, time.process_time()

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal slowest
        slowest = max(slowest, slowness())
        left = most * slowest - (time.process_time() - start)
        if left <= 0.0:
            raise TooLong(f"more than {most} seconds of a quiet machine; this one takes {slowest:.1f} times as long")
        signal.setitimer(signal.ITIMER_PROF, left)

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, most)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
