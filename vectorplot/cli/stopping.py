"""What stops the command from outside: Ctrl-C, and the signals by which a system ends programs."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SAID = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "hung up"}
"""The signals that stop the command, and what it says then. Not every system has all of them."""


class Stopped(KeyboardInterrupt):
    """A signal has come; number: which one."""

    def __init__(self, number: int) -> None:
        self.number = number


def _stop(number: int, frame: FrameType | None) -> None:
    raise Stopped(number)


@contextmanager
def stoppable() -> Iterator[None]:
    """Where the signals of SAID raise Stopped, wherever the work is; one that was ignored before stays so.

    Degenerate: outside the main thread, where Python has no signals, nothing changes.
    """
    before = {}
    try:
        for name in SAID:
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) not in (signal.SIG_IGN, None):
                before[number] = signal.signal(number, _stop)
    except ValueError:
        pass
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def stopped(stop: KeyboardInterrupt) -> int:
    """The exit status after a stop, 128 and the signal's number as in shells; one line on stderr says what it was."""
    number = stop.number if isinstance(stop, Stopped) else signal.SIGINT
    line = f"vectorplot: {SAID[signal.Signals(number).name]}"
    try:
        # The terminal has written ^C.
        sys.stderr.write(f"\n{line}\n" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()
    except OSError:
        pass
    return 128 + int(number)
