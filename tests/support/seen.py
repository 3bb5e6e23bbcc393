"""The stages up to the visibility of all lines, for tests that look between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing import visible_by_rays
from vectorplot.visibility.polyhedra.hidden_lines import Segments, Visibility, counted_parts, visible_parts
from vectorplot.visibility.polyhedra.lines import (
    Lines,
    edge_lines,
    frame_of,
    in_frame,
    intersection_lines,
    joined_lines,
)
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import DRAWN, LineKind

EVERY_EDGE = ("contour", "boundary", "crease", "edges", "intersection")


@dataclass(frozen=True)
class Seen:
    view: View
    lines: Lines
    counted: Visibility
    visible: Visibility

    def length(self, parts: Visibility) -> float:
        along = self.lines.end - self.lines.start
        each = np.sqrt((along * along).sum(axis=0))
        return float(((parts.high - parts.low) * each[parts.segment]).sum()) * self.view.scale


def seen(scene: Scene, camera: Camera, kinds: tuple[str, ...] = DRAWN, fit: bool = True) -> Seen:
    wanted = frozenset(map(LineKind.from_word, kinds))
    view = look(scene, camera)
    faces = project_faces(view)
    solid = solid_items(view, faces)
    backs = np.ones(len(solid), dtype=np.bool_)
    found = [edge_lines(scene, view, faces, wanted, 25.0, backs)]
    if LineKind.INTERSECTION in wanted:
        found.append(intersection_lines(scene, view, faces, wanted, solid, backs))
    every = joined_lines(found)
    lines = in_frame(view, every, frame_of(view, every, Page(), fit))
    segments = Segments(lines.start, lines.end)
    counted = counted_parts(view, faces, solid, segments, lambda part: None)
    visible = visible_parts(view, faces, solid, segments, lambda part: None)
    return Seen(view, lines, counted, visible)


def wrong_samples(scene: Scene, camera: Camera, result: Seen, samples: int, seed: int) -> tuple[int, int, str]:
    """How many samples disagree with brute-force rays, how many were sure enough to compare, and the first fault."""
    lines, parts = result.lines, result.counted
    if not len(lines):
        return 0, 0, ""
    random = np.random.default_rng(seed)
    segment = random.integers(0, len(lines), samples)
    at = random.random(samples)
    points = lines.start[:, segment] + at * (lines.end - lines.start)[:, segment]
    world = result.view.world_of(points)
    truth = visible_by_rays(scene, camera, world)
    key = parts.segment + 0.5 * parts.high
    mine = parts.hidden_by[np.minimum(np.searchsorted(key, segment + 0.5 * at), len(key) - 1)]
    sure = truth.clearance > 1e-6
    wrong = np.flatnonzero(sure & (mine != truth.hidden_by))
    fault = ""
    if len(wrong):
        first = wrong[0]
        kind = LineKind(int(lines.kind[segment[first]])).word
        item, rays = lines.item[segment[first]], truth.hidden_by[first]
        fault = f"{kind} of item {item} at {world[first]}: {mine[first]}, rays {rays}"
    return len(wrong), int(sure.sum()), fault
