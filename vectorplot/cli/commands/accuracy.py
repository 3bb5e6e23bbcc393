"""``vectorplot accuracy``: what accuracy costs in time."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import click

from vectorplot.cli.option_values import numbers
from vectorplot.cli.picture import check_place, progress_bar

PLOTS = ("svg", "ps", "eps", "pdf", "png", "json")


@click.command(short_help="Measure what accuracy costs in time.", context_settings={"show_default": True})
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option("-o", "--out", type=click.Path(), metavar="DIR", help="Folder for table.csv, table.json and plots.")
@click.option("--format", "format_", type=click.Choice(PLOTS), default="svg", help="Format of the plots.")
@click.option("--values", type=numbers, metavar="X,...", help="Values of the knob, from coarse to fine.")
@click.option("--list", "listing", is_flag=True, help="List the names; nothing is measured.")
@click.option("-q", "--quiet", is_flag=True, help="No progress bar.")
def accuracy(
    names: tuple[str, ...], out: str | None, format_: str, values: tuple[float, ...] | None, listing: bool, quiet: bool
) -> None:
    """Measure the error of every approximation of the package over its knob, and the time it takes, beside the exact or
    the finest result; or of those with a NAME.

    All together takes about half a minute. Errors are the same on every run; seconds are those of the processor, on one
    thread.
    """
    from vectorplot.accuracy.results import as_text, listed
    from vectorplot.accuracy.verb import APPROXIMATIONS
    from vectorplot.accuracy.verb import accuracy as measure

    if listing:
        click.echo(listed(APPROXIMATIONS))
        return
    if out is not None:
        check_folder(out)
    with progress_bar(quiet=quiet) as progress:
        found = measure(*names, values=values, progress=progress)
    if out is not None:
        from vectorplot.accuracy.results import write_folder

        write_folder(found, out, format_)
    click.echo(as_text(found))


def check_folder(out: str) -> None:
    """An OSError before the work where there can be no such folder."""
    check_place(out)
    if Path(out).exists() and not Path(out).is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), out)
