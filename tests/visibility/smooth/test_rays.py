"""Sight lines against a sphere and a torus."""

from __future__ import annotations

import numpy as np
import pytest
from support.smooth_parts import ball_from_above

from vectorplot.geometry.budget import USUAL
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.rays import Balls, Samples, counts_in_front, meetings_along, targets_of
from vectorplot.visibility.smooth.sheets import Sheets


def test_points_behind_inside_in_front_and_beside() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    points = radius * np.array([[0.3, 0.2, -2.0], [0.3, 0.2, 0.0], [0.3, 0.2, 2.0], [1.2, 0.0, -2.0]])
    none, nowhere = np.full(4, -1), np.full((4, 3), np.nan)
    no = np.zeros(4, dtype=np.bool_)
    samples = Samples(points, none, nowhere, none[:, None], nowhere[:, None], no, no)
    assert counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)[0].table(len(samples), 1)[
        :, 0
    ].tolist() == [
        2,
        1,
        0,
        0,
    ]


def test_a_sphere_hides_its_own_lower_half() -> None:
    view, sheet, _ = ball_from_above()
    sheets = Sheets((sheet,))
    latitude = np.radians([-80.0, -30.0, -2.0, 2.0, 30.0, 80.0])
    places = np.stack([np.full(6, 0.7), latitude, np.zeros(6)], axis=1)
    points, none, no = sheet.points(places), np.full(6, -1), np.zeros(6, dtype=np.bool_)
    samples = Samples(points, np.zeros(6, np.intp), places, none[:, None], np.full((6, 1, 3), np.nan), no, no)
    found = counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)[0].table(len(samples), 1)[
        :, 0
    ]
    assert np.array_equal(found > 0, points[:, 2] < 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_sight_lines_close_to_outlines_meet_a_torus_as_often_as_in_closed_form(seed: int) -> None:
    rng = np.random.default_rng(seed)
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    torus = Torus(2.0, 0.7)
    camera = Camera(tuple(9.0 * way), (0.0, 0.0, 0.0), up=(0.3, 1.0, 0.2), parallel=True)
    view = look(Scene((Item("T", torus),)), camera)
    sheets = Sheets(tuple(sheets_of_parametrised(view, torus, 0, True)))
    points = _beside_outlines(rng, way, 2.0, 0.7)
    behind = (points - 9.0 * way - view.centre) @ view.axes.T / view.scale
    none, nowhere, no = np.full(len(points), -1), np.full((len(points), 3), np.nan), np.zeros(len(points), np.bool_)
    samples = Samples(behind, none, nowhere, none[:, None], nowhere[:, None], no, no)
    found = counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)[0].table(len(samples), 1)
    assert np.flatnonzero(found[:, 0] != _meetings_in_closed_form(points, way, 2.0, 0.7)).tolist() == []


def _beside_outlines(rng: np.random.Generator, way: np.ndarray, ring: float, tube: float) -> np.ndarray:
    """Points in both directions off the contour of a torus, by a hundredth to a millionth."""
    along = rng.uniform(0.0, 2.0 * np.pi, 650)
    out = np.stack([np.cos(along), np.sin(along), np.zeros_like(along)], axis=1)
    across = np.arctan2(-out @ way, way[2])
    normal = np.cos(across)[:, None] * out + np.sin(across)[:, None] * np.array([0.0, 0.0, 1.0])
    off = 10.0 ** rng.uniform(-6.0, -2.0, len(along))[:, None] * normal
    return np.concatenate([ring * out + side * tube * normal + sign * off for side in (-1, 1) for sign in (-1, 1)])


def _meetings_in_closed_form(points: np.ndarray, way: np.ndarray, ring: float, tube: float) -> np.ndarray:
    """(k,) how many real roots the quartic of a line has that meets a torus about the z axis."""
    start = points - (points @ way)[:, None] * way
    # |p + t w|^2 + R^2 - r^2 is t^2 + c with w of length one at right angles to p; its square is 4 R^2 (x^2 + y^2).
    c = (start * start).sum(axis=1) + ring**2 - tube**2
    flat = [(way[:2] ** 2).sum(), 2.0 * start[:, :2] @ way[:2], (start[:, :2] ** 2).sum(axis=1)]
    zero = np.zeros_like(c)
    quartics = np.stack([zero + 1.0, zero, 2.0 * c, zero, c * c], axis=1)
    quartics[:, 2:] -= 4.0 * ring**2 * np.stack([zero + flat[0], flat[1], flat[2]], axis=1)
    return np.array([(np.abs(np.roots(q).imag) < 1e-7).sum() for q in quartics])


@pytest.mark.parametrize("parallel", [True, False])
def test_balls_are_met_in_closed_form_where_newton_meets_them(parallel: bool) -> None:
    shapes = [
        Item("EGG", Ellipsoid((1.0, 2.0, 0.5))).turned("x", 40).moved(0.5, 0.2, 0.1),
        Item("BALL", Sphere(0.7)).moved(-2.0, 1.0, 0.3),
        Item("RING", Torus(3.0, 0.4)),
    ]
    view = look(Scene(tuple(shapes)), Camera((4.0, -9.0, 7.0), (0.0, 0.0, 0.0), parallel=parallel))
    sheets = Sheets(
        tuple(sheet for k, item in enumerate(shapes) for sheet in sheets_of_parametrised(view, item.shape, k, True))
    )
    targets = targets_of(view, sheets)
    balls = Balls.of(sheets, targets)
    assert balls.number.tolist() == [0, 1] and set(balls.others.sheet.tolist()) == {2}
    points = np.random.default_rng(3).uniform(-0.6, 0.6, (400, 3)) - [0.0, 0.0, 1.5]
    none = Balls(balls.centre, balls.inverse, *targets.take(np.zeros(0, dtype=np.intp)).boxes_of_sheets, targets)
    one, two = (meetings_along(view, sheets, points, known) for known in (balls, none))
    assert len(one.sample) == len(two.sample) > 200 and set(one.number.tolist()) == {0, 1, 2}
    order, other = (np.lexsort((met.t, met.number, met.sample)) for met in (one, two))
    assert one.sample[order].tolist() == two.sample[other].tolist()
    assert np.abs(one.t[order] - two.t[other]).max() < 1e-9
    ways = sight_lines.sight(view, points)[one.sample]
    met = points[one.sample] + one.t[:, None] * ways
    assert np.abs(sheets.points(one.number, one.places) - met).max() < 1e-9
