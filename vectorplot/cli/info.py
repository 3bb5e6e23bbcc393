"""``vectorplot info``: what a file holds."""

from __future__ import annotations

import click

from vectorplot.cli.progress import told_warnings
from vectorplot.errors import printable


@click.command(short_help="Say what a scene or mesh file holds.")
@click.argument("file", type=click.Path(), metavar="FILE")
@click.option("--quiet", "-q", is_flag=True, help="No warnings.")
def info(file: str, quiet: bool) -> None:
    """Say what FILE holds: counts, whether it is closed and convex, its size, and what is wrong with it."""
    from vectorplot.io.description import describe
    from vectorplot.io.read_file import read

    with told_warnings(quiet=quiet):
        lines = describe(read(file))
    click.echo("\n".join(map(printable, lines)))
