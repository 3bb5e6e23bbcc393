"""Options for how painted faces and their shadows look."""

from __future__ import annotations

import click

from vectorplot.cli.options import at_least

FACE_OPTIONS = (
    click.option(
        "--aura",
        "aura_mm",
        type=at_least(0.0),
        default=0.0,
        metavar="MM",
        help="Width of the soft border of shadows.",
    ),
    click.option("--palette", type=click.IntRange(2, 256), default=32, metavar="N", help="Shades of every colour."),
    click.option("--flat", is_flag=True, help="One shade for every plane: no gradients, nothing looks round."),
)
