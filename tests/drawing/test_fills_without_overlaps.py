"""What is seen of filled polygons: the same picture without overlaps."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.hard_shapes import HARD_SHAPES
from support.paths import DATA
from support.strewn import STREWN

import vectorplot as vp
from vectorplot.drawing.fill_visibility import in_space, visible_fills
from vectorplot.drawing.fills import Fills
from vectorplot.geometry.regions import polygons_of
from vectorplot.pictures.paint import paint

FLAT = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])


def squares(*places: tuple[float, float, float], opacity: float | list[float] = 1.0) -> Fills:
    """Squares x, y, side, each in a colour of its own."""
    ring = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    points = np.concatenate([ring * side + (x, y) for x, y, side in places])
    colours = np.array([[10 * k, 0, 0] for k in range(len(places))], dtype=np.uint8)
    return Fills.flat(
        points, np.arange(0, 4 * len(places) + 1, 4), colours, item=np.arange(len(places)), opacity=opacity
    )


def areas(fills: Fills) -> dict[int, float]:
    area = shapely.area(polygons_of(fills.points.T, fills.offsets))
    return {int(k): float(area[fills.item == k].sum()) for k in np.unique(fills.item)}


def colours_at(fills: Fills, points: np.ndarray) -> np.ndarray:
    """The colour of the last polygon that contains each point, white where none does."""
    found = np.full((len(points), 3), 255, dtype=np.uint8)
    polygons = polygons_of(fills.points.T, fills.offsets)
    inside, which = shapely.STRtree(polygons).query(shapely.points(points), predicate="within")
    order = np.lexsort((which, inside))
    found[inside[order]] = fills.colours[fills.offsets[:-1]][which[order]]
    return found


def test_what_is_painted_over_is_taken_away() -> None:
    seen = visible_fills(squares((0, 0, 4), (2, 2, 4)), FLAT)
    assert areas(seen) == pytest.approx({0: 12.0, 1: 16.0})


def test_what_is_hidden_vanishes_and_a_hole_is_cut_open() -> None:
    seen = visible_fills(squares((1, 1, 1), (0, 0, 4), (1, 1, 2)), FLAT)
    assert areas(seen) == pytest.approx({1: 12.0, 2: 4.0})
    assert shapely.is_valid(polygons_of(seen.points.T, seen.offsets)).all()


def test_glass_takes_nothing_away() -> None:
    seen = visible_fills(squares((0, 0, 4), (2, 2, 4), opacity=[1.0, 0.5]), FLAT)
    assert areas(seen) == pytest.approx({0: 16.0, 1: 16.0})
    assert seen.opacity[seen.item == 1].tolist() == [0.5]


def test_neighbours_lose_nothing_to_each_other() -> None:
    seen = visible_fills(squares((0, 0, 1), (1, 0, 1), (2, 0, 1)), FLAT)
    assert areas(seen) == pytest.approx({0: 1.0, 1: 1.0, 2: 1.0})
    assert len(seen) == 3


def test_nothing_and_lines_only() -> None:
    assert len(visible_fills(Fills.empty(), FLAT)) == 0
    line = Fills.flat(np.array([[0.0, 0], [1, 1]]), np.array([0, 2]), np.zeros((1, 3), dtype=np.uint8))
    assert len(visible_fills(line, FLAT)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["town", "table", "interpenetrating", "patterns"])
def test_the_picture_stays_the_same_and_nothing_overlaps(name: str) -> None:
    assert_same_picture(paint(vp.read(DATA / f"{name}.scene"), smooth=False))


@pytest.mark.spread
@pytest.mark.parametrize("kind", STREWN)
@pytest.mark.parametrize("seed", range(3))
def test_strewn_faces_show_the_same_picture(kind: str, seed: int) -> None:
    scene = STREWN[kind](np.random.default_rng(seed))
    assert_same_picture(paint(scene, camera_of(scene, seed), smooth=False))


@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_hard_shapes_show_the_same_picture(name: str) -> None:
    assert_same_picture(paint(HARD_SHAPES[name], camera_of(HARD_SHAPES[name], 4), smooth=False))


def camera_of(scene: vp.Scene, seed: int) -> vp.Camera:
    """Somewhere around the scene, at random; every other one parallel."""
    random = np.random.default_rng(seed)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    direction = random.normal(size=3)
    eye = middle + 1.5 * size * direction / np.linalg.norm(direction)
    return vp.Camera(tuple(eye), tuple(middle), parallel=seed % 2 == 1)


def assert_same_picture(painted: vp.Drawing) -> None:
    before = painted.layers[0].fills[0]
    after = visible_fills(before, painted.page_from_world)
    points = np.random.default_rng(3).uniform([0, 0], [painted.width_mm, painted.height_mm], (4000, 2))
    edges = shapely.linearrings(before.points, indices=np.repeat(np.arange(len(before)), np.diff(before.offsets)))
    _, away = shapely.STRtree(edges).query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    points = points[away > 1e-3]
    assert np.array_equal(colours_at(before, points), colours_at(after, points))
    opaque = after.take(np.flatnonzero(after.opacity >= 1.0))
    polygons = polygons_of(opaque.points.T, opaque.offsets)
    assert shapely.area(polygons).sum() == pytest.approx(shapely.union_all(polygons, grid_size=1e-4).area, rel=1e-5)
    flat = np.c_[after.points3d, np.ones(len(after.points3d))] @ painted.page_from_world.T
    assert np.abs(flat[:, :2] / flat[:, 3:] - after.points).max() < 1e-9


def test_sides_that_run_out_and_back_again_are_no_obstacle() -> None:
    spike = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [6.0, 6.0], [4.0, 4.0], [0.0, 4.0]])
    square = np.array([[2.0, 2.0], [7.0, 2.0], [7.0, 7.0], [2.0, 7.0]])
    colours = np.array([[0, 0, 0], [10, 0, 0]], dtype=np.uint8)
    for first, second in ((spike, square), (square, spike)):
        offsets = np.array([0, len(first), len(first) + len(second)])
        fills = Fills.flat(np.concatenate([first, second]), offsets, colours, item=np.arange(2))
        seen = visible_fills(fills, FLAT)
        assert sum(areas(seen).values()) == pytest.approx(37.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["mirror", "patterns", "shadows", "table"])
def test_effects_leave_regions_that_do_not_overlap(name: str) -> None:
    seen = paint(vp.read(DATA / f"{name}.scene"), fills="visible").layers[0].fills[0]
    opaque = seen.take(np.flatnonzero((seen.opacity == 1.0) & (np.diff(seen.offsets) > 2)))
    polygons = polygons_of(opaque.points.T, opaque.offsets)
    assert shapely.union_all(polygons, grid_size=1e-5).area == pytest.approx(shapely.area(polygons).sum(), rel=1e-5)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-7, 0.3, 1.0])
def test_places_in_space_of_what_is_seen_edge_on_are_apart_as_on_the_page(tilt: float) -> None:
    """From the edge to the front: where a plane says nothing of a place, the border of its polygon does."""
    flat = np.array([(10.0, 5.0), (30.0, 5.0), (30.0, 5.0 + 8.0 * tilt), (10.0, 5.0 + 8.0 * tilt)])
    space = np.column_stack((flat, (0.0, 0.0, 8.0, 8.0)))
    fills = Fills.flat(flat, np.array([0, 4]), np.zeros((1, 3), dtype=np.uint8), points3d=space)
    places = np.column_stack((np.linspace(10.0, 30.0, 7), np.full(7, 5.0 + 4.0 * tilt)))
    found = in_space(fills, places, np.zeros(7, dtype=np.intp), np.eye(4))
    assert np.abs(found[:, :2] - places).max() < 1e-6
    assert -1e-9 <= found[:, 2].min() and found[:, 2].max() <= 8.0 + 1e-9
