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
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import tan
from vectorplot.textbook.viewing.bases import basis_of_gaze, frame_from_world
from vectorplot.textbook.viewing.homogeneous_points import dehomogenized, homogeneous


def window_transform(source: ArrayLike, target: ArrayLike) -> Floats:
    """The matrix that carries one box to another, translate, scale, translate: windows in the plane, boxes in space.

    Parameters
    ----------
    source, target : (2, k) array_like of float
        Two opposite corners each, in the same order; a target may run backwards, which mirrors.

    Returns
    -------
    (k+1, k+1) array of float
        Acts on homogeneous columns.

    Raises
    ------
    InputError
        For a source box without extent.

    Examples
    --------
    >>> from vectorplot.textbook import transformed, window_transform
    >>> matrix = window_transform([(0, 0), (2, 2)], [(0, 100), (100, 0)])
    >>> transformed(matrix, [(0, 0), (1, 2)]).tolist()
    [[0.0, 100.0], [50.0, 0.0]]
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
    """The matrix from the square [-1, 1]^2 to an image of so many pixels, whose centres are the integers.

    Parameters
    ----------
    columns, rows : int
        The size in pixels.

    Returns
    -------
    (4, 4) array of float
        The image is [-1/2, columns - 1/2] x [-1/2, rows - 1/2]. Depth is kept. Row 0 is at y = -1.

    Raises
    ------
    InputError
        For an image without pixels.

    Examples
    --------
    >>> from vectorplot.textbook import transformed, viewport
    >>> transformed(viewport(4, 2), [(0, 0, 0.5)]).tolist()
    [[1.5, 0.5, 0.5]]
    """
    if columns < 1 or rows < 1:
        raise InputError(f"an image of {columns} x {rows} pixels shows nothing")
    matrix = np.eye(4)
    matrix[0, 0], matrix[0, 3] = columns / 2.0, (columns - 1) / 2.0
    matrix[1, 1], matrix[1, 3] = rows / 2.0, (rows - 1) / 2.0
    return matrix


@dataclass(frozen=True)
class ViewVolume:
    """What is seen, in camera coordinates.

    Parameters
    ----------
    left, right : float
        Limits of x in the plane z = near, left < right.
    bottom, top : float
        Limits of y there, bottom < top.
    near, far : float
        Limits of z, 0 > near > far.

    Raises
    ------
    InputError
        For a volume that is empty or reaches the eye.

    Notes
    -----
    Source: lecture, M_orth, P and M_per.

    Examples
    --------
    >>> from vectorplot.textbook import ViewVolume, transformed
    >>> volume = ViewVolume(-1, 1, -1, 1, near=-1, far=-9)
    >>> transformed(volume.orthographic_perspective, [(1, 1, -1), (9, -9, -9)]).tolist()
    [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0]]
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
        """The symmetric volume with a field of vision over its height.

        Parameters
        ----------
        fov_deg : float
            In degrees.
        aspect : float
            Width / height.
        near, far : float
            As of ViewVolume.

        Returns
        -------
        ViewVolume
            With the eye's ray in its middle.

        Raises
        ------
        InputError
            For what ViewVolume refuses.
        """
        half = -near * float(tan(np.radians(fov_deg) / 2.0))
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
        return np.asarray(matmul(self.orthographic, self.perspective))


def camera_matrix(eye: ArrayLike, gaze: ArrayLike, up: ArrayLike) -> Floats:
    """M_cam, from the world to camera coordinates: the eye goes to the origin, the gaze to -z.

    Parameters
    ----------
    eye : (3,) array_like of float
        In the world.
    gaze, up : (3,) array_like of float
        As of basis_of_gaze.

    Returns
    -------
    (4, 4) array of float
        Acts on homogeneous columns.

    Raises
    ------
    InputError
        For vectors without length, or collinear ones.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.textbook import camera_matrix, transformed
    >>> camera = camera_matrix(eye=(0, -5, 0), gaze=(0, 1, 0), up=(0, 0, 1))
    >>> np.allclose(transformed(camera, [(0, 0, 0), (1, 0, 2)]), [(0, 0, -5), (1, 2, -5)])
    True
    """
    return frame_from_world(eye, basis_of_gaze(gaze, up))


