"""The answers of the viewer to its page: keys, moving pictures, commands, exact pictures and recordings."""

from __future__ import annotations

import io
import json
import math
import shlex
import struct
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.animation.animation import MODES, check_fps
from vectorplot.animation.correspondence import corresponding
from vectorplot.animation.movies import encoded, movie_of
from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.geometry.winding import mesh_edges
from vectorplot.pictures.draw import draw
from vectorplot.pictures.film import Film
from vectorplot.save import write
from vectorplot.save_frames import save_frames, write_frames
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.shading.palettes import palette
from vectorplot.viewer.pictures import Given, Job, Source, drawable, for_browser, picture, request
from vectorplot.viewer.state import (
    WIDEST_DEG,
    ViewerState,
    as_point,
    axes_of,
    camera_of_state,
    first_state,
    fitting_fov_deg,
    lights_of_state,
    page_of_state,
)

# The command that makes what one looks at.


def command_line(state: ViewerState, scene: Scene, source: str, out: str) -> str:
    """A line for a shell that makes the same picture.

    Parameters
    ----------
    state : ViewerState
        What one looks at.
    scene : Scene
        What is in the file.
    source, out : str
        The names of the file with the scene, and of that to write.

    Returns
    -------
    str
        `vectorplot draw`, `paint` or `render` with its options, quoted where a shell needs it.

    Notes
    -----
    Lights that were moved are lamps of the command, with their colours; line drawings have those of the file.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.viewer import command_line, first_state
    >>> scene = vp.Scene((vp.Item("die", box((1, 1, 1))),), camera=vp.Camera((0, -5, 0)))
    >>> command_line(first_state(scene), scene, "die.scene", "die.svg")[:60]
    'vectorplot draw die.scene -o die.svg --eye=0.0,-5.0,0.0 --ta'
    """
    asked = request(state, scene)
    words = ["vectorplot", asked.verb, source, "-o", out, *_camera(state, scene), "--no-fit"]
    for name, value in asked.keywords.items():
        words += _option(name, value)
    if asked.verb != "render" and state.landscape:
        words.append("--landscape")
    if asked.verb != "draw":
        words += [f"--lights={_lamp(light)}" for light in lights_of_state(state, scene) or ()]
    return shlex.join(words)


def _camera(state: ViewerState, scene: Scene) -> list[str]:
    camera = camera_of_state(state, scene)
    turn = f"--twist={camera.twist_deg!r}" if camera.up is None else f"--up={_numbers(camera.up)}"
    scale = ["--parallel", f"--height={camera.height!r}"] if camera.parallel else [f"--fov={camera.fov_deg!r}"]
    return [f"--eye={_numbers(camera.eye)}", f"--target={_numbers(camera.target)}", turn, *scale]


def _option(name: str, value: object) -> list[str]:
    if isinstance(value, Hatching):
        return [f"--hatch={value.by}", f"--spacing={value.spacing_mm!r}"]
    if name == "crease_angle_deg":
        return [f"--crease-angle={value!r}"]
    if name == "size" and isinstance(value, tuple):
        return [f"--size={value[0]}x{value[1]}"]
    return [f"--{name}={','.join(value) if isinstance(value, tuple) else value}"]


def _lamp(light: Light) -> str:
    words = [name for name in ("parallel", "fading") if getattr(light, name)]
    if light.intensity is not None:
        words.append(repr(light.intensity))
    if light.colour != "white":
        words.append(light.colour)
    return ",".join([_numbers(light.position), *words])


def _numbers(numbers: Iterable[float]) -> str:
    return ",".join(repr(float(number)) for number in numbers)


# What a key does. Source: Glaeser, section 4.4 and appendix A.3; erratum G4-05: the state's own angles change.

STEP = 0.05
"""By so many radians angles change."""

FACTOR = 1.03
"""Times so much distance and scale change."""

SHIFT = 1.0 / 40.0
"""By so much of the picture's height the target moves."""

