"""Limits to the work on a smooth surface, the doubts that are told, where work stops, and chunks on several threads."""

from __future__ import annotations

import math
import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from dataclasses import dataclass, fields
from itertools import chain, islice
from threading import Lock
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Ints
from vectorplot.errors import InputError

if TYPE_CHECKING:
    from concurrent.futures import Future


# How much work a smooth surface may be before its picture is finished without the rest.

HOW = "a larger budget may do (--budget)"
"""How what was left out may be had all the same."""


@dataclass(frozen=True)
class Budget:
    """Limits of the work on smooth surfaces and shortest paths, so that every picture ends; what they leave undone is
    reported. cells: of a domain around one family of curves; triangles: of an implicit surface around one; points:
    that its curves are refined to; pairs: of chords, chords and triangles, or sight lines and triangles that are
    close in the image; facets: triangles to paint or render; pieces: that piercing faces are cut into; windows: that
    shortest paths of one place are searched through; mirrors: and faces of glass that are
    looked into for lines.
    """

    cells: int = 1 << 13
    triangles: int = 1 << 17
    points: int = 1 << 16
    pairs: int = 1 << 20
    facets: int = 1 << 18
    pieces: int = 1 << 15
    windows: int = 20_000_000
    mirrors: int = 512


USUAL = Budget()
"""The budget where nothing else is said."""


def budget_of(factor: float) -> Budget:
    """The usual budget, so many times."""
    if not 0.0 < factor < math.inf:
        raise InputError(f"a budget of {factor:g}: expected a factor that is finite and positive")
    limits = (getattr(USUAL, limit.name) for limit in fields(Budget))
    # No array has more elements than that.
    return Budget(*(max(1, int(min(limit * factor, 2.0**62))) for limit in limits))


def unresolved(what: str) -> str:
    """The doubt that the budget did not do for something."""
    return f"{what}: {HOW}"


def unheard(part: float) -> None:
    """Whom long work tells the part of it that is done when nobody wants to know."""


def part_of(done: Callable[[float], None], number: int, count: int) -> Callable[[float], None]:
    """Whom the number-th of count equal parts of long work tells the part of it that is done."""
    return lambda part: done((number + part) / count)


def in_one_line(doubts: Iterable[str]) -> str:
    """The doubts about one thing, each once, as one sentence; what the budget did not do for comes last."""
    each = list(dict.fromkeys(doubts))
    spent = [text.removesuffix(f": {HOW}") for text in each if text.endswith(HOW)]
    rest = [text for text in each if not text.endswith(HOW)]
    return "; ".join([*rest, *([unresolved("; ".join(spent))] if spent else [])])


