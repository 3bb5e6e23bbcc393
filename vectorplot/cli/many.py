"""Pictures of many files into a folder: the options for workers, the input files, and the names of the output."""

from __future__ import annotations

import os
import pickle
import re
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import click

from vectorplot.cli.option_values import OptionGroup, exclusive
from vectorplot.cli.picture import WARNINGS, Progress, check_place, progress_bar
from vectorplot.errors import InputError

if TYPE_CHECKING:
    from vectorplot.batch.running import Outcome
    from vectorplot.batch.tasks import Submits, Task
    from vectorplot.save_frames import Picture


# Options that say who makes many pictures, and what is said while they are made.

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
class WorkerOptions(OptionGroup):
    """Who makes the pictures: so many processes, the workers of a cluster, or this process where both are None."""

    workers: int | None = None
    cluster: str | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Self:
        """What a command with WORKER_OPTIONS was told. Bad usage for both options at once."""
        exclusive([("--workers", options["workers"]), ("--cluster", options["cluster"])])
        return super().of(options)

    @property
    def given(self) -> bool:
        """Whether the user said anything."""
        return self.workers is not None or self.cluster is not None

    @contextmanager
    def executor(self) -> Iterator[tuple[Submits, int]]:
        """Who does the work, and how many tasks are with them at once."""
        from vectorplot.batch.running import WINDOW
        from vectorplot.batch.tasks import Here, Processes, cluster

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


# A picture of each of many files, into a folder.

NO_MATTER = ("scene_file", "out", "jobs", "quiet", "explain", "workers", "cluster")
"""Parameters on which the bytes of a picture do not depend, beside what it shows."""

_PICKLE = 5
"""The protocol in which options are compared with those of a run before: any one, but always the same."""

_QUOTED = re.compile(r'"([^"\r\n]{1,1000})"')


class PictureVerb(click.Command):
    """A command that makes pictures; content: the bytes of one, for the values of its parameters; made: the picture
    itself."""

    content: Callable[[Mapping[str, Any]], bytes]
    made: Callable[[Mapping[str, Any]], Any]


def is_folder(out: str) -> bool:
    """Whether a name is that of a folder: it ends in a slash, or there is one of a name without a suffix."""
    return out.endswith(("/", os.sep)) or (out != "-" and not Path(out).suffix and Path(out).is_dir())


def make_pictures(
    verb: str, params: Mapping[str, Any], formats: Sequence[str], check: Callable[[Mapping[str, Any]], object]
) -> None:
    """A picture of each input, in the folder of ``out``; check: what finds bad usage in the parameters of one picture.

    Errors: InputError, after all others are made, where one could not be.
    """
    if params["explain"]:
        raise click.UsageError("--explain is of one picture: OUT must be a file")
    if params.get("text") == "latex":
        raise click.UsageError("--text latex is of one picture: OUT must be a file")
    workers = WorkerOptions.of(params)
    written = params["format_"] or formats[0]
    # Workers are as many as there is room for: threads of theirs would only be in each other's way.
    jobs = params["jobs"] or (1 if workers.given else None)
    outs = out_names(inputs_of(params["scene_file"]), Path(params["out"]), written)
    each = {**params, "format_": written, "jobs": jobs, "quiet": True}
    for source, out in list(outs.items())[:1]:
        check({**each, "scene_file": (source,), "out": out})
    check_place(os.fspath(Path(params["out"])))
    workers.run(_tasks(verb, each, outs), len(outs), "pictures", quiet=params["quiet"])


def inputs_of(named: Sequence[str]) -> tuple[str, ...]:
    """The files that are named, and in place of a folder those in it that hold shapes, by name; each once. Bad usage
    for standard input, which can be read once."""
    if "-" in named:
        raise click.UsageError("standard input is of one picture, not of many")
    found: dict[str, None] = {}
    for name in named:
        if Path(name).is_dir():
            inside = sorted(os.fspath(path) for path in Path(name).iterdir() if path.is_file() and _holds_shapes(path))
            if not inside:
                raise click.UsageError(f"{name}: no file in it is a scene, mesh, molecule or terrain")
            found.update(dict.fromkeys(inside))
        else:
            found[name] = None
    return tuple(found)


def _holds_shapes(path: Path) -> bool:
    from vectorplot.io.named_files import CAD_SUFFIXES
    from vectorplot.io.read_file import MOLECULE_SUFFIXES, TERRAIN_SUFFIXES
    from vectorplot.io.read_mesh import MESH_SUFFIXES

    return path.suffix.lower() in (".scene", *MESH_SUFFIXES, *CAD_SUFFIXES, *MOLECULE_SUFFIXES, *TERRAIN_SUFFIXES)


def out_names(inputs: Sequence[str], folder: Path, format_: str) -> dict[str, str]:
    """The picture of each input: its name with the suffix of the format, after its own suffix where others are called
    the same. Bad usage for inputs that cannot be told apart."""
    stems = Counter(Path(name).stem for name in inputs)
    outs = {
        name: os.fspath(folder / f"{Path(name).stem if stems[Path(name).stem] == 1 else Path(name).name}.{format_}")
        for name in inputs
    }
    owners: dict[str, str] = {}
    for name, out in outs.items():
        if owners.setdefault(out, name) != name:
            raise click.UsageError(f"{owners[out]} and {name} would both become {out}")
    return outs


