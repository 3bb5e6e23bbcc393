from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.arrays import Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.paint import paint
from vectorplot.scene.scene import Item, Material, Scene
from vectorplot.surfaces.families.ellipsoid import Sphere
from vectorplot.surfaces.families.torus import Torus
from vectorplot.visibility.painter.gathering import gathered, side_by_side
from vectorplot.visibility.painter.image_faces import ImageFaces, polygons_of

GLASS = Material("transparent", opacity=0.5)


def squares(places) -> ImageFaces:
    """Squares of side 2 in the image, back to front."""
    corners = np.array([(0, 0), (2, 0), (2, 2), (0, 2)], dtype=np.float64)
    flat = (np.array(places, dtype=np.float64)[:, None] + corners).reshape(-1, 2)
    points = np.concatenate([flat.T, np.zeros((1, len(flat)))])
    return polygons_of(points, np.arange(0, len(flat) + 1, 4), np.arange(len(places)), 1e-9)


def runs(item: Ints) -> int:
    """How many runs of transparent polygons of one item there are."""
    return int(((item >= 0) & (np.append(-2, item[:-1]) != item)).sum())


def test_sheets_side_by_side_stand_together():
    faces = squares([(0, 0), (10, 0), (2, 0), (12, 0), (20, 0), (4, 0)])
    item = np.array([0, 1, 0, 1, -1, 0])
    order = gathered(faces, item, 1e-9)
    assert runs(item[order]) == 2


def test_what_overlaps_keeps_its_order():
    # A part of the first item lies on the second one, another under it.
    faces = squares([(0, 0), (1, 0), (2, 0), (4, 0), (3, 0)])
    item = np.array([0, 1, 0, 0, 1])
    order = gathered(faces, item, 1e-9)
    assert sorted(order) == [0, 1, 2, 3, 4]
    place = np.argsort(order)
    assert place[0] < place[1] < place[2] < place[4] and place[3] < place[4]
    assert runs(item[order]) == 4


def test_opaque_ones_stay_as_they_stand():
    faces = squares([(k, 0) for k in range(0, 60, 3)])
    item = np.full(20, -1)
    assert (gathered(faces, item, 1e-9) == np.arange(20)).all()
    item[[3, 9]] = 0
    order = gathered(faces, item, 1e-9)
    assert runs(item[order]) == 1
    assert (np.diff(order[item[order] < 0]) > 0).all()


@pytest.mark.parametrize("seed", range(12))
def test_random_heaps_show_the_same(seed):
    random = np.random.default_rng(seed)
    faces = squares(random.uniform(0.0, 14.0, (60, 2)))
    item = random.integers(-1, 3, 60)
    order = gathered(faces, item, 1e-9)
    place = np.argsort(order)
    shapes = shapely.polygons(faces.points[:2].T.reshape(60, 4, 2))
    for first in range(60):
        for second in range(first + 1, 60):
            if shapely.area(shapely.intersection(shapes[first], shapes[second])) > 1e-9:
                assert place[first] < place[second]
    assert runs(item[order]) <= runs(item)


def ball(x: float, radius: float) -> Item:
    return Item(f"BALL{x:g}", Sphere(radius, (x, 0.0, 0.0)), "blue", GLASS)


@pytest.mark.slow
@pytest.mark.hard(77)
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
    drawing = paint(scene, Camera(eye, (0.0, 0.0, 0.0), parallel=parallel, height=12.0), tolerance_mm=0.2)
    (fills,) = drawing.layers[0].fills
    clear = np.where(fills.kind == FillKind.GLASS, fills.item, -1)
    assert runs(clear) <= 8


def test_planes_side_by_side_keep_the_order_of_what_overlaps():
    for seed in range(40):
        random = np.random.default_rng(seed)
        places = random.uniform(0.0, 12.0, (60, 2))
        faces = squares(places)
        plane = random.integers(-1, 12, 60)
        order = side_by_side(faces, plane, 1e-9)
        assert sorted(order) == list(range(60))
        place = np.argsort(order)
        over = (np.abs(places[:, None] - places) < 2.0 - 1e-9).all(axis=2)
        first, second = np.nonzero(np.triu(over, 1))
        assert (place[first] < place[second]).all(), seed
        assert runs(plane[order]) <= runs(plane)


@pytest.mark.hard(74)
def test_planes_whose_polygons_do_not_overlap_stand_together_whatever_lies_on_them():
    # Three sheets, one above the other, each of a row of squares that come in turn.
    row = [(2.0 * k, 0.0) for k in range(10)]
    faces = squares([place for place in row for _ in range(3)])
    plane = np.tile(np.arange(3), 10)
    assert runs(plane[side_by_side(faces, plane, 1e-9)]) == 3
