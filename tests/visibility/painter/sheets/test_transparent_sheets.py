"""Transparent polygons in sheets."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.effort import several

from vectorplot.arrays import Ints
from vectorplot.backends.page import page_marks
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.visibility.painter.image_faces import ImageFaces, polygons_of
from vectorplot.visibility.painter.transparent_sheets import in_sheets

GLASS = Material("transparent", opacity=0.5)
WIDTH = 1e-3


def squares(places) -> ImageFaces:
    """Squares of side 2 in the image, back to front."""
    corners = np.array([(0, 0), (2, 0), (2, 2), (0, 2)], dtype=np.float64)
    flat = (np.array(places, dtype=np.float64)[:, None] + corners).reshape(-1, 2)
    points = np.concatenate([flat.T, np.zeros((1, len(flat)))])
    return polygons_of(points, np.arange(0, len(flat) + 1, 4), np.arange(len(places)), 1e-9)


def sheets(faces: ImageFaces, item: Ints, opacity=0.5) -> ImageFaces:
    return in_sheets(faces, item, item, np.broadcast_to(opacity, len(item)), WIDTH, 1e-9).faces


def shapes_of(faces: ImageFaces) -> np.ndarray:
    return np.array(
        [shapely.Polygon(faces.points[:2, a:b].T) for a, b in zip(faces.offsets, faces.offsets[1:], strict=False)]
    )


def runs(item: Ints) -> int:
    """How many runs of transparent polygons of one item there are."""
    return int(((item >= 0) & (np.append(-2, item[:-1]) != item)).sum())


def test_sheets_side_by_side_stand_together():
    faces = squares([(0, 0), (10, 0), (2, 0), (12, 0), (20, 0), (4, 0)])
    item = np.array([0, 1, 0, 1, -1, 0])
    assert runs(item[sheets(faces, item).source]) == 2


def test_without_transparent_ones_nothing_changes():
    faces = squares([(k, 0) for k in range(0, 60, 3)])
    assert sheets(faces, np.full(20, -1)) is faces


def test_opaque_ones_stay_as_they_stand():
    faces = squares([(k, 0) for k in range(0, 60, 3)])
    item = np.full(20, -1)
    item[[3, 9]] = 0
    found = sheets(faces, item)
    assert runs(item[found.source]) == 1
    assert (np.diff(found.source[item[found.source] < 0]) > 0).all()


def test_items_in_a_circle_make_common_sheets():
    # The first item lies under the second one, and on it: both sheets hold parts of both.
    faces = squares([(0, 0), (1, 0), (6, 0), (7, 0)])
    found = sheets(faces, np.array([0, 1, 1, 0]))
    shapes = shapes_of(found)
    covered = shapely.union_all(shapes).area
    under = np.cumsum(shapely.area(shapes)) <= covered + WIDTH
    assert covered == pytest.approx(12.0) and shapely.area(shapes).sum() == pytest.approx(16.0)
    assert shapely.union_all(shapes[under]).area == pytest.approx(covered)
    assert set(found.source[~under].tolist()) == {1, 3}


def test_the_most_transparent_one_is_cut_where_others_end():
    faces = squares([(0, 0), (1, 0), (2, 0), (6, 0), (7, 0)])
    item, opacity = np.array([0, 1, 0, 1, 0]), np.array([0.2, 0.7, 0.2, 0.7, 0.2])
    found = sheets(faces, item, opacity)
    assert runs(item[found.source]) == 3
    assert (item[found.source] == 1).sum() == 2
    shapes = shapes_of(found)
    assert shapely.area(shapes).sum() == pytest.approx(20.0)
    middle = np.flatnonzero(item[found.source] == 1)
    front = shapely.union_all(shapes[middle[-1] + 1 :])
    assert front.area == pytest.approx(4.0), "what lies on the other item, and no more"


@pytest.mark.spread
@pytest.mark.parametrize("opacity", [(0.5, 0.5, 0.5), (0.2, 0.5, 0.8), (0.5, 0.5, 0.8)])
@pytest.mark.parametrize("seed", range(several(4, long=24)))
def test_random_heaps_show_the_same(seed, opacity):
    random = np.random.default_rng(seed)
    faces = squares(random.uniform(0.0, 10.0, (40, 2)))
    item = random.integers(-1, 3, 40)
    found = sheets(faces, item, np.where(item < 0, 1.0, np.take(opacity, item)))
    before, after = shapes_of(faces), shapes_of(found)
    borders = shapely.boundary(after)
    # Everywhere the same polygons lie on one another in the same order.
    for x, y in random.uniform(0.0, 12.0, (400, 2)):
        point = shapely.Point(x, y)
        if shapely.distance(borders, point).min() > 3 * WIDTH:
            old = np.flatnonzero(shapely.contains(before, point))
            new = found.source[np.flatnonzero(shapely.contains(after, point))]
            assert old.tolist() == new.tolist(), (x, y)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_where_sheets_take_too_much_work_what_is_left_shows_the_same_polygon_by_polygon(seed):
    random = np.random.default_rng(seed)
    faces = squares(random.uniform(0.0, 5.0, (40, 2)))
    item = random.integers(0, 3, 40)
    opacity = np.full(40, 0.5)
    found = in_sheets(faces, item, item, opacity, WIDTH, 1e-9, most=400)
    whole = in_sheets(faces, item, item, opacity, WIDTH, 1e-9)
    assert len(found.single) and set(found.single.tolist()) <= {0, 1, 2} and not len(whole.single)
    before, after = shapes_of(faces), shapes_of(found.faces)
    borders = shapely.boundary(after)
    for x, y in random.uniform(0.0, 7.0, (200, 2)):
        point = shapely.Point(x, y)
        if shapely.distance(borders, point).min() > 3 * WIDTH:
            old = np.flatnonzero(shapely.contains(before, point))
            new = found.faces.source[np.flatnonzero(shapely.contains(after, point))]
            assert old.tolist() == new.tolist(), (x, y)


@pytest.mark.parametrize("kind", ["one item", "items"])
def test_plates_that_lie_on_one_another_are_not_cut(kind):
    random = np.random.default_rng(5)
    count, glass = 60, Material("transparent", opacity=0.3)
    corners = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) + random.uniform(-0.5, 0.5, (count, 1, 2))
    points = np.concatenate([corners, np.broadcast_to(0.05 * np.arange(count)[:, None, None], (count, 4, 1))], axis=2)
    square = [(0, 1, 2, 3)]
    plates = [Item(f"P{k}", Mesh.from_polygons(four, square), material=glass) for k, four in enumerate(points)]
    every = Mesh.from_polygons(points.reshape(-1, 3), np.arange(4 * count).reshape(-1, 4).tolist())
    items = {"items": plates, "one item": [Item("all", every, material=glass)]}[kind]
    drawing = paint(Scene(tuple(items)), Camera((4.0, 3.0, 9.0)))
    assert sum(len(mark) for layer in drawing.layers for mark in layer.fills) == count


def ball(x: float, radius: float, opacity: float = 0.5) -> Item:
    return Item(f"BALL{x:g}", Sphere(radius, (x, 0.0, 0.0)), "blue", Material("transparent", opacity=opacity))


@pytest.mark.slow
@pytest.mark.hard(77)
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("eye", [(10.0, -20.0, 8.0), (0.0, -20.0, 0.0), (18.0, -3.0, 2.0), (-3.0, 2.0, 20.0)])
@pytest.mark.parametrize("kind", ["apart", "one in the other", "ring about a ball", "with an opaque one"])
def test_transparent_smooth_items_come_in_few_sheets(kind, eye, parallel):
    items = {
        "apart": [ball(0.0, 2.0), ball(4.5, 1.5)],
        "one in the other": [ball(0.0, 2.0), ball(0.3, 1.0)],
        "ring about a ball": [ball(0.0, 1.5), Item("RING", Torus(4.0, 1.0), "red", GLASS)],
        "with an opaque one": [ball(0.0, 2.0), Item("RING", Torus(4.0, 1.0), "red"), ball(6.0, 1.0)],
    }[kind]
    scene = Scene(tuple(items))
    drawing = paint(scene, Camera(eye, (0.0, 0.0, 0.0), parallel=parallel, height=12.0), tolerance_mm=1.0)
    (fills,) = drawing.layers[0].fills
    clear = np.where(fills.kind == FillKind.GLASS, fills.item, -1)
    assert runs(clear) <= 8


BODIES = {
    "balls": lambda one, two: [ball(0.0, 2.0, one), ball(1.5, 1.8, two)],
    "ball and ring": lambda one, two: [
        ball(0.0, 2.0, one),
        Item("RING", Torus(2.0, 0.7), "orange", Material("transparent", opacity=two)),
    ],
    "ellipsoids": lambda one, two: [
        Item("LONG", Ellipsoid((3.0, 1.0, 1.0)), "green", Material("transparent", opacity=one)),
        Item("HIGH", Ellipsoid((1.0, 1.2, 2.5)), "pink", Material("transparent", opacity=two)),
    ],
}


@pytest.mark.slow
@pytest.mark.hard(77)
@pytest.mark.spread
@pytest.mark.parametrize("opacities", [(0.5, 0.5), (0.3, 0.6), (0.8, 0.2)])
@pytest.mark.parametrize("eye", [(10.0, -20.0, 8.0), (18.0, -3.0, 2.0)])
@pytest.mark.parametrize("kind", BODIES)
def test_smooth_items_that_pierce_one_another_are_blended_in_few_groups(kind, eye, opacities):
    tolerance_mm = 1.0
    drawing = paint(Scene(tuple(BODIES[kind](*opacities))), Camera(eye, (0.0, 0.0, 0.0)), tolerance_mm=tolerance_mm)
    (areas,) = [part for ink in page_marks(drawing).inks for part in ink.parts]
    # As many as there are layers one over the other, more where the most transparent one is cut, and crumbs.
    assert len(areas.group_ends) <= (12 if len(set(opacities)) > 1 else 8)
    shapes = shapely.polygons([shapely.linearrings(areas.microns[a:b]) for a, b in pairwise(areas.offsets)])
    area, crumb = shapely.area(shapes), areas.group < 0
    assert area[crumb].sum() < 1e-3 * area.sum()
    # Outlines of facets fold by less than these may be off: there two lie over one another.
    assert (2.0 * area < 0.2 * 1e3 * tolerance_mm * shapely.length(shapes))[crumb].all()
