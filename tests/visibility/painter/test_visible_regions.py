"""Visible regions against rays, and as areas."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.painted import NEAR_EDGE, SAME_DEPTH, heights_on, nearest, sample_points
from support.strewn import STREWN

from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Item, Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, hard_shapes, random_convex_solids, rotated_boxes, scene_of
from vectorplot.visibility.painter.order import painters_order
from vectorplot.visibility.painter.visible_regions import visible_regions

SHAPES = hard_shapes()


def polygons_of(regions):
    return np.array([shapely.Polygon(regions.points[:2, a:b].T) for a, b in pairwise(regions.offsets)], dtype=object)


def assert_right(scene, camera, samples=300):
    view = look(scene, camera)
    painted = painters_order(view)
    regions = visible_regions(view, painted)
    polygons = polygons_of(regions)
    assert shapely.is_valid(polygons).all()
    x, y = sample_points(view, samples)
    truth, sure = nearest(view, x, y)
    points = shapely.points(x, y)
    tree = shapely.STRtree(polygons)
    sure[tree.query(shapely.buffer(points, NEAR_EDGE), predicate="overlaps")[0]] = False
    point, region = tree.query(points, predicate="within")
    found = np.bincount(point, minlength=samples)
    empty = truth == (-np.inf if view.eye is None else 0.0)
    assert (found == ~empty)[sure].all(), "one region over every point where something is seen"
    source = np.full(samples, -1)
    source[point] = regions.source[region]
    shown = sure & ~empty
    mine = heights_on(view, source, x, y)
    assert (np.abs(mine[shown] - truth[shown]) <= SAME_DEPTH * np.maximum(np.abs(truth[shown]), 0.1)).all()
    assert sure.sum() > 0.6 * samples
    return regions, polygons, painted


def camera_of(scene, seed):
    random = np.random.default_rng(seed)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    direction = random.normal(size=3)
    return Camera(
        tuple(middle + 1.5 * size * direction / np.linalg.norm(direction)), tuple(middle), parallel=seed % 2 == 1
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", STREWN)
@pytest.mark.parametrize("seed", range(5))
def test_every_point_shows_the_nearest_face_once(kind, seed):
    scene = STREWN[kind](np.random.default_rng(seed))
    assert_right(scene, camera_of(scene, seed))


@pytest.mark.parametrize("name", SHAPES)
def test_hard_shapes(name):
    assert_right(SHAPES[name], camera_of(SHAPES[name], 4), 200)


@pytest.mark.parametrize("seed", range(4))
def test_regions_fill_what_the_faces_fill(seed):
    for scene in (random_convex_solids(14, seed), rotated_boxes(40, seed)):
        regions, polygons, painted = assert_right(scene, camera_of(scene, seed))
        faces = np.array([shapely.Polygon(painted.faces.points[:2, a:b].T) for a, b in pairwise(painted.faces.offsets)])
        assert shapely.area(polygons).sum() == pytest.approx(shapely.union_all(faces).area, rel=1e-7)
        assert len(set(regions.source.tolist())) < painted.uncut


def test_a_hole_is_cut_open():
    floor = Mesh.from_polygons([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [[0, 1, 2, 3]])
    cubes = {f"C{x}{y}": box((x, y, 1), (x + 0.5, y + 0.5, 1.5)) for x in (-2, 0, 1) for y in (-2, 0, 1)}
    scene = scene_of(FLOOR=floor, **cubes)
    regions, polygons, _ = assert_right(scene, Camera.view("top", (0, 0, 0), 20.0))
    view = look(scene, Camera.view("top", (0, 0, 0), 20.0))
    seen = polygons[view.face_item[regions.source] == 0]
    assert len(seen) > 1
    # The cubes hide more of the floor than they cover: they are nearer to the eye, by 20 to 18.5.
    whole = shapely.union_all(seen)
    assert len(shapely.get_rings(whole)) == 10
    assert (shapely.get_num_interior_rings(seen) == 0).all()


def test_what_does_not_hide_takes_nothing_away():
    floor = Mesh.from_polygons([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [[0, 1, 2, 3]])
    glass = Item("GLASS", box((-1, -1, 1), (1, 1, 2)), occludes=False)
    view = look(Scene((Item("FLOOR", floor), glass)), Camera.view("top", (0, 0, 0), 20.0))
    regions = visible_regions(view, painters_order(view))
    floor_area = shapely.area(polygons_of(regions)[view.face_item[regions.source] == 0]).sum()
    assert floor_area == pytest.approx(shapely.Polygon(view.image[:, :4].T).area, rel=1e-9)


def test_of_faces_in_one_place_the_one_on_top_is_seen():
    plate = Mesh.from_polygons([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [[0, 1, 2, 3]])
    view = look(scene_of(ONE=plate, TWO=plate), Camera.view("top", (0, 0, 0), 9.0))
    regions = visible_regions(view, painters_order(view))
    assert view.face_item[regions.source].tolist() == [1]


def test_nothing_to_see():
    view = look(Scene(()), Camera((0, -5, 0), (0, 0, 0)))
    assert len(visible_regions(view, painters_order(view))) == 0
