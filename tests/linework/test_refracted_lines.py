from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.effort import several
from support.glass_rays import missing, unfounded
from support.mirror_rays import on_page, strokes_of

import vectorplot as vp
from vectorplot.backends.json import json_bytes
from vectorplot.effects import refracted
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


def test_perspectives_say_that_they_do_not_bend_lines():
    told = []
    eye = replace(CAMERA, parallel=False)
    drawing = vp.draw(basin(STICK), eye, page=SQUARE, explain=lambda report: told.append((report.name, report.why)))
    assert not len(strokes_of(drawing, "refracted")[0])
    assert any(name == "left out" and "refraction" in why for name, why in told)
    told.clear()
    vp.draw(basin(STICK), CAMERA, page=SQUARE, explain=lambda report: told.append((report.name, report.why)))
    assert "refracted lines" in {name for name, _ in told} and "left out" not in {name for name, _ in told}


def test_straight_lines_give_way_to_bent_ones():
    drawing = vp.draw(basin(STICK), CAMERA, page=SQUARE, curves="polyline")
    world = np.array([(0.0, -0.1, z) for z in (-1.4, -1.0)])
    straight = on_page(drawing, world)
    for layer in drawing.layers:
        if layer.name != "refracted":
            points = strokes_of(drawing, layer.name)[0].reshape(-1, 2)
            assert not len(points) or cKDTree(points).query(straight)[0].min() > 0.5


def test_lines_over_a_painting_are_bent_too():
    told = {"page": SQUARE, "fit": False, "lines": "contour,crease"}
    one, other = (strokes_of(verb(basin(STICK), CAMERA, **told), "refracted")[0] for verb in (vp.draw, vp.paint))
    one, other = one.reshape(-1, 2), other.reshape(-1, 2)
    assert len(one) and cKDTree(one).query(other)[0].max() < 1e-6


def test_at_any_size_and_place_water_bends_alike():
    shown = strokes_of(vp.draw(basin(STICK), CAMERA, page=SQUARE), "refracted")[0].reshape(-1, 2)
    for scale, shift in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e5)):
        matrix = np.diag([scale, scale, scale, 1.0])
        matrix[:3, 3] = shift
        scene = basin(STICK)
        moved = replace(scene, items=tuple(item.transformed(matrix) for item in scene.items))
        eye, target = (tuple((scale * np.array(one) + shift).tolist()) for one in (CAMERA.eye, CAMERA.target))
        there = vp.draw(moved, vp.Camera(eye, target, parallel=True), page=SQUARE)
        assert cKDTree(shown).query(strokes_of(there, "refracted")[0].reshape(-1, 2))[0].max() < 1e-4
