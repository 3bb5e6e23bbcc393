"""``vectorplot try``: the interactive program, as a local web page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from vectorplot.cli.films.frames import write_frames
from vectorplot.cli.options import between
from vectorplot.cli.progress import progress_bar, told_warnings

if TYPE_CHECKING:
    from vectorplot.film import Film
    from vectorplot.scene.scene import Scene

MISSING = "try needs aiohttp: pip install 'vectorplot[viewer]'"


@click.command("try", short_help="Look at a scene from all sides, in a local web page.")
@click.argument("scene_file", type=click.Path(), metavar="SCENE")
@click.option("-a", "--animation", metavar="FILE", help="Play it in the page: a file, or a name in the folder anim.")
@click.option(
    "-v", "--video", metavar="NAME", help="With -a: record NAME.vd1 and NAME.vd2, in the folder video, and end."
)
@click.option("--no-browser", is_flag=True, help="Print the address and open no browser.")
@click.option("--timeout", type=between(0.0, 1e6), metavar="S", help="Stop after so many seconds.")
def try_(scene_file: str, animation: str | None, video: str | None, no_browser: bool, timeout: float | None) -> None:
    """Show SCENE, any file that draw takes, in a web page on this machine: turned by mouse and keys, drawn with exact
    hidden lines, painted or shaded, edited beside its picture, and saved as PS, SVG, PDF, DXF or PNG.

    A file without a folder is looked for in the current one and then in data/; its suffix .scene may be left out.
    An animation moves it there, frame by frame; together with -v it becomes a movie, and no page is shown.
    Ctrl-C stops it, and q in the page.
    """
    from vectorplot.animation.folders import data_file
    from vectorplot.errors import InputError
    from vectorplot.viewer.sources import Source

    if video is not None and animation is None:
        raise click.UsageError("-v records what an animation moves: give -a FILE too")
    source = Source(Path(data_file(scene_file)))
    film = None if animation is None else _film(animation, source.scene(None))
    if video is not None and film is not None:
        with told_warnings(quiet=False), progress_bar(quiet=False) as progress:
            write_frames(film, len(film), None, video, film.fps, None, progress)
        return
    try:
        import aiohttp  # noqa: F401  # what is missing is said before any work
    except ImportError:
        raise InputError(MISSING) from None
    import asyncio
    import webbrowser

    from vectorplot.viewer.answers import Answers
    from vectorplot.viewer.server import serve

    source.scene(None)

    def started(address: str) -> None:
        click.echo(address)
        if not no_browser:
            webbrowser.open(address)

    asyncio.run(serve(Answers(source, film), started, timeout))


def _film(animation: str, scene: Scene) -> Film:
    """The film of an animation, found as the book has it, of a scene."""
    from vectorplot.animate import animate
    from vectorplot.animation.animation_file import read_animation
    from vectorplot.animation.folders import animation_file

    return animate(read_animation(animation_file(animation), scene))
