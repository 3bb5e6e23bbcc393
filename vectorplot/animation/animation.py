"""The value Animation: a scene for every moment, and how many frames there are of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from vectorplot.animation.modes import MODES
from vectorplot.errors import InputError
from vectorplot.io.anything import scene_of
from vectorplot.scene.cuts.exploded import shown_apart
from vectorplot.scene.scene import Scene
from vectorplot.words import check_word

MOST_FRAMES = 100_000
"""Frames of one animation."""

MOST_PER_SECOND = 1000.0
"""Frames a second: no screen shows more."""


@dataclass(frozen=True, eq=False)
class Animation:
    """A scene that depends on time, and the frames that are made of it.

    Parameters
    ----------
    motion : callable
        motion(time) is the scene at a time from 0 to 1, or anything that has a shape, as of `io.scene_of`. Camera and
        lights are those of the scene. The same time gives the same scene, in whatever order frames are made; to be made
        in other processes, it can be pickled, as that of `read_animation` can.
    frames : int
        How many, 1 to 100,000.
    fps : float
        How many of them a second.
    mode : str
        A word of MODES: what frames look like where nothing else is said.
    loop : bool
        The first frame follows the last one: frame k is at time k / frames, otherwise at k / (frames - 1).

    Raises
    ------
    InputError
        For counts out of range and other words.

    Notes
    -----
    Degenerate: the only frame of an animation is at time 0.

    Source: Glaeser, chapter 10 and appendix A.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> die = vp.Item("die", box((1, 1, 1)))
    >>> turning = vp.Animation(lambda time: die.turned("z", 90 * time), frames=25, loop=True)
    >>> turning
    <Animation: 25 frames, 25 a second, lines>
    >>> turning.time(5), turning.scene(5).items[0].name
    (0.2, 'die')
    """

    motion: Callable[[float], Any]
    frames: int = 100
    fps: float = 25.0
    mode: str = "lines"
    loop: bool = False

    def __post_init__(self) -> None:
        check_frames(self.frames)
        check_fps(self.fps)
        check_word("mode", self.mode, MODES)
        object.__setattr__(self, "frames", int(self.frames))

    def __len__(self) -> int:
        return self.frames

    def __repr__(self) -> str:
        return f"<Animation: {self.frames} frames, {self.fps:g} a second, {self.mode}>"

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return self.frames / self.fps

    def time(self, frame: int) -> float:
        """The time of a frame.

        Parameters
        ----------
        frame : int
            From 0.

        Returns
        -------
        float
            From 0 to 1.

        Raises
        ------
        InputError
            For a frame that there is not.

        Examples
        --------
        >>> import vectorplot as vp
        >>> film = vp.Animation(lambda time: vp.Scene(()), frames=5)
        >>> [film.time(frame) for frame in range(5)]
        [0.0, 0.25, 0.5, 0.75, 1.0]
        """
        if not 0 <= frame < self.frames:
            raise InputError(f"frame {frame}: expected 0 to {self.frames - 1}")
        return frame / max(self.frames if self.loop else self.frames - 1, 1)

    def scene(self, frame: int) -> Scene:
        """The scene that a frame shows.

        Parameters
        ----------
        frame : int
            From 0.

        Returns
        -------
        Scene
            With its camera and its lights; its parts are moved apart if it says so.

        Raises
        ------
        InputError
            For a frame that there is not, and as of `io.scene_of`.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.geometry import box
        >>> die = vp.Item("die", box((1, 1, 1)))
        >>> film = vp.Animation(lambda time: die.moved(3 * time), frames=4)
        >>> film.scene(3).bounds.tolist()
        [[3.0, 0.0, 0.0], [4.0, 1.0, 1.0]]
        """
        return shown_apart(scene_of(self.motion(self.time(frame))))


def check_frames(frames: int) -> None:
    """An InputError for a number of frames that is out of range."""
    if not (1 <= frames <= MOST_FRAMES and float(frames).is_integer()):
        raise InputError(f"{frames:g} frames: expected 1 to {MOST_FRAMES}")


def check_fps(fps: float) -> None:
    """An InputError for frames a second that are out of range."""
    if not 0.0 < fps <= MOST_PER_SECOND:
        raise InputError(f"{fps:g} frames a second: expected more than 0, at most {MOST_PER_SECOND:g}")
