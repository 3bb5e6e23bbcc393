"""Steps of shade as regions: visible fills of smooth bodies."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.geometry.regions import polygons_of
from vectorplot.pictures.fills import border_tolerance_mm
from vectorplot.shading import palette
from vectorplot.surfaces import Sphere

CAMERA = vp.Camera((0.0, -9.0, 2.0), (0.0, 0.0, 0.0))
STEPS, TOLERANCE_MM, PAGE = 6, 0.06, vp.Page(70, 50, 5)


@pytest.fixture(scope="module")
def seen():
    scene = vp.Scene(
        (
            # What is in a group is painted by triangles, not in bands.
            vp.Item("B", Sphere(1.0), "blue", group="ALL"),
            vp.Item("N", Sphere(0.5, centre=(0.9, -0.9, 0.0)), "red", group="ALL"),
            vp.Item("C", box((4.0, 0.2, 0.3)).moved(-2.0, -0.1, 0.2), "green", group="ALL"),
        )
    )
    painted = vp.paint(scene, CAMERA, page=PAGE, tolerance_mm=border_tolerance_mm(TOLERANCE_MM, STEPS))
    visible = vp.paint(scene, CAMERA, page=PAGE, fills="visible", palette=STEPS, tolerance_mm=TOLERANCE_MM)
    return [picture.layers[0].fills[0] for picture in (painted, visible)]


@pytest.mark.slow
def test_every_shade_of_a_smooth_body_is_a_region(seen):
    painted, regions = seen
    for number, name in enumerate(("blue", "red")):
        mine = regions.take(np.flatnonzero(regions.item == number))
        colours = mine.colours[mine.offsets[:-1]]
        assert {tuple(colour) for colour in colours.tolist()} <= {tuple(row) for row in palette(name, STEPS).tolist()}
        assert STEPS // 2 <= len(np.unique(colours, axis=0)) <= len(mine) <= 4 * STEPS
    assert len(regions) < len(painted) / 20


@pytest.mark.slow
def test_regions_of_shades_cover_what_was_painted_and_do_not_overlap(seen):
    painted, regions = (polygons_of(fills.points.T, fills.offsets) for fills in seen)
    whole = shapely.union_all(painted, grid_size=1e-4).area
    assert shapely.area(regions).sum() == pytest.approx(whole, rel=3e-5)
    assert shapely.union_all(regions, grid_size=1e-4).area == pytest.approx(whole, rel=3e-5)


def test_shades_of_regions_are_those_of_the_painting_to_half_a_step(seen):
    painted, regions = seen
    trees = [shapely.STRtree(polygons_of(fills.points.T, fills.offsets)) for fills in seen]
    triangles = painted.take(np.flatnonzero((painted.item == 0) & (np.diff(painted.offsets) == 3)))
    middles = triangles.points.reshape(-1, 3, 2).mean(axis=1)
    shade = triangles.colours.reshape(-1, 3, 3)[..., 0].mean(axis=1) / 178.5
    # The last triangle is on top; of regions there is one only.
    point, over = trees[0].query(shapely.points(middles), predicate="within")
    top = np.zeros(len(middles), dtype=np.intp)
    np.maximum.at(top, point, over)
    point, region = trees[1].query(shapely.points(middles), predicate="within")
    free = (painted.item[top[point]] == 0) & (regions.item[region] == 0)
    steps = palette("blue", STEPS)[:, 0].astype(float)
    found = np.abs(regions.colours[regions.offsets[region[free]], :1] - steps).argmin(axis=1)
    assert free.sum() > 100 and np.abs(found - STEPS * shade[point[free]]).max() < 1.1
