"""The matrices of the viewing pipeline. Points are columns: a point p goes to matrix @ p, the first of several stands
right.

Camera coordinates: x right, y up, z towards the eye; what is seen has z < 0, and so near and far are negative numbers.
Source: viewing-transformation lecture; errata V-01 to V-05.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import length, normalize
from vectorplot.tolerances.of_angles import PARALLEL_SINE


def homogeneous(points: ArrayLike) -> Floats:
    """Homogeneous coordinates (..., k+1) of points (..., k), last component 1."""
    p = np.asarray(points, dtype=np.float64)
    return np.concatenate([p, np.ones((*p.shape[:-1], 1))], axis=-1)


def dehomogenized(points: ArrayLike) -> Floats:
    """The points (..., k) of homogeneous coordinates (..., k+1), which may carry any common factor.

    Errors: InputError for points at infinity (last component 0).
    """
    p = np.asarray(points, dtype=np.float64)
    if np.any(p[..., -1] == 0.0):
        raise InputError("a point at infinity has no coordinates")
    return np.asarray(p[..., :-1] / p[..., -1:])


def transformed(matrix: ArrayLike, points: ArrayLike) -> Floats:
    """The points (..., k) under a homogeneous matrix (k+1, k+1), after division by the last component."""
    return dehomogenized(homogeneous(points) @ np.asarray(matrix, dtype=np.float64).T)


def window_transform(source: ArrayLike, target: ArrayLike) -> Floats:
    """The matrix (k+1, k+1) that carries one box to another, translate, scale, translate: k = 2 windows, k = 3 boxes.

    source, target (2, k): two opposite corners each, in the same order; a target may run backwards, which mirrors.
    Errors: InputError for a source box without extent.
    """
    s, t = np.asarray(source, dtype=np.float64), np.asarray(target, dtype=np.float64)
    if np.any(s[0] == s[1]):
        raise InputError("a window without extent cannot be mapped")
    k = s.shape[1]
    matrix = np.eye(k + 1)
    matrix[np.arange(k), np.arange(k)] = (t[1] - t[0]) / (s[1] - s[0])
    matrix[:k, k] = (t[0] * s[1] - t[1] * s[0]) / (s[1] - s[0])
    return matrix


def viewport(columns: int, rows: int) -> Floats:
    """The matrix (4, 4) from the square [-1, 1]^2 to an image of so many pixels, whose centres are the integers: the
    image is [-1/2, columns - 1/2] x [-1/2, rows - 1/2]. Depth is kept. Row 0 is at y = -1."""
    if columns < 1 or rows < 1:
        raise InputError(f"an image of {columns} x {rows} pixels shows nothing")
    matrix = np.eye(4)
    matrix[0, 0], matrix[0, 3] = columns / 2.0, (columns - 1) / 2.0
    matrix[1, 1], matrix[1, 3] = rows / 2.0, (rows - 1) / 2.0
    return matrix


@dataclass(frozen=True)
class ViewVolume:
    """What is seen, in camera coordinates: left < right and bottom < top in the plane z = near, and 0 > near > far.

    Errors: InputError for a volume that is empty or reaches the eye. Source: lecture, M_orth, P and M_per.
    """

    left: float
    right: float
    bottom: float
    top: float
    near: float
    far: float

    def __post_init__(self) -> None:
        if not (self.left < self.right and self.bottom < self.top and 0.0 > self.near > self.far > -np.inf):
            raise InputError("a view volume needs left < right, bottom < top and 0 > near > far")

    @classmethod
    def of_field(cls, fov_deg: float, aspect: float, near: float, far: float) -> ViewVolume:
        """The symmetric volume with a field of vision over its height and an aspect = width / height."""
        half = -near * float(np.tan(np.radians(fov_deg) / 2.0))
        return cls(-half * aspect, half * aspect, -half, half, near, far)

    @cached_property
    def orthographic(self) -> Floats:
        """(4, 4) from the box to the cube [-1, 1]^3: near to z = +1, far to -1."""
        low, high = (self.left, self.bottom, self.far), (self.right, self.top, self.near)
        return window_transform((low, high), ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)))

    @cached_property
    def perspective(self) -> Floats:
        """(4, 4) from the frustum to the box: keeps the near plane, the z of the far plane and the order in between.

        The last component of a visible point's image is its z, a negative number (erratum V-04).
        """
        n, f = self.near, self.far
        return np.array([[n, 0.0, 0.0, 0.0], [0.0, n, 0.0, 0.0], [0.0, 0.0, n + f, -f * n], [0.0, 0.0, 1.0, 0.0]])

    @cached_property
    def orthographic_perspective(self) -> Floats:
        """(4, 4) from the frustum to the cube: both in one."""
        return np.asarray(self.orthographic @ self.perspective)


def basis_of(vector: ArrayLike, other: ArrayLike | None = None) -> Floats:
    """An orthonormal right-handed frame (3, 3) of rows u, v, w with w along the vector.

    other: any vector that is not collinear; u is normal to both. Without it, the axis that encloses the largest angle.
    Errors: InputError for vectors without length, or collinear ones.
    """
    w = normalize(vector)
    t = np.eye(3)[np.argmin(np.abs(w))] if other is None else normalize(other)
    u = np.cross(t, w)
    if length(u) <= PARALLEL_SINE:
        raise InputError("two vectors along one line span no frame")
    u = normalize(u)
    return np.array([u, np.cross(w, u), w])


def basis_of_gaze(gaze: ArrayLike, up: ArrayLike) -> Floats:
    """The frame (3, 3) of rows u right, v up, w against the gaze."""
    return basis_of(-np.asarray(gaze, dtype=np.float64), up)


def world_from_frame(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix (k+1, k+1) from coordinates in a frame to the world's: its columns are the basis vectors and the
    origin.

    basis (k, k): rows u, v (and w). Source: lecture; erratum V-01.
    """
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows.T, e
    return matrix


