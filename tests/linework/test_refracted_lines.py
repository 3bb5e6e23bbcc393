from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.bent_rays import missing_in_glass, unfounded_in_glass
from support.effort import several
from support.glass_rays import missing, unfounded
from support.mirror_rays import nearest, on_page, strokes_of

import vectorplot as vp
from vectorplot.backends.json import json_bytes
from vectorplot.effects import refracted, seen_in_surface
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import box

SQUARE = vp.Page(120, 120)
CAMERA = vp.Camera((3, -9, 8), (0, 0, 0), parallel=True)


def basin(*things: vp.Item, refraction: float = 1.333) -> vp.Scene:
    """Things in water between z = -2 and z = 0."""
    water = vp.Material("transparent", refraction=refraction)
    return vp.Scene((vp.Item("WATER", box((-3, -3, -2), (3, 3, 0)), material=water), *things))


STICK = vp.Item("STICK", box((-0.1, -0.1, -1.5), (0.1, 0.1, 1.5)))


@pytest.mark.parametrize("seed", several(range(4), long=range(40)))
def test_what_bent_rays_see_is_drawn_and_nothing_else(seed):
    wrong, seen = missing(seed, 300)
    assert wrong == 0 and seen > 5
    wrong, looked_at = unfounded(seed, 300)
    assert wrong == 0 and looked_at > 250


def test_points_under_water_are_seen_where_snells_law_says():
    drawing = vp.draw(basin(STICK), CAMERA, page=SQUARE, curves="polyline")
    strokes, items = strokes_of(drawing, "refracted")
    way = np.array(CAMERA.target) - CAMERA.eye
    inside, _ = refracted(way, (0, 0, 1), 1.333)
    corners = np.array([(x, y, -1.5) for x in (-0.1, 0.1) for y in (-0.1, 0.1)])
    entries = corners - inside * ((corners[:, 2] / inside[2])[:, None])
    ends = strokes[items == 1].reshape(-1, 2)
    off, _ = cKDTree(ends).query(on_page(drawing, entries))
    # One of the lower corners is behind the stick.
    assert (off < 1e-6).sum() >= 3


def test_a_ball_in_water_has_the_contour_of_bent_rays():
    ball = vp.Item("BALL", Sphere(0.6)).moved(0, 0, -1.2)
    drawing = vp.draw(basin(ball), CAMERA, page=SQUARE, curves="polyline", lines="contour")
    strokes, items = strokes_of(drawing, "refracted")
    points = strokes[items == 1].reshape(-1, 2)
    inside, _ = refracted(np.array(CAMERA.target) - CAMERA.eye, (0, 0, 1), 1.333)
    one = np.cross(inside, (1.0, 0.0, 0.0))
    one /= np.linalg.norm(one)
    t = np.linspace(0.0, 2.0 * np.pi, 4001)[:, None]
    circle = np.array([0.0, 0.0, -1.2]) + 0.6 * (np.cos(t) * one + np.sin(t) * np.cross(inside, one))
    entries = circle - inside * (circle[:, 2] / inside[2])[:, None]
    through_top = (np.abs(entries[:, :2]) < 3.0).all(axis=1)
    expected = on_page(drawing, entries[through_top])
    # Through the side it is seen once more, elsewhere.
    off, _ = cKDTree(expected).query(points)
    assert (off < 0.03).sum() > 50
    assert cKDTree(points[off < 0.03]).query(expected)[0].max() < 2.0


def test_a_refraction_of_one_is_none():
    clear = vp.Material("transparent")
    plain = basin(STICK)
    plain = replace(plain, items=(replace(plain.items[0], material=clear), STICK))
    one, other = (vp.draw(scene, CAMERA, page=SQUARE) for scene in (basin(STICK, refraction=1.0), plain))
    assert json_bytes(one) == json_bytes(other)


PERSPECTIVE = replace(CAMERA, parallel=False)


@pytest.mark.slow
@pytest.mark.parametrize("seed", several(range(3), long=range(30)))
def test_what_bent_rays_of_a_perspective_see_is_drawn_and_nothing_else(seed):
    wrong, seen = missing_in_glass(seed, 12)
    assert wrong == 0 and seen > 0
    wrong, looked_at = unfounded_in_glass(seed, 100)
    assert wrong == 0 and looked_at > 80


