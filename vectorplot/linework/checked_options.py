"""What options of draw may be."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.pens.sorted_layers import layer_words
from vectorplot.errors import InputError
from vectorplot.tolerances.of_lengths import LEAST_TOLERANCE_MM
from vectorplot.words import check_word

SHORTEST_MM = 1.0
"""To parts shorter than this no stroke is cut: it would be dots."""


def check_line_options(
    hidden: str, layers: str, curves: str, halo_mm: float, crease_angle_deg: float, tolerance_mm: float
) -> None:
    """InputError for unknown words, and for numbers out of range."""
    check_word("hidden", hidden, ("none", "dashed", "solid"))
    layer_words(layers)
    check_word("curves", curves, ("bezier", "polyline"))
    if not 0.0 <= halo_mm < np.inf:
        raise InputError(f"a halo of {halo_mm:g} mm: expected a width that is finite and not negative")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    if not LEAST_TOLERANCE_MM <= tolerance_mm < np.inf:
        raise InputError(f"a tolerance of {tolerance_mm:g} mm: expected {LEAST_TOLERANCE_MM:g} or more")


def check_longest(longest_mm: float | None) -> None:
    """InputError for strokes that would be cut too short."""
    if longest_mm is not None and not longest_mm >= SHORTEST_MM:
        raise InputError(f"longest strokes of {longest_mm:g} mm: expected {SHORTEST_MM:g} mm or more")


def check_look(style: str, **others: bool) -> None:
    """InputError for an unknown style, and for options, by their names, that wireframes leave nothing to do."""
    check_word("style", style, ("plain", "wireframe", "depth-cue"))
    for name, given in others.items():
        if given and style != "plain":
            raise InputError(f"{name} does not go with the style {style}, which shows all lines, in colours of its own")
