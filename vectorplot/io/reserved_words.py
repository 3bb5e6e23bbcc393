"""All words of the scene language."""

from __future__ import annotations

from vectorplot.io.named_shapes import CURVES, SLOT_WORDS, SURFACES
from vectorplot.io.scene_item import CAP_WORDS
from vectorplot.io.scene_statements import FIELD_WORDS
from vectorplot.io.scene_words import FORM_WORDS, ITEM_WORDS, SCENE_WORDS
from vectorplot.words import COLOURS, MATERIALS

_WITHIN = ("position", "direction", "intensity", "fading", "none", "face", "polygon", "at", "normal", "lit_by")
_OF_LABELS = ("vertex", "on", "along", "size", "place", "hidden", "mark")

RESERVED = frozenset(
    (
        *(*SCENE_WORDS, *ITEM_WORDS, *FORM_WORDS, *CAP_WORDS, *COLOURS, *MATERIALS),
        *(*SURFACES, *CURVES, *SLOT_WORDS, *_WITHIN, *_OF_LABELS, *FIELD_WORDS),
    )
)
"""Words that are no names unless they are quoted."""
