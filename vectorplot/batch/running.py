"""Running tasks: records of what is finished, files made by workers, and the frames of films as tasks."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import threading
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Generic, TypeVar

from vectorplot.batch.tasks import Here, Lost, Submits, Task, answers, fingerprint
from vectorplot.errors import InputError, InputWarning, printable
from vectorplot.pictures.film import Film
from vectorplot.save import FORMATS, write, write_whole
from vectorplot.save_frames import DIGITS

# The record of what is finished: a file in every folder, with a line for every picture that was written into it.

RECORD = ".vectorplot-finished"
"""Its name. A line is a JSON list: name of the file, fingerprint, bytes."""

_FOLDERS = 8
"""Of so many folders the records are held in memory."""


class Records:
    """What was written before, by folders; of few folders at a time."""

    def __init__(self) -> None:
        self.known: dict[Path, dict[str, tuple[str, int]]] = {}

    def has(self, path: str, fingerprint: str) -> bool:
        """Whether a file with this fingerprint is there, whole."""
        where = Path(path)
        if not fingerprint or self._of(where.parent).get(where.name, ("", 0))[0] != fingerprint:
            return False
        try:
            # A machine that lost its power may have kept the name of a file and not what is in it.
            return where.stat().st_size == self._of(where.parent)[where.name][1]
        except OSError:
            return False

    def add(self, path: str, fingerprint: str, size: int) -> None:
        """Note that a file was written. Errors: OSError that names the record."""
        if not fingerprint:
            return
        where = Path(path)
        self._of(where.parent)[where.name] = (fingerprint, size)
        line = json.dumps([where.name, fingerprint, size]) + "\n"
        record = os.open(where.parent / RECORD, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            os.write(record, line.encode("ascii"))
        finally:
            os.close(record)

    def _of(self, folder: Path) -> dict[str, tuple[str, int]]:
        found = self.known.pop(folder, None)
        if found is None:
            found = _read(folder / RECORD)
            while len(self.known) >= _FOLDERS:
                del self.known[next(iter(self.known))]
        self.known[folder] = found
        return found


def _read(record: Path) -> dict[str, tuple[str, int]]:
    """By names: fingerprints and sizes. Edge cases: lines that are none, as one that was broken off, say nothing."""
    found: dict[str, tuple[str, int]] = {}
    try:
        text = record.read_text(encoding="ascii", errors="replace")
    except OSError:
        return found
    for line in text.splitlines():
        try:
            name, fingerprint, size = json.loads(line)
            found[str(name)] = (str(fingerprint), int(size))
        except (ValueError, TypeError, RecursionError):
            continue
    if text and not text.endswith("\n"):
        with record.open("a", encoding="ascii") as file:
            file.write("\n")
    return found


Value = TypeVar("Value")

WINDOW = 32
"""So many tasks are with the workers at once if nobody says otherwise."""


@dataclass(frozen=True)
class Outcome:
    """What became of a task.

    path: its file; state: written, kept (it was up to date) or failed; cause: why it failed, in one line; warnings:
    what an InputWarning said while its content was made.
    """

    path: str
    state: str
    cause: str = ""
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Tally:
    """How many files were written, kept because they were up to date, and failed.

    written, kept, failed: the counts.
    """

    written: int = 0
    kept: int = 0
    failed: int = 0

    @property
    def count(self) -> int:
        """All of them."""
        return self.written + self.kept + self.failed


@dataclass(frozen=True)
class _Answer(Generic[Value]):
    """What a worker sends: a value, or why there is none; bug: the trace of an error that is no fault of the input."""

    value: Value | None = None
    cause: str = ""
    bug: str = ""
    warnings: tuple[str, ...] = ()


def run(
    tasks: Iterable[Task],
    executor: Submits | None = None,
    *,
    window: int = WINDOW,
    tell: Callable[[Outcome], None] | None = None,
) -> Tally:
    """Make files, each whole or not at all, and only those that are not up to date.

    Parameters
    ----------
    tasks : iterable of Task
        Taken one by one as workers become free: there may be millions.
    executor : Executor, optional
        Anything with the method submit of `concurrent.futures.Executor`; where None, this process does the work.
    window : int
        So many tasks are with the executor at once; with less than two for a worker, workers wait.
    tell : callable, optional
        tell(outcome) is called as soon as a file is done.

    Returns
    -------
    Tally
        How many files were written, kept and failed.

    Raises
    ------
    InputError
        For a window below 1, and where no worker survives anything.
    OSError
        Where a file cannot be written; it names the path.
    RuntimeError
        For an error in a task that is no fault of its input; what is finished stays.

    Notes
    -----
    Workers make contents; this process writes them. So workers need no folder in common to write into, one that dies
    leaves nothing behind, and files are the same bytes whatever the executor is. InputError, OSError and MemoryError of
    a task are its outcome, and the others go on. A task whose worker is lost is given to another one; the third time
    while no other task runs, and after the fourth loss it has failed. What is finished is noted in a file
    ``.vectorplot-finished`` in each folder, so that a run that was stopped goes on where it was.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from functools import partial
    >>> from vectorplot.batch import Task, fingerprint, run
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     tasks = [Task(f"{folder}/{n}.bin", partial(bytes, n), fingerprint(str(n))) for n in range(3)]
    ...     run(tasks[:2]), run(tasks)
    (Tally(written=2, kept=0, failed=0), Tally(written=1, kept=2, failed=0))
    """
    if window < 1:
        raise InputError(f"a window of {window} tasks: expected 1 or more")
    counts = {"written": 0, "kept": 0, "failed": 0}
    records = Records()

    def note(outcome: Outcome) -> None:
        counts[outcome.state] += 1
        if tell is not None:
            tell(outcome)

    def due() -> Iterator[tuple[Task, Callable[[], _Answer[bytes]]]]:
        for task in tasks:
            if records.has(task.path, task.fingerprint):
                note(Outcome(task.path, "kept"))
            else:
                yield task, partial(_answered, task.content)

    for task, answer in answers(due(), executor or Here(), window):
        content = _value(answer, task.path)
        told = () if isinstance(answer, Lost) else answer.warnings
        if isinstance(content, InputError):
            note(Outcome(task.path, "failed", content.cause, told))
            continue
        Path(task.path).parent.mkdir(parents=True, exist_ok=True)
        write_whole(task.path, content)
        records.add(task.path, task.fingerprint, len(content))
        note(Outcome(task.path, "written", "", told))
    return Tally(**counts)


def results(
    calls: Sequence[Callable[[], Value]],
    executor: Submits | None = None,
    *,
    window: int = WINDOW,
    tell: Callable[[], None] | None = None,
) -> list[Value]:
    """What calls give, in their order, such as the drawings of a contact sheet.

    Parameters
    ----------
    calls : sequence of callables
        Without arguments; for workers in other processes they can be pickled.
    executor : Executor, optional
        See `run`.
    window : int
        See `run`.
    tell : callable, optional
        Is called after each that is done.

    Returns
    -------
    list
        A value for each call.

    Raises
    ------
    InputError
        See `run`, and what a call raises of InputError, OSError and MemoryError.
    RuntimeError
        See `run`.

    Examples
    --------
    >>> from functools import partial
    >>> import vectorplot as vp
    >>> from vectorplot.batch import results
    >>> from vectorplot.geometry import box
    >>> drawings = results([partial(vp.draw, box((1, 1, 1)), view) for view in ("top", "iso")])
    >>> vp.contact_sheet(drawings).width_mm
    210.0
    """
    if window < 1:
        raise InputError(f"a window of {window} tasks: expected 1 or more")
    found: dict[int, Value] = {}
    work = ((number, partial(_answered, call)) for number, call in enumerate(calls))
    for number, answer in answers(work, executor or Here(), window):
        value = _value(answer, f"call {number + 1} of {len(calls)}")
        if isinstance(value, InputError):
            raise value
        for text in () if isinstance(answer, Lost) else answer.warnings:
            warnings.warn(text, InputWarning, stacklevel=2)
        found[number] = value
        if tell is not None:
            tell()
    return [found[number] for number in range(len(calls))]


def _answered(make: Callable[[], Value]) -> _Answer[Value]:
    """What a worker does. It raises no Exception: an executor that does has lost its worker."""
    if threading.current_thread() is not threading.main_thread():
        return _tried(make)
    # To catch warnings is for one thread alone.
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        answer = _tried(make)
    told = dict.fromkeys(str(entry.message) for entry in caught if issubclass(entry.category, InputWarning))
    return _Answer(answer.value, answer.cause, answer.bug, tuple(told))


def _tried(make: Callable[[], Value]) -> _Answer[Value]:
    try:
        return _Answer(make())
    except InputError as error:
        return _Answer(cause=str(error))
    except OSError as error:
        name = "" if error.filename is None else f"{error.filename}: "
        return _Answer(cause=printable(name + (error.strerror or str(error))))
    except MemoryError:
        return _Answer(cause="there is not enough memory for this")
    except Exception:
        return _Answer(bug=traceback.format_exc())


def _value(answer: _Answer[Value] | Lost, name: str) -> Value | InputError:
    """The value, or an InputError that says why there is none. Errors: RuntimeError for a bug."""
    if isinstance(answer, Lost):
        return InputError(f"its workers were lost: {answer.why}")
    if answer.bug:
        raise RuntimeError(f"{name}: {answer.bug}")
    if answer.cause:
        return InputError(answer.cause)
    value: Value = answer.value  # type: ignore[assignment]
    return value


# The frames of a film as tasks.

_PICKLE = 5
"""The protocol in which films are compared: any one, but always the same."""


def frame_tasks(film: Film, folder: str | os.PathLike[str], *, format: str | None = None) -> Iterator[Task]:
    """The files that `vp.save_frames` would write into a folder, as tasks; format: svg for drawings, png for pixels
    where None. Tasks have fingerprints where the film can be pickled, as those of animation files can; others are
    always made, in this process. Errors: InputError for an unknown format.
    """
    written = format or ("png" if film.pixels else "svg")
    if written not in FORMATS:
        raise InputError(f"unknown format {written!r}; known are {', '.join(FORMATS)}")
    # Neither the order of options, nor the number of threads, nor who is told of the stages changes a frame.
    options = {name: value for name, value in sorted(film.options.items()) if name not in ("jobs", "explain")}
    same = replace(film, options=options)
    try:
        whole = hashlib.sha256(pickle.dumps(same, _PICKLE)).hexdigest()
    except (pickle.PicklingError, AttributeError, TypeError):
        whole = ""
    for frame in range(len(film)):
        path = os.fspath(Path(folder) / f"{frame + 1:0{DIGITS}d}.{written}")
        known = fingerprint(whole, str(frame), written) if whole else ""
        yield Task(path, partial(frame_content, film, frame, written), known)


def frame_content(film: Film, frame: int, format: str) -> bytes:
    """A frame as the content of a file."""
    return write(film.picture(frame), format)
