"""Section views on a sheet: where they cut, and the line in another view that says so.

Source: ISO 128-40 (cuts and sections), ISO 128-24 (cutting planes).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.layers import PENS
from vectorplot.drawing.lettering.interrupted import grown, outside_boxes
from vectorplot.drawing.lettering.labels.label_letters import HALO_MM
from vectorplot.drawing.lettering.text import lettered
from vectorplot.drawing.sheets.page_strokes import page_strokes
from vectorplot.drawing.strokes.dashes import CHAIN_MM, dashed
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.technical.arranged_views import LETTERS

SEEN_AS = (("left", "right"), ("front", "back"), ("top", "bottom"))
"""The main views that a section across x, y and z is like, the usual one first."""

TOLD_IN = (("front", "back", "top", "bottom"), ("top", "bottom", "left", "right"), ("front", "back", "left", "right"))
"""The views in which one sees a plane across x, y and z as a line, the best first."""

BEYOND_MM, WIDE_MM = 8.0, 6.0
"""How far a cutting line goes on beyond the part, and how long its wide ends are."""

ARROW_MM, HEAD_MM, SLOPE = 9.0, 4.0, 0.18
"""The lengths of arrows and their heads, and half of the width of heads as a part of their length."""

LETTERS_MM = 5.0
"""The height of the letters of sections."""

ROOM_MM = 14.0
"""What a cutting line needs on each side of the part, and the letters over a section view."""

CLEAR_MM = 15.0
"""Letters within so much of a cutting line are between its ends, and those so far beside a name are below it."""

THIN, WIDE = Pen(0.25), Pen(0.7)


@dataclass(frozen=True)
class SheetSection:
    """A section of a part across an axis (0, 1, 2), called by a letter, like one of the main views."""

    letter: str
    axis: int
    offset: float
    like: str

    @property
    def condition(self) -> str:
        """The plane of the cut in words, whose side of the eye is taken away."""
        return f"{'xyz'[self.axis]} = {self.offset!r}"

    def told_in(self, names: Sequence[str]) -> str | None:
        """The view that shows where it is, of those that are named."""
        return next((name for name in TOLD_IN[self.axis] if name in names), None)

    def line_room_mm(self, camera: Camera) -> Floats:
        """(2,2) what its line needs around the part in a view."""
        return np.tile(np.where(np.abs(camera.axes[:2, self.axis]) > math.sqrt(0.5), 0.5, 1.0) * ROOM_MM, (2, 1))

    def line_layers(
        self,
        camera: Camera,
        sight: Camera,
        bounds: Floats,
        middle: tuple[float, float],
        factor: float,
        room: Floats,
        written: Floats,
    ) -> tuple[Layer, ...]:
        """Layers with its line, arrows and letters in a view that sees its plane edge-on.

        sight: the camera of the section; bounds (2,3): of the part, whose middle is at a place on the page; factor: mm
        on paper for a unit of the world; room (2,2): what is already beside the part, in mm; written (b,2,2): the boxes
        of letters in the view, outside of which its ends are, and before which its line is interrupted.
        """
        across = camera.axes[:2]
        normal = across[:, self.axis]
        along = np.array([abs(normal[1]), abs(normal[0])])
        way = matmul(across, -sight.direction)
        centre, half = bounds.mean(axis=0), 0.5 * np.ptp(bounds, axis=0)
        place = np.array(middle) + factor * (self.offset - centre[self.axis]) * normal
        reaches = factor * float(matmul(along, matmul(np.abs(across), half))) + BEYOND_MM + matmul(room, along)
        beside = matmul(written - place, np.where(along > 0.5, 0.0, 1.0))
        near = (beside.min(axis=1) < CLEAR_MM) & (beside.max(axis=1) > -CLEAR_MM)
        far = (matmul(written - place, along))[near]
        reaches = np.maximum(reaches, [_beyond(-far, reaches[0]), _beyond(far, reaches[1])])
        sides = list(zip((-1.0, 1.0), reaches.tolist(), strict=True))
        ends = [place + sign * reach * along for sign, reach in sides]
        inner = [place + sign * (reach - WIDE_MM) * along for sign, reach in sides]
        left = np.array([-way[1], way[0]])
        heads, letters = [], []
        for end in ends:
            back = end - HEAD_MM * way
            wing = HEAD_MM * SLOPE * left
            heads.append(np.array([end - ARROW_MM * way, end, back + wing, back - wing, end]))
            at = end - (ARROW_MM + 0.8 * LETTERS_MM) * way
            letters += _letters(self.letter, at)
        line = dashed(page_strokes([np.array(inner)]), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2])
        boxes = np.stack([written[:, [0, 1, 1, 0], 0], written[:, [0, 0, 1, 1], 1]], axis=-1)
        return (
            Layer("cutting line", THIN, (outside_boxes(line, grown(boxes, HALO_MM), np.eye(4)),)),
            Layer("cutting ends", WIDE, (page_strokes([np.array(pair) for pair in zip(inner, ends, strict=True)]),)),
            Layer("label", PENS["label"], (page_strokes([*heads, *letters]),)),
        )

    def name_layer(self, top: tuple[float, float], written: Floats) -> Layer:
        """A layer with its name, above the middle of the top of its view, and of the boxes (b,2,2) of letters there."""
        under = written[(np.abs(written[:, :, 0] - top[0]) < CLEAR_MM).any(axis=1), 1, 1]
        text = _letters(f"{self.letter}-{self.letter}", np.array([top[0], under.max(initial=top[1]) + 0.4 * ROOM_MM]))
        return Layer("label", PENS["label"], (page_strokes(text),))


def _beyond(far: Floats, reach: float) -> float:
    """How far a cutting line goes that would go so far: beyond boxes from and to (b,2) along it that its end would be
    in."""
    ends = far.max(axis=1)
    # Its arrows and letters are no higher than the room beyond the part.
    return float(ends[ends > reach - WIDE_MM - BEYOND_MM].max(initial=reach - WIDE_MM - HALO_MM)) + WIDE_MM + HALO_MM


def sections_of(asked: str | Iterable[str], names: Sequence[str], bounds: Floats) -> tuple[SheetSection, ...]:
    """The sections that texts such as y=12 ask for, lettered in their order, each like the main view of its direction.

    Errors: InputError for texts that are none, planes beside the part, and more sections than letters.
    """
    texts = [asked] if isinstance(asked, str) else list(asked)
    if len(texts) > len(LETTERS):
        raise InputError(f"{len(texts)} sections: expected at most {len(LETTERS)}")
    found = []
    for letter, text in zip(LETTERS, texts, strict=False):
        sides = re.fullmatch(r"\s*([xyz])\s*=\s*(\S+)\s*", text)
        try:
            offset = float(sides[2]) if sides else math.nan
        except ValueError:
            offset = math.nan
        if sides is None or not math.isfinite(offset):
            raise InputError(f"section {text!r}: expected x, y or z and a number, such as y=12")
        axis = "xyz".index(sides[1])
        low, high = bounds[:, axis].tolist()
        if not low < offset < high:
            raise InputError(f"section {text!r}: beside the part, where {sides[1]} is {low:g} to {high:g}")
        usual = SEEN_AS[axis]
        found.append(SheetSection(letter, axis, offset, next((name for name in usual if name in names), usual[0])))
    return tuple(found)


def _letters(text: str, middle: Floats) -> list[Floats]:
    x, y = middle.tolist()
    lettering = lettered(text, (x, y), size_mm=LETTERS_MM, align="centre", level="middle")
    return [lettering.strokes[k] for k in range(len(lettering.strokes))]
