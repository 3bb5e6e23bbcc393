from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from itertools import combinations, pairwise

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.ndimage import median_filter
from support.fill_samples import colour_at, fan, flat, page_of, pictures, shaded

import vectorplot as vp
from vectorplot.backends.page import SIDE_BY_SIDE_MICRONS, areas, beside_a_side, groups_of, outline
from vectorplot.backends.svg import svg_bytes, svg_text
from vectorplot.drawing.fills import FillKind

DARK, BLUE = (16, 20, 24), (0, 0, 255)
SQUARE = np.array([(5.0, 5.0), (15.0, 5.0), (15.0, 15.0), (5.0, 15.0)])


def moved(polygon, dx, dy) -> np.ndarray:
    return polygon + np.array((dx, dy))


BESIDE, OVER = moved(SQUARE, 10.0, 0.0), moved(SQUARE, 4.0, 3.0)


def groups(polygons, **other) -> list[int]:
    return areas(flat(polygons, [DARK] * len(polygons), **{"opacity": 0.5, **other}), 60.0, 40.0).group.tolist()


def inner(picture, middle, radius, dpi=300):
    """The pixels of a disc on a page of 40 mm height."""
    row, column = np.indices(picture.shape[:2])
    x, y = (column + 0.5) / dpi * 25.4, 40.0 - (row + 0.5) / dpi * 25.4
    return picture[np.hypot(x - middle[0], y - middle[1]) < radius]


def test_neighbours_of_one_opacity_share_a_group():
    assert groups([SQUARE, BESIDE]) == [0, 0]
    assert groups([SQUARE, BESIDE], kind=[FillKind.FACE, FillKind.GLASS]) == [0, 0]
    assert groups([SQUARE, BESIDE], opacity=[0.5, 0.4]) == [-1, -1]
    assert groups([SQUARE, BESIDE], opacity=1.0) == [-1, -1]
    assert groups([SQUARE, BESIDE], kind=FillKind.BACKGROUND) == [-1, -1]
    assert groups([SQUARE, moved(BESIDE, 5.0, 0.0)]) == [-1, -1]  # apart
    assert groups([SQUARE, SQUARE[:2], BESIDE]) == [-1, -1, -1]  # a line between them


def test_what_lies_beside_another_item_goes_on_under_it():
    found = areas(flat([SQUARE, BESIDE], [DARK] * 2, opacity=0.5, item=[0, 1]), 60.0, 40.0)
    # All around what is clipped, and beside it of what is not.
    assert (found.group == 0).all() and found.fringe.tolist() == [True] * 5 + [False] * 2
    assert found.part.tolist() == [-1] * 6 + [0]
    corners, _ = found.outline(0, len(found))
    assert corners.min(axis=0).tolist() == [5000, 5000] and corners.max(axis=0).tolist() == [25000, 15000]
    corners, _ = found.outline(*found.part_ends[0])
    assert corners.min(axis=0).tolist() == [15000, 5000]


def test_an_item_that_overlaps_another_one_is_not_cut():
    # Of three in a row the second one overlaps the one of the other item.
    row = [OVER, moved(SQUARE, 30.0, 0.0), moved(SQUARE, 14.0, 3.0), moved(SQUARE, 40.0, 0.0)]
    assert groups([SQUARE, BESIDE, *row[1:], OVER], item=[0, 0, 1, 1, 1, 1])[2:] == [1, 1, 1, 1]


def test_a_polygon_over_another_one_begins_a_new_group():
    assert groups([SQUARE, OVER]) == [-1, -1]
    front = [moved(SQUARE, 1.0, 1.0), moved(BESIDE, 1.0, 1.0)]
    assert groups([SQUARE, BESIDE, *front]) == [0, 0, 1, 1]
    assert groups([SQUARE, BESIDE, OVER, moved(OVER, 0.0, 10.0)]) == [0, 0, 1, 1]


def test_polygons_that_cross_themselves_are_in_none_and_those_cut_open_to_a_hole_are():
    crossing = [(5, 15), (15, 25), (15, 15), (5, 24)]
    assert groups([SQUARE, crossing, BESIDE]) == [-1, -1, -1]
    hole = [(0, 0), (20, 0), (20, 20), (0, 20), (0, 0), (5, 5), (5, 15), (15, 15), (15, 5), (5, 5)]
    assert groups([hole, SQUARE]) == [0, 0]


@pytest.mark.slow
def test_heaps_are_left_alone_in_time():
    rng = np.random.default_rng(1)
    assert groups(list(SQUARE + rng.uniform(-4.0, 4.0, (20_000, 1, 2)))) == [-1] * 20_000


@pytest.mark.slow
@example(18)
@example(3966)
@given(st.integers(0, 10_000))
def test_polygons_of_a_group_overlap_by_no_more_than_a_strip_that_is_not_seen(seed):
    rng = np.random.default_rng(seed)
    corners = rng.integers(0, 12, (40, 3, 2)) * 2.0
    found = areas(flat(list(corners), [DARK] * 40, opacity=0.5, item=rng.integers(0, 2, 40)), 60.0, 40.0)
    shapes = [shapely.Polygon(found.microns[a:b]) for a, b in pairwise(found.offsets)]
    for number, (first, last) in enumerate(found.group_ends.tolist()):
        assert (found.group[first:last] == number).all() and last - first > 1
        inside = [shapes[k] for k in range(first, last) if not found.fringe[k]]
        common = shapely.intersection(*np.array(list(combinations(inside, 2))).T)
        assert shapely.is_empty(shapely.buffer(common, -SIDE_BY_SIDE_MICRONS)).all()
        united = shapely.union_all(inside)
        corners, offsets = found.outline(first, last)
        rings = [shapely.Polygon(corners[a:b]) for a, b in pairwise(offsets)]
        # All corners are even: no ring of a border crosses another one, so that holes count as holes.
        together = rings[0]
        for ring in rings[1:]:
            together = together.symmetric_difference(ring)
        # What is narrow is filled or left out: of very small groups that counts.
        assert shapely.is_empty(shapely.buffer(united.symmetric_difference(together), -SIDE_BY_SIDE_MICRONS))
        assert together.area == pytest.approx(united.area, rel=1e-3, abs=1e3 * SIDE_BY_SIDE_MICRONS)
    assert (found.group >= 0).sum() == np.diff(found.group_ends, axis=1).sum()


