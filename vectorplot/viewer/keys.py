"""What a key does. Source: Glaeser, section 4.4 and appendix A.3; erratum G4-05: the state's own angles change."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from vectorplot.geometry.cameras.camera import Point
from vectorplot.viewer.state import WIDEST_DEG, ViewerState, axes_of

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
    >>> from vectorplot.viewer import ViewerState, pressed
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
        return replace(state, target=_point(moved))

    return change


def _point(numbers: list[float]) -> Point:
    x, y, z = (float(number) for number in numbers)
    return (x, y, z)


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
