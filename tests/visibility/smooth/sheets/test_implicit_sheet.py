"""Implicit surfaces as sheets: the same numbers as their parametrised forms give."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.placed_surface import PlacedImplicit
from vectorplot.surfaces.quadrics import Quadric, implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.sheets import ImplicitSheet, implicit_sheet, placed_in_view

CUT = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -1.0], np.array([[-1.2, -0.7, -1.2], [0.8, 1.2, 0.6]]))


def view_of(shape, parallel: bool = False) -> View:
    return look(Scene((Item("item", shape),)), Camera((7.0, -9.0, 5.0), (0.2, 0.1, 0.0), parallel=parallel))


def sheet_of(shape) -> ImplicitSheet:
    return implicit_sheet(view_of(shape), shape, 0, True)


def test_the_tessellation_lies_on_the_sheet() -> None:
    sheet = sheet_of(ImplicitTorus(3.0, 1.0))
    assert np.abs(sheet.points(sheet.vertices) - sheet.vertices).max() < 1e-12
    assert sheet.on_sheet(sheet.vertices).all()
    assert 0.0 < sheet.deviations.max() < 3e-3
    assert sheet.own.doubts == ()


@pytest.mark.parametrize("seed", range(3))
def test_normals_and_bends_are_those_of_the_parametrised_form(seed: int) -> None:
    view = view_of(ImplicitTorus(3.0, 1.0))
    one = sheets_of_parametrised(view, Torus(3.0, 1.0), 0, True)[0]
    two = implicit_sheet(view, ImplicitTorus(3.0, 1.0), 0, True)
    random = np.random.default_rng(seed)
    places = np.concatenate([random.uniform(0.0, 2.0 * np.pi, (40, 2)), np.zeros((40, 1))], axis=1)
    points, ways = one.points(places), random.normal(size=(40, 3))
    turned = np.sign((one.normals(places) * two.normals(points)).sum(axis=1))
    assert np.allclose(two.normals(points), turned[:, None] * one.normals(places), atol=1e-11)
    assert np.allclose(two.bends(points, ways), turned * one.bends(places, ways), rtol=1e-8, atol=1e-9)


def test_a_step_along_the_sheet_stays_on_it_to_first_order() -> None:
    sheet = sheet_of(ImplicitTorus(3.0, 1.0))
    places, steps = sheet.vertices[::50], np.random.default_rng(0).normal(size=sheet.vertices[::50].shape)
    off = [np.linalg.norm(sheet.points(moved) - moved, axis=1) for moved in (
        sheet.moved(places, 1e-3 * steps), sheet.moved(places, 1e-4 * steps)
    )]  # fmt: skip
    assert off[0].max() < 1e-4
    assert off[1].max() < 0.02 * off[0].max()


def test_places_near_a_sheet_have_its_points() -> None:
    sheet = sheet_of(implicit_sphere(1.0))
    near = sheet.vertices * (1.0 + 1e-4 * np.random.default_rng(1).normal(size=(len(sheet.vertices), 1)))
    away = np.linalg.norm(sheet.points(near) - near, axis=1)
    assert np.allclose(away, np.linalg.norm(near - sheet.vertices, axis=1), rtol=1e-3)


def test_newton_finds_where_lines_meet_a_sphere() -> None:
    sheet = sheet_of(implicit_sphere(1.0))
    radius = float(np.linalg.norm(sheet.vertices, axis=1).mean())
    random = np.random.default_rng(2)
    aside = random.uniform(-0.6, 0.6, (30, 2)) * radius
    points = np.concatenate([aside, np.full((30, 1), -3.0)], axis=1)
    ways = np.tile([0.0, 0.0, 2.0], (30, 1))
    height = np.sqrt(radius**2 - (aside**2).sum(axis=1))
    places = points + np.stack([0.0 * height, 0.0 * height, 3.0 + 1.04 * height], axis=1)
    for _ in range(6):
        t, places, _ = sheet.missed(points, ways, places)
    assert np.allclose(t, 0.5 * (3.0 + height), atol=1e-10)
    assert np.allclose(places[:, 2], height, atol=1e-10)


def test_the_box_is_that_of_the_world_whatever_the_view() -> None:
    view = view_of(CUT)
    sheet = implicit_sheet(view, CUT, 0, True)
    world = np.array(
        [[0.8, 0.6, 0.0], [0.79, 0.6, 0.1], [0.81, 0.5, 0.0], [-np.sqrt(0.15), -0.7, 0.6], [0.0, 0.0, -1.0]]
    )
    places = view.points_of(world).T
    assert sheet.on_sheet(places).tolist() == [True, True, False, True, True]
    inner = sheet.inwards(places) @ view.axes
    assert inner[0, 0] < 0.0 and inner[3, 1] > 0.0 and inner[3, 2] < 0.0
    assert not inner[[1, 4]].any()
    assert np.abs((sheet.inwards(places) * np.nan_to_num(sheet.normals(places))).sum(axis=1)).max() < 1e-12


def test_a_placement_far_away_keeps_its_digits() -> None:
    torus = ImplicitTorus(3.0, 1.0)
    far = PlacedImplicit(torus, np.eye(3), (1e6, -2e6, 3e6))
    eye, target = ((p + np.array([1e6, -2e6, 3e6])).tolist() for p in np.array([[7.0, -9.0, 5.0], [0.2, 0.1, 0.0]]))
    view = look(Scene((Item("item", far),)), Camera(tuple(eye), tuple(target)))
    placed = placed_in_view(view, far)
    near = Torus(3.0, 1.0).points(*np.random.default_rng(3).uniform(0.0, 6.0, (2, 50)))
    points = (near + (np.array([1e6, -2e6, 3e6]) - view.centre)) @ view.axes.T / view.scale
    assert np.abs(placed.values(points) / np.linalg.norm(placed.gradients(points), axis=1)).max() < 1e-14


def test_an_empty_surface_is_a_sheet_without_triangles() -> None:
    nothing = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, 1.0], np.array([[-1.0] * 3, [1.0] * 3]))
    sheet = sheet_of(nothing)
    assert len(sheet.corners) == 0 and len(sheet.deviations) == 0
