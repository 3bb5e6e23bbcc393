"""Options that the verbs which make pictures share, each written once, and the command that such a verb becomes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import reduce, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.cut_options import CUT_OPTIONS, CutOptions
from vectorplot.cli.line_options import LINE_OPTIONS, LineOptions
from vectorplot.cli.many.picture_per_file import PictureVerb, is_folder, make_pictures
from vectorplot.cli.many.workers import WORKER_OPTIONS, WorkerOptions
from vectorplot.cli.options import KINDS, at_least, between, depth_cue, exposure, format_of, kinds, light
from vectorplot.cli.picture import Report, Source, make_picture, picture_contents, picture_made
from vectorplot.cli.view_options import CAMERA_OPTIONS, CameraOptions, PageOptions, camera_from, page_from

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene
    from vectorplot.shading.raster.image import Image

Command = Callable[..., None]
Option = Callable[[Command], Command]

DRAWING_FORMATS = ("svg", "ps", "eps", "pdf", "png", "tex", "dxf", "json")
"""What a drawing on a page is written as."""

ANGLE = at_least(0.0, at_most=180.0)
POSITIVE = between(0.0, math.inf)

LIGHTS = click.option(
    "--lights",
    type=light,
    multiple=True,
    # A tuple without lamps would be darkness; not a word about lamps leaves those of the scene.
    callback=lambda _context, _parameter, lamps: lamps or None,
    metavar="X,Y,Z[,WORD...]",
    help="Lamp in place of those of the scene; its intensity (0 to 1), a colour, parallel, fading; repeat it for more.",
)

EXPOSURE = click.option(
    "--exposure",
    type=exposure,
    metavar="FACTOR",
    help="To the intensities of all lights; fitted: the brightest face as bright as can be.  [default: of the scene]",
)

DEPTH_CUE = click.option(
    "--depth-cue",
    type=depth_cue,
    metavar="WORD,...[,N]",
    help="Lines thinner (width) or paler (shade) the farther away, in N steps (5); or none.  [default: of the scene]",
)

BACKGROUND = click.option(
    "--background",
    metavar="COLOUR",
    help="Behind the picture: a palette, a plain colour or #rrggbb.  [default: that of the scene or the style]",
)

TOLERANCE = click.option(
    "--tolerance", "tolerance_mm", type=POSITIVE, default=0.02, metavar="MM", help="For approximations."
)

TITLE = click.option("--title", default="", metavar="TEXT", show_default=False, help="Letters in the lower margin.")

FRAME = click.option("--frame", is_flag=True, help="A rectangle in the margin.")

TEXT = click.option(
    "--text",
    type=click.Choice(["strokes", "real", "latex"]),
    default="strokes",
    help="Letters: strokes of the pen; in fonts of the reader; or, with a .pdf or .eps, in a .tex beside it.",
)

BUDGET = click.option(
    "--budget", type=POSITIVE, default=1.0, metavar="FACTOR", help="Times the usual work on a surface."
)

JOBS = click.option(
    "--jobs", type=click.IntRange(1), metavar="N", help="Threads to work on.  [default: as many as processors]"
)

EXPLAIN = click.option("--explain", is_flag=True, help="Print stages, times, counts, memory and errors on stderr.")

QUIET = click.option("-q", "--quiet", is_flag=True, help="No warnings, no progress bar.")

INPUT = click.argument("scene_file", type=click.Path(), nargs=-1, required=True, metavar="INPUT...")

EXAGGERATION = click.option(
    "--exaggeration",
    type=POSITIVE,
    metavar="FACTOR",
    help="Times that heights of a terrain file are as high.  [default: 1 where they are to be seen]",
)

OUT = click.option("-o", "--out", required=True, type=click.Path(), metavar="OUT", help="File to write; - for stdout.")

OUT_OR_FOLDER = click.option(
    "-o",
    "--out",
    required=True,
    type=click.Path(),
    metavar="OUT",
    help="File to write; - for stdout; FOLDER/ for a picture of each INPUT.",
)

_OF_THE_FILE = ("scene_file", "out", "format_", "exaggeration", "quiet", "explain")
"""Parameters that say what is read and written, and what is said of it."""

SILENT = Report(None, None)
"""Nobody is told anything."""


def format_option(formats: Sequence[str]) -> Option:
    """``--format``, for a verb that writes these."""
    return click.option(
        "--format", "format_", type=click.Choice(formats), help="Format, where the name of OUT does not tell."
    )


def lines_option(meaning: str, *, default: str | None = "none", note: str = "") -> Option:
    """``--lines``, with what they are to the verb; note: what the help text says after the words."""
    return click.option("--lines", type=kinds, default=default, metavar="KIND,...", help=f"{meaning}: {KINDS}.{note}")


def crease_angle_option(meaning: str) -> Option:
    """``--crease-angle``, with what sharper edges are to the verb."""
    return click.option("--crease-angle", "crease_angle_deg", type=ANGLE, default=25.0, metavar="DEG", help=meaning)


def shadows_option(ways: Sequence[str], meaning: str) -> Option:
    """``--shadows``, with the ways that the verb has of finding them; auto is one of them."""
    return click.option("--shadows", type=click.Choice(ways), default="auto", help=meaning)


@dataclass(frozen=True)
class Told:
    """What the user told a verb: camera, page (None: pictures of pixels have none), lines on all that is shown, cuts
    through it, and all else.

    rest: values by the keywords of the function of the package that has the verb's name.
    """

    camera: CameraOptions
    page: PageOptions | None
    added: LineOptions
    cuts: CutOptions
    rest: Mapping[str, Any]

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Told:
        """What the options of a command say. Bad usage for options that contradict each other."""
        groups = (CameraOptions, PageOptions, LineOptions, CutOptions, WorkerOptions)
        taken = {field.name for group in groups for field in fields(group)}
        return cls(
            CameraOptions.of(options),
            PageOptions.of(options) if "page" in options else None,
            LineOptions.of(options),
            CutOptions.of(options),
            {name: value for name, value in options.items() if name not in taken},
        )

    def keywords(self, scene: Scene) -> dict[str, Any]:
        """Keywords of the verb's function for a scene: its camera and page but for what the user said, and the rest."""
        camera = camera_from(self.camera, scene)
        page = {} if self.page is None else {"page": page_from(self.page, scene)}
        return {"camera": camera, **page, **self.rest}

    def with_lines(self, scene: Scene) -> tuple[Scene, dict[str, Any]]:
        """A scene with the lines and the cuts that the user asked for, and the keywords of the verb's function, which
        draws them."""
        cut = self.cuts.of_scene(self.added.with_materials(scene))
        keywords = self.keywords(cut)
        lined, kinds = self.added.in_scene(cut)
        if keywords.get("lines") is not None:
            keywords["lines"] = tuple(dict.fromkeys((*keywords["lines"], *kinds)))
        return lined, keywords


