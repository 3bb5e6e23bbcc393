"""Named sheets of paper."""

from __future__ import annotations

import math
import re

from vectorplot.errors import InputError

SHEETS = {
    "a0": (841.0, 1189.0),
    "a1": (594.0, 841.0),
    "a2": (420.0, 594.0),
    "a3": (297.0, 420.0),
    "a4": (210.0, 297.0),
    "a5": (148.0, 210.0),
    "a6": (105.0, 148.0),
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "tabloid": (279.4, 431.8),
    "ledger": (431.8, 279.4),
    "executive": (184.15, 266.7),
}
"""Width and height in mm of the sheets that have a name."""


def sheet_size(text: str) -> tuple[float, float]:
    """Width and height in mm of a named sheet or of WIDTHxHEIGHT.

    Parameters
    ----------
    text : str
        a0 to a6, letter, legal, tabloid, ledger, executive, in capitals or not, or two numbers such as 100x80 or
        100x80mm.

    Returns
    -------
    (float, float)
        In mm, both finite and positive.

    Raises
    ------
    InputError
        For anything else.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.sheet_size("A4"), scene.sheet_size("100x80")
    ((210.0, 297.0), (100.0, 80.0))
    """
    word = text.strip().lower()
    if word in SHEETS:
        return SHEETS[word]
    sides = re.fullmatch(r"([^x]+)x([^x]+?)(?:mm)?", word)
    try:
        width, height = (float(side) for side in sides.groups()) if sides else (math.nan, math.nan)
    except ValueError:
        width = height = math.nan
    if not (0.0 < width < math.inf and 0.0 < height < math.inf):
        raise InputError(f"page {text!r}: expected WIDTHxHEIGHT in mm or one of {', '.join(SHEETS)}")
    return width, height
