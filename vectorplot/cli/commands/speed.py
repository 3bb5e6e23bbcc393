"""``vectorplot speed``: what pictures cost on this machine."""

from __future__ import annotations

import click

from vectorplot.cli.options import drawing_format
from vectorplot.cli.picture import progress_bar


@click.command(short_help="Measure what pictures cost, and how that grows.")
@click.option("-o", "picture", type=click.Path(), metavar="FILE", help="Plot it: svg, pdf, ps, eps, png or json.")
@click.option("--log", type=click.Path(), metavar="FILE", help="Write what was measured as JSON.")
@click.option("--read", "earlier", type=click.Path(), metavar="LOG", help="Show this log; nothing is measured.")
@click.option("--beside", type=click.Path(), metavar="LOG", help="Compare with an earlier log.")
@click.option("--only", multiple=True, metavar="NAME", help="Only these pictures; repeat it for more.")
@click.option("--quiet", "-q", is_flag=True, help="No progress bar.")
def speed(
    picture: str | None,
    log: str | None,
    earlier: str | None,
    beside: str | None,
    only: tuple[str, ...],
    quiet: bool,
) -> None:
    """Measure what pictures of fixed scenes cost: seconds of the processor, the exponent by which they grow with the
    scene, memory, stages; and beside them, in the same run, what single operations of numpy and Python cost.

    Takes a minute or two. Costs in points (of projecting and sorting one) can be compared between machines.
    """
    from vectorplot.errors import InputError
    from vectorplot.save import save
    from vectorplot.speed.measure import SERIES, measure
    from vectorplot.speed.results import comparison, plot, read_log, tables, write_log
    from vectorplot.words import nearest

    if picture is not None:
        drawing_format(picture, None)
    names = [series.name for series in SERIES]
    for name in only:
        if name not in names:
            near = nearest(name, names)
            raise InputError(f"{name!r} is none of the pictures" + (f"; did you mean {near!r}?" if near else ""))
    before = None if beside is None else read_log(beside)
    if earlier is not None:
        found = read_log(earlier)
    else:
        with progress_bar(quiet=quiet) as progress:
            found = measure(only, progress)
    if log is not None:
        write_log(found, log)
    if picture is not None:
        save(plot(found, before), picture)
    click.echo(tables(found) if before is None else f"{tables(found)}\n\n{comparison(before, found)}")