def test_perspective_points_under_water_are_seen_where_snells_law_says():
    drawing = vp.draw(basin(STICK), PERSPECTIVE, page=SQUARE, curves="polyline")
    strokes, items = strokes_of(drawing, "refracted")
    corners = np.array([(x, y, -1.5) for x in (-0.1, 0.1) for y in (-0.1, 0.1)])
    entries = seen_in_surface(PERSPECTIVE.eye, corners, (0, 0, 1), (0, 0, 0), 1.333)
    off, _ = cKDTree(strokes[items == 1].reshape(-1, 2)).query(on_page(drawing, entries))
    assert (off < 1e-6).sum() >= 3


def test_a_straight_line_under_water_is_a_smooth_curve_in_a_perspective():
    rail = vp.Item("RAIL", box((-2.9, 0.0, -1.9), (2.9, 0.05, -1.85)))
    drawing = vp.draw(basin(rail), replace(PERSPECTIVE, eye=(1, -4, 3)), page=SQUARE, tolerance_mm=0.01)
    world = np.stack([np.linspace(-2.9, 2.9, 400), np.full(400, 0.0), np.full(400, -1.85)], axis=1)
    entries = seen_in_surface((1, -4, 3), world, (0, 0, 1), (0, 0, 0), 1.333)
    through_top = (np.abs(entries[:, :2]) < 2.99).all(axis=1)
    layer = next(layer for layer in drawing.layers if layer.name == "refracted")
    assert nearest(strokes_of(drawing, "refracted")[0], on_page(drawing, entries[through_top])).max() < 0.05
    # Joined and fitted, not left in chords.
    assert sum(len(strokes) for strokes in layer.strokes) < 40


def test_a_refraction_of_one_is_none_in_a_perspective():
    clear = vp.Material("transparent")
    plain = basin(STICK)
    plain = replace(plain, items=(replace(plain.items[0], material=clear), STICK))
    one, other = (vp.draw(scene, PERSPECTIVE, page=SQUARE) for scene in (basin(STICK, refraction=1.0), plain))
    assert json_bytes(one) == json_bytes(other)


def test_what_refracts_is_a_stage_in_perspectives_too():
    told = []
    for eye in (PERSPECTIVE, CAMERA):
        vp.draw(basin(STICK), eye, page=SQUARE, explain=lambda report: told.append(report.name))
    assert told.count("refracted lines") == 2 and "left out" not in told


def test_lines_in_water_that_are_hidden_are_dashed():
    drawing = vp.draw(basin(STICK), PERSPECTIVE, page=SQUARE, hidden="dashed")
    layer = next(layer for layer in drawing.layers if layer.name == "hidden")
    assert sum(map(len, layer.strokes))


@pytest.mark.slow
def test_a_ball_in_water_hides_in_a_perspective_what_is_behind_it():
    ball = vp.Item("BALL", Sphere(0.6)).moved(0, 0, -1.2)
    behind = vp.Item("POST", box((-0.05, 1.0, -2.0), (0.05, 1.1, -0.1)))
    eye = replace(PERSPECTIVE, eye=(0.0, -9.0, 4.0))
    alone, both = (
        strokes_of(vp.draw(basin(*things), eye, page=SQUARE, fit=False), "refracted")
        for things in ((behind,), (behind, ball))
    )
    posts = [np.hypot(*(s[i == 1][:, 1] - s[i == 1][:, 0]).T).sum() for s, i in (alone, both)]
    assert 0.05 * posts[0] < posts[1] < 0.9 * posts[0]


def test_straight_lines_give_way_to_bent_ones():
    drawing = vp.draw(basin(STICK), CAMERA, page=SQUARE, curves="polyline")
    world = np.array([(0.0, -0.1, z) for z in (-1.4, -1.0)])
    straight = on_page(drawing, world)
    for layer in drawing.layers:
        if layer.name != "refracted":
            points = strokes_of(drawing, layer.name)[0].reshape(-1, 2)
            assert not len(points) or cKDTree(points).query(straight)[0].min() > 0.5


@pytest.mark.parametrize("camera", [CAMERA, PERSPECTIVE], ids=["parallel", "perspective"])
def test_lines_over_a_painting_are_bent_too(camera):
    told = {"page": SQUARE, "fit": False, "lines": "contour,crease"}
    one, other = (strokes_of(verb(basin(STICK), camera, **told), "refracted")[0] for verb in (vp.draw, vp.paint))
    one, other = one.reshape(-1, 2), other.reshape(-1, 2)
    assert len(one) and cKDTree(one).query(other)[0].max() < (1e-6 if camera.parallel else 0.05)


