"""What a scene of polyhedra with convex faces shows, by rays of another make: which faces, lit by what, also in
mirrors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from support.triangle_rays import TriangleRays
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.vectors import cross, norm
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene

ABOVE = 2e-5
"""Rays start so far above the face they leave, in extents of the scene."""

IN_PLANE = 1e-9
"""Faces lie in one plane where middles and normals differ by so little, in extents of the scene and as cosines."""

GRAZING = 0.02
"""What comes in flatter than at this cosine has no sure answer."""


@dataclass(frozen=True)
class Faces:
    """The faces of a scene: triangles (t,3,3), face (t,) that each is of; item, normal (outer), middle of each."""

    triangles: Floats
    face: Ints
    item: Ints
    normal: Floats
    middle: Floats

    @cached_property
    def rays(self) -> TriangleRays:
        """What shoots at them."""
        return TriangleRays(self.triangles)

    @cached_property
    def in_one_plane(self) -> list[tuple[int, int]]:
        """Faces that lie in the plane of a larger one, of all larger ones, the largest first: the larger one first."""
        area = np.bincount(self.face, norm(cross(*(self.triangles[:, k] - self.triangles[:, 0] for k in (1, 2)))))
        height = np.abs(((self.middle[None] - self.middle[:, None]) * self.normal[:, None]).sum(axis=2))
        level = (height < IN_PLANE * np.ptp(self.triangles.reshape(-1, 3), axis=0).max(initial=0.0)) & (
            np.abs(self.normal @ self.normal.T) > 1.0 - IN_PLANE
        )
        large, small = np.nonzero(level & (area[:, None] > area))
        falling = np.lexsort((-area[small], -area[large]))
        return list(zip(large[falling].tolist(), small[falling].tolist(), strict=True))

    def first(self, origin: Floats, direction: Floats) -> tuple[Ints, Floats]:
        """(n,) the face each ray meets first, -1 for none, and (n,3) where, exactly on its plane. Of faces in one plane
        it meets the smallest, as pictures show them."""
        found = self.rays.first(origin, direction)
        face = np.where(found >= 0, self.face[found], -1)
        n, m = self.normal[face], self.middle[face]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (n * (m - origin)).sum(axis=1) / (n * direction).sum(axis=1)
        point = origin + np.where(face >= 0, np.nan_to_num(t), 0.0)[:, None] * direction
        for large, small in self.in_one_plane:
            at = np.flatnonzero(face == large)
            face[at[self.within(small, point[at])]] = small
        return face, point

    def within(self, face: int, points: Floats) -> Bools:
        """(n,) which points of its plane lie in a face."""
        found = np.zeros(len(points), dtype=np.bool_)
        for corners in self.triangles[self.face == face]:
            sides = np.roll(corners, -1, axis=0) - corners
            turns = [
                np.cross(side, points - corner) @ self.normal[face] for side, corner in zip(sides, corners, strict=True)
            ]
            found |= (np.array(turns) >= 0.0).all(axis=0)
        return found

    def free(self, start: Floats, end: Floats) -> Bools:
        """(n,) whether nothing is between points."""
        way = end - start
        length = np.linalg.norm(way, axis=1)
        way = way / length[:, None]
        return ~self.rays.stopped(start, way, length * (1.0 - 1e-6))


def faces_of(scene: Scene, which: Bools | None = None) -> Faces:
    """The faces of all items, or of some."""
    triangles, face, item = [np.zeros((0, 3, 3))], [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    middle, count = [np.zeros((0, 3))], 0
    for number, thing in enumerate(scene.items):
        mesh = thing.mesh
        if not mesh.face_count or (which is not None and not which[number]):
            continue
        corner, of = ragged.fans(mesh.offsets)
        triangles.append(mesh.vertices[mesh.corners[corner]])
        face.append(count + of)
        item.append(np.full(mesh.face_count, number, dtype=np.intp))
        sizes = np.diff(mesh.offsets)[:, None]
        middle.append(np.add.reduceat(mesh.vertices[mesh.corners], mesh.offsets[:-1]) / sizes)
        count += mesh.face_count
    every, owner = np.concatenate(triangles), np.concatenate(face)
    normal = np.zeros((count, 3))
    np.add.at(normal, owner, cross(every[:, 1] - every[:, 0], every[:, 2] - every[:, 0]))
    return Faces(every, owner, np.concatenate(item), normal / norm(normal)[:, None], np.concatenate(middle))


def page_rays(camera: Camera, page: Page, places: Floats, size: float) -> tuple[Floats, Floats]:
    """(n,3) origins and unit directions of the rays through places (n,2) of a page that is the camera's picture; those
    of a parallel one start outside of a scene of some size."""
    right, up, back = camera.axes
    distance = float(np.linalg.norm(np.subtract(camera.eye, camera.target)))
    height = camera.height if camera.parallel else 2.0 * distance * np.tan(np.radians(camera.fov_deg) / 2.0)
    plane = (places - (page.width_mm / 2.0, page.height_mm / 2.0)) * height / page.height_mm
    through = np.asarray(camera.target) + plane[:, :1] * right + plane[:, 1:] * up
    if camera.parallel:
        return through + 2.0 * (distance + size) * back, np.broadcast_to(-back, through.shape)
    way = through - np.asarray(camera.eye)
    return np.broadcast_to(camera.eye, way.shape), way / np.linalg.norm(way, axis=1)[:, None]


def lacking(faces: Faces, scene: Scene, face: Ints, point: Floats, viewed_from: Floats) -> tuple[Ints, Bools]:
    """(n,) which lights do not reach points (n,3) on faces (n,) that they shine on, bit k for light k, and whether
    that is sure; viewed_from (n,3): the direction in which each point is looked at."""
    mask, sure = np.zeros(len(face), dtype=np.intp), np.ones(len(face), dtype=np.bool_)
    size = np.ptp(faces.triangles.reshape(-1, 3), axis=0).max()
    normal = faces.normal[face]
    normal = np.where((normal * viewed_from).sum(axis=1)[:, None] > 0.0, -normal, normal)
    for number, light in enumerate(scene.lights):
        place = np.asarray(light.position, dtype=np.float64)
        way = np.broadcast_to(place, point.shape) if light.parallel else place - point
        distance = np.linalg.norm(way, axis=1)
        way = way / distance[:, None]
        slope = (way * normal).sum(axis=1)
        start = point + ABOVE * size * normal
        reach = np.full(len(point), 1e3 * size) if light.parallel else distance * (1.0 - 1e-6)
        dark = faces.rays.stopped(start, way, reach)
        mask |= np.where(dark & (slope > 0.0) & (face >= 0), 1 << number, 0)
        sure &= np.abs(slope) > GRAZING
    return mask, sure


def clear_of_edges(labels: Ints, reach: int) -> Bools:
    """(rows, columns) where all labels (rows, columns) up to so many pixels away are the same."""
    from scipy.ndimage import maximum_filter, minimum_filter

    size = 2 * reach + 1
    return np.asarray(maximum_filter(labels, size) == minimum_filter(labels, size))
