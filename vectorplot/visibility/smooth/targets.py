"""Sheets as targets of sight lines and of curves: a tree over the images of their triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.sheets.surface_sheet import Sheet

if TYPE_CHECKING:
    import shapely


@dataclass(frozen=True, eq=False)
class Targets:
    """The triangles (t,) of sheets that hide, sheet after sheet, as far as they are in front of the eye.

    sheet (t,): the sheet of each; corners (t,3) and places (t,3,3): their corners in space and on the sheet; image
    (t,3,2) and depth (t,3) of the corners; margin (t,): how far the image of the sheet may be off theirs; off (t,): how
    far the sheet is in space.
    """

    sheet: Ints
    corners: Floats
    places: Floats
    image: Floats
    depth: Floats
    margin: Floats
    off: Floats

    def __len__(self) -> int:
        return len(self.sheet)

    def some(self, which: Ints | Bools) -> Targets:
        """Some of the triangles, in their order."""
        return records.some(self, which)

    def range_of_sheet(self, number: int) -> slice:
        """Where the triangles of one sheet are."""
        first, last = np.searchsorted(self.sheet, [number, number + 1]).tolist()
        return slice(first, last)

    def of_sheet(self, number: int) -> Targets:
        """The triangles of one sheet."""
        return self.some(np.arange(len(self))[self.range_of_sheet(number)])

    @cached_property
    def tree(self) -> shapely.STRtree:
        """A tree over the triangles' bounding boxes, enlarged by their margins."""
        import shapely

        low, high = self._boxes
        return shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))

    @cached_property
    def nearest(self) -> Floats:
        """(t,) the smallest depths of the corners."""
        return np.asarray(self.depth.min(axis=1))

    @cached_property
    def box(self) -> Floats:
        """(2,2) the box around the image, enlarged by the margins; empty without triangles."""
        low, high = self._boxes
        return np.stack([low.min(axis=0, initial=np.inf), high.max(axis=0, initial=-np.inf)])

    @cached_property
    def _boxes(self) -> tuple[Floats, Floats]:
        """(t,2) and (t,2) smallest and largest coordinates of the images of triangles, enlarged by their margins."""
        margin = self.margin[:, None]
        return self.image.min(axis=1) - margin, self.image.max(axis=1) + margin

    def may_reach(self, low: Floats, high: Floats) -> Bools:
        """(k,) which boxes (k,2), from low to high, overlap the one around all of them."""
        return np.asarray(((low <= self.box[1]) & (high >= self.box[0])).all(axis=1))

    def near_boxes(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Pairs of a box (k,2), from low to high, and a triangle whose box, enlarged by its margin, overlaps it."""
        import shapely

        close = np.flatnonzero(self.may_reach(low, high))
        low, high = low[close], high[close]
        box, triangle = self.tree.query(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
        return close[box], np.asarray(triangle)


def targets_of(view: View, sheets: Sheets) -> Targets:
    """The sheets as seen in a view; triangles that reach before the near plane are left out, and those of a sheet that
    hides nothing."""
    hiding = [number for number, sheet in enumerate(sheets) if sheet.hides]
    return records.joined([_none(), *(_targets(view, sheets[number], number) for number in hiding)])


def _targets(view: View, sheet: Sheet, number: int) -> Targets:
    """The triangles of the sheet of this number."""
    image, depth = sight_lines.image(view, sheet.vertices), sight_lines.depth(view, sheet.vertices)
    kept = np.flatnonzero((depth[sheet.corners] > view.near).all(axis=1))
    corners, off = sheet.corners[kept], 2.0 * sheet.sags[kept]
    scale = 1.0 if view.eye is None else view.focus / np.maximum(depth[corners].min(axis=1), view.near)
    own = np.full(len(kept), number)
    places = sheet.vertex_places[corners]
    return Targets(own, sheet.vertices[corners], places, image[corners], depth[corners], off * scale, off)


def _none() -> Targets:
    """No triangle at all."""
    none, zero = np.zeros((0, 3, 3)), np.zeros(0)
    return Targets(np.zeros(0, dtype=np.intp), none, none, none[:, :, :2], none[:, :, 0], zero, zero)


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


def distance_to(triangle: Floats, weight: Floats, points: Floats) -> Floats:
    """(k,) how far points (k,2) are, about, from triangles (k,3,2) in which they have these barycentric coordinates."""
    nearest = np.einsum("ij,ijk->ik", inside(weight), triangle)
    away = points - nearest
    return np.sqrt(dot(away, away))
