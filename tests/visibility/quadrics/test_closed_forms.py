"""Spheres and ellipsoids with all that can be drawn on them and around them, against rays in closed form."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support.ball_rays import sight

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import ball_of
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box
from vectorplot.visibility.quadrics.closed_forms import closed_forms
from vectorplot.visibility.quadrics.hidden_intervals import visible_arcs
from vectorplot.words import DRAWN, LineKind, line_kinds

LINES = SurfaceLines(columns=5, rows=4, isophotes=(-0.4, 0.3), sections=(Section((1, 2, 3), (9.0, 13.0, 17.0, 21.0)),))


def heap(seed, count, shape, boxes):
    """Balls that pierce each other and boxes, all in the cube from 0 to 10; with centres and frames, lows and highs."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(1, 9, (count, 3))
    sizes = rng.uniform(0.4, 1.3, count) * (60.0 / count) ** (1.0 / 3.0)
    frame = np.eye(3) + 0.4 * rng.normal(size=(3, 3))
    shapes = [
        Sphere(float(r), tuple(c)) if shape == "spheres" else PlacedSurface(Sphere(float(r)), frame, tuple(c))
        for c, r in zip(centres, sizes, strict=True)
    ]
    lines = LINES if shape == "spheres" else SurfaceLines(columns=5, rows=4, sections=LINES.sections)
    items = [Item(f"ball {k}", s, curves=lines) for k, s in enumerate(shapes)]
    lows = rng.uniform(0, 7, (boxes, 3))
    highs = lows + rng.uniform(0.5, 3, (boxes, 3))
    items += [Item(f"box {k}", box(*pair)) for k, pair in enumerate(zip(lows, highs, strict=True))]
    balls = [(b.centre, b.frame) for b in map(ball_of, shapes) if b]
    lights = (Light((20, -30, 40)), Light((1, -1, 3), parallel=True))
    return Scene(tuple(items), lights[seed % 2 :]), balls, list(zip(lows, highs, strict=True))


def camera_of(seed, parallel):
    direction = np.random.default_rng(seed + 100).normal(size=3)
    eye = 5.0 + 25.0 * direction / np.linalg.norm(direction)
    return Camera(eye=tuple(eye.tolist()), target=(5, 5, 5), parallel=parallel)


def strokes_of(drawing):
    """(paths, number) of every stroke."""
    return [(paths, k) for layer in drawing.layers for paths in layer.strokes for k in range(len(paths))]


def points_of(drawing, kinds=frozenset(LineKind)):
    """World points of what is drawn, with the counts of their strokes and their kinds: inner points of chords, which
    lie on their curves, and the middles of straight parts."""
    points, counts, found = [], [], []
    for paths, k in strokes_of(drawing):
        own = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        if paths.kind[k] in kinds:
            inner = own[1:-1] if paths.smooth[k] else 0.5 * (own[:-1] + own[1:])
            points.append(inner)
            counts += [paths.hidden_by[k]] * len(inner)
            found += [paths.kind[k]] * len(inner)
    return np.concatenate(points), np.array(counts), np.array(found)


def length_of(paths, k):
    own = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
    return float(np.linalg.norm(np.diff(own, axis=0), axis=1).sum())


@cache
def drawn(seed, count, shape, boxes, parallel):
    scene, balls, lows = heap(seed, count, shape, boxes)
    camera = camera_of(seed, parallel)
    return scene, camera, balls, lows, draw(scene, camera, hidden="solid", curves="polyline")


