"""Cuts through a scene and exploded views: planes, what becomes of parts before them, and where parts are moved."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import EDGE_ON_SINE
from vectorplot.words import check_colour, check_word

# A cut through a scene: where it is, and what becomes of what lies before it.

FINEST_SPACING_MM = 0.1
"""No hatch of a cut face is closer: it would be black."""

AWAY = ("gone", "ghost", "moved")
"""What becomes of what lies before a cut."""

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class CutPlane:
    """A plane of a cut.

    Parameters
    ----------
    normal : (float, float, float)
        Of length 1; what it leads to is taken away, unless the eye says it.
    offset : float
        normal . p of the points of the plane.
    to_eye : bool
        What is on the side of the eye is taken away.

    Examples
    --------
    >>> from vectorplot.scene import Cut
    >>> Cut.of("z > 2").planes[0]
    CutPlane(normal=(0.0, 0.0, 1.0), offset=2.0, to_eye=False)
    """

    normal: Vector
    offset: float
    to_eye: bool = False


@dataclass(frozen=True)
class Cut:
    """What is taken away of a scene: what lies before all of some planes at once.

    Parameters
    ----------
    planes : tuple of CutPlane
        At least one.
    away : {"gone", "ghost", "moved"}
        What is taken away is not there; or has thin dashed outlines; or is moved along the normals.
    colour : str, optional
        Of the cut faces; those of their bodies where None.
    spacing_mm : float, optional
        From stroke to stroke of their hatches on the page, 0.1 or more; where None about 2.4, on narrow faces half as
        much. Where parts touch that of the third one is 0.6 times as much, of the fifth one 1.5 times. Bodies of one
        group that have the same colour and material are one part.
    angle_deg : float
        Of the strokes of the first part, counter-clockwise from what is level in the plane; those of the next one are
        at right angles to them.
    items : tuple of str, optional
        The names of the items that it is for; all of the scene where None. It goes through these alone.

    Raises
    ------
    InputError
        For no planes, unknown words and colours, and numbers out of range.

    Examples
    --------
    >>> from vectorplot.scene import Cut
    >>> len(Cut.of("x > 0, y < 1").planes), Cut.of("y = 0").planes[0].to_eye
    (2, True)
    """

    planes: tuple[CutPlane, ...]
    away: str = "gone"
    colour: str | None = None
    spacing_mm: float | None = None
    angle_deg: float = 45.0
    items: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if not self.planes:
            raise InputError("cut: no plane")
        if self.spacing_mm is not None and not FINEST_SPACING_MM <= self.spacing_mm < math.inf:
            raise InputError(f"cut: a spacing of {self.spacing_mm:g} mm: expected {FINEST_SPACING_MM:g} mm or more")
        if not math.isfinite(self.angle_deg):
            raise InputError(f"cut: an angle of {self.angle_deg:g} degrees: expected a finite number")
        check_word("cut away", self.away, AWAY)
        if self.colour is not None:
            check_colour(self.colour, "cut: ")

    @property
    def condition(self) -> str:
        """What holds for what is taken away, as text, such as y = 999 or x > 0, y < 1."""
        return ", ".join(map(_condition, self.planes))

    @classmethod
    def of(
        cls,
        text: str,
        away: str = "gone",
        colour: str | None = None,
        *,
        spacing_mm: float | None = None,
        angle_deg: float = 45.0,
    ) -> Cut:
        """The cut that a text spells.

        text: conditions with commas between them, such as y = 0, x + 2y - z > 3 or 0 < x < 2: what all of them hold for
        is taken away; of a plane with = what is on the side of the eye; away, colour, spacing_mm, angle_deg: what
        becomes of what is taken away, and how the faces of the cut are coloured and hatched: see Cut; result: with a
        plane for each sign.
        Errors: for what is no condition, for one on which x, y and z have no effect, and for numbers out of range.
        """
        planes = [plane for condition in text.split(",") for plane in _planes(condition, text)]
        return cls(tuple(planes), away, colour, spacing_mm, angle_deg)

    def is_for(self, name: str) -> bool:
        """Whether it is for an item of this name."""
        return self.items is None or name in self.items

    def region(self, camera: Camera) -> HalfSpaces:
        """What is taken away, as a camera sees it.

        camera: tells on which side of planes with = the eye is; result: the region.
        Errors: where a plane with = is seen edge-on.
        """
        normals, offsets = [], []
        for plane in self.planes:
            sign = _side_of_eye(plane, camera) if plane.to_eye else 1.0
            x, y, z = plane.normal
            normals.append((sign * x, sign * y, sign * z))
            offsets.append(sign * plane.offset)
        return HalfSpaces(tuple(normals), tuple(offsets))

    def transformed(self, matrix: ArrayLike) -> Cut:
        """The cut under a 4x4 matrix acting on columns.

        matrix (4,4): rows 0 to 2: rotation, scale and translation; result: in the moved planes.
        """
        found = HalfSpaces(tuple(p.normal for p in self.planes), tuple(p.offset for p in self.planes))
        moved = found.transformed(np.asarray(matrix, dtype=np.float64))
        planes = zip(self.planes, moved.normals, moved.offsets, strict=True)
        return replace(self, planes=tuple(CutPlane(normal, d, plane.to_eye) for plane, normal, d in planes))


def _side_of_eye(plane: CutPlane, camera: Camera) -> float:
    """1 where the eye is on the side to which the normal leads, -1 on the other."""
    normal = np.array(plane.normal)
    foot = plane.offset * normal
    way = camera.axes[2] if camera.parallel else np.asarray(camera.eye) - foot
    # To length 1 at most, for squares of large numbers have no room.
    way = way / max(float(np.abs(way).max()), 1.0)
    height = float(matmul(way, normal))
    if abs(height) <= EDGE_ON_SINE * float(norm(way)):
        raise InputError(f"cut: the plane {_equation(plane)} is seen edge-on: say < or >")
    return float(np.sign(height))


def _equation(plane: CutPlane) -> str:
    """A plane as conditions spell it: 0.6x - 0.8y = 2."""
    terms = [
        f"{'-' if part < 0.0 else '+'} {'' if abs(part) == 1.0 else f'{abs(part):g}'}{axis}"
        for part, axis in zip(plane.normal, "xyz", strict=True)
        if part
    ]
    first, *others = terms
    return " ".join([first.removeprefix("+ ").replace("- ", "-"), *others, f"= {plane.offset:g}"])


_SIGN = re.compile(r"<=|>=|<|>|=")
_TERM = re.compile(r"([+-]?)\s*(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)?\s*\*?\s*([xyz]?)\s*")


def _planes(condition: str, text: str) -> list[CutPlane]:
    """The planes of a condition: one for each of its signs."""
    signs = [sign.replace("<=", "<").replace(">=", ">") for sign in _SIGN.findall(condition)]
    sides = [_linear(side, text) for side in _SIGN.split(condition)]
    if not 1 <= len(signs) <= 2 or (len(signs) == 2 and (signs[0] != signs[1] or signs[0] == "=")):
        raise InputError(f"cut {text!r}: expected conditions such as y = 0, x + 2y > 3 or 0 < x < 2")
    found = []
    for sign, left, right in zip(signs, sides, sides[1:], strict=False):
        # Larger less smaller: positive in what is taken away.
        with np.errstate(over="ignore"):
            a, b, c, d = ((left - right) if sign != "<" else (right - left)).tolist()
        length = math.hypot(a, b, c)
        if length == 0.0:
            raise InputError(f"cut {text!r}: a condition on which x, y and z have no effect")
        if not (math.isfinite(length) and math.isfinite(d / length)):
            raise InputError(f"cut {text!r}: numbers out of range")
        found.append(CutPlane((a / length, b / length, c / length), -d / length + 0.0, sign == "="))
    return found


def _linear(side: str, text: str) -> np.ndarray:
    """(4,) what x, y, z and 1 are multiplied by in one side of a condition."""
    result, at, side = np.zeros(4), 0, side.strip()
    while at < len(side):
        term = _TERM.match(side, at)
        sign, number, axis = term.groups() if term else ("", None, "")
        if term is None or not (number or axis) or (at > 0 and not sign):
            raise InputError(f"cut {text!r}: {side[at:]!r} is not a sum of numbers, x, y and z")
        result["xyz".find(axis) if axis else 3] += float(sign + "1") * float(number or 1.0)
        at = term.end()
    if not np.isfinite(result).all():
        raise InputError(f"cut {text!r}: numbers out of range")
    if not side:
        raise InputError(f"cut {text!r}: expected conditions such as y = 0, x + 2y > 3 or 0 < x < 2")
    return result


def _condition(plane: CutPlane) -> str:
    terms = [(factor, axis) for factor, axis in zip(plane.normal, "xyz", strict=True) if factor]
    factor, axis = terms[0]
    if len(terms) > 1:
        factor, axis = 1.0, " + ".join(f"{one:.3g}{letter}" for one, letter in terms)
    sign = "=" if plane.to_eye else ">" if factor > 0.0 else "<"
    return f"{axis} {sign} {plane.offset / factor:g}"


# How the parts of a scene are to be moved apart.

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""Axes by their names."""


