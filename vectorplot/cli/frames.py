"""What the commands that make frames share: where they go, and what is said while they are made."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from vectorplot.cli.picture import Progress, check_place

if TYPE_CHECKING:
    from vectorplot.save_frames import Picture


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
    from vectorplot.errors import InputError
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
