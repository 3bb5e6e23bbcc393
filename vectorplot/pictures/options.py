"""What the arguments of the verbs may be: of another type each is one sentence, before any work."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from numbers import Real

import numpy as np

from vectorplot.drawing.drawing import Pen
from vectorplot.drawing.pen_layers import layer_words
from vectorplot.drawing.pens import Style
from vectorplot.errors import InputError
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.pens import DepthCue
from vectorplot.tolerances import LEAST_TOLERANCE_MM
from vectorplot.words import check_word

_LONGEST = 60
"""So much of a wrong argument is shown."""

Fits = Callable[[object], bool]


def _is(*types: type) -> Fits:
    return lambda given: isinstance(given, types)


def _is_number(given: object) -> bool:
    return isinstance(given, Real) and not isinstance(given, bool)


def _are_texts(given: object) -> bool:
    """Texts that can be gone over once more; those of an iterator are used up by looking."""
    if isinstance(given, str):
        return True
    if not isinstance(given, Iterable) or isinstance(given, bytes):
        return False
    return not isinstance(given, tuple | list | set | frozenset) or all(isinstance(one, str) for one in given)


_NUMBER = "a number", _is_number
_LENGTH = (
    "a number of mm, or a text with a unit such as '8cm'",
    lambda given: isinstance(given, str) or _is_number(given),
)
_YES = "True or False", _is(bool, np.bool_)
_TEXT = "a text", _is(str)
_WORDS = "a text with commas between words, or several words", _are_texts
_PENS = (
    "a text such as '0.3' or 'contour=0.5:black', several, a mapping or a Pen",
    lambda given: isinstance(given, Pen | Mapping) or _are_texts(given),
)
_DASHES = (
    "a text such as 'hidden=3,1', several, or a mapping",
    lambda given: isinstance(given, Mapping) or _are_texts(given),
)
_CALLED = "a function", callable

_EXPECTED: dict[str, tuple[str, Fits]] = {
    "width": _LENGTH,
    "margin_pixels": _NUMBER,
    "fit": _YES,
    "lines": _WORDS,
    "crease_angle_deg": _NUMBER,
    "style": ("a Style or a text such as 'book'", _is(Style, str, os.PathLike)),
    "pens": _PENS,
    "dashes": _DASHES,
    "scale_pens": _YES,
    "thin_ends": _YES,
    "depth_cue": ("a DepthCue or a text such as 'width', 'shade,8' or 'none'", _is(DepthCue, str)),
    "halo_mm": _NUMBER,
    "hatch": ("a Hatching such as vp.Hatching('tone'), or a Stippling", _is(Hatching, Stippling)),
    "layers": ("a text such as 'kind' or 'kind,colour'", _is(str)),
    "unplotted": _WORDS,
    "tolerance_mm": _NUMBER,
    "title": _TEXT,
    "frame": _YES,
    "longest_mm": _NUMBER,
    "budget": _NUMBER,
    "exposure": ("a number or 'fitted'", lambda given: isinstance(given, str) or _is_number(given)),
    "aura_mm": _NUMBER,
    "palette": _NUMBER,
    "smooth": _YES,
    "shadow_focus": _NUMBER,
    "progress": _CALLED,
    "explain": _CALLED,
}

_NEVER_NONE = (_NUMBER, _YES, _TEXT)
_MAY_BE_NONE = {
    "longest_mm",
    "margin_pixels",
    "shadow_focus",
    *(name for name, one in _EXPECTED.items() if one not in _NEVER_NONE),
}
"""What is left out where it is None; lines of paint and render are looked at where they are read."""


def check_types(arguments: Mapping[str, object]) -> None:
    """An InputError for the first of a verb's arguments, by their names, that is of another type than the verb's own.

    Words, cameras and pages are looked at where they are read.
    """
    for name, (told, fits) in _EXPECTED.items():
        if name not in arguments or (arguments[name] is None and name in _MAY_BE_NONE) or fits(arguments[name]):
            continue
        shown = repr(arguments[name])
        shown = shown if len(shown) <= _LONGEST else f"{shown[: _LONGEST - 3]}..."
        raise InputError(f"{name}: expected {told}, got {shown}")


# What options of draw may be.

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
