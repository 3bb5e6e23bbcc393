"""The viewing pipeline: frames in space, changes of coordinates, the viewing pyramid and its homogeneous matrices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import Box, ClippedLines, Polygons, cut_polygons, divided
from vectorplot.geometry.elementary import tan
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import CoordinateSystem, depth_of
from vectorplot.geometry.vectors import length, normalize
from vectorplot.tolerances import INFINITE, PARALLEL_SINE

# Frames in space: bases of vectors, and the matrices from and to the world.


def basis_of(vector: ArrayLike, other: ArrayLike | None = None) -> Floats:
    """An orthonormal right-handed frame of rows u, v, w with w along a vector.

    vector: (3,) of any length but zero; other: (3,) any vector that is not collinear; result: (3, 3) its rows are unit
    vectors.
    """
    w = normalize(vector)
    t = np.eye(3)[np.argmin(np.abs(w))] if other is None else normalize(other)
    u = np.cross(t, w)
    if length(u) <= PARALLEL_SINE:
        raise InputError("two vectors along one line span no frame")
    u = normalize(u)
    return np.array([u, np.cross(w, u), w])


def basis_of_gaze(gaze: ArrayLike, up: ArrayLike) -> Floats:
    """The frame of rows u right, v up, w against the gaze.

    gaze (3,): the direction one looks in; up (3,): what is upwards in the picture, not along the gaze; result: (3,3)
    its rows are unit vectors.
    Errors: for vectors without length, or collinear ones.
    """
    return basis_of(-np.asarray(gaze, dtype=np.float64), up)


def world_from_frame(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix from coordinates in a frame to the world's: its columns are the basis vectors and the origin.

    origin: (k,) of the frame, in the world; basis: (k, k) rows u, v (and w); result: (k+1, k+1) acts on homogeneous
    columns.
    Source: lecture; erratum V-01.
    """
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows.T, e
    return matrix