@pytest.mark.parametrize("camera", [CAMERA, PERSPECTIVE], ids=["parallel", "perspective"])
def test_at_any_size_and_place_water_bends_alike(camera):
    shown = strokes_of(vp.draw(basin(STICK), camera, page=SQUARE), "refracted")[0].reshape(-1, 2)
    for scale, shift in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e5)):
        matrix = np.diag([scale, scale, scale, 1.0])
        matrix[:3, 3] = shift
        scene = basin(STICK)
        moved = replace(scene, items=tuple(item.transformed(matrix) for item in scene.items))
        eye, target = (tuple((scale * np.array(one) + shift).tolist()) for one in (camera.eye, camera.target))
        there = vp.draw(moved, vp.Camera(eye, target, parallel=camera.parallel), page=SQUARE)
        assert cKDTree(shown).query(strokes_of(there, "refracted")[0].reshape(-1, 2))[0].max() < 1e-4


@pytest.mark.slow
def test_what_pierces_each_other_in_water_does_so_a_million_units_off():
    post = vp.Item("POST", box((-0.7, -1.0, -2.5), (-0.2, 1.0, 1.0)))
    shown, there = [], basin(vp.Item("BALL", Sphere(0.8)).moved(0.2, 0.1, -0.5), post)
    for shift in (0.0, 1e6):
        moved = replace(there, items=tuple(item.moved(shift, shift, shift) for item in there.items))
        eye, target = (tuple((np.array(one) + shift).tolist()) for one in (PERSPECTIVE.eye, PERSPECTIVE.target))
        told = {"lines": "intersection", "tolerance_mm": 0.1, "page": SQUARE, "curves": "polyline"}
        drawing = vp.draw(moved, replace(PERSPECTIVE, eye=eye, target=target), **told)
        strokes, items = strokes_of(drawing, "refracted")
        shown.append(strokes[items == 1])
    assert len(shown[0]) > 10
    assert max(nearest(one, other.reshape(-1, 2)).max() for one, other in (shown, shown[::-1])) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("camera", [CAMERA, PERSPECTIVE], ids=["parallel", "perspective"])
@pytest.mark.parametrize("low", [(-1.0, 2.0, 0.0), (-1.0, -0.5, 0.2)], ids=["behind", "within"])
def test_what_is_in_glass_behind_glass_is_seen_once(camera, low):
    glass = vp.Item("GLASS", box((-2, -1, 0), (2, 1, 2)), material=vp.Material("transparent", refraction=1.5))
    high = np.add(low, (1.5, 1.0, 1.0))
    thing = vp.Item("THING", box(tuple(np.add(low, 0.2)), tuple(high - 0.2)))
    bending, clear = (
        strokes_of(
            vp.draw(
                vp.Scene(
                    (
                        vp.Item("OTHER", box(low, tuple(high)), material=vp.Material("transparent", refraction=n)),
                        glass,
                        thing,
                    )
                ),
                replace(camera, eye=(0.5, -12.0, 1.5), target=(0.0, 0.0, 1.0)),
                page=SQUARE,
            ),
            "refracted",
        )
        for n in (1.3, 1.0)
    )
    lengths = [np.hypot(*(s[i == 2][:, 1] - s[i == 2][:, 0]).T).sum() for s, i in (bending, clear)]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-6) and lengths[0] > 1.0


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [True, False])
def test_what_stands_in_the_floor_of_a_pool_ends_there_with_a_line(parallel):
    water = vp.Item("WATER", box((-2, -2, 0), (2, 2, 1)), material=vp.Material("transparent", refraction=1.333))
    floor, stone = vp.Item("FLOOR", box((-2, -2, -0.2), (2, 2, 0))), vp.Item("STONE", Sphere(1.0)).moved(0, 0, -0.6)
    camera = vp.Camera((0, 0, 9), (0, 0, 0), parallel=parallel)
    # No border is asked for: that is where two things meet.
    drawing = vp.draw(vp.Scene((water, floor, stone)), camera, lines="contour,intersection", curves="polyline")
    strokes, items = strokes_of(drawing, "refracted")
    ends = strokes[items == 2] - 0.5 * np.array([drawing.width_mm, drawing.height_mm])
    radius = np.linalg.norm(ends, axis=2)
    assert np.ptp(radius) < 0.05
    around = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()
    assert around == pytest.approx(2.0 * np.pi * radius.mean(), rel=1e-3)
    if parallel:
        assert radius.mean() == pytest.approx(0.8 * np.linalg.norm(drawing.page_from_world[0, :3]), abs=0.02)
