"""What one looks at, from where and how: all that keys, mouse and sliders change."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np

from vectorplot.animation.animation import MODES
from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera, Point
from vectorplot.geometry.vectors import norm
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.scene.placement import camera_of, default_camera
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import LARGEST_VIEW, NO_AZIMUTH_SINE
from vectorplot.words import check_word

WIDEST_DEG = 150.0
"""A field of vision never grows wider by keys and wheel."""

HATCHINGS = ("none", "tone", "colour", "even")
"""How faces are hatched in line drawings."""

WISHES = ("", "ps", "video", "quit")
"""What a key asks of the program beside another picture: nothing, a file, a movie, its end."""

DIGITS = 12
"""Of coordinates and angles of cameras."""

_LAMP = (0.6, 0.9)
"""Azimuth from the eye's and elevation, in radians, of the lamp in a scene without lights, once it is moved."""


@dataclass(frozen=True)
class ViewerState:
    """The camera by spherical coordinates, the mode, and what is shown. azimuth, elevation, twist: radians; distance,
    target: world units; fov_deg: over the page's height; parallel: the picture's height is that of the central one
    through the target; former: azimuth, elevation, twist, parallel before a main view; mode: a word of
    `animation.MODES`; light_azimuth, light_elevation: turn of all lights about the scene, radians;
    lights_go_along_from: the eye's azimuth when lights began to follow it, None where they stand; rotating: azimuth
    changes by itself; depth_buffer: pixels, not painted polygons; outlines: on shaded pictures; colour_map, boxes,
    axes, lights: shown but not saved; landscape; wish: what a key asked for besides a picture.
    Errors: InputError for numbers not finite or out of range, and unknown words.
    """

    azimuth: float = -math.pi / 3.0
    elevation: float = 0.5
    twist: float = 0.0
    distance: float = 1.0
    target: Point = (0.0, 0.0, 0.0)
    fov_deg: float = 30.0
    parallel: bool = False
    former: tuple[float, float, float, bool] | None = None
    mode: str = "lines"
    crease_angle_deg: float = 25.0
    hatch: str = "none"
    spacing_mm: float = 0.6
    light_azimuth: float = 0.0
    light_elevation: float = 0.0
    lights_go_along_from: float | None = None
    rotating: bool = False
    depth_buffer: bool = False
    outlines: bool = False
    colour_map: bool = False
    boxes: bool = False
    axes: bool = False
    lights: bool = False
    landscape: bool = False
    wish: str = ""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            object.__setattr__(self, field.name, _checked(field.name, str(field.type), value))
        check_word("mode", self.mode, MODES)
        check_word("hatch", self.hatch, HATCHINGS)
        if self.wish not in WISHES:
            raise InputError(f"viewer: wish {self.wish!r} is none of {', '.join(WISHES[1:])}")
        if not self.distance > 0.0:
            raise InputError("viewer: the distance must be positive")
        if not 0.0 < self.fov_deg < 180.0:
            raise InputError(f"viewer: field of vision {self.fov_deg:g} must lie between 0 and 180 degrees")

    @property
    def picture_height(self) -> float:
        """Height of the picture in world units, in the plane through the target that faces the eye."""
        return 2.0 * self.distance * math.tan(math.radians(self.fov_deg) / 2.0)

    def values(self) -> dict[str, Any]:
        """All fields by their names, as JSON takes them."""
        return asdict(self)

    @classmethod
    def of(cls, values: object) -> ViewerState:
        """The state of such values; fields that are left out have their defaults.

        Errors: InputError for what is no mapping, unknown names, and values that make no sense.
        """
        if not isinstance(values, Mapping):
            raise InputError("viewer: a state is a mapping of fields")
        known = {field.name for field in fields(cls)}
        unknown = next((name for name in values if name not in known), None)
        if unknown is not None:
            raise InputError(f"viewer: a state has no {str(unknown)!r}")
        return cls(**values)


def _checked(name: str, kind: str, value: Any) -> Any:
    """A field's value where it is of its kind. Errors: InputError otherwise."""
    if value is None and kind.endswith("None"):
        return None
    if kind.startswith(("Point", "tuple")):
        numbers = tuple(value) if isinstance(value, tuple | list) else ()
        if len(numbers) == (3 if kind == "Point" else 4):
            return (*(_number(name, one) for one in numbers[:3]), *(bool(one) for one in numbers[3:]))
    elif kind.startswith("float"):
        return _number(name, value)
    elif isinstance(value, bool if kind == "bool" else str):
        return value
    raise InputError(f"viewer: {name} cannot be {str(value)[:40]!r}")


def _number(name: str, value: Any) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST_VIEW:
        return float(value)
    raise InputError(f"viewer: {name} must be a number below {LARGEST_VIEW:g}")


def axes_of(state: ViewerState) -> tuple[Floats, Floats, Floats]:
    """Right, up, and back towards the eye: unit vectors in world coordinates, also beyond the poles."""
    cos_a, sin_a = math.cos(state.azimuth), math.sin(state.azimuth)
    cos_e, sin_e = math.cos(state.elevation), math.sin(state.elevation)
    back = np.array([cos_e * cos_a, cos_e * sin_a, sin_e])
    right = np.array([-sin_a, cos_a, 0.0])
    up = np.cross(back, right)
    cos_t, sin_t = math.cos(state.twist), math.sin(state.twist)
    return cos_t * right + sin_t * up, cos_t * up - sin_t * right, back


