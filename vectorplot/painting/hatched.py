"""A scene hatched: the strokes in what is seen of its faces, where a picture of it has its place on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching.hatched_fills import hatched_regions
from vectorplot.drawing.hatching.toned_regions import toned_regions
from vectorplot.features.edge_splitting import Demand
from vectorplot.geometry.budget import Budget
from vectorplot.painting.coloured import coloured
from vectorplot.painting.hatching_lines import followed_lines
from vectorplot.painting.ordered_faces import ordered_faces, seen_on_page
from vectorplot.plan import plan_paint
from vectorplot.scene.coincidence.twins import without_twins
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.placement import Placement, allowed_in_space
from vectorplot.scene.scene import Scene
from vectorplot.shading.light.exposure import exposed_scene
from vectorplot.shading.light.fineness.picture_fineness import picture_fineness
from vectorplot.shading.light.illumination import AMBIENT
from vectorplot.shading.light.painted_colours import Lighting
from vectorplot.shading.light.painted_normals import painted_normals
from vectorplot.stages.walk import Walk

GRAY = "gray"
"""The palette that runs from black to white."""

TONES = 64
"""So many shades flat faces have: neighbours that differ by less share their strokes."""

ROUGHLY = 8.0
"""Shades on round bodies may be off by so many times as much as in paintings: by a hundredth of black."""

ENDS = 3.0
"""Strokes may end so many tolerances before outlines, or behind them: usually by less than half the width of a pen."""


def hatched(
    scene: Scene,
    placement: Placement,
    given: Hatching | Stippling | None,
    trace: Callable[[Scene], Paths],
    *,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: Budget,
    progress: Callable[[float], None] | None = None,
) -> Paths:
    """The strokes that hatch the visible faces of a scene, as they come.

    placement: of a picture of the scene; given: how items without a hatching of their own are hatched; trace: the
    visible lines of a scene in their places; crease_angle_deg
    and tolerance_mm as of paint. What is near is no brighter than what is far away, and items that are hatched by tone
    are gray, and without patterns. Errors and warnings as of paint.
    """
    how = [given if item.hatch is None else item.hatch for item in scene.items]
    toned = replace(_toned(scene, how), background=None)
    shown = without_twins(toned)
    told = None if progress is None else lambda stage, fraction: progress(fraction)
    walk = Walk(plan_paint(toned, "auto", "visible", frozenset()), None, told)
    page, projection = placement.page, placement.projection

    def demand() -> Callable[[int], Demand]:
        allowed = allowed_in_space(toned, projection, page, placement.whole, ENDS * tolerance_mm)
        return picture_fineness(shown, projection, bool(toned.lights), allowed, ROUGHLY * tolerance_mm)

    ordered = ordered_faces(walk, toned, shown, projection, demand, budget)
    seen, plane = seen_on_page(walk, ordered, placement, budget)
    lit, lights = exposed_scene(seen.view, seen.scene)
    seen = replace(seen, scene=lit)
    # Planes have one shade each: no light varies on them.
    normals = painted_normals(seen.view, toned.items, (), ordered.facets.normals, plane, crease_angle_deg)
    lighting = Lighting(toned.items, lights, normals, plane, TONES, ambient=AMBIENT)
    fills = coloured(walk, seen, lighting, page, 0.0, ROUGHLY * tolerance_mm, budget).fills
    regions = walk.run("visible fills", toned_regions, fills)
    lines = followed_lines(scene, how, seen.view, placement, trace, tolerance_mm, crease_angle_deg)
    return hatched_regions(regions, how, placement.page_from_world, lines)


def _toned(scene: Scene, how: Sequence[Hatching | Stippling | None]) -> Scene:
    """The scene, in gray where only the light counts."""
    items = (
        item if one is not None and one.by == "colour" else replace(item, colour=GRAY, patterns=())
        for item, one in zip(scene.items, how, strict=True)
    )
    return replace(scene, items=tuple(items))
