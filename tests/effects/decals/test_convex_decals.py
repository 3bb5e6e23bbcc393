"""Decals in convex parts."""

from __future__ import annotations

import tracemalloc

import numpy as np

from vectorplot.effects.decals import Decals, convex_decals
from vectorplot.effects.shadows import shadow_decals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.polygon_cuts import polygon_areas
from vectorplot.scene.light import Light
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, numbered


def test_parts_are_convex_and_as_large_and_other_faces_keep_their_decals() -> None:
    floor = box((-4, -4, -1), (4, 4, 0))
    view = look(numbered([floor, box((-1, -1, 0), (0, 0, 1)), box((1, 0, 0), (2, 1, 1))]), Camera((5, -8, 12)))
    decals = shadow_decals(view, (Light((0.7, 0.2, 1.0), parallel=True), Light((0.2, 0.9, 1.0), parallel=True)))
    floor_only = view.face_item == 0
    found = convex_decals(view, decals, floor_only)
    assert len(found) > len(decals)
    for lacking in np.unique(decals.lights_lacking):
        sizes = []
        for some in (decals, found):
            normal, _ = polygon_areas(some.points, some.offsets)
            sizes.append(np.sqrt((normal * normal).sum(axis=0))[some.lights_lacking == lacking].sum())
        assert np.isclose(*sizes, rtol=1e-9)
    for begin, end in zip(found.offsets[:-1], found.offsets[1:], strict=True):
        corners = found.points[:, begin:end].T
        sides = np.roll(corners, -1, axis=0) - corners
        turns = np.cross(sides, np.roll(sides, -1, axis=0))
        assert (turns @ turns.sum(axis=0) > -1e-9).all() or not floor_only[found.face[found.offsets[:-1] == begin]]
    assert convex_decals(view, decals, ~floor_only & False) is decals


def test_a_decal_of_many_corners_takes_memory_in_proportion() -> None:
    count = 3000
    view = look(numbered([box((-4, -4, -1), (4, 4, 0))]), Camera((0, 0, 12)))
    heights = view.world_of(view.points[:, view.corners])[:, 2].reshape(-1, 4).min(axis=1)
    top = int(np.argmax(heights))
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    reach = np.where(np.arange(count) % 2, 1.0, 2.0)
    world = np.stack([reach * np.cos(angle), reach * np.sin(angle), np.zeros(count)], axis=1)
    none = np.zeros(1, dtype=np.intp)
    star = Decals(view.points_of(world), np.array([0, count]), none + top, none + 1, none, none, none - 1, none)
    tracemalloc.start()
    found = convex_decals(view, star, np.ones(view.face_count, dtype=np.bool_))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found) == count - 2 and (found.face == top).all()
    assert peak < 1e7
