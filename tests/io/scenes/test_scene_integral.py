"""Words for integral curves: read, written, drawn where they are seen, and told when they are wrong."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features, geometry, surfaces
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import FieldLines, GeodesicLines, GeodesicsBetween, ShortestPaths
from vectorplot.testing import assert_drawing_is_right, assert_integral_curve, curves_in_space

WORDS = {
    "loxodromes 45 through 0 0": (FieldLines(features.loxodromes(np.pi / 4), None, ((0.0, 0.0),)),),
    "loxodromes 30 v apart 0.5": (FieldLines(features.loxodromes(np.pi / 6, "v"), 0.5),),
    "slope_lines": (FieldLines(features.SteepestSlope()),),
    "helices 10": tuple(FieldLines(features.ConstantElevation(np.radians(10), side)) for side in (1, -1)),
    "helices 10 right": (FieldLines(features.ConstantElevation(np.radians(10), -1)),),
    "curvature_lines": tuple(FieldLines(features.PrincipalDirections(k)) for k in (1, 2)),
    'asymptotic_lines 2 through 0 "pi" , 1 2': (
        FieldLines(features.AsymptoticDirections(2), None, ((0.0, np.pi), (1.0, 2.0))),
    ),
    "slope_lines through 0 1 length 4": (FieldLines(features.SteepestSlope(), None, ((0.0, 1.0),), 4.0),),
    "geodesics 0 1 90 , 2 1 0 length 3": (GeodesicLines(((0.0, 1.0, np.pi / 2), (2.0, 1.0, 0.0)), 3.0),),
    "geodesics between 0 0 1 0.5": (GeodesicsBetween(((0.0, 0.0, 1.0, 0.5),)),),
    "geodesics between 0 0 1 0.5 , 2 0 3 1 count 3 length 9": (
        GeodesicsBetween(((0.0, 0.0, 1.0, 0.5), (2.0, 0.0, 3.0, 1.0)), 3, 9.0),
    ),
}


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize("words", WORDS)
def test_files_say_it_and_write_it_again(words):
    scene = parse_scene(f"RING blue surface torus 3 1 {words} scale 2")
    assert scene.items[0].curves.integral == WORDS[words]
    assert parse_scene(write_scene(scene)).items[0].curves.integral == WORDS[words]


MESH_WORDS = {
    "loxodromes 30": (FieldLines(features.TurnedField(features.SteepestSlope(), np.pi / 6)),),
    "loxodromes 30 slope apart 0.5": (FieldLines(features.TurnedField(features.SteepestSlope(), np.pi / 6), 0.5),),
    "helices 10 right through 1 0 0 , 0 1 0.5": (
        FieldLines(features.ConstantElevation(np.radians(10), -1), None, ((1.0, 0.0, 0.0), (0.0, 1.0, 0.5))),
    ),
    "slope_lines through 0 0 1 length 0.5": (FieldLines(features.SteepestSlope(), None, ((0.0, 0.0, 1.0),), 0.5),),
    "slope_lines apart 0.3": (FieldLines(features.SteepestSlope(), 0.3),),
    "geodesics 1 0 0 0 1 1 , 0 -1 0.5 1 0 0 length 3": (
        GeodesicLines(((1.0, 0.0, 0.0, 0.0, 1.0, 1.0), (0.0, -1.0, 0.5, 1.0, 0.0, 0.0)), 3.0),
    ),
    "shortest_paths 0 0 0 to 2 2 2.0 , 1 0 0 to 1 2 2": (ShortestPaths(((0, 0, 0, 2, 2, 2), (1, 0, 0, 1, 2, 2))),),
}


@pytest.mark.capability("G3.0-language", "G9.4-polyhedron")
@pytest.mark.parametrize("words", MESH_WORDS)
@pytest.mark.parametrize(
    "order", ["A box 2 2 2 {}", "A {} translation base_points 0 0 0 , 1 0 0 , 0 1 0 trans_vector 0 0 1"]
)
def test_files_say_it_of_polyhedra_in_any_order_of_words(words, order):
    scene = parse_scene(order.format(words) + "\nB surface torus 3 1 slope_lines through 0 1")
    assert scene.items[0].curves.integral == MESH_WORDS[words]
    assert scene.items[1].curves.integral == (FieldLines(features.SteepestSlope(), None, ((0.0, 1.0),)),)
    assert parse_scene(write_scene(scene)).items[0].curves.integral == MESH_WORDS[words]


@pytest.mark.capability("G3.0-language")
def test_field_lines_of_formulas_are_drawn_and_written():
    scene = parse_scene('BALL blue surface sphere 2 field_lines "-y" "x" 0 through 0 0.5 translation 0 0 3')
    assert write_scene(parse_scene(write_scene(scene))) == write_scene(scene)
    drawing = vp.draw(scene, lines="integral", hidden="solid")
    found = np.concatenate(curves_in_space(drawing, kind="integral"))
    # Round the axis of the world, on a ball beside it.
    assert np.ptp(np.linalg.norm(found[:, :2], axis=1)) < 0.02 and np.ptp(found[:, 2]) < 0.02


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("box 1 1 1 curvature_lines 0", "family 0, expected 1 or 2"),
        ("box 1 1 1 loxodromes 30 u", "polyhedra have no lines u = const"),
        ("box 1 1 1 slope_lines through 1 2", "a point of slope_lines"),
        ("box 1 1 1 geodesics 0 0 0", "a point of geodesics"),
        ("box 1 1 1 shortest_paths 0 0 0 1 1 1", "shortest_paths: expected 'to' and a point"),
        ("surface torus 3 1 shortest_paths 0 0 0 to 1 1 1", "'shortest_paths' is for polyhedra only"),
        ("surface implicit_torus 3 1 slope_lines", "with parameters u and v only"),
        ("curve circle 1 slope_lines", "'slope_lines' is for surfaces only"),
        ("surface torus 3 1 helices 90", "elevation 90, expected less than 90 degrees"),
        ("surface torus 3 1 helices", "expected a number for the elevation of helices"),
        ("surface torus 3 1 curvature_lines 3", "family 3, expected 1 or 2"),
        ("surface torus 3 1 slope_lines apart 0", "distance"),
        ("surface torus 3 1 slope_lines through 1", "a point of slope_lines"),
        ("surface torus 3 1 geodesics 0 0", "a point of geodesics"),
        ("surface torus 3 1 geodesics 0 0 0 length -1", "length"),
        ("box 1 1 1 geodesics between 0 0 1 1", "for surfaces with parameters u and v only"),
        ("surface torus 3 1 geodesics between 0 0 1", "a point of geodesics between places"),
        ("surface torus 3 1 geodesics between 0 0 1 1 count 0", "expected 1 to 100"),
        ("surface torus 3 1 geodesics between 0 0 1 1 length 0", "length"),
        ('surface torus 3 1 field_lines "x" "y"', "formula"),
    ],
)
def test_mistakes_about_them_are_told(words, cause):
    with pytest.raises(InputError, match=cause):
        parse_scene(f"A {words}")


@pytest.mark.parametrize("body", ["surface cone slope 1 top 3", "vertices 0 0 0, 6 0 6, 6 9 6, 0 9 0 faces 1 2 3 4"])
def test_lines_through_places_are_no_longer_than_they_are_to_be(body):
    place = "0 2" if "surface" in body else "3 4 3"
    scene = parse_scene(f"A {body} slope_lines through {place} length 1.25")
    parts = curves_in_space(vp.draw(scene, lines="integral", hidden="solid"), kind="integral")
    assert np.isclose(sum(np.linalg.norm(np.diff(part, axis=0), axis=1).sum() for part in parts), 2.5)
    with pytest.raises(InputError, match="a length is for lines through given points"):
        FieldLines(features.SteepestSlope(), 0.5, length=3.0)


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("sphere curvature_lines", "B: no lines of curvature: it is flat, or round as a ball"),
        ("sphere asymptotic_lines 1", "B: no asymptotic lines: it is nowhere saddle-shaped"),
        ("sphere slope_lines through 0 99", "B: no slope lines: it is level, or these places lie beyond the surface"),
        ("sphere geodesics 0 99 0", "B: no geodesics from these places"),
        ('graph "0*x" x -1 1 y -1 1 helices 20', "B: no lines of a field: it has no direction there"),
    ],
)
def test_smooth_surfaces_without_such_lines_are_told(words, cause):
    with pytest.warns(InputWarning, match=cause):
        vp.draw(parse_scene(f"B surface {words}"))


@pytest.mark.capability("G9.4-polyhedron")
def test_points_of_the_wrong_sort_of_shape_are_told_with_the_items_name():
    box, ball = geometry.box((2, 2, 2)), surfaces.Sphere()
    flat, deep = (FieldLines(features.SteepestSlope(), None, (row,)) for row in ((0.0, 1.0), (0.0, 1.0, 1.0)))
    for shape, lines, cause in (
        (box, flat, "A: field lines: expected points x y z on a polyhedron, 3 numbers each, got 2"),
        (ball, deep, "A: field lines: expected points u v on a surface, 2 numbers each, got 3"),
        (box, GeodesicLines(((0.0, 1.0, 0.0),)), "A: geodesics: expected points x y z on a polyhedron, 6 numbers"),
        (ball, GeodesicLines(((0.0,) * 5 + (1.0,),)), "A: geodesics: expected points u v on a surface, 3 numbers"),
        (ball, ShortestPaths(((0.0,) * 5 + (1.0,),)), "A: shortest paths are for polyhedra only"),
        (box, FieldLines(features.loxodromes(1.0)), "A: parameter lines: only surfaces with parameters"),
        (box, GeodesicLines(((1.0, 1.0, 3.0, 0.0, 0.0, 1.0),)), "A: geodesics: direction 1 has no length in its face"),
    ):
        with pytest.raises(InputError, match=cause):
            vp.draw(vp.Scene((vp.Item("A", shape, curves=vp.SurfaceLines(integral=(lines,))),)))


@pytest.mark.capability("G9.4-polyhedron")
def test_points_and_directions_on_polyhedra_move_with_them():
    lines = (
        FieldLines(features.SteepestSlope(), None, ((1.0, 0.0, 0.5),), 0.25),
        GeodesicLines(((1.0, 0.0, 0.5, 0.0, 1.0, 0.0),), 3.0),
        FieldLines(features.SteepestSlope(), 0.5, ((1.0, 0.5),)),
        ShortestPaths(((0.0, 0.0, 0.0, 1.0, 2.0, 2.0),)),
    )
    item = vp.Item("A", geometry.box((2, 2, 2)), curves=vp.SurfaceLines(integral=lines))
    matrix = np.array([(0.0, -2.0, 0.0, 1.0), (2.0, 0.0, 0.0, 2.0), (0.0, 0.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0)])
    slope, way, flat, short = item.transformed(matrix).curves.integral
    assert np.allclose(short.ends, [(1.0, 2.0, 3.0, -3.0, 4.0, 7.0)])
    assert np.allclose(slope.through, [(1.0, 4.0, 4.0)]) and slope.apart is None and np.isclose(slope.length, 0.5)
    assert np.allclose(way.starts, [(1.0, 4.0, 4.0, -2.0, 0.0, 0.0)]) and np.isclose(way.length, 6.0)
    assert flat.through == ((1.0, 0.5),) and np.isclose(flat.apart, 1.0)


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
def test_they_are_hidden_on_polyhedra_as_rays_say_and_every_verb_shows_them():
    scene = parse_scene(
        "camera eye 8 5 6 target 0 0 0 A gray box 2 2 2 slope_lines apart 0.6 geodesics 2 1 1 0 1 0.7 length 8"
        " shortest_paths 0 0 1 to 2 2 1.5\n"
        "B gray revolution hollow meridian 0.7 0 2 , 1.5 0 1 , 1.6 0 0 , 1 0 -1 order 12 loxodromes 70 apart 0.6"
        " translation 0 2 0"
    )
    drawing = vp.draw(scene, hidden="solid")
    assert_drawing_is_right(drawing, scene, scene.camera, samples=30)
    field = features.TurnedField(features.SteepestSlope(), np.radians(70))
    alone = vp.draw(vp.Scene(scene.items[1:]), scene.camera, hidden="solid", lines="integral")
    assert_integral_curve(curves_in_space(alone, kind="integral"), scene.items[1].shape, field, 1e-6)
    assert curves_in_space(vp.paint(scene, lines="integral"), kind="integral")
    lined, plain = (vp.render(scene, lines=lines, size=(60, 40)).pixels for lines in ("integral", "none"))
    assert (lined != plain).any()


@pytest.mark.slow
@pytest.mark.capability("G9.4-loxodrome")
def test_they_are_hidden_as_rays_say_and_follow_their_field():
    scene = parse_scene(
        "camera eye 8 5 6 target 0 0 0 RING blue surface torus 3 1 loxodromes 60 through 0 0 geodesics 0 1 40 length 12"
    )
    drawing = vp.draw(scene, hidden="solid")
    assert_drawing_is_right(drawing, scene, scene.camera, samples=30)
    alone = parse_scene("B surface torus 3 1 loxodromes 60 through 0 0")
    lines = curves_in_space(vp.draw(alone, hidden="solid"), kind="integral")
    long = [line for line in lines if len(line) > 5]
    assert_integral_curve(long, scene.items[0].shape, features.loxodromes(np.radians(60)), 0.05)


def test_lines_too_close_together_are_told_with_the_items_name():
    with pytest.raises(InputError, match="RING: evenly spaced curves"):
        vp.draw(parse_scene("RING surface torus 3 1 slope_lines apart 0.0001"))
