"""Which parts of lines are seen."""

from __future__ import annotations

from dataclasses import replace

from vectorplot.arrays import Bools
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.visibility.polyhedra.hidden_lines import Visibility, counted_parts, visible_parts, with_whole_lines
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.visibility.polyhedra.pairs import Segments
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import LineKind


def seen_parts(walk: Walk, view: View, faces: ProjectedFaces, solid: Bools, lines: Lines) -> Visibility:
    """The visible parts of lines, all their parts counted, or whole lines, as the plan has it."""
    if walk.calls_for("all lines"):
        from vectorplot.effects.wireframe import all_lines

        return walk.run("all lines", all_lines, lines)
    over = lines.kind == LineKind.CENTRE
    if over.any():
        rest = seen_parts(walk, view, faces, solid, lines.some(~over))
        return with_whole_lines(rest, over)
    segments = Segments(lines.start + lines.aside, lines.end + lines.aside)
    if walk.calls_for("visible lines"):
        return walk.run("visible lines", visible_parts, view, faces, solid, segments, walk.fraction("visible lines"))
    seen = walk.run("counted lines", counted_parts, view, faces, solid, segments, walk.fraction("counted lines"))
    return replace(seen, hidden_by=seen.hidden_by + lines.behind[seen.segment])
