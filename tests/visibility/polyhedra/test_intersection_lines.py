"""Lines where solids pierce each other: those on faces that turn away are looked for only where they can be seen."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.features.mesh_edge_lines import Faces
from vectorplot.features.mesh_intersections import _part_boxes, _within_hollow, face_intersections
from vectorplot.testing.shapes import box, bumpy_icosphere, rotated_boxes
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


@pytest.mark.parametrize(
    ("size", "place", "meet"), [(0.8, 0.0, False), (0.8, 0.1, False), (0.8, 0.3, True), (0.99, 0.0, True)]
)
def test_shells_in_each_other_meet_where_no_ball_keeps_them_apart(size: float, place: float, meet: bool) -> None:
    """Balls of triangles of radius 1 and less: the planes of the outer one leave a ball of about 0.99 free."""
    outer, inner = bumpy_icosphere(2, 0.0), bumpy_icosphere(2, 0.0)
    turned = inner.vertices @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) * size + (place, 0.0, 0.0)
    both = np.concatenate([outer.vertices, turned])
    triangles = outer.corners.reshape(-1, 3)
    mesh = vp.Mesh.from_triangles(both, np.concatenate([triangles, triangles + len(outer.vertices)]))
    faces = Faces(mesh.vertices.T, mesh.corners, mesh.offsets, np.zeros(len(mesh.corners), dtype=bool), None)
    part = np.repeat([0, 1], len(triangles))
    low, high = _part_boxes(faces, part, 2)
    one, two = np.array([0]), np.array([1])
    free = _within_hollow(faces, part, (low, high), one, two, 1e-9)
    found = face_intersections(faces, part, 1e-9)
    assert free.tolist() == [not meet]
    assert (len(found.one) > 0) == meet
