"""Colours by numbers, their bar, and boxes with ticks."""

from __future__ import annotations

import io
import subprocess
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import shapely
from PIL import Image
from scipy import ndimage

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.drawing import typeset
from vectorplot.effects.colour_maps import (
    COLOUR_MAPS,
    AxisNumbers,
    axis_numbers,
    coloured,
    logarithmic_numbers,
    map_colours,
    scaled,
    with_box,
)
from vectorplot.errors import InputError
from vectorplot.geometry import box as solid_box
from vectorplot.geometry import ragged
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.save import write
from vectorplot.scene import BoxAxes, Colouring, FieldContours, Fields, terrain_scene
from vectorplot.scene.labels import capital_height
from vectorplot.scene.page import in_latex
from vectorplot.surfaces import Sphere, Torus

CUBE = vp.Scene((vp.Item("CUBE", solid_box((2.0, 2.0, 2.0))),))
SQUARE = vp.Scene(
    (vp.Item("S", vp.Mesh.from_polygons([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], [(0, 1, 2, 3)])),)
)
VIEWS = [(9.0, -7.0, 5.0), (-9.0, 7.0, 5.0), (3.0, 8.0, -6.0), (-4.0, -9.0, -5.0)]


@pytest.mark.parametrize("name", COLOUR_MAPS)
def test_maps_run_from_their_first_colour_to_their_last(name):
    colours = map_colours(name, 9)
    assert len(colours) == 9
    assert (colours[0], colours[-1]) == (COLOUR_MAPS[name][0], COLOUR_MAPS[name][-1])


def test_an_unknown_map_gets_its_nearest():
    with pytest.raises(InputError, match="viridis"):
        map_colours("virdis", 4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("by", "low", "high"),
    [("z", -1.0, 1.0), ("height", -1.0, 1.0), ("x*x", 0.0, 1.0), ("slope", 0.0, 90.0), (lambda p: p[:, 1], -1.0, 1.0)],
    ids=["z", "height", "formula", "slope", "function"],
)
def test_the_bar_has_the_numbers_of_the_scene(by, low, high):
    scene, bar = coloured(vp.Scene((vp.Item("BALL", Sphere()),)), Colouring(by, steps=6))
    assert bar.low == pytest.approx(low, abs=0.02 * (high - low))
    assert bar.high == pytest.approx(high, abs=0.02 * (high - low))
    assert [item.colour for item in scene.items] == list(bar.colours)


@pytest.mark.slow
def test_mean_curvature_of_a_ball_is_one_over_its_radius():
    scene, bar = coloured(vp.Scene((vp.Item("BALL", Sphere(2.0)),)), Colouring("curvature", steps=2))
    assert len(scene.items) <= 2
    assert 0.4 < bar.low <= bar.high < 0.6


@pytest.mark.parametrize("word", ["wrong", "x*", "q + z"])
def test_what_is_no_number_is_said_in_one_line(word):
    with pytest.raises(InputError, match="CUBE: colouring by"):
        coloured(CUBE, Colouring(word))


@pytest.mark.parametrize("eye", VIEWS, ids=str)
def test_the_grids_of_a_box_are_on_the_far_sides(eye):
    camera = vp.Camera(eye)
    boxed, reach = with_box(vp.Scene(CUBE.items, box=BoxAxes()), camera)
    low, high = CUBE.bounds
    far = np.where(np.array(eye) >= 0.5 * (low + high), low, high)
    lines = [item.shape for item in boxed.items[1:]]
    assert lines
    for line in lines:
        ends = line.points(np.array([line.start, line.end]))
        assert (np.abs(ends - far).max(axis=0) < 1e-9).any()
    assert [label.text for label in boxed.labels if label.text in "xyz"] == ["x", "y", "z"]
    assert np.allclose(reach[:8].min(axis=0), low) and np.allclose(reach[:8].max(axis=0), high)


