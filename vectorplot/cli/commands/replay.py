"""``vectorplot replay``: a movie of polygons becomes frames again."""

from __future__ import annotations

import asyncio
from functools import partial

import click

from vectorplot.cli.commands.try_ import PAGE_SHOWN_OPTIONS, check_viewer, show_address
from vectorplot.cli.many import FPS, FRAME_FORMAT, FRAMES_OUT, check_out, write_frames
from vectorplot.cli.option_values import chosen
from vectorplot.cli.options import QUIET, with_options
from vectorplot.cli.picture import progress_bar, reported_warnings


@click.command(short_help="Replay a movie of polygons.")
@with_options(
    click.argument("name", metavar="NAME"),
    FRAMES_OUT,
    FPS,
    FRAME_FORMAT,
    click.option(
        "--width", type=click.FloatRange(1.0), default=160.0, metavar="MM", help="Of the page.  [default: 160]"
    ),
    *PAGE_SHOWN_OPTIONS,
    QUIET,
)
def replay(
    name: str,
    frames_out: str | None,
    fps: float | None,
    frame_format: str | None,
    width: float,
    no_browser: bool,
    timeout: float | None,
    quiet: bool,
) -> None:
    """Show the movie NAME.vd1 and NAME.vd2, from the current folder, the folders video and data, or the samples
    that came with vectorplot, in a web page on this machine, again and again, with a pause and a slider of frames,
    and say what it holds; or write its frames to OUT. Ctrl-C stops it."""
    from vectorplot.animation.movies import FPS as USUAL
    from vectorplot.animation.movies import frame_drawings, read_movie
    from vectorplot.io.named_files import movie_to_read

    check_out(frames_out, frame_format)
    with reported_warnings(quiet=quiet), progress_bar(quiet=quiet) as progress:
        movie = read_movie(movie_to_read(name))
        pictures = frame_drawings(movie, width)
        if frames_out is None:
            click.echo(str(movie))
            check_viewer("replay without -o")
            from vectorplot.save_frames import write_frames as written
            from vectorplot.viewer.server import serve_film

            rate = chosen(fps, USUAL)
            shown, started = written(pictures, "svg", rate), partial(show_address, no_browser=no_browser)
            asyncio.run(serve_film(shown, name, len(movie), rate, started, timeout))
            return
        write_frames(pictures, len(movie), frames_out, None, chosen(fps, USUAL), frame_format, progress)
