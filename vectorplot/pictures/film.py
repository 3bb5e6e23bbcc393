"""The verb animate: an animation becomes a film, whose frames are made when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.animation.animation import MODES, Animation, Mode
from vectorplot.animation.correspondence import corresponding, steady_fit, widened
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.geometry.camera import VIEWS, Camera
from vectorplot.pictures.pipeline import stoppable
from vectorplot.pictures.pixels import raster_page
from vectorplot.scene.page import Page
from vectorplot.scene.placement import PageAtScale, camera_around, page_of
from vectorplot.scene.scene import Scene
from vectorplot.shading.image import Image
from vectorplot.words import check_word, unknown

if TYPE_CHECKING:
    from vectorplot.save import Destination

# A film: the frames of an animation, each made when it is asked for.

Progress = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Film:
    """The frames of an animation as pictures on one page.

    Parameters
    ----------
    animation : Animation
        What moves, how many frames there are, and how many a second.
    mode : Mode
        What makes frames.
    camera : Camera, optional
        In place of those of the scenes.
    usual : Camera, optional
        For scenes that have none.
    page : Page, optional
        That of all frames; of pixels None.
    zoom : float
        By how much the heights of the cameras' pictures are multiplied.
    options : mapping
        Keywords of the verb, for all frames.

    Notes
    -----
    Made by `vp.animate`. A frame depends on nothing but its number: frames may be made in any order, and, where the
    animation can be pickled, in other processes.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> die = vp.Item("die", box((1, 1, 1)))
    >>> film = vp.animate(vp.Animation(lambda time: die.turned("z", 90 * time), frames=3), page="100x80")
    >>> film, [drawing.width_mm for drawing in film]
    (<Film: 3 frames, 25 a second, draw>, [100.0, 100.0, 100.0])
    """

    animation: Animation
    mode: Mode
    camera: Camera | None = None
    usual: Camera | None = None
    page: Page | None = None
    zoom: float = 1.0
    options: Mapping[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return self.animation.frames

    def __repr__(self) -> str:
        return f"<Film: {len(self)} frames, {self.fps:g} a second, {self.mode.verb}>"

    def __iter__(self) -> Iterator[Drawing | Image]:
        return (self.picture(frame) for frame in range(len(self)))

    @property
    def fps(self) -> float:
        """Frames a second."""
        return self.animation.fps

    @property
    def pixels(self) -> bool:
        """Whether frames are pixels."""
        return self.mode.verb == "render"

    @stoppable
    def save(self, path: Destination, *, format: str | None = None, progress: Progress | None = None) -> None:
        """Make all frames and write them, as `vp.save_frames` does.

        Parameters
        ----------
        path : str, path or file object
            A name that ends in .pdf, .svg, .mp4, .webm, .gif or .vd1, a folder, or an open file.
        format : str, optional
            Of the files in a folder; needed for an open file.
        progress : callable, optional
            progress(stage, fraction) is called while it works; what it raises stops the work, amid a stage too.

        Raises
        ------
        InputError
            See `vp.save_frames` and the verb.
        OSError
            Where a file cannot be written; it names the path.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> film = vp.animate(vp.Animation(lambda time: vp.Item("die", box((1, 1, 1))), frames=2), page="100x80")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     film.save(pathlib.Path(folder, "film.pdf"))
        ...     pathlib.Path(folder, "film.pdf").read_bytes().startswith(b"%PDF-")
        True
        """
        from vectorplot.save_frames import save_frames, told

        save_frames(told(self, len(self), progress), path, fps=self.fps, format=format)

    def view(self, frame: int) -> tuple[Scene, Camera]:
        """The scene that a frame shows, and the camera that sees it, without the zoom.

        Parameters
        ----------
        frame : int
            From 0.

        Returns
        -------
        Scene
            With its lights.
        Camera
            That of the film, or of the scene.

        Raises
        ------
        InputError
            See `Animation.scene`.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> film = vp.animate(vp.Animation(lambda time: vp.Item("die", box((1, 1, 1)))), camera=vp.Camera((9, 0, 0)))
        >>> film.view(0)[1].eye
        (9.0, 0.0, 0.0)
        """
        from vectorplot.scene.placement import default_camera

        scene = self.animation.scene(frame)
        return scene, self.camera or scene.camera or self.usual or default_camera(scene)

    def picture(self, frame: int, progress: Progress | None = None) -> Drawing | Image:
        """A frame.

        Parameters
        ----------
        frame : int
            From 0.
        progress : callable, optional
            progress(stage, fraction) is called while it works; what it raises stops the work, amid a stage too.

        Returns
        -------
        Drawing or Image
            The picture; strokes are in the same order in all frames.

        Raises
        ------
        InputError
            See `Animation.scene` and the verb.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> die = vp.Item("die", box((1, 1, 1)))
        >>> film = vp.animate(vp.Animation(lambda time: die, frames=2), mode="shading", page="100x80")
        >>> film.picture(1)
        <Drawing '': 100x80 mm, marks: fills 3>
        """
        scene, camera = self.view(frame)
        given = {**self.mode.options, **self.options, "camera": widened(camera, self.zoom), "progress": progress}
        if self.pixels:
            from vectorplot.pictures.render import render

            return render(scene, fit=False, **given)
        if self.mode.verb == "paint":
            from vectorplot.pictures.paint import paint

            return paint(replace(scene, page=self.page), fit=False, **given)
        from vectorplot.pictures.draw import draw

        return corresponding(draw(replace(scene, page=self.page), fit=False, **given), scene)


# The verb animate: an animation becomes a film.

SIZE = (800, 600)
"""Columns and rows of frames of pixels if nobody says otherwise."""


@stoppable
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
        See draw; where None that of the first scene, else A4.
    width : float or str, optional
        See draw.
    size : (int, int)
        Columns and rows of frames of pixels.
    fit : bool
        What is seen in all frames together fills the page, or the pixels, but for the margin, with the target in the
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
        For another mode or view, see `Animation.scene`, and, when frames are made, see the verb.

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
    if pixels and min(size) < 1:
        raise InputError(f"frames of {size[0]} x {size[1]} pixels: expected 1 or more")
    sheet = raster_page(size, options.get("margin_pixels"), 1.0) if pixels else page_of(page, first, width, fit)
    if isinstance(sheet, PageAtScale):
        raise InputError("a page at a scale is of single pictures: a film has one page for all its frames")
    if first.scale_bar is not None:
        raise InputError("a scale bar is of single pictures, not of films")
    if not fit:
        return film if pixels else replace(film, page=sheet)

    def views() -> Any:
        for frame in range(len(film)):
            if progress is not None:
                progress("fit", frame / len(film))
            yield film.view(frame)

    room = sheet
    if first.colouring is not None:
        from vectorplot.effects.colour_maps import narrower

        room = narrower(sheet, first.colouring)
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
