"""All points of curves of smooth surfaces are exact, also those at which polyhedra, other surfaces, halos and the
picture's frame cut them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.effort import several
from support.smooth_scenes import mixed_scenes, views

from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.surfaces.tori import ImplicitTorus
from vectorplot.testing import assert_on_both, assert_on_surface, curves_in_space
from vectorplot.testing.shapes import box
from vectorplot.words import LineKind

MIXED = mixed_scenes()

EXACT = 1e-10
"""Part of the extent."""

ON_SHEETS = (LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.PARAMETER, LineKind.ISOPHOTE, LineKind.INTERSECTION)


def assert_exact(drawing: Drawing, scene: Scene) -> int:
    """Points lie on the surfaces of their items, and their images are where they are drawn; the number of points."""
    size = float(np.ptp(scene.bounds, axis=0).max())
    on_items: list[list[np.ndarray]] = [[] for _ in scene.items]
    for paths in (part for layer in drawing.layers for part in layer.strokes):
        homogeneous = np.column_stack([paths.points3d, np.ones(len(paths.points3d))]) @ drawing.page_from_world.T
        assert np.abs(homogeneous[:, :2] / homogeneous[:, 3:] - paths.points).max(initial=0.0) < 1e-6
        owner = np.repeat(np.arange(len(paths)), np.diff(paths.offsets))
        for number, item in enumerate(scene.items):
            if is_parametrised(item.shape) or is_implicit(item.shape):
                own = paths.smooth & (paths.item == number) & np.isin(paths.kind, ON_SHEETS)
                on_items[number].append(paths.points3d[own[owner]])
    compared = 0
    for item, parts in zip(scene.items, on_items, strict=True):
        points = np.concatenate([np.zeros((0, 3)), *parts])
        if len(points):
            assert_on_surface(points, item.shape, EXACT * size)
        compared += len(points)
    return compared


@cache
def drawing_of(name: str) -> Drawing:
    """What is seen from somewhere."""
    return draw(MIXED[name], next(views(MIXED[name], 1, len(name))), hidden="solid", page=Page(60, 40, 2))


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", MIXED)
def test_points_are_on_their_surfaces_whatever_cuts_the_curves(name: str) -> None:
    assert assert_exact(drawing_of(name), MIXED[name]) > 50


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spheres piercing", "cylinders piercing", "saddle through a torus"])
def test_curves_in_which_surfaces_meet_are_on_both_ends_included(name: str) -> None:
    scene = MIXED[name]
    for camera in list(views(scene, 2, len(name)))[: several(1, long=2)]:
        # With the contours: the picture of the meetings alone is so much larger that all is traced once more for it.
        drawing = draw(scene, camera, lines="contour,intersection", hidden="solid", page=Page(60, 40, 2))
        curves = curves_in_space(drawing, kind="intersection")
        size = float(np.ptp(scene.bounds, axis=0).max())
        assert_on_both(curves, scene.items[0].shape, scene.items[1].shape, EXACT * size)


@pytest.mark.slow
def test_ends_at_halos_and_at_the_frame_are_on_their_curves() -> None:
    scene = MIXED["torus and box"]
    camera = Camera((8.0, -16.0, 11.0), (0.0, 0.0, 0.0), fov_deg=14.0)
    for options in ({"halo_mm": 1.5}, {"fit": False}, {"fit": False, "halo_mm": 1.0, "hidden": "solid"}):
        assert assert_exact(draw(scene, camera, page=Page(60, 40, 2), **options), scene) > 50


@pytest.mark.slow
def test_a_chord_that_a_wall_cuts_ends_on_the_torus_where_it_is_seen() -> None:
    scene = MIXED["torus and box"]
    behind = replace(scene, items=(scene.items[0], Item("wall", box((-1.0, -9.0, -2.0), (0.5, -8.9, 3.0)))))
    camera = Camera((0.0, -30.0, 8.0), (0.0, 0.0, 0.0))
    whole, cut = (
        np.concatenate([part.points3d for layer in draw(s, camera).layers for part in layer.strokes])
        for s in (replace(scene, items=scene.items[:1]), behind)
    )
    ring = ImplicitTorus(3.0, 1.0)
    new = cut[cKDTree(whole).query(cut, p=np.inf)[0] > 1e-9]
    new = new[new[:, 1] > -5.0]
    assert len(new) > 10 and np.abs(ring.values(new)).max() < 1e-10
    # They lie on sight lines that pass the upright borders or the upper one of the wall.
    t = (-9.0 - new[:, 1]) / (-30.0 - new[:, 1])
    at = new + t[:, None] * (np.array(camera.eye) - new)
    back = new + ((-8.9 - new[:, 1]) / (-30.0 - new[:, 1]))[:, None] * (np.array(camera.eye) - new)
    sides = [np.abs(p[:, 0] - x) for p in (at, back) for x in (-1.0, 0.5)]
    sides += [np.abs(p[:, 2] - z) for p in (at, back) for z in (-2.0, 3.0)]
    assert np.min(sides, axis=0).max() < 2e-2