@pytest.mark.parametrize("names", [("x", "y", "z"), ("Länge in m", "Breite in m", "Höhe in m")], ids=["x", "Länge"])
@pytest.mark.parametrize("eye", VIEWS, ids=str)
def test_numbers_of_a_box_stand_outside_of_its_picture_and_on_the_page(eye, names):
    page = vp.Page(100, 90, 5)
    drawing = vp.draw(vp.Scene(CUBE.items, box=BoxAxes(names)), vp.Camera(eye), page=page, text="real")
    outline, rooms = _outline(drawing, CUBE.bounds), _rooms(drawing)
    assert {*names, "0.5", "1", "1.5"} <= rooms.keys()
    inside = shapely.box(4.99, 4.99, 95.01, 85.01)
    for text, room in rooms.items():
        assert shapely.distance(outline, room) > 1.0, text
        assert inside.contains(room), text
        # Numbers are beside the edges they belong to, names beyond them.
        assert shapely.distance(outline, room) < (25.0 if text in names else 3.5), text
    assert not any(one.intersects(other) for one, other in combinations(rooms.values(), 2))


@pytest.mark.slow
def test_edges_of_a_box_are_whole_beside_wide_numbers():
    saddle = vp.graph(lambda x, y: x * y, (-1.5, 1.5), (-1.5, 1.5))
    bare, numbered = (
        vp.draw(vp.Scene((saddle,), box=BoxAxes(size_mm=size)), vp.Camera((8, -10, 6)), page="A5", lines="curve")
        for size in (0.5, 3.5)
    )
    long = [
        sum(np.hypot(*np.diff(paths.points, axis=0).T).sum() for paths in drawing.layers[-2].strokes)
        for drawing in (bare, numbered)
    ]
    assert bare.layers[-2].name == numbered.layers[-2].name
    scales = [float(np.linalg.norm(drawing.page_from_world[0, :3])) for drawing in (bare, numbered)]
    assert long[0] / scales[0] == pytest.approx(long[1] / scales[1], rel=1e-6)


@pytest.mark.parametrize(
    ("low", "high", "texts", "common"),
    [
        (0.0, 1.0, ("0", "0.2", "0.4", "0.6", "0.8", "1"), ""),
        (0.0, 5e4, ("0", "10000", "20000", "30000", "40000", "50000"), ""),
        (2_600_000.0, 2_600_975.0, ("0", "200", "400", "600", "800"), "+ 2600000"),
        (-1_200_725.0, -1_200_000.0, ("-600", "-400", "-200", "0"), "− 1200000"),
        (0.0, 1e-6, ("0", "0.2", "0.4", "0.6", "0.8", "1"), "× 10⁻⁶"),
        (1e-3 - 2.5e-7, 1e-3 + 2.5e-7, ("-2", "-1", "0", "1", "2"), "× 10⁻⁷ + 0.001"),
        (0.0, 4e6, ("0", "1", "2", "3", "4"), "× 10⁶"),
        (1990.0, 2010.0, ("1990", "1995", "2000", "2005", "2010"), ""),
        (7.0, 7.0, ("7",), ""),
    ],
)
def test_numbers_that_would_be_long_say_once_what_they_have_in_common(low, high, texts, common):
    found = axis_numbers(low, high)
    assert (found.texts, found.common) == (texts, common)
    assert np.all(np.diff(found.values) > 0.0) and low <= found.values[0] and found.values[-1] <= high


@pytest.mark.slow
@pytest.mark.parametrize(
    ("surface", "said"),
    [
        (vp.graph(lambda x, y: 7 + 0 * x, (0, 1), (0, 1)), {"x", "y", "z", "7", "0", "0.2", "0.4", "0.6", "0.8", "1"}),
        (
            vp.graph(lambda x, y: x * y, (0, 1e-6), (0, 5e4)),
            {"x", "y", "z", "0", "10000", "20000", "30000", "40000", "50000"},
        ),
    ],
    ids=["constant", "thin"],
)
def test_a_box_has_no_numbers_that_the_scene_does_not_have(surface, said):
    drawing = vp.draw(vp.Scene((surface,), box=BoxAxes()), "iso", page="A6", text="real")
    assert set(_rooms(drawing)) <= said and ("7" in _rooms(drawing)) == ("7" in said)


@pytest.mark.parametrize(("view", "names"), [("front", "xz"), ("top", "xy"), ("right", "yz")])
def test_axes_of_a_box_that_are_seen_end_on_have_no_numbers(view, names):
    drawing = vp.draw(vp.Scene(CUBE.items, box=BoxAxes()), view, page="A6", text="real")
    assert {text for text in _rooms(drawing) if text in "xyz"} == set(names)
    left, bottom, *_ = _outline(drawing, CUBE.bounds).bounds
    assert all(room.bounds[2] < left or room.bounds[3] < bottom for room in _rooms(drawing).values())


