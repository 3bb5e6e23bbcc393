"""What the arguments of the verbs may be: of another type each is one sentence, before any work."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from numbers import Real

import numpy as np

from vectorplot.drawing.drawing import Pen
from vectorplot.drawing.pens.styles import Style
from vectorplot.errors import InputError
from vectorplot.scene.depth_cue import DepthCue
from vectorplot.scene.hatching import Hatching, Stippling

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
_MAY_BE_NONE = {"longest_mm", "shadow_focus", *(name for name, one in _EXPECTED.items() if one not in _NEVER_NONE)}
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
