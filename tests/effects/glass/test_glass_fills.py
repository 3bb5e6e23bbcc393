"""What refracting solids show as fills: colours mixed, so that nothing transparent is left that could show seams."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.paths import DATA

import vectorplot as vp
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.regions import polygons_of
from vectorplot.pictures.paint import paint
from vectorplot.save import write
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.shading.palettes import palette
from vectorplot.testing.shapes import box

SUN = Light((-1.0, -2.0, 4.0), parallel=True, intensity=0.8)
ABOVE = Camera((0.0, 0.0, 10.0), up=(0.0, 1.0, 0.0), parallel=True, height=8.0)


def pool(opacity: float, background: str | None = None) -> Scene:
    floor = Item("FLOOR", box((-2, -2, -2), (2, 2, -1.5)), "orange")
    water = Item(
        "WATER", box((-1, -1, -1.5), (3, 1, 0)), "blue", Material("transparent", opacity, 4.0 / 3.0), occludes=False
    )
    return Scene((floor, water), (SUN,), background=background)


def test_what_is_seen_through_glass_is_mixed_with_its_colour():
    colours = {}
    for opacity in (0.0, 0.25, 1e-9):
        (fills,) = paint(pool(opacity), ABOVE, fit=False, shadows="none").layers[0].fills
        floor = fills.take(np.flatnonzero((fills.kind == FillKind.GLASS) & (fills.item == 0)))
        colours[opacity] = floor.colours[0].astype(float)
        assert (fills.opacity == 1.0).all()
    (fills,) = paint(pool(0.25), ABOVE, fit=False, shadows="none").layers[0].fills
    own = fills.colours[fills.offsets[:-1][fills.item == 1]][0].astype(float)
    # Where nothing lies behind the glass the paper is seen through it.
    tint = (own - 0.75 * palette("white")[-1]) / 0.25
    assert np.abs(colours[0.25] - (0.75 * colours[0.0] + 0.25 * tint)).max() <= 3.0
    assert (colours[1e-9] == colours[0.0]).all()


def test_the_paper_behind_glass_is_that_of_the_scene():
    (white,) = paint(pool(0.5), ABOVE, fit=False, shadows="none").layers[0].fills
    (black,) = paint(pool(0.5, "black"), ABOVE, fit=False, shadows="none").layers[0].fills
    one, two = (f.colours[f.offsets[:-1][f.item == 1]][0].astype(float) for f in (white, black))
    assert np.abs(one - two - 0.5 * 255.0).max() <= 1.0


@pytest.mark.slow
def test_what_is_seen_in_a_pool_is_one_region_for_each_face_and_shadow():
    scene = vp.read(DATA / "pool.scene")
    drawing = vp.paint(scene, smooth=False)
    (fills,) = drawing.layers[0].fills
    assert len(fills) < 1200 and len(write(drawing, "svg")) < 200_000
    # Walls and floor touch all of the water: nothing is looked for behind it, or by way of total reflection.
    seen = fills.take(np.flatnonzero((fills.kind == FillKind.GLASS) & (fills.opacity == 1.0)))
    names = np.array(drawing.items)[seen.item]
    walls = np.isin(names, ["NORTH", "EAST", "SOUTH", "WEST"])
    polygons = polygons_of(seen.points.T, seen.offsets)[walls]
    assert shapely.area(polygons).sum() < 1.3 * shapely.union_all(polygons).area