def test_the_outline_of_a_ring_has_its_hole():
    outer, inside = SQUARE * 3000.0, SQUARE * 1000.0 + 20_000.0
    strips = [np.array([outer[k], outer[k - 3], inside[k - 3], inside[k]]) for k in range(4)]
    corners, offsets = outline(np.concatenate(strips).astype(np.int64), np.arange(0, 17, 4))
    assert len(offsets) == 3
    assert {tuple(p) for p in corners} == {tuple(p) for p in (*outer, *inside)}


def test_none_of_nothing():
    none = np.zeros(0, dtype=np.intp)
    assert groups_of(none.reshape(0, 2), np.zeros(1, dtype=np.intp), none, none).shape == (0,)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["flat", "shaded"])
def test_no_seam_between_transparent_neighbours(kind, tmp_path):
    triangles = list(fan((30.0, 20.0), 15.0, 97))
    if kind == "shaded":
        fills = shaded(triangles, [[(10, 10, 10), (30, 10, 25), (25, 40, 10)]] * 97, opacity=0.5)
    else:
        fills = flat(triangles, [(DARK[0] + k % 2, *DARK[1:]) for k in range(97)], opacity=0.5)
    for name, picture in pictures(page_of(fills), tmp_path).items():
        seen = inner(picture, (30.0, 20.0), 14.0)
        low, high = (132, 150) if kind == "shaded" else (134, 141)
        assert low - 3 <= seen.min() and seen.max() <= high + 3, (name, seen.min(), seen.max())


@pytest.mark.slow
def test_a_transparent_ball_of_smooth_facets_has_no_seams(tmp_path):
    source = (
        "page 40x40 margin 5\ncamera eye 0 -20 4 target 0 0 0\nlight SUN direction -4 -6 7\n"
        "BALL green transparent opacity 0.5 surface sphere 1.1\n"
    )
    (tmp_path / "ball.scene").write_text(source)
    ball = vp.paint(vp.read(tmp_path / "ball.scene"), tolerance_mm=0.05)
    for name, seen in pictures(ball, tmp_path, formats=("svg", "pdf", "png")).items():
        smoothed = median_filter(seen, (5, 5, 1))[2:-2, 2:-2]
        apart = np.abs(seen[2:-2, 2:-2] - smoothed).max(axis=2)
        assert np.median(inner(smoothed, (20.0, 20.0), 12.0)) < 230, "the ball is there"
        ball = inner(np.pad(apart, 2), (20.0, 20.0), 12.0)
        assert ball.max() <= 12 and (ball > 4).mean() < 2e-3, (name, ball.max(), (ball > 4).mean())


@pytest.mark.slow
def test_panes_of_one_item_over_each_other_blend_twice(tmp_path):
    halves = [SQUARE, BESIDE, moved(SQUARE, 4.0, 3.0), moved(BESIDE, 4.0, 3.0)]
    for name, picture in pictures(
        page_of(flat(halves, [BLUE] * 4, opacity=0.5, item=0), items=("g",)), tmp_path
    ).items():
        for place, red in (((6, 6), 128), ((16, 6), 128), ((12, 10), 64), ((17, 10), 64), ((27, 17), 128)):
            seen = colour_at(picture, *place, 40)
            assert abs(seen[0] - red) <= 2 and seen[2] == 255, (name, place, seen)
        # The line along the common side is neither seen through nor blended twice, and the outline does not grow.
        row = picture[int((40 - 6.5) / 25.4 * 300), :, 0]
        assert np.abs(row[62:294] - 128).max() <= 2, name
        assert (row < 192).sum() == pytest.approx(20.0 / 25.4 * 300, abs=1.5), name


def test_svg_groups_are_clipped_to_their_outlines():
    drawing = page_of(flat([SQUARE, BESIDE, OVER], [DARK, BLUE, DARK], opacity=0.25))
    text = svg_text(drawing)
    root = ET.fromstring(svg_bytes(drawing))
    name = "{http://www.w3.org/2000/svg}"
    (group,) = [node for node in root.iter(f"{name}g") if node.get("opacity")]
    (clip,) = root.iter(f"{name}clipPath")
    assert group.get("opacity") == "0.25" and group.get("clip-path") == f"url(#{clip.get('id')})"
    assert [path.get("stroke") for path in group] == ["#101418", "#0000ff"]
    assert len(re.findall("fill-opacity", text)) == 1 and "\7" not in text


def test_convex_polygons_beside_a_side_are_told_from_others():
    polygons = [SQUARE, BESIDE, OVER, moved(SQUARE, 0.0, 30.0), [(5, 5), (15, 5), (7, 7), (5, 15)]]
    microns = np.concatenate(polygons).astype(np.int64)
    offsets = np.array([0, 4, 8, 12, 16, 20])
    one, other = np.array([0, 0, 0, 4]), np.array([1, 2, 3, 3])
    assert beside_a_side(microns, offsets, one, other).tolist() == [True, False, True, False]
