"""Places of a terrain by their x and y: in which triangles they are, and how high."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

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
    given = np.atleast_2d(np.asarray(places, dtype=np.float64))
    if given.ndim != 2 or given.shape[1] != 2 or not np.isfinite(given).all():
        raise InputError(f"{what}: expected places of two finite numbers, x and y")
    if (np.diff(mesh.offsets) != TRIANGLE).any():
        raise InputError(f"{what}: expected a terrain, a mesh of triangles")
    face, found = Ground(mesh).below(given)
    if (face < 0).any():
        bad = given[int((face < 0).argmax())]
        raise InputError(f"{what}: {bad[0]:g} {bad[1]:g} is not on the terrain")
    return face, found


@dataclass(frozen=True, eq=False)
class Ground:
    """The triangles of a terrain, to be asked again and again what lies above or below places."""

    mesh: Mesh

    def below(self, places: Floats) -> tuple[Ints, Floats]:
        """(k,) the triangles in which places (k,2) are, and (k,3) the points there; -1 and NaN heights beside the
        terrain."""
        from shapely import points

        at = places - self._centre[:2]
        place, face = self._tree.query(points(at), predicate="dwithin", distance=self._slack)
        corners = self._corners[face]
        weights = _weights(corners[..., :2], at[place])
        inside = weights.min(axis=1)
        best = np.lexsort((-inside, place))
        counts = np.bincount(place, minlength=len(at))
        # One of each place that has some.
        first = best[ragged.starts(counts)[counts > 0]]
        size = np.sqrt(np.abs(_area(corners[first, :, :2])))
        first = first[inside[first] >= -self._slack / np.maximum(size, LEAST_DIVISOR)]
        result, height = np.full(len(at), -1, dtype=np.intp), np.full(len(at), np.nan)
        result[place[first]] = face[first]
        height[place[first]] = np.einsum("ij,ij->i", np.maximum(weights[first], 0.0), corners[first, :, 2])
        return result, np.column_stack([places, height + self._centre[2]])

    def near(self, plan: Floats) -> tuple[Ints, Ints]:
        """The segments and the triangles, pair by pair, of a line (k,2) of the plan whose boxes meet."""
        from shapely import linestrings

        line = plan - self._centre[:2]
        segment, face = self._tree.query(linestrings(np.stack([line[:-1], line[1:]], axis=1)))
        return segment, face

    @cached_property
    def _centre(self) -> Floats:
        """About the middle of the terrain: places may be far from the origin."""
        return np.asarray(self.mesh.bounds.mean(axis=0))

    @cached_property
    def _corners(self) -> Floats:
        return np.asarray((self.mesh.vertices - self._centre)[self.mesh.corners].reshape(-1, TRIANGLE, 3))

    @cached_property
    def _slack(self) -> float:
        return ZERO_OF_EXTENT * float(np.ptp(self.mesh.bounds, axis=0).max())

    @cached_property
    def _tree(self) -> Any:
        from shapely import STRtree, box

        x, y = self._corners[..., 0], self._corners[..., 1]
        return STRtree(box(least_component(x), least_component(y), greatest_component(x), greatest_component(y)))


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
