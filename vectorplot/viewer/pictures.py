"""The exact picture of what one looks at, by the verb of its mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from vectorplot.animation.modes import MODES
from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing
from vectorplot.paint import paint
from vectorplot.render import render
from vectorplot.save import write
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.scene import Scene
from vectorplot.shading.raster.image import Image
from vectorplot.viewer.state import ViewerState, camera_of_state, lights_of_state, page_of_state

PIXELS_HIGH = 720
"""Rows of pictures of pixels."""

MOST_MARKS = 30_000
"""A browser is given drawings with more of them as pixels."""

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
        As of the verbs.

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
    if isinstance(made, Image) or sum(len(mark) for layer in made.layers for mark in layer.marks) > MOST_MARKS:
        return write(made, "png"), "image/png"
    return write(made, "svg"), "image/svg+xml"
