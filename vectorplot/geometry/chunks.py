"""Work that falls into chunks, on several threads at once.

Stages look at millions of pairs, faces or points a chunk at a time. Chunks do not depend on each other, and numpy
leaves the interpreter to other threads while it computes: so they are done side by side, and what comes out of them is
taken in their order. Which chunks there are never depends on the number of threads; so pictures do not either, to the
last bit.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from itertools import chain, islice
from threading import Lock
from typing import TYPE_CHECKING, TypeVar

from vectorplot.errors import InputError

if TYPE_CHECKING:
    from concurrent.futures import Future

T = TypeVar("T")
R = TypeVar("R")

# Fewer things are done with before threads have begun.
_FEW = 1 << 12

_THREADS: ContextVar[Callable[[], int]] = ContextVar("threads", default=lambda: 1)
"""On how many threads one may work now."""


def threads_of(jobs: int | None) -> int:
    """How many threads a number of jobs asks for: itself, or where it is None as many as there are processors for this
    process. Errors: InputError unless it is 1 or more."""
    if jobs is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if jobs < 1:
        raise InputError(f"{jobs:g} jobs: expected 1 or more")
    return int(jobs)


@contextmanager
def threads(count: int | None) -> Iterator[None]:
    """Where mapped works on so many threads; None: on as many as around it, one if nothing is said there."""
    token = _THREADS.set(_THREADS.get() if count is None else lambda: count)
    try:
        yield
    finally:
        _THREADS.reset(token)


def mapped(function: Callable[[T], R], chunks: Iterable[T]) -> Iterator[R]:
    """What a function makes of each chunk, in their order, on as many threads as are allowed.

    Chunks are asked for on the thread that takes the results, a few ahead of these: memory does not grow with their
    number. What the function raises comes out where its result would; then, or when nobody takes the rest, chunks that
    have not begun are never done. What is mapped within a chunk has one thread, and those that are idle by then: so the
    last and largest one of a few is shared too.
    Degenerate: without chunks nothing; a single one is done where it is asked for.
    """
    count, chunks = _THREADS.get()(), iter(chunks)
    first = list(islice(chunks, 2)) if count > 1 else []
    if len(first) < 2:
        yield from map(function, chain(first, chunks))
        return
    from concurrent.futures import ThreadPoolExecutor

    waiting: deque[Future[R]] = deque()
    pool, share = ThreadPoolExecutor(count), _Share(count)
    try:
        for chunk in chain(first, chunks):
            share.begin()
            waiting.append(pool.submit(copy_context().run, _shared, share, function, chunk))
            if len(waiting) > count:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def workers(count: int) -> int:
    """On how many threads something that shares so many things out by itself, as a search in a tree, may work: one for
    few of them."""
    return _THREADS.get()() if count > _FEW else 1


class _Share:
    """How many threads of a pool are idle."""

    def __init__(self, count: int) -> None:
        self._count, self._begun, self._lock = count, 0, Lock()

    def begin(self) -> None:
        with self._lock:
            self._begun += 1

    def end(self) -> None:
        with self._lock:
            self._begun -= 1

    def of_one(self) -> int:
        """On how many threads one of the chunks may work."""
        return 1 + max(self._count - self._begun, 0)


def _shared(share: _Share, function: Callable[[T], R], chunk: T) -> R:
    token = _THREADS.set(share.of_one)
    try:
        return function(chunk)
    finally:
        _THREADS.reset(token)
        share.end()


def slices(count: int, size: int) -> list[slice]:
    """Slices of a size that cover so many things; the last one may be shorter."""
    return [slice(low, min(low + size, count)) for low in range(0, count, size)]
