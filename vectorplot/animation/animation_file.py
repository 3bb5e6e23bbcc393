"""Animation files: what moves in a scene, said in the manner of the scene language."""

from __future__ import annotations

import os
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from vectorplot.animation.animation import (
    MODES,
    WAYS,
    Animation,
    CameraTrack,
    ItemTrack,
    KeyedMotion,
    LightTrack,
    Track,
    check_fps,
    check_frames,
)
from vectorplot.errors import InputError, printable
from vectorplot.geometry.camera import Point
from vectorplot.geometry.rotations import AXES
from vectorplot.io.named_files import data_file
from vectorplot.io.read_file import read
from vectorplot.io.scene_words import Words
from vectorplot.scene.scene import Scene
from vectorplot.words import nearest

# The statements of animation files, read one after the other.

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


MAX_FILE_BYTES = 4 << 20
"""The largest animation file that is read."""

ONCE = ("mode", "frames", "frames_per_second", "loop", "scene", *CAMERA)
"""Statements that a file makes once."""


def read_animation(path: str | os.PathLike[str], scene: Scene | None = None) -> Animation:
    """The animation that a file describes.

    Parameters
    ----------
    path : str or path
        A text in UTF-8, of any suffix.
    scene : Scene, optional
        What moves. Where None, the one that the file names: beside it, in the current folder or in ``data/``.

    Returns
    -------
    Animation
        It can be pickled.

    Raises
    ------
    InputError
        With file, line and the word expected; for names that the scene does not have, and where nobody names a scene.

    Notes
    -----
    The language stands in docs/animation.md.

    Source: Glaeser, appendix A.4, which leaves its words open.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import vectorplot as vp
    >>> from vectorplot import io
    >>> scene = io.parse_scene("DIE red box solid 2 2 2")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "turn.anim")
    ...     _ = path.write_text("frames 30 loop item DIE rotation z linear at 0 0 at 1 90")
    ...     vp.read_animation(path, scene)
    <Animation: 30 frames, 25 a second, lines>
    """
    file, name = Path(path), printable(str(path))
    try:
        if file.stat().st_size > MAX_FILE_BYTES:
            raise InputError(f"larger than {MAX_FILE_BYTES >> 20} MiB: this is no animation file", file=name)
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("not UTF-8: this is no animation file", file=name) from None
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(getattr(error, "strerror", None) or "cannot be read", file=name) from None
    return _Reader(AnimationWords(text, name), file.parent).animation(scene)


def parse_animation(text: str, scene: Scene | None = None, name: str = "<text>") -> Animation:
    """The animation that a text describes."""
    return _Reader(AnimationWords(text, name), None).animation(scene)


class _Reader:
    """Reads statements and gathers them; folder: that of the file."""

    def __init__(self, words: AnimationWords, folder: Path | None) -> None:
        self.words, self.folder = words, folder
        self.at = 0
        self.given: dict[str, Any] = {}
        self.camera: list[CameraTrack] = []
        self.lights: list[LightTrack] = []
        self.items: list[ItemTrack] = []
        self.named: tuple[str, int] | None = None

    def animation(self, scene: Scene | None) -> Animation:
        """All statements up to the end of the text, and the scene that they are about."""
        words, said = self.words, set()
        while word := words.words[self.at]:
            if word not in STATEMENTS:
                words.unknown(self.at, "", STATEMENTS)
            if word in ONCE and word in said:
                words.fail(self.at, f"a second '{word}'")
            said.add(word)
            self.statement(word)
        shown = self.scene() if scene is None else scene
        motion = KeyedMotion(shown, tuple(self.camera), tuple(self.lights), tuple(self.items))
        return Animation(motion, **self.given)

    def statement(self, word: str) -> None:
        """A statement, and what follows its first word."""
        words, start = self.words, self.at
        if word in CAMERA:
            track, self.at = words.camera_track(self.at)
            self.camera.append(track)
        elif word == "light":
            lights, self.at = words.light_tracks(self.at)
            self.lights += lights
        elif word == "item":
            items, self.at = words.item_tracks(self.at)
            self.items += items
        elif word == "loop":
            self.given["loop"] = True
            self.at += 1
        elif word == "scene":
            if not words.words[start + 1].startswith('"'):
                words.fail(start + 1, f"scene: expected the name of a file in quotes, got {words.shown(start + 1)}")
            self.named = (words.string(start + 1), start + 1)
            self.at += 2
        else:
            self.setting(word)

    def setting(self, word: str) -> None:
        """mode, frames or frames_per_second."""
        words, at = self.words, self.at + 1
        if word == "mode":
            if words.words[at] not in MODES:
                near = nearest(words.words[at].lower(), MODES) if words.words[at] else None
                hint = f" (did you mean '{near}'?)" if near else ""
                words.fail(at, f"mode: expected one of {', '.join(MODES)}, got {words.shown(at)}{hint}")
            self.given["mode"] = words.words[at]
        else:
            owner = f"{word}: "
            try:
                if word == "frames":
                    self.given["frames"] = words.whole(at, owner, word)
                    check_frames(self.given["frames"])
                else:
                    self.given["fps"] = words.number(at, owner, word)
                    check_fps(self.given["fps"])
            except InputError as error:
                if error.file is not None:
                    raise
                words.fail(at, error.cause)
        self.at += 2

    def scene(self) -> Scene:
        """The scene that the file names: a file beside it, or a data file."""
        if self.named is None:
            raise InputError("no scene: expected one beside the animation, or 'scene' in it", file=self.words.name)
        name, at = self.named
        pure = PurePath(name)
        if pure.is_absolute() or ".." in pure.parts:
            self.words.fail(at, f"scene: {name!r} lies elsewhere: expected a name beside the animation or in data/")
        beside = None if self.folder is None else self.folder / name
        try:
            found = beside if beside is not None and beside.is_file() else data_file(name)
        except (InputError, OSError, ValueError):
            self.words.fail(at, f"scene: {name!r}: no such file, nor in data/")
        return read(found)
