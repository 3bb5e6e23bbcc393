from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from support.fill_samples import fan, flat, shaded

from vectorplot.backends.page import RUN_LENGTH, areas
from vectorplot.backends.svg import SHADE_ERROR, nearly_flat, svg_text
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import SEAM_MM, FillKind, Fills

RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)
SQUARE = [(10, 10), (20, 10), (20, 20), (10, 20)]


def on_page(fills: Fills, width=60.0, height=40.0):
    return areas(fills, width, height)


def rings(found) -> list:
    return [found.microns[a:b].tolist() for a, b in zip(found.offsets[:-1], found.offsets[1:], strict=True)]


def doubled_area(ring) -> int:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, [*ring[1:], ring[0]], strict=True))


def test_polygons_are_turned_counter_clockwise_without_repeated_corners():
    found = on_page(flat([SQUARE[::-1], [*SQUARE, (10.0001, 10.0002)]], [RED, BLUE]))
    assert all(doubled_area(ring) == 2 * 10_000**2 for ring in rings(found))
    assert found.sizes.tolist() == [4, 4] and found.colours[[0, 4]].tolist() == [list(RED), list(BLUE)]


def test_what_has_no_area_no_opacity_or_is_not_on_the_page_is_dropped():
    flats = [[(1, 1), (2, 2), (3, 3)], [(1, 1), (1.0001, 1), (1, 1.0001)], [], [(1, 1)], [(5, 5), (5, 5)]]
    found = on_page(flat([*flats, SQUARE, [(70, 1), (80, 1), (75, 9)]], [RED] * 7))
    assert len(found) == 1
    assert len(on_page(flat([SQUARE], [RED], opacity=0.0))) == 0
    assert len(on_page(Fills.empty())) == 0 and on_page(Fills.empty()).runs.tolist() == [0]


def test_cuts_lie_a_seam_beyond_the_page():
    found = on_page(flat([[(-50, 10), (100, 10), (100, 20), (-50, 20)]], [RED]))
    seam = round(SEAM_MM * 1000)
    assert found.microns[:, 0].min() == -seam and found.microns[:, 0].max() == 60_000 + seam


@given(st.integers(0, 10_000))
def test_clipped_polygons_have_the_area_of_the_intersection(seed):
    rng = np.random.default_rng(seed)
    # Star-shaped, not convex.
    angle = np.sort(rng.uniform(0, 2 * np.pi, 9))
    star = rng.uniform(-20, 80, 2) + rng.uniform(2, 60, (9, 1)) * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    found = on_page(flat([star[:: rng.choice((1, -1))]], [RED]))
    box = shapely.box(-SEAM_MM, -SEAM_MM, 60 + SEAM_MM, 40 + SEAM_MM)
    whole = shapely.Polygon(star)
    if whole.is_valid:
        expected = whole.intersection(box).area
        assert sum(map(doubled_area, rings(found))) / 2e6 == pytest.approx(expected, abs=0.2)


@pytest.mark.parametrize("far", [1e4, 1e9, 1e12, 1e200])
def test_corners_far_away_are_cut_off(far):
    found = on_page(flat([[(10, 10), (far, 10), (far, far), (10, far)], [(-far, 5), (far, 5)]], [RED, BLUE]))
    assert found.microns.min() >= -200 and found.microns.max() <= 60_200
    if far < 1e15:  # beyond, doubles do not say where the sides cross the border
        assert found.sizes[-1] == 2
        assert doubled_area(rings(found)[0]) / 2e6 == pytest.approx(50.15 * 30.15, abs=0.1)


def test_shaded_polygons_become_the_triangles_of_their_fan_in_their_places():
    pentagon = [(10, 10), (20, 8), (30, 15), (25, 25), (12, 22)]
    colours = [RED, GREEN, BLUE, (9, 9, 9), (200, 200, 0)]
    both = Fills.joined(flat([SQUARE], [RED]), shaded([pentagon], [colours]), flat([SQUARE], [BLUE]))
    found = on_page(both)
    assert found.sizes.tolist() == [4, 3, 3, 3, 4] and found.shaded.tolist() == [False, True, True, True, False]
    for k in (1, 2, 3):
        corners = {tuple(p) for p in rings(found)[k]}
        assert corners == {tuple(1000 * np.array(pentagon[i])) for i in (0, k, k + 1)}


