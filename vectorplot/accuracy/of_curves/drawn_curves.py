"""Drawn curves: the contour of a torus as it leaves the verb draw."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades
from vectorplot.accuracy.truth import on_page
from vectorplot.arrays import Floats
from vectorplot.curves.bezier.paths import flattened
from vectorplot.draw import draw
from vectorplot.drawing.drawing import CurvedStrokes, Drawing
from vectorplot.features.parametric.contour import contour
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.curve_distance import hausdorff
from vectorplot.tolerances.of_measuring import FINEST_STROKE_MM, PART_OF_FINEST, TRUE_CONTOUR

TORUS, CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

CHORDS_MM = PART_OF_FINEST * FINEST_STROKE_MM
"""The chords that errors are measured by are so near to their curves."""


def _study() -> Study:
    scene = Scene((Item("torus", TORUS),))
    true = contour(TORUS, CAMERA.eye, tracing=Tracing(tolerance=TRUE_CONTOUR))
    lines = [true[k] for k in range(len(true))]

    def made(tolerance: float) -> Drawing:
        return draw(scene, CAMERA, lines="contour", hidden="solid", tolerance_mm=tolerance, jobs=1)

    def error(drawing: Drawing) -> float:
        truth = [on_page(drawing.page_from_world, line) for line in lines]
        return hausdorff(polylines(drawing), truth, accuracy=CHORDS_MM)

    def count(drawing: Drawing) -> int:
        return sum(len(mark.beziers.control) for mark in curved(drawing))

    return Study((Way("strokes", made, 1.0),), error, count)


def curved(drawing: Drawing) -> list[CurvedStrokes]:
    """The strokes of a drawing that are drawn as curves."""
    return [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]


def polylines(drawing: Drawing) -> list[Floats]:
    """The curved strokes of a drawing as polylines that are as good as they."""
    found = []
    for mark in curved(drawing):
        points, offsets = flattened(mark.beziers.control, mark.beziers.offsets, CHORDS_MM)
        found += [part for part in np.split(points, offsets[1:-1]) if len(part)]
    return found


DRAWN_CURVES = Approximation(
    name="drawn-curves",
    title="Strokes of smooth curves",
    about="The contour of a torus as draw writes it, hidden parts with it: traced, refined to chords, fitted with "
    "cubic segments. The error is the Hausdorff distance of strokes and true contour on the page.",
    knob="tolerance in mm",
    values=decades(-1, -3, 5),
    limits=(FINEST_STROKE_MM, 10.0),
    unit="mm",
    counts="segments",
    study=_study,
)