CASES = [
    (seed, count, shape, boxes, parallel)
    for seed, (count, shape, boxes) in enumerate(
        [(2, "spheres", 0), (12, "spheres", 3), (60, "spheres", 0), (8, "ellipsoids", 2), (40, "ellipsoids", 4)]
    )
    for parallel in (False, True)
]


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("case", CASES)
def test_every_point_is_hidden_by_as_many_items_as_rays_meet(case):
    _, camera, balls, boxes, drawing = drawn(*case)
    points, counts, kinds = points_of(drawing)
    on_surface = kinds != LineKind.CONTOUR
    truth = sight(camera, points, balls, boxes)
    sure = (truth.margin > 1e-4) & on_surface
    assert sure.sum() > 100
    assert (counts[sure] == truth.hidden_by[sure]).all()


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_contours_are_hidden_by_as_many_others_as_rays_meet(case):
    _, camera, balls, boxes, drawing = drawn(*case)
    points, counts, _ = points_of(drawing, {LineKind.CONTOUR})
    # A contour lies on its ball, which does not hide it.
    own = np.zeros(len(points), dtype=bool)
    for centre, frame in balls:
        s = (points - centre) @ np.linalg.inv(frame)
        own |= np.abs((s * s).sum(1) - 1.0) < 1e-9
    points, counts = points[own], counts[own]
    every = [sight(camera, points, [ball]) for ball in balls]
    truth = sum((np.where(one.margin < 1e-4, 0, one.hidden_by) for one in every), np.zeros(len(points), int))
    doubtful = sum((one.margin < 1e-4 for one in every), np.zeros(len(points), int)) > 1
    others = sight(camera, points, [], boxes)
    sure = ~doubtful & (others.margin > 1e-4)
    assert sure.sum() > 20
    assert (counts[sure] == (truth + others.hidden_by)[sure]).all()


@pytest.mark.parametrize("case", CASES[:4])
def test_visible_lines_are_the_lines_hidden_by_nothing(case):
    scene, camera, _, _, drawing = drawn(*case)
    plain = draw(scene, camera, curves="polyline")
    lengths = [
        sum(length_of(paths, k) for paths, k in strokes_of(one) if paths.hidden_by[k] == 0) for one in (plain, drawing)
    ]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-3)


@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_neither_size_nor_place_changes_anything(scale, shift):
    def scene(scale, shift):
        rng = np.random.default_rng(2)
        centres = rng.uniform(0, 6, (12, 3)) * scale + shift
        radii = rng.uniform(0.5, 1.5, 12) * scale
        items = [Item(str(k), Sphere(float(r), tuple(c))) for k, (c, r) in enumerate(zip(centres, radii, strict=True))]
        eye = np.array([20.0, -14.0, 9.0]) * scale + shift
        target = np.full(3, 3.0 * scale + shift)
        return Scene(tuple(items)), Camera(eye=tuple(eye.tolist()), target=tuple(target.tolist()))

    one, two = (draw(*scene(*how), curves="polyline") for how in ((1.0, 0.0), (scale, shift)))
    for a, b in zip(one.layers, two.layers, strict=True):
        for p, q in zip(a.strokes, b.strokes, strict=True):
            assert len(p) == len(q)
            assert p.points == pytest.approx(q.points, abs=1e-4)


def forms_of(items, eye=(30, -24, 9), lights=()):
    scene = Scene(tuple(items), lights)
    view = look(scene, Camera(eye=eye, target=(0, 0, 0)))

    def seen(balls, arcs, sides):
        return visible_arcs(balls, arcs, sides, lambda _: None)

    return closed_forms(scene, view, line_kinds(DRAWN), seen)


def test_what_has_no_closed_form_is_a_surface_like_any_other():
    ball, far = Item("a", Sphere(1.0)), Item("b", Sphere(1.0, (16, 0, 0)))
    assert forms_of([ball, far]).items == {0, 1}
    assert forms_of([ball, Item("ring", Torus(1.0, 0.4)), far]).items == {2}
    crossing = forms_of([Item("e", Ellipsoid((1, 2, 3))), Item("f", Ellipsoid((3, 2, 1))), far])
    assert crossing.items == {0, 1, 2} and crossing.traced.tolist() == [[0, 1]]
    assert forms_of([Item("e", Ellipsoid((1, 2, 3))), Item("f", Ellipsoid((2, 4, 6), (1, 0, 0))), far]).items == {
        0,
        1,
        2,
    }
    assert forms_of([ball, far], eye=(0.2, 0.1, 0.3)).items == {1}
    bright = SurfaceLines(isophotes=(0.5,))
    assert forms_of([Item("e", Ellipsoid((1, 2, 3)), curves=bright), far]).items == {1}
    assert forms_of([Item("s", Sphere(2.0), curves=bright)], lights=(Light((0.5, 0, 0)),)).items == frozenset()


def test_a_chain_of_balls_that_meet_a_torus_is_traced_and_one_apart_is_not():
    chain = [Item(str(k), Sphere(1.0, (1.5 * k, 0.0, 0.0))) for k in range(4)]
    assert forms_of([*chain, Item("ring", Torus(1.0, 0.3)), Item("far", Sphere(1.0, (0, 9, 0)))]).items == {5}


