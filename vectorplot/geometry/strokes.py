"""Polylines in space."""

from __future__ import annotations

from dataclasses import dataclass, field

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT


@dataclass(frozen=True, eq=False)
class Strokes:
    """Polylines in space.

    points (p,3); offsets (m+1,): stroke i has the points offsets[i] to offsets[i+1]; kind (m,) LineKind values;
    item (m,) index of the item a stroke belongs to.
    Degenerate: no strokes at all is points (0,3), offsets (1,).
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    kind: Ints = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1
