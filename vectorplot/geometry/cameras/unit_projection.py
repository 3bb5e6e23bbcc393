"""A camera's projection of a scene, in the unit box: from the world to the image, and back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.elementary import tan
from vectorplot.tolerances.of_extent import NEAR_OF_DISTANCE, NO_DIGITS_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LARGEST_VIEW, ULP

ULPS = 16.0
"""Fewer rounding steps of the largest coordinate than these count as zero too."""

FARTHEST_OFF_AXIS_DEG = 60.0
"""A picture that is fitted to the page shows what lies up to so many degrees off the principal ray."""


@dataclass(frozen=True, eq=False)
class Projection:
    """How a camera sees a scene: axes x right, y up, z towards the eye, the scene in the unit box.

    Parameters
    ----------
    eye : (3,) array of float, optional
        For a parallel projection None: then every ray runs along +z.
    target : (3,) array of float
        Where the camera looks.
    focus : float
        Depth of the image plane, which is put into the middle of the scene.
    near : float
        The smallest depth that is drawn.
    picture_height : float
        Of the camera's picture in the image plane.
    tolerance : float
        What counts as distance zero.
    centre : (3,) array of float
        The middle of the scene, in the world: the origin of the projection's coordinates.
    scale : float
        Half the largest side of the scene, in world units: the largest coordinate is about 1.
    axes : (3, 3) array of float
        Unit rows right, up and back, in the world.

    Notes
    -----
    World from view: point = centre + scale * (p @ axes).

    Source: Glaeser, sections 2.1 and 2.4.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> bounds = np.array([(-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)])
    >>> top = geometry.projection_of(vp.Camera.view("top"), bounds)
    >>> points = top.points_of(np.array([(2.0, 1.0, 2.0)]))
    >>> points.T.tolist(), top.image_of(points).T.tolist(), top.world_of(points).tolist()
    ([[1.0, 0.5, 1.0]], [[1.0, 0.5]], [[2.0, 1.0, 2.0]])
    """

    eye: Floats | None
    target: Floats
    focus: float
    near: float
    picture_height: float
    tolerance: float
    centre: Floats
    scale: float
    axes: Floats

    def depth_of(self, points: Floats) -> Floats:
        """The depths of points.

        Parameters
        ----------
        points : (3, n) array of float
            In the projection's coordinates.

        Returns
        -------
        (n,) array of float
            From the eye along the principal ray; in a parallel projection from the middle of the scene, away from the
            eye.
        """
        return np.asarray(-points[2] if self.eye is None else self.eye[2] - points[2], dtype=np.float64)

    def image_of(self, points: Floats) -> Floats:
        """The images of points.

        Parameters
        ----------
        points : (3, n) array of float
            In the projection's coordinates.

        Returns
        -------
        (2, n) array of float
            In the image plane, with the origin where the principal ray meets it.

        Notes
        -----
        Degenerate: points nearer than the near plane get the image of a point at the near plane.
        """
        if self.eye is None:
            return points[:2] - self.target[:2, None]
        factor = self.focus / np.maximum(self.depth_of(points), self.near)
        return (points[:2] - self.eye[:2, None]) * factor

    def points_of(self, world: Floats) -> Floats:
        """Points of the world in the projection's coordinates.

        Parameters
        ----------
        world : (n, 3) array of float
            In world units.

        Returns
        -------
        (3, n) array of float
            About -1 to 1 for what is in the scene.
        """
        return np.asarray(matmul(self.axes / self.scale, (world - self.centre).T), dtype=np.float64)

    def world_of(self, points: Floats) -> Floats:
        """Points of the projection in world coordinates.

        Parameters
        ----------
        points : (3, n) array of float
            In the projection's coordinates.

        Returns
        -------
        (n, 3) array of float
            In world units.
        """
        return np.ascontiguousarray((matmul(self.scale * self.axes.T, points)).T + self.centre)

    @cached_property
    def image_from_world(self) -> Floats:
        """(3,4) homogeneous image coordinates, as of image but in world units, from world points (x,y,z,1)."""
        rotation = np.zeros((4, 4))
        rotation[:3, :3] = self.axes / self.scale
        rotation[:3, 3] = matmul(-self.axes, self.centre / self.scale)
        rotation[3, 3] = 1.0
        if self.eye is None:
            rows = np.array([[1.0, 0, 0, -self.target[0]], [0, 1.0, 0, -self.target[1]], [0, 0, 0, 1.0]])
        else:
            x, y, z = self.eye
            d = self.focus
            rows = np.array([[d, 0, 0, -d * x], [0, d, 0, -d * y], [0, 0, -1.0, z]])
        rows[:2] *= self.scale
        return np.asarray(matmul(rows, rotation), dtype=np.float64)

    @property
    def distance(self) -> float:
        """From the eye to the target; infinite in a parallel projection."""
        return np.inf if self.eye is None else float(self.eye[2] - self.target[2])

    def reaches_too_far(self, *points: Floats) -> bool:
        """Whether any of some points is too near, or too far off the principal ray, to be fitted to a page.

        Parameters
        ----------
        points : (3, n) array of float
            In the projection's coordinates, as many arrays as there are.

        Returns
        -------
        bool
            False in a parallel projection; else True for points nearer than the near plane or more than 60 degrees off.
        """
        if self.eye is None:
            return False
        limit = self.focus * tan(np.radians(FARTHEST_OFF_AXIS_DEG))
        return any(
            self.depth_of(some).min() < self.near or np.abs(self.image_of(some)).max() > limit
            for some in points
            if some.shape[1]
        )


def projection_of(camera: Camera, bounds: Floats) -> Projection:
    """A camera's projection of a box, normalised so that no later decision depends on its size or place.

    Parameters
    ----------
    camera : Camera
        Where the eye is, and how it looks.
    bounds : (2, 3) array of float
        Smallest and largest coordinates of the scene.

    Returns
    -------
    Projection
        With its origin in the middle of the box.

    Raises
    ------
    InputError
        Where this is so small, or the eye so far away, that its coordinates have no digits left; or so large beside the
        distance from the eye to its target that these are one.

    Notes
    -----
    Degenerate: a box without extent takes the camera's distance, or height, for its size.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> bounds = np.array([(0.0, 0.0, 0.0), (8.0, 4.0, 2.0)])
    >>> projection = geometry.projection_of(vp.Camera((4, 2, 21), (4, 2, 1), up=(0, 1, 0)), bounds)
    >>> projection.centre.tolist(), projection.scale, projection.eye.tolist(), projection.distance
    ([4.0, 2.0, 1.0], 4.0, [0.0, 0.0, 5.0], 5.0)
    """
    low, high = bounds
    # What is out of range by overflow is told below.
    with np.errstate(over="ignore"):
        centre, scale = (low + high) / 2.0, float((high - low).max()) / 2.0
    if not scale > 0.0:
        scale = camera.distance if not camera.parallel or camera.height is None else camera.height
    if not 1.0 / LARGEST_VIEW < scale < LARGEST_VIEW or not camera.distance < LARGEST_VIEW:
        raise InputError(f"an extent of {2.0 * scale:g}, seen from {camera.distance:g} away, is out of range")
    largest = max(float(np.abs(low).max()), float(np.abs(high).max()))
    noise = ULPS * ULP * largest / scale
    if noise > NO_DIGITS_OF_EXTENT:
        raise InputError("the scene is too small for its distance from the origin: its coordinates have no digits left")
    if not camera.parallel and camera.distance <= ULPS * ULP * scale:
        raise InputError("the eye is too near to its target for a scene of this size: nothing keeps them apart")
    axes = camera.axes
    eye = None if camera.parallel else matmul(axes, (np.asarray(camera.eye) - centre) / scale)
    focus = 1.0 if eye is None else max(float(eye[2]), 1.0)
    return Projection(
        eye=eye,
        target=matmul(axes, (np.asarray(camera.target) - centre) / scale),
        focus=focus,
        near=-np.inf if eye is None else NEAR_OF_DISTANCE * min(camera.distance / scale, 1.0),
        picture_height=camera.picture_height / scale * (1.0 if eye is None else focus * scale / camera.distance),
        tolerance=max(ZERO_OF_EXTENT, noise),
        centre=centre,
        scale=scale,
        axes=axes,
    )
