"""``vectorplot draw``: a scene or a mesh becomes strokes on a page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import KINDS, at_least, between, format_of, kinds
from vectorplot.cli.picture import make_picture
from vectorplot.cli.view import CAMERA_OPTIONS, PAGE_OPTIONS, CameraOptions, camera_from, page_from, with_options

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene

FORMATS = ("svg", "ps", "eps", "pdf", "png", "json")


@click.command(short_help="Draw a scene or a mesh with exact hidden lines.", context_settings={"show_default": True})
@click.argument("scene_file", type=click.Path(), metavar="INPUT")
@click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")
@click.option("--format", "format_", type=click.Choice(FORMATS), help="Format, where the name of OUT does not tell.")
@with_options(*CAMERA_OPTIONS, *PAGE_OPTIONS)
@click.option(
    "--lines",
    type=kinds,
    metavar="KIND,...",
    help=f"Kinds of lines: {KINDS}.  [default: all but edges; in wireframes all but intersection]",
)
@click.option(
    "--crease-angle", type=at_least(0.0, at_most=180.0), default=25.0, metavar="DEG", help="Sharper edges are creases."
)
@click.option(
    "--style",
    type=click.Choice(["plain", "wireframe", "depth-cue"]),
    default="plain",
    help="Hidden lines removed; or all lines shown, in one shade or by their depth.",
)
@click.option("--hidden", type=click.Choice(["none", "dashed", "solid"]), default="none", help="How hidden lines look.")
@click.option("--halo", type=at_least(0.0), default=0.0, metavar="MM", help="Gap beside lines that lie in front.")
@click.option("--layers", type=click.Choice(["kind", "object", "colour"]), default="kind", help="What shares a layer.")
@click.option("--curves", type=click.Choice(["bezier", "polyline"]), default="bezier", help="How smooth curves leave.")
@click.option("--tolerance", type=between(0.0, math.inf), default=0.02, metavar="MM", help="For approximations.")
@click.option("--longest", type=at_least(1.0), metavar="MM", help="Longer strokes leave in parts.  [default: whole]")
@click.option(
    "--budget", type=between(0.0, math.inf), default=1.0, metavar="FACTOR", help="Times the usual work on a surface."
)
@click.option("--explain", is_flag=True, help="Print stages, times, counts and memory on stderr.")
@click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")
def draw(scene_file: str, out: str, format_: str | None, quiet: bool, explain: bool, **options: Any) -> None:
    """Draw INPUT, a scene file or a mesh (obj, stl, ply, off, glb), and write OUT (svg, ps, eps, pdf, png, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    look = CameraOptions.of(options)

    def picture(scene: Scene, report: Report) -> Drawing:
        from vectorplot.draw import draw as draw_scene

        return draw_scene(
            scene,
            camera_from(look, scene),
            page=page_from(options, scene),
            fit=options["fit"],
            lines=options["lines"],
            crease_angle_deg=options["crease_angle"],
            style=options["style"],
            hidden=options["hidden"],
            halo_mm=options["halo"],
            layers=options["layers"],
            curves=options["curves"],
            tolerance_mm=options["tolerance"],
            longest_mm=options["longest"],
            budget=options["budget"],
            progress=report.progress,
            explain=report.explain,
        )

    make_picture(scene_file, out, format_of(out, format_, FORMATS), picture, quiet=quiet, explain=explain)