def pixel_matrix(camera: ArrayLike, volume: ViewVolume, columns: int, rows: int) -> Floats:
    """Viewport, orthographic, perspective and camera matrix in one: from the world to pixels and depth.

    Parameters
    ----------
    camera : (4, 4) array_like of float
        As of camera_matrix.
    volume : ViewVolume
        What is seen.
    columns, rows : int
        The size of the image in pixels.

    Returns
    -------
    (4, 4) array of float
        Acts on homogeneous columns.

    Raises
    ------
    InputError
        For an image without pixels.

    Examples
    --------
    >>> from vectorplot.textbook import ViewVolume, camera_matrix, pixel_matrix, transformed
    >>> camera = camera_matrix(eye=(0, 0, 5), gaze=(0, 0, -1), up=(0, 1, 0))
    >>> matrix = pixel_matrix(camera, ViewVolume(-1, 1, -1, 1, -1, -9), 100, 80)
    >>> transformed(matrix, [(0, 0, 4), (1, 1, 4)])[:, :2].round(6).tolist()
    [[49.5, 39.5], [99.5, 79.5]]
    """
    return np.asarray(
        matmul(
            matmul(viewport(columns, rows), volume.orthographic_perspective),
            np.asarray(camera, dtype=np.float64),
        )
    )


def segments_to_pixels(
    starts: ArrayLike, ends: ArrayLike, camera: ArrayLike, volume: ViewVolume, columns: int, rows: int
) -> tuple[Floats, Floats, Bools]:
    """The images of segments, and which segments have one.

    Parameters
    ----------
    starts, ends : (n, 3) array_like of float
        In the world.
    camera : (4, 4) array_like of float
        As of camera_matrix.
    volume : ViewVolume
        What is seen.
    columns, rows : int
        The size of the image in pixels.

    Returns
    -------
    (n, 3) array of float
        The images of the starts, in pixels and depth; zeros where there is none.
    (n, 3) array of float
        Those of the ends.
    (n,) array of bool
        Which segments have an image.

    Raises
    ------
    InputError
        For an image without pixels.

    Notes
    -----
    Segments are cut at the near plane before the division, so one that reaches behind the eye shows its part in front.
    Nothing else is cut.

    Source: lecture, final algorithm; erratum V-04.

    Examples
    --------
    >>> from vectorplot.textbook import ViewVolume, camera_matrix, segments_to_pixels
    >>> camera = camera_matrix(eye=(0, 0, 5), gaze=(0, 0, -1), up=(0, 1, 0))
    >>> volume = ViewVolume(-1, 1, -1, 1, -1, -9)
    >>> starts, ends, seen = segments_to_pixels([(0, 0, 0), (0, 0, 6)], [(1, 0, 6), (0, 0, 9)], camera, volume, 100, 80)
    >>> seen.tolist(), ends[0, 2].round(6).item()
    ([True, False], 1.0)
    """
    camera = np.asarray(camera, dtype=np.float64)
    p, q = (matmul(homogeneous(x), camera.T) for x in (starts, ends))
    above_p, above_q = p[:, 2] - volume.near, q[:, 2] - volume.near
    seen = (above_p <= 0.0) | (above_q <= 0.0)
    gap = np.where((above_p > 0.0) == (above_q > 0.0), 1.0, above_p - above_q)
    at_near = p + (above_p / gap)[:, None] * (q - p)
    at_near[:, 2] = volume.near
    matrix = matmul(viewport(columns, rows), volume.orthographic_perspective)
    images = np.zeros((2, len(p), 3))
    for image, point, above in ((images[0], p, above_p), (images[1], q, above_q)):
        kept = np.where((above > 0.0)[:, None], at_near, point)[seen]
        image[seen] = dehomogenized(matmul(kept, matrix.T))
    return images[0], images[1], np.asarray(seen)
