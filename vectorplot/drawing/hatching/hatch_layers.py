"""What pens hatch with: layers of hatching strokes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.layers import BLACK, ink, layers_of
from vectorplot.scene.hatching import Hatching, Stippling

NAME = "hatch"
"""What layers of hatching are called, together with what tells them apart."""


def hatch_layers(
    strokes: Paths, hatching: Sequence[Hatching | Stippling | None], colours: Sequence[str] | None = None
) -> tuple[Layer, ...]:
    """A layer for every width of pen that hatches items, and every colour; the first one may be empty.

    strokes of hatchings only; hatching: of every item; colours: of every item, black where None.
    """
    if not len(strokes):
        return ()
    widths = [0.0 if one is None else one.width_mm for one in hatching]
    inks = [BLACK] * len(widths) if colours is None else [ink(colour) for colour in colours]
    words = [""] * len(widths) if colours is None else [f" {colour}" for colour in colours]
    used = set(strokes.item.tolist())
    pens = list(dict.fromkeys(pen for k, pen in enumerate(zip(words, widths, inks, strict=True)) if k in used))
    several = len({width for _, width, _ in pens}) > 1
    number = {pen: k for k, pen in enumerate(pens)}
    of_item = np.array([number.get(pen, 0) for pen in zip(words, widths, inks, strict=True)], dtype=np.intp)
    named = [(f"{NAME}{word}{f' {w:g}' if several else ''}", Pen(w, colour), True) for word, w, colour in pens]
    return layers_of(strokes, of_item[strokes.item], named)
