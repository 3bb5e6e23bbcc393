"""Lines where solids pierce each other: those on faces that turn away are looked for only where they can be seen."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.testing.shapes import box, rotated_boxes
from vectorplot.visibility.polyhedra.lines import intersection_lines
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces

LINES = "contour,crease,intersection"


def heap(seed: int) -> vp.Scene:
    """Boxes of whole coordinates: many pierce each other, many touch, or have faces in one plane."""
    rng = np.random.default_rng(seed)
    corners = ((low, low + rng.integers(1, 4, 3)) for low in rng.integers(0, 4, (7, 3)))
    return vp.Scene(tuple(vp.Item(f"box {k}", box(*map(tuple, ends))) for k, ends in enumerate(corners)))


def visible_length(drawing: vp.Drawing) -> dict[int, float]:
    """How long the visible lines of each kind are."""
    length: Counter[int] = Counter()
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for k in np.flatnonzero(paths.hidden_by == 0).tolist():
            points = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
            around = np.vstack((points, points[:1])) if paths.closed[k] else points
            length[int(paths.kind[k])] += float(np.hypot(*np.diff(around, axis=0).T).sum())
    return length


@pytest.mark.slow
@pytest.mark.parametrize("lines", [LINES, "crease,intersection"])
@pytest.mark.parametrize("eye", [(9.0, -7.0, 6.0), (2.0, -20.0, 2.0)])
def test_visible_lines_are_those_that_are_visible_of_all_lines(eye: tuple[float, float, float], lines: str) -> None:
    for seed in range(4):
        scene, camera = heap(seed), vp.Camera(eye, target=(2, 2, 2), parallel=seed % 2 == 0)
        seen, every = (visible_length(vp.draw(scene, camera, lines=lines, hidden=how)) for how in ("none", "solid"))
        assert seen == pytest.approx(every, abs=1e-6)


def test_faces_that_turn_away_are_left_out_of_solids_whose_outline_is_drawn() -> None:
    scene = rotated_boxes(60)
    view = vp.scene.look(scene, vp.Camera((30, -20, 18)))
    faces, kinds = project_faces(view), frozenset(map(vp.LineKind.from_word, LINES.split(",")))
    solid = solid_items(view, faces)
    every = len(intersection_lines(scene, view, faces, kinds, solid, np.ones_like(solid)))
    some = len(intersection_lines(scene, view, faces, kinds, solid, ~solid))
    assert solid.all()
    assert 0 < 2 * some < every
    kinds -= {vp.LineKind.CONTOUR}
    assert len(intersection_lines(scene, view, faces, kinds, solid, ~solid)) == every
