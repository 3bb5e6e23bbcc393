"""``vectorplot try``: the interactive program, as a local web page."""

from __future__ import annotations

from pathlib import Path

import click

from vectorplot.cli.options import between

MISSING = "try needs aiohttp: pip install 'vectorplot[viewer]'"


@click.command("try", short_help="Look at a scene from all sides, in a local web page.")
@click.argument("scene_file", type=click.Path(), metavar="SCENE")
@click.option("--no-browser", is_flag=True, help="Print the address and open no browser.")
@click.option("--timeout", type=between(0.0, 1e6), metavar="S", help="Stop after so many seconds.")
def try_(scene_file: str, no_browser: bool, timeout: float | None) -> None:
    """Show SCENE, any file that draw takes, in a web page on this machine: turned by mouse and keys, drawn with exact
    hidden lines, painted or shaded, edited beside its picture, and saved as PS, SVG, PDF, DXF or PNG.

    A file without a folder is looked for in the current one and then in data/; its suffix .scene may be left out.
    Ctrl-C stops it, and q in the page.
    """
    from vectorplot.animation.folders import data_file
    from vectorplot.errors import InputError
    from vectorplot.viewer.sources import Source

    source = Source(Path(data_file(scene_file)))
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

    asyncio.run(serve(Answers(source), started, timeout))
