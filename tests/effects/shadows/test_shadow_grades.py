"""Grades of shadows: the cells that the borders of shadows of several lights cut faces into."""

from __future__ import annotations

import numpy as np
import pytest
from support.blocked_lights import wrong_points

from vectorplot.drawing.fills import FillKind
from vectorplot.effects import shadows as grades
from vectorplot.effects.shadows import Shadows, cast_shadows, graded, joined_shadows, shadow_decals, shadow_decals_of
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import polygon_areas
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, numbered, torus_mesh
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import project_faces

TOP = 1
"""The face of the box that looks up."""


def table() -> View:
    return look(numbered([box((-1, -1, -1), (1, 1, 0))]), Camera.view("top"))


def squares(view: View, *shapes: tuple[float, float, float, int]) -> Shadows:
    """Squares on the table: x and y of their middles, half their sides, and the light they lack."""
    corners = np.concatenate(
        [[[x - h, y - h, 0], [x + h, y - h, 0], [x + h, y + h, 0], [x - h, y + h, 0]] for x, y, h, _ in shapes]
    )
    count = len(shapes)
    return Shadows(
        view.points_of(np.array(corners)),
        4 * np.arange(count + 1),
        np.full(count, TOP),
        np.array([1 << light for *_, light in shapes]),
        np.array([h == 1.0 for _, _, h, _ in shapes]),
    )


def areas(view: View, shadows: Shadows) -> dict[int, float]:
    """The area of all cells that lack the same lights."""
    normal, _ = polygon_areas(shadows.points, shadows.offsets)
    area = np.sqrt((normal * normal).sum(axis=0)) / 2.0 * view.scale**2
    return {
        lacking: float(np.round(area[shadows.lacking == lacking].sum(), 6)) for lacking in np.unique(shadows.lacking)
    }


def ring_of_lights(count: int) -> tuple[Light, ...]:
    angles = 2.0 * np.pi * np.arange(count) / count + 0.1
    return tuple(Light((8.0 * float(np.cos(a)), 8.0 * float(np.sin(a)), 6.0 + k % 3)) for k, a in enumerate(angles))


def things() -> Scene:
    random = np.random.default_rng(0)
    places = [random.uniform(-3.0, 3.0, 2) for _ in range(4)]
    boxes = [box((x - 0.4, y - 0.4, 0), (x + 0.4, y + 0.4, 0.5 + 0.2 * k)) for k, (x, y) in enumerate(places)]
    return numbered([box((-6, -6, -1), (6, 6, 0)), *boxes])


@pytest.mark.capability("G6.3-multi")
def test_three_lights_make_a_cell_for_every_set_of_them() -> None:
    view = table()
    found = graded(view, squares(view, (0, 0, 0.5, 0), (0.5, 0, 0.5, 1), (0.25, 0.5, 0.5, 2)))
    assert areas(view, found) == {1: 0.375, 2: 0.375, 3: 0.25, 4: 0.5, 5: 0.125, 6: 0.125, 7: 0.25}
    assert len(found) == 7 and np.array_equal(found.grade, np.bitwise_count(found.lacking))


def test_shadows_that_only_touch_make_no_grade() -> None:
    view = table()
    found = graded(view, squares(view, (-0.5, 0, 0.5, 0), (0.5, 0, 0.5, 1)))
    assert found.grade.tolist() == [1, 1]


def test_overlapping_shadows_of_one_light_are_one_region() -> None:
    view = table()
    found = graded(view, squares(view, (0, 0, 0.5, 0), (0.2, 0, 0.5, 0), (0.2, 0, 0.1, 0)))
    assert found.grade.tolist() == [1] and areas(view, found) == {1: 1.2}


def test_a_whole_face_makes_others_of_its_light_needless() -> None:
    view = table()
    found = squares(view, (0, 0, 0.5, 0), (0, 0, 1.0, 0), (0.1, 0, 0.5, 1)).without_needless()
    assert found.lacking.tolist() == [1, 2] and found.whole.tolist() == [True, False]


def test_faces_dark_as_wholes_are_one_cell() -> None:
    view = table()
    found = graded(view, squares(view, (0, 0, 1.0, 0), (0, 0, 1.0, 3), (0.1, 0, 0.5, 1), (0.4, 0, 0.5, 2)))
    assert found.lacking[found.whole].tolist() == [9]
    assert areas(view, found) == {9: 4.0, 11: 0.3, 13: 0.3, 15: 0.7}


