"""Strokes that tell how far away they are."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.errors import InputError
from vectorplot.words import check_word

CUES = ("width", "shade")
"""What of strokes goes by depth: the width of their pens, or how much of their colour is left before the paper."""

MOST_STEPS = 32
"""As many as a palette has shades."""


@dataclass(frozen=True)
class DepthCue:
    """Strokes that are thinner, or paler, the farther away they are, in a few steps: each is a pen.

    Parameters
    ----------
    by : tuple of str
        width: the farthest strokes are a fifth as wide as the nearest; shade: they have a fifth of their colour, the
        rest is that of the paper. Or both.
    steps : int
        So many steps, 2 to 32, each over an equal part of the depth of all strokes: for every pen of a drawing so many.

    Raises
    ------
    InputError
        For other words, none at all, and other numbers of steps.

    Notes
    -----
    Source: Glaeser, section 4.4: shades between those of the limits of depth, the lowest fifth unused.

    Examples
    --------
    >>> from vectorplot.scene import DepthCue
    >>> DepthCue.read("width,shade,8")
    DepthCue(by=('width', 'shade'), steps=8)
    """

    by: tuple[str, ...] = ("width",)
    steps: int = 5

    def __post_init__(self) -> None:
        for word in self.by:
            check_word("depth cue", word, CUES)
        if not self.by:
            raise InputError(f"depth cue: expected {' or '.join(CUES)}")
        if not (2 <= self.steps <= MOST_STEPS and float(self.steps).is_integer()):
            raise InputError(f"depth cue: {self.steps} steps, expected 2 to {MOST_STEPS}")

    @classmethod
    def read(cls, text: str) -> DepthCue:
        """The depth cue that a text says: width, shade or both, and a number of steps, with commas between them.

        Parameters
        ----------
        text : str
            Such as "width" or "width,shade,8".

        Returns
        -------
        DepthCue
            Of five steps where the text names no number.

        Raises
        ------
        InputError
            For other texts.

        Examples
        --------
        >>> from vectorplot.scene import DepthCue
        >>> DepthCue.read("shade").steps
        5
        """
        words = [word.strip() for word in text.split(",")]
        try:
            steps = int(words[-1])
        except ValueError:
            return cls(tuple(dict.fromkeys(words)))
        return cls(tuple(dict.fromkeys(words[:-1])), steps)


def depth_cue_of(given: DepthCue | str | None) -> DepthCue | None:
    """What is said in place of a scene's own depth cue; None for the word none.

    Errors: InputError as of DepthCue.
    """
    if isinstance(given, str):
        return None if given == "none" else DepthCue.read(given)
    return given