def _outline(drawing, bounds):
    """The outline of a box on the page."""
    corners = np.where(np.array(list(np.ndindex(2, 2, 2)), dtype=bool), *bounds[::-1])
    image = np.column_stack([corners, np.ones(8)]) @ drawing.page_from_world.T
    return shapely.MultiPoint(image[:, :2] / image[:, 3:]).convex_hull


def _rooms(drawing):
    """The room of each text on a page; of several that say the same that of the last one."""
    found = {}
    for texts in (texts for layer in drawing.layers for texts in layer.texts):
        for k, text in enumerate(texts.strings):
            left = texts.points[k] - (texts.anchor[k] * texts.room_mm[k], 0.0)
            low, high = typeset(text, left, size_mm=texts.size_mm[k]).bounds
            found[text] = shapely.box(*low, *high)
    return found


@pytest.mark.slow
def test_all_verbs_have_bar_and_box():
    scene = vp.Scene(CUBE.items, colouring=Colouring("z", steps=4), box=BoxAxes())
    page = vp.Page(100, 80, 5)
    for drawing in (vp.draw(scene, page=page), vp.paint(scene, page=page)):
        assert (drawing.width_mm, drawing.height_mm) == (100, 80)
        assert drawing.layers[-1].name == "colour bar"
        assert any(len(paths) for layer in drawing.layers[:-1] for paths in layer.strokes)
    image = vp.render(scene, size=(160, 120), samples=1)
    assert image.pixels.shape == (120, 160, 3)
    assert len(np.unique(image.pixels[:, 130:].reshape(-1, 3), axis=0)) > 4


def test_scene_files_have_words_for_both():
    text = 'colour_by "x - z" map heat steps 7 called "T" box_axes names "a" "b" "c" size 2\nC box 1 1 1\n'
    scene = parse_scene(text)
    assert scene.colouring == Colouring("x - z", "heat", 7, "T")
    assert scene.box == BoxAxes(("a", "b", "c"), 2.0)
    again = parse_scene(write_scene(scene))
    assert (again.colouring, again.box) == (scene.colouring, scene.box)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("colour_by", "expected a word or a formula"),
        ("colour_by z steps 1", "expected 2 to 100"),
        ("colour_by z called T", "expected a text in quotes"),
        ('box_axes names "a" "b" C box 1 1 1', "expected three names"),
        ("box_axes size -1", "a positive number of mm"),
    ],
)
def test_mistakes_are_told_with_their_line(text, said):
    with pytest.raises(InputError, match=said) as error:
        parse_scene(text)
    assert error.value.line == 1


def test_cuts_come_before_bands_and_boxes():
    scene = vp.cut(CUBE, "x < 0.5")
    from_where = vp.Camera(eye=VIEWS[0], target=(0.0, 0.0, 0.0))
    for asked in (replace(scene, colouring=Colouring("z")), replace(scene, box=BoxAxes())):
        chart = scaled(asked, from_where).scene
        assert not chart.cuts
        faces = [item for item in chart.items if item.is_cut_face]
        assert len(faces) == 1 and faces[0].name == "CUBE cut"
        assert np.ptp(faces[0].shape.vertices[:, 0]) == 0.0


def test_numbers_that_are_next_to_nothing_have_a_bar_too():
    scene = replace(CUBE, colouring=Colouring("1e-320*x"), box=BoxAxes())
    assert vp.draw(scene, camera="iso").layers[-1].name == "colour bar"


@pytest.mark.parametrize("by", ["x*y", "z*z", lambda points: np.cos(3.0 * points[:, 0]) * points[:, 1]])
def test_formulas_that_are_not_linear_divide_the_faces_of_a_box(by):
    scene, bar = coloured(CUBE, Colouring(by, steps=12))
    numbers = by if callable(by) else lambda points: eval(by, dict(zip("xyz", points.T, strict=True)))
    step = (bar.high - bar.low) / 12
    for item in scene.items:
        band = bar.colours.index(item.colour)
        fans, _ = ragged.fans(item.mesh.offsets)
        middle = numbers(item.mesh.vertices[item.mesh.corners[fans]].mean(axis=1)) - bar.low
        assert (middle > (band - 0.5) * step).all() and (middle < (band + 1.5) * step).all()


