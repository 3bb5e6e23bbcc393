"""Smooth surfaces as painted polygons: their outline, and their colours."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.truth import on_page
from vectorplot.accuracy.wrong_pixels import pixels_of, wrong_share
from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.features.parametric.contour import contour
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.curve_distance import hausdorff
from vectorplot.tolerances.of_measuring import OUTLINE_ACCURACY_MM, TRUE_CONTOUR

TORUS, CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

SPECK_MM2 = 1.0
"""Holes, and parts in them, of a smaller area lie between polygons that rounding has set apart."""

COLUMNS, ROWS, LEVELS = 420, 594, 3
"""The pixels that colours are compared in, and by how many of 255 steps they may differ."""

FINEST_MM = 0.01
"""The tolerance of the picture that colours are compared with."""


def painted(tolerance: float) -> Drawing:
    """The torus painted within a tolerance, in mm."""
    return paint(Scene((Item("torus", TORUS, "blue"),)), CAMERA, shadows="none", tolerance_mm=tolerance, jobs=1)


def polygons(drawing: Drawing) -> int:
    """How many polygons a drawing has."""
    return sum(len(mark) for layer in drawing.layers for mark in layer.fills)


def outlines(drawing: Drawing) -> list[Floats]:
    """The borders (n,2) of all that polygons cover."""
    from shapely import Polygon, get_parts, make_valid, polygons, union_all

    rings = [np.split(mark.points, mark.offsets[1:-1]) for layer in drawing.layers for mark in layer.fills]
    whole = union_all(make_valid([Polygon(ring) for part in rings for ring in part if len(ring) > 2]))
    parts = [part for part in get_parts(whole) if part.area > SPECK_MM2]
    holes = [hole.coords for part in parts for hole in part.interiors if polygons(hole).area > SPECK_MM2]
    return [np.asarray(line) for line in (*(part.exterior.coords for part in parts), *holes)]


def _outline() -> Study:
    true = contour(TORUS, CAMERA.eye, tracing=Tracing(tolerance=TRUE_CONTOUR))

    def error(drawing: Drawing) -> float:
        truth = [on_page(drawing.page_from_world, true[k]) for k in range(len(true))]
        return hausdorff(outlines(drawing), truth, accuracy=OUTLINE_ACCURACY_MM)

    return Study((Way("painted polygons", painted, 1.0),), error, polygons)


def _colours() -> Study:
    truth = pixels_of(painted(FINEST_MM), COLUMNS, ROWS)

    def error(drawing: Drawing) -> float:
        return wrong_share(pixels_of(drawing, COLUMNS, ROWS), truth, LEVELS)

    return Study((Way("painted polygons", painted),), error, polygons, exact=lambda: painted(FINEST_MM))


PAINTED_OUTLINE = Approximation(
    name="painted-outline",
    title="Outlines of painted surfaces",
    about="A torus as painted polygons. The error is the Hausdorff distance of their outline from the true contour on "
    "the page.",
    knob="tolerance in mm",
    values=(1.0, 0.5, 0.2, 0.1, 0.05),
    limits=(FINEST_MM, 10.0),
    unit="mm",
    counts="polygons",
    study=_outline,
)

PAINTED_COLOURS = Approximation(
    name="painted-colours",
    title="Colours of painted surfaces",
    about="The same torus in pixels of half a millimetre. The error is how many of them have another colour, by more "
    "than 3 of 255 steps, than in the picture of the finest tolerance, 0.01 mm.",
    knob="tolerance in mm",
    values=(1.0, 0.5, 0.2, 0.1, 0.05),
    limits=(FINEST_MM, 10.0),
    unit="% of the pixels",
    counts="polygons",
    study=_colours,
)
