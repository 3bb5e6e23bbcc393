"""Labels: what they may say, what they name, how scene files spell them."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot import io
from vectorplot.curves import Circle
from vectorplot.geometry import box
from vectorplot.io.anything import scene_of
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.annotations import label_anchors
from vectorplot.scene.labels import capital_height
from vectorplot.scene.page import in_latex
from vectorplot.surfaces import Sphere

ITEMS = (vp.Item("CUBE", box((2, 2, 2))), vp.Item("RING", Circle(radius=2.0)), vp.Item("BALL", Sphere(1.0)))

FILE = """
label A "A" at 0 0 4
label "two\\n\\"lines\\"" vertex CUBE 8 size 10pt place above_left hidden dashed mark cross
label k "k, αβ" along RING 0.25 place above
label "T" page 10, 20 size 2mm mark dot
label "e" on RING 0.5 mark tick
CUBE red box solid 2 2 2
RING curve circle 2
"""


def test_sizes_in_mm_and_in_points() -> None:
    assert capital_height("3.5") == capital_height("3.5mm") == 3.5
    assert capital_height("72.27pt") == capital_height("72 bp") == pytest.approx(0.7 * 25.4)
    assert vp.Label("A", (0, 0, 0), size_mm="72bp").size_mm == pytest.approx(0.7 * 25.4)
    for wrong in ("", "big", "-1", "0mm", "nan", "infpt", "3 cm", "\\huger", "small", None, True):
        with pytest.raises(vp.InputError, match="a size of"):
            capital_height(wrong)


@pytest.mark.parametrize("word", [r"\small", r"\Huge"])
def test_a_size_of_latex_keeps_its_word_in_files_and_copies(word: str) -> None:
    label = vp.Label("A", (0, 0, 4), size_mm=word)
    scene = io.parse_scene(f'box_axes size {word} label A "A" at 0 0 4 size {word}')
    assert scene.labels == (label,) and in_latex(scene.labels[0].capitals_mm) == word
    again = pickle.loads(pickle.dumps(io.parse_scene(write_scene(scene))))
    assert in_latex(again.labels[0].capitals_mm) == in_latex(again.box.capitals_mm) == word
    ticks = vp.axes(2, ticks=1, size_mm=word).labels
    assert {label.capitals_mm for label in ticks} == {label.capitals_mm, label.capitals_mm * 2 / 3}


def test_scene_files_say_the_same_as_python() -> None:
    scene = io.parse_scene(FILE)
    assert scene.labels == (
        vp.Label("A", (0.0, 0.0, 4.0), "A"),
        vp.Label(
            'two\n"lines"',
            vp.AtVertex("CUBE", 7),
            size_mm=capital_height("10pt"),
            place="above_left",
            hidden="dashed",
            mark="cross",
        ),
        vp.Label("k, αβ", vp.Along("RING", 0.25), "k", place="above"),
        vp.Label("T", vp.OnPage(10.0, 20.0), size_mm=2.0, mark="dot"),
        vp.Label("e", vp.OnCurve("RING", 0.5), mark="tick"),
    )
    again = io.parse_scene(write_scene(scene))
    assert again.labels == scene.labels


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("label", "expected a text in quotes, got the end of the file"),
        ("label A B", "label A: expected a text in quotes, got 'B'"),
        ('label A "A"', "label A: expected at, vertex, on, along, page, got the end of the file"),
        ('label A "A" at 1 2', "label A: expected a number for at"),
        ('label A "A" at 1 2 3 page 1 2', "label A: a second place, 'page'"),
        ('label A "A" at 1 2 3 size big', "label A: a size of 'big'"),
        ('label A "A" at 1 2 3 place under', "label A: place: expected one of auto, centre"),
        ('label A "A" vertex CUBE 0', "label A: vertices count from 1, got 0"),
        ('label A "A" vertex CUBE 9', "label A: CUBE has 8 vertices, not 9"),
        ('label A "A" vertex WALL 1', "label A: there is no item 'WALL'"),
        ('label A "A" vertex RING 1', "label A: RING has no vertices"),
        ('label A "A" along CUBE', "label A: CUBE is no curve"),
        ('label A "A" along RING 1.5', "label A: a part of 1.5 of a curve"),
        ('label A "A" along RING place left', "label A: along a curve a label is above, below or centre, not left"),
    ],
)
def test_what_is_wrong_in_a_file_is_one_line(text: str, cause: str) -> None:
    scene = "CUBE red box solid 2 2 2\nRING curve circle 2\n"
    with pytest.raises(vp.InputError) as caught:
        io.parse_scene(scene + text, "f.scene")
    assert str(caught.value).startswith("f.scene:3: ") and cause in str(caught.value)


@pytest.mark.parametrize(
    "wrong",
    [
        {"place": "under"},
        {"hidden": "maybe"},
        {"mark": "star"},
        {"size_mm": 0.0},
        {"size_mm": np.nan},
        {"size_mm": "x"},
    ],
)
def test_python_refuses_the_same(wrong: dict[str, object]) -> None:
    with pytest.raises(vp.InputError, match="label A: "):
        vp.Label("A", (0, 0, 0), **wrong)  # type: ignore[arg-type]
    with pytest.raises(vp.InputError, match="label A: expected finite coordinates"):
        vp.Label("A", (0, np.inf, 0))


def test_anchors_are_the_places_that_labels_name() -> None:
    labels = (
        vp.Label("V", vp.AtVertex("CUBE", 7)),
        vp.Label("k", vp.Along("RING", 0.25)),
        vp.Label("P", (1, 2, 3)),
        vp.Label("T", vp.OnPage(1, 2)),
    )
    found = label_anchors(vp.Scene(ITEMS, labels=labels))
    assert found.points[0].tolist() == ITEMS[0].mesh.vertices[7].tolist() and found.points[2].tolist() == [1, 2, 3]
    assert found.points[1] == pytest.approx([0.0, 2.0, 0.0], abs=1e-3) and np.isnan(found.points[3]).all()
    assert [course is not None for course in found.courses] == [False, True, False, False]
    with pytest.raises(vp.InputError, match="label A: BALL has no vertices"):
        label_anchors(vp.Scene(ITEMS, labels=(vp.Label("A", vp.AtVertex("BALL", 0)),)))


def test_labels_go_where_their_scene_goes() -> None:
    labels = (vp.Label("P", (1, 0, 0)), vp.Label("V", vp.AtVertex("CUBE", 7)), vp.Label("k", vp.Along("RING")))
    scene = vp.Scene(ITEMS, labels=labels)
    matrix = np.diag([2.0, 3.0, 4.0, 1.0])
    matrix[:3, 3] = 1.0, 2.0, 3.0
    for moved in (scene.transformed(matrix), scene.moved(5, 6, 7).turned("z", 30)):
        before, after = label_anchors(scene), label_anchors(moved)
        assert after.points[1] == pytest.approx(moved.items[0].mesh.vertices[7])
        assert not np.isclose(before.points, after.points).all(axis=1).any()
    assert label_anchors(scene.transformed(matrix)).points[0] == pytest.approx([3.0, 2.0, 3.0])


def test_labels_of_several_scenes_name_their_own_items() -> None:
    one = vp.Scene(ITEMS[:1], labels=(vp.Label("V", vp.AtVertex("CUBE", 7)),))
    both = scene_of([one, one.moved(10)])
    named = scene_of({"left": one, "right": one.moved(10)})
    for scene in (both, named):
        points = label_anchors(scene).points
        assert points[1] - points[0] == pytest.approx([10.0, 0.0, 0.0])


ROOF = vp.Mesh.from_triangles(
    [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, 3)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
)


def named_roof(margin: float, *names: str) -> vp.Scene:
    labels = tuple(vp.Label(name, vp.AtVertex("roof", k)) for k, name in enumerate(names))
    return vp.Scene((vp.Item("roof", ROOF),), labels=labels, page=vp.Page(100, 90, margin))


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
@pytest.mark.parametrize("page", [{}, {"width": "80mm"}, {"page": "scale 9:1"}], ids=["page", "width", "scale"])
def test_labels_have_room_beside_the_outlines_of_a_picture_with_a_narrow_margin(verb, page) -> None:
    scene = named_roof(1.0, "Alpha", "Bravo point", "C", "Summit")
    drawing = verb(scene, "iso", text="real", **page)
    (texts,) = [texts for layer in drawing.layers for texts in layer.texts]
    world = drawing.page_from_world @ np.column_stack([ROOF.vertices, np.ones(4)]).T
    corners = (world[:2] / world[3]).T
    outline = shapely.MultiPoint(corners).convex_hull
    for k in range(len(texts)):
        left = texts.points[k, 0] - texts.anchor[k] * texts.room_mm[k]
        box_ = shapely.box(left, texts.points[k, 1], left + texts.room_mm[k], texts.points[k, 1] + texts.size_mm[k])
        assert not box_.intersects(outline), texts.strings[k]
        assert shapely.box(0, 0, drawing.width_mm, drawing.height_mm).contains(box_), texts.strings[k]
    low, high = corners.min(axis=0), corners.max(axis=0)
    assert (low >= 1.0 - 1e-9).all() and (high <= np.array([drawing.width_mm, drawing.height_mm]) - 1.0 + 1e-9).all()


def test_a_picture_whose_labels_have_room_stays_as_large_as_without_them() -> None:
    wide, bare = (vp.draw(named_roof(15.0, *names), "iso") for names in (("A", "B", "C", "D"), ()))
    np.testing.assert_array_equal(wide.page_from_world, bare.page_from_world)
    narrow = vp.draw(named_roof(1.0, "A", "B", "C", "D"), "iso")
    assert np.linalg.norm(narrow.page_from_world[0, :3]) < np.linalg.norm(
        vp.draw(named_roof(1.0), "iso").page_from_world[0, :3]
    )
