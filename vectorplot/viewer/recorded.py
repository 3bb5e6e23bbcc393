"""What was recorded by hand: the states of a page one after the other, drawn exactly and written as one movie."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from vectorplot.animation.animation import check_fps
from vectorplot.animation.correspondence import corresponding
from vectorplot.animation.movies.encoding import encoded
from vectorplot.animation.movies.recorder import movie_of
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.save_frames import save_frames, write_frames
from vectorplot.scene.scene import Scene
from vectorplot.viewer.jobs import Job
from vectorplot.viewer.pictures import drawable, picture
from vectorplot.viewer.state import ViewerState

MOST_FRAMES = 1500
"""So many frames are recorded, a minute; the page stops by itself there."""

MOVIES = {"mp4": "video/mp4", "svg": "image/svg+xml", "pdf": "application/pdf", "vd1": "application/zip"}
"""What movies may be, and their media types; the two files of polygons come in an archive."""

LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""The date of files in archives: the same movie, the same bytes."""


def movie_formats() -> tuple[str, ...]:
    """Those of MOVIES that can be written here: videos need the package av."""
    return tuple(word for word in MOVIES if word != "mp4" or find_spec("av") is not None)


def recorded_states(frames: object) -> tuple[ViewerState, ...]:
    """The states of frames: the first one whole, of each other one what is new in it.

    Errors: InputError for no frames, more than MOST_FRAMES, and what is no state.
    """
    if not isinstance(frames, list) or not frames:
        raise InputError("viewer: nothing was recorded")
    if len(frames) > MOST_FRAMES:
        raise InputError(f"viewer: {len(frames)} frames: expected at most {MOST_FRAMES}")
    found: list[ViewerState] = []
    values: dict[str, Any] = {}
    for new in frames:
        if not isinstance(new, Mapping):
            raise InputError("viewer: a frame is a mapping of fields")
        values = {**values, **new}
        found.append(ViewerState.of(values) if new or not found else found[-1])
    return tuple(found)


def recorded_pictures(states: tuple[ViewerState, ...], scene: Scene, job: Job) -> Iterator[Drawing]:
    """The drawings of states, on the page of the first one; the same state is drawn once.

    Pixels become painted polygons: a movie has frames of one kind.
    Errors: as of picture; SupersededError where the job is stopped.
    """
    before: tuple[ViewerState, Drawing] | None = None
    for number, state in enumerate(states):
        job.frame(number, len(states))
        job.progress("frames", number / len(states))
        shown = drawable(replace(state, landscape=states[0].landscape))
        if before is None or before[0] != shown:
            made = picture(shown, scene, progress=job.progress)
            if not isinstance(made, Drawing):
                raise InputError(f"viewer: frames of the mode {shown.mode} are no drawings")
            # Painted polygons keep the order in which they cover each other.
            before = shown, corresponding(made, scene) if shown.mode in ("lines", "wire") else made
        yield before[1]
    job.frame(len(states), len(states))


def write_recorded(asked: Mapping[str, Any], scene: Scene, stem: str, file: Path | None, job: Job) -> tuple[str, bytes]:
    """The movie that a page asks for, by its frames, fps and format: its name and content, or the file it went to and
    nothing.

    Errors: InputError for frames that are none, and unknown formats; OSError where the file cannot be written.
    """
    states, fps, format_ = recorded_states(asked.get("frames")), asked.get("fps"), asked.get("format")
    if not isinstance(fps, int | float) or isinstance(fps, bool):
        raise InputError("viewer: fps must be a number")
    check_fps(fps)
    if file is None and format_ not in MOVIES:
        raise InputError(f"viewer: expected one of {', '.join(MOVIES)}")
    pictures = recorded_pictures(states, scene, job)
    if file is not None:
        file.parent.mkdir(exist_ok=True)
        save_frames(pictures, file, fps=fps)
        return str(file), b""
    if format_ == "vd1":
        return f"{stem}.zip", _archive(pictures, stem)
    return f"{stem}.{format_}", write_frames(pictures, str(format_), fps)


def _archive(pictures: Iterator[Drawing], stem: str) -> bytes:
    """The two files of a movie of polygons."""
    found = io.BytesIO()
    with zipfile.ZipFile(found, "w") as archive:
        for suffix, content in zip(("vd1", "vd2"), encoded(movie_of(pictures)), strict=True):
            archive.writestr(zipfile.ZipInfo(f"{stem}.{suffix}", LONG_AGO), content, zipfile.ZIP_DEFLATED)
    return found.getvalue()
