"""A film: the frames of an animation, each made when it is asked for."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from vectorplot.animation.animation import Animation
from vectorplot.animation.correspondence import corresponding
from vectorplot.animation.modes import Mode
from vectorplot.animation.steady_fit import widened
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.pages.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.shading.raster.image import Image

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

    def save(
        self, path: str | os.PathLike[str], *, format: str | None = None, progress: Progress | None = None
    ) -> None:
        """Make all frames and write them, as `vp.save_frames` does.

        Parameters
        ----------
        path : str or path
            A name that ends in .pdf, .svg, .mp4, .webm, .gif or .vd1, or a folder.
        format : str, optional
            Of the files in a folder.
        progress : callable, optional
            progress(stage, fraction) is called while it works.

        Raises
        ------
        InputError
            As of `vp.save_frames` and of the verb.
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
            As of `Animation.scene`.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> film = vp.animate(vp.Animation(lambda time: vp.Item("die", box((1, 1, 1)))), camera=vp.Camera((9, 0, 0)))
        >>> film.view(0)[1].eye
        (9.0, 0.0, 0.0)
        """
        from vectorplot.scene.point_of_view import default_camera

        scene = self.animation.scene(frame)
        return scene, self.camera or scene.camera or self.usual or default_camera(scene)

    def picture(self, frame: int, progress: Progress | None = None) -> Drawing | Image:
        """A frame.

        Parameters
        ----------
        frame : int
            From 0.
        progress : callable, optional
            progress(stage, fraction) is called while it works.

        Returns
        -------
        Drawing or Image
            The picture; strokes are in the same order in all frames.

        Raises
        ------
        InputError
            As of `Animation.scene` and of the verb.

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
            from vectorplot.render import render

            return render(scene, fit=False, **given)
        if self.mode.verb == "paint":
            from vectorplot.paint import paint

            return paint(replace(scene, page=self.page), fit=False, **given)
        from vectorplot.draw import draw

        return corresponding(draw(replace(scene, page=self.page), fit=False, **given), scene)
