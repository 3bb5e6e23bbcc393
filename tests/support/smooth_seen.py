"""What the engines find for scenes with smooth surfaces, before anything is joined or left out on the page."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.visibility.polyhedra.hidden_lines import Segments, counted_parts
from vectorplot.visibility.polyhedra.lines import edge_lines, frame_of, in_frame, intersection_lines, joined_lines
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.visibility.smooth.hidden_curves import cut_lines_and_chords
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.words import DRAWN, LineKind


@dataclass(frozen=True)
class Chords:
    """Start and end (n,3) of chords in the world; kind, item and hidden_by (n,)."""

    start: np.ndarray
    end: np.ndarray
    kind: np.ndarray
    item: np.ndarray
    hidden_by: np.ndarray

    @property
    def length(self) -> np.ndarray:
        return np.linalg.norm(self.end - self.start, axis=1)

    def lengths(self) -> np.ndarray:
        """Length for each kind (rows) and number of items in front (columns)."""
        key = np.minimum(self.hidden_by, 15) + 16 * self.kind
        return np.bincount(key, weights=self.length, minlength=16 * len(LineKind)).reshape(-1, 16)


ALL = frozenset(map(LineKind.from_word, DRAWN))
"""The kinds of lines that are drawn if nothing else is asked for."""


def chords_seen(scene: Scene, camera: Camera, *, kinds: frozenset[LineKind] = ALL, tolerance: float = 5e-5) -> Chords:
    """The chords of some kinds with their counts. tolerance: of chords, as a part of half the scene's extent."""
    view = look(scene, camera)
    faces = project_faces(view)
    solid = solid_items(view, faces)
    backs = np.ones(len(solid), dtype=np.bool_)
    edges = edge_lines(scene, view, faces, kinds, 25.0, backs)
    straight = joined_lines([edges, intersection_lines(scene, view, faces, kinds, solid, backs)])
    traced = traced_scene(scene, view, scene_sheets(scene, view), kinds, tolerance)
    every, _ = cut_lines_and_chords(view, traced, straight, tolerance)
    lines = in_frame(view, every, frame_of(view, every, Page(), True))
    seen = counted_parts(view, faces, solid, Segments(lines.start, lines.end), lambda part: None)
    seen = replace(seen, hidden_by=seen.hidden_by + lines.behind[seen.segment])
    start, way = lines.start[:, seen.segment], (lines.end - lines.start)[:, seen.segment]
    return Chords(
        view.world_of(start + seen.low * way),
        view.world_of(np.where(seen.high < 1.0, start + seen.high * way, lines.end[:, seen.segment])),
        lines.kind[seen.segment],
        lines.item[seen.segment],
        seen.hidden_by,
    )
