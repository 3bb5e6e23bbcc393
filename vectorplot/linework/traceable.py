"""What the lines of a scene are traced on, as a view shows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.budget import Budget
from vectorplot.linework.curved_lines import lines_and_chords, smooth_sheets
from vectorplot.linework.quadric_lines import balls, behind_balls
from vectorplot.linework.seen_parts import seen_parts
from vectorplot.linework.straight_lines import straight_lines
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.visibility.framing import in_frame
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.visibility.quadrics.closed_forms import ClosedForms
    from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet


@dataclass(frozen=True, eq=False)
class Traceable:
    """A scene in a view, for lines of some kinds: the faces of its polyhedra, which of its items are solid (i,), its
    balls, if it has any, its other smooth surfaces; and the lines of its polyhedra, which no tolerance changes."""

    walk: Walk
    scene: Scene
    view: View
    kinds: frozenset[LineKind]
    faces: ProjectedFaces
    solid: Bools
    straight: Lines
    balls: ClosedForms | None
    sheets: tuple[SmoothSheet, ...]

    @property
    def reached(self) -> Floats:
        """(3,n) points in whose box all of it is."""
        balls = () if self.balls is None else (self.balls.reached,)
        return np.concatenate([self.view.points, *balls, *(sheet.vertices.T for sheet in self.sheets)], axis=1)

    def lines(self, tolerance: float, budget: Budget) -> Lines:
        """All lines, curves as chords within a tolerance in the unit box."""
        smooth = (self.sheets, self.balls, self.kinds, self.straight)
        return lines_and_chords(self.walk, self.scene, self.view, *smooth, tolerance, budget)

    def framed(self, lines: Lines, place: Placement | None) -> Lines:
        """What of lines is before the eye and, where the picture has its place, inside of it; cut where balls begin to
        hide them."""
        inside = self.walk.run("frame", in_frame, self.view, lines, place)
        return behind_balls(self.walk, self.view, self.balls, inside)

    def seen(self, lines: Lines) -> Visibility:
        """Which parts of framed lines are seen."""
        return seen_parts(self.walk, self.view, self.faces, self.solid, lines)


def traceable(
    walk: Walk,
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    budget: Budget,
) -> Traceable:
    """What lines of these kinds are traced on. view: of the scene; faces: of that; budget: of shortest ways."""
    solid = solid_items(view, faces)
    straight = straight_lines(walk, scene, view, faces, solid, kinds, crease_angle_deg, budget)
    round_bodies = balls(walk, scene, view, kinds)
    sheets = smooth_sheets(walk, scene, view, round_bodies)
    return Traceable(walk, scene, view, kinds, faces, solid, straight, round_bodies, sheets)
