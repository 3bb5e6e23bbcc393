"""Decals united, and without what covers them."""

from __future__ import annotations

import numpy as np
import pytest
from support.blocked_lights import wrong_points

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, disjoint_decals, no_decals, united_decals
from vectorplot.effects.shadows import cast_shadows, shadow_decals, shadow_decals_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import polygon_areas
from vectorplot.scene.light import Light
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, numbered, rotated_boxes, torus_mesh
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import project_faces

LIGHTS = (Light((1.0, 0.4, 2.0), parallel=True), Light((8.0, 9.0, 7.0)))


def inside(view: View, decals: Decals, k: int, points: np.ndarray) -> np.ndarray:
    """Whether points of the face lie in a simple polygon, by the crossing number in its plane."""
    import shapely

    normal, _ = polygon_areas(decals.points, decals.offsets)
    axis = int(np.abs(normal[:, k]).argmax())
    flat = np.delete(decals.points[:, decals.offsets[k] : decals.offsets[k + 1]], axis, axis=0)
    return shapely.contains_xy(shapely.Polygon(flat.T), *np.delete(points, axis, axis=0))


def area(view: View, decals: Decals) -> float:
    normal, _ = polygon_areas(decals.points, decals.offsets)
    return float(np.sqrt((normal * normal).sum(axis=0)).sum() / 2.0 * view.scale**2)


def test_the_shadow_of_a_ring_is_united_to_a_region_with_a_hole_cut_open() -> None:
    # A ring without one face is no body: each of its faces throws a shadow of its own.
    whole = torus_mesh()
    open_ = Mesh(whole.vertices, whole.corners[:-4], whole.offsets[:-1])
    ring = open_.transformed(np.diag([1, 1, 1, 1.0]) + np.pad([[0, 0, 0, 3.0]], ((2, 1), (0, 0))))
    view = look(numbered([box((-6, -6, -3), (6, 6, -2)), ring]), Camera((2, -9, 15), (0, 0, 0)))
    single = cast_shadows(view, (Light((0.0, 0.0, 1.0), parallel=True),))
    decals = shadow_decals_of(single, FillKind.SHADOW)
    on_floor = decals.of(np.flatnonzero(view.face_item[decals.face] == 0))
    united = united_decals(view, on_floor)
    assert 2 <= len(united) <= 4 < len(on_floor)
    radii = np.hypot(*ring.vertices[:, :2].T)
    flat = view.world_of(united.points)[:, :2]
    assert np.isclose(np.hypot(*flat.T).max(), radii.max(), atol=1e-7)
    total = area(view, united)
    assert np.pi * (radii.max() ** 2 - radii.min() ** 2) * 0.85 < total < np.pi * (radii.max() ** 2 - radii.min() ** 2)


@pytest.mark.parametrize("work", [united_decals, disjoint_decals])
def test_points_keep_their_grades(work) -> None:
    view = look(rotated_boxes(14, 4), Camera((14, 9, 11), (0, 0, 0)))
    decals = shadow_decals(view, LIGHTS)
    done = work(view, decals)
    random = np.random.default_rng(2)
    checked = 0
    for face in np.unique(decals.face).tolist():
        corners = view.points[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        points = corners @ random.dirichlet(np.ones(corners.shape[1]), 60).T
        grades = []
        for some in (decals, done):
            mine = np.flatnonzero(some.face == face)
            rows = [inside(view, some, k, points) * some.grade[k] for k in mine.tolist()]
            grades.append(np.array([*rows, np.zeros(60)]))
        assert np.array_equal(grades[0].max(axis=0), grades[1].max(axis=0))
        if work is disjoint_decals:
            levels = done.level[done.face == face]
            cover = np.array([(grades[1][:-1][levels == n] > 0).any(axis=0) for n in np.unique(levels)])
            assert (cover.sum(axis=0) <= 1).all()
        checked += 1
    assert checked > 20


def test_the_parts_lie_on_their_faces() -> None:
    view = look(rotated_boxes(14, 4), Camera((14, 9, 11), (0, 0, 0)))
    decals = shadow_decals(view, LIGHTS)
    united = united_decals(view, decals)
    assert len(united) <= len(decals) and not wrong_points(view, LIGHTS, decals, drawn(view), 300)[0]
    normal, _ = polygon_areas(united.points, united.offsets)
    face = np.repeat(united.face, np.diff(united.offsets))
    first = view.points[:, view.corners[view.offsets[face]]]
    unit = np.repeat(normal / np.sqrt((normal * normal).sum(axis=0)), np.diff(united.offsets), axis=1)
    assert np.abs(((united.points - first) * unit).sum(axis=0)).max() < 1e-7


def drawn(view: View):
    return drawn_faces(view, project_faces(view))


def test_nothing_stays_nothing() -> None:
    view = look(rotated_boxes(2, 4), Camera((14, 9, 11), (0, 0, 0)))
    assert len(united_decals(view, no_decals())) == 0 and len(disjoint_decals(view, no_decals())) == 0
