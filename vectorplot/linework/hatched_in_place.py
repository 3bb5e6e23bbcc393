"""The strokes that hatch faces of a scene, on a picture of it that has its place."""

from __future__ import annotations

from functools import partial

from vectorplot.drawing.drawing import Paths
from vectorplot.geometry.budget import budget_of
from vectorplot.linework.lines_in_place import lines_in_place
from vectorplot.linework.traceable import Traceable
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.placement import Placement


def hatched_in_place(
    shapes: Traceable,
    placement: Placement,
    hatch: Hatching | Stippling | None,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
) -> Paths:
    """The strokes in what is seen of a scene's faces, as they come. hatch and all else as of draw."""
    from vectorplot.painting.hatched import hatched

    walk = shapes.walk
    trace = partial(
        lines_in_place,
        view=shapes.view,
        faces=shapes.faces,
        placement=placement,
        kinds=frozenset(),
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
    )
    filled = partial(
        hatched,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget_of(budget),
        progress=walk.fraction("hatching"),
    )
    return walk.run("hatching", filled, shapes.scene, placement, hatch, trace)
