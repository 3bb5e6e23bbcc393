"""Options that say who makes many pictures, and what is said while they are made."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import exclusive
from vectorplot.cli.progress import WARNINGS, progress_bar
from vectorplot.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vectorplot.batch.calls import Submits
    from vectorplot.batch.running import Outcome
    from vectorplot.batch.tasks import Task
    from vectorplot.cli.progress import Progress

FOR_EACH = 2
"""Tasks that are with the executor at once for each worker: while one is made, the next one is on its way."""

WORKER_OPTIONS = (
    click.option(
        "--workers",
        type=click.IntRange(1),
        metavar="N",
        help="Processes that make pictures into a folder.  [default: this one]",
    ),
    click.option(
        "--cluster",
        metavar="ADDRESS",
        help="Or the workers of a Dask cluster: its scheduler, as tcp://host:8786.",
    ),
)


@dataclass(frozen=True)
class WorkerOptions:
    """Who makes the pictures: so many processes, the workers of a cluster, or this process where both are None."""

    workers: int | None = None
    cluster: str | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> WorkerOptions:
        """What a command with WORKER_OPTIONS was told. Bad usage for both options at once."""
        exclusive([("--workers", options["workers"]), ("--cluster", options["cluster"])])
        return cls(**{field.name: options[field.name] for field in fields(cls)})

    @property
    def given(self) -> bool:
        """Whether the user said anything."""
        return self.workers is not None or self.cluster is not None

    @contextmanager
    def executor(self) -> Iterator[tuple[Submits, int]]:
        """Who does the work, and how many tasks are with them at once."""
        from vectorplot.batch.executors import Here, Processes, cluster
        from vectorplot.batch.running import WINDOW

        if self.cluster is not None:
            with cluster(self.cluster) as executor:
                yield executor, WINDOW
        elif self.workers is not None:
            with Processes(self.workers) as executor:
                yield executor, FOR_EACH * self.workers
        else:
            yield Here(), 1

    def run(self, tasks: Iterable[Task], count: int, what: str, *, quiet: bool) -> None:
        """Make so many files; a line on stderr for each that fails, and for warnings.

        Errors: InputError, after all others are done, where one failed.
        """
        from vectorplot.batch.running import run

        with progress_bar(quiet=quiet) as progress, self.executor() as (executor, window):
            tally = run(tasks, executor, window=window, tell=_teller(count, what, progress, quiet=quiet))
        if tally.failed:
            raise InputError(f"{tally.failed} of {tally.count} {what} failed")


def _teller(count: int, what: str, progress: Progress | None, *, quiet: bool) -> Callable[[Outcome], None]:
    """What is said of each outcome: of failures the first, and of warnings, each of which is said once."""
    warned: dict[str, None] = {}
    done = {"written": 0, "kept": 0, "failed": 0}

    def tell(outcome: Outcome) -> None:
        done[outcome.state] += 1
        if outcome.state == "failed" and done["failed"] <= WARNINGS:
            click.echo(f"vectorplot: {outcome.path}: {outcome.cause}", err=True)
        for line in () if quiet else outcome.warnings:
            if line not in warned and len(warned) < WARNINGS:
                warned[line] = None
                click.echo(f"vectorplot: warning: {line}", err=True)
        if progress is not None:
            progress(f"{what} {sum(done.values())} of {count}", sum(done.values()) / max(count, 1))

    return tell
