"""The scene that is looked at: a file, or the text that stands in the page's editor in its place."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.read_file import SCENE_SUFFIXES, read
from vectorplot.io.scenes.scene_language import parse_scene
from vectorplot.scene.scene import Scene

MOST_TEXT = 1 << 20
"""Longer scene files are shown, and not edited."""

KEPT = 4
"""So many scenes are kept that were read."""


@dataclass(eq=False)
class Source:
    """A file, and the scenes that were read from it and from texts in its place, the latest KEPT of them."""

    path: Path
    _kept: OrderedDict[str, Scene] = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def text(self) -> str | None:
        """What the file says, where it is a text in the scene language and not too long to edit; otherwise None."""
        if self.path.suffix.lower() not in SCENE_SUFFIXES or self.path.stat().st_size > MOST_TEXT:
            return None
        try:
            return self.path.read_text(encoding="utf-8-sig")
        except ValueError:
            return None

    def scene(self, text: str | None) -> Scene:
        """What the text describes, or the file where it is None. Errors: InputError with the line, OSError."""
        key = f"file {self.path.stat().st_mtime_ns}" if text is None else hashlib.sha256(text.encode()).hexdigest()
        with self._lock:
            found = self._kept.get(key)
        if found is None:
            found = read(self.path) if text is None else parse_scene(text, str(self.path), beside=self.path)
            if not isinstance(found, Scene):
                raise InputError("is no scene", file=str(self.path))
        with self._lock:
            self._kept[key] = found
            self._kept.move_to_end(key)
            while len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        return found


@dataclass(frozen=True, eq=False)
class Given:
    """A scene that is of no file, and has no text."""

    shown: Scene
    path: Path = Path("scene")

    def text(self) -> str | None:
        """None: there is nothing to edit."""
        return None

    def scene(self, text: str | None) -> Scene:
        """The scene."""
        return self.shown
