"""Grades of shadows, and which of them are needless."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.shadow_grades import Shadows, graded, joined_shadows, shadow_decals_of, without_covered
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.plane_cuts import polygon_areas
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, numbered

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
        np.zeros((0, count), dtype=np.intp),
    )


def areas(view: View, shadows: Shadows) -> list[float]:
    normal, _ = polygon_areas(shadows.points, shadows.offsets)
    return (np.sqrt((normal * normal).sum(axis=0)) / 2.0 * view.scale**2).round(12).tolist()


@pytest.mark.capability("G6.3-multi")
def test_three_lights_make_three_grades() -> None:
    view = table()
    found = graded(view, squares(view, (0, 0, 0.5, 0), (0.5, 0, 0.5, 1), (0.25, 0.5, 0.5, 2)), 3)
    assert found.grade.tolist() == [1, 1, 1, 2, 2, 2, 3]
    assert found.lacking.tolist() == [1, 2, 4, 3, 5, 6, 7]
    assert np.allclose(areas(view, found), [1, 1, 1, 0.5, 0.375, 0.375, 0.25])
    assert found.parents[:, -1].tolist() == [0, 1, 2] and found.parents[:, 3].tolist() == [0, 1, -1]


def test_shadows_that_only_touch_make_no_grade() -> None:
    view = table()
    found = graded(view, squares(view, (-0.5, 0, 0.5, 0), (0.5, 0, 0.5, 1)), 2)
    assert found.grade.tolist() == [1, 1]


def test_shadows_of_one_light_stay_of_grade_one() -> None:
    view = table()
    assert graded(view, squares(view, (0, 0, 0.5, 0), (0.2, 0, 0.5, 0)), 2).grade.tolist() == [1, 1]


def test_a_whole_face_makes_others_of_its_light_needless() -> None:
    view = table()
    found = squares(view, (0, 0, 0.5, 0), (0, 0, 1.0, 0), (0.1, 0, 0.5, 1)).without_needless()
    assert found.lacking.tolist() == [1, 2] and found.whole.tolist() == [True, False]


def test_what_lies_in_another_shadow_of_its_light_goes() -> None:
    view = table()
    many = squares(view, (0, 0, 0.2, 0), (0, 0, 0.5, 0), (0.3, 0, 0.2, 0), (0, 0, 0.5, 0), (0, 0, 0.1, 1))
    assert np.allclose(areas(view, without_covered(view, many)), [1.0, 0.04])


def test_decals_tell_lights_and_levels() -> None:
    view = table()
    decals = shadow_decals_of(graded(view, squares(view, (0, 0, 0.5, 0), (0.5, 0, 0.5, 3)), 4), FillKind.SHADOW)
    assert decals.light.tolist() == [0, 3, -1] and decals.grade.tolist() == [1, 1, 2]
    assert decals.lights_lacking.tolist() == [1, 8, 9] and decals.level[2] > decals.level[0]


def test_nothing_joined_has_no_grades() -> None:
    assert len(graded(table(), joined_shadows([]), 2)) == 0 and len(without_covered(table(), joined_shadows([]))) == 0
