"""Pictures that are being made: of each page the latest wins, and what nobody waits for any more stops."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TypeVar

Made = TypeVar("Made")

MOST_PAGES = 64
"""Of more pages that are open at once the jobs wait for those of others."""


class SupersededError(Exception):
    """The page has asked for something newer, or the program ends."""


@dataclass(eq=False)
class Job:
    """Work of one page; progress is handed to the verbs, which stop where it raises SupersededError."""

    stopped: threading.Event = field(default_factory=threading.Event)

    def progress(self, stage: str, fraction: float) -> None:
        """Let the work go on, or stop it."""
        if self.stopped.is_set():
            raise SupersededError(stage)


class Jobs:
    """A thread that makes pictures, one after the other."""

    def __init__(self) -> None:
        self.latest: dict[str, Job] = {}
        self.pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="picture")
        self.running: set[Future[object]] = set()

    async def run(self, page: str, work: Callable[[Job], Made]) -> Made:
        """What the work makes. Errors: SupersededError where the page asks for something newer first."""
        if page not in self.latest and len(self.latest) >= MOST_PAGES:
            page = next(iter(self.latest))
        before = self.latest.pop(page, None)
        if before is not None:
            before.stopped.set()
        job = Job()
        self.latest[page] = job

        def working() -> Made:
            job.progress("begin", 0.0)
            return work(job)

        try:
            return await asyncio.get_running_loop().run_in_executor(self.pool, working)
        finally:
            # Also where nobody waits any more because the page has gone.
            job.stopped.set()
            if self.latest.get(page) is job:
                del self.latest[page]

    def close(self) -> None:
        """Stop all work; waits for what is running to notice."""
        for job in self.latest.values():
            job.stopped.set()
        self.pool.shutdown(wait=True, cancel_futures=True)
