"""Where the eye of a panorama is that stands on a terrain."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.features.terrains.places import places_on_terrain
from vectorplot.geometry.cameras.panoramic_view import Panorama
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.scene.scene import Scene

USUAL_ABOVE = 1.0 / 500.0
"""How high an eye is above a terrain where nothing is said, by the width of the scene."""


def eye_of(given: Panorama, scene: Scene) -> Floats:
    """(3,) the eye of a panorama in a scene: as it is given, or above the highest triangle at its place.

    Errors: InputError where there is no triangle of a polyhedron at the place.
    """
    if len(given.place) > 2:
        return np.array(given.place)
    heights = []
    cause = "panorama: nothing to stand on: give the place a height"
    for item in scene.items:
        if isinstance(item.shape, Mesh) and item.shape.face_count and (np.diff(item.shape.offsets) == TRIANGLE).all():
            try:
                heights.append(places_on_terrain(item.shape, given.place, "panorama")[1][0, 2])
            except InputError as error:
                cause = error.cause
    if not heights:
        raise InputError(cause)
    above = USUAL_ABOVE * float(np.ptp(scene.bounds, axis=0)[:2].max()) if given.above is None else given.above
    return np.array([*given.place, max(heights) + above])
