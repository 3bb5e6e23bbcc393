"""``vectorplot develop``: bodies and surfaces become nets to cut out and fold."""

from __future__ import annotations

import warnings
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import of_option
from vectorplot.cli.options import (
    BUDGET,
    DRAWING_FORMATS,
    EXPLAIN,
    INPUT,
    JOBS,
    LANDSCAPE,
    OUT,
    QUIET,
    TILES,
    TOLERANCE,
    UNIT,
    crease_angle_option,
    drawing_format,
    format_option,
    with_options,
)
from vectorplot.cli.picture import Source, make_picture, tiles_beside

if TYPE_CHECKING:
    from vectorplot.cli.picture import Report
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene


TINY_MM = 10.0
"""A development that is no larger is hardly what was meant: a unit of its scene is no millimetre."""


def _tell_if_tiny(made: Drawing) -> None:
    """An InputWarning for a development that is tiny, with what makes it larger."""
    import numpy as np

    from vectorplot.errors import InputWarning

    points = [paths.points for layer in made.layers for paths in layer.strokes if len(paths)]
    wide, high = np.ptp(np.concatenate(points), axis=0).tolist() if points else (0.0, 0.0)
    if 0.0 < max(wide, high) < TINY_MM:
        text = f"the development is {wide:.3g} x {high:.3g} mm: --unit cm or m, or --scale 10:1, makes it larger"
        warnings.warn(text, InputWarning, stacklevel=2)


@click.command(short_help="Unfold bodies and surfaces, to be cut out.", context_settings={"show_default": True})
@with_options(
    INPUT,
    OUT,
    format_option(DRAWING_FORMATS),
    click.option("--page", metavar="SIZE", help="A0 to A6, letter, ... or WIDTHxHEIGHT in mm.  [default: as needed]"),
    LANDSCAPE,
    click.option("--scale", default="1:1", metavar="A:B", help="Mm on paper for mm in space."),
    UNIT,
    click.option(
        "--tabs", "tabs_mm", type=of_option("tabs_mm"), default=0.0, metavar="MM", help="Tabs to glue, so wide."
    ),
    click.option("--numbers", is_flag=True, help="Equal numbers at sides that belong together."),
    crease_angle_option("Polyhedra are folded along sharper edges."),
    TOLERANCE,
    TILES,
    BUDGET,
    JOBS,
    EXPLAIN,
    QUIET,
)
def develop(
    scene_file: tuple[str, ...], out: str, format_: str | None, quiet: bool, explain: bool, **told: Any
) -> None:
    """Unfold INPUT, a scene or mesh file, into nets of polyhedra and developments of surfaces, in true size, with the
    curves on them; write OUT (svg, ps, eps, pdf, png, tex, dxf, json).

    Lines to cut, mountain folds and valley folds have layers of their own.
    """
    from vectorplot.pictures.development import development

    if told.pop("landscape") and told["page"] is not None:
        told["page"] = f"{told['page'].split(' ')[0]} landscape"
    written = drawing_format(out, format_)
    told["unit"] = told["unit"] or "mm"
    told_of_tiles = {"tiles": told.pop("tiles"), "out": out, "tolerance_mm": told["tolerance_mm"]}
    beside = [] if told_of_tiles["tiles"] is None else tiles_beside(told_of_tiles, written)

    def picture(scene: Scene, report: Report) -> Drawing:
        made = development(scene, **told, progress=report.progress, explain=report.explain)
        _tell_if_tiny(made)
        return made

    jobs = told["jobs"]
    source = Source(scene_file, upright=True)
    make_picture(source, out, written, partial(picture), quiet=quiet, explain=explain, jobs=jobs, beside=beside)
