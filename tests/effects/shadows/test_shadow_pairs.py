"""Shadows of so many things on so many faces that they cannot be cut out one by one."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.effects.shadows import cast_shadows, cast_within
from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, numbered

PLATES = 200
SIDE = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], dtype=np.float64)
FLAT = SIDE[:, [2, 1, 0]]
LAMPS = (Light((-1.0, 0.2, 0.4), parallel=True, name="LOW"), Light((0.0, 0.2, 1.0), parallel=True, name="HIGH"))
VIEW = Camera((-300.0, -200.0, 200.0), (100.0, 0.0, 0.0))
ASIDE = Camera((100.0, -1000.0, 150.0), (100.0, 50.0, 50.0))
"""From here plates that shade one another stand side by side: few lie on each other in the picture."""


def quads(corners: np.ndarray) -> Mesh:
    """One mesh of quadrangles (n,4,3) that share no vertices."""
    count = len(corners)
    return Mesh(corners.reshape(-1, 3), np.arange(4 * count), np.arange(0, 4 * count + 1, 4))


def plates(first: float = 0.0) -> Mesh:
    """Upright plates one after the other: light along them meets each behind many others."""
    return quads(SIDE * (1.0, 100.0, 100.0) + (first + np.arange(PLATES))[:, None, None] * (1.0, 0.0, 0.0))


def lines_of(scene: Scene, **options: object) -> list[str]:
    """What painting a scene warns of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        vp.paint(scene, ASIDE, tolerance_mm=1.0, **options)
    return [str(entry.message) for entry in caught]


def test_the_shadows_of_a_crowd_on_itself_are_left_out_and_no_others() -> None:
    view = look(numbered([plates(), box((-50, -50, -2), (400, 150, -1))]), VIEW)
    every = cast_shadows(view, LAMPS)
    cast = cast_within(view, LAMPS, 100.0)
    assert cast.left_out.T.tolist() == [[0, 0, 0]]
    kept = every.take(np.flatnonzero((view.face_item[every.face] == 1) | (every.lacking == 2)))
    assert 0 < len(kept) < len(every)
    assert len(cast.shadows) == len(kept)
    order, same = (np.lexsort((s.points[0, s.offsets[:-1]], s.face, s.lacking)) for s in (cast.shadows, kept))
    assert np.allclose(cast.shadows.take(order).points, kept.take(same).points, atol=1e-12)


@pytest.mark.parametrize("pairs", [1e6, np.inf])
def test_where_the_budget_does_all_shadows_are_as_they_were(pairs: float) -> None:
    view = look(numbered([plates(), box((-50, -50, -2), (400, 150, -1))]), VIEW)
    every, cast = cast_shadows(view, LAMPS), cast_within(view, LAMPS, pairs)
    assert cast.left_out.shape == (3, 0)
    assert np.array_equal(cast.shadows.points, every.points) and np.array_equal(cast.shadows.face, every.face)


@pytest.mark.slow
def test_one_roof_over_very_many_tiles_is_no_crowd() -> None:
    side = 150
    steps = np.stack(np.meshgrid(np.arange(side), np.arange(side), [0.0]), axis=-1).reshape(-1, 1, 3)
    roof = FLAT * (side, side, 1.0) + (0.0, 0.0, 5.0)
    view = look(numbered([quads(np.concatenate([roof[None], 0.8 * FLAT + steps]))]), Camera((0, -20, 3), (0, 0, 0)))
    lamp = (Light((0.0, 0.0, 1.0), parallel=True),)
    cast = cast_within(view, lamp, 1.0, casters=np.ones(1, dtype=np.bool_))
    assert not cast.left_out.size
    assert len(cast.shadows) >= 0.9 * side * side


def test_two_crowds_that_shade_each_other_keep_their_shadows_on_the_ground() -> None:
    ground = box((-50, -50, -2), (400, 150, -1))
    view = look(numbered([plates(), plates(0.5), ground]), VIEW)
    cast = cast_within(view, LAMPS[:1], 100.0)
    assert {tuple(row) for row in cast.left_out.T.tolist()} == {(0, a, b) for a in (0, 1) for b in (0, 1)}
    assert set(view.face_item[cast.shadows.face].tolist()) == {2}


@pytest.mark.slow
def test_paint_names_what_throws_them_and_the_lamps_in_one_line() -> None:
    crowd = Item("CROWD", plates(), "blue")
    lamps = (LAMPS[0], Light((-1.0, 0.3, 0.5), parallel=True))
    scene = Scene((crowd, Item("FLOOR", box((-50, -50, -2), (400, 150, -1)), "red")), lights=lamps)
    (line,) = lines_of(scene, budget=1e-4)
    assert line.startswith("CROWD: ") and "itself" in line and "LOW, light 2" in line and "--budget" in line


@pytest.mark.slow
def test_paint_names_what_is_transparent_and_what_lacks_its_shadows() -> None:
    """What is transparent itself shows no shadows of what is."""
    crowd = Item("CROWD", plates(), "blue", vp.Material("transparent"))
    scene = Scene((crowd, Item("OTHERS", plates(0.5), "red")), lights=LAMPS[:1])
    blended, itself, others = lines_of(scene, budget=1e-4)
    assert blended.startswith("CROWD: too much that is transparent ")
    assert itself.startswith("OTHERS: more shadows on itself ")
    assert others.startswith("CROWD: more shadows on OTHERS ") and "LOW" in others and "--budget" in others
