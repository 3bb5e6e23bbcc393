"""Pages that are as large as their pictures, and pages of a width."""

import json
from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import Fills
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.projections import projection_of
from vectorplot.geometry.solids import box
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import ScaleBar
from vectorplot.scene.page import Page
from vectorplot.scene.placement import fitted_page, fitted_picture, page_of_width

POINT = 25.4 / 72.27
"""A point of TeX in mm."""

SLAB = vp.Scene((vp.Item("slab", box((4.0, 1.0, 2.0))),), page=Page(100.0, 200.0, 5.0))
POLE = vp.Scene((vp.Item("pole", box((1.0, 1.0, 30.0))),))
VERBS = (vp.draw, vp.paint)


def extent(drawing):
    """The corners (2,2) of all strokes and polygons of a drawing but its paper."""
    layers = [layer for layer in drawing.layers if layer.plotted]
    points = [mark.points[:, :2] for layer in layers for mark in layer.marks if isinstance(mark, Paths | Fills)]
    every = np.concatenate(points)
    return np.array([every.min(axis=0), every.max(axis=0)])


def page_of(drawing):
    return np.array([drawing.width_mm, drawing.height_mm])


def assert_same(one, other):
    """Layer for layer the same marks."""
    assert [layer.name for layer in one.layers] == [layer.name for layer in other.layers]
    for a, b in zip(one.layers, other.layers, strict=True):
        assert a.pen == b.pen
        for mine, its in zip(a.marks, b.marks, strict=True):
            np.testing.assert_array_equal(mine.offsets, its.offsets)
            np.testing.assert_allclose(mine.points, its.points, atol=1e-6)


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_page_that_fits_is_the_picture_and_its_margin(verb, scale):
    scene = vp.Scene((vp.Item("slab", box((4.0 * scale, scale, 2.0 * scale))),), page=Page(100.0, 200.0, 5.0))
    drawing = verb(scene, "front", page="fit")
    np.testing.assert_allclose(page_of(drawing), (100.0, 55.0), atol=1e-6)
    np.testing.assert_allclose(extent(drawing), [(5, 5), (95, 50)], atol=1e-6)
    on_page = drawing.page_from_world @ (4.0 * scale, 0.0, 2.0 * scale, 1.0)
    np.testing.assert_allclose(on_page[:2] / on_page[3], (95, 50), atol=1e-6)
    lying = verb(scene, "front", page="fit landscape")
    np.testing.assert_allclose(page_of(lying), (190.0, 100.0), atol=1e-6)


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("scene", [SLAB, POLE])
@pytest.mark.parametrize("width", [40.0, "40", "40mm", "4 cm", "1.5in", "120pt", "120bp", r"0.5\linewidth"])
def test_a_page_of_a_width_is_as_high_as_its_picture(verb, scene, width):
    drawing = verb(scene, "front", page=Page(70.0, 30.0, 3.0), width=width)
    mm = {"1.5in": 38.1, "120pt": 120.0 * POINT, "120bp": 120.0 * 25.4 / 72.0, r"0.5\linewidth": 172.5 * POINT}.get(
        width, 40.0
    )
    ratio = 0.5 if scene is SLAB else 30.0
    np.testing.assert_allclose(page_of(drawing), (mm, (mm - 6.0) * ratio + 6.0), rtol=1e-9)
    np.testing.assert_allclose(extent(drawing), [(3, 3), page_of(drawing) - 3], rtol=1e-9)


@pytest.mark.parametrize("verb", VERBS)
def test_paper_title_and_frame_are_those_of_the_page_cut(verb):
    drawing = verb(SLAB, "front", width=80, background="yellow", title="Slab", frame=True)
    plain = verb(SLAB, "front", page=Page(80.0, drawing.height_mm, 5.0), background="yellow", title="Slab", frame=True)
    assert_same(drawing, plain)
    np.testing.assert_allclose(drawing.height_mm, 45.0)


def test_hatching_halo_and_labels_are_those_of_the_page_cut():
    ball = vp.Item("ball", box((1.0, 1.0, 1.0)).transformed(np.diag([1.0, -3.0, 1.0, 1.0])))
    scene = vp.Scene((*SLAB.items, ball), labels=(vp.Label("A", (4.0, 0.0, 2.0)),), page=Page(100.0, 200.0, 9.0))
    options = {"hatch": vp.Hatching("tone"), "halo_mm": 0.8, "scale_pens": True, "hidden": "dashed"}
    drawing = vp.draw(scene, "iso", width=70, **options)
    plain = vp.draw(scene, "iso", page=Page(70.0, drawing.height_mm, 9.0), **options)
    assert_same(drawing, plain)


