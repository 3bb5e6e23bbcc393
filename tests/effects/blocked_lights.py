"""Shadows checked at points of faces by rays to the lights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.effects.decals import Decals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.scene.scene import Light, Scene
from vectorplot.scene.view import View
from vectorplot.testing.sight import visible_by_rays
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
    """(n,) the highest grade of the decals each point lies in, and how far it is from the nearest side of one."""
    grade = np.zeros(len(at.face), dtype=np.intp)
    clear = np.full(len(at.face), np.inf)
    normal, _, _ = newell(view, np.arange(view.face_count))
    normal /= np.sqrt((normal * normal).sum(axis=0))
    order = np.argsort(at.face, kind="stable")
    low, high = (np.searchsorted(at.face[order], decals.face, side=side) for side in ("left", "right"))
    for k in np.flatnonzero(high > low).tolist():
        here = order[low[k] : high[k]]
        corners = decals.points[:, decals.offsets[k] : decals.offsets[k + 1]]
        along = np.roll(corners, -1, axis=1) - corners
        length = np.sqrt((along * along).sum(axis=0))
        inward = np.cross(normal[:, decals.face[k]], along.T).T[:, length > 1e-12] / length[length > 1e-12]
        arm = at.points[:, here][:, None] - corners[:, length > 1e-12][:, :, None]
        distance = (inward[:, :, None] * arm).sum(axis=0).min(axis=0)
        grade[here[distance > 0.0]] = np.maximum(grade[here[distance > 0.0]], decals.grade[k])
        clear[here] = np.minimum(clear[here], np.abs(distance))
    return grade, clear


def light_camera(light: Light, scene: Scene) -> Camera:
    """A camera in the place of a light."""
    x, y, z = light.position
    if light.parallel:
        return Camera((x, y, z), (0.0, 0.0, 0.0), parallel=True, height=1.0)
    middle = scene.bounds.mean(axis=0)
    a, b, c = (middle if np.abs(middle - light.position).max() > 0 else middle + 1.0).tolist()
    return Camera((x, y, z), (a, b, c))


def lights_blocked(
    scene: Scene, view: View, lights: tuple[Light, ...], at: FacePoints, lit: Bools
) -> tuple[Ints, Floats]:
    """(n,) how many of the lights that a face is turned to, lit (l,n), do not reach each point, and how sure that is."""
    blocked = np.zeros(len(at.face), dtype=np.intp)
    clear = np.full(len(at.face), np.inf)
    world = view.world_of(at.points)
    for light, mine in zip(lights, lit, strict=True):
        sight = visible_by_rays(scene, light_camera(light, scene), world)
        blocked += (sight.hidden_by > 0) & mine
        clear = np.minimum(clear, np.where(mine, sight.clearance, np.inf))
    return blocked, clear


def lit_faces(view: View, lights: tuple[Light, ...]) -> Bools:
    """(l,f) the faces that turn the same side to a light and to the eye."""
    normal, _, first = newell(view, np.arange(view.face_count))
    corner = view.points[:, first]
    eye = np.array([[0.0], [0.0], [1.0]]) if view.eye is None else view.eye[:, None] - corner
    to_eye = (normal * eye).sum(axis=0)
    rows = []
    for light in lights:
        place = np.array(light.position)
        ray = (view.axes @ place)[:, None] if light.parallel else view.points_of(place[None]) - corner
        rows.append((normal * ray).sum(axis=0) * to_eye > 0.0)
    return np.array(rows).reshape(len(lights), view.face_count)


def wrong_points(
    scene: Scene, view: View, lights: tuple[Light, ...], decals: Decals, faces: Ints, count: int, seed: int = 0
) -> tuple[int, int]:
    """How many sample points of faces have a wrong grade, and how many have an answer at all."""
    at = face_points(view, faces, count, np.random.default_rng(seed))
    grade, clear = highest_grade(view, decals, at)
    blocked, sure = lights_blocked(scene, view, lights, at, lit_faces(view, lights)[:, at.face])
    answered = (clear > 1e-6) & (sure > 1e-6)
    return int((grade != blocked)[answered].sum()), int(answered.sum())
