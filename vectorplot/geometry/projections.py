"""Projections: images with depths, collineations, and the world, screen and light systems of cameras and lamps.

The eye stands on the positive z-axis at a distance d, the image plane is z = 0. Points are rows.

Source: Glaeser, section 2.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.elementary import tan
from vectorplot.geometry.rotations import look_rotation
from vectorplot.geometry.vectors import length
from vectorplot.tolerances import INFINITE, LARGEST_VIEW, NEAR_OF_DISTANCE, NO_DIGITS_OF_EXTENT, ULP, ZERO_OF_EXTENT

# The two transformations of space to images: images with depths, and the collineation, which keeps planes plane.


def project(points: ArrayLike, distance: float) -> Floats:
    """T1: the points of a system with their images for x and y, and their depth z.

    Parameters
    ----------
    points : (..., 3) array_like of float
        With the eye on the z-axis.
    distance : float
        Of the eye from the image plane z = 0, may be infinite (then nothing changes).

    Returns
    -------
    (..., 3) array of float
        Image x and y, and depth.

    Raises
    ------
    InputError
        For points on or behind the neutral plane z = d: clip them first.

    Notes
    -----
    Not linear: straight edges bend.

    Source: Glaeser, sections 2.1, equations 6 to 8, and 2.3, equations 15 and 16.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.project([(1, 2, 0), (1, 2, 5)], distance=10.0).tolist()
    [[1.0, 2.0, 0.0], [2.0, 4.0, 5.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    images = p.copy()
    images[..., :2] *= _scale(p, distance)
    return images


def unproject(images: ArrayLike, distance: float) -> Floats:
    """The inverse of T1: points from their images and depths.

    images: (..., 3) image x and y, and depth; result: (..., 3) in the system.
    """
    p = np.asarray(images, dtype=np.float64)
    points = p.copy()
    points[..., :2] /= _scale(p, distance)
    return points


def collineate(points: ArrayLike, distance: float, factor: float | None = None) -> Floats:
    """T2: the points with their images for x and y and the depth z* = k lambda z, lambda = d / (d - z).

    Parameters
    ----------
    points : (..., 3) array_like of float
        With the eye on the z-axis.
    distance : float
        Of the eye from the image plane: the d of the equation.
    factor : float, optional
        The k of the equation; 1 / d where None, so that z* = z / (d - z).

    Returns
    -------
    (..., 3) array of float
        Image x and y, and z*.

    Raises
    ------
    InputError
        For points on or behind the neutral plane, and for the factor 0.

    Notes
    -----
    Linear: planes go to planes, and z* keeps the order of z. The image plane stays fixed for every k; the centre of the
    collineation is (0, 0, d (1 - k)) (erratum G2-04).

    Edge cases: at an infinite distance lambda is 1, and k must be given, or is 1.

    Source: Glaeser, section 2.3, equations 17 to 21.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.collineate([(1, 2, 0), (1, 2, 5)], distance=10.0).tolist()
    [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    scale = np.ones(3) * _scale(p, distance)
    scale[..., 2] *= _factor(distance, factor)
    return np.asarray(p * scale)


def uncollineate(images: ArrayLike, distance: float, factor: float | None = None) -> Floats:
    """The inverse of T2: points from their images and depths z*.

    images: (..., 3) image x and y, and z*; result: (..., 3) in the system.
    Source: Glaeser, section 2.3, equation 22.
    """
    p = np.asarray(images, dtype=np.float64)
    # z* = k d z / (d - z), hence 1 / lambda = k d / (k d + z*).
    k = _factor(distance, factor)
    shrink = np.ones(p.shape[:-1]) if distance == INFINITE else k * distance / (k * distance + p[..., 2])
    return np.asarray(p * shrink[..., None] / np.array([1.0, 1.0, k]))


def depth_of(star: ArrayLike, distance: float) -> Floats:
    """The depths z (...) of T2 depths z* (...): d z* / (1 + z*). Source: Glaeser, section 2.3, equation 22."""
    s = np.asarray(star, dtype=np.float64)
    return np.asarray(distance * s / (1.0 + s))


def _factor(distance: float, factor: float | None) -> float:
    if factor is None:
        return 1.0 if distance == INFINITE else 1.0 / distance
    if factor == 0.0:
        raise InputError("a collineation with factor 0 flattens space")
    return factor


def _scale(points: Floats, distance: float) -> Floats:
    """(..., 1) lambda = d / (d - z)."""
    if distance == INFINITE:
        return np.ones((*points.shape[:-1], 1))
    gap = distance - points[..., 2:]
    if not np.all(gap > 0.0):
        raise InputError(f"{int((~(gap > 0.0)).sum())} points lie on or behind the neutral plane: clip them first")
    return np.asarray(distance / gap)


# World, screen and light systems: one type for all, central and parallel projection alike.
#
# In a system the eye (or the lamp) stands on the positive z-axis at a distance d, the target is the origin, and the
# image plane is z = 0. Depth z is the signed distance from it, larger = closer to the eye. Points are rows. Source:
# Glaeser, sections 2.1 to 2.4.


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

        camera: the eye; result: with the target as the origin.
        """
        return cls(np.array(camera.target), camera.axes.T, INFINITE if camera.parallel else camera.distance)

    @classmethod
    def of_screen(cls, camera: Camera, window: PixelWindow, enlarge: float = 1.0) -> CoordinateSystem:
        """A camera's system, in which images are measured in pixels: the field of vision fills the window's height.

        camera: the eye; window: the screen; enlarge: a zoom about the middle that leaves the field of vision, and so
        the perspective, as it is; result: with the target in the middle of the window.
        Source: Glaeser, sections 2.3, equations 11 to 14, and 2.4; errata G2-02, G2-03, G2-06.
        Errors: for an enlargement that is not positive and finite.
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

        position (3,): of the lamp, in the world; target (3,): what it shines at; result: a central projection.
        Source: Glaeser, section 2.4.
        Errors: for a lamp in the target.
        """
        ray = np.asarray(position, dtype=np.float64) - np.asarray(target, dtype=np.float64)
        return cls(np.asarray(target, dtype=np.float64), look_rotation(ray), float(length(ray)))

    @classmethod
    def of_parallel_light(cls, direction: ArrayLike, target: ArrayLike = (0.0, 0.0, 0.0)) -> CoordinateSystem:
        """The system of parallel rays, such as sunlight.

        direction (3,): where they come from, of any length but zero; target (3,): the origin; result: a parallel
        projection.
        Errors: for a direction without length.
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

        points (...,3): in the world; result: (...,3) in world units.
        """
        return np.asarray(matmul(np.asarray(points, dtype=np.float64) - self.target, self.rotation))

    def forbidden(self, points: ArrayLike) -> Bools:
        """Which world points lie on or behind the neutral plane through the eye: they have no image.

        points (...,3): in the world; result: (...) all False in a parallel projection.
        """
        return np.asarray(self.rotated(points)[..., 2] >= self.distance)

    def from_world(self, points: ArrayLike) -> Floats:
        """World points in this system.

        points (...,3): in the world; result: (...,3) image x and y, and depth.
        Source: Glaeser, section 2.4 (world to screen, world to light).
        Errors: for forbidden points: clip them first.
        """
        images = project(self.rotated(points), self.distance)
        images[..., :2] = np.array(self.middle) + images[..., :2] * np.array(self.scale)
        return images

    def to_world(self, points: ArrayLike) -> Floats:
        """Points of this system in the world.

        points (...,3): image x and y, and depth; result: (...,3) in the world.
        Errors: for depths on or behind the neutral plane.
        """
        images = np.array(points, dtype=np.float64)
        images[..., :2] = (images[..., :2] - np.array(self.middle)) / np.array(self.scale)
        return np.asarray(matmul(unproject(images, self.distance), self.rotation.T) + self.target)

    def homogeneous(self, points: ArrayLike) -> Floats:
        """World points after T2, in homogeneous coordinates of pixels x, y and depth z*.

        points (...,3): in the world; result: (...,4) the last component is positive in front of the neutral plane.
        Every point has them, forbidden ones too: clip here.
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


# A camera's projection of a scene, in the unit box: from the world to the image, and back.

ULPS = 16.0
"""Fewer rounding steps of the largest coordinate than these count as zero too."""

FARTHEST_OFF_AXIS_DEG = 60.0
"""A picture that is fitted to the page shows what lies up to so many degrees off the principal ray."""


@dataclass(frozen=True, eq=False)
class Projection:
    """How a camera sees a scene: axes x right, y up, z towards the eye, the scene in the unit box. eye (3,), None for a
    parallel projection along z; target (3,); near: the smallest depth drawn; picture_height: in the image plane;
    tolerance: what counts as distance zero; centre (3,): the origin, in the world; axes (3,3): unit rows right, up
    and back, in the world.
    Source: Glaeser, sections 2.1 and 2.4.
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

    @property
    def world_eye(self) -> Floats:
        """(4,) the eye in the world, (x, y, z, 1); (x, y, z, 0) for the rays from there of a parallel projection."""
        if self.eye is None:
            return np.append(self.axes[2], 0.0)
        return np.append(self.world_of(self.eye[:, None])[0], 1.0)

    def depth_of(self, points: Floats) -> Floats:
        """The depths of points.

        points: (3, n) in the projection's coordinates; result: (n,) from the eye along the principal ray.
        """
        return np.asarray(-points[2] if self.eye is None else self.eye[2] - points[2], dtype=np.float64)

    def image_of(self, points: Floats) -> Floats:
        """The images of points.

        points: (3, n) in the projection's coordinates; result: (2, n) in the image plane, with the origin where the
        principal ray meets it.
        Edge cases: points nearer than the near plane get the image of a point at the near plane.
        """
        if self.eye is None:
            return points[:2] - self.target[:2, None]
        factor = self.focus / np.maximum(self.depth_of(points), self.near)
        return (points[:2] - self.eye[:2, None]) * factor

    def points_of(self, world: Floats) -> Floats:
        """Points of the world in the projection's coordinates.

        world: (n, 3) in world units; result: (3, n) about -1 to 1 for what is in the scene.
        """
        return np.asarray(matmul(self.axes / self.scale, (world - self.centre).T), dtype=np.float64)

    def in_image_plane(self, image: Floats) -> Floats:
        """(3, n) the points of the image plane, in the projection's coordinates, whose images (2, n) these are."""
        across = self.target if self.eye is None else self.eye
        height = 0.0 if self.eye is None else self.eye[2] - self.focus
        return np.concatenate([image + across[:2, None], np.full((1, image.shape[1]), height)])

    def world_of(self, points: Floats) -> Floats:
        """Points of the projection in world coordinates.

        points: (3, n) in the projection's coordinates; result: (n, 3) in world units.
        """
        return np.ascontiguousarray((matmul(self.scale * self.axes.T, points)).T + self.centre)

    @cached_property
    def image_from_world(self) -> Floats:
        """(3,4) homogeneous image coordinates, see image but in world units, from world points (x,y,z,1)."""
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

        points: (3, n) in the projection's coordinates, as many arrays as there are.
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
    """A camera's projection of the box bounds (2,3), normalised about its middle so that no later decision depends on
    size or place.
    Edge cases: a box without extent takes the camera's distance, or height, for its size. Errors: InputError where that
    is so small, or the eye so far, that coordinates have no digits left; or so large that eye and target are one.
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
