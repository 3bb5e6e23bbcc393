"""Who does the work: this process, processes of this machine, or a cluster."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib import import_module
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any

from vectorplot.errors import InputError

ANSWERS_S = 10
"""Seconds within which a scheduler answers."""

MOST_WORKERS = 1024
"""Processes of one machine."""


class Here(Executor):
    """This process: each call is done when it is submitted.

    Examples
    --------
    >>> from vectorplot.batch import Here
    >>> Here().submit(divmod, 7, 2).result()
    (3, 1)
    """

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
    """The workers of a Dask cluster that runs already.

    Parameters
    ----------
    address : str
        Of its scheduler, as ``tcp://host:8786``.

    Returns
    -------
    context manager
        Gives an executor; tasks that are under way when it is left with an error are cancelled.

    Raises
    ------
    InputError
        Where the extra ``cluster`` is not installed, or nobody answers at the address.

    Notes
    -----
    Whoever reaches a scheduler may run programs on its workers: it belongs into a network of one's own, or behind TLS.
    Workers have the same versions of Python and of this package, and see input files by the same names.

    Examples
    --------
    >>> from vectorplot.batch import cluster
    >>> with cluster("tcp://127.0.0.1:8786") as executor:  # doctest: +SKIP
    ...     executor.submit(divmod, 7, 2).result()
    (3, 1)
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise InputError("a cluster needs the extra: pip install 'vectorplot[cluster]'") from None
    try:
        client = distributed.Client(address, timeout=ANSWERS_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"no cluster answers at {address}: {str(error).splitlines()[0]}") from None
    with client, client.get_executor(pure=False) as executor:
        yield executor
