"""``vectorplot render``: a scene or a mesh becomes a shaded picture of pixels."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import KINDS, at_least, between, format_of, kinds, light, pixels
from vectorplot.cli.picture import make_picture
from vectorplot.cli.view import CAMERA_OPTIONS, CameraOptions, camera_from, with_options

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.scene.scene import Scene
    from vectorplot.shading.raster.image import Image

FORMATS = ("png",)
SHADOWS = ("auto", "none", "buffer", "trapezoid", "exact")


@click.command(short_help="Render a scene or a mesh as pixels.", context_settings={"show_default": True})
@click.argument("scene_file", type=click.Path(), metavar="INPUT")
@click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")
@click.option("--format", "format_", type=click.Choice(FORMATS), help="Format, where the name of OUT does not tell.")
@with_options(*CAMERA_OPTIONS)
@click.option("--size", type=pixels, default="800x600", metavar="WxH", help="Columns and rows of pixels.")
@click.option("--fit/--no-fit", default=True, help="Fill the picture, or keep the camera's scale.")
@click.option(
    "--lights",
    type=light,
    multiple=True,
    metavar="X,Y,Z[,I]",
    help="Lamp at a point, with an intensity from 0 to 1, in place of the lights of the scene; repeat it for more.",
)
@click.option("--shadows", type=click.Choice(SHADOWS), default="auto", help="How shadows are found.")
@click.option("--shadow-size", type=click.IntRange(8, 8192), default=1024, metavar="N", help="Texels along a map.")
@click.option("--shadow-bits", type=click.Choice(["8", "16", "32"]), default="32", help="Of a depth in a shadow map.")
@click.option(
    "--shadow-casters",
    type=click.Choice(["all", "away"]),
    default="all",
    help="Faces that shadow buffers are made of: all, or, of closed items, those that turn away from the light.",
)
@click.option(
    "--shadow-focus",
    type=between(0.0, 1.0),
    metavar="PART",
    help="Trapezoids grow until what is near the eye has this part of --shadow-size squared.",
)
@click.option("--samples", type=click.IntRange(1, 8), metavar="N", help="N x N samples in every pixel.  [default: 2]")
@click.option(
    "--crease-angle", type=at_least(0.0, at_most=180.0), default=25.0, metavar="DEG", help="Sharper edges stay sharp."
)
@click.option("--lines", type=kinds, default="none", metavar="KIND,...", help=f"Lines on top: {KINDS}.")
@click.option("--background", metavar="COLOUR", help="A palette, a plain colour or #rrggbb.  [default: white]")
@click.option(
    "--budget", type=between(0.0, math.inf), default=1.0, metavar="FACTOR", help="Times the usual work on a surface."
)
@click.option("--explain", is_flag=True, help="Print stages, times, counts and memory on stderr.")
@click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")
def render(scene_file: str, out: str, format_: str | None, quiet: bool, explain: bool, **options: Any) -> None:
    """Render INPUT, a scene file or a mesh (obj, stl, ply, off, glb), as a PNG picture OUT.

    Camera options replace the fields of the camera in the scene file one by one.
    """
    look = CameraOptions.of(options)

    def picture(scene: Scene, report: Report) -> Image:
        from vectorplot.render import render as render_scene

        return render_scene(
            scene,
            camera_from(look, scene),
            size=options["size"],
            fit=options["fit"],
            lights=options["lights"] or None,
            shadows=options["shadows"],
            shadow_size=options["shadow_size"],
            shadow_bits=int(options["shadow_bits"]),
            shadow_casters=options["shadow_casters"],
            shadow_focus=options["shadow_focus"],
            samples=options["samples"],
            crease_angle_deg=options["crease_angle"],
            lines=options["lines"],
            background=options["background"],
            budget=options["budget"],
            progress=report.progress,
            explain=report.explain,
        )

    make_picture(scene_file, out, format_of(out, format_, FORMATS), picture, quiet=quiet, explain=explain)
