"""The statements of animation files, read one after the other."""

from __future__ import annotations

import numpy as np

from vectorplot.animation.keyed_motion import CameraTrack, ItemTrack, LightTrack
from vectorplot.animation.tracks import WAYS, Track
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Point
from vectorplot.geometry.motions.movable import AXES
from vectorplot.io.scenes.scene_words import Words
from vectorplot.words import nearest

CAMERA = {
    **{"eye": 3, "target": 3, "twist": 1, "field_of_vision": 1, "height": 1},
    **{"azimuth": 1, "elevation": 1, "distance": 1},
}
"""The words for what moves of the camera, and how many numbers each key has."""

LIGHT = {"position": 3, "direction": 3, "intensity": 1}
"""The words for what changes of a light, and how many numbers each key has."""

ITEM = ("translation", "rotation", "scale")
"""The words for how items move."""

STATEMENTS = ("mode", "frames", "frames_per_second", "loop", "scene", *CAMERA, "light", "item")
"""The first words of all statements."""

OF_TRACKS = (*WAYS, "closed", "at", "about")
"""The words within statements."""

MOST_KEYS = 10_000
"""Keys of one animation file."""


class AnimationWords(Words):
    """The words of an animation file; keys: how many have been read."""

    def __init__(self, text: str, name: str) -> None:
        super().__init__(text, name)
        self.keys = 0

    def unknown(self, at: int, owner: str, expected: tuple[str, ...]) -> None:
        """Raise InputError for a word that is none of those expected, with the one that may be meant."""
        near = nearest(self.words[at].lower(), expected) if self.words[at] else None
        hint = f" (did you mean '{near}'?)" if near else ""
        self.fail(at, f"{owner}expected one of {', '.join(expected)}, got {self.shown(at)}{hint}")

    def place(self, at: int) -> tuple[str, int]:
        """The file and the line of a word."""
        return self.name, self.line(at)

    def track(self, at: int, owner: str, sizes: tuple[int, ...]) -> tuple[Track, int]:
        """How a value runs, and its keys, and the word behind them; sizes: how many numbers a key may have."""
        start, way, closed = at, WAYS[0], False
        while self.words[at] in (*WAYS, "closed"):
            closed |= self.words[at] == "closed"
            way = self.words[at] if self.words[at] in WAYS else way
            at += 1
        if self.words[at] != "at":
            self.unknown(at, owner, ("at", *WAYS, "closed"))
        times: list[float] = []
        values: list[list[float]] = []
        size = 0
        while self.words[at] == "at":
            times.append(self.number(at + 1, owner, "the time of a key"))
            if not size:
                more = self.is_number(at + 2 + min(sizes)) or self.words[at + 2 + min(sizes)] == ","
                size = max(sizes) if more else min(sizes)
            value, at = self.numbers(at + 2, size, owner, "a key")
            values.append(value)
            self.keys += 1
            if self.keys > MOST_KEYS:
                self.fail(at - 1, f"{owner}more than {MOST_KEYS} keys")
        try:
            return Track(np.array(times), np.array(values), way, closed), at
        except InputError as error:
            self.fail(start, owner + error.cause)

    def camera_track(self, at: int) -> tuple[CameraTrack, int]:
        """What moves of the camera."""
        word = self.words[at]
        track, end = self.track(at + 1, f"{word}: ", (CAMERA[word],))
        return CameraTrack(word, track), end

    def light_tracks(self, at: int) -> tuple[list[LightTrack], int]:
        """A light by its name or number, and what changes of it."""
        name, owner, after = self._named(at, "light")
        found = []
        while (word := self.words[after]) in LIGHT:
            start = after
            track, after = self.track(after + 1, f"{owner}{word}: ", (LIGHT[word],))
            found.append(LightTrack(name, word, track, self.place(start)))
        if not found:
            self.unknown(after, owner, tuple(LIGHT))
        return found, after

    def item_tracks(self, at: int) -> tuple[list[ItemTrack], int]:
        """An item by its name, a group or all, and how it moves, one motion after the other."""
        name, owner, after = self._named(at, "item")
        found = []
        while (word := self.words[after]) in ITEM:
            start, axis, about = after, "z", (0.0, 0.0, 0.0)
            after += 1
            if word == "rotation":
                axis = self.words[after]
                if axis not in AXES:
                    self.fail(after, f"{owner}expected an axis x, y or z after 'rotation', got {self.shown(after)}")
                after += 1
            if word != "translation" and self.words[after] == "about":
                about, after = self._point(after + 1, owner)
            sizes = {"translation": (3,), "rotation": (1,), "scale": (1, 3)}[word]
            track, after = self.track(after, f"{owner}{word}: ", sizes)
            found.append(ItemTrack(name, word, axis, about, track, self.place(start)))
        if not found:
            self.unknown(after, owner, ITEM)
        return found, after

    def _named(self, at: int, what: str) -> tuple[str, str, int]:
        """The name behind a word, how messages begin that are about it, and the word behind it."""
        if self.words[at + 1] in ("", ",", *STATEMENTS, *OF_TRACKS):
            self.fail(at + 1, f"{what}: expected a name, got {self.shown(at + 1)}")
        name = self.string(at + 1)
        return name, f"{what} {name}: ", at + 2

    def _point(self, at: int, owner: str) -> tuple[Point, int]:
        (x, y, z), end = self.numbers(at, 3, owner, "the point that stays")
        return (x, y, z), end
