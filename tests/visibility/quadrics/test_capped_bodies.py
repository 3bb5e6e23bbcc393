"""Capped bodies with all that can be drawn on them and around them, against rays and against the second engine."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support.body_rays import body_sight, off_surface, unit_body

from vectorplot.drawing.drawing import CurvedStrokes
from vectorplot.geometry.camera import Camera
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import Capped, Frustum, rod
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Cylinder, Ellipsoid, Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box
from vectorplot.visibility.polyhedra.lines import straight_lines
from vectorplot.visibility.quadrics import closed_forms as first_engine
from vectorplot.visibility.quadrics.closed_forms import closed_forms
from vectorplot.visibility.quadrics.hidden_intervals import visible_arcs
from vectorplot.visibility.smooth.hidden_curves import whole_lines_and_chords
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.words import DRAWN, LineKind, line_kinds

LINES = SurfaceLines(columns=5, rows=3)

SHAPES = [
    lambda rng: Capped(Cylinder(rng.uniform(0.2, 0.6), -0.5, 0.6)),
    lambda rng: Capped(Cone.standing(rng.uniform(0.3, 0.8), rng.uniform(0.5, 1.0))),
    lambda rng: Capped(Frustum(rng.uniform(0.1, 0.7), rng.uniform(0.1, 0.7), rng.uniform(0.3, 1.0))),
    lambda rng: Capped(Sphere(0.7), (0.0, 0.5 * np.pi)),
    lambda rng: Capped(Ellipsoid((0.7, 0.5, 0.6)), (-0.9, 0.5)),
    lambda rng: Capped(Cone(0.6, 0.2, 1.0)),
    lambda rng: Sphere(rng.uniform(0.2, 0.7)),
]


def heap(seed, affine, scale=1.0, shift=0.0):
    """Bodies of all kinds, turned every way and apart from each other, and two boxes between them; with what the rays
    need."""
    rng = np.random.default_rng(seed)
    items, bodies, boxes = [], [], []
    for number, place in enumerate(np.stack(np.meshgrid(*[np.arange(3)] * 3), axis=-1).reshape(-1, 3) * 2.6):
        matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        if affine:
            matrix = 0.7 * matrix @ (np.eye(3) + 0.25 * rng.normal(size=(3, 3)))
        shape = SHAPES[rng.integers(len(SHAPES))](rng)
        placed = PlacedSurface(shape, scale * matrix, scale * (place + rng.uniform(-0.2, 0.2, 3)) + shift)
        items.append(Item(str(number), placed, curves=LINES))
        bodies.append(unit_body(placed))
    for axis in range(2):
        low = rng.uniform(0.0, 4.0, 3)
        high = low + rng.uniform(0.5, 1.5, 3)
        low[axis], high[axis] = 1.25, 1.35
        boxes.append((scale * low + shift, scale * high + shift))
        items.append(Item(f"box {axis}", box(*boxes[-1])))
    return Scene(tuple(items)), bodies, boxes


def camera_of(seed, distance, parallel, scale=1.0, shift=0.0):
    direction = np.random.default_rng(seed + 100).normal(size=3)
    eye = scale * (2.6 + distance * direction / np.linalg.norm(direction)) + shift
    return Camera(eye=tuple(eye.tolist()), target=tuple(np.full(3, 2.6 * scale + shift).tolist()), parallel=parallel)


def strokes_of(drawing):
    return [(paths, k) for layer in drawing.layers for paths in layer.strokes for k in range(len(paths))]


def samples(drawing, bodies):
    """Points of what is drawn, on bodies or straight lines, and by how many items they are said to be hidden."""
    points, counts, smooth = [], [], []
    part = np.linspace(0.0, 1.0, 7)[1:-1, None, None]
    for paths, k in strokes_of(drawing):
        own = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        straight = len(own) == 2 or not paths.smooth[k]
        inner = (own[:-1] * (1.0 - part) + own[1:] * part).reshape(-1, 3) if straight else own[1:-1]
        points.append(inner)
        counts += [paths.hidden_by[k]] * len(inner)
        smooth += [paths.smooth[k]] * len(inner)
    points = np.concatenate(points)
    off = [off_surface(body, (points - body.centre) @ np.linalg.inv(body.frame)) for body in bodies]
    # Points of chords are off their curves.
    on = ~np.array(smooth) | (np.min(off, axis=0) < 1e-9)
    return points[on], np.array(counts)[on]


def forms_of(scene, camera):
    def seen(bodies, arcs, sides):
        return visible_arcs(bodies, arcs, sides, lambda _: None)

    return closed_forms(scene, look(scene, camera), line_kinds(DRAWN), seen)


@cache
def drawn(seed, affine, parallel):
    scene, bodies, boxes = heap(seed, affine)
    camera = camera_of(seed, (9.0, 20.0, 6.5)[seed % 3], parallel)
    return scene, camera, bodies, boxes, draw(scene, camera, hidden="solid", curves="polyline")


CASES = [(seed, affine, parallel) for seed in (0, 2) for affine in (False, True) for parallel in (False, True)]


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("case", CASES)
def test_every_point_is_hidden_by_as_many_items_as_rays_meet(case):
    scene, camera, bodies, boxes, drawing = drawn(*case)
    assert len(forms_of(scene, camera).items) == len(bodies)
    points, counts = samples(drawing, bodies)
    truth = body_sight(camera, points, bodies, boxes)
    assert truth.sure.sum() > 4000
    # In an apex the rulings of a cone meet, those in front and those behind.
    wrong = truth.sure & (truth.hidden_by != counts)
    apex = [np.linalg.norm(points[wrong] - (b.centre + b.frame[2]), axis=1) for b in bodies if b.radii[1] == 0.0]
    assert all(np.min(apex, axis=0, initial=np.inf) < 1e-9) if wrong.any() else True


def length_of(drawing, kind, hidden_by=0):
    total = 0.0
    for paths, k in strokes_of(drawing):
        if paths.kind[k] == kind and paths.hidden_by[k] == hidden_by:
            own = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
            own = np.concatenate([own, own[:1]]) if paths.closed[k] else own
            total += float(np.linalg.norm(np.diff(own, axis=0), axis=1).sum())
    return total


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES[:3])
def test_visible_lines_are_the_lines_hidden_by_nothing(case):
    scene, camera, _, _, drawing = drawn(*case)
    plain = draw(scene, camera, curves="polyline")
    for kind in (LineKind.CONTOUR, LineKind.CREASE, LineKind.PARAMETER):
        assert length_of(plain, kind) == pytest.approx(length_of(drawing, kind), rel=1e-3)


@cache
def seen_heap(scale, shift):
    """What is seen of a heap of some size somewhere."""
    return draw(heap(3, False, scale, shift)[0], camera_of(3, 9.0, False, scale, shift), curves="polyline")


@pytest.mark.parametrize(
    ("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6), pytest.param(1e-3, -5.0, marks=pytest.mark.slow)]
)
def test_neither_size_nor_place_changes_anything(scale, shift):
    one, two = seen_heap(1.0, 0.0), seen_heap(scale, shift)
    for kind in (LineKind.CONTOUR, LineKind.CREASE, LineKind.PARAMETER):
        assert length_of(one, kind) == pytest.approx(length_of(two, kind), rel=1e-6)


VIEWS = [((9, -7, 6), False), ((3, -12, 0.4), True), ((1, -2, -11), False), ((2, 1, 14), True)]

MIXED = """
CAN blue surface cylinder 1 0 2 capped parameter_lines 6 3
HAT red surface cone 1 2 capped translation 3 0 0 parameter_lines 5 2
POT green surface frustum 1 0.5 1.5 capped rotation x 70 translation -3 0 1
DOME yellow surface sphere 1 v 0 90 capped rotation y 100 translation 0 3 0
ZONE pink surface ellipsoid 1 0.7 1 v -30 45 capped translation 0 -3 0.5 parameter_lines 5 3
"""


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize(("eye", "parallel"), VIEWS)
def test_both_engines_draw_the_same(eye, parallel, monkeypatch):
    scene = parse_scene(MIXED)
    camera = Camera(eye, (0, 0, 0.5), parallel=parallel)
    one = draw(scene, camera, curves="polyline")
    monkeypatch.setattr(first_engine, "capped_quadric_of", lambda shape: None)
    two = draw(scene, camera, curves="polyline")
    for kind in (LineKind.CONTOUR, LineKind.CREASE, LineKind.PARAMETER):
        assert length_of(one, kind) == pytest.approx(length_of(two, kind), rel=3e-4)


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize(("eye", "parallel"), [((1, -2, -11), False), ((7, 16.7, 6.7), True), ((8.8, -11, 1.8), True)])
def test_traced_bodies_are_hidden_by_as_many_items_as_rays_meet(eye, parallel, monkeypatch):
    # Some outlines run along rims, and lines end there, where both of the sheets that meet end.
    scene = parse_scene(MIXED)
    bodies = [unit_body(item.shape) for item in scene.items]
    camera = Camera(eye, (0, 0, 0.5), parallel=parallel)
    monkeypatch.setattr(first_engine, "capped_quadric_of", lambda shape: None)
    drawing = draw(scene, camera, hidden="solid", curves="polyline")
    points, counts = samples(drawing, bodies)
    truth = body_sight(camera, points, bodies)
    on_apex = np.linalg.norm(points - np.array([3.0, 0.0, 2.0]), axis=1) < 1e-9
    known = truth.sure & ~on_apex
    assert known.sum() > 1000
    assert (counts == truth.hidden_by)[known].all()


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize(("eye", "parallel"), [*VIEWS, ((0, 0, 15), True), ((0, 0, -15), False)])
def test_bodies_lie_to_the_side_of_their_traced_outlines_that_is_said(eye, parallel):
    item = Item("can", Capped(Frustum(0.6, 1.1, 1.5)) if eye[0] else Capped(Cylinder(1.0, 0.0, 2.0)))
    view = look(Scene((item,)), Camera(eye, (0, 0, 0.5), parallel=parallel))
    sheets = scene_sheets(Scene((item,)), view)
    traced = traced_scene(Scene((item,)), view, sheets, frozenset({LineKind.CONTOUR}), 1e-4)
    none = np.zeros(0, dtype=np.intp)
    lines = whole_lines_and_chords(traced, straight_lines(np.zeros((3, 0)), np.zeros((3, 0)), none, none, none))
    start, end = view.image_of(lines.start), view.image_of(lines.end)
    way, arm = end - start, np.mean(start, axis=1, keepdims=True) - start
    # The image of the body is convex.
    left = way[0] * arm[1] - way[1] * arm[0] > 0.0
    assert len(lines) > 8
    assert np.array_equal(lines.sides(view), np.where(left, 1, -1))


def test_rulings_on_outlines_are_drawn_once():
    can = Item("can", Capped(Cylinder(1.0, 0.0, 2.0)), curves=SurfaceLines(columns=6, rows=1))
    drawing = draw(Scene((can,)), Camera((1, -2, -11), (0, 0, 0.5)))
    rulings = [
        paths.points3d[paths.offsets[k]] for paths, k in strokes_of(drawing) if paths.kind[k] == LineKind.PARAMETER
    ]
    # The one at angle 0 lies on the contour.
    assert sorted(np.round([x for x, _, _ in rulings], 9).tolist()) == [-0.5, 0.5]


def test_bodies_on_a_ground_are_drawn_in_closed_form():
    items = [Item("ground", box((-1, -1, -0.2), (9, 9, 0.0)))]
    for k in range(9):
        place = (4.0 * (k % 3), 4.0 * (k // 3), 0.0)
        items.append(Item(str(k), Capped(Cylinder(0.5, 0, 2, place) if k % 2 else Cone.standing(0.6, 2, place))))
    scene, camera = Scene(tuple(items)), Camera((20, -14, 12), (4, 4, 0))
    assert len(forms_of(scene, camera).items) == 9
    bodies = [unit_body(item.shape) for item in items[1:]]
    drawing = draw(scene, camera, hidden="solid", curves="polyline")
    points, counts = samples(drawing, bodies)
    truth = body_sight(camera, points, bodies, [((-1, -1, -0.2), (9, 9, 0.0))])
    above = points[:, 2] > 1e-6
    assert (counts == truth.hidden_by)[truth.sure & above].all()
    # The parts of rims that are seen stand on the ground, which does not hide them.
    rims = [paths.hidden_by[k] for paths, k in strokes_of(drawing) if paths.kind[k] == LineKind.CONTOUR]
    assert 0 in rims


@pytest.mark.slow
@pytest.mark.parametrize("upwards", [True, False])
def test_what_lies_beyond_an_apex_is_not_inside_of_the_cone(upwards):
    # In the other half of the double cone, in front of the base.
    cone = Item("cone", Capped(Cone.standing(1.0, 0.3) if upwards else Cone(1.0, 0.0, 0.3)))
    apex, way = (np.array([0.0, 0.0, 0.3]), 1.0) if upwards else (np.zeros(3), -1.0)
    middles = [apex + np.array([x, 0.0, 0.1 * way]) for x in (-0.1, 0.0, 0.1)]
    grains = [Item(str(k), box(p - 1e-2, p + 1e-2)) for k, p in enumerate(middles)]
    for parallel in (False, True):
        drawing = draw(Scene((cone, *grains)), Camera((0.0, -6.0, 3.0 * way), parallel=parallel), hidden="solid")
        assert {paths.hidden_by[k] for paths, k in strokes_of(drawing) if paths.item[k]} == {0, 1}
        whole = draw(Scene((cone, *grains)), Camera((0.0, -6.0, 3.0 * way), parallel=parallel), lines="contour")
        assert {paths.item[k] for paths, k in strokes_of(whole)} == {0, 1, 2, 3}


def test_a_rod_through_balls_meets_them_in_circles():
    first, second = np.array([0.0, 0.0, 0.0]), np.array([3.0, 1.0, 2.0])
    items = (Item("a", Sphere(1.0, first)), Item("b", Sphere(0.7, second)), Item("bond", rod(first, second, 0.3)))
    scene, camera = Scene(items), Camera((2, -12, 5), (1, 0.5, 1))
    forms = forms_of(scene, camera)
    assert forms.items == {0, 1, 2}
    drawing = draw(scene, camera, hidden="solid", curves="polyline")
    circles = [
        paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        for paths, k in strokes_of(drawing)
        if paths.kind[k] == LineKind.INTERSECTION
    ]
    points = np.concatenate(circles)
    way = (second - first) / np.linalg.norm(second - first)
    off = points - first
    assert np.linalg.norm(off - (off @ way)[:, None] * way, axis=1) == pytest.approx(0.3, abs=1e-12)
    on_balls = np.linalg.norm(points - first, axis=1) - 1.0, np.linalg.norm(points - second, axis=1) - 0.7
    assert np.min(np.abs(on_balls), axis=0) == pytest.approx(0.0, abs=1e-12)
    bodies = [unit_body(item.shape) for item in items]
    found, counts = samples(drawing, bodies)
    truth = body_sight(camera, found, bodies)
    assert (counts == truth.hidden_by)[truth.sure].all()


def test_equal_bodies_are_drawn_once_and_stacked_ones_touch():
    can, twin = Capped(Cylinder(1.0, 0.0, 2.0)), PlacedSurface(Capped(Cylinder(0.5, 0.0, 1.0)), 2.0 * np.eye(3))
    above = Capped(Cylinder(1.0, 2.0, 3.0))
    camera = Camera((5, -9, 7), (0, 0, 1))
    one, two = (
        draw(Scene(tuple(Item(str(k), s) for k, s in enumerate(shapes))), camera) for shapes in ((can,), (can, twin))
    )
    assert len(strokes_of(one)) == len(strokes_of(two))
    stacked = Scene((Item("a", can), Item("b", above)))
    assert forms_of(stacked, camera).items == {0, 1}


@pytest.mark.slow
def test_what_has_no_closed_form_is_a_surface_like_any_other():
    camera = Camera((30, -24, 9), (0, 0, 0))
    can, far = Item("a", Capped(Cylinder())), Item("far", Sphere(1.0, (16, 0, 0)))

    def items(*others, camera=camera):
        return forms_of(Scene((*others, far)), camera).items

    assert items(can) == {0, 1}
    assert items(can, Item("ring", Torus(1.0, 0.4))) == {2}
    assert items(can, camera=Camera((0.2, 0.1, 0.3), (5, 0, 0))) == {1}
    lit, cut = SurfaceLines(isophotes=(0.5,)), SurfaceLines(sections=(Section((1, 0, 0), (0.1,)),))
    oval = PlacedSurface(can.shape, np.diag([1.0, 0.5, 1.0]), np.zeros(3))
    assert items(Item("lit", can.shape, curves=lit), Item("cut", far.shape, curves=cut)) == {0, 1, 2}
    assert items(Item("lit", oval, curves=lit)) == {1}
    assert items(Item("cut", oval, curves=cut)) == {0, 1}
    assert items(Item("vase", Capped(Cylinder()), lines=("contour",))) == {0, 1}


def test_what_lies_under_a_body_is_hidden_by_it():
    # The lines of a grid on the ground run under a can, in the plane of its bottom.
    can = Item("can", Capped(Cylinder(1.0, 0.0, 1.0)))
    strips = [Item(str(k), box((0.5 * k - 2, -3, -0.1), (0.5 * k - 1.5, 3, 0.0))) for k in range(8)]
    drawing = draw(Scene((can, *strips)), Camera((4, -9, 6), (0, 0, 0)), lines="edges")
    for paths, k in strokes_of(drawing):
        points = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        if paths.item[k] and np.abs(points[:, 2]).max() < 1e-9 and np.ptp(points[:, 0]) < 1e-9:
            middle = 0.5 * (points[:-1] + points[1:])
            assert (np.hypot(middle[:, 0], middle[:, 1]) > 0.5).all()


@pytest.mark.slow
def test_glass_bodies_hide_nothing_and_creases_leave_as_arcs():
    glass = Item("glass", Capped(Cylinder(2.0, 0.0, 3.0)), material=Material("transparent"))
    core = Item("core", Capped(Cone.standing(1.0, 2.0, (0, 0, 0.5))))
    drawing = draw(Scene((glass, core)), Camera((5, -9, 7), (0, 0, 1)), hidden="solid")
    assert max(paths.hidden_by[k] for paths, k in strokes_of(drawing)) == 1
    alone = draw(Scene((Item("can", Capped(Cylinder())),)), Camera((5, -9, 7), (0, 0, 1)))
    marks = [mark for layer in alone.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]
    assert sum(len(mark.arcs) for mark in marks) == 1


def test_a_can_seen_along_its_axis_is_a_circle():
    for eye, parallel in (((0, 0, 9), True), ((0, 0, 9), False), ((0, 0, -9), True)):
        scene = Scene((Item("can", Capped(Cylinder(1.0, 0.0, 2.0)), curves=LINES),))
        drawing = draw(scene, Camera(eye, (0, 0, 1), parallel=parallel), lines="contour,crease")
        lengths = [length_of(drawing, kind) for kind in (LineKind.CONTOUR, LineKind.CREASE)]
        assert lengths[0] > 0.0 and lengths[1] == 0.0
