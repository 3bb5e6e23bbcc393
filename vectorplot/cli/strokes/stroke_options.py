"""Options for how strokes look: a style, hidden lines, pens and dashes."""

from __future__ import annotations

import click

from vectorplot.cli.options import at_least, dash, layers, pen, said_or_none, style

_STYLE, _HIDDEN, _PEN, _DASH = (
    click.option(
        "--style",
        type=style,
        metavar="STYLE",
        help="plain, plotter, book, draft, blueprint, wireframe, depth-cue, or a file that ends in .toml."
        "  [default: what the scene says, or plain]",
    ),
    click.option(
        "--hidden",
        type=click.Choice(["none", "dashed", "solid"]),
        help="How hidden lines look.  [default: none, or what the style says]",
    ),
    click.option(
        "--pen",
        "pens",
        type=pen,
        multiple=True,
        callback=said_or_none,
        metavar="[WHAT=]PEN,...",
        help="WIDTH, COLOUR or WIDTH:COLOUR of a kind of line (or hidden), an item, or ITEM.KIND; repeat it for more.",
    ),
    click.option(
        "--dash",
        "dashes",
        type=dash,
        multiple=True,
        callback=said_or_none,
        metavar="[WHAT=]DASH,GAP",
        help="Dashes of the same, in mm or with units (8pt,3pt), or none; repeat it for more.",
    ),
)
STROKE_OPTIONS = (_STYLE, _HIDDEN, _PEN, _DASH)
"""Of lines where faces are not filled."""

OVERLAID_OPTIONS = (_STYLE, _PEN, _DASH)
"""Of lines on top of faces that are filled, where hidden lines are hidden."""

HALO = click.option(
    "--halo",
    "halo_mm",
    type=at_least(0.0),
    default=0.0,
    metavar="MM",
    help="Gap beside lines that lie in front.",
)

LAYERS = click.option(
    "--layers",
    type=layers,
    metavar="WORD,...",
    help="What shares a layer: kind, object, colour, or several of these.  [default: kind, or what the style says]",
)
