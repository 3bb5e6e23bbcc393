"""Sheets as targets of sight lines and of curves: a tree over the images of their triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.components import greatest_component, least_component
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.smooth.box_strips import BoxStrips
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets

STRIP = 16
"""Triangles, one beside the other, of which the tree has one box."""


@dataclass(frozen=True, eq=False)
class Vertices:
    """The vertices (n,) of sheets that hide: points (n,3), places (n,3) on their sheets, image (n,2), depth (n,)."""

    points: Floats
    places: Floats
    image: Floats
    depth: Floats


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles (t,): the sheet of each; vertices (t,3); margin (t,): how far the image of the sheet may be off theirs;
    off (t,): how far the sheet is in space."""

    sheet: Ints
    vertices: Ints
    margin: Floats
    off: Floats


@dataclass(frozen=True, eq=False)
class Targets:
    """The triangles (t,) of sheets that hide, sheet after sheet, as far as they are in front of the eye, and the
    vertices that they have in common."""

    triangles: Triangles
    vertices: Vertices

    def __len__(self) -> int:
        return len(self.sheet)

    @property
    def sheet(self) -> Ints:
        """(t,) the sheet of each."""
        return self.triangles.sheet

    def some(self, which: Ints | Bools) -> Targets:
        """Some of the triangles, in their order."""
        return Targets(records.some(self.triangles, which), self.vertices)

    def range_of_sheet(self, number: int) -> slice:
        """Where the triangles of one sheet are."""
        first, last = np.searchsorted(self.sheet, [number, number + 1]).tolist()
        return slice(first, last)

    def of_sheet(self, number: int) -> Targets:
        """The triangles of one sheet."""
        return self.some(np.arange(len(self))[self.range_of_sheet(number)])

    def corners(self, which: Ints | slice) -> Floats:
        """(k,3,3) the corners in space of some of the triangles."""
        return self._of_corners(self.vertices.points, which)

    def places(self, which: Ints | slice) -> Floats:
        """(k,3,3) the places of the corners on their sheets."""
        return self._of_corners(self.vertices.places, which)

    def image(self, which: Ints | slice) -> Floats:
        """(k,3,2) the images of the corners."""
        return self._of_corners(self.vertices.image, which)

    def depth(self, which: Ints | slice) -> Floats:
        """(k,3) the depths of the corners."""
        return self._of_corners(self.vertices.depth, which)

    def _of_corners(self, values: Floats, which: Ints | slice) -> Floats:
        # take is several times as fast as an index between brackets.
        return values.take(self.triangles.vertices[which], axis=0)

    @cached_property
    def box(self) -> Floats:
        """(2,2) the box around the image, enlarged by the margins; empty without triangles."""
        low, high = self._boxes.low, self._boxes.high
        return np.stack([low.min(axis=1, initial=np.inf), high.max(axis=1, initial=-np.inf)])

    @cached_property
    def _boxes(self) -> BoxStrips:
        """(t,) boxes around the images of triangles, enlarged by their margins."""
        x, y = self.vertices.image.T
        margin = self.triangles.margin
        corners = [np.stack([x.take(column), y.take(column)]) for column in self.triangles.vertices.T]
        low, high = np.minimum(corners[0], corners[1]), np.maximum(corners[0], corners[1])
        return BoxStrips(np.minimum(low, corners[2]) - margin, np.maximum(high, corners[2]) + margin, STRIP)

    def may_reach(self, low: Floats, high: Floats) -> Bools:
        """(k,) which boxes (k,2), from low to high, overlap the one around all of them."""
        return np.asarray(((low <= self.box[1]) & (high >= self.box[0])).all(axis=1))

    def near_boxes(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Pairs of a box (k,2), from low to high, and a triangle whose box, enlarged by its margin, overlaps it."""
        close = np.flatnonzero(self.may_reach(low, high))
        if not len(close):
            return close, close
        box, triangle = self._boxes.overlapping(low[close].T, high[close].T)
        return close[box], triangle


def targets_of(view: View, sheets: Sheets) -> Targets:
    """The sheets as seen in a view; triangles that reach before the near plane are left out, and those of a sheet that
    hides nothing."""
    hiding = [number for number, sheet in enumerate(sheets) if sheet.hides]
    own = [sheets[number] for number in hiding]
    none, nothing = np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp)
    points = np.concatenate([none, *(sheet.vertices for sheet in own)])
    places = np.concatenate([none, *(sheet.vertex_places for sheet in own)])
    image, depth = sight_lines.image(view, points), sight_lines.depth(view, points)
    first = ragged.starts([len(sheet.vertices) for sheet in own])
    corners = np.concatenate([nothing, *(sheet.corners + k for sheet, k in zip(own, first.tolist(), strict=True))])
    number = np.repeat(np.array(hiding, dtype=np.intp), [len(sheet.corners) for sheet in own])
    off = 2.0 * np.concatenate([none[:, 0], *(sheet.sags for sheet in own)])
    nearest = np.minimum.reduce([depth.take(column) for column in corners.T])
    kept = nearest > view.near
    if not kept.all():
        corners, number, off, nearest = corners[kept], number[kept], off[kept], nearest[kept]
    scale = 1.0 if view.eye is None else view.focus / np.maximum(nearest, view.near)
    return Targets(Triangles(number, corners, off * scale, off), Vertices(points, places, image, depth))


def weights(triangle: Floats, points: Floats) -> Floats:
    """(k,3) barycentric coordinates of points (k,2) in triangles (k,3,2); not finite for those seen edge-on."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    ab, ac, ap = b - a, c - a, points - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        two = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
        three = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
        return np.stack([1.0 - two - three, two, three], axis=1)


def inside(weight: Floats) -> Floats:
    """(k,3) the nearest barycentric coordinates within the triangle, about."""
    # Triangles seen edge-on have no such coordinates: their middle is as good.
    clipped = np.clip(np.where(np.isfinite(weight), weight, 1.0 / 3.0), 0.0, 1.0)
    return np.asarray(clipped / clipped.sum(axis=1, keepdims=True))


def distance_to(triangle: Floats, points: Floats) -> Floats:
    """(k,) how far points (k,2) are from triangles (k,3,2), those seen edge-on as well; 0 in their insides."""
    corners = triangle.swapaxes(0, 1)
    away, turns = [], []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side, to = b - a, points - a
        along = np.clip(dot(side, to) / np.maximum(dot(side, side), LEAST_DIVISOR), 0.0, 1.0)
        off = to - along[:, None] * side
        away.append(dot(off, off))
        turns.append(side[:, 0] * to[:, 1] - side[:, 1] * to[:, 0])
    around = np.stack(turns, axis=1)
    within = (least_component(around) > 0.0) | (greatest_component(around) < 0.0)
    return np.where(within, 0.0, np.sqrt(least_component(np.stack(away, axis=1))))
