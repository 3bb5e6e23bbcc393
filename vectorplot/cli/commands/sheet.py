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
    EXPLODE,
    HIDDEN_LINES,
    INPUT,
    LANDSCAPE,
    MEASURE_OPTIONS,
    OUT,
    PARTS,
    QUIET,
    SHORTEST,
    TEXT,
    UNIT,
    VIEW_WORDS,
    check_overlaid,
    crease_angle_option,
    drawing_format,
    format_option,
    moved_apart,
    with_options,
)
from vectorplot.cli.picture import ReadSource, Source, make_pages, make_picture, reported_warnings, warn_of_nothing

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.page import SheetSettings
    from vectorplot.scene.scene import Scene


def _name_of_mesh(path: str) -> str:
    """The name of a file without its suffix, where the file has no title of its own to say."""
    from vectorplot.io.read_file import CAD_SUFFIXES
    from vectorplot.io.read_mesh import MESH_SUFFIXES

    return Path(path).stem if Path(path).suffix.lower() in (*MESH_SUFFIXES, *CAD_SUFFIXES) else ""


_OF_ASSEMBLY: dict[str, Any] = {
    **{"title": None, "section": (), "detail_view": (), "breakout": (), "interrupted": ()},
    **{"balloons": False, "parts_list": False},
}
"""What the sheets of parts have not, as that of the whole has."""


def _field(text: str) -> tuple[str, str]:
    """NAME=TEXT."""
    name, sign, said = text.partition("=")
    if not sign or not name.strip():
        raise click.BadParameter(f"{text!r}: expected NAME=TEXT, such as MATERIAL=S235")
    return name.strip(), said


def _lying(page: str | None, standard: str | None, said: SheetSettings) -> str:
    """The page of a sheet on its longer side; said: by the scene."""
    usual = "tabloid" if (standard or said.standard) == "asme" else "A3"
    return f"{(page or said.page or usual).split(' ')[0]} landscape"


