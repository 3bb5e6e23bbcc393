"""``vectorplot try``: the interactive program, as a local web page."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from vectorplot.cli.many import check_out
from vectorplot.cli.option_values import between
from vectorplot.cli.picture import check_place, progress_bar, reported_warnings

if TYPE_CHECKING:
    from vectorplot.pictures.film import Film
    from vectorplot.scene.scene import Scene


PAGE_SHOWN_OPTIONS = (
    click.option("--no-browser", is_flag=True, help="Print the address and open no browser."),
    click.option("--timeout", type=between(0.0, 1e6), metavar="S", help="Stop after so many seconds."),
)
"""Of what shows a page."""


@click.command("try", short_help="Look at a scene from all sides, in a local web page.")
@click.argument("scene_file", type=click.Path(), metavar="SCENE")
@click.option("-a", "--animation", metavar="FILE", help="Play it in the page: a file, or a name in the folder anim.")
@click.option(
    "-v",
    "--video",
    metavar="NAME",
    help="Where recordings go: NAME.vd1 and NAME.vd2 in the folder video, or an .mp4, .svg, .pdf; with -a: record it.",
)
@click.option(
    "--sketch-timeout",
    type=between(0.1, 1e6),
    default=30.0,
    metavar="S",
    help="A sketch may take so many seconds each time.  [default: 30]",
)
@PAGE_SHOWN_OPTIONS[0]
@PAGE_SHOWN_OPTIONS[1]
def try_(
    scene_file: str,
    animation: str | None,
    video: str | None,
    sketch_timeout: float,
    no_browser: bool,
    timeout: float | None,
) -> None:
    """Show SCENE, any file that draw takes, in a web page on this machine: turned by mouse and keys, drawn with exact
    hidden lines, painted or shaded, edited beside its picture, and saved as PS, SVG, PDF, DXF or PNG.

    SCENE may be a sketch, a Python file with a function sketch: it is run whenever the file changes, and the page has a
    slider for each parameter of the function.

    A file without a folder is looked for in the current one, then in data/, then among the samples that came with
    vectorplot; its suffix .scene may be left out.
    An animation moves it there, frame by frame; together with -v it becomes a movie, and no page is shown. Key v in the
    page records what one does there.
    Ctrl-C stops it, and q in the page.
    """
    if Path(scene_file).suffix.lower() == ".py":
        if animation is not None or video is not None:
            raise click.UsageError("a sketch has no animation: --animation and --video do not go with it")
        _try_sketch(Path(scene_file), sketch_timeout, no_browser, timeout)
        return
    from vectorplot.io.named_files import data_file
    from vectorplot.viewer.pictures import Source

    file = None if video is None else _file(video)
    source = Source(Path(data_file(scene_file)))
    film = None if animation is None else _film(animation)
    if film is not None:
        # What is wrong with it is said before any page is shown.
        first = film(source.scene(None))
        if file is not None:
            with reported_warnings(quiet=False), progress_bar(quiet=False) as progress:
                file.parent.mkdir(exist_ok=True)
                first.save(file, progress=progress)
            return
    check_viewer("try")
    import asyncio

    from vectorplot.viewer.answers import Answers
    from vectorplot.viewer.server import serve

    source.scene(None)

    asyncio.run(serve(Answers(source, film, file), partial(show_address, no_browser=no_browser), timeout))


def _try_sketch(path: Path, each_s: float, no_browser: bool, timeout: float | None) -> None:
    """Show what a sketch draws. Errors: InputError where there is no such file."""
    from vectorplot.errors import InputError

    if not path.is_file():
        raise InputError("there is no such file", file=str(path))
    check_viewer("try")
    import asyncio

    from vectorplot.viewer.server import serve_sketch
    from vectorplot.viewer.sketches import Sketch

    asyncio.run(serve_sketch(Sketch(path, each_s), partial(show_address, no_browser=no_browser), timeout))


def check_viewer(what: str) -> None:
    """Errors: InputError where what serves pages is not installed; said before any work."""
    from vectorplot.errors import not_installed

    try:
        import aiohttp  # noqa: F401
    except ImportError:
        raise not_installed(what, "aiohttp", "viewer") from None


def show_address(address: str, *, no_browser: bool) -> None:
    """Say where a page is served, and open it in a browser unless there shall be none."""
    import webbrowser

    click.echo(address)
    if not no_browser:
        webbrowser.open(address)


def _film(animation: str) -> Callable[[Scene], Film]:
    """What an animation, found as the book has it, makes of a scene."""
    from vectorplot.animation.animation_file import read_animation
    from vectorplot.io.named_files import animation_file
    from vectorplot.pictures.film import animate

    path = animation_file(animation)
    return lambda scene: animate(read_animation(path, scene))


def _file(video: str) -> Path:
    """The file of a movie: one with a suffix of its own, or as the book has it. Bad usage for other suffixes, and an
    OSError where nothing can be written there."""
    from vectorplot.io.named_files import VIDEOS, movie_to_write
    from vectorplot.save_frames import MOVIES, ONE_FILE

    suffix = Path(video).suffix[1:].lower()
    if suffix in ONE_FILE:
        check_out(video, None)
        return Path(video)
    name = movie_to_write(video[: -len(suffix) - 1] if suffix in MOVIES else video)
    check_place(os.fspath(name) if name.parent != VIDEOS else os.fspath(VIDEOS))
    return name.with_name(f"{name.name}.vd1")
