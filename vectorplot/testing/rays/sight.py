"""What hides a point, found by looking: a ray from the point to the eye."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.parts import smooth_parts
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.testing.rays.implicit_rays import implicit_hides
from vectorplot.testing.rays.mesh_rays import edge_distances, hits, occluders, sight_rays
from vectorplot.testing.rays.surface_rays import Hiding, surface_hides


class Sight(NamedTuple):
    """What rays find between points and the eye.

    Parameters
    ----------
    hidden_by : (n,) array of int
        How many items hide each point.
    clearance : (n,) array of float
        How sure that is, see visible_by_rays.
    on_contour : (n,) array of bool
        Whether the point is one of the contour of a smooth surface, and judged as such.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> sight = testing.visible_by_rays(cube, vp.Camera.view("top"), [(1, 1, 2), (1, 1, 0)])
    >>> sight.hidden_by.tolist(), sight.on_contour.any().item()
    ([0, 1], False)
    """

    hidden_by: Ints
    clearance: Floats
    on_contour: Bools


def visible_by_rays(scene: Scene, camera: Camera, points: ArrayLike, *, items: Sequence[int] | None = None) -> Sight:
    """How many items hide each of some points from the camera's eye, by brute force.

    Parameters
    ----------
    scene : Scene
        What may hide the points.
    camera : Camera
        Where the eye is.
    points : (n, 3) array_like of float
        In the world.
    items : sequence of int, optional
        The indices of those that may hide; all where None.

    Returns
    -------
    Sight
        How many items hide each point, 0 where it is visible; and how sure that is.

    Notes
    -----
    An item counts once, however often it is met; a face or sheet that touches the point does not hide it, and neither
    does one that is seen edge-on. Items that do not occlude and faces that are not present hide nothing.

    clearance is the distance, as a part of the scene's largest side and at most 0.001, from the ray to the nearest edge
    of a face that the point does not touch, or from the point to a face on its ray that it does not touch; for smooth
    surfaces contour and borders stand for the edges, less the error of looking, so that 0 means: not known. Compare
    only where it is larger than the accuracy asked for: nearer, the answer turns on rounding. A point of a contour must
    lie on it to about a millionth of the extent; another curve that passes a contour changes there, and has no answer.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> slab, plank = geometry.box((4, 4, 1)), geometry.box((1, 4, 4))
    >>> scene = vp.Scene((vp.Item("slab", slab), vp.Item("plank", plank)))
    >>> sight = testing.visible_by_rays(scene, vp.Camera.view("top"), [(0.5, 2, 1), (2, 2, 1)])
    >>> sight.hidden_by.tolist(), bool((sight.clearance > 1e-6).all())
    ([1, 0], True)
    """
    targets = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    bounds = scene.bounds
    middle, size = bounds.mean(axis=0), float((bounds[1] - bounds[0]).max()) or 1.0
    rays = sight_rays(camera, targets, middle, size)
    triangles, edges = occluders(scene, middle, size, items)
    hidden, clearance = hits(rays, triangles, len(scene.items))
    clearance = np.minimum(clearance, edge_distances(rays, edges))
    on_contour = np.zeros(len(targets), dtype=np.bool_)
    eye = None if camera.parallel else (np.asarray(camera.eye) - middle) / size
    for index in range(len(scene.items)) if items is None else items:
        item = scene.items[index]
        if not item.hides or not len(targets):
            continue
        if is_parametrised(item.shape):
            parts = [surface_hides(part.surface, eye, rays, middle, size) for part in smooth_parts(item.shape)]
            hides, distances, touches = (np.stack(column) for column in zip(*parts, strict=True))
            found = Hiding(np.any(hides, axis=0), distances.min(axis=0), np.any(touches, axis=0))
        elif is_implicit(item.shape):
            found = implicit_hides(item.shape, rays, middle, size)
        else:
            continue
        hidden, clearance = hidden + found.hidden, np.minimum(clearance, found.clearance)
        on_contour |= found.touched
    return Sight(hidden, clearance, on_contour)