Change = Callable[[ViewerState], ViewerState]


def pressed(state: ViewerState, key: str) -> ViewerState:
    """What one looks at after a key.

    Parameters
    ----------
    state : ViewerState
        What one looked at before.
    key : str
        A letter, or the name that browsers give a key, such as ArrowLeft; others are ignored.

    Returns
    -------
    ViewerState
        Its wish says what the key asked for beside another picture.

    Notes
    -----
    A field of vision grows no wider than 150 degrees. Elevations go on beyond the poles.

    Source: Glaeser, section 4.4 and appendix A.3; erratum G4-05.

    Examples
    --------
    >>> from vectorplot.viewer import pressed
    >>> from vectorplot.viewer.state import ViewerState
    >>> top = pressed(ViewerState(azimuth=1.0), "1")
    >>> top.parallel, pressed(top, "u").azimuth, pressed(top, "?") == top
    (True, 1.0, True)
    """
    change = KEYS.get(key)
    return state if change is None else change[1](replace(state, wish=""))


def _turn(azimuth: float = 0.0, elevation: float = 0.0, twist: float = 0.0) -> Change:
    return lambda state: replace(
        state,
        azimuth=state.azimuth + azimuth,
        elevation=state.elevation + elevation,
        twist=state.twist + twist,
    )


def _away(factor: float) -> Change:
    return lambda state: replace(state, distance=state.distance * factor)


def _larger(factor: float) -> Change:
    return lambda state: replace(state, fov_deg=scaled_fov_deg(state.fov_deg, factor))


def scaled_fov_deg(fov_deg: float, factor: float) -> float:
    """The field of vision in which all is so many times as large, no wider than WIDEST_DEG."""
    found = math.degrees(2.0 * math.atan(math.tan(math.radians(fov_deg) / 2.0) / factor))
    return min(found, max(WIDEST_DEG, fov_deg))


def _arrow(right: float, up: float) -> Change:
    def change(state: ViewerState) -> ViewerState:
        if state.lights:
            return replace(
                state,
                light_azimuth=state.light_azimuth + STEP * right,
                light_elevation=state.light_elevation + STEP * up,
            )
        step = SHIFT * state.picture_height
        across, upward, _ = axes_of(state)
        moved = [t + step * (right * a + up * u) for t, a, u in zip(state.target, across, upward, strict=True)]
        return replace(state, target=as_point(moved))

    return change


def _view(azimuth_quarters: int, elevation_quarters: int) -> Change:
    """A main view: parallel rays, and the former perspective kept for u."""

    def change(state: ViewerState) -> ViewerState:
        former = state.former or (state.azimuth, state.elevation, state.twist, state.parallel)
        quarter = math.pi / 2.0
        azimuth, elevation = azimuth_quarters * quarter, elevation_quarters * quarter
        return replace(state, azimuth=azimuth, elevation=elevation, twist=0.0, parallel=True, former=former)

    return change


def _back(state: ViewerState) -> ViewerState:
    if state.former is None:
        return state
    azimuth, elevation, twist, parallel = state.former
    return replace(state, azimuth=azimuth, elevation=elevation, twist=twist, parallel=parallel, former=None)


def _with(**values: object) -> Change:
    return lambda state: ViewerState.of({**state.values(), **values})


def _along(state: ViewerState) -> ViewerState:
    return state if state.lights_go_along_from is not None else replace(state, lights_go_along_from=state.azimuth)


def _still(state: ViewerState) -> ViewerState:
    """The lights stay where they have come to."""
    if state.lights_go_along_from is None:
        return state
    turned = state.light_azimuth + state.azimuth - state.lights_go_along_from
    return replace(state, light_azimuth=turned, lights_go_along_from=None)


