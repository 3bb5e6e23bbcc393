"""``vectorplot info``: what a file holds."""

from __future__ import annotations

import click

from vectorplot.cli.option_values import upwards
from vectorplot.cli.picture import reported_warnings
from vectorplot.errors import printable


@click.command(short_help="Say what a scene or mesh file holds.")
@click.argument("files", type=click.Path(), nargs=-1, required=True, metavar="FILE...")
@click.option("--up", type=upwards, metavar="X,Y,Z", help="What is upwards, or x, y, z: sizes are of what stands so.")
@click.option("--quiet", "-q", is_flag=True, help="No warnings.")
def info(files: tuple[str, ...], up: tuple[float, float, float] | None, quiet: bool) -> None:
    """Say what the files hold: counts, whether it is closed and convex, its size, and what is wrong with it."""
    from vectorplot.io.description import describe
    from vectorplot.io.mesh_file import stood_up
    from vectorplot.io.read_file import read_named
    from vectorplot.scene.scene import together

    with reported_warnings(quiet=quiet):
        scene = together([read_named(file) for file in files])
        lines = describe(scene if up is None else stood_up(scene, up))
    click.echo("\n".join(map(printable, lines)))