def _tasks(verb: str, params: Mapping[str, Any], outs: Mapping[str, str]) -> Iterator[Task]:
    from vectorplot.batch.tasks import Task, fingerprint
    from vectorplot.io.named_files import data_file_or_name

    same = {name: value for name, value in sorted(params.items()) if name not in NO_MATTER}
    # Two that are pickled alike are alike; at worst, one that has not changed is made again.
    said = pickle.dumps(same, _PICKLE).hex()
    for source, out in outs.items():
        files = files_of((data_file_or_name(source), *(value for value in same.values() if isinstance(value, str))))
        try:
            known = fingerprint(verb, source, said, files=files)
        except OSError:
            known = ""
        content = partial(picture_content, verb, {**params, "scene_file": (source,), "out": out})
        yield Task(out, content, known)


def files_of(names: Sequence[str]) -> tuple[Path, ...]:
    """Those of the names that are files, and all files that the texts among them name in quotes; the files' own places
    are where these names begin."""
    from vectorplot.io.named_files import CAD_SUFFIXES
    from vectorplot.io.read_mesh import MESH_SUFFIXES

    found: dict[Path, None] = {}
    waiting = [Path(name) for name in names]
    while waiting:
        path = waiting.pop(0)
        try:
            if path in found or not path.is_file():
                continue
            found[path] = None
            if path.suffix.lower() not in (*MESH_SUFFIXES, *CAD_SUFFIXES):
                text = path.read_text(encoding="utf-8", errors="replace")
                waiting += [path.parent / name for name in dict.fromkeys(_QUOTED.findall(text))]
        except (OSError, ValueError):
            continue
    return tuple(found)


def picture_content(verb: str, params: Mapping[str, Any]) -> bytes:
    """What a worker does: a picture for the values of a command's parameters, as the content of a file."""
    content: bytes = _by_command(verb, params, lambda command: command.content)
    return content


def picture_of(verb: str, params: Mapping[str, Any]) -> Any:
    """The same, the drawing or image itself."""
    return _by_command(verb, params, lambda command: command.made)


def _by_command(
    verb: str, params: Mapping[str, Any], what: Callable[[PictureVerb], Callable[[Mapping[str, Any]], Any]]
) -> Any:
    command: PictureVerb = getattr(import_module(f"vectorplot.cli.commands.{verb}"), verb)
    context = click.Context(command, info_name=verb)
    context.params = dict(params)
    try:
        with context:
            return what(command)(params)
    except click.UsageError as error:
        # Of options that what is in the file has no use for.
        raise InputError(error.format_message()) from None


# What the commands that make frames share: where they go, and what is said while they are made.

FRAME_FORMATS = ("svg", "png", "pdf", "ps", "eps", "tex", "dxf", "json")
"""What single frames in a folder may be."""

FRAMES_OUT = click.option(
    "-o",
    "--out",
    "frames_out",
    type=click.Path(),
    metavar="OUT",
    help="Pages of a .pdf, a moving .svg, a video (.mp4, .webm, .gif), or a folder for single frames, FOLDER/.",
)

FRAME_FORMAT = click.option(
    "--format", "frame_format", type=click.Choice(FRAME_FORMATS), help="Of single frames.  [default: svg or png]"
)

FPS = click.option("--fps", type=float, metavar="N", help="Frames a second.  [default: that of the film]")


def check_out(out: str | None, format_: str | None) -> None:
    """Bad usage, or an OSError, before the work, where frames cannot go where they are told to."""
    from vectorplot.save_frames import VIDEOS, kind_of

    if out is None:
        return
    try:
        kind = kind_of(out)
    except InputError as error:
        raise click.UsageError(str(error)) from None
    if format_ is not None and kind != "folder":
        raise click.UsageError("--format is that of single frames: OUT must be a folder, FOLDER/")
    if kind in VIDEOS:
        from vectorplot.backends.video import library

        library()
    elif kind == "pdf":
        from vectorplot.save import backend

        backend(kind)
    check_place(os.fspath(Path(out)))


def is_sequence(out: str | None) -> bool:
    """Whether frames become files of their own in a folder."""
    from vectorplot.save_frames import kind_of

    return out is not None and kind_of(out) == "folder"


def write_frames(
    pictures: Iterable[Picture],
    count: int,
    out: str | None,
    movie: str | None,
    fps: float,
    format_: str | None,
    progress: Progress | None,
) -> None:
    """Write so many frames: to OUT, as a movie of polygons of this name, or both; each is made once.

    Of pixels there is no such movie.
    """
    from vectorplot.io.named_files import VIDEOS, movie_to_write
    from vectorplot.save_frames import recorded, save_frames, told

    frames = told(pictures, count, progress)
    if movie is not None:
        name = movie_to_write(movie)
        check_place(os.fspath(name) if name.parent != VIDEOS else os.fspath(VIDEOS))
        if name.parent == VIDEOS:
            VIDEOS.mkdir(exist_ok=True)
        frames = recorded(frames, name)
    if out is not None:
        save_frames(frames, out, fps=fps, format=format_)
    else:
        deque(frames, maxlen=0)
