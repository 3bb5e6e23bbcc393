"""What frames look like: a word for each verb and how it is told to work."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Mode:
    """A verb, and what it is told beside all else.

    Parameters
    ----------
    verb : {"draw", "paint", "render"}
        The verb that makes frames.
    options : mapping
        Keywords of the verb.

    Examples
    --------
    >>> from vectorplot.animation import MODES
    >>> MODES["shading"]
    Mode(verb='paint', options={'shadows': 'none'})
    """

    verb: str
    options: Mapping[str, Any] = field(default_factory=dict)


MODES: dict[str, Mode] = {
    "wire": Mode("draw", {"style": "depth-cue"}),
    "lines": Mode("draw"),
    "shading": Mode("paint", {"shadows": "none"}),
    "shadows": Mode("paint"),
    "erasing": Mode("paint", {"fills": "erasing"}),
    "pixels": Mode("render"),
}
"""Modes by their words. Source: Glaeser, appendix A.3, keys w, h, s, c and j; pixels are those of a depth buffer."""
