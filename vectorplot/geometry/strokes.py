"""Polylines in space."""

from __future__ import annotations

from dataclasses import dataclass, field

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT


@dataclass(frozen=True, eq=False)
class Strokes:
    """Polylines in space.

    Parameters
    ----------
    points : (p, 3) array of float
        In world units.
    offsets : (m+1,) array of int
        Stroke i has the points offsets[i] to offsets[i+1].
    kind : (m,) array of int
        LineKind values.
    item : (m,) array of int
        Index of the item a stroke belongs to.

    Notes
    -----
    Degenerate: no strokes at all is points (0,3), offsets (1,).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> kind = np.array([vp.LineKind.CURVE])
    >>> strokes = vp.Strokes(np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]), np.array([0, 2]), kind, np.array([0]))
    >>> len(strokes)
    1
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    kind: Ints = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1
