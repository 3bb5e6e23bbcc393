"""The exact pictures of the viewer: what is asked for, the scene that is looked at, and the jobs that make pictures."""

from __future__ import annotations

import asyncio
import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from vectorplot.animation.animation import MODES
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.geometry.budget import stopping
from vectorplot.io.read_file import SCENE_SUFFIXES, read
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.draw import draw
from vectorplot.pictures.paint import paint
from vectorplot.pictures.render import render
from vectorplot.save import SHOWN, shown_as, write
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.scene import Scene
from vectorplot.shading.image import Image
from vectorplot.viewer.state import ViewerState, camera_of_state, lights_of_state, page_of_state

# The exact picture of what one looks at, by the verb of its mode.

PIXELS_HIGH = 720
"""Rows of pictures of pixels."""

OUTLINES = ("contour", "boundary")
"""The kinds of lines that outlines are."""

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Request:
    """What a verb is told: its name, and its keywords but for camera and page."""

    verb: str
    keywords: dict[str, Any]


def request(state: ViewerState, scene: Scene) -> Request:
    """The verb of a state's mode and its keywords."""
    mode = MODES[state.mode]
    told = dict(mode.options)
    shaded = state.mode in ("shading", "shadows", "pixels")
    verb = "render" if shaded and state.depth_buffer else mode.verb
    if state.mode != "wire":
        told["crease_angle_deg"] = state.crease_angle_deg
    if state.outlines and (shaded or state.mode == "lines"):
        told["lines"] = OUTLINES
    if state.mode == "lines" and state.hatch != "none":
        told["hatch"] = Hatching(state.hatch, spacing_mm=state.spacing_mm)  # type: ignore[arg-type]  # checked word
    if verb == "render":
        page = page_of_state(state, scene)
        told["size"] = (round(PIXELS_HIGH * page.width_mm / page.height_mm), PIXELS_HIGH)
    return Request(verb, told)


def picture(state: ViewerState, scene: Scene, *, progress: Progress | None = None) -> Drawing | Image:
    """What the verb of the state's mode makes of the scene, at the scale of the state's camera.

    Parameters
    ----------
    state : ViewerState
        What one looks at.
    scene : Scene
        Of which camera and lights are replaced.
    progress : callable, optional
        progress(stage, fraction) is called while it works; what it raises stops the work.

    Returns
    -------
    Drawing or Image
        Pixels where a depth buffer finds what is hidden.

    Raises
    ------
    InputError
        See the verbs.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.viewer import first_state, picture
    >>> scene = vp.Scene((vp.Item("die", box((1, 1, 1))),))
    >>> picture(first_state(scene), scene).width_mm
    297.0
    """
    asked = request(state, scene)
    camera = camera_of_state(state, scene)
    told = {**asked.keywords, "fit": False, "progress": progress}
    if asked.verb == "draw":
        lit = lights_of_state(state, scene)
        shown = scene if lit is None else replace(scene, lights=lit)
        return draw(shown, camera, page=page_of_state(state, scene), **told)
    told["lights"] = lights_of_state(state, scene)
    if asked.verb == "paint":
        return paint(scene, camera, page=page_of_state(state, scene), **told)
    return render(scene, camera, **told)


def drawable(state: ViewerState) -> ViewerState:
    """The state with painted polygons where it shows pixels."""
    return replace(state, mode="shadows" if state.mode == "pixels" else state.mode, depth_buffer=False)


def for_browser(made: Drawing | Image) -> tuple[bytes, str]:
    """A picture as SVG, or as PNG where it is of pixels or has very many marks, and its media type."""
    format = "png" if isinstance(made, Image) else shown_as(made)[0]
    return write(made, format), SHOWN[format]


# Pictures that are being made: of each page the latest wins, and what nobody waits for any more stops.

Made = TypeVar("Made")

MOST_PAGES = 64
"""Of more pages that are open at once the jobs wait for those of others."""


class SupersededError(Exception):
    """The page has asked for something newer, or the program ends."""


@dataclass(eq=False)
class Job:
    """Work of one page; progress is handed to the verbs, which stop where it raises SupersededError.

    frames: how many are done, and how many there are, where it makes a movie; heard is told of each.
    """

    stopped: threading.Event = field(default_factory=threading.Event)
    frames: tuple[int, int] = (0, 0)
    heard: Callable[[int, int], None] | None = None

    def frame(self, done: int, count: int) -> None:
        """So many frames of so many are done."""
        self.frames = (done, count)
        if self.heard is not None:
            self.heard(done, count)

    def progress(self, stage: str, fraction: float) -> None:
        """Let the work go on, or stop it."""
        self.go_on()

    def go_on(self) -> None:
        """The same, where nobody knows how far the work is."""
        if self.stopped.is_set():
            raise SupersededError("nobody waits for it any more")


class Jobs:
    """A thread that makes pictures, one after the other."""

    def __init__(self) -> None:
        self.latest: dict[str, Job] = {}
        self.lock = threading.Lock()
        self.closed = False
        self.pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="picture")

    def submit(
        self, page: str, work: Callable[[Job], Made], heard: Callable[[int, int], None] | None = None
    ) -> tuple[Job, Future[Made]]:
        """The job of a page's work, and what will come of it: SupersededError where it is stopped; at once where the
        program ends.

        What the page has asked for before is stopped. heard: is told how many frames are done.
        """
        job = Job(heard=heard)
        with self.lock:
            if self.closed:
                raise SupersededError("the program ends")
            if page not in self.latest and len(self.latest) >= MOST_PAGES:
                page = next(iter(self.latest))
            before = self.latest.pop(page, None)
            self.latest[page] = job
            if before is not None:
                before.stopped.set()

            def working() -> Made:
                job.go_on()
                with stopping(job.go_on):
                    return work(job)

            return job, self.pool.submit(working)

    async def run(self, page: str, work: Callable[[Job], Made]) -> Made:
        """What the work makes. Errors: SupersededError where the page asks for something newer first."""
        job, made = self.submit(page, work)
        try:
            return await asyncio.wrap_future(made)
        except asyncio.CancelledError:
            if self.closed:
                raise SupersededError("the program ends") from None
            raise
        finally:
            self.end(job)

    def end(self, job: Job) -> None:
        """Stop a job that nobody waits for any more, because it is done or its page has gone."""
        job.stopped.set()
        with self.lock:
            self.latest = {page: other for page, other in self.latest.items() if other is not job}

    def close(self) -> None:
        """Stop all work; waits for what is running to notice."""
        with self.lock:
            self.closed = True
            for job in self.latest.values():
                job.stopped.set()
        self.pool.shutdown(wait=True, cancel_futures=True)


@dataclass(frozen=True, eq=False)
class Workers:
    """Who makes what a page asks for: neither a key nor a picture waits for what takes longer than itself."""

    quick: Jobs = field(default_factory=Jobs)
    pictures: Jobs = field(default_factory=Jobs)
    movies: Jobs = field(default_factory=Jobs)

    def of(self, what: str) -> Jobs:
        """Those who answer a question, by its name."""
        if what == "movie":
            return self.movies
        return self.pictures if what in ("picture", "frame", "save", "sketch") else self.quick

    def close(self) -> None:
        """Stop all work, as Jobs does."""
        for jobs in (self.quick, self.pictures, self.movies):
            jobs.close()


# The scene that is looked at: a file, or the text that stands in the page's editor in its place.

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
