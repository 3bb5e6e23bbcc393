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
    """Work of one page; progress is handed to the verbs, which stop where it raises SupersededError.

    frames: how many are done, and how many there are, where it makes a movie; heard is told of each.
    """

    stopped: threading.Event = field(default_factory=threading.Event)
    frames: tuple[int, int] = (0, 0)
    heard: Callable[[int, int], None] | None = None

    def frame(self, done: int, count: int) -> None:
        """So many frames of so many are done."""
        self.frames = (done, count)
        if self.heard is not None:
            self.heard(done, count)

    def progress(self, stage: str, fraction: float) -> None:
        """Let the work go on, or stop it."""
        if self.stopped.is_set():
            raise SupersededError(stage)


class Jobs:
    """A thread that makes pictures, one after the other."""

    def __init__(self) -> None:
        self.latest: dict[str, Job] = {}
        self.lock = threading.Lock()
        self.pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="picture")

    def submit(
        self, page: str, work: Callable[[Job], Made], heard: Callable[[int, int], None] | None = None
    ) -> tuple[Job, Future[Made]]:
        """The job of a page's work, and what will come of it: SupersededError where it is stopped.

        What the page has asked for before is stopped. heard: is told how many frames are done.
        """
        job = Job(heard=heard)
        with self.lock:
            if page not in self.latest and len(self.latest) >= MOST_PAGES:
                page = next(iter(self.latest))
            before = self.latest.pop(page, None)
            self.latest[page] = job
        if before is not None:
            before.stopped.set()

        def working() -> Made:
            job.progress("begin", 0.0)
            return work(job)

        return job, self.pool.submit(working)

    async def run(self, page: str, work: Callable[[Job], Made]) -> Made:
        """What the work makes. Errors: SupersededError where the page asks for something newer first."""
        job, made = self.submit(page, work)
        try:
            return await asyncio.wrap_future(made)
        finally:
            self.end(job)

    def end(self, job: Job) -> None:
        """Stop a job that nobody waits for any more, because it is done or its page has gone."""
        job.stopped.set()
        with self.lock:
            self.latest = {page: other for page, other in self.latest.items() if other is not job}

    def close(self) -> None:
        """Stop all work; waits for what is running to notice."""
        for job in list(self.latest.values()):
            job.stopped.set()
        self.pool.shutdown(wait=True, cancel_futures=True)
