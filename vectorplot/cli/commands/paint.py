"""``vectorplot paint``: a scene or a mesh becomes filled polygons on a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.option_values import of_option
from vectorplot.cli.options import (
    BACKGROUND,
    DEPTH_CUE,
    DRAWING_FORMATS,
    EXPOSURE,
    FACE_OPTIONS,
    FONT,
    FRAME,
    LIGHTS,
    OVERLAID_OPTIONS,
    PAGE_OPTIONS,
    REFLECTIONS,
    SHORTEST,
    TEXT,
    TILES,
    TITLE,
    TOLERANCE,
    crease_angle_option,
    lines_option,
    picture_verb,
    shadows_option,
)

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.scene.scene import Scene


@picture_verb(
    "Paint a scene or a mesh with filled polygons.",
    DRAWING_FORMATS,
    *PAGE_OPTIONS,
    LIGHTS,
    EXPOSURE,
    shadows_option("paint", "Whether lights cast shadows."),
    *FACE_OPTIONS,
    REFLECTIONS,
    click.option(
        "--fills",
        type=of_option("fills"),
        default="painted",
        help="Painted one over the other, only what is seen of each, or blank with edges.",
    ),
    lines_option("Lines on top, or on blank polygons"),
    crease_angle_option("Sharper edges are creases; meshes look round where faces meet at less."),
    *OVERLAID_OPTIONS,
    DEPTH_CUE,
    BACKGROUND,
    TOLERANCE,
    TITLE,
    FRAME,
    TEXT,
    FONT,
    SHORTEST,
    TILES,
)
def paint(scene: Scene, **told: Any) -> Drawing:
    """Paint INPUT, a scene file (- for stdin), mesh (obj, stl, ply, off, glb, vtk, vtu), CAD part (step, iges, brep),
    molecule (xyz, pdb, cif) or terrain (asc, xyz), and write OUT (svg, ps, eps, pdf, png, tex, dxf, json).

    Camera options replace the fields of the camera in the scene file one by one.
    """
    from vectorplot.pictures.paint import paint as paint_scene

    return paint_scene(scene, **keywords(told))


def keywords(told: dict[str, Any]) -> dict[str, Any]:
    """What the options of the command are to the function."""
    rest = dict(told)
    return {"smooth": not rest.pop("flat"), **rest}
