"""The entry point: runs the command, stops it on signals, and turns what went wrong into a line and an exit status."""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType

from vectorplot.errors import InputError, printable

# What stops the command from outside: Ctrl-C, and the signals by which a system ends programs.

SAID = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "hung up"}
"""The signals that stop the command, and what it says then. Not every system has all of them."""


class Stopped(KeyboardInterrupt):
    """A signal has come; number: which one."""

    def __init__(self, number: int) -> None:
        self.number = number


def _stop(number: int, frame: FrameType | None) -> None:
    """Raises Stopped; while a module loads, a moment later: Python makes other errors of what is raised in the making
    of a class (before version 3.12), and modules in C of what is raised in what they import."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            later = threading.Timer(0.005, _send, [number, threading.get_ident()])
            later.daemon = True
            later.start()
            return
        frame = frame.f_back
    raise Stopped(number)


def _send(number: int, thread: int) -> None:
    """Sends a signal to a thread of this process; where systems cannot, to the process, which wakes no thread."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(thread, number)
    else:
        signal.raise_signal(number)


@contextmanager
def stoppable() -> Iterator[None]:
    """Where the signals of SAID raise Stopped, wherever the work is; one that was ignored before stays so.

    Edge cases: outside the main thread, where Python has no signals, nothing changes.
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


def _ignore(*handlers: object) -> None:
    """Ignores the signals of SAID, those that one of these handlers has."""
    for number in (getattr(signal, name) for name in SAID if hasattr(signal, name)):
        if signal.getsignal(number) in handlers:
            signal.signal(number, signal.SIG_IGN)


def stopped(stop: KeyboardInterrupt) -> int:
    """The exit status after a stop, 128 and the signal's number as in shells; one line on stderr says what it was. More
    signals are ignored from here on, as far as stoppable lets them stop anything."""
    _ignore(_stop)
    number = stop.number if isinstance(stop, Stopped) else signal.SIGINT
    line = f"vectorplot: {SAID[signal.Signals(number).name]}"
    try:
        # The terminal has written ^C.
        sys.stderr.write(f"\n{line}\n" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()
    except OSError:
        pass
    return 128 + int(number)


BAD_INPUT = 1

NO_MEMORY = "there is not enough memory for this"


def main() -> None:
    """What the shell starts."""
    # Before numpy comes. Stages share their work out themselves (--jobs): threads of matrix products would mostly wait
    # for more of these, which takes as much of a processor as small pictures do.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        with stoppable():
            status = run(sys.argv[1:])
    except KeyboardInterrupt as stop:
        status = stopped(stop)
    if status > 128:
        # The command has said why it ends: a second signal has no more to say.
        _ignore(signal.SIG_DFL, signal.default_int_handler)
    sys.exit(status)


def run(arguments: Sequence[str]) -> int:
    """The exit status after running the command: 0, 1 for bad input, 2 for bad usage, 128 and more after a signal."""
    try:
        return _invoked(arguments)
    except KeyboardInterrupt as stop:
        return stopped(stop)
    except InputError as error:
        say(str(error))
    except BrokenPipeError:
        # The reader has gone; without this the interpreter complains once more when it flushes at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        name = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
        say(name + (error.strerror or str(error)))
    except MemoryError:
        say(NO_MEMORY)
    return BAD_INPUT


def _invoked(arguments: Sequence[str]) -> int:
    """The exit status after the command did its work or told of bad usage."""
    import click

    from vectorplot.cli.verbs import meant_option, say_usage, vectorplot

    try:
        with warnings.catch_warnings():
            if not sys.warnoptions:
                warnings.simplefilter("ignore")
            with vectorplot.make_context("vectorplot", [_as_written(word) for word in arguments]) as context:
                vectorplot.invoke(context)
    except click.exceptions.Exit as error:
        return error.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        return error.exit_code
    except click.NoSuchOption as error:
        say_usage(error, f"No such option {error.option_name!r}.{meant_option(error)}")
        return error.exit_code
    except click.UsageError as error:
        say_usage(error, error.format_message())
        return error.exit_code
    return 0


def _as_written(word: str) -> str:
    """A word of the command line, read as UTF-8 where the locale (LANG=C) left its bytes as they came."""
    try:
        return os.fsencode(word).decode("utf-8")
    except UnicodeDecodeError:
        return word


def say(text: str) -> None:
    """Print one line on stderr, whatever the text holds and whether anyone reads it."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(f"vectorplot: {printable(text)}\n")
        sys.stderr.flush()
    except OSError:
        pass
