"""Polygons in water: as few pieces as the bend of their outlines asks for."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from vectorplot.effects.refraction import SightWays, Soup, bent, traced
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box

EVERYWHERE = np.array([[-np.inf], [np.inf], [-np.inf], [np.inf]])
FLOOR = np.array([(-1.0, -1.0, -1.0), (1.0, -1.0, -1.0), (1.0, 1.0, -1.0), (-1.0, 1.0, -1.0)])


def pool() -> tuple[View, SightWays]:
    """The cube of side 2 about the origin, and its upper face as the surface of water."""
    view = look(Scene((Item("A", box((-1, -1, -1), (1, 1, 1))),)), Camera(eye=(3.0, -4.0, 3.0)))
    down = (view.axes @ np.array([0.0, 0.0, -1.0]))[:, None, None]
    return view, SightWays(down, view.points_of(np.array([[0.0, 0.0, 1.0]]))[..., None], np.array([4.0 / 3.0]))


def floor_in(view: View) -> Soup:
    zero = np.zeros(1, dtype=np.intp)
    return Soup(view.points_of(FLOOR), np.array([0, 4]), zero, zero)


def outlines(view: View, found: Soup) -> tuple[np.ndarray, np.ndarray]:
    """The sides (2,n,2) of triangles in the image, and which of them are sides of one triangle only."""
    image = view.image_of(found.points).reshape(2, -1, 3)
    sides = np.stack([image, np.roll(image, -1, axis=2)], axis=3).reshape(2, -1, 2)
    key = [tuple(sorted(map(tuple, np.round(side.T, 9).tolist()))) for side in sides.transpose(1, 0, 2)]
    count = Counter(key)
    # The sides between parts are common to two of them: nothing gapes, and nothing is covered twice.
    assert set(count.values()) == {1, 2}
    return sides, np.array([count[k] == 1 for k in key])


@pytest.mark.capability("G6.6-pool")
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_outlines_are_as_straight_as_asked_for(tolerance: float) -> None:
    view, water = pool()
    found = bent(view, water, floor_in(view), EVERYWHERE, tolerance)
    assert (np.diff(found.offsets) == 3).all()
    sides, outer = outlines(view, found)
    middle = sides[:, outer].mean(axis=2)
    rays = traced(view, water, middle)
    below = view.points_of(FLOOR)
    normal = water.normal[:, 0, 0]
    there = rays.place + (normal @ (below[:, :1] - rays.place)) / (normal @ rays.direction) * rays.direction
    world = view.world_of(there)
    beside = np.abs(np.abs(world[:, :2]).max(axis=1) - 1.0)
    # One unit of the floor is less than one and a half of the image.
    assert beside.max() <= 1.5 * tolerance * view.scale
    a, b = np.diff(view.image_of(found.points).reshape(2, -1, 3), axis=2).transpose(2, 0, 1)
    area = a[0] * b[1] - a[1] * b[0]
    assert (area > 0.0).all() or (area < 0.0).all()


@pytest.mark.slow
def test_there_are_fewer_pieces_than_in_a_grid_as_fine_as_the_outline() -> None:
    view, water = pool()
    found = bent(view, water, floor_in(view), EVERYWHERE, 1e-5)
    outer = outlines(view, found)[1]
    assert len(found) < 0.25 * 2 * (outer.sum() / 4) ** 2


def test_what_windows_do_not_show_is_left_out() -> None:
    view, water = pool()
    beside = np.array([[5.0], [6.0], [5.0], [6.0]])
    assert len(bent(view, water, floor_in(view), beside, 1e-3)) == 0