def test_a_number_that_is_the_same_everywhere_divides_nothing():
    scene, _ = coloured(CUBE, Colouring("0.1+0*x"))
    assert sum(item.mesh.face_count for item in scene.items) == 12


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_pens_of_an_item_are_those_of_its_bands(verb):
    scene = replace(CUBE, colouring=Colouring("z", steps=4))
    name = CUBE.items[0].name
    drawing = verb(scene, lines="contour", pens=f"{name}=1.25:red")
    assert {layer.pen.width_mm for layer in drawing.layers if layer.name.startswith("contour")} == {1.25}
    with pytest.raises(InputError, match="no item"):
        verb(scene, pens="nobody=1")


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_level_lines_over_colours_are_black_and_alone_where_nothing_else_is_asked_for(verb):
    hill = terrain_scene([[0, 1, 0], [1, 9, 1], [0, 1, 0]])
    drawing = verb(replace(hill, colouring=Colouring("z", "land", 7)), "top", lines="section,index")
    layers = {layer.name: layer for layer in drawing.layers if any(len(paths) for paths in layer.strokes)}
    assert set(layers) == {"section", "index", "colour bar"}
    assert layers["section"].pen.colour == layers["index"].pen.colour == "#000000"
    heights = np.concatenate([paths.points3d[:, 2] for paths in (*layers["section"].strokes, *layers["index"].strokes)])
    rounded = hill.items[0].curves.sections
    assert set(heights.round(6)) <= {offset for section in rounded for offset in section.offsets}


# Classes, ranges, logarithms, what is beyond, and the bar that says so.


def areas(scene):
    """The area of every item."""
    return {one.name: float(np.linalg.norm(one.mesh.area_vectors, axis=1).sum()) / 2.0 for one in scene.items}


def test_classes_have_the_areas_between_their_limits():
    scene, bar = coloured(SQUARE, Colouring("x", at=(1.0, 2.0, 8.0), under="black", over="red"))
    assert areas(scene) == pytest.approx({"S 1": 10.0, "S 2": 10.0, "S 3": 60.0, "S 4": 20.0})
    assert [one.colour for one in scene.items] == ["#000000", *bar.colours, "#ff0000"]
    assert bar.limits == (1.0, 2.0, 8.0) and bar.numbers() == AxisNumbers((0.0, 0.5, 1.0), ("1", "2", "8"))


def test_what_is_beyond_a_range_has_the_last_colours_where_nothing_else_is_said():
    scene, bar = coloured(SQUARE, Colouring("x", low=2.0, high=4.0, steps=2))
    assert areas(scene) == pytest.approx({"S 1": 30.0, "S 2": 70.0})
    assert [one.colour for one in scene.items] == list(bar.colours)


def test_a_logarithmic_scale_has_equal_ratios():
    scene, bar = coloured(SQUARE, Colouring("10^(x/2.5)", low=1.0, high=1e4, steps=4, logarithmic=True))
    assert bar.limits == pytest.approx((1.0, 10.0, 100.0, 1000.0, 10000.0))
    assert areas(scene) == pytest.approx(dict.fromkeys(("S 1", "S 2", "S 3", "S 4"), 25.0), rel=0.02)
    assert bar.numbers().texts == ("1", "10", "100", "1000", "10⁴")
    assert list(bar.numbers().values) == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    below, _ = coloured(SQUARE, Colouring("x-5", steps=2, low=1.0, high=4.0, logarithmic=True, under="black"))
    assert areas(below) == pytest.approx({"S 1": 60.0, "S 2": 10.0, "S 3": 30.0}, rel=0.06)
    with pytest.raises(InputError, match="no number is positive"):
        coloured(SQUARE, Colouring("-1-x", logarithmic=True))


@pytest.mark.parametrize(("low", "high"), [(2.0, 7.0), (0.9, 1.2), (1e-7, 1e9), (10.0, 20.0)])
def test_numbers_of_a_logarithmic_scale_are_few_round_and_in_order(low, high):
    found = logarithmic_numbers(low, high, 6)
    assert 1 <= len(found) <= 12 and list(found) == sorted(found)
    assert all(low * (1 - 1e-9) <= value <= high * (1 + 1e-9) for value in found)


