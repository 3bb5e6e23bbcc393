"""Where items of scene files stand: placements, and the modifiers that change them."""

from __future__ import annotations

import math

import numpy as np

from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.bodies.solids import IDENTITY
from vectorplot.io.scenes.scene_words import Words
from vectorplot.tolerances.of_numbers import LARGEST

Placement = tuple[float, ...]
"""The first three rows of a matrix (4,4), row by row."""

_QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def moved(placement: Placement, x: float, y: float, z: float) -> Placement:
    """A placement followed by a translation."""
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    return (a, b, c, t + x, d, e, f, u + y, g, h, i, v + z)


def scaled(placement: Placement, x: float, y: float, z: float) -> Placement:
    """A placement followed by stretching along the axes."""
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    return (x * a, x * b, x * c, x * t, y * d, y * e, y * f, y * u, z * g, z * h, z * i, z * v)


def affinely_mapped(placement: Placement, rows: Placement) -> Placement:
    """A placement followed by an affine map: the first three rows of its matrix (4,4)."""
    if placement == IDENTITY:
        return rows
    below = (0.0, 0.0, 0.0, 1.0)
    after, before = (np.array([*one, *below]).reshape(4, 4) for one in (rows, placement))
    return tuple((matmul(after, before))[:3].ravel().tolist())


def turned(placement: Placement, axis: str, angle_deg: float) -> Placement:
    """A placement followed by a rotation about an axis through the origin, counter-clockwise seen from its tip.

    Quarter turns are exact. Source: Glaeser, section 1.6, equations 27 to 29.
    """
    quarters = angle_deg / 90.0
    if quarters == int(quarters):
        cos, sin = _QUARTERS[int(quarters) % 4]
    else:
        cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    # Row by row and written out: thousands of items are turned.
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    if axis == "x":
        second = (cos * d - sin * g, cos * e - sin * h, cos * f - sin * i, cos * u - sin * v)
        return (a, b, c, t, *second, sin * d + cos * g, sin * e + cos * h, sin * f + cos * i, sin * u + cos * v)
    if axis == "y":
        third = (cos * g - sin * a, cos * h - sin * b, cos * i - sin * c, cos * v - sin * t)
        return (sin * g + cos * a, sin * h + cos * b, sin * i + cos * c, sin * v + cos * t, d, e, f, u, *third)
    first = (cos * a - sin * d, cos * b - sin * e, cos * c - sin * f, cos * t - sin * u)
    return (*first, sin * a + cos * d, sin * b + cos * e, sin * c + cos * f, sin * t + cos * u, g, h, i, v)


def read_rotation(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """An axis and an angle."""
    axis = words.words[at + 1]
    if axis not in ("x", "y", "z"):
        words.fail(at + 1, f"{owner}expected an axis x, y or z after 'rotation', got {words.shown(at + 1)}")
    angle = words.number(at + 2, owner, "the angle of a rotation")
    return turned(placement, axis, angle), at + 3


def read_scale(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """One factor, or three along the axes; a negative one mirrors."""
    count = 3 if words.is_number(at + 2) or words.words[at + 2] == "," else 1
    factors, end = words.numbers(at + 1, count, owner, "a factor of scale")
    if not all(factors):
        words.fail(at, f"{owner}scale: a factor of 0")
    x, y, z = factors * (3 // count)
    return _finite(words, at, owner, scaled(placement, x, y, z)), end


def read_matrix(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """The twelve numbers of an affine map."""
    rows, end = words.numbers(at + 1, 12, owner, "matrix")
    with np.errstate(divide="ignore"):
        volume = determinant(np.array(rows).reshape(3, 4)[:, :3])
    if not volume:
        words.fail(at, f"{owner}matrix: its determinant is 0")
    return _finite(words, at, owner, affinely_mapped(placement, tuple(rows))), end


def _finite(words: Words, at: int, owner: str, placement: Placement) -> Placement:
    if not all(abs(number) <= LARGEST for number in placement):
        words.fail(at, f"{owner}'{words.words[at]}' goes beyond the range of numbers")
    return placement
