"""The lines of a scene where its picture has found its place on the page."""

from __future__ import annotations

from dataclasses import dataclass, replace

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.drawn_lines import fitted_lines, strokes_on_page
from vectorplot.geometry.budget import Budget
from vectorplot.linework.traceable import Traceable
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, fitted_picture, mm_per_image
from vectorplot.tolerances.of_extent import FINEST_CHORD_OF_EXTENT
from vectorplot.visibility.framing import frame_of
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines

LARGER = 1.25
"""Curves are traced anew where they come out so many times larger on the page than they were taken for."""


@dataclass(frozen=True, eq=False)
class PlacedLines:
    """Lines before the eye, what is seen of them, and where that stands on the page."""

    shapes: Traceable
    lines: Lines
    seen: Visibility
    placement: Placement

    def with_halo(self, halo_mm: float) -> PlacedLines:
        """The same, lines ending so far beside what is in front of them where the plan has it."""
        walk = self.shapes.walk
        if not walk.calls_for("halo"):
            return self
        from vectorplot.effects.halos import halo

        width = halo_mm / self.placement.scale
        return replace(self, seen=walk.run("halo", halo, self.shapes.view, self.lines, self.seen, width))

    def strokes(self) -> Paths:
        """The seen parts as strokes on the page, as they come."""
        shapes = self.shapes
        return shapes.walk.run("strokes", strokes_on_page, shapes.view, self.lines, self.seen, self.placement)


def placed_lines(shapes: Traceable, sheet: Page, fit: bool, tolerance_mm: float, budget: Budget) -> PlacedLines:
    """The lines of a scene, and their place on a sheet that they fill; without fit that of the field of vision."""
    walk, view, reached = shapes.walk, shapes.view, shapes.reached
    scale = mm_per_image(view, reached, sheet, fit)
    while True:
        # Chords take one half of the tolerance, Béziers through their ends the other.
        tolerance = 0.5 * tolerance_mm / scale
        every = shapes.lines(tolerance, budget)
        bounded = frame_of(view, every, sheet, fit)
        framed = shapes.framed(every, bounded)
        seen = shapes.seen(framed)
        placement = bounded or fitted_lines(view, framed, seen, sheet)
        if bounded is None and not len(seen) and walk.calls_for("hatching"):
            # Without lines the picture is that of the faces.
            placement = fitted_picture(view, sheet, view.image_of(reached))
        if (
            every is shapes.straight
            or not len(seen)
            or placement.scale <= LARGER * scale
            or tolerance < FINEST_CHORD_OF_EXTENT
        ):
            return PlacedLines(shapes, framed, seen, placement)
        # Little of the scene is drawn, and that larger than thought.
        scale = placement.scale
