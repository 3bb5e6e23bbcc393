"""What the page asks for, and the answers: functions of what the page tells, which keeps all state itself."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.animation.modes import MODES
from vectorplot.errors import InputError
from vectorplot.film import Film
from vectorplot.save import write
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.viewer.commands import command_line
from vectorplot.viewer.jobs import Job
from vectorplot.viewer.keys import KEYS, pressed
from vectorplot.viewer.moving import moving
from vectorplot.viewer.pictures import drawable, for_browser, picture
from vectorplot.viewer.recorded import MOVIES, movie_formats, write_recorded
from vectorplot.viewer.sources import Given, Source
from vectorplot.viewer.state import ViewerState, first_state, fitting_fov_deg, page_of_state

SAVED = {
    "svg": "image/svg+xml",
    "pdf": "application/pdf",
    "ps": "application/postscript",
    "dxf": "image/vnd.dxf",
    "png": "image/png",
}
"""The formats that the page saves, and their media types."""

MOST_KEYS = 1000
"""So many keys are taken at once."""

Asked = Mapping[str, Any]
Answer = Callable[[Asked, Job], Any]

ERRORS = (InputError, OSError, MemoryError)
"""What the page is told; all else is a fault of the program."""


@dataclass(frozen=True)
class Answers:
    """All that the page asks, about the scene of a source.

    film: what it plays of a scene, if anything moves; video: the file that recordings go to, else they are handed over.
    """

    source: Source | Given
    film: Callable[[Scene], Film] | None = None
    video: Path | None = None
    _films: dict[int, tuple[Scene, Film]] = field(default_factory=dict, repr=False)

    def by_name(self, name: str) -> Answer | None:
        """The answer to a question; None where there is no such question."""
        known: dict[str, Answer] = {
            "start": self.start,
            "scene": self.scene,
            "keys": self.keys,
            "fit": self.fit,
            "picture": self.picture,
            "frame": self.frame,
            "save": self.save,
            "command": self.command,
        }
        return known.get(name)

    def start(self, asked: Asked, job: Job) -> dict[str, Any]:
        """The name of the file, its text, the keys; mode and frames of the film, and how many of these a second."""
        name, keys = self.source.path.name, {key: says for key, (says, _) in KEYS.items()}
        film = self._film(self.source.scene(None))
        moves = {"frames": 0} if film is None else {"frames": len(film), "fps": film.fps, "mode": film.animation.mode}
        movies = {"formats": movie_formats(), "file": None if self.video is None else str(self.video)}
        told = {"name": name, "text": self.source.text(), "file": isinstance(self.source, Source)}
        return {**told, "keys": keys, "film": moves, "movies": movies}

    def scene(self, asked: Asked, job: Job) -> tuple[bytes, str]:
        """What moves: lines in the world as 32-bit floats, and before them what else the page has to know."""
        scene = self._scene(asked)
        shown = moving(scene)
        low, high = scene.bounds
        lines = np.concatenate([shown.segments.reshape(-1, 6), shown.boxes.reshape(-1, 6)])
        head = json_bytes(
            {
                "first": first_state(scene).values(),
                "segments": len(shown.segments),
                "boxes": len(shown.boxes),
                "thinned": shown.thinned,
                "bounds": [low.tolist(), high.tolist()],
                "items": len(scene.items),
                "title": scene.title,
                "colours": shown.colours,
                "lights": [_told(light) for light in scene.lights],
                "page": _page(scene),
            }
        )
        return struct.pack("<I", len(head)) + head + lines.astype("<f4").tobytes(), "application/octet-stream"

    def keys(self, asked: Asked, job: Job) -> dict[str, Any]:
        """The state after keys, and where its lights are."""
        state, keys = _state(asked), asked.get("keys")
        if not isinstance(keys, list) or len(keys) > MOST_KEYS or not all(isinstance(key, str) for key in keys):
            raise InputError(f"viewer: expected a list of at most {MOST_KEYS} keys")
        wishes = []
        for key in keys:
            state = pressed(state, key)
            wishes += [state.wish] if state.wish else []
            state = replace(state, wish="")
        return {"state": state.values(), "wishes": wishes}

    def fit(self, asked: Asked, job: Job) -> dict[str, Any]:
        """The state from whose eye all of the scene is seen."""
        scene, state = self._scene(asked), _state(asked)
        low, high = scene.bounds
        x, y, z = ((low + high) / 2.0).tolist()
        centred = replace(state, target=(x, y, z))
        return {"state": replace(centred, fov_deg=fitting_fov_deg(centred, scene)).values()}

    def picture(self, asked: Asked, job: Job) -> tuple[bytes, str]:
        """The exact picture."""
        return for_browser(picture(_state(asked), self._scene(asked), progress=job.progress))

    def frame(self, asked: Asked, job: Job) -> tuple[bytes, str]:
        """A frame of the film, by its number from 0, in the mode of the page: painted where that is of pixels, but for
        a film of pixels, which has no other."""
        number, film = asked.get("frame"), self._film(self._scene(asked))
        count = 0 if film is None else len(film)
        if film is None or type(number) is not int or not 0 <= number < count:
            raise InputError(f"viewer: expected the number of one of {count} frames")
        if not film.pixels:
            film = replace(film, mode=MODES[as_written(_state(asked), "svg").mode])
        return for_browser(film.picture(number, progress=job.progress))

    def save(self, asked: Asked, job: Job) -> tuple[bytes, str]:
        """The picture as a file. Shaded pixels become painted polygons where the format has none."""
        format_ = asked.get("format")
        if format_ not in SAVED:
            raise InputError(f"viewer: expected one of {', '.join(SAVED)}")
        state = _state(asked)
        made = picture(as_written(state, format_), self._scene(asked), progress=job.progress)
        return write(made, format_), SAVED[format_]

    def command(self, asked: Asked, job: Job) -> dict[str, Any]:
        """The command that makes the picture."""
        format_ = asked.get("format")
        if format_ not in SAVED:
            raise InputError(f"viewer: expected one of {', '.join(SAVED)}")
        name, scene = str(self.source.path), self._scene(asked)
        return {"line": command_line(as_written(_state(asked), format_), scene, name, f"picture.{format_}")}

    def movie(self, asked: Asked, job: Job) -> tuple[str, bytes, str]:
        """What was recorded, drawn exactly: the name of a movie, its content, and its media type. Where it goes to a
        file there is no content."""
        name, content = write_recorded(asked, self._scene(asked), self.source.path.stem, self.video, job)
        return name, content, MOVIES.get(str(asked.get("format")), "")

    def _film(self, scene: Scene) -> Film | None:
        """The film of a scene; the last one is kept."""
        if self.film is None:
            return None
        kept = self._films.get(0)
        if kept is None or kept[0] is not scene:
            kept = self._films[0] = scene, self.film(scene)
        return kept[1]

    def _scene(self, asked: Asked) -> Scene:
        text = asked.get("text")
        if text is not None and not isinstance(text, str):
            raise InputError("viewer: the text of a scene is a text")
        return self.source.scene(text)


def as_written(state: ViewerState, format_: str) -> ViewerState:
    """The state whose picture is written: pixels only as PNG, otherwise painted polygons in their place."""
    return state if format_ == "png" else drawable(state)


def json_bytes(values: Any) -> bytes:
    """Values as JSON; numbers that are none become null."""
    return json.dumps(values, allow_nan=False).encode()


def told(error: Exception) -> dict[str, Any]:
    """What the page is told of an error: the cause, and the line where there is one."""
    if isinstance(error, InputError):
        return {"cause": error.cause, "line": error.line, "file": error.file}
    if isinstance(error, MemoryError):
        return {"cause": "there is not enough memory for this", "line": None, "file": None}
    cause = getattr(error, "strerror", None) or str(error)
    return {"cause": cause, "line": None, "file": getattr(error, "filename", None)}


def _state(asked: Asked) -> ViewerState:
    return ViewerState.of(asked.get("state"))


def _told(light: Light) -> dict[str, Any]:
    return {"position": light.position, "parallel": light.parallel, "name": light.name}


def _page(scene: Scene) -> dict[str, Any]:
    page = page_of_state(ViewerState(), scene)
    return {"width": page.width_mm, "height": page.height_mm, "margin": page.margin_mm, "named": scene.page is not None}
