"""``vectorplot draw``: a scene or a mesh becomes strokes on a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.common_options import (
    DRAWING_FORMATS,
    TOLERANCE,
    crease_angle_option,
    lines_option,
    picture_verb,
)
from vectorplot.cli.hatching_options import HATCHING_OPTIONS, hatching_from
from vectorplot.cli.options import at_least
from vectorplot.cli.view_options import PAGE_OPTIONS

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene


@picture_verb(
    "Draw a scene or a mesh with exact hidden lines.",
    DRAWING_FORMATS,
    *PAGE_OPTIONS,
    lines_option("Kinds of lines", default=None, note="  [default: all but edges; in wireframes all but intersection]"),
    crease_angle_option("Sharper edges are creases."),
    click.option(
        "--style",
        type=click.Choice(["plain", "wireframe", "depth-cue"]),
        default="plain",
        help="Hidden lines removed; or all lines shown, in one shade or by their depth.",
    ),
    click.option(
        "--hidden", type=click.Choice(["none", "dashed", "solid"]), default="none", help="How hidden lines look."
    ),
    click.option(
        "--halo",
        "halo_mm",
        type=at_least(0.0),
        default=0.0,
        metavar="MM",
        help="Gap beside lines that lie in front.",
    ),
    *HATCHING_OPTIONS,
    click.option(
        "--layers", type=click.Choice(["kind", "object", "colour"]), default="kind", help="What shares a layer."
    ),
    click.option(
        "--curves", type=click.Choice(["bezier", "polyline"]), default="bezier", help="How smooth curves leave."
    ),
    TOLERANCE,
    click.option(
        "--longest",
        "longest_mm",
        type=at_least(1.0),
        metavar="MM",
        help="Longer strokes leave in parts.  [default: whole]",
    ),
)
def draw(scene: Scene, **told: Any) -> Drawing:
    """Draw INPUT, a scene file, mesh (obj, stl, ply, off, glb), molecule (xyz, pdb, cif) or terrain (asc, xyz), and
    write OUT (svg, ps, eps, pdf, png, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    from vectorplot.draw import draw as draw_scene

    hatch, rest = hatching_from(told)
    return draw_scene(scene, hatch=hatch, **rest)