KEYS: dict[str, tuple[str, Change]] = {
    "w": ("wireframe", _with(mode="wire")),
    "h": ("hidden lines", _with(mode="lines")),
    "j": ("hidden lines by the painter", _with(mode="erasing")),
    "s": ("shading", _with(mode="shading")),
    "c": ("cast shadows", _with(mode="shadows")),
    "f": ("freeze", _with(rotating=False)),
    "F": ("rotate by itself", _with(rotating=True)),
    "a": ("azimuth +", _turn(azimuth=STEP)),
    "A": ("azimuth −", _turn(azimuth=-STEP)),
    ">": ("azimuth +", _turn(azimuth=STEP)),
    "<": ("azimuth −", _turn(azimuth=-STEP)),
    "e": ("elevation +", _turn(elevation=STEP)),
    "E": ("elevation −", _turn(elevation=-STEP)),
    "^": ("elevation +", _turn(elevation=STEP)),
    "t": ("twist +", _turn(twist=STEP)),
    "T": ("twist −", _turn(twist=-STEP)),
    "x": ("larger", _larger(FACTOR)),
    "X": ("smaller", _larger(1.0 / FACTOR)),
    "d": ("farther", _away(FACTOR)),
    "D": ("nearer", _away(1.0 / FACTOR)),
    "ArrowLeft": ("target or lights left", _arrow(-1.0, 0.0)),
    "ArrowRight": ("target or lights right", _arrow(1.0, 0.0)),
    "ArrowUp": ("target or lights up", _arrow(0.0, 1.0)),
    "ArrowDown": ("target or lights down", _arrow(0.0, -1.0)),
    "1": ("top", _view(-1, 1)),
    "2": ("front", _view(-1, 0)),
    "3": ("right", _view(0, 0)),
    "4": ("bottom", _view(-1, -1)),
    "5": ("back", _view(1, 0)),
    "6": ("left", _view(2, 0)),
    "u": ("former perspective", _back),
    "g": ("geocentric: lights stand still", _still),
    "G": ("heliocentric: lights go along", _along),
    "k": ("colours", _with(colour_map=True)),
    "K": ("no colours", _with(colour_map=False)),
    "b": ("boxes", _with(boxes=True)),
    "B": ("no boxes", _with(boxes=False)),
    "o": ("outlines", _with(outlines=True)),
    "O": ("no outlines", _with(outlines=False)),
    "m": ("axes", _with(axes=True)),
    "M": ("no axes", _with(axes=False)),
    "l": ("lights, which arrows move", _with(lights=True)),
    "L": ("no lights", _with(lights=False)),
    "z": ("depth buffer", _with(depth_buffer=True)),
    "Z": ("painter's order", _with(depth_buffer=False)),
    "p": ("PostScript file", _with(wish="ps")),
    "v": ("begin and end a movie", _with(wish="video")),
    "q": ("quit", _with(wish="quit")),
    "Escape": ("quit", _with(wish="quit")),
}
"""What each key does, in words and as a change."""


# What is shown while the picture moves: few lines of the scene in the world, which a browser projects itself.

MOST_SEGMENTS = 12_000
"""So many lines a browser draws fifteen times a second, on one core."""

MOST_BOXES = 500
"""Of scenes with more items the boxes of the first ones are shown."""

MOST_COLOURS = 32
"""So many colours of items are shown."""

COARSE_MM = 0.5
"""How far off lines on smooth surfaces may be while they move."""

SHADES = 16
"""Of each colour that is shown."""


@dataclass(frozen=True, eq=False)
class Moving:
    """Lines in the world and what is shown over pictures.

    segments (n,2,3); boxes (m,2,3) lowest and highest corners of items; thinned: the segments are some of many.
    """

    segments: Floats
    boxes: Floats
    thinned: bool
    colours: tuple[tuple[str, tuple[str, ...]], ...]