@pytest.mark.hard(80)
def test_equal_balls_are_drawn_once():
    ball, twin, other = Item("a", Sphere(1.0)), Item("b", Sphere(1.0)), Item("c", Sphere(0.5, (1.2, 0, 0)))
    one, two = (draw(Scene(items), Camera(eye=(5, -9, 4))) for items in ((ball, other), (ball, twin, other)))
    assert len(strokes_of(one)) == len(strokes_of(two))


@pytest.mark.hard(80)
def test_equal_balls_hide_the_far_sides_of_each_other_s_lines():
    lines = SurfaceLines(columns=6, rows=4)
    ball, twin = Item("a", Sphere(1.0), curves=lines), Item("b", PlacedSurface(Sphere(0.5), 2.0 * np.eye(3)))
    camera = Camera(eye=(5, -9, 4))
    drawing = draw(Scene((ball, twin)), camera, hidden="solid")
    assert {int(paths.hidden_by[k]) for paths, k in strokes_of(drawing)} == {0, 2}
    # What is drawn on glass is hidden by an opaque ball in its place, wherever it is turned away.
    glass = Item("a", Sphere(1.0), material=Material("transparent"), curves=lines)
    one, two = (draw(Scene(items), camera) for items in ((ball,), (glass, twin)))
    lengths = [sum(length_of(paths, k) for paths, k in strokes_of(one)) for one in (one, two)]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-3)


@pytest.mark.hard(80)
def test_touching_balls_have_no_curve_in_common_and_whole_contours():
    scene = Scene((Item("a", Sphere(1.0)), Item("b", Sphere(1.0, (2.0, 0.0, 0.0)))))
    drawing = draw(scene, Camera(eye=(1.0, -9.0, 0.0), target=(1, 0, 0), parallel=True))
    strokes = [paths for layer in drawing.layers for paths in layer.strokes if len(paths)]
    assert [paths.kind.tolist() for paths in strokes] == [[LineKind.CONTOUR, LineKind.CONTOUR]]
    assert strokes[0].closed.all()


def test_glass_balls_hide_nothing_and_show_all_of_their_lines():
    lines = SurfaceLines(columns=4)
    glass = Item("glass", Sphere(2.0), material=Material("transparent"), curves=lines)
    scene = Scene((glass, Item("core", Sphere(1.0))))
    camera = Camera(eye=(5, -9, 4))
    assert sum(paths.kind[k] == LineKind.CONTOUR for paths, k in strokes_of(draw(scene, camera))) == 2
    # Behind the core the meridians of the glass are hidden, behind the glass is nothing.
    assert max(paths.hidden_by[k] for paths, k in strokes_of(draw(scene, camera, hidden="solid"))) == 1


def test_a_ball_behind_the_eye_is_not_drawn_and_one_beside_it_is_cut():
    items = (
        Item("ahead", Sphere(1.0)),
        Item("behind", Sphere(1.0, (0, -30, 0))),
        Item("beside", Sphere(3.0, (4, -10, 0))),
    )
    drawing = draw(Scene(items), Camera(eye=(0, -10, 0), target=(0, 0, 0)))
    found = {int(k) for layer in drawing.layers for paths in layer.strokes for k in paths.item}
    assert 0 in found and 1 not in found


def test_a_circle_leaves_as_one_arc_of_an_ellipse():
    from vectorplot.drawing.drawing import CurvedStrokes

    drawing = draw(Scene((Item("a", Sphere(1.0)),)), Camera(eye=(5, -9, 4)))
    marks = [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]
    assert [len(mark.arcs) for mark in marks] == [1]


def test_a_wireframe_shows_every_arc_whole():
    scene = Scene((Item("a", Sphere(1.0), curves=SurfaceLines(columns=6, rows=4)), Item("b", Sphere(1.0, (0, 3, 0)))))
    drawing = draw(scene, Camera(eye=(0, -12, 2)), style="wireframe")
    kinds = [int(paths.kind[k]) for paths, k in strokes_of(drawing)]
    assert kinds.count(LineKind.PARAMETER) >= 6 and kinds.count(LineKind.CONTOUR) == 2