def test_a_hole_full_of_a_higher_grade_is_painted_over() -> None:
    view = table()
    found = graded(view, squares(view, (0, 0, 0.6, 0), (0, 0, 0.2, 1)))
    assert len(found) == 2 and areas(view, found) == {1: 1.44, 3: 0.16}


def test_a_hole_that_light_falls_into_stays_open() -> None:
    view = table()
    frame = [(-0.5, 0, 0.1, 0), (0.5, 0, 0.1, 0), (0, -0.5, 0.1, 0), (0, 0.5, 0.1, 0)]
    sides = squares(view, *frame)
    stretch = np.array([[1, 6], [1, 6], [6, 1], [6, 1]], dtype=float)
    middle = view.points_of(np.array([[x, y, 0] for x, y, *_ in frame]))
    points = sides.points.reshape(3, 4, 4)
    points[:2] = middle[:2, :, None] + stretch.T[:, :, None] * (points[:2] - middle[:2, :, None])
    found = graded(view, joined_shadows([sides, squares(view, (0.5, 0, 0.02, 1))]))
    assert areas(view, found) == {1: 0.8, 3: 0.0016}


def test_decals_tell_lights_and_levels() -> None:
    view = table()
    decals = shadow_decals_of(graded(view, squares(view, (0, 0, 0.5, 0), (0.5, 0, 0.5, 3))), FillKind.SHADOW)
    by_lacking = np.argsort(decals.lights_lacking)
    assert decals.light[by_lacking].tolist() == [0, 3, -1] and decals.grade[by_lacking].tolist() == [1, 1, 2]
    assert decals.lights_lacking[by_lacking].tolist() == [1, 8, 9]
    assert decals.level[by_lacking[2]] > decals.level[by_lacking[0]]


def test_nothing_joined_has_no_grades() -> None:
    assert len(graded(table(), joined_shadows([]))) == 0


@pytest.mark.slow
@pytest.mark.hard(78)
@pytest.mark.parametrize("lights", [1, 3, 16, 32])
def test_sixteen_lights_make_as_many_cells_as_their_borders_do(lights: int) -> None:
    view = look(things(), Camera((7, -12, 11), (0, 0, 0)))
    lamps = ring_of_lights(lights)
    decals = shadow_decals(view, lamps)
    corners = int(np.diff(cast_shadows(view, lamps).offsets).sum())
    assert len(decals) < 30 + 2 * corners * (1 + lights // 8)
    drawn = drawn_faces(view, project_faces(view))
    wrong, answered = wrong_points(view, lamps, decals, drawn, 1500)
    assert wrong == 0 and answered > 1400


@pytest.mark.slow
@pytest.mark.hard(78)
def test_many_lights_on_a_mesh_see_its_outline_only() -> None:
    # A ring without one face is no body: each of its faces throws a shadow of its own.
    whole = torus_mesh()
    open_ = Mesh(whole.vertices, whole.corners[:-4], whole.offsets[:-1])
    ring = open_.transformed(np.diag([0.5, 0.5, 0.5, 1.0]) + np.pad([[2.2]], ((2, 1), (3, 0))))
    scene = numbered([box((-6, -6, -1), (6, 6, 0)), ring])
    view = look(scene, Camera((7, -12, 11), (0, 0, 0)))
    lamps = ring_of_lights(16)
    decals = shadow_decals(view, lamps)
    on_floor = [np.count_nonzero(view.face_item[found.face] == 0) for found in (decals, cast_shadows(view, lamps))]
    assert on_floor[0] < 0.1 * on_floor[1]
    wrong, answered = wrong_points(view, lamps, decals, drawn_faces(view, project_faces(view)), 1000)
    assert wrong == 0 and answered > 900


@pytest.mark.hard(78)
def test_where_there_are_many_cells_a_line_warns(monkeypatch: pytest.MonkeyPatch) -> None:
    view = table()
    random = np.random.default_rng(0)
    many = squares(view, *((*random.uniform(-0.4, 0.4, 2), 0.5, k) for k in range(20)))
    monkeypatch.setattr(grades, "MANY_CELLS", 50)
    with pytest.warns(InputWarning, match=r"shadows overlap in \d+ parts"):
        graded(view, many)
    monkeypatch.setattr(grades, "MOST_CELLS", 60)
    with pytest.raises(InputError, match="more than 60 parts"):
        graded(view, many)
