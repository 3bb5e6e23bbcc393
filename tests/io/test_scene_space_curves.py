"""Curves in space in scene files: every family, where they stand, what is written and said about mistakes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.curves.curve import is_curve
from vectorplot.curves.families import Circle, Helix, Line, Loxodrome, cylinder_intersection
from vectorplot.curves.placed_curves import PlacedCurve, curve_of_function
from vectorplot.curves.splines import (
    AkimaSpline,
    ApproximatingSpline,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    nurbs_curve,
    spline_curve,
)
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.io.description import describe
from vectorplot.io.named_shapes import CURVES
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.swept import revolution_surface
from vectorplot.testing import assert_on_both, assert_same_curve, curves_in_space

TURN = 2.0 * np.pi
MOVES = "rotation x 30 scale 1 2 -0.5 translation -1 0 0 matrix 0 1 0 2 1 0 0 0 0 0 3 1"

POINTS = np.array([(0, 0, 0), (2, 1, 0), (3, 0, 1), (2, -2, 2), (0, -1, 1)], dtype=float)
PLACES = ", ".join(f"{x:g} {y:g} {z:g}" for x, y, z in POINTS)

FAMILIES = [
    pytest.param("line 0 0 0, 1 2 3", Line.through((0, 0, 0), (1, 2, 3)), marks=pytest.mark.capability("G8.1-line")),
    pytest.param("circle", Circle(), marks=pytest.mark.capability("G8.1-circle")),
    ("circle 2 centre 1 2 3 axis 1 1 0 arc 0 90", Circle((1, 2, 3), 2.0, (1, 1, 0), 0.0, np.pi / 2)),
    ("helix 2 0.5", Helix(2.0, 0.5)),
    ("helix rise -1 axis 1 0 0 centre 0 0 1 arc -180 720", Helix(1.0, -1.0, (0, 0, 1), (1, 0, 0), -np.pi, 2 * TURN)),
    pytest.param("loxodrome 2 80", Loxodrome(2.0, np.radians(80.0)), marks=pytest.mark.capability("G8.1-loxodrome")),
    ("loxodrome course 100 arc -90 270", Loxodrome(1.0, np.radians(100.0), -np.pi / 2, 1.5 * np.pi)),
    *[
        pytest.param(
            f"cylinder_intersection {r} {s} {a} branch {branch}",
            cylinder_intersection(r, s, a)[branch - 1],
            marks=pytest.mark.capability("G8.1-cylcyl"),
        )
        for r, s, a, branch in [
            (3, 1, 0.5, 1),
            (3, 1, 0.5, 2),
            (1, 3, 0.5, 1),
            (1, 3, 0.5, 2),
            (2, 2, 0.5, 1),
            (3, 2, 1, 1),
            (2, 3, 1, 1),
            (2, 2, 0, 1),
            (2, 2, 0, 2),
        ]
    ],
    pytest.param(
        '"cos(t)" "sin(t)" "0.2*t" t 0 "2*pi"',
        curve_of_function(lambda t: (np.cos(t), np.sin(t), 0.2 * t), 0.0, TURN),
        marks=pytest.mark.capability("G8.1-curve"),
    ),
    ('"cos(t)" "sin(t)" 1 t 0 "2*pi" closed', Circle((0, 0, 1))),
    ('curve "t" 0 1 t 0 1', Line((0, 0, 1), (1, 0, 0))),
    *[
        pytest.param(text.format(PLACES), wanted, marks=pytest.mark.capability("G3.L-mathobj"))
        for text, wanted in (
            ("akima {}", spline_curve(POINTS, AkimaSpline())),
            ("akima closed points {}", spline_curve(POINTS, AkimaSpline(closed=True))),
            ("akima {} parameters 0, 1, 3, 4, 6", spline_curve(POINTS, AkimaSpline(parameters=[0, 1, 3, 4, 6]))),
            ("cubic {} closed", spline_curve(POINTS, CubicSpline(closed=True))),
            ("cubic {} tangents 1 0 0, 0 1 0", spline_curve(POINTS, CubicSpline(tangents=((1, 0, 0), (0, 1, 0))))),
            ("bspline {} order 3", spline_curve(POINTS, BSpline(3))),
            ("bspline order 5 closed points {}", spline_curve(POINTS, BSpline(5, closed=True))),
            ("interpolating {} order 5", spline_curve(POINTS, InterpolatingSpline(5))),
            ("approximating {} controls 3 order 3", spline_curve(POINTS, ApproximatingSpline(3, 3))),
            (
                'nurbs {} weights 1, 2, "sqrt(2)/2", 1, 1 order 3',
                nurbs_curve(POINTS, [1, 2, 0.5**0.5, 1, 1], order=3),
            ),
            (
                "nurbs {} knots 0 0 0 0, 2 3 3 3 3",
                nurbs_curve(POINTS, knots=[0, 0, 0, 0, 2, 3, 3, 3, 3]),
            ),
        )
    ],
]


def shape(text):
    (item,) = parse_scene(f"A curve {text}").items
    return item.shape


def same_curve(found, wanted):
    t = np.linspace(wanted.start, wanted.end, 40)
    ends = np.allclose((found.start, found.end), (wanted.start, wanted.end), rtol=1e-15, atol=0.0)
    return (
        ends
        and found.closed == wanted.closed
        and np.allclose(found.points(t), wanted.points(t), rtol=0.0, atol=1e-12)
        and np.allclose(found.tangents(t), wanted.tangents(t), rtol=0.0, atol=1e-8, equal_nan=True)
    )


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize(("text", "wanted"), FAMILIES)
def test_a_family_is_the_curve_of_that_name(text, wanted):
    assert is_curve(shape(text)) and same_curve(shape(text), wanted)


@pytest.mark.capability("G8.1-curve", "G8.1-line", "G8.1-circle", "G8.1-loxodrome", "G8.1-cylcyl")
@pytest.mark.parametrize(("text", "wanted"), FAMILIES)
def test_what_is_drawn_of_a_curve_is_all_of_it(text, wanted):
    """From its formula to a polyline, and to a picture as fine as asked for."""
    true = wanted.points(np.linspace(wanted.start, wanted.end, 4001))
    camera = Camera((5.0, -9.0, 40.0), tuple(true.mean(axis=0)), parallel=True)
    page = Page(100.0, 100.0, 5.0)
    drawing = draw(parse_scene(f"A curve {text}"), camera, page=page, tolerance_mm=0.02, curves="polyline")
    image = np.column_stack([true, np.ones(len(true))]) @ drawing.page_from_world.T
    paths = [paths for layer in drawing.layers for paths in layer.strokes]
    lines = [one.points[a:b] for one in paths for a, b in pairwise(one.offsets)]
    lines = [np.vstack([line, line[:1]]) for line in lines] if wanted.closed else lines
    assert_same_curve(lines, image[:, :2] / image[:, 3:], 0.025)
    ends = np.concatenate([line[[0, -1]] for line in curves_in_space(drawing, kind="curve")])
    if not wanted.closed:
        for end in true[[0, -1]]:
            assert np.linalg.norm(ends - end, axis=1).min() < 1e-9


@pytest.mark.capability("G3.6-write")
@pytest.mark.parametrize(("text", "wanted"), FAMILIES)
def test_curves_are_written_and_read_again(text, wanted):
    written = write_scene(parse_scene(f"A curve {text} {MOVES}"))
    second = parse_scene(written)
    rows = np.array([[0, 1, 0, 2], [1, 0, 0, 0], [0, 0, 3, 1.0]])
    t = np.linspace(wanted.start, wanted.end, 7)
    sine, cosine = 0.5, np.sqrt(0.75)
    turned = wanted.points(t) @ np.array([[1, 0, 0], [0, cosine, sine], [0, -sine, cosine]])
    expected = (turned * (1, 2, -0.5) - (1, 0, 0)) @ rows[:, :3].T + rows[:, 3]
    assert np.allclose(second.items[0].shape.points(t), expected, rtol=0.0, atol=1e-11)
    assert write_scene(second) == written and written.isascii()


def test_every_family_sweeps_surfaces_too():
    texts = [family.values[0] if hasattr(family, "values") else family[0] for family in FAMILIES]
    named = {text.split()[0]: text for text in texts if text.split()[0] in CURVES}
    assert set(named) == set(CURVES)
    for word, text in named.items():
        first = parse_scene(f"A surface revolution {text}").items[0].shape
        again = parse_scene(write_scene(Scene((Item("A", first),)))).items[0].shape
        assert same_curve(again.generator, revolution_surface(shape(text)).generator), word


def test_formulas_may_follow_their_slots():
    curve = shape('t -1 1 formulas "t" 0 "t^2"')
    assert np.allclose(curve.points(np.array([-1.0, 0.5])), [(-1, 0, 1), (0.5, 0, 0.25)])


number = st.floats(-1e6, 1e6)


@given(st.floats(1e-3, 1e3), number, st.tuples(number, number, number), st.floats(-7, 7), st.floats(0.01, 20))
def test_numbers_keep_every_digit(radius, rise, centre, start, size):
    scene = Scene((Item("A", Helix(radius, rise, centre, (0, 1, 1), start, start + size)),))
    helix = parse_scene(write_scene(scene)).items[0].shape
    assert (helix.radius, helix.rise, *helix.centre) == (radius, rise, *centre)
    assert np.allclose((helix.start, helix.end), (start, start + size), rtol=4e-16, atol=0.0)


@pytest.mark.slow
@given(st.floats(1e-3, 1e3), st.floats(1e-3, 1e3), st.floats(0, 1))
def test_branches_are_found_again(r, s, part):
    for branch in cylinder_intersection(r, s, part * 0.999 * (r + s)):
        again = parse_scene(write_scene(Scene((Item("A", branch),)))).items[0].shape
        assert again == branch


def test_placed_curves_keep_every_digit():
    forms = np.array([[0.0, 2.0, 0.0], [-1.0, 0.0, 0.5], [0.0, 0.0, 3.0]])
    placed = parse_scene(write_scene(Scene((Item("A", PlacedCurve(Circle(), forms, (0.1, 0.2, 0.3))),)))).items[0].shape
    assert np.array_equal(placed.matrix, forms) and np.array_equal(placed.shift, (0.1, 0.2, 0.3))


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (Scene((Item("A", curve_of_function(lambda t: (t, t, t), 0, 1)),)), "A: .* Python"),
        (Scene((Item("A", Circle(), curves=SurfaceLines(columns=2)),)), "A: .* polyhedra only"),
        (Scene((Item("A", "circle"),)), "A: the scene language has no word for a str"),
    ],
)
def test_what_the_language_lacks_is_refused(scene, message):
    with pytest.raises(InputError, match=message):
        write_scene(scene)


MISTAKES = [
    ("C curve", "curve: expected three formulas in quotes or one of line, circle, helix, .*, got the end"),
    ("C curve helx 1 2", "curve: expected 'helix', got 'helx'"),
    ("C curve wobble", "three formulas in quotes or one of"),
    ("C curve helix 1", "helix: expected 'rise', got the end"),
    ("C curve helix 0 1", "radius must be positive, not 0"),
    ("C curve helix 1 1 arc 90 90", "empty"),
    ("C curve circle axis 0 0 0", "circle: an axis without length"),
    ("C curve line 0 0 0 0 0 0", "a direction without length"),
    ("C curve loxodrome 1", "loxodrome: expected 'course'"),
    ("C curve loxodrome 1 course 180", "alpha must not be 0"),
    ("C curve cylinder_intersection 1", "cylinder_intersection: expected 's'"),
    ("C curve cylinder_intersection 1 1 5", "the cylinders do not meet, or in one point only"),
    ("C curve cylinder_intersection 1 1 2", "the cylinders do not meet, or in one point only"),
    ("C curve cylinder_intersection 1 2 -1", "must not be negative"),
    ("C curve cylinder_intersection 2 1 0 branch 3", "there is no branch 3, there are 2"),
    ("C curve cylinder_intersection 2 2 1 branch 0", "there is no branch 0, there is one"),
    ("C curve cylinder_intersection 2 2 1 branch 1.5", "a whole number for branch"),
    ('C curve "t" "t"', "expected a formula in t in quotes, got the end"),
    ('C curve "t" "t" 0', "curve: expected 't', got the end"),
    ('C curve "t" "u" 0 t 0 1', "unknown name"),
    ('C curve "t" "t" 0 t 1 1', "empty"),
    ('C curve "t" "t" 0 t 0 1e999', "not a finite number"),
    ('C curve "1/0" "t" 0 t 0 1', "no finite point"),
    ('C curve "t" "1/t^9" 0 t -1 1.001', "runs off to infinity"),
    ("C curve circle curve circle", "a second 'curve'"),
    ("C box 1 1 1 curve circle", "is a 'box' already"),
    ("C curve akma 0 0 0, 1 1 1", "curve: expected 'akima', got 'akma'"),
    ("C curve akima", "akima: expected 'points', got the end"),
    ("C curve akima 0 0 0", "takes at least 2 points, not 1"),
    ("C curve akima 0 0 0, 1 1", "expected a number for points, got the end"),
    ("C curve akima 0 0 0, 1 1 nan", "'nan' is not a finite number"),
    ("C curve bspline 0 0 0, 1 1 1 order 3", "takes at least 3 points, not 2"),
    ("C curve bspline 0 0 0, 1 1 1 order 999999999999", "must be a whole number from 2 to 32"),
    ("C curve bspline 0 0 0, 1 1 1 order 2.5", "expected a whole number for order"),
    ("C curve cubic 0 0 0, 1 1 1, 0 1 0 closed tangents 1 0 0 1 0 0", "a closed one has no tangents"),
    ("C curve cubic 0 0 0, 1 1 1 parameters 1, 1", "rise from point to point"),
    ("C curve approximating 0 0 0, 1 1 1, 2 0 0 controls 99999999", "control points, expected 4 to"),
    ("C curve nurbs 0 0 0, 1 1 1 order 2 weights 1, -1", "weights must be positive"),
    ("C curve nurbs 0 0 0, 1 1 1 order 2 weights 1", "1 weights for 2 points"),
    ("C curve nurbs 0 0 0, 1 1 1 order 2 knots 0, 0, 1", "2 points of order 2 need 4 knots, not 3"),
    ("C curve nurbs 0 0 0, 1 1 1 order 2 knots 0, 0, 1, 1 closed", "does not end where it begins"),
    ("C curve circle removed_faces 1", "a curve has no faces"),
    ("C curve circle level_lines 3", "'level_lines' is for surfaces only"),
    ("C curve circle isophotes 3 lit_by 1", "'isophotes' is for surfaces only"),
    ("C curve circle scale 0", "scale: a factor of 0"),
    ("C curve circle scale 1e50 scale 1e50", "beyond the range of numbers"),
]


@pytest.mark.parametrize(("text", "message"), MISTAKES)
def test_mistakes_name_file_line_item_and_cause(text, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_scene("# a comment\n" + text, "knot.scene")
    assert str(caught.value).startswith("knot.scene:2: C: ") and "\n" not in str(caught.value)


def test_curves_have_no_common_part():
    with pytest.raises(InputError, match="C: A is a curve: only solids are intersected"):
        parse_scene("A curve circle B box 1 1 1 C intersection A B")


def test_a_scene_with_curves_is_described():
    *items, whole = describe(parse_scene('A curve circle 2 B curve "t" 0 0 t 0 1 C box 1 1 1 D surface torus'))
    assert items[0] == "A: curve (circle), closed, size 4 x 4 x 0, from -2,-2,0 to 2,2,0"
    assert items[1] == "B: curve, open, size 1 x 0 x 0, from 0,0,0 to 1,0,0"
    assert whole.startswith("4 items, 1 surface, 2 curves, 8 vertices, 12 edges, 6 faces, 0 lights")


@pytest.mark.slow
@pytest.mark.capability("G8.1-cylcyl")
def test_the_curve_of_two_cylinders_is_drawn_on_both():
    scene = parse_scene(
        "R surface cylinder 2 -2 2 lines none occludes no S surface cylinder 1 -3 3 rotation x 90 translation 0.5 0 0 "
        "lines none occludes no A curve cylinder_intersection 2 1 0.5 B curve cylinder_intersection 2 1 0.5 branch 2"
    )
    points = curves_in_space(draw(scene, Camera((5, -9, 4))), kind="curve")
    assert_on_both(points, scene.items[0].shape, scene.items[1].shape, tolerance=1e-12)
