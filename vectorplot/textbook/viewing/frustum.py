"""The viewing pyramid as a body in the world."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.collineation import depth_of
from vectorplot.geometry.cameras.coordinate_system import CoordinateSystem
from vectorplot.geometry.clipping.clip_windows import Box
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_numbers import INFINITE

_CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
_FACES = ([0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4])


@dataclass(frozen=True, eq=False)
class Frustum:
    """What a system shows of the world: the frustum between the far and the near plane, inside the clipping window.

    Parameters
    ----------
    system : CoordinateSystem
        Of the eye.
    box : Box
        The clipping window, and the depths after T2 of the far and the near plane.

    Raises
    ------
    InputError
        For depths that are not in front of the neutral plane.

    Notes
    -----
    In a parallel projection it is a box, and the depths of the clipping box are those of the system.

    Source: Glaeser, sections 2.2 and 2.5, figures 3, 4 and 11.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import Box, CoordinateSystem, Window
    >>> from vectorplot.textbook import Frustum
    >>> system = CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> frustum = Frustum(system, Box(Window(-1, 1, -1, 1), -0.5, 1.0))
    >>> frustum.depths, frustum.mesh.face_count
    ((-10.0, 5.0), 6)
    >>> frustum.contains([(0, 0, 0), (1.5, 0, 0), (1.5, 0, -9)]).tolist()
    [True, False, True]
    """

    system: CoordinateSystem
    box: Box

    def __post_init__(self) -> None:
        if self.system.distance != INFINITE and not -1.0 < self.box.min_z < self.box.max_z < INFINITE:
            raise InputError("near and far plane must lie in front of the neutral plane: -1 < far < near after T2")

    @property
    def depths(self) -> tuple[float, float]:
        """Depths of the far and of the near plane in the system."""
        if self.system.distance == INFINITE:
            return self.box.min_z, self.box.max_z
        far, near = depth_of([self.box.min_z, self.box.max_z], self.system.distance)
        return float(far), float(near)

    @property
    def corners(self) -> Floats:
        """(8, 3) in the world: far ones first, then lower ones, then left ones."""
        w, (far, near) = self.box.window, self.depths
        limits = np.array([[w.min_x, w.min_y, far], [w.max_x, w.max_y, near]])
        return self.system.to_world(np.take_along_axis(limits, _CORNERS, axis=0))

    @property
    def mesh(self) -> Mesh:
        """The frustum as a solid: far, near, left, right, upper and lower face."""
        turned = np.prod(np.sign(self.system.scale)) < 0.0
        mesh = Mesh.from_polygons(self.corners, _FACES)
        return mesh.reversed() if turned else mesh

    @property
    def box_mesh(self) -> Mesh:
        """The same solid after T2: a box."""
        w = self.box.window
        limits = np.array([[w.min_x, w.min_y, self.box.min_z], [w.max_x, w.max_y, self.box.max_z]])
        return Mesh.from_polygons(np.take_along_axis(limits, _CORNERS, axis=0), _FACES)

    def contains(self, points: ArrayLike) -> Bools:
        """Which world points lie inside or on the border.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In the world.

        Returns
        -------
        (...) array of bool
            False for what lies behind the eye.
        """
        return np.asarray((matmul(self.system.homogeneous(points), self.box.planes.T) >= 0.0).all(axis=-1))
