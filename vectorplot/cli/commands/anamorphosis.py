"""``vectorplot anamorphosis``: a drawing to lay around a curved mirror, in which it is seen undistorted."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.commands.draw import HATCHING_OPTIONS, hatching_from
from vectorplot.cli.option_values import length, of_option, point
from vectorplot.cli.options import (
    BUDGET,
    CAMERA_OPTIONS,
    CURVES,
    CUT_OPTIONS,
    DRAWING_FORMATS,
    EXAGGERATION,
    EXPLAIN,
    HALO,
    INPUT,
    JOBS,
    LANDSCAPE,
    LAYERS,
    LINE_OPTIONS,
    MEASURE_OPTIONS,
    MOLECULES,
    OUT,
    QUIET,
    REFLECTIONS,
    STROKE_OPTIONS,
    TILES,
    TOLERANCE,
    Told,
    crease_angle_option,
    drawing_format,
    format_option,
    lines_option,
    with_options,
)
from vectorplot.cli.picture import Companion, ReadSource, Source, make_picture, tiles_beside

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.pictures.anamorphosis import Drawn, Laid
    from vectorplot.scene.scene import Scene
    from vectorplot.shading.image import Image

_MIRROR = ("radius_mm", "height_mm", "viewer", "seen_mm")
"""What is told of the mirror, besides its kind."""

_PAGE = ("page", "curves", "tolerance_mm", "jobs")
"""What is told of the page, and how the lines leave."""

_SETTING = ("mirror", *_MIRROR, *_PAGE)

_FILES = ("scene_file", "out", "format_", "quiet", "explain", "exaggeration", "molecules", "tiles", "landscape")
"""Parameters that say what is read and written, and what is said of it."""


@click.command(short_help="Bend a drawing so that a curved mirror shows it.", context_settings={"show_default": True})
@with_options(
    INPUT,
    OUT,
    format_option(DRAWING_FORMATS),
    EXAGGERATION,
    MOLECULES,
    click.option(
        "--mirror",
        type=of_option("mirror"),
        default="cylinder",
        help="What stands on the paper; none: one looks at the paper aslant.",
    ),
    click.option(
        "--radius", "radius_mm", type=length, default="25mm", metavar="LENGTH", help="Radius of the mirror at its foot."
    ),
    click.option(
        "--tall",
        "height_mm",
        type=length,
        metavar="LENGTH",
        help="Height of the mirror.  [default: of a cone 2 radii, of a cylinder as needed]",
    ),
    click.option(
        "--viewer",
        type=point,
        metavar="X,Y,Z",
        help="The eye, mm from the middle of the mirror's foot: right, away from the lower edge of the page, up.  "
        "[default: 0,-16,14 radii, of a cone 0,0,16 radii, without a mirror 0,-400,150 mm]",
    ),
    click.option(
        "--seen",
        "seen_mm",
        type=length,
        metavar="LENGTH",
        help="Longer side of the picture, as it seems to stand in the mirror.  [default: as suits the mirror]",
    ),
    click.option(
        "--preview",
        type=click.Path(dir_okay=False),
        metavar="FILE",
        help="Also write what is seen then: the mirror, the picture in it, and the paper.",
    ),
    click.option("--page", metavar="SIZE", help="A0 to A6, letter, ... or WIDTHxHEIGHT in mm.  [default: as needed]"),
    LANDSCAPE,
    *CAMERA_OPTIONS,
    lines_option("Kinds of lines", default=None, note="  [default: all but edges]"),
    crease_angle_option("Sharper edges are creases."),
    *STROKE_OPTIONS,
    HALO,
    REFLECTIONS,
    *HATCHING_OPTIONS,
    LAYERS,
    CURVES,
    TOLERANCE,
    TILES,
    *LINE_OPTIONS,
    *CUT_OPTIONS,
    *MEASURE_OPTIONS,
    BUDGET,
    JOBS,
    EXPLAIN,
    QUIET,
)
def anamorphosis(**params: Any) -> None:
    """Draw INPUT, whatever draw takes or a drawing that was saved as JSON, bent so that it is seen undistorted in a
    mirror that stands on the paper, or from a low eye; write OUT (svg, ps, eps, pdf, png, tex, dxf, json) in true size.

    Layers of their own show where the mirror stands and where the eye has to be.
    """
    if params["landscape"] and params["page"] is not None:
        params["page"] = f"{params['page'].split(' ')[0]} landscape"
    out, paths, preview = params["out"], params["scene_file"], params.pop("preview")
    written = drawing_format(out, params["format_"])
    setting = {name: params[name] for name in _SETTING}
    of_draw = {name: value for name, value in params.items() if name not in _FILES and name not in _SETTING}
    told = Told.of({**of_draw, "jobs": params["jobs"], "curves": params["curves"]})
    fineness = (params["exaggeration"], told.camera.says_where(), None, params["molecules"])
    source = Source(paths, *fineness)
    if len(paths) == 1 and paths[0].lower().endswith(".json"):
        from vectorplot.scene.scene import Scene

        _none_given(of_draw)
        source = ReadSource(paths, *fineness, scene=Scene(()))

    def picture(scene: Scene, report: Report) -> Drawing:
        from vectorplot.pictures.anamorphosis import on_page

        return _laid(on_page, _drawn(source, told, scene, report), setting, report)

    beside = [] if params["tiles"] is None else tiles_beside(params, written)
    if preview is not None:
        beside.append(_preview(source, told, setting, preview, out))
    make_picture(
        source,
        out,
        written,
        partial(picture),
        quiet=params["quiet"],
        explain=params["explain"],
        jobs=params["jobs"],
        beside=beside,
    )


def _none_given(of_draw: Collection[str]) -> None:
    """Bad usage for options that say how a drawing is made, where one is read."""
    context = click.get_current_context()
    for option in context.command.params:
        given = context.get_parameter_source(str(option.name)) is click.core.ParameterSource.COMMANDLINE
        if given and option.name in of_draw:
            raise click.UsageError(f"{option.opts[0]} does not go with a drawing that was saved: it is bent as it is")


def _drawn(source: Source, told: Told, scene: Scene, report: Report) -> Drawn:
    """What draws a scene as the user told, or the drawing of a file."""
    from vectorplot.pictures.anamorphosis import picture_of

    if isinstance(source, ReadSource):
        from vectorplot.backends.json import read_drawing

        return picture_of(read_drawing(source.paths[0]), None)
    lined, keywords = told.with_lines(scene)
    hatch, rest = hatching_from(keywords)
    return picture_of(lined, **rest, hatch=hatch, explain=report.explain)


def _laid(laid: Laid, drawn: Drawn, setting: Mapping[str, Any], report: Report) -> Drawing:
    """What is laid on a page of a picture, as the user told."""
    from vectorplot.pictures.anamorphosis import AnamorphicMirror, anamorphosis_of

    mirror = AnamorphicMirror(setting["mirror"], **{name: setting[name] for name in _MIRROR})
    how = {name: setting[name] for name in _PAGE}
    return anamorphosis_of(drawn, laid, mirror, **how, progress=report.progress, explain=report.explain)


def _preview(source: Source, told: Told, setting: Mapping[str, Any], path: str, out: str) -> Companion:
    """The file of what is seen from the eye. Errors: bad usage for one that is OUT."""
    if path == "-" or os.path.realpath(path) == os.path.realpath(out):
        raise click.UsageError("--preview needs a file of its own")
    written = drawing_format(path, None)

    def content(scene: Scene, made: Drawing | Image) -> bytes:
        from vectorplot.cli.picture import SILENT
        from vectorplot.pictures.anamorphosis import as_seen
        from vectorplot.save import write

        seen = _laid(as_seen, _drawn(source, told, scene, SILENT), {**setting, "page": None}, SILENT)
        return write(seen, written)

    return Companion("preview", path, content)
