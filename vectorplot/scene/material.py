"""What the surface of an item is like."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.errors import InputError
from vectorplot.geometry.elementary import log, power
from vectorplot.words import MATERIALS, unknown_material

OPACITY_OF_TRANSPARENT = 0.5
"""The opacity of what is transparent where nothing else is said."""

MOST_HIGHLIGHT = 10.0
"""The highlight from which on its sharpness, where it is not given, is no greater: that of a mirror, 1024."""

FINISH_WORDS = ("exponent", "diffuse", "highlight", "sharpness")
"""The numbers of a material that say how it takes light, in place of those of its word."""


@dataclass(frozen=True, init=False)
class Material:
    """How a surface takes light.

    Parameters
    ----------
    word : str
        normal, metallic, shiny (or reflecting), mat (or matte), wood, plastic, transparent, mirror, or unlit, which has
        its colour whatever the light.
    opacity : float, optional
        0 (clear) to 1; that of what is transparent a half where none is given, else 1.
    refraction : float
        The constant sin(alpha)/sin(beta) of Snell's law, positive.
    exponent : float, optional
        Of the cosine of the angle between normal and light: 1 is Lambert's law, 2 and more look metallic, 0.5 to 1 mat.
        None, here and below: that of the word.
    diffuse : float, optional
        The share of the light that is sent back in all directions, 0 or more.
    highlight : float, optional
        The strength of the mirrored light, 0 or more.
    sharpness : float, optional
        The exponent of the cosine of the angle between mirrored ray and eye, positive. Where only one of highlight and
        sharpness is given, the highlight is the logarithm of the sharpness to the base 2.

    Raises
    ------
    InputError
        For other words and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Material("transparent").opacity
    0.5
    >>> vp.Material("plastic", diffuse=0.7, sharpness=16).own_finish
    {'diffuse': 0.7, 'highlight': 4.0, 'sharpness': 16.0}
    >>> vp.Material("reflecting").word
    'shiny'
    """

    word: str
    opacity: float
    refraction: float
    exponent: float | None
    diffuse: float | None
    highlight: float | None
    sharpness: float | None

    def __init__(
        self,
        word: str = "normal",
        opacity: float | None = None,
        refraction: float = 1.0,
        *,
        exponent: float | None = None,
        diffuse: float | None = None,
        highlight: float | None = None,
        sharpness: float | None = None,
    ) -> None:
        if word not in MATERIALS:
            raise unknown_material(word)
        if opacity is None:
            opacity = OPACITY_OF_TRANSPARENT if word == "transparent" else 1.0
        if not 0.0 <= opacity <= 1.0:
            raise InputError(f"material {word}: an opacity of {opacity:g}: expected 0 to 1")
        if not 0.0 < refraction < np.inf:
            raise InputError(f"material {word}: a refraction of {refraction:g}: expected a positive, finite number")
        object.__setattr__(self, "word", MATERIALS[word])
        object.__setattr__(self, "opacity", float(opacity))
        object.__setattr__(self, "refraction", float(refraction))
        for name, value in zip(FINISH_WORDS, (exponent, diffuse, highlight, sharpness), strict=True):
            may_be_zero = name in ("diffuse", "highlight")
            if value is not None and not (0.0 < value < np.inf or (may_be_zero and value == 0.0)):
                least = "0 or a positive" if may_be_zero else "a positive"
                raise InputError(f"material {word}: {name} {value:g}: expected {least}, finite number")
            object.__setattr__(self, name, None if value is None else float(value))

    @property
    def own_finish(self) -> dict[str, float]:
        """The numbers that stand for those of its word, by their names; highlight and sharpness are both there or
        neither."""
        given = {name: value for name in FINISH_WORDS if (value := getattr(self, name)) is not None}
        if "sharpness" in given and "highlight" not in given:
            given["highlight"] = max(float(log(given["sharpness"]) / log(2.0)), 0.0)
        elif "highlight" in given and "sharpness" not in given:
            given["sharpness"] = float(power(2.0, min(given["highlight"], MOST_HIGHLIGHT)))
        return {name: given[name] for name in FINISH_WORDS if name in given}

    @property
    def is_mirror(self) -> bool:
        """Whether one sees other things in it."""
        return self.word == "mirror"

    @property
    def is_unlit(self) -> bool:
        """Whether it has its colour whatever the light."""
        return self.word == "unlit"

    @property
    def is_clear(self) -> bool:
        """Whether one sees through it."""
        return self.word == "transparent" or self.opacity < 1.0