def seen_from(camera: Camera) -> ViewerState:
    """The state that looks as a camera does."""
    back = camera.direction
    azimuth, elevation = math.atan2(back[1], back[0]), math.asin(min(1.0, max(-1.0, back[2])))
    level = ViewerState(azimuth, elevation)
    right, up, _ = axes_of(level)
    twist = math.atan2(float(matmul(camera.axes[0], up)), float(matmul(camera.axes[0], right)))
    fov = math.degrees(2.0 * math.atan(camera.picture_height / (2.0 * camera.distance)))
    return replace(
        level, twist=twist, distance=camera.distance, target=camera.target, fov_deg=fov, parallel=camera.parallel
    )


def first_state(scene: Scene) -> ViewerState:
    """What the program begins with: the scene from its own camera, with a field of vision in which all of it is seen.

    Parameters
    ----------
    scene : Scene
        Without a camera it is seen as by `vp.draw`.

    Returns
    -------
    ViewerState
        Line drawing; on the longer side of A4 where the scene names no page.

    Notes
    -----
    Edge cases: where the scene reaches behind the eye, or there is nothing in it, the camera keeps its field of vision.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.viewer import first_state
    >>> scene = vp.Scene((vp.Item("die", box((1, 1, 1))),), camera=vp.Camera((0, -5, 0)))
    >>> round(first_state(scene).distance, 6), first_state(scene).mode
    (5.0, 'lines')
    """
    state = replace(seen_from(camera_of(None, scene)), landscape=scene.page is None)
    return replace(state, fov_deg=fitting_fov_deg(state, scene))


def fitting_fov_deg(state: ViewerState, scene: Scene) -> float:
    """The field of vision in which the box round the scene is just within the margins of the page."""
    low, high = scene.bounds
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T - state.target
    right, up, back = axes_of(state)
    depth = np.full(8, state.distance) if state.parallel else state.distance - matmul(corners, back)
    page = page_of_state(state, scene)
    wide, high_mm = page.width_mm - 2.0 * page.margin_mm, page.height_mm - 2.0 * page.margin_mm
    if not (depth > 0.0).all() or not scene.items:
        return state.fov_deg
    across = np.maximum(np.abs(matmul(corners, up)) / high_mm, np.abs(matmul(corners, right)) / wide) * page.height_mm
    slope = float((across / depth).max())
    found = math.degrees(2.0 * math.atan(slope))
    return min(found, WIDEST_DEG) if found > 0.0 and math.isfinite(found) else state.fov_deg


def page_of_state(state: ViewerState, scene: Scene) -> Page:
    """The page of the scene, else A4, on its longer side where the state says so."""
    page = scene.page or Page()
    return page.landscape if state.landscape else page


def camera_of_state(state: ViewerState, scene: Scene) -> Camera:
    """The camera of a state, with the near and far planes of the scene's own.

    Where an azimuth would not tell how the picture stands the camera has an up vector, otherwise a twist, so that its
    fields are those that options of the command give.
    """
    base = scene.camera or default_camera(scene)
    right, up, back = axes_of(state)
    eye = _rounded(np.asarray(state.target) + state.distance * back, state.distance)
    twisted = base.up is None and math.cos(state.elevation) > NO_AZIMUTH_SINE
    rest = math.radians(base.twist_deg)
    upright = math.cos(rest) * up + math.sin(rest) * right
    return Camera(
        eye,
        state.target,
        None if twisted else _rounded(upright, 1.0),
        _rounded((math.degrees(state.twist),) * 3, 1.0)[0] if twisted else base.twist_deg,
        base.fov_deg if state.parallel else state.fov_deg,
        state.parallel,
        state.picture_height if state.parallel else None,
        base.near,
        base.far,
    )


def as_point(vector: Iterable[float]) -> Point:
    """Three numbers as Python has them."""
    x, y, z = (float(one) for one in vector)
    return (x, y, z)


def _rounded(numbers: Iterable[float], size: float) -> Point:
    """Numbers in as many digits as a command has to name, of what is so large."""
    places = DIGITS - math.ceil(math.log10(size))
    x, y, z = (round(float(number), places) + 0.0 for number in numbers)
    return (x, y, z)


def lights_of_state(state: ViewerState, scene: Scene) -> tuple[Light, ...] | None:
    """The lights of the scene, turned about its middle; None where they are as they were.

    A scene without lights gets a lamp, once it is moved.
    """
    along = 0.0 if state.lights_go_along_from is None else state.azimuth - state.lights_go_along_from
    turn, lift = state.light_azimuth + along, state.light_elevation
    if not turn and not lift:
        return None
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(norm(high - low)) or 1.0
    if not scene.lights:
        base = seen_from(camera_of(None, scene))
        return (Light(_turned(middle, 2.0 * size, base.azimuth + _LAMP[0] + turn, _LAMP[1] + lift)),)
    moved = []
    for light in scene.lights:
        x, y, z = np.asarray(light.position) - (np.zeros(3) if light.parallel else middle)
        radius = math.hypot(x, y, z)
        azimuth, elevation = math.atan2(y, x) + turn, math.atan2(z, math.hypot(x, y)) + lift
        about = np.zeros(3) if light.parallel else middle
        moved.append(replace(light, position=_turned(about, radius, azimuth, elevation)))
    return tuple(moved)


def _turned(about: Floats, radius: float, azimuth: float, elevation: float) -> Point:
    flat = radius * math.cos(elevation)
    offset = (flat * math.cos(azimuth), flat * math.sin(azimuth), radius * math.sin(elevation))
    return as_point(about + np.asarray(offset))
