"""The value Animation: a scene for every moment, modes of frames, and cameras, lights and items moved along keys."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.splines import AkimaSpline, CubicSpline, SplineCurve, spline_curve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera, Point
from vectorplot.geometry.rotations import scale_matrix, shift_matrix, turn_matrix
from vectorplot.io.anything import scene_of
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.words import check_word

# What frames look like: a word for each verb and how it is told to work.


@dataclass(frozen=True)
class Mode:
    """A verb, and what it is told beside all else.

    verb: the verb that makes frames; options: keywords of the verb.
    """

    verb: str
    options: Mapping[str, Any] = field(default_factory=dict)


MODES: dict[str, Mode] = {
    "wire": Mode("draw", {"style": "depth-cue"}),
    "lines": Mode("draw"),
    "shading": Mode("paint", {"shadows": "none"}),
    "shadows": Mode("paint"),
    "erasing": Mode("paint", {"fills": "erasing"}),
    "pixels": Mode("render"),
}
"""Modes by their words. Source: Glaeser, appendix A.3, keys w, h, s, c and j; pixels are those of a depth buffer."""


MOST_FRAMES = 100_000
"""Frames of one animation."""

MOST_PER_SECOND = 1000.0
"""Frames a second: no screen shows more."""


@dataclass(frozen=True, eq=False)
class Animation:
    """A scene that depends on time, and the frames that are made of it.

    Parameters
    ----------
    motion : callable
        motion(time) is the scene at a time from 0 to 1, or anything that has a shape, see `io.scene_of`. Camera and
        lights are those of the scene. The same time gives the same scene, in whatever order frames are made; to be made
        in other processes, it can be pickled, as that of `read_animation` can.
    frames : int
        How many, 1 to 100,000.
    fps : float
        How many of them a second.
    mode : str
        A word of MODES: what frames look like where nothing else is said.
    loop : bool
        The first frame follows the last one: frame k is at time k / frames, otherwise at k / (frames - 1).

    Raises
    ------
    InputError
        For counts out of range and other words.

    Notes
    -----
    Edge cases: the only frame of an animation is at time 0.

    Source: Glaeser, chapter 10 and appendix A.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> die = vp.Item("die", box((1, 1, 1)))
    >>> turning = vp.Animation(lambda time: die.turned("z", 90 * time), frames=25, loop=True)
    >>> turning
    <Animation: 25 frames, 25 a second, lines>
    >>> turning.time(5), turning.scene(5).items[0].name
    (0.2, 'die')
    """

    motion: Callable[[float], Any]
    frames: int = 100
    fps: float = 25.0
    mode: str = "lines"
    loop: bool = False

    def __post_init__(self) -> None:
        check_frames(self.frames)
        check_fps(self.fps)
        check_word("mode", self.mode, MODES)
        object.__setattr__(self, "frames", int(self.frames))

    def __len__(self) -> int:
        return self.frames

    def __repr__(self) -> str:
        return f"<Animation: {self.frames} frames, {self.fps:g} a second, {self.mode}>"

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return self.frames / self.fps

    def time(self, frame: int) -> float:
        """The time of a frame.

        Parameters
        ----------
        frame : int
            From 0.

        Returns
        -------
        float
            From 0 to 1.

        Raises
        ------
        InputError
            For a frame that there is not.

        Examples
        --------
        >>> import vectorplot as vp
        >>> film = vp.Animation(lambda time: vp.Scene(()), frames=5)
        >>> [film.time(frame) for frame in range(5)]
        [0.0, 0.25, 0.5, 0.75, 1.0]
        """
        if not 0 <= frame < self.frames:
            raise InputError(f"frame {frame}: expected 0 to {self.frames - 1}")
        return frame / max(self.frames if self.loop else self.frames - 1, 1)

    def scene(self, frame: int) -> Scene:
        """The scene that a frame shows.

        Parameters
        ----------
        frame : int
            From 0.

        Returns
        -------
        Scene
            With its camera and its lights; its parts are moved apart if it says so.

        Raises
        ------
        InputError
            For a frame that there is not, and as in `io.scene_of`.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> die = vp.Item("die", box((1, 1, 1)))
        >>> film = vp.Animation(lambda time: die.moved(3 * time), frames=4)
        >>> film.scene(3).bounds.tolist()
        [[3.0, 0.0, 0.0], [4.0, 1.0, 1.0]]
        """
        return shown_apart(scene_of(self.motion(self.time(frame))))


def check_frames(frames: int) -> None:
    """An InputError for a number of frames that is out of range."""
    if not (1 <= frames <= MOST_FRAMES and float(frames).is_integer()):
        raise InputError(f"{frames:g} frames: expected 1 to {MOST_FRAMES}")


def check_fps(fps: float) -> None:
    """An InputError for frames a second that are out of range."""
    if not 0.0 < fps <= MOST_PER_SECOND:
        raise InputError(f"{fps:g} frames a second: expected more than 0, at most {MOST_PER_SECOND:g}")


# What changes along keys: values at some times, and what is between them.

WAYS = ("akima", "cubic", "linear")
"""How values run between keys: the first one where nothing is said."""

FEWEST_CLOSED = {"akima": 3, "cubic": 3, "linear": 2}
"""Keys of a track that is closed."""

PERIOD = 1.0
"""The time after which what is closed comes again."""


@dataclass(frozen=True, eq=False)
class Track:
    """Numbers or points over time: keys (n,) times, values (n,1) or (n,3), a word of WAYS. Values stay before the first
    and behind the last key; in a closed track the first key follows the last, one unit of time later.
    Errors: InputError for times that do not rise or leave 0 to 1, and for too few keys. Source: Glaeser, section 9.1,
    errata G9-01 to G9-05.
    """

    times: Floats
    values: Floats
    way: str = WAYS[0]
    closed: bool = False

    def __post_init__(self) -> None:
        times = self.times
        if not ((times >= 0.0) & (times <= PERIOD)).all() or not (np.diff(times) > 0.0).all():
            raise InputError("times of keys must rise, from 0 to 1")
        if self.closed and len(times) < FEWEST_CLOSED[self.way]:
            raise InputError(f"closed: {len(times)} keys, expected {FEWEST_CLOSED[self.way]} or more")
        if self.closed and times[-1] - times[0] >= PERIOD:
            raise InputError("closed: the last key stands where the first one comes again")

    def at(self, time: float) -> Floats:
        """(1,) or (3,) the value at a time."""
        first, last = float(self.times[0]), float(self.times[-1])
        moment = first + (time - first) % PERIOD if self.closed else min(max(time, first), last)
        if len(self.times) == 1:
            return np.asarray(self.values[0])
        if self.way == "linear":
            times, values = self._around
            return np.array([np.interp(moment, times, column) for column in values.T])
        return np.asarray(self._spline.points(np.array(moment))[: self.values.shape[1]])

    @property
    def _around(self) -> tuple[Floats, Floats]:
        """Times and values, of what is closed with the first key again at the end."""
        if not self.closed:
            return self.times, self.values
        return np.append(self.times, self.times[0] + PERIOD), np.concatenate([self.values, self.values[:1]])

    @cached_property
    def _spline(self) -> SplineCurve:
        kind = AkimaSpline if self.way == "akima" else CubicSpline
        points = np.zeros((len(self.values), 3))
        points[:, : self.values.shape[1]] = self.values
        return spline_curve(points, kind(closed=self.closed, parameters=self._around[0]))


# A scene whose camera, lights and items are moved along keys.

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
