"""Shadows of one light on a face as one region."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.effects.shadows import cast_shadows
from vectorplot.effects.soft_shadows import united_shadows
from vectorplot.geometry.regions import polygons_of
from vectorplot.scene.view import look

LIGHTS = (vp.Light((3.0, -1.0, 9.0)), vp.Light((-1.0, -2.0, 4.0), parallel=True))


@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
def test_regions_are_where_the_shadows_are(size: float) -> None:
    rng = np.random.default_rng(5)
    corners = rng.uniform(-1.5, 1.5, (90, 3)) + np.array([0.0, 0.0, 2.5])
    flakes = vp.Mesh.from_triangles(size * corners, np.arange(90).reshape(-1, 3))
    floor = vp.Mesh.from_polygons(size * np.array([(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)]), [(0, 1, 2, 3)])
    scene = vp.Scene((vp.Item("floor", floor), vp.Item("flakes", flakes)))
    view = look(scene, vp.Camera.view("top"))
    lights = [
        vp.Light(tuple(light.position if light.parallel else size * np.array(light.position)), parallel=light.parallel)
        for light in LIGHTS
    ]
    cast = cast_shadows(view, lights, receivers=view.face_item == 0)
    united = united_shadows(view, cast)
    assert len(united) < len(cast) / 2
    for bit in (1, 2):
        before, after = (
            shapely.union_all(polygons_of(some.points, some.offsets))
            for some in (s.take(np.flatnonzero(s.lacking == bit)) for s in (cast, united))
        )
        assert shapely.symmetric_difference(before, after).area < 1e-6 * before.area
