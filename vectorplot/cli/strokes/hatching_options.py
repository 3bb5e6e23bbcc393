"""Options that say how faces are hatched."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import at_least, number

if TYPE_CHECKING:
    from vectorplot.scene.hatching import Hatching, Stippling

_OF = {"spacing": "spacing_mm", "angle": "angle_deg", "cross": "cross", "along": "along", "hatch_width": "width_mm"}
"""The options that say more of a hatching, and the fields of it that they fill."""

HATCHING_OPTIONS = (
    click.option(
        "--hatch",
        type=click.Choice(["none", "tone", "colour", "even"]),
        default="none",
        help="Faces hatched: by light and shadow, by light and colour, or all alike.",
    ),
    click.option(
        "--spacing",
        type=at_least(0.01),
        metavar="MM",
        help="From stroke to stroke where it is darkest.  [default: 0.6]",
    ),
    click.option("--angle", type=number, metavar="DEG", help="Of the strokes.  [default: 45]"),
    click.option("--cross", is_flag=True, default=None, help="Strokes cross where it is darker than a half."),
    click.option(
        "--along",
        type=click.Choice(["page", "surface", "slope", "level", "curvature", "asymptotic", "isophotes"]),
        help="Parallel on the page; in planes of faces, along parameter lines; or flowing.  [default: page]",
    ),
    click.option("--stipple", type=click.IntRange(1), metavar="N", help="So many dots in place of strokes."),
    click.option(
        "--hatch-width",
        type=at_least(0.01),
        metavar="MM",
        help="Of the pen that hatches, or makes dots.  [default: 0.18, of dots 0.25]",
    ),
)


def hatching_from(options: Mapping[str, Any]) -> tuple[Hatching | Stippling | None, dict[str, Any]]:
    """The hatching or stippling that the options of a command ask for, None where they ask for none, and the other
    options.

    Errors: bad usage for options of a hatching without one, or beside dots; InputError as of Hatching and Stippling.
    """
    from vectorplot.scene.hatching import Hatching, Stippling

    given = {field: options[name] for name, field in _OF.items() if options[name] is not None}
    rest = {name: value for name, value in options.items() if name not in (*_OF, "hatch", "stipple")}
    if options["stipple"] is not None:
        strokes = [name for name, field in _OF.items() if field in given and name != "hatch_width"]
        if strokes:
            raise click.UsageError(f"--{strokes[0]} is for strokes, and --stipple makes dots")
        by: Any = "tone" if options["hatch"] == "none" else options["hatch"]
        return Stippling(options["stipple"], by, **given), rest
    if options["hatch"] == "none":
        if given:
            name = next(name for name, field in _OF.items() if field in given)
            raise click.UsageError(f"--{name.replace('_', '-')} goes with --hatch tone, colour or even")
        return None, rest
    return Hatching(options["hatch"], **given), rest
