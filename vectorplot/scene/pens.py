"""What a scene says of its pens, and of strokes that tell how far away they are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from vectorplot.errors import InputError
from vectorplot.words import LineKind, check_word, nearest

# What a scene says of the pens it is drawn with.

HIDDEN = "hidden"
"""The kind of what something is in front of, whatever else it is."""

FRAME = "frame"
"""What draws the frame of a page and its title: a kind that no line of a scene is of."""

PEN_KINDS = (*(kind.word for kind in LineKind), HIDDEN, FRAME)
"""The kinds that pens are for."""

WIDEST_MM = 25.0
"""No pen and no brush that plotters take is wider: 50 is 0.50 without its point."""

LONGEST_MM = 1000.0
"""No dash and no gap is longer."""

FINEST_MM = 0.01
"""No pen is finer, or draws a shorter dash."""


@dataclass(frozen=True)
class PenOverrides:
    """The style, the pens and the dashes that a scene asks for; what `vp.draw` is told comes before them.

    Parameters
    ----------
    style : str, optional
        The name of a style, or a file that ends in .toml.
    pens : mapping of str
        For kinds of lines, items, or item.kind: WIDTH, COLOUR or WIDTH:COLOUR, as in `vp.draw`.
    dashes : mapping of str
        For the same: DASH,GAP in mm, or none.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.scene import PenOverrides
    >>> inks = PenOverrides("book", {"contour": "0.7:red"})
    >>> cube = vp.Item("cube", vp.geometry.box((1, 1, 1)))
    >>> drawing = vp.draw(vp.Scene((cube,), inks=inks))
    >>> {layer.name: layer.pen.width_mm for layer in drawing.layers}["contour"]
    0.7
    """

    style: str | None = None
    pens: Mapping[str, str] = field(default_factory=dict)
    dashes: Mapping[str, str] = field(default_factory=dict)

    def renamed(self, names: Mapping[str, str]) -> PenOverrides:
        """The same of a scene whose items have other names."""
        pens, dashes = (
            {_joined(*_renamed(target, names)): said for target, said in own.items()}
            for own in (self.pens, self.dashes)
        )
        return replace(self, pens=pens, dashes=dashes)


def target_of(text: str) -> tuple[str | None, str | None]:
    """The kind and the item that a pen is for: None for all of them."""
    if not text:
        return None, None
    if text.lower() in PEN_KINDS:
        return text.lower(), None
    item, dot, kind = text.rpartition(".")
    if dot and item and kind.lower() in PEN_KINDS:
        return kind.lower(), item
    return None, text


def unknown_item(item: str, items: Iterable[str]) -> InputError:
    """The error for an item that is not among those of a scene, with the word that may be meant."""
    word, known = item.lower(), {name.lower(): name for name in items}
    near = nearest(word, PEN_KINDS) or known.get(word, known.get(nearest(word, known) or "", ""))
    hint = f" (did you mean {near!r}?)" if near else ""
    return InputError(f"pen {item!r}: no kind of line, and no item{hint}")


def _renamed(target: str, names: Mapping[str, str]) -> tuple[str | None, str | None]:
    kind, item = target_of(target)
    return kind, None if item is None else names.get(item, item)


def _joined(kind: str | None, item: str | None) -> str:
    return ".".join(part for part in (item, kind) if part is not None)


# Strokes that tell how far away they are.

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

        text: such as "width" or "width,shade,8"; result: of five steps where the text names no number.
        Errors: for other texts.
        """
        words = [word.strip() for word in text.split(",")]
        try:
            steps = int(words[-1])
        except ValueError:
            return cls(tuple(dict.fromkeys(words)))
        return cls(tuple(dict.fromkeys(words[:-1])), steps)


def depth_cue_of(given: DepthCue | str | None) -> DepthCue | None:
    """What is said in place of a scene's own depth cue; None for the word none.

    Errors: InputError as in DepthCue.
    """
    if isinstance(given, str):
        return None if given == "none" else DepthCue.read(given)
    return given
