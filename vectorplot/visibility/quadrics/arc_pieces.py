"""Arcs cut into pieces of less than a half turn, as rational Bézier curves of degree two."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.elementary import arctan, tan
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.visibility.polyhedra.grid import Floats32
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.visibility.quadrics.conic_arcs import Arcs

IN_A_TURN = 8
"""Pieces of a whole turn: fewer have larger boxes, which more things overlap; more cost more."""

LARGE, MOST = 2.0, 512
"""An arc so many times larger in the picture than what hides is cut finer, into so many pieces at most."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Parts of arcs: control (3,4,n) homogeneous control points; arc (n,); middle, half (n,):
    from middle - half to middle + half in the arc's parameter; box (4,n) left, right, bottom, top in the image; nearest
    and farthest (n,) depth."""

    control: Floats = field(metadata=IN_COLUMNS)
    arc: Ints
    middle: Floats
    half: Floats
    box: Floats32 = field(metadata=IN_COLUMNS)
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.arc)

    def some(self, which: Ints | Bools) -> Pieces:
        """Some of the pieces."""
        return records.some(self, which)

    def parameters(self, arcs: Arcs, which: Ints, t: Floats) -> Floats:
        """(k,) the arcs' parameters at t, 0 to 1 along pieces which (k,)."""
        middle, half = self.middle[which], self.half[which]
        s = 2.0 * t - 1.0
        # The tangent of the half angle goes evenly along the weighted curve.
        straight = arcs.straight[self.arc[which]]
        turned = 2.0 * arctan(tan(np.where(straight, 0.0, 0.5 * half)) * s)
        turned = np.where(straight, half * s, turned)
        return np.where(t <= 0.0, middle - half, np.where(t >= 1.0, middle + half, middle + turned))


def cut_arcs(sight: EyeCoordinates, arcs: Arcs, typical: float) -> Pieces:
    """The arcs in pieces; typical: the size of what hides, in the image."""
    reach = np.sqrt(arcs.first * arcs.first + arcs.second * arcs.second)
    size = reach.max(axis=1, initial=0.0)
    if sight.central:
        size = size / np.maximum(np.abs(arcs.middle[:, 2]) - reach[:, 2], 0.1 * np.abs(arcs.middle[:, 2]) + sight.near)
    span = arcs.high - arcs.low
    wide = size * np.where(arcs.straight, span, 1.0) / (LARGE * typical)
    turns = np.where(arcs.straight, 1.0, span / (2.0 * np.pi))
    in_all = np.where(arcs.straight, np.ceil(wide), np.ceil(turns * np.maximum(IN_A_TURN, 8.0 * wide)))
    # No piece may turn by more than a third of a half turn: its weights stay above a half.
    fewest = np.where(arcs.straight, 1.0, np.ceil(span / (np.pi / 3.0)))
    count = np.maximum(np.clip(in_all, 1.0, MOST), fewest).astype(np.intp)
    arc, step = ragged.owner(count), ragged.place(count)
    half = 0.5 * span[arc] / count[arc]
    middle = arcs.low[arc] + (2 * step + 1) * half
    control = _control(arcs, arc, middle, half)
    depth = control[:, 2] / control[:, 3]
    nearest, farthest = depth.min(axis=0), depth.max(axis=0)
    image = control[:, :2] / control[:, 3:4]
    if sight.central:
        image = image / np.maximum(depth, sight.near)[:, None]
        image[:, :, nearest < sight.near] = np.nan
    low, high = image.min(axis=0), image.max(axis=0)
    return Pieces(control, arc, middle, half, packed_box(low, high), nearest, farthest)


def _control(arcs: Arcs, arc: Ints, middle: Floats, half: Floats) -> Floats:
    """(3,4,n) control points: both ends, and where the tangents meet, with its weight."""
    straight = arcs.straight[arc]
    weight = np.where(straight, 1.0, np.cos(half))
    centre, first, second = arcs.middle[arc].T, arcs.first[arc].T, arcs.second[arc].T
    divisor = arcs.weight[arc]
    control = np.empty((3, 4, len(arc)))
    one = np.ones(len(arc))
    for k, (t, w) in enumerate(((middle - half, one), (middle, weight), (middle + half, one))):
        along = np.where(straight, t, np.cos(t)), np.where(straight, 0.0, np.sin(t))
        control[k, :3] = centre * w + first * along[0] + second * along[1]
        control[k, 3] = w + divisor * along[0]
    return control


def packed_box(low: Floats, high: Floats) -> Floats32:
    """(4,n) boxes from lower left to upper right corners (2,n), rounded outwards; everything where these are not
    numbers."""
    below, above = np.float32(-np.inf), np.float32(np.inf)
    left, bottom = np.nextafter(np.where(np.isnan(low), -np.inf, low).astype(np.float32), below)
    right, top = np.nextafter(np.where(np.isnan(high), np.inf, high).astype(np.float32), above)
    return np.stack([left, right, bottom, top])
