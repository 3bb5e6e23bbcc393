"""What the commands that make pictures share: read, make, write, and say what it cost."""

from __future__ import annotations

import errno
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vectorplot.errors import InputError, InputWarning

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.pictures.pipeline import StageReport
    from vectorplot.scene.scene import Scene
    from vectorplot.shading.image import Image


# What the command says on stderr while it works, and afterwards.

PATIENCE_S = 0.5
"""Work shorter than this shows no bar."""

INTERVAL_S = 0.05
"""The bar moves no more often than this."""

WARNINGS = 50
"""So many warnings are printed, the others counted."""


class Progress:
    """A progress bar that appears when the work takes long; call it with a stage and the fraction done, 0 to 1."""

    def __init__(self) -> None:
        self.shown = time.perf_counter() + PATIENCE_S - INTERVAL_S
        self.bar: Any = None

    def __call__(self, stage: str, fraction: float) -> None:
        """Show the stage and how far it has come."""
        now = time.perf_counter()
        if now < self.shown + INTERVAL_S:
            return
        self.shown = now
        if self.bar is None:
            from tqdm import tqdm

            shape = "{desc} {percentage:3.0f}%|{bar}| {elapsed}"
            self.bar = tqdm(total=1.0, file=sys.stderr, leave=False, bar_format=shape)
        self.bar.set_description_str(stage, refresh=False)
        self.bar.n = min(max(fraction, 0.0), 1.0)
        self.bar.refresh()

    def close(self) -> None:
        """Take the bar away."""
        if self.bar is not None:
            self.bar.close()


@contextmanager
def progress_bar(*, quiet: bool) -> Iterator[Progress | None]:
    """A progress bar on a terminal; None where stderr is no terminal or the user wants silence."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    bar = Progress()
    try:
        yield bar
    finally:
        bar.close()


@contextmanager
def reported_warnings(*, quiet: bool) -> Iterator[None]:
    """Print every InputWarning of the work, up to WARNINGS of them, as one line on stderr, after the work.

    Work that fails says why in one line, and nothing else.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        yield
    if quiet:
        return
    lines = dict.fromkeys(str(entry.message) for entry in caught if issubclass(entry.category, InputWarning))
    for line in islice(lines, WARNINGS):
        click.echo(f"vectorplot: warning: {line}", err=True)
    if len(lines) > WARNINGS:
        click.echo(f"vectorplot: warning: {len(lines) - WARNINGS} more like these", err=True)


def table(reports: Sequence[StageReport]) -> str:
    """What the stages cost, a line each: time, how much came out, the process's peak memory by then, how far off what
    they approximate was measured to be, and why they ran."""
    from vectorplot.pictures.pipeline import ERROR_WIDTH, STAGE_NAME

    head = f"{'stage':<{STAGE_NAME}}  {'ms':>9}  {'count':>9}  {'peak MB':>8}  {'off by':<{ERROR_WIDTH}}  why"
    peak = max((report.peak_mb for report in reports), default=0.0)
    total = sum(report.seconds for report in reports if report.error is None)
    foot = f"{'total':<{STAGE_NAME}}  {1000.0 * total:9.1f}  {'':>9}  {peak:8.1f}"
    return "\n".join([head, *map(str, with_errors(reports)), foot])


def with_errors(reports: Sequence[StageReport]) -> list[StageReport]:
    """A report for each stage, with what was measured of it later on; measuring is not part of its time."""
    found: list[StageReport] = []
    last: dict[str, int] = {}
    for report in reports:
        if report.error is None or report.name not in last:
            last[report.name] = len(found)
            found.append(report)
        else:
            stage = found[last[report.name]]
            found[last[report.name]] = replace(stage, error=report.error, unit=report.unit)
    return found


def summed(reports: Sequence[StageReport]) -> list[StageReport]:
    """The reports of many pictures as in one: times and counts together, of memory and errors the largest."""
    found: dict[tuple[str, bool], StageReport] = {}
    for one in reports:
        key = one.name, one.error is None
        before = found.get(key)
        if before is None:
            found[key] = one
            continue
        found[key] = replace(
            before,
            seconds=before.seconds + one.seconds,
            count=before.count + one.count,
            peak_mb=max(before.peak_mb, one.peak_mb),
            error=None if before.error is None or one.error is None else max(before.error, one.error),
        )
    return list(found.values())


AFTER_A_NAME = (": ", ", ", " and ")
"""What follows the name of an item that a message begins with."""


@dataclass(frozen=True)
class Report:
    """Whom a verb tells how far it is, and what each stage cost; None where nobody asked: then nothing is measured."""

    progress: Callable[[str, float], None] | None
    explain: Callable[[StageReport], None] | None


SILENT = Report(None, None)
"""Nobody is told anything."""


