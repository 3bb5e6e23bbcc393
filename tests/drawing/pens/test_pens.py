"""Pens by kind, by item and by both; dashes; styles by name and from files."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.drawing.pens import STYLES, pen_rules, read_style
from vectorplot.errors import InputError
from vectorplot.geometry import box
from vectorplot.words import LineKind

SCENE = vp.Scene(
    (
        vp.Item("HOUSE", box((1, 1, 1)), "red"),
        vp.Item("SHED", box((1, 1, 1)).moved(0.3, 2.0, 0.0), "blue"),
        vp.Item("a.b", box((0.2, 0.2, 0.2)).moved(3.0, 0.0, 0.0), "lightblue"),
    )
)


def drawn(**options):
    return vp.draw(SCENE, vp.Camera((6, -9, 5), (0.5, 1, 0.5)), page="120x90", **options)


def pens_of(drawing):
    """The pen of every item, kind and side, as drawn."""
    found = {}
    for layer in drawing.layers:
        for paths in layer.strokes:
            for kind, item, hidden in zip(paths.kind, paths.item, paths.hidden_by > 0, strict=True):
                word = "hidden" if hidden else LineKind(kind).word
                found.setdefault((drawing.items[item], word), set()).add((layer.pen.width_mm, layer.pen.colour))
    return {key: pens.pop() for key, pens in found.items() if len(pens) == 1}


def test_narrower_rules_hold_and_of_equal_ones_the_later():
    rules = "0.2:#111111,contour=0.5,HOUSE=#222222,crease=0.9,crease=0.3,HOUSE.contour=0.7:#333333,hidden=0.1"
    found = pens_of(drawn(pens=rules, hidden="solid"))
    assert found["HOUSE", "contour"] == (0.7, "#333333")
    assert found["SHED", "contour"] == (0.5, "#111111")
    assert found["HOUSE", "crease"] == (0.3, "#222222")
    assert found["a.b", "crease"] == (0.3, "#111111")
    assert {pen for (_, kind), pen in found.items() if kind == "hidden"} == {(0.1, "#111111")}


@pytest.mark.parametrize(
    "pens",
    [
        "contour=0.5:#ff0000,a.b=0.4",
        ["contour=0.5:#ff0000", "a.b=0.4"],
        {"contour": "0.5:#ff0000", "a.b": 0.4},
        {"contour": vp.Pen(0.5, "#ff0000"), "a.b": "0.4mm"},
    ],
)
def test_pens_may_be_said_in_many_ways(pens):
    found = pens_of(drawn(pens=pens))
    assert found["HOUSE", "contour"] == (0.5, "#ff0000") and found["a.b", "contour"][0] == 0.4


@pytest.mark.slow
def test_no_stroke_is_lost_or_doubled_by_pens_and_layers():
    want = sum(len(layer.strokes[0].points) for layer in drawn(hidden="solid").layers)
    rules = {"HOUSE": "red", "crease": "0.1", "a.b.crease": "0.2", "hidden": "green", "SHED.hidden": "blue"}
    for layers in ("kind", "object", "colour", "kind,colour", "object, kind", "colour,object,kind"):
        drawing = drawn(hidden="solid", layers=layers, pens=rules)
        assert sum(len(layer.strokes[0].points) for layer in drawing.layers) == want
        names = [layer.name for layer in drawing.layers]
        assert len(set(names)) == len(names)
    both = drawn(layers="kind,colour")
    assert [layer.name for layer in both.layers] == [
        f"{kind} {colour}" for kind in ("visible", "contour") for colour in ("red", "blue", "lightblue")
    ]
    assert {layer.pen.colour for layer in both.layers} == {"#c00000", "#1f4fa3"}


def test_units_and_colours():
    (rule,) = pen_rules("contour=1.44bp:white")
    assert (rule.width_mm, rule.colour) == (pytest.approx(0.508), "#ffffff")
    (rule,) = pen_rules(None, "HOUSE.hidden=6pt,0.1cm")
    assert (rule.item, rule.kind, rule.dash_mm) == ("HOUSE", "hidden", (pytest.approx(6 * 25.4 / 72.27), 1.0))


@pytest.mark.parametrize("dash", [(3.0, 1.0), (1.0, 2.0)])
def test_dashes_are_real_strokes_as_long_as_asked_for_within_the_fit(dash):
    drawing = drawn(hidden="dashed", dashes=[f"hidden={dash[0]},{dash[1]}", "HOUSE.crease=2,1"])
    (hidden,) = next(layer for layer in drawing.layers if layer.name == "hidden").strokes
    steps = np.hypot(*np.diff(hidden.points, axis=0).T)
    steps[hidden.offsets[1:-1] - 1] = 0.0
    lengths = np.add.reduceat(steps, hidden.offsets[:-1])
    assert abs(np.median(lengths) / dash[0] - 1.0) < 0.15
    crease = next(layer for layer in drawing.layers if layer.pen.dash_mm == (2.0, 1.0))
    assert len(crease.strokes[0]) > 10 and set(crease.strokes[0].item) == {0}
    whole = drawn(hidden="dashed", dashes="hidden=none")
    assert len(next(layer for layer in whole.layers if layer.name == "hidden").strokes[0]) < 20


def test_layers_are_plotted_unless_asked_not_to():
    drawing = drawn(hidden="dashed", background="lightyellow", unplotted="contour, hidden")
    assert [layer.name for layer in drawing.layers if not layer.plotted] == ["background", "contour", "hidden"]
    assert all(layer.plotted for layer in drawn(hidden="solid").layers)


def test_pens_grow_with_the_page_on_request():
    kw = {"camera": vp.Camera((6, -9, 5)), "scale_pens": True, "dashes": "crease=2,1"}
    for page, factor in (("A4", 1.0), ("A2", 2.0)):
        layer = vp.draw(SCENE, page=page, **kw).layers[0]
        assert layer.pen.width_mm == pytest.approx(0.25 * factor, rel=5e-3)
        assert layer.pen.dash_mm == pytest.approx((2 * factor, factor), rel=5e-3)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"pens": "contur=0.5"}, "no kind of line, and no item \\(did you mean 'contour'"),
        ({"pens": "house=0.5"}, "did you mean 'HOUSE'"),
        ({"pens": "contour=0.5:blak"}, "did you mean 'black'"),
        ({"pens": "contour=-1"}, "pen contour=-1"),
        ({"pens": "contour=5furlong"}, "no length in mm or pt"),
        ({"pens": "=0.5"}, "before '='"),
        ({"pens": "contour="}, "expected WIDTH"),
        ({"pens": "contour=nan:red"}, "no length|unknown colour"),
        ({"dashes": "hidden=3"}, "expected DASH,GAP"),
        ({"dashes": "hidden=3,0"}, "no length"),
        ({"dashes": "hidden=1e-9,1e-9"}, "0.01 mm or more"),
        ({"dashes": "3,1e-4pt"}, "0.01 mm or more"),
        ({"pens": "50"}, "25 mm or less"),
        ({"pens": {"contour": 26}}, "25 mm or less"),
        ({"dashes": "hidden=3,1001"}, "1000 mm or less"),
        ({"layers": "kind,colr"}, "did you mean 'colour'"),
        ({"style": "bok"}, "did you mean 'book'"),
        ({"style": "wireframe", "pens": "0.3"}, "does not go with the style wireframe"),
        ({"background": "bleu"}, "did you mean 'blue'"),
    ],
)
def test_what_is_no_pen_is_told(options, said):
    with pytest.raises(vp.InputError, match=said):
        drawn(**options)


@pytest.mark.parametrize("name", [name for name, style in STYLES.items() if style.look == "plain"])
def test_every_style_draws_the_same_lines(name):
    drawing = drawn(style=name, hidden="none")
    assert sum(len(layer.strokes[0].points) for layer in drawing.layers if layer.strokes) == 34
    assert (name == "blueprint") == (not drawing.layers[0].plotted)


FILE = """# of a shop
hidden = "dashed"
background = "white"
[pens]
contour = 0.7
"a.b.crease" = "0.2:blue"
[dashes]
hidden = "3pt,2pt"
"""


def test_a_file_is_a_style(tmp_path):
    path = tmp_path / "shop.toml"
    path.write_text(FILE)
    drawing = drawn(style=str(path))
    assert pens_of(drawing)["a.b", "crease"] == (0.2, "#1f4fa3")
    assert pens_of(drawing)["HOUSE", "contour"] == (0.7, "#000000")
    assert pens_of(drawn(style=str(path), hidden="none", pens="contour=1"))["SHED", "contour"][0] == 1.0


@pytest.mark.parametrize(
    ("old", "new", "line", "said"),
    [
        ('hidden = "dashed"', 'hiden = "dashed"', 2, "did you mean 'hidden'"),
        ('"dashed"', '"dotted"', 2, "none, dashed, solid"),
        ('"dashed"', "3", 2, "expected a text"),
        ('"dashed"', '"dash', 2, "Illegal|Unterminated"),
        ("0.7", '"0.7:blak"', 5, "did you mean 'black'"),
        ('"a.b.crease"', "a.b.crease", 6, "quote 'item.kind'"),
        ("3pt,2pt", "3", 8, "expected DASH,GAP"),
        ("[pens]", "pens = 3\n[pans]", 4, "expected a table"),
        ('"white"', '"whit"', 3, "did you mean 'white'"),
    ],
)
def test_mistakes_in_files_are_told_with_their_line(tmp_path, old, new, line, said):
    path = tmp_path / "shop.toml"
    path.write_text(FILE.replace(old, new, 1))
    with pytest.raises(vp.InputError, match=said) as error:
        read_style(path)
    assert (error.value.file, error.value.line) == (str(path), line)


def test_files_that_are_no_styles_are_told(tmp_path):
    for content in (b"\xff\xfe", b"#" * (1 << 21)):
        (tmp_path / "x.toml").write_bytes(content)
        with pytest.raises(vp.InputError, match=r"no style|too large"):
            read_style(tmp_path / "x.toml")
    with pytest.raises(vp.InputError, match="no such file"):
        read_style(tmp_path / "y.toml")


def test_several_dashes_in_one_text_are_several_rules():
    found = pen_rules(None, "contour=3,1,crease=2,1,hidden=none")
    assert [(rule.kind, rule.dash_mm) for rule in found] == [
        ("contour", (3.0, 1.0)),
        ("crease", (2.0, 1.0)),
        ("hidden", (0.0, 0.0)),
    ]


@pytest.mark.parametrize("pens", ["contour=1e-9", "0.009", "contour=0.02pt"])
def test_no_pen_is_finer_than_a_hundredth_of_a_millimetre(pens):
    with pytest.raises(InputError, match="mm or more"):
        drawn(pens=pens)


def test_frames_and_titles_have_a_pen_of_their_own():
    drawing = drawn(pens="frame=0.9:blue,0.2", dashes="frame=4,2", title="T", frame=True)
    assert drawing.layers[-1].name == "frame" and drawing.layers[-1].pen.width_mm == 0.9
    assert len(drawing.layers[-1].strokes[0]) > 30


def test_layers_that_are_not_plotted_are_layers():
    drawing = drawn(unplotted="frame, hidden, HOUSE", frame=True)
    assert [layer.name for layer in drawing.layers if not layer.plotted] == ["frame"]
    with pytest.raises(InputError, match="unplotted 'contuor'"):
        drawn(unplotted="contuor")


def test_a_style_that_ends_too_early_is_told_with_its_last_line(tmp_path):
    (tmp_path / "a.toml").write_text('hidden = "dashed"\n[pens]\na = [1,\n')
    with pytest.raises(InputError) as error:
        read_style(tmp_path / "a.toml")
    assert error.value.line == 3


def shown(verb, **options):
    options = {"lines": "contour,crease", **options}
    return verb(SCENE, vp.Camera((6, -9, 5), (0.5, 1, 0.5)), **options)


@pytest.mark.parametrize(
    "rules", [{"pens": "0.3,contour=0.7:red,HOUSE.crease=0.1:blue"}, {"style": "blueprint"}, {"pens": "SHED=green"}]
)
def test_lines_on_top_of_painted_faces_have_the_pens_of_drawn_ones(rules):
    painted = shown(vp.paint, page="120x90", **rules)
    drawn_too = drawn(lines="contour,crease", **{"hidden": "none", **rules})
    mine, other = pens_of(painted), pens_of(drawn_too)
    assert mine.items() <= other.items() and {key for key in other if key[1] != "hidden"} == set(mine)
    papers = [
        next(tuple(fills.colours[0].tolist()) for layer in drawing.layers for fills in layer.fills)
        for drawing in (painted, drawn_too)
        if "style" in rules
    ]
    assert len(set(papers)) <= 1


@pytest.mark.slow
def test_lines_over_pixels_have_pens_too():
    plain, red = (shown(vp.render, size=(120, 90), **rules).pixels for rules in ({}, {"pens": "contour=1:red"}))
    is_red = (red[..., 0] > 1.5 * red[..., 1].clip(1)) & (plain != red).any(axis=2)
    # Contours of 1 mm are 3.8 pixels wide, those that nobody asks for one.
    dark = (plain.max(axis=2) < 60).sum()
    assert is_red.sum() > 2 * dark > 0
    assert (shown(vp.render, size=(120, 90), dashes="contour=1,1").pixels != plain).any()


@pytest.mark.parametrize("verb", [vp.paint, vp.render])
@pytest.mark.parametrize(
    ("rules", "said"),
    [
        ({"style": "wireframe"}, "the style wireframe shows lines alone: it is for draw"),
        ({"pens": "HUSE=1"}, "pen 'HUSE': no kind of line, and no item (did you mean 'HOUSE'?)"),
        ({"pens": "contour=thick"}, "thick"),
    ],
)
def test_what_is_no_pen_over_faces_is_told(verb, rules, said):
    with pytest.raises(InputError) as told:
        shown(verb, lines="none", **rules)
    assert said in str(told.value)


def test_erasing_fills_have_lines_in_the_shades_of_items():
    with pytest.raises(InputError, match="erasing"):
        shown(vp.paint, fills="erasing", pens="0.3")
