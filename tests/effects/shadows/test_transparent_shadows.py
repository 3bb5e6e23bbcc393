"""Shadows of transparent items."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.blocked_lights import face_points, highest_grade

import vectorplot as vp
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import joined_decals
from vectorplot.effects.shadows import shadow_decals, transparent_shadows
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box

LIGHTS = (Light((0.3, 0.0, 1.0), parallel=True), Light((0.0, 0.0, 8.0)))


def glass(name: str, x: float, colour: str, opacity: float) -> Item:
    material = Material("transparent", opacity)
    return Item(name, box((x, 0, 1), (x + 1, 1, 1.5)), colour, material, occludes=False)


def scene() -> Scene:
    floor = Item("floor", box((-5, -5, -1), (5, 5, 0)))
    brick = Item("brick", box((-3, -3, 1), (-2, -2, 2)))
    return Scene((floor, glass("a", 0, "blue", 0.3), brick, glass("b", 2, "green", 0.5), glass("c", -2, "blue", 0.3)))


@pytest.mark.capability("G6.6-transparent-shadow")
def test_they_have_the_colours_of_the_items_and_come_last() -> None:
    view = look(scene(), Camera((3, -9, 15), (0, 0, 0)))
    clear = transparent_shadows(view, scene(), LIGHTS)
    on_floor = np.flatnonzero(view.face_item[clear.face] == 0)
    names = [clear.colours[k] for k in clear.colour[on_floor]]
    assert sorted(names) == ["blue"] * 4 + ["green"] * 2
    assert np.allclose(clear.opacities[on_floor], [0.3 if name == "blue" else 0.5 for name in names])
    assert sorted(clear.light[on_floor].tolist()) == [0, 0, 0, 1, 1, 1]
    assert (clear.kind == FillKind.CLEAR_SHADOW).all()
    assert (clear.lights_lacking == 1 << clear.light).all()
    dark = shadow_decals(view, LIGHTS)
    both = joined_decals(clear, dark)
    on_one = [k for k in both.painting_order if both.face[k] == clear.face[on_floor[0]]]
    assert both.kind[on_one].tolist() == sorted(both.kind[on_one].tolist())


def test_a_scene_without_glass_has_none() -> None:
    solid = Scene(tuple(item for item in scene().items if item.hides))
    view = look(solid, Camera((3, -9, 15), (0, 0, 0)))
    assert len(transparent_shadows(view, solid, LIGHTS)) == 0


def test_what_is_wholly_clear_or_occludes_casts_none() -> None:
    milky = replace(glass("b", 2, "blue", 0.5), occludes=True)
    items = (scene().items[0], glass("a", 0, "blue", 0.0), milky)
    view = look(Scene(items), Camera((3, -9, 15), (0, 0, 0)))
    assert len(transparent_shadows(view, Scene(items), LIGHTS)) == 0


@pytest.mark.capability("G6.6-transparent-shadow")
@pytest.mark.parametrize("camera", [Camera((3, -9, 15), (0, 0, 0)), Camera((-9, -7, 6), (0, 0, 0)), Camera.view("iso")])
@pytest.mark.parametrize("number", [1, 2])
def test_painted_they_come_after_the_shadows_of_the_same_face_and_darken_it(camera: Camera, number: int) -> None:
    lit = replace(scene(), lights=LIGHTS[:number])
    (fills,) = vp.paint(lit, camera, page=vp.Page(120, 90, 4), smooth=False).layers[0].fills
    clear = np.flatnonzero(fills.kind == FillKind.CLEAR_SHADOW)
    assert len(clear)
    on_floor = fills.item == 0
    shadows = np.flatnonzero(on_floor & (fills.kind == FillKind.SHADOW))
    assert len(shadows) and shadows.max() < np.flatnonzero(on_floor & (fills.kind == FillKind.CLEAR_SHADOW)).min()
    # Thin, and in the colour of the glass, or opaque, in the mixed colour: of the face below more than a half stays.
    first = fills.colours[fills.offsets[:-1]].astype(int)
    face = first[np.flatnonzero(on_floor & (fills.kind == FillKind.FACE))]
    mixed = fills.opacity[clear, None] * first[clear] + (1 - fills.opacity[clear, None]) * face.max(axis=0)
    assert (mixed.sum(axis=1) < face.max(axis=0).sum()).all()
    thin = fills.opacity[clear] < 1.0
    assert (fills.opacity[clear[thin]] < 0.6).all()
    assert (first[clear[~thin]] > 0.5 * face.max(axis=0)).all()
    assert (np.ptp(first[clear[~thin]], axis=1) > 10).all(), "it has a colour, which the floor has not"


@pytest.mark.capability("G6.6-transparent-shadow")
def test_for_pens_they_are_sparse_lines_after_the_shadows() -> None:
    lit = replace(scene(), lights=LIGHTS[:1])
    camera = Camera((3, -9, 15), (0, 0, 0))
    page = vp.Page(120, 90, 4)
    (painted,) = vp.paint(lit, camera, page=page).layers[0].fills
    (fills,) = vp.paint(lit, camera, page=page, fills="visible").layers[0].fills
    assert (fills.kind != FillKind.CLEAR_SHADOW).all() or (fills.opacity == 1.0).all()
    sparse = np.flatnonzero((np.diff(fills.offsets) == 2) & (fills.item == 0))
    solid = np.flatnonzero((np.diff(fills.offsets) > 2) & (fills.item == 0))
    assert len(sparse) > 20 and sparse.min() > solid.max(), "nothing of the floor is drawn over them"
    clear = np.flatnonzero((painted.kind == FillKind.CLEAR_SHADOW) & (painted.item == 0))
    ends = fills.points[fills.offsets[sparse]]
    boxes = [painted.points[painted.offsets[k] : painted.offsets[k + 1]] for k in clear]
    inside = [((ends >= b.min(axis=0) - 0.3) & (ends <= b.max(axis=0) + 0.3)).all(axis=1) for b in boxes]
    assert np.any(inside, axis=0).all(), "they lie in the shadows"


def test_where_a_light_does_not_get_anyway_nothing_dims_it_and_others_lack_too() -> None:
    floor, brick = scene().items[0], Item("brick", box((0.5, -1, 2), (3, 2, 2.5)))
    panes = (glass("a", 0, "blue", 0.3), glass("b", 0.25, "blue", 0.3))
    view = look(Scene((floor, *panes, brick)), Camera((3, -9, 15), (0, 0, 0)))
    dark = shadow_decals(view, LIGHTS)
    clear = transparent_shadows(view, Scene((floor, *panes, brick)), LIGHTS, dark)
    at = face_points(view, np.flatnonzero(view.face_item == 0), 30000, np.random.default_rng(3))
    masks = {}
    for name, decals in (("dark", dark), ("clear", clear)):
        masks[name] = np.zeros((2, len(at.face)), dtype=int)
        for k in range(len(decals)):
            alone = replace(decals.of(np.array([k])), grade=np.ones(1, dtype=int))
            inside, _ = highest_grade(view, alone, at)
            for light in range(2):
                if name == "dark":
                    masks[name][light] |= inside * (int(decals.lights_lacking[k]) >> light & 1)
                elif decals.light[k] == light:
                    masks[name][light] += inside
                    others = int(decals.lights_lacking[k]) & ~(1 << light)
                    assert (masks["dark"][1 - light][inside > 0] == (others >> (1 - light) & 1)).mean() > 0.999
    assert masks["clear"].max() == 1, "things of one colour dim a light once"
    assert not (masks["clear"] & masks["dark"]).any()
    both = masks["clear"].astype(bool) & masks["dark"][::-1].astype(bool)
    assert masks["clear"].sum() > 100 and both.sum() > 10
