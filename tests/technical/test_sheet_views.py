"""Sections, details and local sections on technical sheets: where they cut, and what they show, in closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from technical.test_technical_sheet import BRICK, layer, outlines, strokes_of

import vectorplot as vp
from vectorplot.drawing.strokes import inside_ring, outside_ring
from vectorplot.geometry import box, prism, regular_polygon
from vectorplot.pictures.sheet_views import sections_of


def plate():
    """40 x 20 x 6, with two square holes of 4, about (8, 6) and (32, 14)."""
    holes = [
        [(x - 2, y - 2, 0), (x + 2, y - 2, 0), (x + 2, y + 2, 0), (x - 2, y + 2, 0)] for x, y in ((8, 6), (32, 14))
    ]
    return vp.Item("plate", prism([(0, 0, 0), (40, 0, 0), (40, 20, 0), (0, 20, 0)], (0, 0, 6), holes=holes))


def hatched(sheet):
    """(x, x) from where to where hatches reach, in each hatched area of the sheet, from left to right, with 1:1."""
    points = np.concatenate([part for _, part in strokes_of(sheet, "hatch")])
    x = np.sort(points[:, 0])
    ends = np.flatnonzero(np.diff(x) > 3.0)
    return np.column_stack([x[np.append(0, ends + 1)], x[np.append(ends, len(x) - 1)]])


@pytest.mark.slow
def test_an_offset_section_goes_through_both_holes():
    one = vp.technical_sheet(plate(), views="front,top", section="y=6", scale="1:1")
    both = vp.technical_sheet(plate(), views="front,top", section="y=6 | x=20 | y=14", scale="1:1")
    for sheet, gaps in ((one, [6.0]), (both, [6.0, 30.0])):
        areas = hatched(sheet)
        areas = areas - areas[0, 0]
        assert len(areas) == len(gaps) + 1
        assert np.allclose(areas[:-1, 1], gaps, atol=1e-6) and np.allclose(areas[1:, 0], np.array(gaps) + 4.0)
    line = np.concatenate([part for _, part in strokes_of(both, "cutting line")])
    top = max(outlines(both)[:2], key=lambda one: float(np.ptp(one[:, 1])))
    assert line[:, 1].min() == pytest.approx(top[0, 1] + 6.0) and line[:, 1].max() == pytest.approx(top[0, 1] + 14.0)
    assert len(strokes_of(both, "cutting ends")) == 4


@pytest.mark.slow
def test_a_half_section_is_hatched_at_the_right_alone_and_has_its_axis():
    sheet = vp.technical_sheet(BRICK, views="front,top", section="half y=10", scale="1:1")
    points = np.concatenate([part for _, part in strokes_of(sheet, "hatch")])
    middle, low = points.min(axis=0)
    assert np.ptp(points, axis=0) == pytest.approx([20.0, 10.0], abs=1e-6)
    whole = outlines(sheet)
    left = whole[np.abs(whole[:, 1, 0] - middle) < 1e-6]
    assert len(left) and np.ptp(left[0], axis=0) == pytest.approx([20.0, 10.0])
    thin = np.concatenate([part for _, part in strokes_of(sheet, "thin")])
    upright = thin[(np.abs(thin[:, 0] - middle) < 1e-6) & (np.abs(thin[:, 1] - low) < 20.0)]
    assert np.ptp(upright[:, 1]) == pytest.approx(18.0, abs=1e-6)
    arrows = [part for _, part in strokes_of(sheet, "cutting ends")]
    assert len(arrows) == 3


@pytest.mark.slow
def test_an_aligned_section_shows_both_arms_in_full():
    """A bar of 20 to the left of an axis, one of 30 at 60 degrees from it: side by side they are 50 long."""
    left = vp.Item("left", box((20, 4, 6)).moved(-20, -2, 0))
    right = vp.Item("right", box((30, 4, 6)).moved(0, -2, 0).turned("z", 60))
    asked = {"views": "front,top", "scale": "1:1"}
    sheet = vp.technical_sheet([left, right], section="aligned z at 0,0 from 180 to 60", **asked)
    areas = np.concatenate([part for _, part in strokes_of(sheet, "hatch")])
    assert np.ptp(areas[:, 0]) == pytest.approx(50.0, abs=1e-6) and np.ptp(areas[:, 1]) == pytest.approx(6.0, abs=1e-6)
    ends = np.array([part for _, part in strokes_of(sheet, "cutting ends") if len(part) == 2])
    ways = np.degrees(np.arctan2(*(ends[:, 1] - ends[:, 0]).T[::-1])) % 360.0
    assert sorted(np.round(ways, 6).tolist()) == [60.0, 180.0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "size", "turn"),
    [
        # Across the corners of a block of 40 x 30 x 12 its face is 50 wide, seen along the diagonal.
        ("3x=4y", (50.0, 12.0), 36.869897645844),
        ("-4y=-3x", (50.0, 12.0), 36.869897645844),
        # From the lower edge at the left to the upper one at the right.
        ("z=0.3x", (30.0, 40.0 * np.hypot(1.0, 0.3)), np.degrees(np.arctan(0.3))),
    ],
)
def test_an_oblique_section_has_its_true_size_and_its_line(section, size, turn):
    block = box((40.0, 30.0, 12.0))
    sheet = vp.technical_sheet(block, views="front,top", section=section, scale="1:1", centre_lines=True)
    areas = np.concatenate([part for _, part in strokes_of(sheet, "hatch")])
    assert sorted(np.ptp(areas, axis=0)) == pytest.approx(sorted(size), abs=2.5)
    cut = np.concatenate([part for _, part in strokes_of(sheet, "cut")])
    assert sorted(np.ptp(cut, axis=0)) == pytest.approx(sorted(size), abs=1e-6)
    ends = np.array([part for _, part in strokes_of(sheet, "cutting ends") if len(part) == 2])
    ways = np.degrees(np.arctan2(*(ends[:, 1] - ends[:, 0]).T[::-1])) % 180.0
    assert ways == pytest.approx([turn, turn])


@pytest.mark.slow
def test_a_plane_across_no_view_has_no_line_but_a_section():
    """The plane through three corners of a cube is cut in an equilateral triangle."""
    sheet = vp.technical_sheet(box((20.0, 20.0, 20.0)), views="front", section="x+y+z=20", scale="1:1")
    assert "cutting line" not in [one.name for one in sheet.layers]
    cut = np.concatenate([part for _, part in strokes_of(sheet, "cut")])
    corners = np.unique(cut.round(6), axis=0)
    apart = np.linalg.norm(corners[:, None] - corners, axis=2)
    assert len(corners) == 3 and apart[np.triu_indices(3, 1)] == pytest.approx([20.0 * 2**0.5] * 3, abs=1e-5)


@pytest.mark.parametrize("axis", "xyz")
def test_halves_of_aligned_sections_are_beside_each_other(axis):
    (section,) = sections_of(
        f"aligned {axis} at 1,2 from 200 to 20", ("front", "top", "left"), np.array([[-9] * 3, [9] * 3])
    )
    assert section.turn_axis == "xyz".index(axis) and len({section.axis, section.across, section.turn_axis}) == 3
    low, high = section.zones
    assert low.high == high.low and (low.turn_deg - high.turn_deg) % 360.0 == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("section", "cause"),
    [
        ("half", "expected x, y or z"),
        ("x+y>3", "expected x, y or z"),
        ("half x+y=3", "expected x, y or z"),
        ("x+y=300", "beside the part"),
        ("y=6 | y=8 | y=14", "planes of one axis with steps"),
        ("y=6 | x=20", "planes of one axis with steps"),
        ("y=6 | x=30 | y=14 | x=20 | y=6", "planes of one axis with steps"),
        ("aligned z at 0,0 from 180", "expected x, y or z"),
        ("half y=60", "beside the part"),
    ],
)
def test_sections_that_cannot_be(section, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.technical_sheet(BRICK, section=section)


@pytest.mark.slow
def test_a_detail_is_so_much_larger_and_inside_of_its_circle():
    sheet = vp.technical_sheet(BRICK, views="front", detail_view="front:40,0,10,4,5:1", scale="1:1")
    rings = sorted(
        (part for _, part in strokes_of(sheet, "thin") if len(part) > 50), key=lambda one: float(np.ptp(one[:, 0]))
    )
    small, large = rings[0], rings[-1]
    assert np.ptp(small[:, 0]) == pytest.approx(8.0) and np.ptp(large[:, 0]) == pytest.approx(40.0)
    middle = large.mean(axis=0)
    inside = [part for _, part in strokes_of(sheet, "contour") if np.hypot(*(part - middle).T).max() < 20.01]
    corner = np.concatenate(inside)
    assert len(corner) and np.hypot(*(corner - middle).T).min() == pytest.approx(0.0, abs=1e-6)
    assert np.hypot(*(corner - middle).T).max() == pytest.approx(20.0, rel=1e-3)
    assert small.mean(axis=0) == pytest.approx(outlines(sheet)[0][1], abs=1e-6)


@pytest.mark.slow
def test_a_detail_without_a_scale_has_the_next_standard_one():
    texts = vp.technical_sheet(BRICK, views="front", detail_view="front:40,0,10,4", scale="1:2", text="real")
    words = {string for one in texts.layers for real in one.texts for string in real.strings}
    assert {"A", "A (1:1)", "1:2"} <= words


@pytest.mark.slow
@pytest.mark.parametrize(("x", "cut"), [(30, True), (10, False)])
def test_a_detail_of_a_half_section_is_of_the_half_that_it_is_in(x, cut):
    told = {"views": "front,top", "section": "half y=10", "scale": "1:1"}
    plain, sheet = (vp.technical_sheet(BRICK, **told, **more) for more in ({}, {"detail_view": f"A:{x},0,10,3"}))
    assert (len(strokes_of(sheet, "hatch")) > len(strokes_of(plain, "hatch"))) is cut


@pytest.mark.slow
def test_a_local_section_is_hatched_in_its_border_alone():
    """Hidden lines of a bore end where it is cut open."""
    bore = regular_polygon(24, 3, centre=(20, 10, 0))
    block = vp.Item("block", prism([(0, 0, 0), (40, 0, 0), (40, 20, 0), (0, 20, 0)], (0, 0, 12), holes=[bore]))
    closed, opened = (
        vp.technical_sheet(block, views="front", scale="1:1", breakout=told) for told in ((), "front:20,10,6,5")
    )
    assert layer(closed, "hatch") is None
    front = outlines(closed)[0]
    middle = front.mean(axis=0)
    hatches = np.concatenate([part for _, part in strokes_of(opened, "hatch")])
    assert np.hypot(*(hatches - middle).T).max() < 5.0 * 1.09
    hidden = np.concatenate([part for _, part in strokes_of(opened, "hidden")])
    assert np.hypot(*(hidden - middle).T).min() > 5.0 * 0.91
    border = [part for _, part in strokes_of(opened, "thin") if len(part) > 20]
    assert border and all((part >= front[0] - 1e-6).all() and (part <= front[1] + 1e-6).all() for part in border)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("told", "cause"),
    [
        ({"detail_view": "front:1,2,3"}, "a view, a point and a radius such as"),
        ({"detail_view": "front:1,2,3,4,5"}, "expected two numbers such as 1:2"),
        ({"detail_view": "back:1,2,3,4"}, "there is no view 'back' on the sheet: front, A"),
        ({"detail_view": "front:1,2,3,-4"}, "a radius"),
        ({"breakout": "A:1,2,3,4"}, "there is no view 'A' on the sheet: front$"),
        ({"breakout": "front:1,2,3,4,5:1"}, "a radius such as"),
    ],
)
def test_circles_that_cannot_be(told, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.technical_sheet(BRICK, views="front", section="y=10", **told)


@pytest.mark.slow
def test_views_stand_where_the_scale_is_the_largest():
    """A long part with a section: below its view it is twice as large as beside it."""
    bar = vp.Item("bar", box((150, 20, 20)))
    sheet = vp.technical_sheet(bar, views="front", section="y=10", page="A4")
    assert sheet.title == "1:1"
    front, seen = outlines(sheet)
    assert seen[1, 1] < front[0, 1] or front[1, 1] < seen[0, 1]


def test_strokes_are_divided_at_a_ring():
    """A segment through a square, one outside of it, a closed stroke around a corner."""
    ring = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    paths = vp.Paths.of_polylines(
        [[(-3, 0.5), (3, 0.5)], [(-3, 2), (3, 2)], [(0, 0), (2, 0), (2, 2), (0, 2)]], closed=[False, False, True]
    )
    inner, outer = inside_ring(paths, ring), outside_ring(paths, ring)
    lengths = [
        [float(np.hypot(*np.diff(part, axis=0).T).sum()) for part in np.split(some.points, some.offsets[1:-1])]
        for some in (inner, outer)
    ]
    assert lengths[0] == pytest.approx([2.0, 1.0, 1.0]) and lengths[1] == pytest.approx([2.0, 2.0, 6.0, 6.0])


@pytest.mark.parametrize(("section", "marks"), [("y=25", False), ("y=4", True)])
def test_a_section_has_no_centre_marks_of_what_it_takes_away(section, marks):
    base = prism([(0, 0, 0), (60, 0, 0), (60, 50, 0), (0, 50, 0)], (0, 0, 12))
    hole = regular_polygon(48, 6, centre=(30, 0, 30), normal=(0, 1, 0))
    ear = prism([(20, 0, 20), (40, 0, 20), (40, 0, 40), (20, 0, 40)], (0, 10, 0), holes=[hole])
    sheet = vp.technical_sheet([base, ear], views="top", section=section, centre_lines=True)
    assert any(name.startswith("centre mark") for name, _ in strokes_of(sheet, "centre")) == marks


def rod(size=1.0):
    """A square rod along x, 600 x 20 x 20, with a step at 500."""
    parts = [((0, 0, 0), (500, 20, 20)), ((500, 5, 5), (100, 10, 10))]
    boxes = [vp.Item(f"rod {k}", box(sides).moved(*at), group="rod") for k, (at, sides) in enumerate(parts)]
    return vp.Scene(tuple(boxes)).scaled(size)


def test_an_interrupted_view_is_as_much_shorter_and_its_measures_are_true():
    chain = vp.dimension((0, 0, 20), (500, 0, 20), (0, 0, 10))
    scene = vp.Scene(rod().items)
    told = {"views": "front", "interrupted": "x=40..460", "scale": "1:1", "page": "A3", "block": False}
    sheet = vp.technical_sheet([scene, chain], **told, dimensions=True, text="real")
    whole = outlines(sheet)
    assert np.ptp(whole[:, :, 0]) == pytest.approx(600 - 420 + 5, abs=1e-6)
    written = [text for layer in sheet.layers for texts in layer.texts for text in texts.strings]
    assert {"500", "600"} <= set(written)
    breaks = [part for _, part in strokes_of(sheet, "thin")]
    assert len(breaks) == 2 and [np.ptp(one[:, 1]) for one in breaks] == pytest.approx([25.0, 25.0])
    left, right = sorted(one[0, 0] - whole[:, :, 0].min() for one in breaks)
    assert (left, right) == pytest.approx((40.0, 45.0))


def test_interruptions_of_a_small_part_in_inches_look_the_same():
    told = {"views": "front,left,iso", "interrupted": "x=40..460", "section": "x=550", "dimensions": True}
    sheets = [vp.technical_sheet(rod(size), unit=unit, **told) for size, unit in ((1.0, "mm"), (0.001, "m"))]
    for one, other in zip(*(outlines(sheet) for sheet in sheets), strict=True):
        assert np.allclose(one, other, atol=2e-3)


def test_what_is_shown_of_an_interrupted_part_in_space_is_apart():
    sheet = vp.technical_sheet(rod(), views="iso", interrupted=["x=40..240", "x=260..460"], scale="1:1", page="A3")
    x = np.concatenate([part for _, part in strokes_of(sheet, "contour")])[:, 0]
    # The rod ends 5 before its widest side.
    long = 600 - 400 + 2 * 5 + 15
    assert np.ptp(x) == pytest.approx(long * np.sqrt(0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("told", "cause"),
    [
        ({"interrupted": "x=4"}, "expected an axis, from and to"),
        ({"interrupted": "x=400..40"}, "inside of the part"),
        ({"interrupted": "x=40..900"}, "x is 0 to 600"),
        ({"interrupted": ["x=40..200", "x=150..300"]}, "x=150..300 is left out twice"),
        ({"interrupted": "x=40..460", "section": "x=100"}, "section A-A: in what is left out"),
        ({"interrupted": "x=40..460", "detail_view": "front:100,0,0,9"}, "detail A: in what is left out"),
        ({"interrupted": "x=40..460", "section": "aligned x at 10,10 from 180 to 45"}, "exclude each other"),
    ],
)
def test_interruptions_that_cannot_be(told, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.technical_sheet(rod(), **told)


def test_a_break_through_nothing_has_no_line():
    ends = [vp.Item(f"end {k}", box((30, 10, 10)).moved(x, 0, 0)) for k, x in enumerate((0, 300))]
    told = {"views": "front", "interrupted": "x=60..270", "scale": "1:1", "page": "A3", "block": False}
    sheet = vp.technical_sheet(ends, **told)
    assert layer(sheet, "thin") is None or not strokes_of(sheet, "thin")
    assert np.ptp(outlines(sheet)[:, :, 0]) == pytest.approx(330 - 210 + 5)


def test_aligned_sections_show_the_centre_lines_in_both_of_their_planes():
    """Axes at 45 degrees, on the hinge, and beside both planes."""
    disc = prism(regular_polygon(64, 30.0), (0, 0, 10))
    axes = [vp.centre_line((x, y, -5), (x, y, 15)) for x, y in ((14, 14), (0, 0), (0, 20))]
    sheet = vp.technical_sheet([disc, *axes], views="top", scale="1:1", section="aligned z at 0,0 from 180 to 45")
    cut = np.concatenate([points for _, points in strokes_of(sheet, "cut")])
    (left, low), (_, high) = cut.min(axis=0), cut.max(axis=0)
    strokes = np.concatenate([points for _, points in strokes_of(sheet, "centre")])
    within = strokes[(low - 5.1 < strokes[:, 1]) & (strokes[:, 1] < high + 5.1)]
    assert (
        np.unique(within[:, 0].round(2)).tolist()
        == np.round([left + 30.0, left + 30.0 + 14.0 * np.sqrt(2.0)], 2).tolist()
    )


def test_sections_leave_parts_whole_that_their_plane_goes_through():
    """A pin in the plane, and one before it, which goes as all else does."""
    pins = [vp.Item(f"pin {k + 1}", box((4, 4, 20)).moved(18, y, -5)) for k, y in enumerate((8, 1))]
    told = {"views": "top", "section": "y=10", "scale": "1:1"}
    for uncut, hatched in (("pin", {"brick cut"}), (None, {"brick cut", "pin 1 cut"})):
        sheet = vp.technical_sheet([BRICK, *pins], **told, uncut=uncut)
        assert {name for name, _ in strokes_of(sheet, "hatch")} == hatched
        # In the top view each pin is 4 high, in the section what is whole 20.
        heights = [(name, round(float(np.ptp(points[:, 1])), 6)) for name, points in strokes_of(sheet, "contour")]
        assert (("pin 1", 20.0) in heights) == (uncut is not None) and [h for n, h in heights if n == "pin 2"] == [4.0]
    with pytest.raises(vp.InputError, match=r"uncut: part 'bolt': expected one of brick, pin 1, pin 2"):
        vp.technical_sheet([BRICK, *pins], **told, uncut=["bolt"])
