"""World, screen and light systems: one type for all, central and parallel projection alike.

In a system the eye (or the lamp) stands on the positive z-axis at a distance d, the target is the origin, and the image
plane is z = 0. Depth z is the signed distance from it, larger = closer to the eye. Points are rows.
Source: Glaeser, sections 2.1 to 2.4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.collineation import project, unproject
from vectorplot.geometry.cameras.pixel_window import PixelWindow
from vectorplot.geometry.rotations import look_rotation
from vectorplot.geometry.vectors import length
from vectorplot.tolerances.of_extent import NEAR_OF_DISTANCE
from vectorplot.tolerances.of_numbers import INFINITE


@dataclass(frozen=True, eq=False)
class CoordinateSystem:
    """Coordinates of space as the world, a screen or a lamp has them: image x and y, and depth z.

    Parameters
    ----------
    target : (3,) array of float
        The origin, in the world.
    rotation : (3, 3) array of float
        Carries world directions, as rows, into the system.
    distance : float
        Of the centre of projection from the target, infinite for a parallel one.
    scale, middle : (float, float)
        pixel = middle + scale * image.
    near : float
        How far the near plane is from the centre, as a part of that distance.

    Raises
    ------
    InputError
        From its functions: for impossible enlargements, lamps in the target, the centre of a parallel projection, and
        points without an image.

    Notes
    -----
    The world itself is the parallel projection along z: world().

    Source: Glaeser, sections 2.1 to 2.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> system = geometry.CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> system.from_world([(1, 2, 0), (1, 2, 5)]).tolist()
    [[1.0, 2.0, 0.0], [2.0, 4.0, 5.0]]
    >>> system.to_world([(2, 4, 5)]).tolist()
    [[1.0, 2.0, 5.0]]
    """

    target: Floats
    rotation: Floats
    distance: float = INFINITE
    scale: tuple[float, float] = (1.0, 1.0)
    middle: tuple[float, float] = (0.0, 0.0)
    near: float = NEAR_OF_DISTANCE

    @classmethod
    def world(cls) -> CoordinateSystem:
        """The world's own system, in which nothing changes."""
        return cls(np.zeros(3), np.eye(3))

    @classmethod
    def of_image(cls, camera: Camera) -> CoordinateSystem:
        """A camera's system, in which images are measured in world units in the image plane.

        Parameters
        ----------
        camera : Camera
            The eye.

        Returns
        -------
        CoordinateSystem
            With the target as the origin.
        """
        return cls(np.array(camera.target), camera.axes.T, INFINITE if camera.parallel else camera.distance)

    @classmethod
    def of_screen(cls, camera: Camera, window: PixelWindow, enlarge: float = 1.0) -> CoordinateSystem:
        """A camera's system, in which images are measured in pixels: the field of vision fills the window's height.

        Parameters
        ----------
        camera : Camera
            The eye.
        window : PixelWindow
            The screen.
        enlarge : float
            A zoom about the middle that leaves the field of vision, and so the perspective, as it is.

        Returns
        -------
        CoordinateSystem
            With the target in the middle of the window.

        Raises
        ------
        InputError
            For an enlargement that is not positive and finite.

        Notes
        -----
        Source: Glaeser, sections 2.3, equations 11 to 14, and 2.4; errata G2-02, G2-03, G2-06.
        """
        if not 0.0 < enlarge < np.inf:
            raise InputError(f"an enlargement by {enlarge:g} leaves no picture")
        across = enlarge * window.height / camera.picture_height
        distance = INFINITE if camera.parallel else camera.distance
        scale = (across, across * window.pixel_ratio)
        middle = (window.width / 2.0, window.height / 2.0)
        return cls(np.array(camera.target), camera.axes.T, distance, scale, middle)

    @classmethod
    def of_light(cls, position: ArrayLike, target: ArrayLike = (0.0, 0.0, 0.0)) -> CoordinateSystem:
        """The system of a lamp: a camera without twist, whose images are shadows in the plane through the target.

        Parameters
        ----------
        position : (3,) array_like of float
            Of the lamp, in the world.
        target : (3,) array_like of float
            What it shines at.

        Returns
        -------
        CoordinateSystem
            A central projection.

        Raises
        ------
        InputError
            For a lamp in the target.

        Notes
        -----
        Source: Glaeser, section 2.4.
        """
        ray = np.asarray(position, dtype=np.float64) - np.asarray(target, dtype=np.float64)
        return cls(np.asarray(target, dtype=np.float64), look_rotation(ray), float(length(ray)))

    @classmethod
    def of_parallel_light(cls, direction: ArrayLike, target: ArrayLike = (0.0, 0.0, 0.0)) -> CoordinateSystem:
        """The system of parallel rays, such as sunlight.

        Parameters
        ----------
        direction : (3,) array_like of float
            Where they come from, of any length but zero.
        target : (3,) array_like of float
            The origin.

        Returns
        -------
        CoordinateSystem
            A parallel projection.

        Raises
        ------
        InputError
            For a direction without length.
        """
        return cls(np.asarray(target, dtype=np.float64), look_rotation(direction))

    @property
    def inverse_rotation(self) -> Floats:
        """(3, 3) from the system to the world; its rows are right, up and back."""
        return self.rotation.T

    @property
    def centre(self) -> Floats:
        """(3,) where the eye or lamp is, in the world. Errors: InputError for a parallel projection."""
        if self.distance == INFINITE:
            raise InputError("the centre of a parallel projection is infinitely far away")
        return np.asarray(self.target + self.distance * self.rotation[:, 2])

    def rotated(self, points: ArrayLike) -> Floats:
        """World points with the target as the origin and the eye on the z-axis, not yet projected.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In the world.

        Returns
        -------
        (..., 3) array of float
            In world units.
        """
        return np.asarray(matmul(np.asarray(points, dtype=np.float64) - self.target, self.rotation))

    def forbidden(self, points: ArrayLike) -> Bools:
        """Which world points lie on or behind the neutral plane through the eye: they have no image.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In the world.

        Returns
        -------
        (...) array of bool
            All False in a parallel projection.
        """
        return np.asarray(self.rotated(points)[..., 2] >= self.distance)

    def from_world(self, points: ArrayLike) -> Floats:
        """World points in this system.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In the world.

        Returns
        -------
        (..., 3) array of float
            Image x and y, and depth.

        Raises
        ------
        InputError
            For forbidden points: clip them first.

        Notes
        -----
        Source: Glaeser, section 2.4 (world to screen, world to light).
        """
        images = project(self.rotated(points), self.distance)
        images[..., :2] = np.array(self.middle) + images[..., :2] * np.array(self.scale)
        return images

    def to_world(self, points: ArrayLike) -> Floats:
        """Points of this system in the world.

        Parameters
        ----------
        points : (..., 3) array_like of float
            Image x and y, and depth.

        Returns
        -------
        (..., 3) array of float
            In the world.

        Raises
        ------
        InputError
            For depths on or behind the neutral plane.
        """
        images = np.array(points, dtype=np.float64)
        images[..., :2] = (images[..., :2] - np.array(self.middle)) / np.array(self.scale)
        return np.asarray(matmul(unproject(images, self.distance), self.rotation.T) + self.target)

    def homogeneous(self, points: ArrayLike) -> Floats:
        """World points after T2, in homogeneous coordinates of pixels x, y and depth z*.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In the world.

        Returns
        -------
        (..., 4) array of float
            The last component is positive in front of the neutral plane. Every point has them, forbidden ones too: clip
            here.

        Notes
        -----
        The depth is z / (d - z); in a parallel projection z itself.
        """
        right, up, back = self.rotation.T
        sunk = np.zeros(3) if self.distance == INFINITE else back / self.distance
        (x, y), (across, upward) = self.middle, self.scale
        depth = back if self.distance == INFINITE else sunk
        # One product of matrices: millions of points pass here.
        rows = np.stack([across * right - x * sunk, upward * up - y * sunk, depth, -sunk], axis=1)
        result = matmul(np.asarray(points, dtype=np.float64) - self.target, rows)
        result += (x, y, 0.0, 1.0)
        return np.asarray(result)