def check_overlaid(out: str, format_: str) -> None:
    """Bad usage for letters over what LaTeX takes for no picture."""
    from vectorplot.save import OVERLAID

    if out == "-" or format_ not in OVERLAID or not out.lower().endswith(f".{format_}"):
        raise click.UsageError("--text latex needs a name that ends in .pdf or .eps")


def with_options(*options: Option) -> Callable[[Command], Command]:
    """A decorator that gives a command these options, in this order."""
    return lambda command: reduce(lambda inner, option: option(inner), reversed(options), command)


def picture_verb(
    short_help: str, formats: Sequence[str], *options: Option
) -> Callable[[Callable[..., Drawing | Image]], click.Command]:
    """A decorator that makes a command of a function: a scene, and what the user told, become a picture.

    The function's name and docstring are the command's name and help; its keywords are those of Told, progress and
    explain. options: the verb's own, between those for INPUT, OUT and camera and those for work and reports; each is
    named as the keyword it becomes.
    """

    def command_of(verb: Callable[..., Drawing | Image]) -> click.Command:
        def asked(params: Mapping[str, Any]) -> dict[str, Any]:
            """What is to be pictured and how, as make_picture and picture_contents take it."""
            told = Told.of({name: value for name, value in params.items() if name not in _OF_THE_FILE})
            written, jobs = format_of(params["out"], params["format_"], formats), told.rest["jobs"]
            overlaid = told.rest.get("text") == "latex"
            if overlaid:
                told = replace(told, rest={**told.rest, "text": "real"})
                check_overlaid(params["out"], written)

            def picture(scene: Scene, report: Report) -> Drawing | Image:
                lined, keywords = told.with_lines(scene)
                return verb(lined, **keywords, progress=report.progress, explain=report.explain)

            source = Source(params["scene_file"], params["exaggeration"], upright=told.camera.says_where())
            return {"source": source, "format_": written, "picture": picture, "jobs": jobs, "overlaid": overlaid}

        def content(params: Mapping[str, Any]) -> bytes:
            """What a file of pictures in a folder holds."""
            return picture_contents(name=Path(params["out"]).name, report=SILENT, **asked(params))[0]

        def made(params: Mapping[str, Any]) -> Drawing | Image:
            """The picture itself."""
            said = asked(params)
            return picture_made(said["source"], said["picture"], SILENT)

        @click.command(cls=PictureVerb, short_help=short_help, context_settings={"show_default": True})
        @with_options(
            INPUT,
            OUT_OR_FOLDER,
            format_option(formats),
            EXAGGERATION,
            *CAMERA_OPTIONS,
            *options,
            *LINE_OPTIONS,
            *CUT_OPTIONS,
            BUDGET,
            JOBS,
            *WORKER_OPTIONS,
            EXPLAIN,
            QUIET,
        )
        @wraps(verb)
        def command(**params: Any) -> None:
            if is_folder(params["out"]):
                make_pictures(verb.__name__, params, formats, asked)
                return
            if WorkerOptions.of(params).given:
                raise click.UsageError("--workers and --cluster make pictures into a folder: OUT must be one, FOLDER/")
            told = asked(params)
            make_picture(out=params["out"], quiet=params["quiet"], explain=params["explain"], **told)

        assert isinstance(command, PictureVerb)
        command.content = content
        command.made = made
        return command

    return command_of
