"""Shadows checked at points of faces by rays to the lights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from support.triangle_rays import blocked
from vectorplot.arrays import Floats, Ints
from vectorplot.effects.decals import Decals
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell


@dataclass(frozen=True)
class FacePoints:
    """Points (3,n) in the view, inside faces (n,)."""

    points: Floats
    face: Ints


def face_points(view: View, faces: Ints, count: int, random: np.random.Generator) -> FacePoints:
    """Random points inside faces, each a mean of the corners with random weights."""
    if not len(faces):
        return FacePoints(np.zeros((3, 0)), faces)
    face = faces[random.integers(0, len(faces), count)]
    sizes = view.face_sizes[face]
    corner = np.arange(int(view.face_sizes.max()))[:, None]
    weight = random.exponential(size=(len(corner), count)) * (corner < sizes)
    weight /= weight.sum(axis=0)
    points = view.points[:, view.corners[view.offsets[face] + np.minimum(corner, sizes - 1)]]
    return FacePoints((points * weight).sum(axis=1), face)


def highest_grade(view: View, decals: Decals, at: FacePoints) -> tuple[Ints, Floats]:
    """(n,) the highest grade of the decals, simple polygons, that each point lies in, and how far it is from the
    nearest side of one."""
    grade = np.zeros(len(at.face), dtype=np.intp)
    clear = np.full(len(at.face), np.inf)
    normal, _, _ = newell(view, np.arange(view.face_count))
    axis = np.abs(normal).argmax(axis=0)
    order = np.argsort(at.face, kind="stable")
    low, high = (np.searchsorted(at.face[order], decals.face, side=side) for side in ("left", "right"))
    for k in np.flatnonzero(high > low).tolist():
        here = order[low[k] : high[k]]
        corners = decals.points[:, decals.offsets[k] : decals.offsets[k + 1]]
        along = np.roll(corners, -1, axis=1) - corners
        points = at.points[:, here]
        share = (along[:, :, None] * (points[:, None] - corners[:, :, None])).sum(axis=0)
        share = np.clip(share / np.maximum((along * along).sum(axis=0), 1e-300)[:, None], 0.0, 1.0)
        arm = points[:, None] - corners[:, :, None] - share * along[:, :, None]
        clear[here] = np.minimum(clear[here], np.sqrt((arm * arm).sum(axis=0)).min(axis=0))
        u, v = (int(axis[decals.face[k]]) + np.array([1, 2])) % 3
        inside = _crossings(corners[[u, v]], along[[u, v]], points[[u, v]]) % 2 == 1
        grade[here[inside]] = np.maximum(grade[here[inside]], decals.grade[k])
    return grade, clear


def _crossings(corners: Floats, along: Floats, points: Floats) -> Ints:
    """(n,) how many sides of a polygon a ray along the first axis from each point meets."""
    before = corners[1][:, None] <= points[1]
    after = (corners[1] + along[1])[:, None] <= points[1]
    share = (points[1] - corners[1][:, None]) / np.where(along[1] == 0.0, 1.0, along[1])[:, None]
    ahead = corners[0][:, None] + share * along[0][:, None] > points[0]
    return np.asarray(((before != after) & ahead).sum(axis=0))


def scene_triangles(view: View) -> Floats:
    """(t,3,3) the triangles, corner by corner, of all faces that occlude."""
    face = np.repeat(np.arange(view.face_count), view.face_sizes - 2)
    face_start = np.repeat(np.cumsum(view.face_sizes - 2) - (view.face_sizes - 2), view.face_sizes - 2)
    step = np.arange(len(face)) - face_start
    kept = view.occludes[view.face_item[face]]
    start, step = view.offsets[face[kept]], step[kept]
    corners = np.stack([view.corners[start], view.corners[start + step + 1], view.corners[start + step + 2]], axis=1)
    return view.points.T[corners]


def lights_blocked(view: View, lights: tuple[Light, ...], at: FacePoints) -> tuple[Ints, Floats]:
    """(n,) how many of the lights that a face turns its visible side to do not reach each point, and how sure that
    is."""
    count = np.zeros(len(at.face), dtype=np.intp)
    sure = np.full(len(at.face), np.inf)
    normal, _, _ = newell(view, at.face)
    eye = np.array([[0.0], [0.0], [1.0]]) if view.eye is None else view.eye[:, None] - at.points
    to_eye = (normal * eye).sum(axis=0)
    triangles = scene_triangles(view)
    for light in lights:
        place = np.array(light.position, dtype=np.float64)
        if light.parallel:
            rays = np.broadcast_to((view.axes @ place * 5.0 / np.linalg.norm(place))[:, None], at.points.shape)
        else:
            rays = view.points_of(place[None]) - at.points
        lit = (normal * rays).sum(axis=0) * to_eye > 0.0
        dark, clear = blocked(at.points[:, lit].T, rays[:, lit].T, triangles)
        count[lit] += dark
        sure[lit] = np.minimum(sure[lit], clear)
    return count, sure


def wrong_points(
    view: View, lights: tuple[Light, ...], decals: Decals, faces: Ints, count: int, seed: int = 0
) -> tuple[int, int]:
    """How many sample points of faces have a wrong grade, and how many have an answer at all: no side of a shadow or
    of what casts it within a millionth of the extent."""
    at = face_points(view, faces, count, np.random.default_rng(seed))
    grade, clear = highest_grade(view, decals, at)
    dark, sure = lights_blocked(view, lights, at)
    answered = (clear > 1e-6) & (sure > 1e-6)
    return int((grade != dark)[answered].sum()), int(answered.sum())
