"""Light that becomes weaker with the distance from its lamp.

Source: Glaeser, section 4.5, equation 4, figure 5, with distances in place of depths.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.shading.light.illumination import distance_factor

LEAST_REACH = 0.25
"""What is nearer to a lamp than this part of the distance of the farthest point keeps all of its light: else the lamp's
own bulb, or the ceiling it hangs from, would leave none for the rest. So nothing gets less than a sixteenth."""


def lamp_reach(view: View, light: Light) -> float:
    """How far from a lamp, in the view, light keeps what it has: as far as the nearest point of the faces, or a quarter
    of the way to the farthest. Degenerate: without end for light that does not fade, as parallel light never does,
    and for a scene without faces."""
    if not light.fading or light.parallel or not view.face_count:
        return np.inf
    corners = view.corners[ragged.fans(view.offsets)[0]]
    place = np.array(light.position)
    nearest = float(_distances(place, view.points, corners).min(initial=np.inf))
    arm = view.points - place[:, None]
    return max(nearest, LEAST_REACH * float(np.sqrt((arm * arm).sum(axis=0)).max()))


def fading_factors(light: Light, reach: float, points: Floats) -> Floats:
    """(n,) what part of its light a lamp sends to points (3,n): all of it within its reach, farther away less with the
    square of the distance."""
    if reach == np.inf:
        return np.ones(points.shape[1])
    arm = points - np.array(light.position)[:, None]
    far = np.maximum(np.sqrt((arm * arm).sum(axis=0)), reach)
    return distance_factor(0.0, -far, -reach)


def _distances(place: Floats, points: Floats, corners: Ints) -> Floats:
    """(t,) distances of a place from triangles (t,3) of points (3,n)."""
    a, b, c = (points[:, corners[:, k]] - place[:, None] for k in range(3))
    normal = np.cross(b - a, c - a, axis=0)
    size = np.sqrt((normal * normal).sum(axis=0))
    height = np.abs((normal * a).sum(axis=0)) / np.where(size > 0.0, size, 1.0)
    above = size > 0.0
    border = np.full(len(corners), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        side = q - p
        length = (side * side).sum(axis=0)
        share = np.clip(-(p * side).sum(axis=0) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
        foot = p + share * side
        border = np.minimum(border, np.sqrt((foot * foot).sum(axis=0)))
        above &= (np.cross(p, q, axis=0) * normal).sum(axis=0) >= 0.0
    return np.where(above, height, border)
