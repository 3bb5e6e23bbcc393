"""Parts of bent faces in the order of painting."""

from __future__ import annotations

import numpy as np

from vectorplot.effects.glass import refracted_order
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.image_faces import ImageFaces, polygons_of


def view() -> View:
    scene = Scene((Item("A", box((-1, -1, -1), (1, 1, 1))),))
    return look(scene, Camera(eye=(0.0, 0.0, 9.0), up=(0.0, 1.0, 0.0), parallel=True))


def strips(corners: np.ndarray, parts: int = 4) -> np.ndarray:
    """(3,4,parts) a parallelogram (3,4) in strips across its first side."""
    a, b, c, d = corners.T
    cut = np.linspace(0.0, 1.0, parts + 1)
    near, far = (p[:, None] + (q - p)[:, None] * cut for p, q in ((a, b), (d, c)))
    return np.stack([near[:, :-1], near[:, 1:], far[:, 1:], far[:, :-1]], axis=1)


def parts_of(*faces: np.ndarray) -> tuple[ImageFaces, np.ndarray]:
    points = np.concatenate([strips(face) for face in faces], axis=2)
    count = points.shape[2]
    parts = polygons_of(
        points.transpose(0, 2, 1).reshape(3, -1), np.arange(0, 4 * count + 1, 4), np.arange(count), 1e-12
    )
    return parts, np.repeat(np.arange(len(faces)), 4)


def sheet(x: float, y: float, size: float, height: float) -> np.ndarray:
    corners = np.array([(x, y), (x + size, y), (x + size, y + size), (x, y + size)]).T
    return np.concatenate([corners, np.full((1, 4), height)])


def test_parts_of_a_face_stand_together_whatever_their_number() -> None:
    sheets = [sheet(0.1 * k, 0.1 * k, 0.3, height) for k, height in enumerate((0.2, 0.0, 0.3, 0.1))]
    found = refracted_order(view(), *parts_of(*sheets), 1e-6)
    assert (found.source // 4).reshape(-1, 4).tolist() == [[1] * 4, [3] * 4, [0] * 4, [2] * 4]


def test_faces_that_overlap_by_no_more_than_the_tolerance_make_no_demands() -> None:
    # The first overlaps the second a little, where it is below it, and the other way round on the other side.
    left, right = sheet(0.0, 0.0, 0.3, 0.1), sheet(0.2999, 0.0, 0.3, 0.0)
    left[2] += 1e3 * (left[0] - 0.29995) * np.sign(left[1] - 0.15)
    parts, face = parts_of(left, right)
    assert len(refracted_order(view(), parts, face, 1e-3)) == 8


def test_faces_in_a_circle_are_cut() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 4)[:3]
    sheets = []
    for angle in turn:
        # A bar that rises along itself: each begins below the one and ends above the other.
        bar = np.array([(-0.4, -0.2, -0.1), (0.4, -0.2, 0.1), (0.4, -0.1, 0.1), (-0.4, -0.1, -0.1)]).T
        c, s = np.cos(angle), np.sin(angle)
        sheets.append(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ bar)
    parts, face = parts_of(*sheets)
    found = refracted_order(view(), parts, face, 1e-6)
    seen = np.concatenate([np.flatnonzero(found.source // 4 == k) for k in range(3)])
    assert len(found) >= 12 and len(np.unique(seen)) == len(found)
    # At every crossing the higher of two bars comes later.
    for one in range(len(found)):
        for two in range(one):
            a, b = (found.points[:, found.offsets[k] : found.offsets[k + 1]].mean(axis=1) for k in (one, two))
            if np.hypot(*(a - b)[:2]) < 0.02:
                assert a[2] >= b[2] - 1e-9
