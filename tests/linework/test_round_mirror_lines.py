import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.bent_rays import missing_in_mirror, unfounded_in_mirror
from support.effort import several
from support.mirror_rays import nearest, on_page, strokes_of

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.surfaces import Sphere, Torus, rod
from vectorplot.testing.shapes import box

SQUARE = vp.Page(120, 120)
CAMERA = vp.Camera((0, -8, 3), (0, 0, 0))
MIRROR = vp.Material("mirror")


def before(shape, *things):
    return vp.Scene((vp.Item("MIRROR", shape, material=MIRROR), *things))


POST = vp.Item("POST", box((1.5, -2.0, -0.5), (2.0, -1.5, 1.0)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", several(range(4), long=range(40)))
def test_what_a_round_mirror_shows_is_drawn_and_nothing_else(seed):
    wrong, seen = missing_in_mirror(seed, 60)
    assert wrong == 0 and seen > 5
    wrong, looked_at = unfounded_in_mirror(seed, 150)
    assert wrong == 0 and looked_at > 10


@pytest.mark.parametrize("parallel", [False, True])
def test_a_corner_is_seen_in_a_ball_where_fermat_says(parallel):
    drawing = vp.draw(before(Sphere(1.0), POST), replace(CAMERA, parallel=parallel), page=SQUARE, curves="polyline")
    strokes, items = strokes_of(drawing, "reflected")
    eye, corner = np.array(CAMERA.eye, dtype=float), np.array([1.5, -2.0, 1.0])
    to_eye = eye / np.linalg.norm(eye)
    # In the plane of eye, corner and centre: the angle of the place is found by halving.
    side = np.cross(np.cross(to_eye, corner), to_eye)
    side /= np.linalg.norm(side)
    low, high = 0.0, np.arccos(to_eye @ corner / np.linalg.norm(corner))
    for _ in range(80):
        middle = 0.5 * (low + high)
        place = np.cos(middle) * to_eye + np.sin(middle) * side
        away = to_eye if parallel else (eye - place) / np.linalg.norm(eye - place)
        there = (corner - place) / np.linalg.norm(corner - place)
        low, high = (low, middle) if place @ there > place @ away else (middle, high)
    place = np.cos(low) * to_eye + np.sin(low) * side
    assert nearest(strokes[items == 1].reshape(-1, 2, 2), on_page(drawing, place[None]))[0] < 1e-3


def test_without_reflections_and_without_mirrors_nothing_is_reflected():
    plain = replace(before(Sphere(1.0), POST), items=(vp.Item("BALL", Sphere(1.0)), POST))
    for drawing in (vp.draw(before(Sphere(1.0), POST), CAMERA, reflections=0), vp.draw(plain, CAMERA)):
        assert not len(strokes_of(drawing, "reflected")[0])


def test_a_scene_without_round_mirrors_loads_nothing_of_them():
    code = (
        "import sys, vectorplot as vp; from vectorplot.geometry import box; vp.draw(vp.Item('BOX', box((1, 1, 1))));"
        "assert not [m for m in sys.modules if 'round_mirror' in m or 'bent_lines' in m]"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_mirrors_of_other_shapes_say_that_they_show_nothing():
    with pytest.warns(InputWarning, match="MIRROR: a mirror of this shape shows no lines"):
        drawing = vp.draw(before(Torus(1.0, 0.3), POST), CAMERA)
    assert not len(strokes_of(drawing, "reflected")[0])


def test_a_rod_shows_things_between_its_ends_only():
    drawing = vp.draw(before(rod((0, 0, -1), (0, 0, 1), 0.8), POST), CAMERA, page=SQUARE, curves="polyline")
    strokes, _ = strokes_of(drawing, "reflected")
    circle = np.linspace(0.0, 2.0 * np.pi, 721)
    rims = [np.stack([0.8 * np.cos(circle), 0.8 * np.sin(circle), np.full(721, z)], axis=1) for z in (-1.0, 1.0)]
    hull = np.concatenate([on_page(drawing, rim) for rim in rims])
    points = strokes.reshape(-1, 2)
    assert len(points) and (points >= hull.min(axis=0)).all() and (points <= hull.max(axis=0)).all()


def test_what_stands_before_a_round_mirror_hides_what_it_shows():
    screen = vp.Item("SCREEN", box((-3, -4.1, -3), (3, -4, 3)), lines=())
    drawing = vp.draw(before(Sphere(1.0), POST, screen), CAMERA, page=SQUARE)
    assert not len(strokes_of(drawing, "reflected")[0])


@pytest.mark.slow
def test_lines_over_a_painting_are_in_round_mirrors_too():
    told = {"page": SQUARE, "fit": False, "lines": "contour,crease"}
    one, other = (
        strokes_of(verb(before(Sphere(1.0), POST), CAMERA, **told), "reflected")[0] for verb in (vp.draw, vp.paint)
    )
    assert len(other) and nearest(one, other.reshape(-1, 2)).max() < 0.05


def test_at_any_size_and_place_round_mirrors_show_the_same():
    shown = strokes_of(vp.draw(before(Sphere(1.0), POST), CAMERA, page=SQUARE), "reflected")[0].reshape(-1, 2)
    for scale, shift in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e5)):
        matrix = np.diag([scale, scale, scale, 1.0])
        matrix[:3, 3] = shift
        scene = before(Sphere(1.0), POST)
        moved = replace(scene, items=tuple(item.transformed(matrix) for item in scene.items))
        eye, target = (tuple((scale * np.array(one) + shift).tolist()) for one in (CAMERA.eye, CAMERA.target))
        there = vp.draw(moved, vp.Camera(eye, target), page=SQUARE)
        assert cKDTree(shown).query(strokes_of(there, "reflected")[0].reshape(-1, 2))[0].max() < 1e-3
