"""The command that makes what one looks at."""

from __future__ import annotations

import shlex
from collections.abc import Iterable

from vectorplot.scene.hatching import Hatching
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.viewer.pictures import request
from vectorplot.viewer.state import ViewerState, camera_of_state, lights_of_state


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
