"""Surfaces in scene files: every family, the lines on them, where they stand, and what is said about mistakes."""

from __future__ import annotations

import numpy as np
import pytest
from support.pace import cpu_seconds
from support.sample_surfaces import FAMILIES, same_surface

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.named_shapes import SURFACES
from vectorplot.io.scene_language import parse_scene
from vectorplot.scene.surface_lines import Section
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import ImplicitTorus, Torus


def one(text):
    (item,) = parse_scene(text).items
    return item


def shape(text):
    return one(f"A surface {text}").shape


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize(("text", "wanted"), FAMILIES, ids=lambda value: value if isinstance(value, str) else "")
def test_a_family_is_the_surface_of_that_name(text, wanted):
    assert same_surface(shape(text), wanted)


def test_every_family_is_tried():
    assert {text.split()[0] for text, _ in FAMILIES} == set(SURFACES)


def test_derivatives_of_formulas_are_exact():
    text = '"exp(u)*cos(30*v)" "exp(u)*sin(30*v)" "u^3*v"'
    u, v = np.random.default_rng(2).random((2, 200))
    uu, uv, vv = shape(f"function {text} u 0 1 v 0 1").second_partials(u, v)
    assert np.allclose(uu[:, 0], np.exp(u) * np.cos(30 * v), rtol=1e-13, atol=1e-13)
    assert np.allclose(uv[:, 1], 30 * np.exp(u) * np.cos(30 * v), rtol=1e-12, atol=1e-12)
    assert np.allclose(vv[:, 0], -900 * np.exp(u) * np.cos(30 * v), rtol=1e-12, atol=1e-10)
    assert np.allclose(uu[:, 2], 6 * u * v, rtol=1e-13, atol=1e-13)


def test_words_may_come_in_any_order_and_the_item_goes_on_behind_them():
    text = "A parameter_lines 3 4 blue translation 0 0 1 surface torus minor 1 major 3 metallic B surface sphere"
    a, b = parse_scene(text).items
    assert (a.colour, a.material.word, a.curves.columns, a.curves.rows) == ("blue", "metallic", 3, 4)
    assert same_surface(a.shape, Torus(3.0, 1.0, (0, 0, 1))) and same_surface(b.shape, Sphere())


def test_formulas_may_follow_their_slots():
    assert same_surface(shape('graph x -1 2 y 0 1 formula "x*y"'), shape('graph "x*y" x -1 2 y 0 1'))


def test_names_in_quotes_are_no_slots():
    names = [item.name for item in parse_scene('A surface torus 3 1 "u" surface sphere "a b" box 1 1 1').items]
    assert names == ["A", "u", "a b"]


# --- where it stands ---


@pytest.mark.parametrize("kind", ["surface torus 3 1", "surface implicit_torus 3 1"])
def test_modifiers_act_on_surfaces_as_on_boxes(kind):
    moves = (
        "translation 1 2 3 rotation x 30 scale 1 2 -0.5 rotation z 90 translation -1 0 0 matrix 0 1 0 2 1 0 0 0 0 0 3 1"
    )
    moved = one(f"A box 1 1 1 {moves}").shape.vertices
    corners = one("A box 1 1 1").shape.vertices
    item = one(f"A {kind} {moves}")
    rows = np.linalg.lstsq(np.column_stack([corners, np.ones(8)]), moved, rcond=None)[0]
    if kind.startswith("surface torus"):
        u, v = np.array([0.3, 2.0]), np.array([1.0, 4.0])
        expected = np.column_stack([Torus().points(u, v), [1, 1]]) @ rows
        assert np.allclose(item.shape.points(u, v), expected, atol=1e-12)
    else:
        p = np.array([[1.0, 2.0, 0.3], [3.0, 0.5, 0.0]])
        there = np.column_stack([p, [1, 1]]) @ rows
        assert np.allclose(item.shape.values(there), ImplicitTorus().values(p), rtol=1e-9)


def test_scale_stretches_and_mirrors_polyhedra_too():
    plain, mirrored = one("A box 1 2 3 scale 2").shape, one("A box 1 2 3 scale -1 1 1").shape
    assert np.ptp(plain.vertices, axis=0).tolist() == [2.0, 4.0, 6.0]
    assert mirrored.vertices[:, 0].min() == -1.0
    volume = np.einsum("ij,ij->i", mirrored.area_vectors, mirrored.vertices[mirrored.corners[mirrored.offsets[:-1]]])
    assert volume.sum() > 0.0, "the faces still look outwards"


# --- lines ---


def test_lines_are_what_the_file_asks_for():
    curves = one(
        "A surface sphere 2 translation 0 0 5 parameter_lines 24 12 isophotes 3 level_lines 3 "
        "sections normal 0 3 4 at -1, 2.5 sections x at 0"
    ).curves
    assert (curves.columns, curves.rows, curves.light) == (24, 12, None)
    assert curves.isophotes == (-0.5, 0.0, 0.5)
    level, slanted, across = curves.sections
    assert np.allclose(level.offsets, (4.0, 5.0, 6.0)) and level.normal == (0.0, 0.0, 1.0)
    assert slanted == Section((0.0, 0.6, 0.8), (-1.0, 2.5)) and across.offsets == (0.0,)


