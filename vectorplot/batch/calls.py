"""The engine: calls on an executor, few at a time, and again where a worker is lost."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass, replace
from queue import SimpleQueue
from typing import Any, Generic, Protocol, TypeVar

from vectorplot.errors import InputError

Key = TypeVar("Key")
Value = TypeVar("Value")

IN_COMPANY, ALONE = 2, 1
"""How often a call is made again beside others, and then alone, after its worker was lost."""

NOTHING_WORKS = 3
"""After so many calls in a row that no worker survived, the workers are at fault."""


class Submits(Protocol):
    """What takes calls, as the executors of `concurrent.futures` do, of this room, and of others' clusters.

    Notes
    -----
    What it raises in place of an answer is taken for the loss of a worker.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from vectorplot.batch import Submits
    >>> def seven(executor: Submits) -> int:
    ...     return executor.submit(len, "letters").result()
    >>> with ThreadPoolExecutor(1) as executor:
    ...     seven(executor)
    7
    """

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The answer to a call, which comes later.

        Parameters
        ----------
        fn : callable
            What is called.
        args, kwargs : Any
            What it is given.

        Returns
        -------
        Future
            Of `concurrent.futures`.

        Examples
        --------
        >>> from vectorplot.batch import Here
        >>> Here().submit(len, "letters").done()
        True
        """
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
    """The answers to calls as they come, each with its key; no more than window calls are under way at any time.

    The calls raise nothing: what an executor raises in their place is the loss of a worker. As a lost worker may take
    others' calls with it, who was there at too many losses is asked alone. Where this is left early, calls that have
    not begun are cancelled.
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