def test_clipping_keeps_the_linear_map_of_colours():
    triangle, colours = [(-30, -10), (100, 5), (20, 90)], [(0, 40, 250), (250, 0, 10), (20, 230, 0)]
    found = on_page(shaded([triangle], [colours]))
    assert set(found.sizes.tolist()) == {3}
    slopes = np.linalg.solve(np.diff(triangle, axis=0), np.diff(colours, axis=0))
    expected = np.array(colours[0]) + (found.microns / 1000.0 - triangle[0]) @ slopes
    assert np.abs(expected - found.colours).max() <= 0.51
    box = shapely.box(-SEAM_MM, -SEAM_MM, 60 + SEAM_MM, 40 + SEAM_MM)
    assert sum(map(doubled_area, rings(found))) / 2e6 == pytest.approx(
        shapely.Polygon(triangle).intersection(box).area, abs=0.1
    )


def test_triangles_of_nearly_one_colour_and_tiny_ones_are_flat():
    level = int(2 * SHADE_ERROR)
    near, apart = (
        [(100, 100, 100), (100 + level, 100, 100), (100, 100, 98)],
        [(100, 0, 0), (101 + level, 0, 0), (100, 0, 0)],
    )
    triangle = SQUARE[:3]
    tiny = [(1, 1), (1.05, 1), (1, 1.05)]
    found = nearly_flat(on_page(shaded([triangle, triangle, tiny], [near, apart, [RED, GREEN, BLUE]])))
    assert found.shaded.tolist() == [False, True, False]
    assert found.colours[0].tolist() == [102, 100, 99]


def test_runs_hold_neighbours_of_one_colour_only_if_opaque():
    fills = flat([SQUARE] * 8, [RED, RED, BLUE, BLUE, RED, RED, RED, RED], opacity=[1, 1, 1, 1, 1, 0.5, 0.5, 1])
    assert on_page(fills).runs.tolist() == [0, 2, 4, 5, 6, 7, 8]
    line = flat([SQUARE, SQUARE[:2], SQUARE[:2], SQUARE], [RED] * 4)
    assert on_page(line).runs.tolist() == [0, 1, 3, 4]
    many = on_page(flat([SQUARE] * (2 * RUN_LENGTH + 5), [RED] * (2 * RUN_LENGTH + 5)))
    assert np.diff(many.runs).tolist() == [RUN_LENGTH, RUN_LENGTH, 5]


def test_lines_have_the_mean_of_their_colours():
    found = on_page(shaded([[(5, 5), (20, 30)]], [[(10, 20, 30), (20, 40, 61)]]))
    assert found.colours.tolist() == [[15, 30, 46]] * 2 and not found.shaded.any()


def test_neighbours_keep_common_corners():
    triangles = fan((30, 20), 35, 90)
    found = on_page(flat(list(triangles), [(k, 0, 0) for k in range(90)]))
    places = {
        tuple(corner) for ring in rings(found) for corner in ring if 0 < corner[0] < 60_000 and 0 < corner[1] < 40_000
    }
    assert places == {(30_000, 20_000)} | {
        tuple(np.rint(1000 * p).astype(int)) for p in triangles[:, 1] if 0 < p[0] < 60 and 0 < p[1] < 40
    }


def test_blank_polygons_have_no_line_around_them():
    square = np.array([[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0]])
    points, colours = np.concatenate([square, square + 15.0]), np.array([[9, 9, 9], [9, 9, 9]], dtype=np.uint8)
    fills = Fills.flat(points, np.array([0, 4, 8]), colours, kind=[FillKind.BACKGROUND, FillKind.FACE])
    found = areas(fills, 60.0, 60.0)
    assert found.bare.tolist() == [True, False]
    assert len(found.runs) == 3
    text = svg_text(Drawing(60.0, 60.0, (Layer("fills", Pen(), (fills,)),)))
    assert text.count('stroke="none"') == 1
