"""The order of solids by the power of the spheres around them, checked."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry.convex.separating_planes import spheres_power
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.body_pairs import body_relations
from vectorplot.visibility.painter.pairs.box_pairs import box_pairs
from vectorplot.visibility.painter.pairs.convex_bodies import Bodies, spheres_apart
from vectorplot.visibility.painter.pairs.face_pairs import APART, BEHIND, IN_FRONT


def sphere_order(view: View, faces: ImageFaces, bodies: Bodies) -> Ints | None:
    """Convex bodies back to front, by falling power of the eye with respect to the spheres around them.

    Parameters
    ----------
    view : View
        What the bodies are seen in.
    faces : ImageFaces
        What can be seen, in the image.
    bodies : Bodies
        As of convex_bodies, b of them.

    Returns
    -------
    (b,) array of int, or None
        Numbers of bodies; None where that order is wrong.

    Notes
    -----
    It is right for bodies whose spheres are disjoint; pairs whose spheres are not, and whose boxes overlap in the
    image, are compared as they are.

    Source: Glaeser, section 5.5, figure 9; erratum G5-03.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import sphere_order
    >>> from vectorplot.visibility import convex_bodies, painters_order
    >>> near = box((1, 1, 1), placement=(1, 0, 0, 0, 0, 1, 0, -5, 0, 0, 1, 0))
    >>> view = look(vp.Scene((vp.Item("near", near), vp.Item("far", box((1, 1, 1))))), vp.Camera((2, -20, 3)))
    >>> faces = painters_order(view).faces
    >>> sphere_order(view, faces, convex_bodies(view, faces, np.arange(2))).tolist()
    [1, 0]
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
