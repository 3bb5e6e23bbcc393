"""``vectorplot info``: what a file holds."""

from __future__ import annotations

import click

from vectorplot.cli.progress import told_warnings
from vectorplot.errors import printable


@click.command(short_help="Say what a scene or mesh file holds.")
@click.argument("files", type=click.Path(), nargs=-1, required=True, metavar="FILE...")
@click.option("--quiet", "-q", is_flag=True, help="No warnings.")
def info(files: tuple[str, ...], quiet: bool) -> None:
    """Say what the files hold: counts, whether it is closed and convex, its size, and what is wrong with it."""
    from vectorplot.io.description import describe
    from vectorplot.io.read_file import read
    from vectorplot.scene.naming.joined_scenes import together

    with told_warnings(quiet=quiet):
        lines = describe(together([read(file) for file in files]))
    click.echo("\n".join(map(printable, lines)))
