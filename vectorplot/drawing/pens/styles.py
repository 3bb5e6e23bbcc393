"""Styles: what lines are shown, and the pens, dashes and paper that go together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from vectorplot.drawing.pens.pen_rules import PenRule, pen_rules
from vectorplot.words import check_colour, check_word

LOOKS = ("plain", "wireframe", "depth-cue")
"""Hidden lines removed; or all lines shown, in one shade or by their depth."""

HIDDEN_WAYS = ("none", "dashed", "solid")
"""How hidden lines look."""


@dataclass(frozen=True)
class Style:
    """How a drawing looks, as far as it is not said for the drawing itself.

    Parameters
    ----------
    look : {"plain", "wireframe", "depth-cue"}
        Hidden lines removed; or all lines shown, in one shade or by their depth, in colours of their own.
    hidden : {"none", "dashed", "solid"}
        How hidden lines look.
    pens : mapping of str to str
        As of `vp.draw`: kinds of lines, items, or item.kind, and WIDTH, COLOUR or WIDTH:COLOUR.
    dashes : mapping of str to str
        As of `vp.draw`: the same, and DASH,GAP.
    background : str, optional
        The colour of the paper; none is drawn where None.
    layers : str
        What shares a layer.

    Raises
    ------
    InputError
        For unknown words, and what is no pen.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> bold = vp.Style(pens={"contour": "0.8:red", "hidden": "0.2"}, hidden="dashed")
    >>> drawing = vp.draw(box((1, 2, 3)), style=bold)
    >>> next(layer.pen for layer in drawing.layers if layer.name == "contour").colour
    '#c00000'
    """

    look: Literal["plain", "wireframe", "depth-cue"] = "plain"
    hidden: Literal["none", "dashed", "solid"] = "none"
    pens: Mapping[str, str] = field(default_factory=dict)
    dashes: Mapping[str, str] = field(default_factory=dict)
    background: str | None = None
    layers: str = "kind"

    def __post_init__(self) -> None:
        check_word("look", self.look, LOOKS)
        check_word("hidden", self.hidden, HIDDEN_WAYS)
        if self.background is not None:
            check_colour(self.background, "background: ")
        _ = self.rules

    @property
    def rules(self) -> tuple[PenRule, ...]:
        """Its pens and dashes as rules."""
        return pen_rules(self.pens, self.dashes)


STYLES = {
    "plain": Style(),
    "wireframe": Style("wireframe"),
    "depth-cue": Style("depth-cue"),
    "plotter": Style(pens={"": "0.3"}, layers="kind,colour"),
    "book": Style(
        hidden="dashed",
        pens={"contour": "0.6", "boundary": "0.4", "crease": "0.3", "hidden": "0.13:gray", "parameter": "0.13"},
        dashes={"hidden": "1.6,0.9"},
    ),
    "draft": Style(hidden="solid", pens={"": "0.13:#4a4a4a", "contour": "0.25:black", "hidden": "0.09:#a8a8a8"}),
    "blueprint": Style(
        hidden="dashed",
        pens={"": "0.2:#dce8f7", "contour": "0.45:white", "boundary": "0.45:white", "hidden": "0.15:#86a8d8"},
        dashes={"hidden": "2,1.2"},
        background="#1f4788",
    ),
}
"""The styles that have a name."""
