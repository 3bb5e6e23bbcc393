"""Round bodies of a scene as its eye sees them: images of unit bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import inverse_matrix, matmul
from vectorplot.scene.item import Item
from vectorplot.scene.view import View
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates, eye_coordinates


@dataclass(frozen=True, eq=False)
class UnitBodies:
    """Images of unit bodies in the coordinates of sight: the points centre + s @ frame; centre (n,3), frame (n,3,3),
    item (n,); hides (n,); tolerance: what counts as distance zero."""

    sight: EyeCoordinates
    centre: Floats
    frame: Floats
    item: Ints
    hides: Bools
    tolerance: float

    def __len__(self) -> int:
        return len(self.item)

    @cached_property
    def inverse(self) -> Floats:
        """(n,3,3): s = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(self.frame))


class Placed(Protocol):
    """A body of the world: the points centre + s @ frame of a unit body."""

    @property
    def centre(self) -> Any:
        """(3,)."""

    @property
    def frame(self) -> Any:
        """(3,3)."""


def bodies_in_sight(view: View, items: Sequence[Item], which: Ints, bodies: Sequence[Placed]) -> UnitBodies:
    """Bodies of the world, those of the items which (n,), as the eye of a view sees them."""
    sight = eye_coordinates(view)
    centre = np.array([body.centre for body in bodies]).reshape(-1, 3)
    frame = np.array([body.frame for body in bodies]).reshape(-1, 3, 3)
    turned = view.axes.T / view.scale
    hides = np.array([items[k].hides for k in which.tolist()], dtype=np.bool_)
    in_view = matmul(centre - view.centre, turned)
    return UnitBodies(sight, sight.points(in_view), sight.vectors(matmul(frame, turned)), which, hides, view.tolerance)