@contextmanager
def kept_promise(
    report: Report, keywords: Mapping[str, Any], *, strict: bool, quiet: bool
) -> Iterator[Callable[[StageReport], None] | None]:
    """Whom a verb tells what its stages cost. Afterwards what it reached is printed, where an error or a time was asked
    for. Errors: with strict, InputError where it could not be kept."""
    if keywords.get("off_by") is None and keywords.get("within") is None:
        yield report.explain
        return
    from vectorplot.pictures.promises import BROKEN, PROMISE

    reports: list[StageReport] = []

    def explain(entry: StageReport) -> None:
        reports.append(entry)
        if report.explain is not None:
            report.explain(entry)

    yield explain
    for entry in reports:
        if entry.name == BROKEN and strict:
            raise InputError(f"not kept: {entry.why}")
        if entry.name == PROMISE and not quiet and report is not SILENT:
            click.echo(f"vectorplot: {entry.why}", err=True)


@dataclass(frozen=True)
class Source:
    """The files that a picture is made of; exaggeration: of the heights of a terrain, None for the usual one; upright:
    the user has said where one looks from, or what is up; tolerance: of parts of CAD systems, parts: how they
    are drawn, and molecules: their style, as in vectorplot.read."""

    paths: tuple[str, ...]
    exaggeration: float | None = None
    upright: bool = False
    tolerance: float | None = None
    molecules: str | None = None
    parts: str | None = None

    @property
    def name(self) -> str:
        """What messages call them."""
        return ", ".join(self.paths)

    def read(self) -> Scene:
        """All that is in them; an InputWarning hints at files with y upwards."""
        from vectorplot.io.mesh_file import up_axis_hint
        from vectorplot.io.read_file import read_named
        from vectorplot.scene.scene import together

        reading = partial(
            read_named,
            exaggeration=self.exaggeration,
            tolerance=self.tolerance,
            molecules=self.molecules,
            parts=self.parts,
        )
        scenes = [reading(path) for path in self.paths]
        for path, scene in zip(self.paths, scenes, strict=True):
            told = None if self.upright else up_axis_hint(path, scene)
            if told is not None:
                warnings.warn(told, InputWarning, stacklevel=2)
        return together(scenes)


@dataclass(frozen=True)
class ReadSource(Source):
    """Files of which a scene was read already, or a part of it."""

    scene: Scene | None = None

    def read(self) -> Scene:
        """That scene."""
        assert self.scene is not None
        return self.scene


@dataclass(frozen=True)
class Companion:
    """A file beside a picture, such as what proves it: what it is, its name, and what makes its content from the scene
    and the picture."""

    what: str
    path: str
    content: Callable[[Scene, Drawing | Image], bytes]


def tiles_beside(params: Mapping[str, Any], format_: str) -> list[Companion]:
    """The sheets that a large page is cut into, a file each. Errors: bad usage for a picture that goes to stdout."""
    columns, rows = params["tiles"]
    out = Path(params["out"])
    if params["out"] == "-":
        raise click.UsageError("--tiles writes files beside OUT: OUT must be a file")

    def content(row: int, column: int, scene: Scene, made: Drawing | Image) -> bytes:
        from vectorplot.drawing.drawing import Drawing
        from vectorplot.drawing.tiles import tile
        from vectorplot.save import write

        assert isinstance(made, Drawing)
        return write(tile(made, columns, rows, row, column, tolerance_mm=params["tolerance_mm"]), format_)

    return [
        Companion("tiles", str(out.with_stem(f"{out.stem}-{row + 1}-{column + 1}")), partial(content, row, column))
        for row in range(rows)
        for column in range(columns)
    ]


def make_picture(
    source: Source,
    out: str,
    format_: str,
    picture: Callable[[Scene, Report], Drawing | Image],
    *,
    quiet: bool,
    explain: bool,
    jobs: int | None = None,
    overlaid: bool = False,
    beside: Sequence[Companion] = (),
) -> None:
    """Read a scene, make a picture of it and write that; nothing is written unless all of it succeeds.

    quiet: no warnings, no progress bar; explain: print what each stage cost; jobs: threads to read on, as many as
    processors where it is None; overlaid: texts are left to LaTeX, in a file beside OUT; beside: more files.
    """
    reports: list[StageReport] = []
    with reported_warnings(quiet=quiet):
        check_place(out)
        for companion in beside:
            check_place(companion.path)
        with progress_bar(quiet=quiet) as progress:
            report = Report(progress, reports.append if explain else None)
            contents = picture_contents(
                source, Path(out).name, format_, picture, report, jobs, overlaid=overlaid, beside=beside
            )
    # What is wrong with a picture is said before there is a file of it.
    if beside:
        own, others = contents[: -len(beside)], contents[-len(beside) :]
        write_out(out, *own, beside=dict(zip((companion.path for companion in beside), others, strict=True)))
    else:
        write_out(out, *contents)
    if explain:
        click.echo(table(reports), err=True)


