"""Where a function at the corners of triangles vanishes, though its sign may be anyone's choice."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines.line_fields import LineField, sharpness
from vectorplot.geometry.vectors import cross, dot
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


@dataclass(frozen=True, eq=False)
class Crossings:
    """Sides of triangles on which a function vanishes, and the segments between them.

    low, high (k,): the ends of the sides; part (k,): where between them; pairs (s,2): of sides, in the triangles
    triangle (s,); strength (s,): how clear the line is there.
    """

    low: Ints
    high: Ints
    part: Floats
    pairs: Ints
    triangle: Ints
    strength: Floats


def crossings(points: Floats, triangles: Ints, field: LineField) -> Crossings:
    """The segments across triangles (t,3) of points (n,3) on which a field is zero, and a line is.

    Directions at the ends of a side are compared with each other: the function has one sign where they go the same way.
    A triangle round which they do not come back to themselves has an umbilic inside, and no line.
    Degenerate: zero counts as positive; triangles with values that are not finite have no line.
    """
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1)
    usable = np.flatnonzero(np.isfinite(field.values)[triangles].all(axis=1))
    positive = field.values >= 0.0
    a, b = sides[usable, :, 0], sides[usable, :, 1]
    apart = positive[a] != positive[b]
    if field.directions is not None:
        opposite = dot(field.directions[a], field.directions[b]) < 0.0
        round_ = np.flatnonzero(opposite.sum(axis=1) % 2 == 0)
        usable, a, b = usable[round_], a[round_], b[round_]
        apart = apart[round_] ^ opposite[round_]
    crossed = np.flatnonzero(apart.sum(axis=1) == 2)
    usable, a, b, apart = usable[crossed], a[crossed], b[crossed], apart[crossed]
    row, which = np.nonzero(apart)
    low, high = np.minimum(a, b)[row, which], np.maximum(a, b)[row, which]
    _, first, number = np.unique(low * len(points) + high, return_index=True, return_inverse=True)
    low, high = low[first], high[first]
    pairs = number.reshape(-1, 2)
    sizes = np.abs(field.values[low]), np.abs(field.values[high])
    part = sizes[0] / np.maximum(sizes[0] + sizes[1], LEAST_DIVISOR)
    ends = field.strength[low], field.strength[high]
    with np.errstate(invalid="ignore"):
        between = (1.0 - part) * ends[0] + part * ends[1]
    if field.sides is not None:
        # A line goes on up to the contour, beyond which the strength has another sign; a derivative is infinite there.
        at_contour = np.fmax(*ends) if field.directions is None else 0.0
        between = np.where(field.sides[low] != field.sides[high], at_contour, between)
    strength = between[pairs].min(axis=1)
    if field.directions is not None:
        falls, height = _falls(points, triangles[usable], field)
        strength = np.where(falls < 0.0, strength if height is None else strength * sharpness(falls, height), 0.0)
    return Crossings(low, high, part, pairs, usable, np.nan_to_num(strength, nan=0.0, posinf=np.inf, neginf=0.0))


def _falls(points: Floats, triangles: Ints, field: LineField) -> tuple[Floats, Floats | None]:
    """(s,) how fast the derivative itself changes in its direction in each of these triangles, and the mean height."""
    directions = np.zeros((0, 3, 3)) if field.directions is None else field.directions[triangles]
    values = field.values[triangles]
    same = np.where(np.einsum("sij,sj->si", directions, directions[:, 0]) < 0.0, -1.0, 1.0)
    values, way = same * values, (same[:, :, None] * directions).sum(axis=1)
    corners = points[triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = cross(one, two)
    square = dot(normal, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        way = way / np.sqrt(dot(way, way))[:, None]
        rises = (values[:, 1] - values[:, 0]) * dot(cross(two, normal), way)
        rises += (values[:, 2] - values[:, 0]) * dot(cross(normal, one), way)
        falls = rises / square
    height = None if field.height is None else field.height[triangles].mean(axis=1)
    return np.asarray(falls), height
