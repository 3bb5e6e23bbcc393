"""The nearest points of a mesh, and the faces they are in."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import FaceTriangles, face_triangles
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances import LEAST_DIVISOR, ZERO_OF_EXTENT

PAIRS = 1 << 20
"""About so many points and triangles are compared at a time."""


class MeshPlaces(NamedTuple):
    """Places on a mesh.

    faces: (k,) the face that each is in; points: (k, 3) in world coordinates; distances: (k,) how far they are from the
    points they were looked for from, in world units.
    """

    faces: Ints
    points: Floats
    distances: Floats


def nearest_on_mesh(mesh: Mesh, points: ArrayLike, directions: ArrayLike | None = None) -> MeshPlaces:
    """The nearest place of a mesh to each of points (k,3), exact to rounding. directions (k,3): on an edge or in a
    vertex the face that it leads into is chosen, the first one where None. Of equally near faces, to a part of the
    extent, the first counts.
    Source: Ericson, Real-time collision detection, section 5.1.5. Errors: InputError for a mesh without faces, or
    points and directions that are not three finite numbers.
    """
    at = _rows("points", points)
    ways = None if directions is None else np.broadcast_to(_rows("directions", directions), at.shape)
    faces = face_triangles(mesh)
    near = nearest_triangles(faces, at)
    corners = mesh.vertices[faces.triangles[near.triangle]]
    slack = _slack(faces)
    lead = np.zeros(len(near.point)) if ways is None else _lead(corners, near.feet, ways[near.point], slack)
    best = np.lexsort((faces.face[near.triangle], -lead, near.point))
    best = best[ragged.starts(np.bincount(near.point, minlength=len(at)))]
    return MeshPlaces(faces.face[near.triangle[best]], near.feet[best], near.distances[best])


class NearTriangles(NamedTuple):
    """The triangles that are nearest to points: point (n,), ascending, triangle (n,), feet (n,3) in these, distances
    (n,); several of a point where they are equally near."""

    point: Ints
    triangle: Ints
    feet: Floats
    distances: Floats


def nearest_triangles(faces: FaceTriangles, at: Floats) -> NearTriangles:
    """The nearest of some triangles to points (k,3). Errors: InputError for no triangles."""
    if not len(faces.triangles):
        raise InputError("the mesh has no faces on which a point could lie")
    corners = faces.mesh.vertices[faces.triangles]
    slack = _slack(faces)
    found = [NearTriangles(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros((0, 3)), np.zeros(0))]
    for which, point, triangle in _candidates(at, corners, slack):
        foot = feet_on_triangles(at[point], corners[triangle])
        distance = norm(foot - at[point])
        least = np.full(len(which), np.inf)
        np.minimum.at(least, point - which[0], distance)
        kept = np.flatnonzero(distance <= least[point - which[0]] + slack)
        kept = kept[np.argsort(point[kept], kind="stable")]
        found.append(NearTriangles(point[kept], triangle[kept], foot[kept], distance[kept]))
    return NearTriangles(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _slack(faces: FaceTriangles) -> float:
    """What tells places on triangles apart."""
    return max(ZERO_OF_EXTENT * faces.extent, faces.rounding)


def _rows(name: str, values: ArrayLike) -> Floats:
    rows = np.atleast_2d(np.asarray(values, dtype=np.float64))
    if rows.shape[1:] != (3,) or not np.isfinite(rows).all():
        raise InputError(f"nearest on a mesh: {name} must be three finite numbers each")
    return rows


def _candidates(at: Floats, corners: Floats, slack: float) -> list[tuple[Ints, Ints, Ints]]:
    """Points and the triangles that may be nearest to them, in parts: points (p,), and point and triangle (n,)."""
    from scipy.spatial import cKDTree

    centres = corners.mean(axis=1)
    radii = norm(corners - centres[:, None]).max(axis=1)
    # Triangles of about one size have a tree of their own: a huge one does not make every point try all small ones.
    size = np.frexp(radii)[1]
    groups = [np.flatnonzero(size == one) for one in np.unique(size)]
    trees = [cKDTree(centres[group]) for group in groups]
    bound = np.full(len(at), np.inf)
    for group, tree in zip(groups, trees, strict=True):
        nearest = group[tree.query(at)[1]]
        bound = np.minimum(bound, norm(feet_on_triangles(at, corners[nearest]) - at))
    reach = [(bound + 2.0 * slack) + radii[group].max() for group in groups]
    counts = np.zeros(len(at), dtype=np.intp)
    for tree, far in zip(trees, reach, strict=True):
        counts += tree.query_ball_point(at, far, return_length=True)
    part = np.cumsum(counts) // PAIRS
    found = []
    for which in np.split(np.arange(len(at)), np.flatnonzero(np.diff(part)) + 1):
        points, triangles = [], []
        for group, tree, far in zip(groups, trees, reach, strict=True):
            near = tree.query_ball_point(at[which], far[which])
            points.append(np.repeat(which, [len(one) for one in near]))
            triangles.append(group[np.concatenate([np.asarray(one, dtype=np.intp) for one in near])])
        if len(which):
            found.append((which, np.concatenate(points), np.concatenate(triangles)))
    return found


def feet_on_triangles(points: Floats, corners: Floats) -> Floats:
    """(n,3) the nearest points of triangles (n,3,3) to points (n,3)."""
    step = np.roll(corners, -1, axis=1) - corners
    arm = points[:, None] - corners
    along = dot(arm, step) / np.maximum(dot(step, step), LEAST_DIVISOR)
    on_sides = corners + np.clip(along, 0.0, 1.0)[..., None] * step
    best = norm(on_sides - points[:, None]).argmin(axis=1)
    feet = on_sides[np.arange(len(points)), best]
    normal = cross(step[:, 0], step[:, 1])
    square = dot(normal, normal)
    inwards = cross(np.broadcast_to(normal[:, None], step.shape), step)
    inside = (dot(inwards, arm) >= 0.0).all(axis=1) & (square > 0.0)
    height = dot(normal, arm[:, 0]) / np.where(square > 0.0, square, 1.0)
    return np.where(inside[:, None], points - height[:, None] * normal, feet)


def _lead(corners: Floats, feet: Floats, ways: Floats, slack: float) -> Floats:
    """(n,) how well directions (n,3) from feet (n,3) stay in triangles (n,3,3): 1 along them, less where they leave
    their plane, and much less where they lead away over a side on which the foot is."""
    step = np.roll(corners, -1, axis=1) - corners
    normal = cross(step[:, 0], step[:, 1])
    inwards = cross(np.broadcast_to(normal[:, None], step.shape), step)
    inwards = inwards / np.maximum(norm(inwards), LEAST_DIVISOR)[..., None]
    on_side: Bools = dot(inwards, feet[:, None] - corners) <= slack
    normal = normal / np.maximum(norm(normal), LEAST_DIVISOR)[:, None]
    ways = ways / np.maximum(norm(ways), LEAST_DIVISOR)[:, None]
    flat = ways - dot(ways, normal)[:, None] * normal
    away = np.where(on_side, np.minimum(dot(inwards, flat[:, None]), 0.0), 0.0).min(axis=1)
    return np.asarray(norm(flat) + 2.0 * away)
