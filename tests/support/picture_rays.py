"""What rays of another make see of a scene, against a painted picture of it, pixel by pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from support.scene_rays import ABOVE, GRAZING, Faces, clear_of_edges, faces_of, lacking, page_rays
from support.top_fills import colours_at, covering, fills_of, last_at, pixel_places
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.paint import paint
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene

PAGE = Page(160.0, 120.0, 0.0)
COLUMNS, ROWS = 160, 120
EDGE = 2
"""Pixels that are so many rays away from an edge are compared: a pixel of the picture is two of them wide."""
LEVELS = 2.5
"""Colours are the same where they differ by so many of 256 levels: one by rounding, one by the palette."""


@dataclass(frozen=True)
class Truth:
    """What rays through the pixels see: face (n,) and point (n,3), the direction from the eye, and the mirror that it
    is seen in, -1 for none; lights that do not get there; by_mirror: the number of the double of a light that may shine
    there, -1 for none, and more: what it gives, as a light."""

    faces: Faces
    face: Ints
    point: Floats
    way: Floats
    pane: Ints
    dark: Ints
    by_mirror: Ints
    more: Floats
    sure: Bools


def random_camera(scene: Scene, random: np.random.Generator) -> Camera:
    low, high = scene.bounds
    size, middle = float(np.linalg.norm(high - low)), (low + high) / 2.0
    way = random.normal(size=3)
    way[2] = abs(way[2]) + 0.2
    eye = middle + random.uniform(0.9, 2.0) * size * way / np.linalg.norm(way)
    parallel, twist = bool(random.random() < 0.3), random.uniform(0, 360)
    distance = float(np.linalg.norm(eye - middle))
    fov = float(np.degrees(2.0 * np.arctan(0.4 * size / distance)))
    return Camera(tuple(eye), tuple(middle), twist_deg=twist, fov_deg=fov, parallel=parallel, height=0.8 * size)


def random_lights(scene: Scene, random: np.random.Generator, count: int) -> tuple[Light, ...]:
    """Lamps and suns all around."""
    low, high = scene.bounds
    size = float(np.linalg.norm(high - low))
    lights = []
    for number in range(count):
        way = random.normal(size=3) + np.array([0.0, 0.0, 1.5])
        way *= random.uniform(0.6, 1.5) * size / np.linalg.norm(way)
        parallel = bool(random.random() < 0.5)
        place = way if parallel else (low + high) / 2.0 + way
        lights.append(Light(tuple(place.tolist()), parallel, 0.55 - 0.2 * number))
    return tuple(lights)


def truth_of(scene: Scene, camera: Camera, places: Floats) -> Truth:
    faces = faces_of(scene)
    origin, way = page_rays(camera, PAGE, places, float(np.ptp(scene.vertices, axis=0).sum()))
    face, point = faces.first(origin, way)
    mirrors = np.array([item.material.word == "mirror" for item in scene.items], dtype=np.bool_)
    outside = (faces.normal[face] * way).sum(axis=1) < 0.0
    pane = np.where((face >= 0) & mirrors[faces.item[face]] & outside, face, -1)
    at = np.flatnonzero(pane >= 0)
    if len(at):
        normal = faces.normal[pane[at]]
        away = way[at] - 2.0 * (way[at] * normal).sum(axis=1)[:, None] * normal
        size = np.ptp(scene.vertices, axis=0).max()
        behind, there = faces.first(point[at] + 2e-5 * size * normal, away)
        face, point, way = face.copy(), point.copy(), way.copy()
        # What a mirror shows beside all things is itself.
        hit = behind >= 0
        pane[at[~hit]] = -1
        face[at[hit]], point[at[hit]], way[at[hit]] = behind[hit], there[hit], away[hit]
    dark, sure = lacking(faces, scene, face, point, way)
    by_mirror, more, certain = _light_by_mirrors(scene, faces, mirrors, face, point, way)
    # Mirrors do not show what other mirrors throw.
    by_mirror, more = np.where(pane < 0, by_mirror, -1), np.where(pane < 0, more, 0.0)
    return Truth(faces, face, point, way, pane, dark, by_mirror, more, sure & certain)


def _light_by_mirrors(
    scene: Scene, faces: Faces, mirrors: Bools, face: Ints, point: Floats, way: Floats
) -> tuple[Ints, Floats, Bools]:
    """(n,) which double of a light shines on points, or would if nothing were in the way; what it gives, half of what
    the light does; and whether that is sure. Of several doubles the last one counts."""
    number, more, sure = np.full(len(face), -1), np.zeros(len(face)), np.ones(len(face), dtype=np.bool_)
    normal = faces.normal[face]
    normal = np.where((normal * way).sum(axis=1)[:, None] > 0.0, -normal, normal)
    size, count = float(np.ptp(scene.vertices, axis=0).max()), 0
    for light in scene.lights:
        for window in np.flatnonzero(mirrors[faces.item]).tolist():
            axis, middle = faces.normal[window], faces.middle[window]
            place = np.asarray(light.position) - (0.0 if light.parallel else middle)
            if place @ axis <= 0.0:
                continue
            double = np.asarray(light.position) - 2.0 * (place @ axis) * axis
            to_light = np.broadcast_to(double, point.shape) if light.parallel else double - point
            reach = -((point - middle) @ axis) / (to_light @ axis)
            through = point + np.clip(reach, 0.0, 1e6)[:, None] * to_light
            inside = (face >= 0) & (reach > 0.0) & (((point - middle) @ axis) > 1e-9 * size)
            inside &= (normal * to_light).sum(axis=1) > 0.0
            inside &= ((through - middle) @ axis < 1e-6 * size) & faces.within(window, through)
            at = np.flatnonzero(inside)
            start, mirror = point[at] + ABOVE * size * normal[at], through[at] + ABOVE * size * axis
            on = np.broadcast_to(light.position, mirror.shape) * (1e3 if light.parallel else 1.0)
            free = faces.free(start, mirror) & faces.free(mirror, on)
            from_middle = np.broadcast_to(double, point.shape) if light.parallel else double - faces.middle[face]
            cosine = (normal * from_middle).sum(axis=1) / np.linalg.norm(from_middle, axis=1)
            number[at], more[at] = count, 0.5 * light.intensity * np.where(free, cosine[at], 0.0)
            slope = (normal * to_light).sum(axis=1) / np.linalg.norm(to_light, axis=1)
            sure[at] &= (np.abs(slope[at]) > GRAZING) & (np.abs(to_light[at] @ axis) > GRAZING * _lengths(to_light[at]))
            count += 1
    return number, more, sure


def _lengths(vectors: Floats) -> Floats:
    return np.asarray(np.linalg.norm(vectors, axis=1))


def expected_levels(scene: Scene, camera: Camera, truth: Truth) -> Floats:
    """(n,) the levels of gray, from 0 to 255, of what rays see, as chapter 4.5 of the book has it, without rounding."""
    result = np.zeros(len(truth.face))
    for pane in np.unique(truth.pane).tolist():
        here = np.flatnonzero(truth.pane == pane)
        result[here] = _levels(scene, camera, truth, here, pane)
    return result


def _levels(scene: Scene, camera: Camera, truth: Truth, here: Ints, pane: int) -> Floats:
    face, faces = truth.face[here], truth.faces
    normal = faces.normal[face]
    normal = np.where((normal * truth.way[here]).sum(axis=1)[:, None] > 0.0, -normal, normal)
    given, kept = np.zeros(len(here)), np.zeros(len(here))
    for number, light in enumerate(scene.lights):
        place = np.asarray(light.position)
        way = np.broadcast_to(place, normal.shape) if light.parallel else place - faces.middle[face]
        cosine = (normal * way).sum(axis=1) / np.linalg.norm(way, axis=1)
        share = light.intensity * np.where(cosine > 0.0, cosine, -0.3 * cosine)
        given += share
        kept += share * np.where(truth.dark[here] >> number & 1, 0.5, 1.0)
    given, kept = given + truth.more[here], kept + truth.more[here]
    low, high = _depth_limits(camera, _depths(camera, faces, scene.vertices, pane))
    depth = _depths(camera, faces, faces.middle[face], pane)
    cue = 0.2 * np.clip((depth - low) / (high - low), 0.0, 1.0)
    level = 255.0 * np.clip(0.8 * np.minimum(given, 1.0) * kept / np.maximum(given, 1e-300) + cue, 0.0, 1.0)
    return level if pane < 0 else 0.85 * level


def _depth_limits(camera: Camera, depths: Floats) -> tuple[float, float]:
    """Smallest and largest, but in a perspective no less than a fifth of the eye's distance before it, nor more than
    five of them."""
    low, high = float(depths.min()), float(depths.max())
    if camera.parallel:
        return low, high
    target = float(camera.axes[2] @ np.asarray(camera.target))
    low = max(low, target - 4.0 * camera.distance)
    return low, max(min(high, target + 0.8 * camera.distance), low)


def _depths(camera: Camera, faces: Faces, points: Floats, pane: int) -> Floats:
    """(n,) coordinates towards the eye of points, or of their doubles in a mirror."""
    if pane >= 0:
        normal = faces.normal[pane]
        points = points - 2.0 * ((points - faces.middle[pane]) @ normal)[:, None] * normal
    return np.asarray(points @ camera.axes[2])


def compared(scene: Scene, camera: Camera, drawing: Drawing | None = None) -> tuple[int, int, int]:
    """How many pixels show the wrong item, how many the wrong shade, and how many are compared."""
    drawing = drawing or paint(scene, camera, page=PAGE, fit=False, palette=256, smooth=False)
    fills = fills_of(drawing)
    places = pixel_places(drawing, COLUMNS, ROWS)
    truth = truth_of(scene, camera, places)
    labels = (truth.face + 1) + (len(truth.faces.item) + 1) * (truth.pane + 1)
    labels = labels * (1 << len(scene.lights)) + truth.dark
    labels = 64 * labels + 2 * (truth.by_mirror + 1) + (truth.more > 0.0)
    sure = clear_of_edges(labels.reshape(ROWS, COLUMNS), EDGE).ravel()
    place, polygon = covering(fills, places[sure])
    top = last_at(place, polygon, int(sure.sum()))
    item = np.where(top >= 0, np.append(fills.item, -1)[top], -1)
    wanted = np.where(truth.face >= 0, truth.faces.item[truth.face], -1)[sure]
    reflects = (top >= 0) & (np.append(fills.kind, -1)[top] == FillKind.REFLECTION)
    wrong = (item != wanted) | (reflects != (truth.pane[sure] >= 0))
    plain = np.array([thing.material.word == "normal" for thing in scene.items] + [False])
    lit = truth.sure[sure] & plain[wanted] & ~wrong
    if not scene.lights:
        return int(wrong.sum()), 0, int(sure.sum())
    level = colours_at(fills, top[lit], places[sure][lit])[:, 0]
    off = np.abs(level - expected_levels(scene, camera, truth)[sure][lit]) > LEVELS
    return int(wrong.sum()), int(off.sum()), int(sure.sum())
