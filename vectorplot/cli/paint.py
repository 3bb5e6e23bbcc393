"""``vectorplot paint``: a scene or a mesh becomes filled polygons on a page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import KINDS, at_least, between, format_of, kinds, light
from vectorplot.cli.picture import make_picture
from vectorplot.cli.view import CAMERA_OPTIONS, PAGE_OPTIONS, CameraOptions, camera_from, page_from, with_options

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene

FORMATS = ("svg", "ps", "eps", "pdf", "png", "json")


@click.command(short_help="Paint a scene or a mesh with filled polygons.", context_settings={"show_default": True})
@click.argument("scene_file", type=click.Path(), metavar="INPUT")
@click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")
@click.option("--format", "format_", type=click.Choice(FORMATS), help="Format, where the name of OUT does not tell.")
@with_options(*CAMERA_OPTIONS, *PAGE_OPTIONS)
@click.option(
    "--lights",
    type=light,
    multiple=True,
    metavar="X,Y,Z[,I]",
    help="Lamp at a point, with an intensity from 0 to 1, in place of the lights of the scene; repeat it for more.",
)
@click.option("--shadows", type=click.Choice(["auto", "none"]), default="auto", help="Whether lights cast shadows.")
@click.option("--aura", type=at_least(0.0), default=0.0, metavar="MM", help="Width of the soft border of shadows.")
@click.option("--palette", type=click.IntRange(2, 256), default=32, metavar="N", help="Shades of every colour.")
@click.option("--flat", is_flag=True, help="One shade for every plane: no gradients, nothing looks round.")
@click.option(
    "--fills",
    type=click.Choice(["painted", "visible", "erasing"]),
    default="painted",
    help="Painted one over the other, only what is seen of each, or blank with edges.",
)
@click.option(
    "--lines", type=kinds, default="none", metavar="KIND,...", help=f"Lines on top, or on blank polygons: {KINDS}."
)
@click.option(
    "--crease-angle",
    type=at_least(0.0, at_most=180.0),
    default=25.0,
    metavar="DEG",
    help="Sharper edges are creases; meshes look round where faces meet at less.",
)
@click.option("--tolerance", type=between(0.0, math.inf), default=0.02, metavar="MM", help="For approximations.")
@click.option(
    "--budget", type=between(0.0, math.inf), default=1.0, metavar="FACTOR", help="Times the usual work on a surface."
)
@click.option("--explain", is_flag=True, help="Print stages, times, counts and memory on stderr.")
@click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")
def paint(scene_file: str, out: str, format_: str | None, quiet: bool, explain: bool, **options: Any) -> None:
    """Paint INPUT, a scene file or a mesh (obj, stl, ply, off, glb), and write OUT (svg, ps, eps, pdf, png, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    look = CameraOptions.of(options)

    def picture(scene: Scene, report: Report) -> Drawing:
        from vectorplot.paint import paint as paint_scene

        return paint_scene(
            scene,
            camera_from(look, scene),
            page=page_from(options, scene),
            fit=options["fit"],
            lights=options["lights"] or None,
            shadows=options["shadows"],
            aura_mm=options["aura"],
            palette=options["palette"],
            smooth=not options["flat"],
            fills=options["fills"],
            lines=options["lines"],
            crease_angle_deg=options["crease_angle"],
            tolerance_mm=options["tolerance"],
            budget=options["budget"],
            progress=report.progress,
            explain=report.explain,
        )

    make_picture(scene_file, out, format_of(out, format_, FORMATS), picture, quiet=quiet, explain=explain)
