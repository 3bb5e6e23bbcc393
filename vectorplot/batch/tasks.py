"""Tasks, which are files and how they are made, their fingerprints, and the workers that run them."""

from __future__ import annotations

import hashlib
import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType
from typing import Any, Generic, Protocol, TypeVar

from vectorplot import __version__
from vectorplot.errors import InputError, not_installed

# The value Task: a file and how its content is made; and fingerprints, by which a file is known to be up to date.


@dataclass(frozen=True)
class Task:
    """A file that is to be made.

    Parameters
    ----------
    path : str
        The file; its folder is made where there is none.
    content : callable
        content() is what is written, as bytes. For workers in other processes it can be pickled: a function of a
        module, or functools.partial of one.
    fingerprint : str
        Of all that the content depends on, as `fingerprint` makes it; where it is that of a file that was written
        before, this is not made again. Without one, the file is always made.

    Examples
    --------
    >>> from functools import partial
    >>> from vectorplot.batch import Task
    >>> Task("out/hello.txt", partial(bytes, 5)).content()
    b'\\x00\\x00\\x00\\x00\\x00'
    """

    path: str
    content: Callable[[], bytes]
    fingerprint: str = ""


def fingerprint(*said: str, files: Iterable[str | os.PathLike[str]] = ()) -> str:
    """What tells a picture from another one: a hash of the version of the package, of texts, and of what files hold.

    Parameters
    ----------
    said : str
        All that the picture depends on, beside the files.
    files : iterable of str or path
        The files it is made of: names do not matter, contents and their order do.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    OSError
        For a file that cannot be read.

    Notes
    -----
    It is the first 128 bits of a SHA-256 sum: two pictures with the same one of these are the same but with a
    probability of about 1e-38.

    Examples
    --------
    >>> from vectorplot.batch import fingerprint
    >>> fingerprint("frame", "12") == fingerprint("frame", "12")
    True
    >>> fingerprint("frame", "12") == fingerprint("frame1", "2")
    False
    """
    whole = hashlib.sha256()
    for part in (__version__, *said):
        whole.update(hashlib.sha256(part.encode("utf-8", "surrogatepass")).digest())
    for path in files:
        with Path(path).open("rb") as file:
            whole.update(hashlib.file_digest(file, "sha256").digest())
    return whole.hexdigest()[:32]


# The engine: calls on an executor, few at a time, and again where a worker is lost.

Key = TypeVar("Key")
Value = TypeVar("Value")

IN_COMPANY, ALONE = 2, 1
"""How often a call is made again beside others, and then alone, after its worker was lost."""

NOTHING_WORKS = 3
"""After so many calls in a row that no worker survived, the workers are at fault."""


class Submits(Protocol):
    """What takes calls, as the executors of `concurrent.futures` do, of this room, and of others' clusters."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The answer to a call, which comes later."""
        ...


@dataclass(frozen=True)
class Lost:
    """No answer came, however often it was asked for: the workers died, or never understood; why: in one line."""

    why: str


@dataclass(frozen=True)
class _Call(Generic[Key, Value]):
    key: Key
    work: Callable[[], Value]
    losses: int = 0

    @property
    def alone(self) -> bool:
        """Whether it may be what its workers die of."""
        return self.losses >= IN_COMPANY


