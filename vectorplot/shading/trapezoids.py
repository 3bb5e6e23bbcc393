"""The trapezoid around what an eye sees, as a lamp sees it: most of a shadow map then shows what is near the eye.

All happens in the lamp's image plane (its post-perspective plane): points (n, 2) are those of the view frustum there, N
and F the images of the centres of its near and its far plane. The top line of the trapezoid is the one near the eye.
Sources: Ressler, Notes on implementation of trapezoidal shadow maps, sections 2 and 3; Martin and Tan, TSM recipe.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.convex_polygons import convex_hull
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances import ZERO_OF_EXTENT

FOCUS_LINE = 0.8
"""Part of the map, from the top line on, that shows what is nearer than the focus."""


LARGEST_TAPER = 1e4
"""How many times wider than the top line the base may be."""

SEARCH_STEP = 0.05
"""The search for the best focus line goes down by so much of the map at a time."""


@dataclass(frozen=True, eq=False)
class Axis:
    """The line of sight in the lamp's image plane.

    origin: (2,) N, the image of the centre of the near plane; direction: (2,) unit vector to F, that of the far plane;
    top, base: distances from N, along the direction, of the two parallel lines of the trapezoid.
    Source: Ressler, equations 1 to 4.
    """

    origin: Floats
    direction: Floats
    top: float
    base: float

    @property
    def length(self) -> float:
        """From the top line to the base."""
        return self.base - self.top

    @property
    def left(self) -> Floats:
        """(2,) unit vector to the left of the direction."""
        return np.array([-self.direction[1], self.direction[0]])

    def along(self, points: ArrayLike) -> Floats:
        """Distances of points from N, measured along the direction.

        points: (..., 2) in the lamp's image plane; result: (...) positive towards F.
        """
        return np.asarray(matmul(np.asarray(points, dtype=np.float64) - self.origin, self.direction))

    def across(self, points: ArrayLike) -> Floats:
        """Distances of points from the line of sight.

        points: (..., 2) in the lamp's image plane; result: (...) positive on the left.
        """
        return np.asarray(matmul(np.asarray(points, dtype=np.float64) - self.origin, self.left))


def line_of_sight(points: ArrayLike, near: ArrayLike, far: ArrayLike) -> Axis:
    """The axis between the images of the centres of the near and the far plane, with its top and base lines.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Images of the frustum; inner ones change nothing.
    near, far : (2,) array_like of float
        Images of the centres of its planes.

    Returns
    -------
    Axis
        Its top and base line touch the points.

    Raises
    ------
    InputError
        Without points, and for what is not finite.

    Notes
    -----
    Edge cases: where both centres have one image, as the lamp shines along the line of sight, the axis is x.

    Source: Ressler, equations 1 to 4.

    Examples
    --------
    >>> from vectorplot.shading import line_of_sight
    >>> axis = line_of_sight([(0, -2), (0, 2), (8, 3), (9, 0)], near=(1, 0), far=(8, 0))
    >>> axis.top, axis.base
    (-1.0, 8.0)
    """
    p, n, f = (np.asarray(x, dtype=np.float64) for x in (points, near, far))
    if p.ndim != 2 or p.shape[1] != 2 or not len(p) or not all(np.isfinite(x).all() for x in (p, n, f)):
        raise InputError("a trapezoid needs at least one point, and finite coordinates")
    arm = f - n
    extent = float(np.ptp(p, axis=0).max())
    size = float(np.hypot(*arm))
    direction = arm / size if size > ZERO_OF_EXTENT * extent else np.array([1.0, 0.0])
    t = matmul(p - n, direction)
    return Axis(n, direction, float(t.min()), float(t.max()))


def focus_distance(axis: Axis, points: ArrayLike) -> float:
    """How far behind the top line the focus lies: of the centre of its far plane alone, or, the authors' way, of the
    corners (n, 2) of what is in focus, the farthest of which counts.

    Source: Ressler, equation 5.
    """
    p = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    return float(np.max(axis.along(p))) - axis.top


def taper_of_focus(axis: Axis, focus: float, line: float = FOCUS_LINE) -> float:
    """The length of the trapezoid over eta, 0 for a rectangle, without poles; it fades to 0 as the centre of the near
    plane moves from the top line to the middle of the frustum, where eye and lamp begin to face each other. Edge
    cases: a focus on or before the top line takes the largest taper; a frustum without length has none.
    Source: after Ressler, section 2, and erratum N-02.
    """
    if not axis.length > 0.0:
        return 0.0
    share = min(max(focus / axis.length, 0.0), 1.0)
    fading = min(max(0.0, 1.0 + 2.0 * axis.top / axis.length), 1.0)
    steep = (line - share) / ((1.0 - line) * share) if share > 0.0 else LARGEST_TAPER
    return fading * min(max(steep, 0.0), LARGEST_TAPER)


def tapered_map(points: ArrayLike, axis: Axis, taper: float) -> Floats:
    """(3,3) the projective map of the trapezoid around points (n,2) onto the square from -1 to 1, top line to y = -1;
    its last row is 1 + taper tau, tau from 0 on the top line to 1 on the base, so there is no pole where it becomes
    a rectangle. Edge cases: points on a line get a billionth of their extent across, a single point a square of size
    1.
    Source: after Ressler, sections 4 and 5.
    """
    p = np.asarray(points, dtype=np.float64)
    extent = float(np.ptp(p, axis=0).max())
    length = max(axis.length, ZERO_OF_EXTENT * extent) or 1.0
    plane = np.zeros((3, 3))
    # tau, distance from the line of sight, and one.
    plane[0, :2], plane[0, 2] = (
        axis.direction / length,
        -(matmul(axis.origin, axis.direction) + axis.top) / length,
    )
    plane[1, :2], plane[1, 2] = -axis.left, matmul(axis.origin, axis.left)
    plane[2, 2] = 1.0
    weight = plane[2] + taper * plane[0]
    tau, across = (matmul(p, row[:2]) + row[2] for row in plane[:2])
    spread = across / (1.0 + taper * np.clip(tau, 0.0, 1.0))
    low, high = float(spread.min()), float(spread.max())
    half = max((high - low) / 2.0, ZERO_OF_EXTENT * extent) or 0.5
    right = (plane[1] - (low + high) / 2.0 * weight) / half
    upward = 2.0 * (1.0 + taper) * plane[0] - weight
    return np.stack([right, upward, weight])


def projective_images(matrix: Floats, points: ArrayLike) -> Floats:
    """(..., 2) points (..., 2) after a projective map (3, 3)."""
    p = np.asarray(points, dtype=np.float64)
    h = matmul(p, matrix[:, :2].T) + matrix[:, 2]
    return np.asarray(h[..., :2] / h[..., 2:])


def focus_area(matrix: Floats, focus_points: ArrayLike) -> float:
    """The area that the convex hull of points (n, 2) has in the map, as part of it. Edge cases: 0 on a line."""
    p = projective_images(matrix, focus_points)
    hull = p[convex_hull(p)]
    after = np.roll(hull, -1, axis=0)
    return float(cross(hull, after).sum()) / 8.0


def searched_line(points: ArrayLike, axis: Axis, focus: float, focus_points: ArrayLike) -> float:
    """The focus line that gives the focus region the largest area in the map, searched from 80 % downwards in steps of
    5 %, until the area falls. Source: Martin and Tan, recipe, tips."""
    best = FOCUS_LINE
    largest = focus_area(tapered_map(points, axis, taper_of_focus(axis, focus, best)), focus_points)
    for number in range(1, round(FOCUS_LINE / SEARCH_STEP)):
        line = FOCUS_LINE - number * SEARCH_STEP
        area = focus_area(tapered_map(points, axis, taper_of_focus(axis, focus, line)), focus_points)
        if area <= largest:
            break
        best, largest = line, area
    return best


def adapted_size(size: int, share: float, wanted: float, largest: int) -> int:
    """The side of a map, between size and largest, without jumps, larger where the focus has too small a part of it.
    size: in texels; share: part of the map in focus; wanted: the part of a map of side size whose texels it should
    get, over 0 up to 1.
    Source: Martin and Tan, recipe, tips. Errors: InputError for numbers out of range.
    """
    if not (0.0 <= share and 0.0 < wanted <= 1.0 and 1 <= size <= largest):
        raise InputError(f"a map of {size} texels for a share of {share:g} of {wanted:g} is out of range")
    grown = size * np.sqrt(wanted / share) if share > 0.0 else largest
    return int(min(max(round(grown), size), largest))
