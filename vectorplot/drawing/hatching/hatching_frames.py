"""What hatching lines run along: directions on the page, or in the planes of faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills_without_overlaps import in_space, planes_of_fills
from vectorplot.drawing.hatching.toned_regions import TonedRegions
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances.of_angles import FLAT_SLOPE, SAME_PLANE_SINE
from vectorplot.tolerances.of_extent import SAME_PLANE_OF_EXTENT


@dataclass(frozen=True, eq=False)
class PageFrame:
    """Lines at an angle on the page, in mm."""

    angle: float

    def coordinates(self, regions: TonedRegions) -> tuple[Floats, Floats]:
        """Where the corners (c,) of regions are along the lines and across them."""
        along, across = self._axes()
        return matmul(along, regions.points), matmul(across, regions.points)

    def sheet(self, regions: TonedRegions) -> Ints:
        """(n,) what regions share where their lines run on from one to the other."""
        return np.zeros(len(regions), dtype=np.intp)

    def points(
        self, regions: TonedRegions, region: Ints, u: Floats, v: Floats, page_from_world: Floats
    ) -> tuple[Floats, Floats]:
        """(m,2) points of regions (m,) on the page, and (m,3) in space."""
        flat = self.on_page(u, v)
        return flat, in_space(regions.fills, flat, regions.source[region], page_from_world)

    def on_page(self, u: Floats, v: Floats) -> Floats:
        """(m,2) points of the page by where they are along the lines and across them."""
        along, across = self._axes()
        return np.asarray(u[:, None] * along + v[:, None] * across)

    def _axes(self) -> tuple[Floats, Floats]:
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([c, s]), np.array([-s, c])


@dataclass(frozen=True, eq=False)
class PlaneFrame:
    """Lines in the planes of regions (n,): origin, along and across (n,3) in space, as long as a mm is on the page at
    the middle of the regions of a plane; plane (n,) their numbers."""

    origin: Floats
    along: Floats
    across: Floats
    plane: Ints
    corners: Floats

    def coordinates(self, regions: TonedRegions) -> tuple[Floats, Floats]:
        """Where the corners (c,) of regions are along the lines and across them."""
        of = np.repeat(regions.of, np.diff(regions.offsets))
        arm = self.corners - self.origin[of]
        along, across = self.along[of], self.across[of]
        return dot(arm, along) / dot(along, along), dot(arm, across) / dot(across, across)

    def sheet(self, regions: TonedRegions) -> Ints:
        """(n,) what regions share where their lines run on from one to the other."""
        return self.plane

    def points(
        self, regions: TonedRegions, region: Ints, u: Floats, v: Floats, page_from_world: Floats
    ) -> tuple[Floats, Floats]:
        """(m,2) points of regions (m,) on the page, and (m,3) in space."""
        found = self.origin[region] + u[:, None] * self.along[region] + v[:, None] * self.across[region]
        return _on_page(found, page_from_world), found


def plane_frame(regions: TonedRegions, angle: float, page_from_world: Floats) -> PlaneFrame:
    """Lines at an angle to what is level in the planes of regions, evenly spaced on the page at the middle of each.

    In level planes the angle is from the x axis. Planes of one item with one normal are one where they coincide but for
    SAME_PLANE_OF_EXTENT.
    Degenerate: a plane seen edge-on has no regions.
    """
    of = np.repeat(regions.of, np.diff(regions.offsets))
    corners = in_space(regions.fills, regions.points.T, regions.source[of], page_from_world)
    normal, place = (column[regions.source] for column in planes_of_fills(regions.fills))
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = (low + high) / 2.0
    plane = _plane_numbers(regions.item, normal, dot(normal, place - middle), float(norm(high - low)))
    _, first = np.unique(plane, return_index=True)
    normal = normal[first][plane]
    level = cross(np.array([0.0, 0.0, 1.0]), normal)
    flat = np.linalg.norm(level, axis=1) <= FLAT_SLOPE
    level[flat] = (1.0, 0.0, 0.0)
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    up = cross(normal, level)
    along = np.cos(angle) * level + np.sin(angle) * up
    across = np.cos(angle) * up - np.sin(angle) * level
    count = int(plane.max(initial=-1)) + 1
    weight = np.bincount(plane[of], minlength=count)
    centre = np.stack([np.bincount(plane[of], corners[:, k], count) / weight for k in range(3)], axis=1)[plane]
    image, image_across = (_slope(centre, vector, page_from_world) for vector in (along, across))
    mm = np.linalg.norm(image, axis=1)
    apart = np.abs(cross(image, image_across)) / mm
    # From a point that the planes' own numbers do not change.
    origin = middle - dot(normal, middle - place[first][plane])[:, None] * normal
    return PlaneFrame(origin, along / mm[:, None], across / apart[:, None], plane, corners)


def _plane_numbers(item: Ints, normal: Floats, height: Floats, extent: float) -> Ints:
    """(n,) numbers of planes, the same ones for those of an item that coincide."""
    rounded = [np.rint(normal / SAME_PLANE_SINE), np.rint(height / (SAME_PLANE_OF_EXTENT * extent))[:, None]]
    rows = np.concatenate([item[:, None], *rounded], axis=1) + 0.0
    return np.unique(rows, axis=0, return_inverse=True)[1].ravel()


def _on_page(points: Floats, page_from_world: Floats) -> Floats:
    rows = matmul(points, page_from_world[:, :3].T) + page_from_world[:, 3]
    return np.asarray(rows[:, :2] / rows[:, 3:])


def _slope(points: Floats, direction: Floats, page_from_world: Floats) -> Floats:
    """(n,2) by how many mm points of the page move where points (n,3) move along directions (n,3)."""
    rows = matmul(points, page_from_world[:, :3].T) + page_from_world[:, 3]
    step = matmul(direction, page_from_world[:, :3].T)
    depth = rows[:, 3:]
    return np.asarray(step[:, :2] / depth - rows[:, :2] * step[:, 3:] / (depth * depth))