@pytest.mark.parametrize("kind", [fitted_page, lambda page: page_of_width(page, 100.0)])
@pytest.mark.parametrize("margin", [0.0, 10.0])
def test_pictures_without_width_or_height_have_a_page(kind, margin):
    view = projection_of(vp.Camera.view("top"), bounds=np.array([(-1, -1, 0), (1, 1, 0)]))
    for size in [(0.0, 2.0), (2.0, 0.0), (0.0, 0.0)]:
        image = np.array([np.zeros(2), size]).T
        placement = fitted_picture(view, kind(Page(100.0, 80.0, margin)), image)
        sides = np.array([placement.page.width_mm, placement.page.height_mm])
        np.testing.assert_allclose(placement.on_page(image).mean(axis=0), sides / 2.0)
        assert (sides <= 100.0).all() and np.ptp(placement.on_page(image), axis=0).max() <= 100.0 - 2.0 * margin


@pytest.mark.parametrize("verb", VERBS)
def test_an_empty_picture_and_one_of_the_field_of_vision_have_a_whole_page(verb):
    sheet = Page(100.0, 60.0, 10.0)
    inside = vp.Camera((2.0, 0.5, 1.0), (2.0, 5.0, 1.0))
    for scene, camera in [(vp.Scene(()), "front"), (SLAB, inside)]:
        assert page_of(verb(vp.Scene(scene.items, page=sheet), camera, page="fit")).tolist() == [100.0, 60.0]
        np.testing.assert_allclose(page_of(verb(scene, camera, page=sheet, width=60)), [60.0, 40.0])


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize(
    ("said", "told"),
    [
        ({"width": "8x"}, "'8x' is no length: expected a positive number, and perhaps mm, pt, bp, cm, in"),
        ({"width": "1e999"}, "'1e999' is no length"),
        ({"width": 15}, "a margin of 10 mm leaves nothing of the page"),
        ({"width": -1}, "not a page"),
        ({"width": np.nan}, "not a page"),
        ({"width": np.inf}, "not a page"),
        ({"width": 80, "fit": False}, "does not go with no-fit"),
        ({"page": "fit", "fit": False}, "does not go with no-fit"),
        ({"page": "fitt"}, "expected WIDTHxHEIGHT"),
    ],
)
def test_what_is_no_width_is_told(verb, said, told):
    with pytest.raises(InputError, match=told) as found:
        verb(POLE, "front", **said)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_the_options_are_those_of_python(verb, tmp_path, capsys):
    mesh, out = tmp_path / "slab.off", tmp_path / "slab.json"
    mesh.write_text("OFF\n3 1 0\n0 0 0\n4 0 0\n4 0 2\n3 0 1 2\n", encoding="utf-8")
    command = [verb, str(mesh), "-o", str(out), "--view", "front", "-q", "--margin", "2"]

    def sides(*words):
        assert run([*command, *words]) == 0
        return json.loads(out.read_text(encoding="utf-8"))["page_mm"]

    np.testing.assert_allclose(sides("--width", "8cm"), [80.0, 42.0])
    np.testing.assert_allclose(sides("--page", "fit"), [210.0, 107.0])
    np.testing.assert_allclose(sides("--page", "fit", "--landscape"), [297.0, 150.5])
    np.testing.assert_allclose(sides("--page", "fit", "--width", "80"), [80.0, 42.0])
    capsys.readouterr()
    assert run([*command, "--page", "A5", "--width", "80"]) == 2
    assert "--page SIZE and --width exclude each other" in capsys.readouterr().err
    assert run([*command, "--width", "80", "--no-fit"]) == 1
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("page fit", {"page": "fit"}),
        ("page A5 landscape fit margin 3", {"page": fitted_page(vp.Page(210, 148, 3))}),
        ("page width 80mm", {"width": "80mm"}),
        ("page width 3in margin 4", {"page": vp.Page(margin_mm=4), "width": "3in"}),
    ],
)
def test_pages_of_scene_files_are_those_of_the_options(said, told, tmp_path):
    text = "B gray box solid 3 2 1\n"
    (tmp_path / "a.scene").write_text(f"{said}\n{text}")
    (tmp_path / "b.scene").write_text(text)
    one = vp.draw(tmp_path / "a.scene", "iso")
    other = vp.draw(tmp_path / "b.scene", "iso", **told)
    assert (one.width_mm, one.height_mm) == (other.width_mm, other.height_mm)
    # Files that are written say the same.
    vp.save(vp.read(tmp_path / "a.scene"), tmp_path / "c.scene")
    again = vp.draw(tmp_path / "c.scene", "iso")
    assert (again.width_mm, again.height_mm) == pytest.approx((one.width_mm, one.height_mm))
    assert run(["draw", str(tmp_path / "a.scene"), "--view", "iso", "-o", str(tmp_path / "a.svg")]) == 0
    assert f'width="{one.width_mm:.6g}' in (tmp_path / "a.svg").read_text()