def moving(scene: Scene) -> Moving:
    """The edges of meshes and the lines on smooth surfaces, no more than MOST_SEGMENTS, evenly chosen; the boxes round
    items; the shades of their colours, darkest first.

    Edge cases: nothing for an empty scene.
    """
    meshes = [item for item in scene.items if isinstance(item.shape, Mesh)]
    others = tuple(item for item in scene.items if not isinstance(item.shape, Mesh))
    parts = [_edges(item.shape) for item in meshes if isinstance(item.shape, Mesh)]
    if others:
        parts.append(_lines(Scene(others)))
    segments = np.concatenate([np.zeros((0, 2, 3)), *parts])
    step = -(-len(segments) // MOST_SEGMENTS)
    chosen = segments[:: max(step, 1)]
    return Moving(chosen, _boxes(scene), step > 1, _colours(scene))


def _edges(mesh: Mesh) -> Floats:
    return mesh.vertices[mesh_edges(mesh)]


def _lines(scene: Scene) -> Floats:
    """What a wireframe from afar shows of surfaces and curves."""
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(norm(high - low)) or 1.0
    x, y, z = (middle + size * np.array([2.0, -3.0, 2.0])).tolist()
    camera = Camera((x, y, z), tuple(middle.tolist()), parallel=True, height=size)
    found = []
    for layer in draw(scene, camera, style="wireframe", curves="polyline", tolerance_mm=COARSE_MM).layers:
        for paths in layer.strokes:
            follows = np.ones(len(paths.points3d), dtype=bool)
            follows[paths.offsets[1:] - 1] = False
            start = np.flatnonzero(follows)
            found.append(np.stack([paths.points3d[start], paths.points3d[start + 1]], axis=1))
            whole = np.flatnonzero(paths.closed)
            ends = paths.offsets[whole + 1] - 1, paths.offsets[whole]
            found.append(np.stack([paths.points3d[end] for end in ends], axis=1))
    segments = np.concatenate([np.zeros((0, 2, 3)), *found])
    return np.asarray(segments[np.isfinite(segments).all(axis=(1, 2))])


def _boxes(scene: Scene) -> Floats:
    found = []
    for item in islice(scene.items, MOST_BOXES):
        try:
            found.append(item.shape.bounds if isinstance(item.shape, Mesh) else Scene((item,)).bounds)
        except InputError:
            continue
    return np.array(found).reshape(-1, 2, 3)


def _colours(scene: Scene) -> tuple[tuple[str, tuple[str, ...]], ...]:
    names = dict.fromkeys(item.colour for item in scene.items)
    return tuple((name, tuple(_hex(shade) for shade in palette(name, SHADES))) for name in islice(names, MOST_COLOURS))


def _hex(shade: NDArray[np.uint8]) -> str:
    return "#" + "".join(f"{part:02x}" for part in shade.tolist())


# What was recorded by hand: the states of a page one after the other, drawn exactly and written as one movie.

MOST_FRAMES = 1500
"""So many frames are recorded, a minute; the page stops by itself there."""

MOVIES = {"mp4": "video/mp4", "svg": "image/svg+xml", "pdf": "application/pdf", "vd1": "application/zip"}
"""What movies may be, and their media types; the two files of polygons come in an archive."""

LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""The date of files in archives: the same movie, the same bytes."""


def movie_formats() -> tuple[str, ...]:
    """Those of MOVIES that can be written here: videos need the package av."""
    return tuple(word for word in MOVIES if word != "mp4" or find_spec("av") is not None)


def word_of(format_: object, known: Iterable[str]) -> str:
    """The format that a page names, one of some. Errors: InputError for another one, and for what is no text."""
    if not isinstance(format_, str) or format_ not in known:
        raise InputError(f"viewer: expected one of {', '.join(known)}")
    return format_


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
    Errors: see picture; SupersededError where the job is stopped.
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
    if file is None:
        format_ = word_of(format_, MOVIES)
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
        format_ = word_of(asked.get("format"), SAVED)
        state = _state(asked)
        made = picture(as_written(state, format_), self._scene(asked), progress=job.progress)
        return write(made, format_), SAVED[format_]

    def command(self, asked: Asked, job: Job) -> dict[str, Any]:
        """The command that makes the picture."""
        format_ = word_of(asked.get("format"), SAVED)
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
