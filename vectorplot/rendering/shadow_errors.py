"""How many places shadow maps say a wrong thing of, measured against exact shadows."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.vectors import cross
from vectorplot.scene.scene import Scene
from vectorplot.shading.light.lighting import Lighting
from vectorplot.shading.raster.scene_triangles import SceneTriangles
from vectorplot.shading.shadows.shadow_rays import exact_shadows

PLACES = 1024
"""So many places are asked about."""


def wrong_shadows(scene: Scene, triangles: SceneTriangles, lighting: Lighting) -> float | None:
    """Of how many of 100 places, spread over the triangles of a scene by their area, maps say wrongly whether a light
    reaches them; None for a scene without area."""
    corners, points = triangles.corners, triangles.points
    a, b, c = (points[corners[:, k]] for k in range(3))
    area = np.linalg.norm(cross(b - a, c - a), axis=1)
    whole = np.cumsum(area)
    if not len(whole) or not whole[-1] > 0.0:
        return None
    random = np.random.default_rng(0)
    which = np.searchsorted(whole, whole[-1] * (np.arange(PLACES) + 0.5) / PLACES)
    s, t = random.random((2, PLACES, 1))
    s, t = np.where(s + t > 1.0, 1.0 - s, s), np.where(s + t > 1.0, 1.0 - t, t)
    places = a[which] + s * (b - a)[which] + t * (c - a)[which]
    normals = cross(b - a, c - a)[which] / area[which, None]
    casts = np.array([item.casts_shadow for item in scene.items], dtype=np.bool_)[triangles.item]
    number = np.where(casts, np.cumsum(casts) - 1, -1)
    true = exact_shadows(lighting.lights, points, corners[casts], number)
    wrong = [
        (says(places, normals, which) != is_so(places, normals, which)).mean()
        for says, is_so in zip(lighting.blocked, true, strict=True)
    ]
    return 100.0 * float(np.mean(wrong))
