"""The pens of lines that lie over painted or shaded faces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.layers import FRAME_PEN, layers_by_kind
from vectorplot.drawing.pens.pen_rules import PenRule, Pens, frame_pen, pen_of, pen_rules, rules_by_target, scaled_pen
from vectorplot.drawing.pens.scene_inks import style_of_scene
from vectorplot.drawing.pens.sorted_layers import in_pens
from vectorplot.drawing.pens.styles import Style
from vectorplot.errors import InputError
from vectorplot.scene.pages.inks import Inks
from vectorplot.words import LineKind


@dataclass(frozen=True)
class OverlaidPens:
    """Rules of pens, the last one that fits counts, and the colour of the paper that goes with them, if one does."""

    rules: tuple[PenRule, ...]
    background: str | None

    def layers(self, paths: Paths, items: Sequence[str], width: float | None = None, mm: float = 1.0) -> list[Layer]:
        """Strokes in layers by kind, with their pens.

        items: the name of every item; width: of all pens where no rule says otherwise, those of the kinds where None;
        mm: how long a millimetre is in units of the page, in which width is said. Rules for items that are not there
        have no effect.
        """
        found: Sequence[Layer] = layers_by_kind(paths)
        if width is not None:
            found = [replace(layer, pen=replace(layer.pen, width_mm=width / mm)) for layer in found]
        return [replace(layer, pen=scaled_pen(layer.pen, mm)) for layer in in_pens(found, items, self.rules)]

    def letters(self, pen: Pen) -> Pen:
        """The pen of letters, where rules say nothing the one given."""
        return pen_of(rules_by_target(self.rules), pen, int(LineKind.LABEL), False, "")

    def border(self, letters: Pen) -> Pen:
        """The pen of a frame and a title, where that of letters is known."""
        return frame_pen(self.rules, replace(FRAME_PEN, colour=letters.colour))


def overlaid_pens(
    inks: Inks | None,
    style: Style | str | None,
    pens: Pens | None,
    dashes: str | Mapping[str, str] | Iterable[str] | None,
) -> OverlaidPens:
    """The pens that a scene asks for and those that are asked for beside it, which come first.

    A scene's own wireframe has nothing to say where faces are filled.
    Errors: InputError for unknown styles, what is no pen or dash, and a wireframe that is asked for.
    """
    asked = pen_rules(pens, dashes)
    chosen, own = style_of_scene(inks, style)
    if chosen.look != "plain":
        if style is not None:
            raise InputError(f"the style {chosen.look} shows lines alone: it is for draw")
        return OverlaidPens(asked, None)
    return OverlaidPens((*chosen.rules, *own, *asked), chosen.background)
