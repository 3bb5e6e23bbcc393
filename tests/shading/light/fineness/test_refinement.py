"""Shaded polygons cut where shading between their corners would not do."""

from __future__ import annotations

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.geometry.regions import polygons_of
from vectorplot.geometry.solids import revolution

LATITUDE = np.linspace(-np.pi / 2, np.pi / 2, 13)
BALL = revolution(20.0 * np.column_stack([np.cos(LATITUDE), 0 * LATITUDE, np.sin(LATITUDE)]), 20)


def test_parts_of_shaded_faces_cover_them_once_and_meet_along_whole_sides() -> None:
    scene = vp.Scene((vp.Item("BALL", BALL, "blue", vp.Material("plastic")),), (vp.Light((-3, -4, 4), parallel=True),))
    fills = vp.paint(scene, vp.Camera.view("front"), page=vp.Page(60, 60, 4), shadows="none").layers[0].fills[0]
    faces = vp.paint(scene, vp.Camera.view("front"), page=vp.Page(60, 60, 4), shadows="none", smooth=False)
    whole = shapely.union_all(polygons_of(faces.layers[0].fills[0].points.T, faces.layers[0].fills[0].offsets))
    polygons = polygons_of(fills.points.T, fills.offsets)
    assert len(fills) > 1.2 * len(faces.layers[0].fills[0])
    assert abs(shapely.area(polygons).sum() - whole.area) < 1e-6 * whole.area
    # No corner lies inside a side: neighbours halve a common side both, or none.
    corners = np.unique(np.round(fills.points, 9), axis=0)
    rings = shapely.boundary(polygons)
    near, ring = shapely.STRtree(rings).query(shapely.points(corners), predicate="dwithin", distance=1e-7)
    own = np.full(len(near), np.inf)
    for step in range(int(np.diff(fills.offsets).max())):
        at = fills.offsets[ring] + np.minimum(step, np.diff(fills.offsets)[ring] - 1)
        own = np.minimum(own, np.abs(fills.points[at] - corners[near]).max(axis=1))
    assert (own < 1e-6).all()