@pytest.mark.parametrize("size", ["2.5", "5", "8pt"])
def test_letters_of_a_bar_have_their_size_and_numbers_room(size):
    own = Colouring("z", steps=4, size_mm=size)
    drawing = vp.draw(replace(CUBE, colouring=own), "front", page="120x90", text="real")
    (texts,) = drawing.layers[-1].texts
    assert set(np.round(texts.size_mm / capital_height(size), 6)) == {1.0, 1.2}
    assert (texts.points[:, 0] > 0.6 * 120).all() and (texts.points[:, 0] + texts.room_mm < 120.0).all()
    heights = np.sort(texts.points[texts.size_mm < 1.1 * capital_height(size), 1])
    assert (np.diff(heights) > 1.1 * capital_height(size)).all()


def test_formulas_of_titles_are_set_and_long_ones_run_along_the_bar():
    short, long = (
        vp.draw(replace(CUBE, colouring=Colouring("z", label=label)), "front", page="120x90", text="real")
        for label in (r"$\sigma_1$", r"the stress $\sigma_1$ in the middle")
    )
    for drawing, turn, text in ((short, 0.0, r"$\sigma_1$"), (long, 90.0, r"the stress $\sigma_1$ in the middle")):
        (texts,) = drawing.layers[-1].texts
        assert [turn for string, turn in zip(texts.strings, texts.turn_deg, strict=True) if string == text] == [turn]
        assert drawing.width_mm == 120.0
    strokes = vp.draw(replace(CUBE, colouring=Colouring("z", label=r"$\sin x$")), "front", page="120x90")
    plain = vp.draw(replace(CUBE, colouring=Colouring("z", label="sin x")), "front", page="120x90")
    assert write(strokes, "svg") == write(plain, "svg")
    with pytest.raises(InputError, match=r"colour bar: there are no strokes for \\sum"):
        vp.draw(replace(CUBE, colouring=Colouring("z", label=r"$\sum$")), "front")


@pytest.mark.parametrize("verb", [vp.paint, vp.render])
def test_unlit_colours_are_those_of_the_bar(verb):
    lamp = vp.Light((5.0, -7.0, 3.0), colour="orange", intensity=0.4)
    own = Colouring("x", steps=3, is_lit=False)
    made = verb(replace(CUBE, colouring=own, lights=(lamp,)), vp.Camera((6.0, -9.0, 7.0)))
    _, bar = coloured(CUBE, own)
    colours = np.array([[int(word[k : k + 2], 16) for k in (1, 3, 5)] for word in bar.colours])
    if verb is vp.paint:
        fills = made.layers[0].fills[0]
        assert {tuple(row) for row in fills.colours.reshape(-1, 3).tolist()} == {tuple(row) for row in colours.tolist()}
    else:
        for colour in colours:
            assert (made.pixels == colour).all(axis=2).mean() > 0.02


def test_a_bar_keeps_the_width_that_latex_knows_and_stands_off_the_picture():
    drawing = vp.draw(
        replace(CUBE, colouring=Colouring("z")), "front", page=vp.Page(80, 60, 1.0), width=r"0.5\linewidth"
    )
    assert in_latex(drawing.width_mm) == r"0.5\linewidth"
    bar = drawing.layers[-1]
    assert min(mark.points[:, 0].min() for mark in bar.marks) - max(
        mark.points[:, 0].max() for layer in drawing.layers[:-1] for mark in layer.strokes if len(mark)
    ) == pytest.approx(3.0, abs=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        'colour_by x map heat steps 3 called "a" low 0 high 4 under black over "#ff0000" logarithmic unlit size 8pt',
        "colour_by x classes 1, 2, 5.5 size 3",
        "colour_by x low 1 logarithmic",
        'scale_bar "nm" length 5 size 3',
        "scale_bar",
    ],
)
def test_all_words_are_written_as_they_are_read(text):
    scene = parse_scene(text.replace("low 0", "low 0.1") + " BOX gray box 1 2 3")
    again = parse_scene(write_scene(scene))
    assert (again.colouring, again.scale_bar) == (scene.colouring, scene.scale_bar)
    assert scene.colouring is not None or scene.scale_bar is not None


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("colour_by x classes 2, 1", "ascending limits"),
        ("colour_by x classes 1, 2 low 0", "ends in their limits"),
        ("colour_by x low 3 high 2", "do not ascend"),
        ("colour_by x low 0 logarithmic", "begins above 0"),
        ("colour_by x under rde", "colour"),
        ("colour_by x size -1", "positive number of mm"),
        ("scale_bar length 0", "finite and positive"),
        ('scale_bar "nm" lenght 3', "did you mean"),
    ],
)
def test_what_is_wrong_with_bars_is_told(text, told):
    with pytest.raises(InputError, match=told):
        parse_scene(f"BOX gray box 1 2 3\n{text}")


