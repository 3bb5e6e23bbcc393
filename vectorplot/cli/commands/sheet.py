"""``vectorplot sheet``: main views of a part on one sheet."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import upwards
from vectorplot.cli.options import (
    CUT_SPACING,
    DRAWING_FORMATS,
    EXPLAIN,
    INPUT,
    LANDSCAPE,
    OUT,
    QUIET,
    VIEW_WORDS,
    crease_angle_option,
    drawing_format,
    format_option,
    with_options,
)
from vectorplot.cli.picture import Source, make_pages, make_picture, warn_of_nothing

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene


def _name_of_mesh(path: str) -> str:
    """The name of a file without its suffix, where the file has no title of its own to say."""
    from vectorplot.io.read_file import CAD_SUFFIXES
    from vectorplot.io.read_mesh import MESH_SUFFIXES

    return Path(path).stem if Path(path).suffix.lower() in (*MESH_SUFFIXES, *CAD_SUFFIXES) else ""


@click.command(short_help="Draw main views of a part on one sheet.", context_settings={"show_default": True})
@with_options(
    INPUT,
    OUT,
    format_option(DRAWING_FORMATS),
    click.option(
        "--views", default="front,top,left,iso", metavar="VIEW,...", help=f"Some of {', '.join(VIEW_WORDS)}; each once."
    ),
    click.option("--up", type=upwards, metavar="X,Y,Z", help="What is upwards, or x, y, z (default: z)."),
    click.option(
        "--scale",
        default="fit",
        metavar="A:B",
        help="Mm on paper for units of the part; fit: the largest of ISO 5455.",
    ),
    click.option(
        "--unit",
        type=click.Choice(["mm", "cm", "m", "in"]),
        default="mm",
        help="What a unit of the part is; the sheet is in mm whatever it is.",
    ),
    click.option(
        "--projection",
        type=click.Choice(["first", "third"]),
        default="first",
        help="Views opposite to the side they are seen from, or on it.",
    ),
    click.option("--page", default="A3", metavar="SIZE", help="A0 to A6, letter, ... or WIDTHxHEIGHT in mm."),
    LANDSCAPE,
    click.option("--section", multiple=True, metavar="AXIS=PLACE", help="A section view, as y=12; repeat it for more."),
    CUT_SPACING,
    click.option("--dimensions", is_flag=True, help="How long the part is along x, y and z."),
    click.option("--centre-lines", is_flag=True, help="Of bores, shafts and other round edges of meshes."),
    click.option("--frame", is_flag=True, help="A border with centring marks and zones."),
    click.option("--block/--no-block", default=True, help="The title block, or views alone, as a figure."),
    click.option(
        "--title",
        default="",
        metavar="TEXT",
        show_default=False,
        help="Letters in the title block.  [default: those of the scene, or the name of a mesh file]",
    ),
    click.option("--author", default="", metavar="TEXT", show_default=False, help="Who has drawn it."),
    click.option("--date", default="", metavar="TEXT", show_default=False, help="As it is to be written."),
    click.option("--sheet", metavar="TEXT", help="The number of the sheet, such as 1/2.  [default: 1, or 1/2 of two]"),
    crease_angle_option("Sharper edges are creases."),
    EXPLAIN,
    QUIET,
)
def sheet(scene_file: tuple[str, ...], out: str, format_: str | None, quiet: bool, explain: bool, **told: Any) -> None:
    """Draw main views of INPUT in line with each other, at one exact scale with hidden lines dashed, and a title block;
    write OUT (svg, ps, eps, pdf, png, tex, dxf, json).

    A named page lies on the side that gives the views more room. Several INPUTs become a sheet each, the pages of one
    PDF.
    """
    from vectorplot.pictures.nothing_seen import why_nothing
    from vectorplot.pictures.technical_sheet import technical_sheet
    from vectorplot.scene.page import Page

    if told.pop("landscape"):
        told["page"] = f"{told['page'].split(' ')[0]} landscape"
    asked, upright = told.pop("sheet"), told["up"] is not None
    told |= {"cut_spacing_mm": told.pop("cut_spacing"), "title": told["title"] or None}

    def page(number: int, scene: Scene, report: Report) -> Drawing:
        usual = "1" if len(scene_file) == 1 else f"{number + 1}/{len(scene_file)}"
        said = usual if asked is None else asked
        named = replace(scene, title=scene.title or _name_of_mesh(scene_file[number]))
        made = technical_sheet(named, **told, sheet=said, progress=report.progress, explain=report.explain)
        warn_of_nothing(Source((scene_file[number],)), made, lambda: why_nothing(scene, None, Page()))
        return made

    written = drawing_format(out, format_)
    if len(scene_file) > 1:
        if written != "pdf":
            raise click.UsageError("several INPUTs become the pages of a PDF: OUT must end in .pdf")
        make_pages([Source((one,), upright=upright) for one in scene_file], out, page, quiet=quiet, explain=explain)
        return
    make_picture(Source(scene_file, upright=upright), out, written, partial(page, 0), quiet=quiet, explain=explain)