def test_sections_are_spread_over_the_extent_along_their_normal():
    section = one("A surface torus 3 1 rotation x 30 translation 7 8 9 sections normal 1 2 3 4").curves.sections[0]
    # The extent of a torus along g: 2 (major sin + minor), sin the sine between g and its axis.
    axis, normal = np.array([0.0, -0.5, np.sqrt(0.75)]), np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    reach = 3.0 * np.sqrt(1.0 - (axis @ normal) ** 2) + 1.0
    wanted = normal @ (7, 8, 9) + reach * np.array([-0.6, -0.2, 0.2, 0.6])
    assert np.allclose(section.offsets, wanted, atol=1e-6)
    box = one("A surface implicit_torus 3 1 level_lines 1").curves.sections[0]
    assert np.allclose(box.offsets, (0.0,), atol=1e-12)


def test_isophotes_know_their_light_by_name_and_by_number_wherever_it_stands():
    a, b, c, d = parse_scene(
        "light SUN direction 0 0 1 A surface torus isophotes 3 lit_by LAMP B surface torus isophotes 3 lit_by 1 "
        "light LAMP position 1 1 1 C surface torus isophotes 3 light 2 position 3 3 3 "
        'D surface torus isophotes 1 lit_by "2"'
    ).items
    assert [item.curves.light for item in (a, b, c, d)] == [1, 0, None, 2]


def test_the_word_lines_chooses_among_the_kinds():
    item = one("A surface torus parameter_lines 2 2 lines contour, parameter, isophote, section")
    assert item.lines == ("contour", "parameter", "isophote", "section")


# --- mistakes ---

MISTAKES = [
    ("R surface tors 3 1", "unknown surface 'tors', expected 'torus'"),
    ("R surface", r"expected the name of a surface \(torus, .*\), got the end"),
    ("R surface torus 3 -1", "minor radius must be positive, not -1"),
    ("R surface torus 3 1 major 2", "a second 'major'"),
    ("R surface torus u 0 500", "'u 0 500' is no part of u 0 to 360 degrees"),
    ("R surface sphere v -100 0", "'v -100 0' is no part of v -90 to 90 degrees"),
    ('R surface graph "sn(x)" x 0 1 y 0 1', r"position 1 of 'sn\(x\)': unknown function \(did you mean 'sin'\)"),
    ('R surface graph "x*q" x 0 1 y 0 1', "position 3 of 'x.q': unknown name"),
    ('R surface graph "z" x 0 1 y 0 1', "unknown name"),
    ("R surface graph x^2 x 0 1 y 0 1", r"expected a formula in x and y in quotes, got 'x\^2'"),
    ('R surface graph "x" x 0 1', "graph: expected 'x' and 'y' with their ranges, or 'disc'"),
    ('R surface graph "x" disc 1 x 0 1', "do not go with 'disc'"),
    ('R surface graph "x" disc 1 hole 2', "a hole of radius 2"),
    ('R surface graph "x" x 1 0 y 0 1', "no domain"),
    ('R surface graph "sqrt(-1-x^2)" x -1 1 y -1 1', "no finite point"),
    ('R surface implicit "sqrt(-1-x^2)" box -1 1 -1 1 -1 1', "no value anywhere in its box"),
    ('R surface implicit "x" box 1 -1 -1 1 -1 1', "a box needs"),
    ('R surface implicit "x"', "implicit: expected 'box', got the end"),
    ('R surface function "u" "v" u 0 1 v 0 1', "expected a formula in u and v in quotes, got 'u'"),
    ('R surface function "u" "v" 0 u 0 1', "function: expected 'v'"),
    ("R surface quadric 1 2 3 box 0 1 0 1 0 1", "expected a number for coefficients, got 'box'"),
    ("R surface quadric 0 0 0 0 0 0 0 0 0 1 box 0 1 0 1 0 1", "no surface"),
    ("R surface cyclide radius 2", "cyclide: expected 'centre'"),
    ("R surface cyclide centre 3 0 1 radius 1", "runs off to infinity"),
    ("R surface cone slope 1 radius 2", "give 'radius' and 'height', or"),
    ("R surface cone depth_slope 1", "'depth_slope' needs 'slope'"),
    ("R surface catenoid width 0", "a width of 0"),
    ("R surface helical 1", "helical: expected 'line' or 'circle' or .* or 'curve'"),
    ("R surface helical circle", "helical: expected 'rise'"),
    ("R surface revolution line 0 0 0 0 0 0", "a direction without length"),
    ("R surface revolution line 1 0 0 1 0 1 circle", "a second generator, 'circle'"),
    ("R surface translation circle path", "path: expected one of line, circle, helix, .*, curve"),
    ("R surface revolution line 1 0 0 1 0 1 angle 90 0", "empty"),
    ("R surface torus major nan", "'nan' is not a finite number"),
    ('R surface torus major "1/0"', '"1/0" is not a finite number'),
    ("R surface torus scale 1e50 scale 1e50", "'scale' goes beyond the range of numbers"),
    ("R surface torus scale 0", "scale: a factor of 0"),
    ("R surface torus matrix 1 0 0 0 0 0 0 0 0 0 0 0", "its determinant is 0"),
    ("R surface torus 3 1 surface sphere", "a second 'surface'"),
    ("R revolution surface torus", "is a 'revolution' already"),
    ("R surface torus removed_faces 1", "a surface has no faces"),
    ("R surface torus parameter_lines 3", "expected a whole number for the rows of parameter_lines"),
    ("R surface torus parameter_lines -1 3", "-1 columns"),
    ("R surface torus isophotes 0", "isophotes: 0 of them"),
    ("R surface torus isophotes 2.5", "expected a whole number for isophotes"),
    ("R surface torus isophotes at 2", "2 is no cosine"),
    ("R surface torus isophotes 5 lit_by SUN", "there is no light 'SUN'"),
    ("R surface torus isophotes 5 lit_by 1", "there is no light '1'"),
    ("R surface torus isophotes 5 lit_by", "expected the name or the number of a light"),
    ("R surface torus sections q 5", "expected x, y, z or 'normal', got 'q'"),
    ("R surface torus sections normal 0 0 0 4", "expected a normal of three finite numbers, not all zero"),
    ("R surface torus sections z at 1,", "expected a number for sections"),
    ('R surface function "u" "v" 0 u 0 1 v 0 1 level_lines 3', "no extent along their normal"),
]