def test_a_long_title_stands_close_behind_the_numbers():
    long = Colouring("z", label="height above the table")
    drawing = vp.draw(replace(CUBE, colouring=long), "front", page="297x210", text="real")
    (texts,) = drawing.layers[-1].texts
    turned = texts.turn_deg == 90.0
    numbers = (texts.points[:, 0] + texts.room_mm)[~turned].max()
    # Letters that are turned have their base line at the right.
    assert numbers < texts.points[turned, 0].item() < numbers + 3.0 * long.capitals_mm


RING = vp.Scene((vp.Item("RING", Torus(3.0, 1.0)),), camera=vp.Camera((9.0, -12.0, 8.0)))


@pytest.mark.slow
def test_bands_are_filled_as_parts_of_their_body():
    drawing = vp.paint(replace(RING, colouring=Colouring("z", steps=4)), page="60x40")
    of_scene = np.concatenate([fills.item for fills in drawing.layers[0].fills])
    assert {drawing.items[k] for k in np.unique(of_scene)} == {"RING"}


@pytest.mark.slow
def test_nothing_shines_through_between_bands_of_lit_surfaces():
    """In a picture on white and on black paper all pixels but those at the outlines are the same."""
    svg = write(vp.paint(replace(RING, colouring=Colouring("z")), page="100x70", tolerance_mm=0.1), "svg")
    shown = [
        subprocess.run(("rsvg-convert", "-b", paper), input=svg, capture_output=True, check=True).stdout
        for paper in ("white", "black")
    ]
    white, black = (np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int) for png in shown)
    through = np.abs(white - black).max(axis=2)
    inside = ndimage.binary_erosion(through < 200, iterations=3)
    assert inside.mean() > 0.2
    assert (through[inside] > 8).mean() < 2e-3 and through[inside].max() < 30


@pytest.mark.parametrize("told", [{"steps": 10}, {"at": (0.0, 5e7, 1e8, 2e8)}])
def test_long_numbers_at_the_bar_are_parts_of_a_power_of_ten_and_stay_on_the_page(told):
    block = vp.Item("block", solid_box((30, 20, 10)))
    scene = vp.Scene((block,), colouring=Colouring("2.5e8*x/30", label="stress", **told))
    bar = coloured(scene, scene.colouring)[1]
    assert bar.numbers().common == "× 10⁸" and max(map(len, bar.numbers().texts)) <= 3
    drawing = vp.paint(scene, page="84x80", text="real")
    texts = [string for layer in drawing.layers for texts in layer.texts for string in texts.strings]
    assert "× 10⁸" in texts and not any("e+" in one for one in texts)


def test_a_range_may_have_steps(tmp_path):
    said = ["--colour-by", "z", "--colour-range=-4,0", "--colour-steps", "8"]
    assert run(["paint", "data/torus.scene", *said, "-o", str(tmp_path / "steps.svg")]) == 0


def test_contours_of_fields_stay_where_they_are_on_the_whole():
    block = solid_box((4, 2, 1))
    heat = Fields(block, {"heat": 2.5 * block.vertices[:, 0]})
    lines = vp.SurfaceLines(contours=(FieldContours("heat", 4),))
    scene = vp.Scene((vp.Item("block", block, fields=heat, curves=lines),))
    found = []
    for own in (scene, replace(scene, colouring=Colouring("heat", steps=7))):
        drawing = vp.draw(own, "top", page="200x100", fit=False)
        (layer,) = (layer for layer in drawing.layers if layer.name == "section")
        found.append(np.unique(np.concatenate([paths.points3d[:, 0] for paths in layer.strokes]).round(6)).tolist())
    assert found[0] == found[1] == [0.8, 1.6, 2.4, 3.2]
