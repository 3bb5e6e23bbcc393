"""Soft borders of shadows."""

from __future__ import annotations

import numpy as np
import pytest
from support.blocked_lights import FacePoints, face_points, highest_grade

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import joined_decals
from vectorplot.effects.shadows import cast_shadows, graded, shadow_decals_of
from vectorplot.effects.soft_shadows import shadow_borders
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.light import Light
from vectorplot.scene.view import View, look
from vectorplot.shading.illumination import LEVELS
from vectorplot.testing.shapes import box, numbered

FLOOR = box((-3, -3, -1), (3, 3, 0))
LIGHTS = (Light((0.7, 0.2, 1.0), parallel=True), Light((-2.0, 1.0, 4.0)), Light((0.5, -3.0, 3.0)))


def scene_view(parallel: bool, turned: bool = False) -> View:
    floor = Mesh.from_polygons([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [[0, 1, 2, 3][:: -1 if turned else 1]])
    scene = numbered([floor, box((-0.5, -0.5, 0.2), (0.5, 0.5, 1.2)), box((1, 0, 0), (1.5, 1, 0.7))])
    return look(scene, Camera((5, -8, 12), (0, 0, 0), parallel=parallel))


@pytest.mark.capability("G6.3-aura")
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("lights", [1, 3])
def test_borders_reach_as_far_as_their_width(parallel: bool, turned: bool, lights: int) -> None:
    view = scene_view(parallel, turned)
    single = cast_shadows(view, LIGHTS[:lights])
    shadows = graded(view, single)
    width = 0.02
    decals = shadow_borders(view, single, shadows, width)
    assert (decals.kind == FillKind.SHADOW_BORDER).all() and (decals.level % LEVELS > 0).all()
    at = face_points(view, np.unique(shadows.face), 4000, np.random.default_rng(1))
    image = view.image_of(at.points)
    first = shadow_decals_of(single, FillKind.SHADOW)
    outermost = (decals.grade == 1) & (decals.level == 1)
    reached, _ = highest_grade(view, joined_decals(decals.of(np.flatnonzero(outermost)), first), at)
    near = np.full(len(at.face), np.inf)
    inside, _ = highest_grade(view, first, at)
    for k in range(len(first)):
        mine = at.face == first.face[k]
        corners = view.image_of(first.points[:, first.offsets[k] : first.offsets[k + 1]])
        for start, end in zip(corners.T, np.roll(corners, -1, axis=1).T, strict=True):
            along = end - start
            arm = image[:, mine] - start[:, None]
            share = np.clip((along @ arm) / max(along @ along, 1e-30), 0.0, 1.0)
            near[mine] = np.minimum(near[mine], np.hypot(*(arm - share * along[:, None])))
    outside = inside == 0
    for step in range(1, LEVELS):
        own = decals.of(np.flatnonzero((decals.grade == 1) & (decals.level == step)))
        reach = width * (LEVELS - step) / (LEVELS - 1)
        assert (highest_grade(view, joined_decals(own, first), at)[0][outside & (near < 0.999 * reach)] == 1).all()
    assert (reached[outside & (near < 0.999 * width)] == 1).all()
    assert (reached[outside & (near > 1.42 * width)] == 0).all()
    assert (outside & (near < 0.999 * width)).sum() > 20


@pytest.mark.slow
@pytest.mark.capability("G6.3-aura")
def test_a_border_of_higher_grade_ends_where_only_one_light_more_shines() -> None:
    view = scene_view(False)
    single = cast_shadows(view, LIGHTS)
    shadows = graded(view, single)
    decals = shadow_borders(view, single, shadows, 0.02)
    plain = shadow_decals_of(shadows, FillKind.SHADOW)
    assert set(decals.grade.tolist()) == {1, 2, 3}
    checked = 0
    for grade in (2, 3):
        for k in np.flatnonzero(decals.grade == grade).tolist():
            samples = face_points(view, decals.face[[k]], 2000, np.random.default_rng(k))
            within = np.flatnonzero(highest_grade(view, decals.of(np.array([k])), samples)[0])
            at = FacePoints(samples.points[:, within], samples.face[within])
            covered = np.flatnonzero((plain.face == decals.face[k]) & (plain.lights_lacking == decals.lacking[k]))
            assert (highest_grade(view, plain.of(covered), at)[0] == grade - 1).all()
            assert decals.lacking[k] & (1 << decals.light[k]) == 0
            assert np.bitwise_count(decals.lacking[k]) == grade - 1
            checked += len(within)
    assert checked > 100


def test_no_width_no_borders() -> None:
    view = scene_view(False)
    single = cast_shadows(view, LIGHTS)
    shadows = graded(view, single)
    assert len(shadow_borders(view, single, shadows, 0.0)) == 0
    for width in (-1.0, np.nan, np.inf):
        with pytest.raises(InputError):
            shadow_borders(view, single, shadows, width)


def test_an_eye_over_the_shadow_has_a_border_too() -> None:
    view = look(numbered([FLOOR, box((-1, -1, 1), (1, 1, 1.1))]), Camera((2.0, 0.0, 0.3), (-3.0, 0.0, 0.0)))
    single = cast_shadows(view, LIGHTS[:1])
    borders = shadow_borders(view, single, graded(view, single), 0.01)
    assert (view.depth_of(borders.points) >= view.near - 1e-9).all() and np.isfinite(borders.points).all()


def test_shadows_of_many_pieces_have_one_border() -> None:
    floor = Mesh.from_polygons([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [[0, 1, 2, 3]])
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, 13), np.linspace(-1.0, 1.0, 13))
    corners = np.stack([u.ravel(), v.ravel(), 1.0 + 0.2 * (u * v).ravel()], axis=1)
    corner = np.arange(156).reshape(12, 13)[:, :-1].ravel()
    roof = Mesh.from_polygons(
        corners.tolist(), np.stack([corner, corner + 1, corner + 14, corner + 13], axis=1).tolist()
    )
    view = look(numbered([floor, roof]), Camera((5, -8, 12), (0, 0, 0)))
    single = cast_shadows(view, LIGHTS[:1])
    borders = shadow_borders(view, single, graded(view, single), 0.02)
    on_floor = view.face_item[single.face] == 0
    assert on_floor.sum() > 100
    assert (view.face_item[borders.face] == 0).sum() == LEVELS - 1
