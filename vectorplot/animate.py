"""The verb animate: an animation becomes a film."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.animation.animation import Animation
from vectorplot.animation.modes import MODES
from vectorplot.animation.steady_fit import steady_fit
from vectorplot.errors import InputError
from vectorplot.film import Film, Progress
from vectorplot.geometry.cameras.camera import VIEWS, Camera
from vectorplot.scene.pages.page import Page
from vectorplot.scene.point_of_view import camera_around, page_of
from vectorplot.words import check_word, unknown

SIZE = (800, 600)
"""Columns and rows of frames of pixels if nobody says otherwise."""


def animate(
    animation: Animation,
    *,
    mode: str | None = None,
    camera: Camera | str | None = None,
    page: Page | str | None = None,
    width: float | str | None = None,
    size: tuple[int, int] = SIZE,
    fit: bool = True,
    progress: Progress | None = None,
    **options: Any,
) -> Film:
    """The film of an animation: its frames, drawn, painted or rendered on one page.

    Parameters
    ----------
    animation : Animation
        What moves.
    mode : str, optional
        wire, lines, shading, shadows, erasing or pixels; where None that of the animation.
    camera : Camera or str, optional
        For all frames, in place of those of the scenes; or the name of a main view.
    page : Page or str, optional
        As of draw; where None that of the first scene, else A4.
    width : float or str, optional
        As of draw.
    size : (int, int)
        Columns and rows of frames of pixels.
    fit : bool
        What is seen in all frames together fills the page but for its margin, or the pixels, with the target in the
        middle: one fit for the whole film. Otherwise the page height is the camera's picture height.
    progress : callable, optional
        progress(stage, fraction) is called while it looks at all scenes.
    options : Any
        Others of the verb that makes the frames, such as lines, style, hidden or lights.

    Returns
    -------
    Film
        Frames are made when they are asked for; `vp.save` writes them all.

    Raises
    ------
    InputError
        For another mode or view, as of `Animation.scene`, and, when frames are made, as of the verb.

    Notes
    -----
    The eye stays where the scene has it, so that a fit changes no perspective. Where the scene of any frame reaches
    behind the eye, or more than 60 degrees off the principal ray, all frames show the camera's field of vision. Scenes
    without a camera are looked at as all of them together would be.

    Source: Glaeser, chapter 10.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> die = vp.Item("die", box((1, 1, 1)))
    >>> turning = vp.Animation(lambda time: die.turned("z", 90 * time), frames=8, loop=True)
    >>> film = vp.animate(turning, page="100x80", hidden="dashed")
    >>> [layer.name for layer in film.picture(3).layers if len(layer.strokes[0])]
    ['visible', 'contour', 'hidden']
    """
    word = animation.mode if mode is None else mode
    check_word("mode", word, MODES)
    chosen = MODES[word]
    pixels = chosen.verb == "render"
    bare = Film(animation, chosen, options={**options, "size": size} if pixels else options)
    if isinstance(camera, str) and camera not in VIEWS:
        raise unknown("view", camera, VIEWS)
    film = _looked_at(bare, camera)
    first = animation.scene(0)
    sheet = Page(float(size[0]), float(size[1]), 0.0) if pixels else page_of(page, first, width, fit)
    if pixels and min(size) < 1:
        raise InputError(f"frames of {size[0]} x {size[1]} pixels: expected 1 or more")
    if not fit:
        return film if pixels else replace(film, page=sheet)

    def views() -> Any:
        for frame in range(len(film)):
            if progress is not None:
                progress("fit", frame / len(film))
            yield film.view(frame)

    room = sheet
    if first.colouring is not None:
        from vectorplot.effects.scales.colour_bar import narrower

        room = narrower(sheet)
    fitted, zoom = steady_fit(views(), room)
    return replace(film, page=None if pixels else sheet if room is not sheet else fitted, zoom=zoom)


def _looked_at(film: Film, camera: Camera | str | None) -> Film:
    """The film with the camera that is asked for, or one for scenes that have none."""
    if isinstance(camera, Camera):
        return replace(film, camera=camera)
    if camera is None and film.animation.scene(0).camera is not None:
        return film
    bounds = np.array([film.animation.scene(frame).bounds for frame in range(len(film))])
    around = camera_around(np.stack([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)]))
    if camera is None:
        return replace(film, usual=around)
    return replace(film, camera=Camera.view(camera, target=around.target, distance=around.distance))
