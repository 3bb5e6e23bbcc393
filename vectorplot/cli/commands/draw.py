"""``vectorplot draw``: a scene or a mesh becomes strokes on a page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import at_least, number, of_option, place
from vectorplot.cli.options import (
    BACKGROUND,
    CURVES,
    DEPTH_CUE,
    DRAWING_FORMATS,
    FONT,
    FRAME,
    HALO,
    LAYERS,
    PAGE_OPTIONS,
    REFLECTIONS,
    SHORTEST,
    STROKE_OPTIONS,
    TEXT,
    TILES,
    TITLE,
    TOLERANCE,
    crease_angle_option,
    lines_option,
    picture_verb,
)

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.pictures.pipeline import StageReport
    from vectorplot.scene.hatching import Hatching, Stippling
    from vectorplot.scene.scene import Scene


# Options that say how faces are hatched.

_OF = {"spacing": "spacing_mm", "angle": "angle_deg", "cross": "cross", "along": "along", "hatch_width": "width_mm"}
"""The options that say more of a hatching, and the fields of it that they fill."""

HATCHING_OPTIONS = (
    click.option(
        "--hatch",
        type=click.Choice(["none", "tone", "colour", "even"]),
        default="none",
        help="Faces hatched: by light and shadow, by light and colour, or all alike.",
    ),
    click.option(
        "--spacing",
        type=at_least(0.01),
        metavar="MM",
        help="From stroke to stroke where it is darkest.  [default: 0.6]",
    ),
    click.option("--angle", type=number, metavar="DEG", help="Of the strokes.  [default: 45]"),
    click.option("--cross", is_flag=True, default=None, help="Strokes cross where it is darker than a half."),
    click.option(
        "--along",
        type=click.Choice(["page", "surface", "slope", "level", "curvature", "asymptotic", "isophotes"]),
        help="Parallel on the page; in planes of faces, along parameter lines; or flowing.  [default: page]",
    ),
    click.option("--stipple", type=click.IntRange(1), metavar="N", help="So many dots in place of strokes."),
    click.option(
        "--hatch-width",
        type=at_least(0.01),
        metavar="MM",
        help="Of the pen that hatches, or makes dots.  [default: 0.18, of dots 0.25]",
    ),
)


def hatching_from(options: Mapping[str, Any]) -> tuple[Hatching | Stippling | None, dict[str, Any]]:
    """The hatching or stippling that the options of a command ask for, None where they ask for none, and the other
    options.

    Errors: bad usage for options of a hatching without one, or beside dots; InputError as in Hatching and Stippling.
    """
    from vectorplot.scene.hatching import Hatching, Stippling

    given = {field: options[name] for name, field in _OF.items() if options[name] is not None}
    rest = {name: value for name, value in options.items() if name not in (*_OF, "hatch", "stipple")}
    if options["stipple"] is not None:
        strokes = [name for name, field in _OF.items() if field in given and name != "hatch_width"]
        if strokes:
            raise click.UsageError(f"--{strokes[0]} is for strokes, and --stipple makes dots")
        by: Any = "tone" if options["hatch"] == "none" else options["hatch"]
        return Stippling(options["stipple"], by, **given), rest
    if options["hatch"] == "none":
        if given:
            name = next(name for name, field in _OF.items() if field in given)
            raise click.UsageError(f"--{name.replace('_', '-')} goes with --hatch tone, colour or even")
        return None, rest
    return Hatching(options["hatch"], **given), rest


@picture_verb(
    "Draw a scene or a mesh with exact hidden lines.",
    DRAWING_FORMATS,
    click.option(
        "--panorama",
        type=place,
        metavar="X,Y[,Z]",
        help="What is seen all round from there, unrolled; X,Y is a place on a terrain.",
    ),
    click.option(
        "--strips",
        type=click.IntRange(1, 36),
        metavar="N",
        help="Strips that a panorama is cut into.  [default: as many as make it largest]",
    ),
    *PAGE_OPTIONS,
    lines_option("Kinds of lines", default=None, note="  [default: all but edges; in wireframes all but intersection]"),
    crease_angle_option("Sharper edges are creases."),
    *STROKE_OPTIONS,
    click.option("--scale-pens", is_flag=True, help="Widths and dashes are those on A4, and grow with the page."),
    click.option("--thin-ends", is_flag=True, help="Lines that converge stop early in turn, before they blot."),
    DEPTH_CUE,
    BACKGROUND,
    HALO,
    REFLECTIONS,
    *HATCHING_OPTIONS,
    LAYERS,
    click.option(
        "--unplotted",
        default="",
        metavar="LAYER,...",
        show_default=False,
        help="Layers that plotters skip.  [default: none]",
    ),
    CURVES,
    TOLERANCE,
    TITLE,
    FRAME,
    TEXT,
    FONT,
    click.option(
        "--longest",
        "longest_mm",
        type=of_option("longest_mm"),
        metavar="MM",
        help="Longer strokes leave in parts.  [default: whole]",
    ),
    SHORTEST,
    TILES,
    click.option(
        "--certificate",
        type=click.Path(dir_okay=False),
        metavar="FILE",
        help="Also write what proves each stroke visible or hidden, as JSON; it is checked beside OUT as JSON.",
    ),
)
def draw(scene: Scene, **told: Any) -> Drawing:
    """Draw INPUT, a scene file (- for stdin), mesh (obj, stl, ply, off, glb, vtk, vtu), CAD part (step, iges, brep),
    molecule (xyz, pdb, cif) or terrain (asc, xyz), and write OUT (svg, ps, eps, pdf, png, tex, dxf, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    from vectorplot.pictures.draw import draw as draw_scene

    rest = keywords(told)
    standing, strips = rest.pop("panorama"), rest.pop("strips")
    if standing is not None:
        hatched = rest.pop("hatch") is not None
        drawing = _all_round(scene, standing, strips, hatched, rest)
    elif strips is not None:
        raise click.UsageError("--strips goes with --panorama")
    else:
        drawing = draw_scene(scene, **rest)
    if rest["explain"] is not None:
        for report in _plotting(drawing):
            rest["explain"](report)
    return drawing


def _plotting(drawing: Drawing) -> Iterator[StageReport]:
    """How far the pens of a plotter go for a drawing, how often they are lifted, and how long that takes."""
    from vectorplot.drawing.pen_order import DOWN_MM_PER_S, LIFT_S, UP_MM_PER_S, plot_estimate
    from vectorplot.pictures.pipeline import StageReport, peak_mb

    found, peak = plot_estimate(drawing), peak_mb()
    seconds = f"seconds at {DOWN_MM_PER_S:g} mm/s, in the air {UP_MM_PER_S:g}, {LIFT_S:g} s to lift and set down"
    yield StageReport("pen down", "mm that a plotter draws", 0.0, round(found.down_mm), peak)
    yield StageReport("pen up", "mm in the air between strokes", 0.0, round(found.up_mm), peak)
    yield StageReport("lifts", "how often the pen goes up", 0.0, found.lifts, peak)
    yield StageReport("plotting", seconds, 0.0, round(60.0 * found.minutes()), peak)


def keywords(told: dict[str, Any]) -> dict[str, Any]:
    """What the options of the command are to the function. Bad usage as in hatching_from."""
    hatch, rest = hatching_from(told)
    return {**rest, "hatch": hatch}


def _all_round(
    scene: Scene, standing: tuple[float, ...], strips: int | None, hatched: bool, told: dict[str, Any]
) -> Drawing:
    """The panorama from a place. Bad usage for options that a panorama has nothing to do for."""
    from vectorplot.geometry.camera import Panorama
    from vectorplot.pictures.panorama import panorama

    given = click.get_current_context().params
    unlike = {name: given[name] for name in ("eye", "target", "up", "twist", "fov", "height", "near", "far", "view")}
    flags = {name: given[name] or None for name in ("parallel", "scale_pens", "thin_ends")}
    cue = {"depth-cue": told["depth_cue"], "off-by": told["off_by"], "within": told["within"]}
    halo = {"halo": told["halo_mm"] or None, "no-fit": None if told["fit"] else True, "hatch": hatched or None}
    if told["text"] != "strokes":
        raise click.UsageError("letters of panoramas are strokes: --text does not go with --panorama")
    for name, value in {**unlike, **flags, **halo, **cue, "hidden": told["hidden"]}.items():
        if value is not None and value != "none":
            raise click.UsageError(f"--{name.replace('_', '-')} does not go with --panorama")
    unused = (
        "camera",
        "fit",
        "hidden",
        "halo_mm",
        "scale_pens",
        "thin_ends",
        "depth_cue",
        "text",
        "font",
        "off_by",
        "within",
    )
    rest = {name: value for name, value in told.items() if name not in unused}
    return panorama(scene, Panorama(standing, strips=strips), **rest)