def frame_from_world(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix from the world's coordinates to those in an orthonormal frame.

    origin: (k,) of the frame, in the world; basis: (k, k) rows u, v (and w); result: (k+1, k+1) acts on homogeneous
    columns.
    Source: lecture; erratum V-02.
    """
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows, matmul(-rows, e)
    return matrix


# Points changed from one coordinate system into another. Source: Glaeser, section 2.4.


def changed_coordinates(points: ArrayLike, source: CoordinateSystem, target: CoordinateSystem) -> Floats:
    """Points of one system in another, such as from the screen to a lamp.

    Parameters
    ----------
    points : (..., 3) array_like of float
        In the first system.
    source, target : CoordinateSystem
        From which and into which they are brought.

    Returns
    -------
    (..., 3) array of float
        In the second system.

    Raises
    ------
    InputError
        For points that lie on or behind a neutral plane.

    Notes
    -----
    Source: Glaeser, section 2.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> from vectorplot.textbook import changed_coordinates
    >>> eye = geometry.CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> changed_coordinates([(2, 4, 5)], eye, geometry.CoordinateSystem.world()).tolist()
    [[1.0, 2.0, 5.0]]
    """
    return target.from_world(source.to_world(points))


def with_target_as_origin(target: ArrayLike, *pools: ArrayLike) -> tuple[Floats, ...]:
    """Pools of points, centres of projection among them, moved so that the target is the origin.

    target: (3,) in the world; pools: (..., 3) as many as there are.
    Source: Glaeser, section 2.4.
    """
    centre = np.asarray(target, dtype=np.float64)
    return tuple(np.asarray(np.asarray(pool, dtype=np.float64) - centre) for pool in pools)


# The viewing pyramid as a body in the world.

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

        points (...,3): in the world; result: (...) False for what lies behind the eye.
        """
        return np.asarray((matmul(self.system.homogeneous(points), self.box.planes.T) >= 0.0).all(axis=-1))


# Homogeneous points, and matrices that act on them. Points are columns: a point p goes to matrix @ p.


def homogeneous(points: ArrayLike) -> Floats:
    """Homogeneous coordinates of points, last component 1.

    points (...,k): in the plane or in space; result: (...,k+1) with one more column.
    """
    p = np.asarray(points, dtype=np.float64)
    return np.concatenate([p, np.ones((*p.shape[:-1], 1))], axis=-1)


def dehomogenized(points: ArrayLike) -> Floats:
    """The points of homogeneous coordinates, which may carry any common factor.

    points: (..., k+1) homogeneous; result: (..., k) divided by the last component.
    """
    p = np.asarray(points, dtype=np.float64)
    if np.any(p[..., -1] == 0.0):
        raise InputError("a point at infinity has no coordinates")
    return np.asarray(p[..., :-1] / p[..., -1:])


def transformed(matrix: ArrayLike, points: ArrayLike) -> Floats:
    """Points under a homogeneous matrix, after division by the last component.

    matrix (k+1,k+1): acts on homogeneous columns; points (...,k): in the plane or in space; result: (...,k) their
    images.
    Errors: for images at infinity.
    """
    return dehomogenized(matmul(homogeneous(points), np.asarray(matrix, dtype=np.float64).T))


# The matrices of the viewing pipeline. Points are columns: a point p goes to matrix @ p, the first of several stands
# right.
#
# Camera coordinates: x right, y up, z towards the eye; what is seen has z < 0, and so near and far are negative
# numbers. Source: viewing-transformation lecture; errata V-01 to V-05.


def window_transform(source: ArrayLike, target: ArrayLike) -> Floats:
    """The matrix that carries one box to another, translate, scale, translate: windows in the plane, boxes in space.

    source, target (2,k): two opposite corners each, in the same order; a target may run backwards, which mirrors;
    result: (k+1,k+1) acts on homogeneous columns.
    Errors: for a source box without extent.
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

    columns, rows: the size in pixels; result: (4,4) the image is [-1/2, columns - 1/2] x [-1/2, rows - 1/2]. Depth is
    kept. Row 0 is at y = -1.
    Errors: for an image without pixels.
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

    left, right: limits of x in the plane z = near, left < right; bottom, top: limits of y there, bottom < top; near,
    far: limits of z, 0 > near > far.
    Source: lecture, M_orth, P and M_per.
    Errors: for a volume that is empty or reaches the eye.
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

        fov_deg: in degrees; aspect: width / height; near, far: see ViewVolume; result: with the eye's ray in its
        middle.
        Errors: for what ViewVolume refuses.
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

    eye (3,): in the world; gaze, up (3,): see basis_of_gaze; result: (4,4) acts on homogeneous columns.
    Errors: for vectors without length, or collinear ones.
    """
    return frame_from_world(eye, basis_of_gaze(gaze, up))


def pixel_matrix(camera: ArrayLike, volume: ViewVolume, columns: int, rows: int) -> Floats:
    """Viewport, orthographic, perspective and camera matrix in one: from the world to pixels and depth.

    camera (4,4): see camera_matrix; volume: what is seen; columns, rows: the size of the image in pixels; result:
    (4,4) acts on homogeneous columns.
    Errors: for an image without pixels.
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
    """The images (n,3) of starts and ends in pixels and depth, zeros where there is none, and (n,) which segments have
    one. starts, ends (n,3): in the world; camera (4,4): see camera_matrix. Segments are cut at the near plane before
    the division, so one that reaches behind the eye shows its front part; nothing else is cut.
    Source: lecture, final algorithm; erratum V-04. Errors: InputError for an image without pixels.
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


Drawn = TypeVar("Drawn")


def clip_lines_3d(start: ArrayLike, end: ArrayLike, box: Box) -> ClippedLines:
    """The parts of segments inside a box, wherever the eye is.

    start, end: (n, 4) homogeneous, as CoordinateSystem.homogeneous gives them.
    Source: Glaeser, section 2.5; errata G2-08 to G2-10.
    """
    p, q = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    low, high, exists, clipped = _inside_part(matmul(p, box.planes.T), matmul(q, box.planes.T))
    ends = [
        np.where((t < 0.5)[:, None], p + t[:, None] * (q - p), q - (1.0 - t)[:, None] * (q - p)) for t in (low, high)
    ]
    flat = [divided(e, exists) for e in ends]
    return ClippedLines(flat[0], flat[1], exists, clipped)


def _inside_part(p: Floats, q: Floats) -> tuple[Floats, Floats, Bools, Bools]:
    """From distances (n, planes) of both ends: parameters of the part inside, whether there is one, whether any is
    cut."""
    out_p, out_q = p < 0.0, q < 0.0
    share = p / np.where(out_p != out_q, p - q, 1.0)
    low = np.where(out_p & ~out_q, share, 0.0).max(axis=-1)
    high = np.where(out_q & ~out_p, share, 1.0).min(axis=-1)
    exists = ~(out_p & out_q).any(axis=-1) & (low <= high)
    return low, high, np.asarray(exists), np.asarray((out_p | out_q).any(axis=-1))


def clip_and_draw(
    start: ArrayLike,
    end: ArrayLike,
    clip: Callable[[ArrayLike, ArrayLike], ClippedLines],
    draw: Callable[[Floats, Floats], Drawn],
) -> Drawn:
    """What draw makes of the segments that clip leaves: any way of clipping goes with any way of drawing.

    start, end: (n, 2 or more) the segments.
    """
    lines = clip(start, end)
    return draw(lines.start[lines.exists], lines.end[lines.exists])


def clip_polygons_3d(polygons: Polygons, box: Box) -> Polygons:
    """The parts of polygons inside a box, wherever the eye is.

    Source: Glaeser, section 2.5; errata G2-09, G2-12.
    """
    for plane in box.planes:
        polygons, _ = cut_polygons(polygons, matmul(polygons.points, plane))
    points = polygons.points
    return Polygons(divided(points, np.ones(len(points), dtype=np.bool_)), polygons.offsets)
