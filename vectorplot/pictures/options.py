"""What the arguments of the verbs may be, each described once.

Of another type, out of range or another word each is one sentence, before any work; the command reads its options by
the same ranges and words."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from numbers import Real

from vectorplot.errors import InputError
from vectorplot.tolerances import LEAST_TOLERANCE_MM
from vectorplot.words import TEXT_WORDS, check_word

_LONGEST = 60
"""So much of a wrong argument is shown."""


@dataclass(frozen=True)
class Option:
    """What one argument may be.

    expected, fits: its type, in words and as a test; optional: None is left out; words: all that a text may be; least,
    most: the range of a number, which is finite; whole: a whole one; said: what messages call the number.
    """

    expected: str
    fits: Callable[[object], bool]
    optional: bool = True
    words: tuple[str, ...] = ()
    least: float = -math.inf
    most: float = math.inf
    whole: bool = False
    said: str = ""

    @property
    def range(self) -> str:
        """The range, in words."""
        return f"{self.least:g} or more" if self.most == math.inf else f"{self.least:g} to {self.most:g}"

    def check(self, name: str, given: object) -> None:
        """InputError for what is of another type, out of range, or another word."""
        if given is None and self.optional:
            return
        if not self.fits(given):
            shown = repr(given)
            shown = shown if len(shown) <= _LONGEST else f"{shown[: _LONGEST - 3]}..."
            raise InputError(f"{name}: expected {self.expected}, got {shown}")
        if self.words and isinstance(given, str):
            check_word(name, given, self.words)
        if self.said and isinstance(given, Real):
            value = float(given)
            # NaN lies between no two numbers.
            within = self.least <= value <= self.most and value < math.inf
            if not within or (self.whole and not value.is_integer()):
                raise InputError(f"{self.said.format(given)}: expected {self.range}")


def _is(*types: type) -> Callable[[object], bool]:
    return lambda given: isinstance(given, types)


def _is_number(given: object) -> bool:
    return isinstance(given, Real) and not isinstance(given, bool)


def _is_truth(given: object) -> bool:
    """Python's or numpy's."""
    return isinstance(given, bool) or getattr(given, "dtype", None) == "bool"


def _are_texts(given: object) -> bool:
    """Texts that can be gone over once more; those of an iterator are used up by looking."""
    if isinstance(given, str):
        return True
    if not isinstance(given, Iterable) or isinstance(given, bytes):
        return False
    return not isinstance(given, tuple | list | set | frozenset) or all(isinstance(one, str) for one in given)


def _is_a(*classes: str, texts: tuple[type, ...] = (str,)) -> Callable[[object], bool]:
    """Whether something is a text, or of one of these classes of ours, by their names: nothing is imported for it."""
    return lambda given: (
        isinstance(given, texts)
        or any(one.__name__ in classes and one.__module__.startswith("vectorplot.") for one in type(given).__mro__)
    )


def _number(said: str, least: float, most: float = math.inf, *, whole: bool = False, optional: bool = False) -> Option:
    return Option("a number", _is_number, optional, (), least, most, whole, said)


def _word(*words: str, optional: bool = False) -> Option:
    return Option("a text", _is(str), optional, words)


_ANY_NUMBER = Option("a number", _is_number, optional=False)
_YES = Option("True or False", _is_truth, optional=False)
_TEXT = Option("a text", _is(str), optional=False)
_WORDS = Option("a text with commas between words, or several words", _are_texts)
_CALLED = Option("a function", callable)

OPTIONS: dict[str, Option] = {
    "margin_pixels": Option("a number", _is_number),
    "width": Option(
        "a number of mm, or a text with a unit such as '8cm'",
        lambda given: isinstance(given, str) or _is_number(given),
    ),
    "fit": _YES,
    "lines": _WORDS,
    "hidden": _word("none", "dashed", "solid", optional=True),
    "curves": _word("bezier", "polyline", "arcs"),
    "text": _word(*TEXT_WORDS),
    "font": Option("the name of a family of fonts, or a file", _is(str)),
    "fills": _word("painted", "visible", "erasing"),
    "transparency": _word("blended", "sparse"),
    "crease_angle_deg": _number("a crease angle of {:g} degrees", 0.0, 180.0),
    "style": Option("a Style or a text such as 'book'", _is_a("Style", texts=(str, os.PathLike))),
    "pens": Option(
        "a text such as '0.3' or 'contour=0.5:black', several, a mapping or a Pen",
        lambda given: _is_a("Pen", texts=(Mapping,))(given) or _are_texts(given),
    ),
    "dashes": Option(
        "a text such as 'hidden=3,1', several, or a mapping",
        lambda given: isinstance(given, Mapping) or _are_texts(given),
    ),
    "scale_pens": _YES,
    "thin_ends": _YES,
    "depth_cue": Option("a DepthCue or a text such as 'width', 'shade,8' or 'none'", _is_a("DepthCue")),
    "halo_mm": _number("a halo of {:g} mm", 0.0),
    "reflections": _number("{:g} reflections", 0, 8, whole=True),
    "hatch": Option("a Hatching such as vp.Hatching('tone'), or a Stippling", _is_a("Hatching", "Stippling", texts=())),
    "layers": Option("a text such as 'kind' or 'kind,colour'", _is(str)),
    "unplotted": _WORDS,
    "tolerance_mm": _number("a tolerance of {:g} mm", LEAST_TOLERANCE_MM),
    "title": _TEXT,
    "frame": _YES,
    "shortest_mm": _number("shortest strokes of {:g} mm", 0.0, optional=True),
    # Shorter parts of strokes would be dots.
    "longest_mm": _number("longest strokes of {:g} mm", 1.0, optional=True),
    "off_by": Option("a number, or a text such as '0.01mm'", lambda given: isinstance(given, str) or _is_number(given)),
    "within": Option("seconds, or a text such as '0.5s'", lambda given: isinstance(given, str) or _is_number(given)),
    "budget": _ANY_NUMBER,
    "exposure": Option("a number or 'fitted'", lambda given: isinstance(given, str) or _is_number(given)),
    "aura_mm": _number("an aura of {:g} mm", 0.0),
    "palette": _number("a palette of {:g} shades", 2, 256, whole=True),
    "smooth": _YES,
    "tabs_mm": _number("tabs of {:g} mm", 0.0),
    "numbers": _YES,
    "mirror": Option(
        "an AnamorphicMirror or a text such as 'cone'",
        _is_a("AnamorphicMirror"),
        optional=False,
        words=("cylinder", "cone", "none"),
    ),
    "radius_mm": _number("a mirror with a radius of {:g} mm", 0.0),
    "height_mm": _number("a mirror {:g} mm high", 0.0, optional=True),
    "seen_mm": _number("a picture of {:g} mm", 0.0, optional=True),
    "samples": _number("{:g} samples", 1, 8, whole=True, optional=True),
    "shadow_focus": Option("a number", _is_number),
    "progress": _CALLED,
    "explain": _CALLED,
}
"""What the arguments of the verbs may be, by their names; cameras, pages and lights are checked where they are read."""

SHADOWS = {"paint": ("auto", "none"), "render": ("auto", "none", "buffer", "trapezoid", "perspective", "exact")}
"""The ways that the verbs have of finding shadows."""


def check_options(arguments: Mapping[str, object]) -> None:
    """An InputError for the first of a verb's arguments, by their names, that is not what it may be."""
    for name, option in OPTIONS.items():
        if name in arguments:
            option.check(name, arguments[name])


def check_letters(font: str | None, text: str) -> None:
    """InputError for a font that is none, and for one of letters that are strokes."""
    if font is None:
        return
    from vectorplot.drawing.texts import check_font

    check_font(font)
    if text == "strokes":
        raise InputError("font: letters are strokes; with text='real' (--text real) they have a font")


def check_look(style: str, **others: bool) -> None:
    """InputError for an unknown style, and for options, by their names, that wireframes leave nothing to do."""
    check_word("style", style, ("plain", "wireframe", "depth-cue"))
    for name, given in others.items():
        if given and style != "plain":
            raise InputError(f"{name} does not go with the style {style}, which shows all lines, in colours of its own")
