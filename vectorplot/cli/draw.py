"""``vectorplot draw``: a scene or a mesh becomes strokes on a page."""

from __future__ import annotations

import errno
import math
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import DRAWN, KINDS, at_least, between, format_of, kinds, number, point, sheet
from vectorplot.cli.progress import progress_bar, table, told_warnings
from vectorplot.cli.view import CameraOptions, camera_from, page_from
from vectorplot.errors import InputWarning

if TYPE_CHECKING:
    from vectorplot.plan import StageReport

FORMATS = ("svg", "ps", "eps", "pdf", "png", "json")
VIEW_WORDS = ("front", "back", "left", "right", "top", "bottom", "iso")


@click.command(short_help="Draw a scene or a mesh with exact hidden lines.", context_settings={"show_default": True})
@click.argument("scene_file", type=click.Path(), metavar="INPUT")
@click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")
@click.option("--format", "format_", type=click.Choice(FORMATS), help="Format, where the name of OUT does not tell.")
@click.option("--eye", type=point, metavar="X,Y,Z", help="Where one looks from.")
@click.option("--target", type=point, metavar="X,Y,Z", help="What one looks at.")
@click.option("--up", type=point, metavar="X,Y,Z", help="Direction that is up in the picture (default: z).")
@click.option("--twist", type=number, metavar="DEG", help="Turn of the camera about its principal ray.")
@click.option("--fov", type=between(0.0, 180.0), metavar="DEG", help="Full angle over the picture height.")
@click.option("--parallel", is_flag=True, help="Parallel projection along eye - target.")
@click.option("--height", type=between(0.0, math.inf), metavar="H", help="World units over the page, when parallel.")
@click.option(
    "--view", type=click.Choice(VIEW_WORDS), help="A main view in place of --eye, parallel unless --fov is given."
)
@click.option(
    "--page", type=sheet, metavar="SIZE", help="A0 to A6, letter, legal, ... or WIDTHxHEIGHT in mm.  [default: A4]"
)
@click.option("--landscape", is_flag=True, help="Lay the page on its longer side.")
@click.option("--margin", type=at_least(0.0), metavar="MM", help="Empty border of the page.  [default: 10]")
@click.option("--fit/--no-fit", default=True, help="Fill the page, or keep the camera's scale.")
@click.option("--lines", type=kinds, default=",".join(DRAWN), metavar="KIND,...", help=f"Some of {', '.join(KINDS)}.")
@click.option(
    "--crease-angle", type=at_least(0.0, at_most=180.0), default=25.0, metavar="DEG", help="Sharper edges are creases."
)
@click.option("--hidden", type=click.Choice(["none", "dashed", "solid"]), default="none", help="How hidden lines look.")
@click.option("--halo", type=at_least(0.0), default=0.0, metavar="MM", help="Gap beside lines that lie in front.")
@click.option("--layers", type=click.Choice(["kind", "object", "colour"]), default="kind", help="What shares a layer.")
@click.option("--curves", type=click.Choice(["bezier", "polyline"]), default="bezier", help="How smooth curves leave.")
@click.option("--tolerance", type=between(0.0, math.inf), default=0.02, metavar="MM", help="For approximations.")
@click.option("--explain", is_flag=True, help="Print stages, times, counts and memory on stderr.")
@click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")
def draw(scene_file: str, out: str, format_: str | None, quiet: bool, explain: bool, **options: Any) -> None:
    """Draw INPUT, a scene file or a mesh (obj, stl, ply, off, glb), and write OUT (svg, ps, eps, pdf, png, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    names = ("eye", "target", "up", "twist", "fov", "parallel", "height", "view")
    look = CameraOptions(**{name: options[name] for name in names})
    look.check()
    word = format_of(out, format_, FORMATS)

    reports: list[StageReport] = []
    with told_warnings(quiet=quiet):
        draw_file(scene_file, out, word, look, options, quiet=quiet, reports=reports)
    if explain:
        click.echo(table(reports), err=True)


def draw_file(
    scene_file: str,
    out: str,
    format_: str,
    look: CameraOptions,
    options: dict[str, Any],
    *,
    quiet: bool,
    reports: list[StageReport],
) -> None:
    """Read, draw and write, and note what each stage cost; nothing is written unless all of it succeeds."""
    from vectorplot.draw import draw as draw_scene
    from vectorplot.io.read import read
    from vectorplot.plan import Stage, Walk
    from vectorplot.save import write

    stages = (Stage("read", scene_file), Stage("write", f"as {format_}"))
    walk = Walk(stages, reports.append, None)
    check_place(out)
    with progress_bar(quiet=quiet) as progress:
        scene = walk.run("read", read, scene_file)
        drawing = draw_scene(
            scene,
            camera_from(look, scene),
            page=page_from(options["page"], options["landscape"], options["margin"], scene),
            fit=options["fit"],
            lines=options["lines"],
            crease_angle_deg=options["crease_angle"],
            hidden=options["hidden"],
            halo_mm=options["halo"],
            layers=options["layers"],
            curves=options["curves"],
            tolerance_mm=options["tolerance"],
            progress=progress,
            explain=reports.append,
        )
        if not any(len(paths) for layer in drawing.layers for paths in layer.strokes):
            warnings.warn(f"{scene_file}: nothing to draw: the picture is empty", InputWarning, stacklevel=2)
        content = walk.run("write", write, drawing, format_)
        write_out(out, content)


def check_place(out: str) -> None:
    """An OSError before the work where there is no folder to write into."""
    folder = Path(out).parent
    if out != "-" and not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder))


def write_out(out: str, content: bytes) -> None:
    """Write to a file, whole or not at all, or to stdout for ``-``."""
    if out == "-":
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    from vectorplot.save import write_whole

    write_whole(out, content)
