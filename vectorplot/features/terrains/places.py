"""Places of a terrain by their x and y: in which triangles they are, and how high."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.components import greatest_component, least_component
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


def places_on_terrain(mesh: Mesh, places: ArrayLike, what: str = "terrain") -> tuple[Ints, Floats]:
    """Where the vertical lines through given places meet a terrain.

    Parameters
    ----------
    mesh : Mesh
        Of triangles, none above another, such as `terrain_mesh` makes.
    places : (k, 2) array_like of float
        x and y; or one pair.
    what : str
        How messages begin.

    Returns
    -------
    faces : (k,) array of int
        One triangle for each place.
    points : (k, 3) array of float
        In these triangles.

    Raises
    ------
    InputError
        For places that are not finite pairs, or beside the terrain or in a hole, and a mesh of other faces.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import features
    >>> roof = vp.Mesh.from_triangles([(0, 0, 0), (2, 0, 0), (0, 2, 4)], [(0, 1, 2)])
    >>> features.places_on_terrain(roof, (0.5, 1.0))[1].tolist()
    [[0.5, 1.0, 2.0]]
    """
    from shapely import STRtree, box, points

    given = np.atleast_2d(np.asarray(places, dtype=np.float64))
    if given.ndim != 2 or given.shape[1] != 2 or not np.isfinite(given).all():
        raise InputError(f"{what}: expected places of two finite numbers, x and y")
    if (np.diff(mesh.offsets) != TRIANGLE).any():
        raise InputError(f"{what}: expected a terrain, a mesh of triangles")
    # About the middle of the terrain: places may be far from the origin.
    centre = mesh.bounds.mean(axis=0)
    corners = (mesh.vertices - centre)[mesh.corners].reshape(-1, TRIANGLE, 3)
    x, y = corners[..., 0], corners[..., 1]
    at = given - centre[:2]
    tree = STRtree(box(least_component(x), least_component(y), greatest_component(x), greatest_component(y)))
    slack = ZERO_OF_EXTENT * float(np.ptp(mesh.bounds, axis=0).max())
    place, face = tree.query(points(at), predicate="dwithin", distance=slack)
    weights = _weights(corners[face, :, :2], at[place])
    inside = weights.min(axis=1)
    best = np.lexsort((-inside, place))
    counts = np.bincount(place, minlength=len(at))
    size = np.sqrt(np.abs(_area(corners[face, :, :2])))
    found = counts > 0
    first = best[np.minimum(ragged.starts(counts), max(len(best) - 1, 0))] if len(best) else np.zeros(len(at), np.intp)
    if len(best):
        found &= inside[first] >= -slack / np.maximum(size[first], LEAST_DIVISOR)
    if not found.all():
        bad = given[int((~found).argmax())]
        raise InputError(f"{what}: {bad[0]:g} {bad[1]:g} is not on the terrain")
    height = np.einsum("ij,ij->i", np.maximum(weights[first], 0.0), corners[face[first], :, 2])
    return face[first], np.column_stack([given, height + centre[2]])


def _area(triangles: Floats) -> Floats:
    """(n,) twice the areas of triangles (n,3,2), with signs."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    one, two = b - a, c - a
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def _weights(triangles: Floats, at: Floats) -> Floats:
    """(n,3) barycentric coordinates; -1 in triangles without an area."""
    whole = _area(triangles)
    parts = np.stack(
        [_area(np.stack([at, triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]], axis=1)) for k in range(3)], axis=1
    )
    flat = np.abs(whole) <= LEAST_DIVISOR
    return np.asarray(np.where(flat[:, None], -1.0, parts / np.where(flat, 1.0, whole)[:, None]))
