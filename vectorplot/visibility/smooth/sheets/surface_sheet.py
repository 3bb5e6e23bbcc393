"""A smooth surface as the engine sees it: known exactly at places, and roughly by a tessellation."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import cross, dot


class OnSheet(Protocol):
    """What is known at places (k,3) on a smooth surface, in the view's coordinates.

    A place says where on the sheet something is: parameters (u, v, 0) of a parametrised surface, the point itself of an
    implicit one; and on which of several, where they are asked as one (see parametric_places).
    """

    def points(self, places: Floats) -> Floats:
        """(k,3) points."""
        ...

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals; NaN at singular points."""
        ...

    def bends(self, places: Floats, directions: Floats) -> Floats:
        """(k,) how strongly the sheet bends towards its normal along the tangential parts of directions (k,3): the
        normal part of the acceleration of a path with that velocity."""
        ...

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps (k,3) lead to, to first order."""
        ...

    def inwards(self, places: Floats) -> Floats:
        """(k,3) tangents into the sheet at places on its border; 0 elsewhere."""
        ...

    def turnings(self, places: Floats) -> Floats:
        """(k,3) the direction to which both wings of a cuspidal edge turn, at places on it."""
        ...

    def missed(self, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3): one Newton step for where lines points + t ways meet the sheet: t, and the places there; and
        the points (k,3) of the sheet at the places from which the step is taken."""
        ...

    def apart(self, one: Floats, two: Floats) -> Floats:
        """(k,) how far places are from each other as parts of the domain; whole periods do not count."""
        ...

    def on_sheet(self, places: Floats) -> Bools:
        """(k,) whether places lie in the domain."""
        ...


class Sheet(OnSheet, Protocol):
    """A smooth surface in the view's coordinates."""

    @property
    def item(self) -> int:
        """The item it belongs to."""
        ...

    @property
    def hides(self) -> bool:
        """Whether it hides what is behind it."""
        ...

    @property
    def vertices(self) -> Floats:
        """(m,3) points of a tessellation, on the sheet."""
        ...

    @property
    def vertex_places(self) -> Floats:
        """(m,3) their places."""
        ...

    @property
    def corners(self) -> Ints:
        """(t,3) the vertices of its triangles."""
        ...

    @property
    def sags(self) -> Floats:
        """(t,) how far its triangles are off the sheet, about."""
        ...


def solved(a: Floats, b: Floats, c: Floats, right: Floats) -> Floats:
    """(k,3) the x with x0 a + x1 b + x2 c = right, for rows of vectors (k,3); not finite where they lie in a plane."""
    bc = cross(b, c)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        factor = 1.0 / dot(a, bc)
        return np.stack(
            [dot(right, bc) * factor, dot(right, cross(c, a)) * factor, dot(right, cross(a, b)) * factor], axis=1
        )
