"""The style and the pens that a scene asks for itself."""

from __future__ import annotations

from vectorplot.drawing.pens.pen_rules import PenRule, pen_rules
from vectorplot.drawing.pens.style_file import style_of
from vectorplot.drawing.pens.styles import Style
from vectorplot.errors import InputError
from vectorplot.scene.pages.inks import Inks


def style_of_scene(inks: Inks | None, asked: Style | str | None) -> tuple[Style, tuple[PenRule, ...]]:
    """The style that is asked for, else that of the scene, else plain; and the rules of the scene's own pens.

    Pens of the scene have nothing to do in a wireframe, which has colours of its own.

    Errors: InputError for unknown styles and what is no pen, and for a scene with pens and a wireframe of its own.
    """
    own = Inks() if inks is None else inks
    style = style_of(asked if asked is not None else own.style or "plain")
    rules = pen_rules(own.pens, own.dashes)
    if style.look == "plain":
        return style, rules
    if rules and asked is None:
        raise InputError(f"pens do not go with the style {style.look}, which shows all lines, in colours of its own")
    return style, ()
