"""``vectorplot draw``: a scene or a mesh becomes strokes on a page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import of_option, place
from vectorplot.cli.options import (
    BACKGROUND,
    DEPTH_CUE,
    DRAWING_FORMATS,
    FONT,
    FRAME,
    HALO,
    HATCHING_OPTIONS,
    LAYERS,
    PAGE_OPTIONS,
    SHORTEST,
    STROKE_OPTIONS,
    TEXT,
    TILES,
    TITLE,
    TOLERANCE,
    crease_angle_option,
    hatching_from,
    lines_option,
    picture_verb,
)

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.pictures.pipeline import StageReport
    from vectorplot.scene.scene import Scene


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
    *HATCHING_OPTIONS,
    LAYERS,
    click.option(
        "--unplotted",
        default="",
        metavar="LAYER,...",
        show_default=False,
        help="Layers that plotters skip.  [default: none]",
    ),
    click.option(
        "--curves", type=of_option("curves"), default="bezier", help="How curves and circles of meshes leave."
    ),
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
    from vectorplot.drawing.plotting import DOWN_MM_PER_S, LIFT_S, UP_MM_PER_S, plot_estimate
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