@dataclass(frozen=True)
class Explosion:
    """The parts of a scene are moved apart along an axis, as `vp.exploded` does it, when the scene is shown.

    axis: the first part stays, the others move along it; factor: see `vp.exploded`; moves: instead, how far each of
    some parts is moved, by the names of items or groups.
    """

    axis: str | tuple[float, float, float] = "z"
    factor: float = 1.5
    moves: tuple[tuple[str, Vector], ...] = ()

    def __post_init__(self) -> None:
        _ = self.way
        if not 1.0 <= self.factor < np.inf:
            raise InputError(f"explode: a factor of {self.factor:g}: expected a finite number, 1 or more")

    @property
    def way(self) -> Floats:
        """(3,) the direction of the axis, of length 1."""
        return direction_of(self.axis)

    def transformed(self, matrix: ArrayLike) -> Explosion:
        """The explosion under a 4x4 matrix acting on columns.

        matrix: (4, 4) rows 0 to 2: rotation, scale and translation.
        """
        linear = np.asarray(matrix, dtype=np.float64)[:3, :3]
        x, y, z = matmul(linear, self.way).tolist()
        moved = [(name, matmul(linear, np.array(step)).tolist()) for name, step in self.moves]
        return replace(self, axis=(x, y, z), moves=tuple((name, (a, b, c)) for name, (a, b, c) in moved))


def direction_of(axis: str | Sequence[float] | ArrayLike) -> Floats:
    """(3,) the direction, of length 1, of an axis by its name or its numbers. Errors: InputError for what is none."""
    way = np.asarray(AXES.get(axis, (0.0, 0.0, 0.0)) if isinstance(axis, str) else axis, dtype=np.float64)
    if way.shape != (3,) or not np.isfinite(way).all() or not way.any():
        raise InputError(f"explode: an axis {axis!r}: expected x, y, z or a direction")
    way = way / np.abs(way).max()
    return np.asarray(way / norm(way))