def frame_from_world(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix (k+1, k+1) from the world's coordinates to those in an orthonormal frame. Source: lecture; erratum
    V-02."""
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows, -rows @ e
    return matrix


def camera_matrix(eye: ArrayLike, gaze: ArrayLike, up: ArrayLike) -> Floats:
    """M_cam (4, 4) from the world to camera coordinates: the eye goes to the origin, the gaze to -z."""
    return frame_from_world(eye, basis_of_gaze(gaze, up))


def pixel_matrix(camera: ArrayLike, volume: ViewVolume, columns: int, rows: int) -> Floats:
    """M (4, 4) = viewport, orthographic, perspective and camera matrix in one: from the world to pixels and depth."""
    return np.asarray(viewport(columns, rows) @ volume.orthographic_perspective @ np.asarray(camera, dtype=np.float64))


def segments_to_pixels(
    starts: ArrayLike, ends: ArrayLike, camera: ArrayLike, volume: ViewVolume, columns: int, rows: int
) -> tuple[Floats, Floats, Bools]:
    """The images of segments: starts and ends (n, 3) in pixels and depth, and (n,) which segments have an image.

    Segments are cut at the near plane before the division, so one that reaches behind the eye shows its part in front.
    Nothing else is cut. Ends of a segment without an image are zeros.
    Source: lecture, final algorithm; erratum V-04.
    """
    camera = np.asarray(camera, dtype=np.float64)
    p, q = (homogeneous(x) @ camera.T for x in (starts, ends))
    above_p, above_q = p[:, 2] - volume.near, q[:, 2] - volume.near
    seen = (above_p <= 0.0) | (above_q <= 0.0)
    gap = np.where((above_p > 0.0) == (above_q > 0.0), 1.0, above_p - above_q)
    at_near = p + (above_p / gap)[:, None] * (q - p)
    at_near[:, 2] = volume.near
    matrix = viewport(columns, rows) @ volume.orthographic_perspective
    images = np.zeros((2, len(p), 3))
    for image, point, above in ((images[0], p, above_p), (images[1], q, above_q)):
        kept = np.where((above > 0.0)[:, None], at_near, point)[seen]
        image[seen] = dehomogenized(kept @ matrix.T)
    return images[0], images[1], np.asarray(seen)