def test_a_page_of_a_width_is_not_cut_and_sheets_may_lie_on_their_side(tmp_path):
    with pytest.raises(vp.InputError, match="exclude each other"):
        parse_scene("page width 80mm fit\n")
    box = tmp_path / "b.scene"
    box.write_text("B gray box solid 3 2 1\n")
    assert run(["draw", str(box), "--page", "A5 landscape", "-o", str(tmp_path / "a.svg")]) == 0
    assert 'viewBox="0 0 210 148"' in (tmp_path / "a.svg").read_text()


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize(("scale", "factor"), [("1:2", 0.5), ("3", 3.0), ("5:1", 5.0)])
def test_a_page_at_a_scale_is_as_large_as_its_picture(verb, scale, factor):
    drawing = verb(SLAB, "front", page=f"scale {scale}")
    wide, high = np.ptp(SLAB.bounds, axis=0)[[0, 2]]
    margin = SLAB.page.margin_mm if SLAB.page else 10.0
    np.testing.assert_allclose(page_of(drawing), (factor * wide + 2 * margin, factor * high + 2 * margin))
    np.testing.assert_allclose(np.linalg.norm(drawing.page_from_world[0, :3]), factor, rtol=1e-12)
    with pytest.raises(InputError, match="parallel projections"):
        verb(SLAB, vp.Camera((9, -9, 9)), page=f"scale {scale}")


@pytest.mark.parametrize("text", ["1:0", "0", "a:b", "1:2:3", ""])
def test_what_is_no_scale_is_told(text):
    with pytest.raises(InputError, match="expected two numbers such as 1:2"):
        vp.draw(SLAB, "front", page=f"scale {text}")
    with pytest.raises(InputError, match="does not go with no-fit"):
        vp.draw(SLAB, "front", page="scale 1:2", fit=False)


def test_a_scene_file_says_its_scale():
    scene = parse_scene("page scale 1:4 margin 3 BOX gray box 1 2 3")
    assert scene.page.mm_per_unit == 0.25 and scene.page.margin_mm == 3.0
    assert parse_scene(write_scene(scene)).page == scene.page
    with pytest.raises(InputError, match="exclude each other"):
        parse_scene("page scale 1:4 fit BOX gray box 1 2 3")


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("page", [None, "fit", "scale 1:2", "120x80"])
def test_a_scale_bar_is_as_long_as_what_it_says(verb, page):
    scene = replace(SLAB, scale_bar=ScaleBar("nm"))
    drawing, plain = verb(scene, "front", page=page, text="real"), verb(SLAB, "front", page=page, text="real")
    bar = drawing.layers[-1]
    assert bar.name == "scale bar"
    course, (said,) = bar.strokes[0].points, bar.texts[0].strings
    length = float(said.removesuffix(" nm"))
    scale = np.linalg.norm(drawing.page_from_world[0, :3])
    assert np.ptp(course[:, 0]) == pytest.approx(length * scale) and f"{length:.0e}"[0] in "125"
    # Whole pages stay as they are, the others are higher by the strip; what is drawn stands above it.
    if page in ("fit", "scale 1:2"):
        assert page_of(drawing)[1] == pytest.approx(page_of(plain)[1] + 2.4 * 2.5)
    else:
        np.testing.assert_allclose(page_of(drawing), page_of(plain))
    assert extent(replace(drawing, layers=drawing.layers[:-1]))[0][1] > course[:, 1].max()
    # Where world points are says the matrix still.
    world = drawing.layers[0].strokes[0] if verb is vp.draw else None
    if world is not None:
        at = np.column_stack([world.points3d, np.ones(len(world.points3d))]) @ drawing.page_from_world.T
        np.testing.assert_allclose(at[:, :2] / at[:, 3:], world.points, atol=1e-6)


def test_scale_bars_have_no_place_where_nothing_has_a_scale():
    scene = replace(SLAB, scale_bar=ScaleBar(length=1e6))
    with pytest.raises(InputError, match="longer than the page"):
        vp.draw(scene, "front")
    with pytest.raises(InputError, match="for parallel projections"):
        vp.draw(scene, vp.Camera((9, -9, 9)))
    with pytest.warns(InputWarning, match="a scale bar"):
        vp.render(replace(SLAB, scale_bar=ScaleBar()), "front", size=(60, 40))