def make_pages(
    sources: Sequence[Source],
    out: str,
    page: Callable[[int, Scene, Report], Drawing],
    *,
    quiet: bool,
    explain: bool,
) -> None:
    """Read scenes, draw a page of each, which is told its number from 0, and write them as one PDF; nothing is written
    unless all of it succeeds. quiet, explain: see make_picture.
    """
    from vectorplot.save_frames import write_frames

    reports: list[StageReport] = []
    with reported_warnings(quiet=quiet):
        check_place(out)
        with progress_bar(quiet=quiet) as progress:
            report = Report(progress, reports.append if explain else None)
            made = [_page(source, partial(page, number), report) for number, source in enumerate(sources)]
            contents = write_frames(made, "pdf", 1.0)
    write_out(out, contents)
    if explain:
        click.echo(table(reports), err=True)


def _page(source: Source, page: Callable[[Scene, Report], Drawing], report: Report) -> Drawing | Image:
    """The page of a scene; errors name its file."""
    try:
        return picture_made(source, page, report)
    except InputError as error:
        if error.file is not None:
            raise
        raise InputError(error.cause, file=source.name) from error


def picture_contents(
    source: Source,
    name: str,
    format_: str,
    picture: Callable[[Scene, Report], Drawing | Image],
    report: Report,
    jobs: int | None = None,
    *,
    overlaid: bool = False,
    beside: Sequence[Companion] = (),
) -> tuple[bytes, ...]:
    """Read a scene and make a picture of it: the content of its file, where texts are overlaid of theirs, and those of
    the files beside it; name: that of the picture's file."""
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.geometry.budget import threads_of
    from vectorplot.pictures.pipeline import Pipeline, Stage
    from vectorplot.save import write, write_for_latex

    stages = [Stage("read", source.name), Stage("write", f"as {format_}")]
    stages[1:1] = [Stage(companion.what, "asked for, in a file beside the picture") for companion in beside]
    pipeline = Pipeline(stages, report.explain, None, threads_of(jobs))
    scene = pipeline.run("read", source.read)
    with located(scene):
        made = picture(scene, report)
        more = [pipeline.run(companion.what, companion.content, scene, made) for companion in beside]
    if overlaid and isinstance(made, Drawing):
        return (*pipeline.run("write", write_for_latex, made, format_, name), *more)
    return (pipeline.run("write", write, made, format_), *more)


def picture_made(
    source: Source, picture: Callable[[Scene, Report], Drawing | Image], report: Report
) -> Drawing | Image:
    """Read a scene and make a picture of it."""
    scene = source.read()
    with located(scene):
        return picture(scene, report)


def warn_of_nothing(source: Source, made: Drawing | Image, why: Callable[[], str]) -> None:
    """An InputWarning for a picture that shows nothing; why: what says why."""
    if is_empty(made):
        warnings.warn(f"{source.name}: the picture is empty: {why()}", InputWarning, stacklevel=3)


@contextmanager
def located(scene: Scene) -> Iterator[None]:
    """In the errors and warnings of the work that begin with the name of an item: the file and the line it is in."""
    places = {item.name: item.place for item in scene.items if item.place is not None}

    def place_of(text: str) -> tuple[str, int] | None:
        named = [name for name in places if text.startswith(tuple(name + after for after in AFTER_A_NAME))]
        return places[max(named, key=len)] if named else None

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        try:
            yield
        except InputError as error:
            place = place_of(error.cause) if error.file is None else None
            if place is None:
                raise
            raise InputError(error.cause, file=place[0], line=place[1]) from error
    for entry in caught:
        text = str(entry.message)
        place = place_of(text)
        told = entry.message if place is None else InputWarning(f"{place[0]}:{place[1]}: {text}")
        warnings.warn_explicit(told, entry.category, entry.filename, entry.lineno)


def is_empty(made: Drawing | Image) -> bool:
    """Whether a picture shows nothing: no marks, or a single colour."""
    from vectorplot.shading.image import Image

    if isinstance(made, Image):
        return bool((made.pixels == made.pixels[0, 0]).all())
    return not any(len(mark) for layer in made.layers for mark in layer.marks)


def check_place(out: str) -> None:
    """An OSError before the work where there is no folder to write into."""
    folder = Path(out).parent
    if out != "-" and not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder))


def write_out(out: str, content: bytes, *letters: bytes, beside: Mapping[str, bytes] | None = None) -> None:
    """Write to a file, whole or not at all, or to stdout for ``-``; letters: to a .tex beside it, together with it;
    beside: other files, by their names, together with it too."""
    from vectorplot.save import write_together

    others: dict[str | os.PathLike[str], bytes] = {} if beside is None else {path: one for path, one in beside.items()}
    if out == "-":
        write_together(others)
        if sys.stdout is None:
            raise OSError(errno.EBADF, "standard output is closed")
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    write_together({out: content, **{Path(out).with_suffix(".tex"): one for one in letters}, **others})
