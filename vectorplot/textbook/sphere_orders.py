"""The order of solids by the power of the spheres around them, checked."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry.convex.separating_planes import spheres_power
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.bodies import Bodies, spheres_apart
from vectorplot.visibility.painter.pairs.body_pairs import body_relations
from vectorplot.visibility.painter.pairs.candidates import box_pairs
from vectorplot.visibility.painter.pairs.face_pairs import APART, BEHIND, IN_FRONT


def sphere_order(view: View, faces: ImageFaces, bodies: Bodies) -> Ints | None:
    """Convex bodies (b,) back to front, by falling power of the eye with respect to the spheres around them; None where
    that order is wrong.

    It is right for bodies whose spheres are disjoint; pairs whose spheres are not, and whose boxes overlap in the
    image, are compared as they are.
    Source: Glaeser, section 5.5, figure 9; erratum G5-03.
    """
    eye = np.array([0.0, 0.0, 1.0, 0.0]) if view.eye is None else view.eye
    power = spheres_power(bodies.sphere.T, eye)
    if not len(bodies):
        return bodies.item
    rows = [e.reduceat(row, bodies.offsets[:-1]) for row in bodies.corners for e in (np.minimum, np.maximum)]
    for first, second in box_pairs(np.stack(rows), view.tolerance):
        close = ~spheres_apart(bodies, first, second)
        a, b = first[close], second[close]
        codes = body_relations(view, faces, bodies, a, b)
        told = np.where(power[a] <= power[b], IN_FRONT, BEHIND)
        if ((codes != APART) & (codes != told)).any():
            return None
    return np.argsort(-power, kind="stable")
