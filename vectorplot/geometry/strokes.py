"""Polylines in space."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.arrays import Floats, Ints


@dataclass(frozen=True, eq=False)
class Strokes:
    """Polylines in space.

    points (p,3); offsets (m+1,): stroke i has the points offsets[i] to offsets[i+1]; kind (m,) LineKind values;
    item (m,) index of the item a stroke belongs to.
    Degenerate: no strokes at all is points (0,3), offsets (1,).
    """

    points: Floats
    offsets: Ints
    kind: Ints
    item: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1
