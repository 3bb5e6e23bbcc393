"""A scene as one camera sees it: all faces in one mesh, in the camera's axes, scaled to the unit box."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.tolerance import ZERO_OF_EXTENT
from vectorplot.scene.pools import pools
from vectorplot.scene.scene import Scene

ULPS = 16.0
"""Fewer rounding steps of the largest coordinate than these count as zero too."""

LARGEST = 1e100
"""Beyond this, and below its inverse, products of lengths leave the range of floating point numbers."""

NEAR_OF_DISTANCE = 1e-4
"""The near plane, as a part of the smaller of the eye's distance from its target and the scene's extent."""


@dataclass(frozen=True, eq=False)
class View:
    """Faces of all items in the camera's axes: x right, y up, z towards the eye; origin in the middle of the scene, the
    largest coordinate about 1.

    points (3,v); corners (c,), offsets (f+1,) as in Mesh, but without the faces that are not present, and with those
    that are not planar and convex cut into triangles: inner (c,) marks their diagonals; face_item (f,); item_vertices
    (i+1,): item k has the points item_vertices[k] to item_vertices[k+1], none if it is a smooth surface; smooth
    surfaces have no faces either; occludes (i,); eye (3,) the eye, or for a
    parallel projection None: then every ray runs along +z; target (3,); focus: depth of the image plane, which is put
    into the middle of the scene; near: the smallest depth that is drawn; tolerance: what counts as distance zero;
    picture_height: of the camera's picture in the image plane. world_from_view: point = centre + scale * (p @ axes).
    Source: Glaeser, sections 2.1, 2.4 and 3.1 (the pools).
    """

    points: Floats
    corners: Ints
    offsets: Ints
    inner: Bools
    face_item: Ints
    item_vertices: Ints
    occludes: Bools
    eye: Floats | None
    target: Floats
    focus: float
    near: float
    picture_height: float
    tolerance: float
    centre: Floats
    scale: float
    axes: Floats

    def __len__(self) -> int:
        return self.face_count

    @property
    def face_count(self) -> int:
        """How many faces there are."""
        return len(self.offsets) - 1

    @cached_property
    def face_sizes(self) -> Ints:
        """(f,) number of corners."""
        return np.diff(self.offsets)

    @cached_property
    def is_triangular(self) -> bool:
        """Whether every face is a triangle."""
        return len(self.corners) == 3 * self.face_count

    def after(self, position: Ints) -> Ints:
        """(n,) where in corners the corners stand that follow those at some positions in their faces."""
        return next_positions(self.offsets, position)

    @cached_property
    def depth(self) -> Floats:
        """(v,) distance from the eye along the principal ray; in a parallel projection from the middle of the scene."""
        return self.depth_of(self.points)

    @cached_property
    def image(self) -> Floats:
        """(2,v) the points' images in the image plane, origin where the principal ray meets it.

        Points nearer than the near plane have no image: they get that of a point at the near plane.
        """
        return self.image_of(self.points)

    def depth_of(self, points: Floats) -> Floats:
        """(n,) the depths of points (3,n)."""
        return np.asarray(-points[2] if self.eye is None else self.eye[2] - points[2], dtype=np.float64)

    def image_of(self, points: Floats) -> Floats:
        """(2,n) the images of points (3,n)."""
        if self.eye is None:
            return points[:2] - self.target[:2, None]
        factor = self.focus / np.maximum(self.depth_of(points), self.near)
        return (points[:2] - self.eye[:2, None]) * factor

    def points_of(self, world: Floats) -> Floats:
        """(3,n) points (n,3) of the world in the view's coordinates."""
        return np.asarray((self.axes / self.scale) @ (world - self.centre).T, dtype=np.float64)

    def world_of(self, points: Floats) -> Floats:
        """(n,3) points (3,n) of the view in world coordinates."""
        return np.ascontiguousarray((self.scale * self.axes.T @ points).T + self.centre)

    @cached_property
    def image_from_world(self) -> Floats:
        """(3,4) homogeneous image coordinates, as of image but in world units, from world points (x,y,z,1)."""
        rotation = np.zeros((4, 4))
        rotation[:3, :3] = self.axes / self.scale
        rotation[:3, 3] = -self.axes @ (self.centre / self.scale)
        rotation[3, 3] = 1.0
        if self.eye is None:
            rows = np.array([[1.0, 0, 0, -self.target[0]], [0, 1.0, 0, -self.target[1]], [0, 0, 0, 1.0]])
        else:
            x, y, z = self.eye
            d = self.focus
            rows = np.array([[d, 0, 0, -d * x], [0, d, 0, -d * y], [0, 0, -1.0, z]])
        rows[:2] *= self.scale
        return np.asarray(rows @ rotation, dtype=np.float64)


def look(scene: Scene, camera: Camera) -> View:
    """The scene in the camera's axes, normalised so that no later decision depends on its size or place.

    Errors: InputError where the scene is so small, or the eye so far away, that its coordinates have no digits left.
    Degenerate: an empty scene gives a view without points.
    """
    low, high = scene.bounds
    centre, scale = (low + high) / 2.0, float((high - low).max()) / 2.0
    if not scale > 0.0:
        scale = camera.distance if not camera.parallel or camera.height is None else camera.height
    if not 1.0 / LARGEST < scale < LARGEST or not camera.distance < LARGEST:
        raise InputError(f"an extent of {2.0 * scale:g}, seen from {camera.distance:g} away, is out of range")
    largest = max(float(np.abs(low).max()), float(np.abs(high).max()))
    noise = ULPS * np.finfo(float).eps * largest / scale
    if noise > 1e-3:
        raise InputError("the scene is too small for its distance from the origin: its coordinates have no digits left")
    pool = pools(scene)
    points = np.ascontiguousarray((camera.axes / scale) @ (pool.points - centre).T)
    tolerance = max(ZERO_OF_EXTENT, noise)
    faces = convex_faces(points, pool.corners, pool.offsets, tolerance)
    axes = camera.axes
    target = axes @ ((np.asarray(camera.target) - centre) / scale)
    eye = None if camera.parallel else axes @ ((np.asarray(camera.eye) - centre) / scale)
    focus = 1.0 if eye is None else max(float(eye[2]), 1.0)
    return View(
        points=points,
        corners=faces.corners,
        offsets=faces.offsets,
        inner=faces.inner,
        face_item=pool.face_item[faces.source],
        item_vertices=pool.item_vertices,
        occludes=np.array([item.hides for item in scene.items], dtype=np.bool_),
        eye=eye,
        target=target,
        focus=focus,
        near=-np.inf if eye is None else NEAR_OF_DISTANCE * min(camera.distance / scale, 1.0),
        picture_height=camera.picture_height / scale * (1.0 if eye is None else focus * scale / camera.distance),
        tolerance=tolerance,
        centre=centre,
        scale=scale,
        axes=axes,
    )
