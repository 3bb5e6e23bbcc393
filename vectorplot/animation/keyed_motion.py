"""A scene whose camera, lights and items are moved along keys."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vectorplot.animation.tracks import Track
from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera, Point
from vectorplot.geometry.motions.movable import scale_matrix, shift_matrix, turn_matrix
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.point_of_view import default_camera
from vectorplot.scene.scene import Scene

ALL = "all"
"""The name of all items."""

ZENITH_DEG = 90.0
"""The eye rises no higher."""


@dataclass(frozen=True, eq=False)
class CameraTrack:
    """A part of the camera along keys: eye, target, twist, field_of_vision, height; or azimuth, elevation (degrees) and
    distance (a factor), by which the eye moves around the target and away from it."""

    what: str
    track: Track


@dataclass(frozen=True, eq=False)
class LightTrack:
    """position, direction or intensity of a light, by its name or its number from 1; place: file and line it stands
    in."""

    name: str
    what: str
    track: Track
    place: tuple[str, int]


@dataclass(frozen=True, eq=False)
class ItemTrack:
    """translation, rotation (degrees about an axis) or scale of an item, of a group of items or of all, about a point;
    place: file and line it stands in."""

    name: str
    what: str
    axis: str
    about: Point
    track: Track
    place: tuple[str, int]

    def matrix(self, time: float) -> Floats:
        """(4,4) what it does at a time, acting on columns."""
        value = self.track.at(time).tolist()
        if self.what == "translation":
            return shift_matrix(value[0], value[1], value[2])
        if self.what == "rotation":
            done = turn_matrix(self.axis, value[0])
        else:
            done = scale_matrix(value[0], value[1], value[2]) if len(value) > 1 else scale_matrix(value[0], None, None)
        x, y, z = self.about
        return np.asarray(matmul(matmul(shift_matrix(x, y, z), done), shift_matrix(-x, -y, -z)))


@dataclass(frozen=True, eq=False)
class KeyedMotion:
    """A scene, and what moves in it: called with a time from 0 to 1 it is the scene then.

    Items are moved in the order of their tracks.
    Errors: InputError, with file and line, for names that the scene does not have.
    """

    scene: Scene
    camera: tuple[CameraTrack, ...] = ()
    lights: tuple[LightTrack, ...] = ()
    items: tuple[ItemTrack, ...] = ()

    def __post_init__(self) -> None:
        for light in self.lights:
            if self._light(light.name) is None:
                known = ", ".join(one.name for one in self.scene.lights if one.name) or f"{len(self.scene.lights)}"
                raise _unknown("light", light.name, known, light.place)
        for item in self.items:
            if not self._moved(item.name):
                known = ", ".join(one.name for one in self.scene.items[:10])
                raise _unknown("item", item.name, known, item.place)

    def __call__(self, time: float) -> Scene:
        """The scene at a time from 0 to 1."""
        return replace(self.scene, camera=self._camera(time), lights=self._lights(time), items=self._items(time))

    def _camera(self, time: float) -> Camera:
        base = self.scene.camera or default_camera(self.scene)
        values = {track.what: track.track.at(time).tolist() for track in self.camera}
        single = {"twist": "twist_deg", "field_of_vision": "fov_deg", "height": "height"}
        given: dict[str, Any] = {own: values[word][0] for word, own in single.items() if word in values}
        given |= {word: tuple(values[word]) for word in ("eye", "target") if word in values}
        camera = replace(base, **given)
        if not values.keys() & {"azimuth", "elevation", "distance"}:
            return camera
        around, above, farther = (
            values.get(word, [usual])[0] for word, usual in (("azimuth", 0.0), ("elevation", 0.0), ("distance", 1.0))
        )
        x, y, z = camera.direction.tolist()
        azimuth = math.atan2(y, x) + math.radians(around)
        height = math.degrees(math.asin(max(-1.0, min(1.0, z)))) + above
        elevation = math.radians(max(-ZENITH_DEG, min(ZENITH_DEG, height)))
        ray = (
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        )
        eye = np.array(camera.target) + farther * camera.distance * np.array(ray)
        return replace(camera, eye=tuple(eye.tolist()))

    def _light(self, name: str) -> int | None:
        names = [light.name for light in self.scene.lights]
        if name in names:
            return names.index(name)
        counted = name.isdecimal() and len(name) <= len(str(len(names))) and 1 <= int(name) <= len(names)
        return int(name) - 1 if counted else None

    def _lights(self, time: float) -> tuple[Light, ...]:
        lights = list(self.scene.lights)
        for track in self.lights:
            index, value = self._light(track.name) or 0, track.track.at(time).tolist()
            if track.what == "intensity":
                lights[index] = replace(lights[index], intensity=max(0.0, min(1.0, value[0])))
            else:
                lights[index] = replace(lights[index], position=tuple(value), parallel=track.what == "direction")
        return tuple(lights)

    def _moved(self, name: str) -> list[int]:
        every = enumerate(self.scene.items)
        return [number for number, item in every if name in (ALL, item.name, item.group)]

    def _items(self, time: float) -> tuple[Item, ...]:
        matrices: dict[int, Floats] = {}
        for track in self.items:
            matrix = track.matrix(time)
            for number in self._moved(track.name):
                matrices[number] = matmul(matrix, matrices[number]) if number in matrices else matrix
        items = list(self.scene.items)
        for number, matrix in matrices.items():
            if not np.array_equal(matrix, np.eye(4)):
                items[number] = items[number].transformed(matrix)
        return tuple(items)


def _unknown(what: str, name: str, known: str, place: tuple[str, int]) -> InputError:
    return InputError(f"the scene has no {what} {name!r} ({what}s: {known or 'none'})", file=place[0], line=place[1])
