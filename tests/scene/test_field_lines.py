"""Fields of meshes as lines: contours, streamlines, arrows."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError, InputWarning
from vectorplot.features import VectorField
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import FieldContours, FieldLines, Fields, NamedVectors, field_arrows

SIDE = 21
X, Y = (grid.ravel() for grid in np.meshgrid(np.linspace(-2, 2, SIDE), np.linspace(-2, 2, SIDE), indexing="ij"))
PLACE = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
QUADS = np.stack([PLACE[:-1, :-1], PLACE[1:, :-1], PLACE[1:, 1:], PLACE[:-1, 1:]], axis=-1).reshape(-1, 4)
SHEET = vp.Mesh.from_polygons(np.stack([X, Y, 0 * X], axis=1).tolist(), QUADS.tolist())
FIELDS = Fields.of(
    SHEET,
    {"height": 3.0 * X + Y, "round": np.stack([-Y, X, 0 * X], axis=1), "hole": np.where(X > 1.5, np.nan, X)},
    {"of_faces": np.arange(len(QUADS))},
)


def drawn(curves: vp.SurfaceLines, kind: str, item: str = "SHEET"):
    """The points in space of the strokes of a kind, stroke by stroke."""
    scene = vp.Scene((vp.Item(item, SHEET, fields=FIELDS, curves=curves),))
    drawing = vp.draw(scene, "top", lines=kind, curves="polyline")
    return [
        paths.points3d[begin:end]
        for layer in drawing.layers
        for paths in layer.strokes
        for begin, end in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)
    ]


def test_contours_have_the_value_of_the_field() -> None:
    strokes = drawn(vp.SurfaceLines(contours=(FieldContours("height", (-1.25, 0.4)),)), "section")
    values = sorted(float((3.0 * stroke[:, 0] + stroke[:, 1]).mean()) for stroke in strokes)
    assert values == pytest.approx([-1.25, 0.4])
    for stroke in strokes:
        assert np.ptp(3.0 * stroke[:, 0] + stroke[:, 1]) < 1e-9
        # From one border of the sheet to the other.
        assert np.ptp(stroke[:, 1]) == pytest.approx(4.0)


def test_a_number_of_contours_is_round_ones_and_there_is_none_without_numbers() -> None:
    strokes = drawn(vp.SurfaceLines(contours=(FieldContours("height", 8),)), "section")
    levels = {round(float((3.0 * one[:, 0] + one[:, 1]).mean()), 9) for one in strokes}
    assert levels == {-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0}
    (line,) = drawn(vp.SurfaceLines(contours=(FieldContours("hole", (1.0,)),)), "section")
    assert np.ptp(line[:, 1]) == pytest.approx(4.0)
    assert not drawn(vp.SurfaceLines(contours=(FieldContours("hole", (1.7,)),)), "section")


def test_streamlines_follow_the_vectors_of_a_field() -> None:
    lines = FieldLines(VectorField(NamedVectors("round")), through=((1.0, 0.0, 0.0),), length=3.0)
    (stroke,) = drawn(vp.SurfaceLines(integral=(lines,)), "integral")
    # Vectors (-y, x) lead round the origin, but for what one direction in every face is off.
    assert np.abs(np.hypot(stroke[:, 0], stroke[:, 1]) - 1.0).max() < 0.12
    way = np.diff(stroke, axis=0)
    assert (stroke[:-1, 0] * way[:, 1] - stroke[:-1, 1] * way[:, 0] > 0.0).mean() > 0.99


def test_arrows_are_as_long_as_their_vectors_and_apart() -> None:
    arrows = field_arrows(vp.Item("SHEET", SHEET, fields=FIELDS), "round", apart=0.5, longest=0.4)
    ends = [(item.shape.points(np.array(0.0)), item.shape.points(np.array(item.shape.end))) for item in arrows.items]
    start = np.array([one for one, _ in ends])
    way = np.array([other - one for one, other in ends])
    expected = np.stack([-start[:, 1], start[:, 0], 0 * start[:, 0]], axis=1) * 0.4 / np.sqrt(8.0)
    np.testing.assert_allclose(way, expected, atol=1e-12)
    assert 60 <= len(ends) <= 81 and len(arrows.labels) == len(ends)
    assert len({tuple(np.floor(one / 0.5 + 1e-9).tolist()) for one in start + np.array((2.0, 2.0, 0.0))}) == len(ends)
    drawing = vp.draw([vp.Item("SHEET", SHEET), arrows], "top")
    assert sum(len(layer.strokes[0]) for layer in drawing.layers if layer.name == "label") >= len(ends)


@pytest.mark.parametrize("text", ["contours heat 12", "contours heat at 1, 2.5", "field_lines wind apart 0.5"])
def test_their_words_are_written_as_they_are_read(text: str) -> None:
    scene = parse_scene(f"BOX gray box 1 2 3 {text}")
    curves = scene.items[0].curves
    assert curves and parse_scene(write_scene(scene)).items[0].curves == curves


@pytest.mark.parametrize(
    ("curves", "told"),
    [
        (vp.SurfaceLines(contours=(FieldContours("hieght"),)), "SHEET: contours: .*height"),
        (vp.SurfaceLines(contours=(FieldContours("of_faces"),)), "at the vertices"),
        (vp.SurfaceLines(integral=(FieldLines(VectorField(NamedVectors("rnd"))),)), "round"),
    ],
)
def test_unknown_fields_are_told(curves: vp.SurfaceLines, told: str) -> None:
    with pytest.raises(InputError, match=told):
        drawn(curves, "section,integral")


@pytest.mark.parametrize("values", [0, (), (np.nan,), 10**5])
def test_what_are_no_values_is_told(values) -> None:
    with pytest.raises(InputError):
        FieldContours("height", values)


def test_items_without_fields_have_no_arrows() -> None:
    with pytest.raises(InputError, match="the item has none"):
        field_arrows(vp.Item("SHEET", SHEET), "round")
    with pytest.raises(InputError, match="positive lengths"):
        field_arrows(vp.Item("S", SHEET, fields=FIELDS), "round", apart=-1.0)


@pytest.mark.parametrize("way", ['"1/0" 0 0', "0 0 0"])
def test_a_field_without_vectors_has_no_arrows_and_says_so(way) -> None:
    with pytest.warns(InputWarning, match="A: no arrows of field"):
        scene = parse_scene(f"A box 1 1 1\nfield_arrows of A {way}")
    assert [item.name for item in scene.items] == ["A"]


def test_arrows_of_formulas_stand_on_a_surface_wherever_it_is_and_as_the_function_says() -> None:
    text = 'field_arrows of BALL "-y" "x" 0 apart 0.5 longest 0.3\nBALL surface sphere 2'
    scene = parse_scene(text)
    same = field_arrows(scene.items[0], lambda points: np.cross((0.0, 0.0, 1.0), points), apart=0.5, longest=0.3)
    starts = []
    for one, other in zip(scene.items[1:], same.items, strict=True):
        ends = [line.shape.points(np.array([0.0, line.shape.end])) for line in (one, other)]
        np.testing.assert_allclose(ends[0], ends[1], atol=1e-12)
        starts.append(ends[0][0])
        np.testing.assert_allclose(np.diff(ends[0], axis=0)[0], np.cross((0, 0, 0.15), ends[0][0]), atol=2e-4)
    np.testing.assert_allclose(np.linalg.norm(starts, axis=1), 2.0)
    again = parse_scene(write_scene(scene))
    assert len(again.items) == len(scene.items) and len(again.labels) == len(scene.labels)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("field_arrows of B wind", "item 'B': expected one of A"),
        ("field_arrows A", "expected 'of'"),
        ("field_arrows of A wind", "no field 'wind'"),
        ('field_arrows of A "x" "y"', "a formula in x"),
        ("field_arrows of A 1 0 0 apart -1", "positive lengths"),
        ("field_arrows of A 1 0 0 appart 1", "did you mean 'apart'"),
        ("field_arrows of A 1 0 0 apart 0.001", "larger 'apart'"),
        ('C surface implicit "x+y+z" box -1 1 -1 1 -1 1 field_arrows of C 1 0 0', "parametrised surfaces"),
    ],
)
def test_arrows_that_cannot_be_are_told_with_their_line(text: str, told: str) -> None:
    with pytest.raises(InputError, match=f"^<text>:2: .*{told}"):
        parse_scene(f"A surface sphere 1\n{text}")


def test_functions_that_give_no_vectors_are_told() -> None:
    with pytest.raises(InputError, match="a field of vectors gives"):
        field_arrows(vp.Item("SHEET", SHEET), lambda points: points[:, 0])