@click.command(short_help="Draw main views of a part on one sheet.", context_settings={"show_default": True})
@with_options(
    INPUT,
    OUT,
    format_option(DRAWING_FORMATS),
    click.option(
        "--views",
        metavar="VIEW,...",
        help=f"Some of {', '.join(VIEW_WORDS)}; each once.  [default: front,top,left,iso]",
    ),
    click.option("--up", type=upwards, metavar="X,Y,Z", help="What is upwards, or x, y, z (default: z)."),
    click.option(
        "--scale",
        metavar="A:B",
        help="Mm on paper for units of the part; fit: the largest of ISO 5455.  [default: fit]",
    ),
    UNIT,
    click.option(
        "--standard",
        type=click.Choice(["iso", "asme"]),
        help="What is usual: first angle, A3, measures above lines; or third angle, tabloid, level measures.  "
        "[default: iso]",
    ),
    click.option(
        "--measured-in", type=click.Choice(["mm", "cm", "m", "in"]), help="The unit of all measures.  [default: mm]"
    ),
    *MEASURE_OPTIONS,
    click.option(
        "--projection",
        type=click.Choice(["first", "third"]),
        help="Views opposite to the side they are seen from, or on it.  [default: first, of asme third]",
    ),
    click.option(
        "--page", metavar="SIZE", help="A0 to A6, letter, ... or WIDTHxHEIGHT in mm.  [default: A3, of asme tabloid]"
    ),
    LANDSCAPE,
    click.option(
        "--section",
        multiple=True,
        metavar="AXIS=PLACE",
        help="A section view, as y=12, x+y=30, 'half y=12', 'y=12 | x=20 | y=30' or 'aligned z at 0,0 from 180 to 60'; "
        "repeat it for more.",
    ),
    CUT_SPACING,
    click.option(
        "--detail-view",
        multiple=True,
        metavar="VIEW:X,Y,Z,R[,A:B]",
        help="What is in a circle of a view, larger and apart; repeat it for more.",
    ),
    click.option(
        "--breakout",
        multiple=True,
        metavar="VIEW:X,Y,Z,R",
        help="A local section through a point, in a circle of a view; repeat it for more.",
    ),
    click.option(
        "--interrupted",
        multiple=True,
        metavar="AXIS=FROM..TO",
        help="What is left out of a long part, as x=40..160, with break lines; repeat it for more.",
    ),
    click.option("--dimensions/--no-dimensions", default=None, help="How long the part is along x, y and z."),
    click.option(
        "--centre-lines/--no-centre-lines", default=None, help="Of bores, shafts and other round edges of meshes."
    ),
    click.option("--frame", is_flag=True, help="A border with centring marks and zones."),
    click.option(
        "--block/--no-block", default=None, help="The title block, or views alone, as a figure.  [default: block]"
    ),
    click.option(
        "--title",
        default="",
        metavar="TEXT",
        show_default=False,
        help="Letters in the title block.  [default: those of the scene, or the name of a mesh file]",
    ),
    click.option("--author", metavar="TEXT", help="Who has drawn it."),
    click.option("--date", metavar="TEXT", help="As it is to be written."),
    click.option("--sheet", metavar="TEXT", help="The number of the sheet, such as 1/2.  [default: 1, or 1/2 of two]"),
    click.option(
        "--field",
        "fields",
        type=_field,
        multiple=True,
        metavar="NAME=TEXT",
        help="A free field of the title block, as MATERIAL=S235; repeat it for more.",
    ),
    click.option("--block-template", metavar="FILE", help="A TOML file with the rows and cells of the title block."),
    click.option(
        "--balloons/--no-balloons", default=None, help="Numbers of parts around the iso view, or the first one."
    ),
    click.option("--parts-list/--no-parts-list", default=None, help="A list of the parts on the title block."),
    click.option(
        "--made-of",
        type=_field,
        multiple=True,
        metavar="PART=TEXT",
        help="The material of a part, for that list, as BOLT=8.8; repeat it for more.",
    ),
    click.option("--each-part", is_flag=True, help="Then a sheet of each part, all as the pages of one PDF."),
    EXPLODE,
    HIDDEN_LINES,
    TEXT,
    crease_angle_option("Sharper edges are creases."),
    PARTS,
    SHORTEST,
    EXPLAIN,
    QUIET,
)
def sheet(scene_file: tuple[str, ...], out: str, format_: str | None, quiet: bool, explain: bool, **told: Any) -> None:
    """Draw main views of INPUT in line with each other, at one exact scale with hidden lines dashed, and a title block;
    write OUT (svg, ps, eps, pdf, png, tex, dxf, json).

    A named page lies on the side that gives the views more room. Several INPUTs become a sheet each, the pages of one
    PDF; so do the parts of one with --each-part.
    """
    from vectorplot.pictures.nothing_seen import why_nothing
    from vectorplot.pictures.sheet_annotations import part_scenes
    from vectorplot.pictures.technical_sheet import technical_sheet
    from vectorplot.scene.page import Page, SheetSettings

    landscape = told.pop("landscape")
    asked, upright = told.pop("sheet"), told["up"] is not None
    told |= {"cut_spacing_mm": told.pop("cut_spacing"), "title": told["title"] or None}
    told["frame"] = told["frame"] or None
    # What is not said here the scene may say.
    told |= {name: told[name] or None for name in ("section", "detail_view", "breakout", "interrupted")}
    told |= {name: dict(told[name]) or None for name in ("fields", "made_of")}

    apart, each_part = told.pop("explode"), told.pop("each_part")
    parts = told.pop("parts")
    sources = [Source((one,), upright=upright, parts=parts) for one in scene_file]
    if each_part:
        if len(sources) > 1:
            raise click.UsageError("--each-part is of one INPUT")
        with reported_warnings(quiet=quiet):
            whole = sources[0].read()
        sources = [ReadSource(scene_file, scene=one) for one in (whole, *part_scenes(whole))]

    def page(number: int, scene: Scene, report: Report) -> Drawing:
        usual = "1" if len(sources) == 1 else f"{number + 1}/{len(sources)}"
        said = usual if asked is None else asked
        of_part = each_part and number > 0
        options = dict(told)
        if of_part:
            made_of = {**dict((scene.sheet or SheetSettings()).made_of or ()), **(told["made_of"] or {})}
            material = {"MATERIAL": made_of[scene.title]} if scene.title in made_of else {}
            options |= {**_OF_ASSEMBLY, "fields": {**(told["fields"] or {}), **material}}
        if landscape:
            options["page"] = _lying(options["page"], options["standard"], scene.sheet or SheetSettings())
        shown = scene if of_part else moved_apart(scene, apart)
        named = replace(shown, title=scene.title or _name_of_mesh(sources[number].paths[0]))
        made = technical_sheet(named, **options, sheet=said, progress=report.progress, explain=report.explain)
        warn_of_nothing(sources[number], made, lambda: why_nothing(scene, None, Page()))
        return made

    written = drawing_format(out, format_)
    overlaid = told["text"] == "latex"
    if overlaid:
        told["text"] = "real"
        check_overlaid(out, written)
    if len(sources) > 1:
        if written != "pdf":
            several = "the sheets of parts" if each_part else "several INPUTs"
            raise click.UsageError(f"{several} become the pages of a PDF: OUT must end in .pdf")
        if overlaid:
            raise click.UsageError("--text latex is of one sheet")
        make_pages(sources, out, page, quiet=quiet, explain=explain)
        return
    make_picture(
        sources[0],
        out,
        written,
        partial(page, 0),
        quiet=quiet,
        explain=explain,
        overlaid=overlaid,
    )
