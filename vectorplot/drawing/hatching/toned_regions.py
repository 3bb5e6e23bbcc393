"""What is seen of filled polygons, and how dark it is from place to place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.fills_without_overlaps import visible_regions
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.tolerances.of_the_page import GRID_MM

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Shares of red, green and blue in how bright a colour looks. Source: ITU-R BT.709."""


@dataclass(frozen=True, eq=False)
class TonedRegions:
    """Regions (n,) of the page without common inner points, each a part of one polygon of fills, by its number source.

    points (2,c), offsets (k+1,): rings, which bound the regions of (k,) from outside or as holes; darkness (n,3): a, b
    and c of a + b x + c y, and lowest, highest (n,) what it is at least and at most: equal on plain regions.
    """

    fills: Fills
    source: Ints
    points: Floats
    offsets: Ints
    of: Ints
    darkness: Floats
    lowest: Floats
    highest: Floats

    def __len__(self) -> int:
        return len(self.source)

    @property
    def plain(self) -> Bools:
        """(n,) the regions that are equally dark everywhere."""
        return np.asarray(self.lowest == self.highest)

    @property
    def item(self) -> Ints:
        """(n,) the item each is a part of."""
        return self.fills.item[self.source]

    @property
    def areas(self) -> Floats:
        """(n,) the areas of the regions."""
        x, y = self.points
        after = ragged.following(self.offsets)
        around = ragged.owner(np.diff(self.offsets))
        area = 0.5 * np.abs(np.bincount(around, x * y[after] - x[after] * y, minlength=len(self.of)))
        # The first ring of each region is its outer one.
        outer = np.diff(self.of, prepend=-1) != 0
        return np.asarray(np.bincount(self.of, np.where(outer, area, -area), minlength=len(self)), dtype=np.float64)

    def some(self, which: Bools) -> TonedRegions:
        """Those regions, with their rings."""
        corners, offsets = ragged.take(self.offsets, which[self.of])
        return TonedRegions(
            self.fills,
            self.source[which],
            self.points[:, corners],
            offsets,
            (np.cumsum(which) - 1)[self.of[which[self.of]]],
            self.darkness[which],
            self.lowest[which],
            self.highest[which],
        )

    def darkness_at(self, points: Floats, region: Ints) -> Floats:
        """(m,) how dark regions (m,) are at points (m,2) of the page, 0 to 1."""
        a, b, c = self.darkness[region].T
        found = a + b * points[:, 0] + c * points[:, 1]
        return np.asarray(np.clip(found, self.lowest[region], self.highest[region]))


def toned_regions(fills: Fills) -> TonedRegions:
    """The visible regions of polygons painted one over the other, as dark as their colours: black is 1, white 0.

    What one can see through is as much lighter as it is clear, and adds to what lies behind it. Lines, and the paper,
    are no regions. Errors as of visible_fills.
    """
    import shapely

    fills = _in_triangles(
        fills.some(np.flatnonzero((np.diff(fills.offsets) > 2) & (fills.kind != FillKind.BACKGROUND)))
    )
    parts, source = visible_regions(fills)
    rings, of = shapely.get_rings(parts, return_index=True)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    # A ring of shapely repeats its first point at its end.
    kept = np.append(ring[1:] == ring[:-1], False)[: len(ring)]
    offsets = np.searchsorted(ring[kept], np.arange(len(rings) + 1))
    darkness, lowest, highest = _darkness(fills)
    return TonedRegions(
        fills,
        source,
        np.ascontiguousarray(xy[kept].T),
        offsets,
        of,
        darkness[source],
        lowest[source],
        highest[source],
    )


def _in_triangles(fills: Fills) -> Fills:
    """The same picture, with the triangles of their fans in place of shaded polygons."""
    first = fills.offsets[:-1]
    differs = (fills.colours != np.repeat(fills.colours[first], np.diff(fills.offsets), axis=0)).any(axis=1)
    shaded = np.zeros(len(fills), dtype=np.bool_)
    shaded[ragged.owner(np.diff(fills.offsets))[differs]] = True
    plain, fan = fills.some(np.flatnonzero(~shaded)), fills.some(np.flatnonzero(shaded))
    corners, of = ragged.fans(fan.offsets)
    at = corners.ravel()
    triangles = Fills(
        fan.points[at],
        3 * np.arange(len(of) + 1),
        fan.colours[at],
        fan.opacity[of],
        fan.item[of],
        fan.points3d[at],
        fan.kind[of],
    )
    number = np.concatenate([np.flatnonzero(~shaded), np.flatnonzero(shaded)[of]])
    return Fills.joined(plain, triangles).some(np.argsort(number, kind="stable"))


def _darkness(fills: Fills) -> tuple[Floats, Floats, Floats]:
    """(m,3) the planes of darkness over plain polygons and shaded triangles, and (m,) the least and the largest one.

    Degenerate: triangles without area are as dark as the mean of their corners.
    """
    first = fills.offsets[:-1]
    dark = (1.0 - matmul(fills.colours, LUMINANCE) / 255.0) * np.repeat(fills.opacity, np.diff(fills.offsets))
    dark = np.clip(dark, 0.0, 1.0)
    if not len(fills):
        return np.zeros((0, 3)), np.zeros(0), np.zeros(0)
    lowest, highest = np.minimum.reduceat(dark, first), np.maximum.reduceat(dark, first)
    planes = np.zeros((len(fills), 3))
    planes[:, 0] = dark[first]
    at = np.flatnonzero(highest > lowest)
    start = first[at]
    one, other = (fills.points[start + k] - fills.points[start] for k in (1, 2))
    rise, rise_other = dark[start + 1] - dark[start], dark[start + 2] - dark[start]
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    wide = np.abs(area) > GRID_MM * (np.abs(one) + np.abs(other)).sum(axis=1)
    at, start, one, other = at[wide], start[wide], one[wide], other[wide]
    area, rise, rise_other = area[wide], rise[wide], rise_other[wide]
    planes[at, 1] = (rise * other[:, 1] - rise_other * one[:, 1]) / area
    planes[at, 2] = (rise_other * one[:, 0] - rise * other[:, 0]) / area
    planes[at, 0] -= (planes[at, 1:] * fills.points[start]).sum(axis=1)
    flat = np.flatnonzero(highest > lowest)[~wide]
    mean = (dark[first[flat]] + dark[first[flat] + 1] + dark[first[flat] + 2]) / 3.0
    planes[flat, 0] = lowest[flat] = highest[flat] = mean
    return planes, lowest, highest
