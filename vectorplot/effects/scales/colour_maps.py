"""Colours for numbers from low to high."""

from __future__ import annotations

from importlib import import_module

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.words import unknown

COLOUR_MAPS: dict[str, tuple[str, ...]] = {
    "viridis": (
        *("#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b"),
        "#fde725",
    ),
    "heat": ("#1b0a24", "#5b1648", "#a32748", "#dd4f2f", "#f28c28", "#f9c74f", "#fff3c4"),
    "diverging": ("#2c5aa0", "#7fa8d1", "#dfe6ea", "#f0c3a2", "#d9744f", "#a32020"),
    "land": ("#6f9f6a", "#a5c183", "#e2dda6", "#d8b67c", "#b88a5a", "#99745a", "#c8c1ba", "#ffffff"),
    "gray": ("#202020", "#f4f4f4"),
}
"""Colours from low to high, with what is between them mixed. viridis: control points of the map of matplotlib by
Smith and van der Walt, which is in the public domain (CC0)."""


def map_colours(name: str, count: int) -> list[str]:
    """So many colours #rrggbb of a map, from its low end to its high end.

    Errors: InputError for a name that is neither of ours nor of matplotlib's, where that is installed.
    """
    if name in COLOUR_MAPS:
        given = np.array(
            [[int(word[k : k + 2], 16) for k in (1, 3, 5)] for word in COLOUR_MAPS[name]], dtype=np.float64
        )
        place = np.linspace(0.0, len(given) - 1.0, count)
        return _words(np.stack([np.interp(place, np.arange(len(given)), given[:, k]) for k in range(3)], axis=1))
    try:
        colormaps = import_module("matplotlib").colormaps
    except ImportError:
        raise unknown("colour map", name, COLOUR_MAPS, "or one of matplotlib, which is not installed") from None
    if name not in colormaps:
        raise unknown("colour map", name, COLOUR_MAPS, "or one of matplotlib")
    try:
        return _words(255.0 * np.asarray(colormaps[name](np.linspace(0.0, 1.0, count)), dtype=np.float64)[:, :3])
    except (TypeError, ValueError):
        raise InputError(f"colour map {name!r}: matplotlib gives no colours") from None


def _words(colours: Floats) -> list[str]:
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.floor(colours + 0.5).astype(int).tolist()]
