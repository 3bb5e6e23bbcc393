"""Colours in the words of PGF/TikZ."""

from __future__ import annotations


def colour_of(packed: int) -> str:
    """A colour from its red, green and blue in one number."""
    return f"{{rgb,255:red,{packed >> 16};green,{packed >> 8 & 255};blue,{packed & 255}}}"
