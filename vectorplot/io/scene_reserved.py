"""All words of the scene language."""

from __future__ import annotations

from vectorplot.io.scene_families import CURVES, SLOT_WORDS, SURFACES
from vectorplot.io.scene_reader import HANDLERS
from vectorplot.io.scene_words import SCENE_WORDS

_WITHIN = ("position", "direction", "intensity", "fading", "none", "face", "polygon", "at", "normal", "lit_by")

RESERVED = frozenset([*HANDLERS, *SCENE_WORDS, *SURFACES, *CURVES, *SLOT_WORDS, *_WITHIN])
"""Words that are no names unless they are quoted."""
