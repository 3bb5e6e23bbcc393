"""``vectorplot render``: a scene or a mesh becomes a shaded picture of pixels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import at_least, between, of_option, pixels
from vectorplot.cli.options import (
    BACKGROUND,
    DEPTH_CUE,
    EXPOSURE,
    LIGHTS,
    OVERLAID_OPTIONS,
    REFLECTIONS,
    SHORTEST,
    crease_angle_option,
    fit_option,
    lines_option,
    picture_verb,
    shadows_option,
)

if TYPE_CHECKING:
    from vectorplot.scene.scene import Scene
    from vectorplot.shading.image import Image


FORMATS = ("png",)


@picture_verb(
    "Render a scene or a mesh as pixels.",
    FORMATS,
    click.option("--size", type=pixels, default="800x600", metavar="WxH", help="Columns and rows of pixels."),
    click.option(
        "--margin-pixels",
        type=at_least(0.0),
        metavar="N",
        help="Empty border of a picture that fits.  [default: 3 % of the shorter side]",
    ),
    fit_option("picture"),
    LIGHTS,
    EXPOSURE,
    shadows_option("render", "How shadows are found."),
    click.option(
        "--shadow-size",
        type=click.IntRange(8, 8192),
        metavar="N",
        help="Texels along a shadow map.  [default: about the longer side of the picture]",
    ),
    click.option(
        "--shadow-bits", type=click.Choice(["8", "16", "32"]), default="32", help="Of a depth in a shadow map."
    ),
    click.option(
        "--shadow-casters",
        type=click.Choice(["all", "away"]),
        default="all",
        help="Faces that shadow buffers are made of: all, or, of closed items, those that turn away from the light.",
    ),
    click.option(
        "--shadow-focus",
        type=between(0.0, 1.0),
        metavar="PART",
        help="Trapezoids grow until what is near the eye has this part of --shadow-size squared.",
    ),
    click.option(
        "--samples", type=of_option("samples"), metavar="N", help="N x N samples in every pixel.  [default: 2]"
    ),
    click.option(
        "--transparency",
        type=of_option("transparency"),
        default="blended",
        help="Transparent items: mixed with what is behind them, or every second, third or fourth pixel.",
    ),
    crease_angle_option("Sharper edges stay sharp."),
    REFLECTIONS,
    lines_option("Lines on top"),
    *OVERLAID_OPTIONS,
    SHORTEST,
    DEPTH_CUE,
    BACKGROUND,
)
def render(scene: Scene, **told: Any) -> Image:
    """Render INPUT, a scene file (- for stdin), mesh (obj, stl, ply, off, glb, vtk, vtu), CAD part (step, iges, brep),
    molecule (xyz, pdb, cif) or terrain (asc, xyz), as a PNG picture OUT.

    Camera options replace the fields of the camera in the scene file one by one.
    """
    from vectorplot.pictures.render import render as render_scene

    return render_scene(scene, **keywords(told))


def keywords(told: dict[str, Any]) -> dict[str, Any]:
    """What the options of the command are to the function."""
    return {**told, "shadow_bits": int(told["shadow_bits"])}
