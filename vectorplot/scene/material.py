"""What the surface of an item is like."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.errors import InputError
from vectorplot.words import MATERIALS, unknown_material

OPACITY_OF_TRANSPARENT = 0.5
"""The opacity of what is transparent where nothing else is said."""


@dataclass(frozen=True, init=False)
class Material:
    """How a surface takes light.

    Parameters
    ----------
    word : str
        normal, metallic, shiny (or reflecting), mat (or matte), wood, plastic, transparent or mirror.
    opacity : float, optional
        0 (clear) to 1; that of what is transparent a half where none is given, else 1.
    refraction : float
        The constant sin(alpha)/sin(beta) of Snell's law, positive.

    Raises
    ------
    InputError
        For other words and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Material("transparent")
    Material(word='transparent', opacity=0.5, refraction=1.0)
    >>> vp.Material("reflecting").word
    'shiny'
    """

    word: str
    opacity: float
    refraction: float

    def __init__(self, word: str = "normal", opacity: float | None = None, refraction: float = 1.0) -> None:
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

    @property
    def is_mirror(self) -> bool:
        """Whether one sees other things in it."""
        return self.word == "mirror"

    @property
    def is_clear(self) -> bool:
        """Whether one sees through it."""
        return self.word == "transparent" or self.opacity < 1.0