@pytest.mark.parametrize(("text", "message"), MISTAKES)
def test_mistakes_name_file_line_item_and_cause(text, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_scene("# a comment\n" + text, "hill.scene")
    assert str(caught.value).startswith("hill.scene:2: R: ") and "\n" not in str(caught.value)


def test_a_word_that_is_nearly_one_of_a_slot_is_pointed_out():
    with pytest.raises(InputError, match="is 'mjor' meant to be 'major'"):
        parse_scene("R surface torus mjor 3")


def test_polyhedra_have_no_parameter_lines_and_surfaces_no_lines_of_polyhedra_nor_a_common_part():
    with pytest.raises(InputError, match="B: 'parameter_lines' is for surfaces only"):
        parse_scene("B box 1 1 1 parameter_lines 4 4")
    for word in ("smooth_lines", "isophote_edges", "smooth_contours"):
        with pytest.raises(InputError, match=f"B: '{word}' is for polyhedra only"):
            parse_scene(f"B surface torus 3 1 isophotes 4 {word}")
    with pytest.raises(InputError, match="C: A is a surface: only solids are intersected"):
        parse_scene("A surface torus B box 1 1 1 C intersection A B")


@pytest.mark.hard(68)
@pytest.mark.parametrize(
    "text",
    [
        "R surface torus parameter_lines 1000000000 1000000000",
        "R surface torus isophotes 1000000000",
        "R surface torus sections z 1000000000",
        "R surface torus level_lines 9000 level_lines 9000",
        f"R surface torus level_lines at {' , '.join(['0'] * 20_000)}",
        f'R surface graph "{"x+" * 100_000}x" x 0 1 y 0 1',
        f'R surface graph "{"(" * 5000}x{")" * 5000}" x 0 1 y 0 1',
    ],
    ids=["grid", "isophotes", "sections", "levels", "list", "long", "deep"],
)
def test_wild_counts_are_refused_at_once(text):
    with cpu_seconds(2.0), pytest.raises(InputError):
        parse_scene(text)


@pytest.mark.hard(69)
def test_where_a_formula_has_no_value_there_is_a_hole():
    roof = shape('graph "sqrt(1 - x^2)*log(y)" x -2 2 y -1 1')
    points = roof.points(np.array([0.5, 1.5, 0.5]), np.array([0.5, 0.5, -0.5]))
    assert np.isfinite(points[0]).all() and np.isnan(points[1:]).all()


@pytest.mark.hard(70)
@pytest.mark.parametrize(
    "formula",
    [
        "__import__('os').system('touch owned')",
        "().__class__.__bases__",
        "x.__class__",
        "eval(x)",
        "open(x)",
        "lambda: x",
        "[x for x in y]",
        "x if y else z",
        "x; y",
        "x := 3",
        "exec",
    ],
)
def test_formulas_are_read_and_never_run_as_code(formula, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for text in (f'R surface graph "{formula}" x 0 1 y 0 1', f'R surface torus major "{formula}"'):
        with pytest.raises(InputError, match="R: position"):
            parse_scene(text)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_scene_without_surfaces_does_not_load_them():
    import subprocess
    import sys

    code = (
        "import sys; from vectorplot.io.scene_language import parse_scene; parse_scene('A box 1 1 1');"
        "assert 'vectorplot.io.scenes.scene_families' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=600)


def test_surfaces_are_no_meshes():
    assert not isinstance(shape("torus"), Mesh)