def answers(
    calls: Iterable[tuple[Key, Callable[[], Value]]], executor: Submits, window: int
) -> Iterator[tuple[Key, Value | Lost]]:
    """The answers to calls as they come, each with its key; at most window calls are under way. Calls raise nothing:
    what an executor raises instead is the loss of a worker, and a call present at too many losses is retried alone.
    Where this is left early, calls not begun are cancelled.
    Errors: InputError where no worker survives anything.
    """
    fresh = (_Call(key, work) for key, work in calls)
    again: deque[_Call[Key, Value]] = deque()
    running: dict[Future[Value], _Call[Key, Value]] = {}
    done: SimpleQueue[Future[Value]] = SimpleQueue()
    in_vain = 0

    def begin(call: _Call[Key, Value]) -> None:
        future = executor.submit(call.work)
        running[future] = call
        future.add_done_callback(done.put)

    try:
        while True:
            lonely = any(call.alone for call in running.values())
            while not lonely and len(running) < window and done.empty():
                call = again.popleft() if again else next(fresh, None)
                if call is None:
                    break
                if call.alone and running:
                    again.appendleft(call)
                    break
                begin(call)
                lonely = call.alone
            if not running:
                return
            future = done.get()
            call = running.pop(future)
            try:
                value: Value | Lost = future.result()
                in_vain = 0
            except BaseException as error:
                if not isinstance(error, Exception) and not future.cancelled():
                    raise
                if call.losses < IN_COMPANY + ALONE:
                    again.append(replace(call, losses=call.losses + 1))
                    continue
                value = Lost(_why(error))
                in_vain += 1
                if in_vain == NOTHING_WORKS:
                    raise InputError(f"no worker survives anything: {value.why}") from error
            yield call.key, value
    finally:
        for future in running:
            future.cancel()


def _why(error: BaseException) -> str:
    text = str(error)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


# Who does the work: this process, processes of this machine, or a cluster.

ANSWERS_S = 10
"""Seconds within which a scheduler answers."""

MOST_WORKERS = 1024
"""Processes of one machine."""


class Here(Executor):
    """This process: each call is done when it is submitted."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The answer to a call, which has come."""
        answer: Future[Any] = Future()
        try:
            answer.set_result(fn(*args, **kwargs))
        except Exception as error:
            answer.set_exception(error)
        return answer


class Processes(Executor):
    """Processes of this machine; those that die are replaced.

    Parameters
    ----------
    workers : int
        How many, 1 to 1024.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    They are started afresh (spawn), as on every system: a program that uses them does its work behind
    ``if __name__ == "__main__":``. Left with an error, such as the KeyboardInterrupt of Ctrl-C, it ends them at once;
    nor do they outlive this process. Calls that were under way when one of them died raise BrokenProcessPool.

    Examples
    --------
    >>> from vectorplot.batch import Processes
    >>> with Processes(2) as executor:  # doctest: +SKIP
    ...     executor.submit(divmod, 7, 2).result()
    (3, 1)
    """

    def __init__(self, workers: int) -> None:
        if not 1 <= workers <= MOST_WORKERS:
            raise InputError(f"{workers} workers: expected 1 to {MOST_WORKERS}")
        self.workers = workers
        self._context = multiprocessing.get_context("spawn")
        # Nothing is ever sent: when the end of this process is closed, by itself or by death, theirs says so.
        self._theirs, self._ours = self._context.Pipe(duplex=False)
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self.workers, self._context, _begin, (self._theirs,))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The answer to a call, which comes later."""
        try:
            return self._pool.submit(fn, *args, **kwargs)
        except BrokenProcessPool:
            self._pool.shutdown(wait=False)
            self._pool = self._new()
            return self._pool.submit(fn, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes when they have done what they have begun."""
        self._pool.shutdown(wait, cancel_futures=cancel_futures)
        if wait:
            self._ours.close()
            self._theirs.close()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self._ours.close()
        self.shutdown(cancel_futures=kind is not None)


def _begin(theirs: Connection) -> None:
    """What a worker does first: Ctrl-C is for who started it, and when that one ends, so does this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def outlive_nobody() -> None:
        try:
            theirs.poll(None)
        finally:
            # It writes no files, so nothing is left half done.
            os._exit(1)

    threading.Thread(target=outlive_nobody, daemon=True).start()


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """The workers of a running Dask cluster as an executor; address: of its scheduler, such as ``tcp://host:8786``.
    Tasks under way are cancelled when it is left with an error.
    Whoever reaches a scheduler may run programs on its workers, so it belongs in a private network or behind TLS.
    Workers need the same versions of Python and of this package, and the same names for input files. Errors: without
    the extra ``cluster``, or where nobody answers.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise not_installed("a cluster", "distributed", "cluster") from None
    try:
        client = distributed.Client(address, timeout=ANSWERS_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"no cluster answers at {address}: {str(error).splitlines()[0]}") from None
    with client, client.get_executor(pure=False) as executor:
        yield executor