def line_each(doubts: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """The doubts about several things, each with the name of what it is about: one line for each of these."""
    about: dict[str, list[str]] = {}
    for name, text in doubts:
        about.setdefault(name, []).append(text)
    return tuple(f"{name}: {in_one_line(texts)}" for name, texts in about.items())


# Where long work may be stopped: amid the loops of its stages, by whoever does not wait for it any more.

WAIT_S = 0.05
"""Who waits for other threads asks so often whether to stop."""

T = TypeVar("T")
R = TypeVar("R")

_ASKED: ContextVar[Callable[[], None]] = ContextVar("asked", default=lambda: None)
"""What raises an exception where the work is to stop."""


@contextmanager
def stopping(ask: Callable[[], None]) -> Iterator[None]:
    """Where may_stop calls ask, which raises an exception where the work is to stop."""
    token = _ASKED.set(ask)
    try:
        yield
    finally:
        _ASKED.reset(token)


def may_stop() -> None:
    """A place amid long work where it may be stopped; loops over chunks are to have one at least every tenth of a
    second."""
    _ASKED.get()()


def in_turn(chunks: Iterable[T]) -> Iterator[T]:
    """The chunks of long work, one after the other; before each of them it may stop."""
    for chunk in chunks:
        may_stop()
        yield chunk


def in_pieces(function: Callable[..., NDArray[Any]], size: int, *columns: NDArray[Any]) -> NDArray[Any]:
    """What a function that looks at each row by itself makes of columns: of so many rows at once, and may stop in
    between."""
    if len(columns[0]) <= size:
        return function(*columns)
    return np.concatenate(
        [function(*(column[some] for column in columns)) for some in in_turn(slices(len(columns[0]), size))]
    )


# Work that falls into chunks, on several threads at once.
#
# Stages look at millions of pairs, faces or points a chunk at a time. Chunks do not depend on each other, and numpy
# leaves the interpreter to other threads while it computes: so they are done side by side, and what comes out of them
# is taken in their order. Which chunks there are never depends on the number of threads; so pictures do not either, to
# the last bit.

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
    """What a function makes of each chunk, in order, on as many threads as are allowed. Chunks are taken on the calling
    thread, a few ahead of the results, so memory does not grow with their number. Exceptions are raised where the
    result would come; then, or when nobody takes the rest, chunks not begun are dropped, and those begun end where they
    may stop. Before each chunk the work may stop. What is mapped within a chunk has one thread, and those idle by then.
    Edge cases: a single chunk is done on the calling thread.
    """
    count, chunks = _THREADS.get()(), iter(chunks)
    first = list(islice(chunks, 2)) if count > 1 else []
    if len(first) < 2:
        yield from map(function, in_turn(chain(first, chunks)))
        return
    from concurrent.futures import ThreadPoolExecutor

    waiting: deque[Future[R]] = deque()
    pool, share = ThreadPoolExecutor(count), _Share(count)
    try:
        for chunk in in_turn(chain(first, chunks)):
            share.begin()
            waiting.append(pool.submit(copy_context().run, _shared, share, function, chunk))
            if len(waiting) > count:
                yield _taken(waiting.popleft())
        while waiting:
            yield _taken(waiting.popleft())
    finally:
        share.dropped = True
        pool.shutdown(wait=True, cancel_futures=True)


def workers(count: int) -> int:
    """On how many threads something that shares so many things out by itself, as a search in a tree, may work: one for
    few of them."""
    return _THREADS.get()() if count > _FEW else 1


def _taken(future: Future[R]) -> R:
    """Its result; while it is waited for, the work may stop."""
    from concurrent.futures import wait

    while not future.done():
        may_stop()
        wait((future,), WAIT_S)
    return future.result()


class _Share:
    """How many threads of a pool are idle, and whether its work is dropped."""

    def __init__(self, count: int) -> None:
        self._count, self._begun, self._lock = count, 0, Lock()
        self.dropped = False

    def begin(self) -> None:
        with self._lock:
            self._begun += 1

    def end(self) -> None:
        with self._lock:
            self._begun -= 1

    def of_one(self) -> int:
        """On how many threads one of the chunks may work."""
        return 1 + max(self._count - self._begun, 0)

    def ask(self) -> None:
        """Ends a chunk whose result nobody takes."""
        if self.dropped:
            raise _DroppedError


class _DroppedError(Exception):
    """Nobody takes the result."""


def _shared(share: _Share, function: Callable[[T], R], chunk: T) -> R:
    token = _THREADS.set(share.of_one)
    try:
        with stopping(share.ask):
            return function(chunk)
    finally:
        _THREADS.reset(token)
        share.end()


def slices(count: int, size: int) -> list[slice]:
    """Slices of a size that cover so many things; the last one may be shorter."""
    return [slice(low, min(low + size, count)) for low in range(0, count, size)]


# Rows taken in blocks whose partners fit into memory, until the budget is used up.

FIRST_BLOCK, FASTER = 32, 8
"""Rows of the first block, at least: how many partners rows have is not known yet; and so many times as many rows as in
a block there may be in the next one."""

PARTNERS_AT_ONCE = 1 << 18
"""Partners of a block, about."""

PAIRS_OF_EACH = 1 << 14
"""The part of the budget's pairs that every row may have, if that is more in all: scenes of many lines have many."""


@dataclass(frozen=True, eq=False)
class Block(Generic[T]):
    """What was found for a block of rows; partners: how many were held in memory; close: how many of these called for
    close work."""

    found: T
    partners: int
    close: int


def in_blocks(rows: Ints, pairs: int, partners: int, look: Callable[[Ints], Block[T]]) -> tuple[list[T], int]:
    """What look finds for one block of rows (k,) after the other, and how many of the rows were looked at before more
    than the budget's pairs had called for close work. partners: no row has more."""
    found: list[T] = []
    done, size, close = 0, max(FIRST_BLOCK, min(PARTNERS_AT_ONCE, pairs) // max(partners, 1)), 0
    most = max(pairs, len(rows) * (pairs // PAIRS_OF_EACH))
    while done < len(rows) and close <= most:
        may_stop()
        block = look(rows[done : done + size])
        found.append(block.found)
        done = min(done + size, len(rows))
        close += block.close
        # The next block may have more partners than this one had: it grows slowly.
        size = max(1, min(FASTER * size, int(size * min(PARTNERS_AT_ONCE, most) / max(block.partners, 1))))
    return found, done
