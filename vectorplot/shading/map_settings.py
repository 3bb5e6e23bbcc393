"""How the shadow maps of a picture are made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from vectorplot.errors import InputError
from vectorplot.words import check_word


@dataclass(frozen=True)
class MapSettings:
    """How shadow maps are made.

    size: texels along the side of a map, were it a square; bits: of a depth: 8, 16 or 32; casting: which faces the map
    is made of, all or those that turn away from the light; wanted_focus: the part of the texels that what is in focus
    should get of a tapered map; tapered: how those are made that go by what is seen, trapezoid or perspective.
    """

    size: int = 1024
    bits: int = 32
    casting: Literal["all", "away"] = "all"
    wanted_focus: float | None = None
    tapered: Literal["trapezoid", "perspective"] = "trapezoid"

    def __post_init__(self) -> None:
        check_word("shadow casters", self.casting, ("all", "away"))
        check_word("tapered maps", self.tapered, ("trapezoid", "perspective"))
        if self.wanted_focus is not None and not 0.0 < self.wanted_focus < 1.0:
            raise InputError(f"a shadow focus of {self.wanted_focus:g}: expected a part of the map, between 0 and 1")
