"""Hatching and stippling by tone: filled polygons as strokes or dots that lie as densely as they are dark."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fill_visibility import in_space, planes_of_fills, visible_regions
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices, workers
from vectorplot.geometry.ragged import ShortKeys, radix_order
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.scene.hatching import DOT_MM, Hatching, Stippling
from vectorplot.tolerances import (
    COINCIDENT_MM,
    FLAT_SLOPE,
    GRID_MM,
    HATCH_GAP_MM,
    SAME_PLANE_OF_EXTENT,
    SAME_PLANE_SINE,
)
from vectorplot.words import LineKind

# How dense strokes are for a darkness: so that the ink covers the share of the paper that is asked.

CROSSED_FROM = 0.5
"""From this darkness on strokes cross."""

LEAST_COVER = 0.02
"""What needs less ink than this share of the paper stays white: a stroke alone would be a line, and no shade."""

LEAST_MM = 0.5
"""Shorter strokes are specks."""

LEVELS = 4
"""Lines begin at two to this power different darknesses: more of them look restless, fewer show as steps."""


def even_spacings(hatching: Hatching, darkness: Floats) -> tuple[Floats, Floats]:
    """(n,) the distances of the strokes of the first and of the second family in places of one darkness (n,), 0 to 1;
    infinite where there are none.

    Strokes of one width w at a distance s cover w/s of the paper, crossing ones 1 - (1 - w/s)^2.
    """
    cover = darkness * hatching.darkest
    cover = np.where(cover >= LEAST_COVER, cover, 0.0)
    crossed = (darkness >= CROSSED_FROM) & hatching.cross
    share = np.where(crossed, 1.0 - np.sqrt(1.0 - np.minimum(cover, 1.0)), cover)
    with np.errstate(divide="ignore"):
        first = hatching.width_mm / share
    return first, np.where(crossed, first, np.inf)


def covers(hatching: Hatching, darkness: Floats) -> tuple[Floats, Floats]:
    """(n,) the shares of the paper that the strokes of the first and of the second family cover where it is as dark as
    (n,) and darkness varies: the second one begins where the first one is as dense as can be."""
    cover = darkness * hatching.darkest
    cover = np.where(cover >= LEAST_COVER, cover, 0.0)
    first = np.minimum(cover, hatching.width_mm / hatching.spacing_mm)
    with np.errstate(invalid="ignore", divide="ignore"):
        second = np.where(cover > first, 1.0 - (1.0 - cover) / (1.0 - first), 0.0)
    return first, second


def thresholds(hatching: Hatching, family: int, line: Ints) -> Floats:
    """(k,) the darkness above which a line of a family, 0 or 1, is drawn where darkness varies: covers turned round."""
    rank = ranks(line, 1 << LEVELS)
    share = hatching.width_mm / hatching.spacing_mm
    cover = rank * share if family == 0 else 1.0 - (1.0 - share) * (1.0 - rank * share)
    return np.asarray(np.maximum(cover, LEAST_COVER) / hatching.darkest)


def ranks(line: Ints, count: int) -> Floats:
    """(k,) the order in which lines, by their numbers, come to be drawn where it becomes darker, from 0 to 1: the
    binary digits of the number turned round, as many as count lines need.

    So lines half as dense as the densest ones are every second one of these, and every stroke runs on into what is
    darker.
    Source: van der Corput, Verteilungsfunktionen (1935).
    """
    digits = max(count - 1, 1).bit_length()
    rest = line % (1 << digits)
    result = np.zeros(len(line), dtype=np.intp)
    for _ in range(digits):
        result = 2 * result + (rest & 1)
        rest = rest >> 1
    return np.asarray((result + 0.5) / (1 << digits))


# What is seen of filled polygons, and how dark it is from place to place.

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

    def take(self, which: Bools) -> TonedRegions:
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
    are no regions. Errors as in visible_fills.
    """
    import shapely

    shown = (np.diff(fills.offsets) > 2) & (fills.kind != FillKind.BACKGROUND)
    fills = fills.take(np.flatnonzero(shown)).in_triangles()
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


def _darkness(fills: Fills) -> tuple[Floats, Floats, Floats]:
    """(m,3) the planes of darkness over plain polygons and shaded triangles, and (m,) the least and the largest one.

    Edge cases: triangles without area are as dark as the mean of their corners.
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
    area = cross(one, other)
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


# Hatching along lines of a surface: each of them as far as it is dark enough for it.

STEP_MM = 0.4
"""So often along a line one looks how dark it is there, and how far its neighbours are away."""


@dataclass(frozen=True, eq=False)
class FollowedLines:
    """The visible lines of a family, 0 or 1, on an item.

    paths: straight parts of two points, of this item and others; samples (s,3): points on all lines of the family, line
    (s,): of which, and apart (s,): how far in mm the neighbouring lines are from there; ranks (s,): which of them are
    drawn first where it becomes darker, from 0 to 1; ends (3,): the unit normal of the flat ends of a capped body, or
    zero; shortest_mm: strokes are no shorter.
    """

    family: int
    item: int
    paths: Paths
    samples: Floats
    apart: Floats
    line: Ints
    ranks: Floats
    ends: Floats
    shortest_mm: float = 0.0


def dark_parts(lines: FollowedLines, hatching: Hatching, darkness: Callable[[Floats, Floats], Floats]) -> Paths:
    """Those parts of lines that hatch an item as dark as it is: darkness(flat, solid) of places (n,2) on the page and
    (n,3) in space.

    Of lines that are d mm apart, each has a rank between 0 and 1; it is drawn where its rank is less than the share of
    them that is needed for the ink. So where lines come closer on the page, there are fewer of them.
    """
    paths = chosen(lines.paths, lines.paths.item == lines.item)
    if not len(paths):
        return Paths.empty()
    from scipy.spatial import cKDTree

    ends, space = paths.points.reshape(-1, 2, 2), paths.points3d.reshape(-1, 2, 3)
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    sizes = np.maximum(np.ceil(length / STEP_MM), 1.0).astype(np.intp) + 1
    of = ragged.owner(sizes)
    share = ragged.place(sizes) / (sizes[of] - 1.0)
    flat = ends[of, 0] + share[:, None] * (ends[of, 1] - ends[of, 0])
    solid = space[of, 0] + share[:, None] * (space[of, 1] - space[of, 0])
    known = np.flatnonzero(np.isfinite(lines.samples).all(axis=1))
    near = known[cKDTree(lines.samples[known]).query(solid, workers=workers(len(solid)))[1]]
    rank = _ranks(lines, near, of, _lines(lines.line[near], of, paths.curve))
    dark = np.ones(len(flat)) if hatching.by == "even" else darkness(flat, solid)
    cover = covers(hatching, dark)[lines.family]
    error_ratio = lines.apart[near] * cover / hatching.width_mm - rank
    return _long_enough(_cut(paths, of, share, error_ratio), lines.shortest_mm)


def _ranks(lines: FollowedLines, near: Ints, of: Ints, line: Ints) -> Floats:
    """(n,) the ranks of points of paths, of which those samples (n,) are next: on a neighbouring line some are, where
    lines are close, and have the rank that the line (m,) of their path begins with."""
    first = np.searchsorted(lines.line, np.arange(int(lines.line[-1]) + 1))
    own = line[of]
    return np.where(lines.line[near] == own, lines.ranks[near], lines.ranks[first[own]])


def _lines(line: Ints, of: Ints, curve: Ints) -> Ints:
    """(m,) the lines that paths are parts of, by those (n,) that points of paths of (n,) are next to: the middle one,
    of all parts of a curve (m,) where they are known."""
    group = np.unique(np.where(curve >= 0, curve, -1 - np.arange(len(curve))), return_inverse=True)[1].ravel()
    order = np.lexsort((line, group[of]))
    sizes = np.bincount(group[of])
    middle = line[order][ragged.starts(sizes) + sizes // 2]
    return np.asarray(middle[group])


def darkness_along(regions: TonedRegions, points: Floats, _: Floats) -> Floats:
    """(n,) how dark regions are at points (n,2) of the page; beside them as dark as the nearest one."""
    import shapely

    corners, ring = regions.points.T[:, :], regions.offsets
    closed = np.insert(np.arange(len(corners)), ring[1:], ring[:-1])
    rings = shapely.linearrings(corners[closed], indices=ragged.owner(np.diff(ring) + 1))
    outer = np.append(True, regions.of[1:] != regions.of[:-1])
    tree = shapely.STRtree(shapely.polygons(rings[outer]))
    # Of a region with holes the outer ring does: in a hole is something else.
    spots = shapely.points(points)
    point, region = tree.query(spots, predicate="intersects")
    found = np.full(len(points), -1)
    found[point] = region
    lost = np.flatnonzero(found < 0)
    if len(lost):
        found[lost] = tree.nearest(spots[lost])
    return regions.darkness_at(points, found)


def _cut(paths: Paths, of: Ints, share: Floats, error_ratio: Floats) -> Paths:
    """The parts of straight paths where an excess, known at places share (n,) along paths of (n,), is positive."""
    same = of[1:] == of[:-1]
    first = np.flatnonzero(same)
    here, there = error_ratio[first], error_ratio[first + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        zero = share[first] + (share[first + 1] - share[first]) * np.clip(here / (here - there), 0.0, 1.0)
    low, high = np.where(here > 0.0, share[first], zero), np.where(there > 0.0, share[first + 1], zero)
    kept = np.flatnonzero(((here > 0.0) | (there > 0.0)) & (high > low))
    low, high, owner = low[kept], high[kept], of[first[kept]]
    new = np.ones(len(owner), dtype=np.bool_)
    new[1:] = (owner[1:] != owner[:-1]) | (low[1:] > high[:-1])
    begin = np.flatnonzero(new)
    last = np.append(begin[1:], len(new))[: len(begin)] - 1
    low, high, owner = low[begin], high[last], owner[begin]
    part = np.stack([low, high], axis=1)
    parts = chosen(paths, owner)
    ends, space = parts.points.reshape(-1, 2, 2), parts.points3d.reshape(-1, 2, 3)
    points = ends[:, :1] + part[..., None] * (ends[:, 1:] - ends[:, :1])
    solid = space[:, :1] + part[..., None] * (space[:, 1:] - space[:, :1])
    # What is known of a curve's direction and handles is known where its parts begin and end only.
    whole = (part == (0.0, 1.0)).ravel()
    cut = np.repeat((part == (0.0, 1.0)).all(axis=1), 2)
    return replace(
        parts,
        points=points.reshape(-1, 2),
        points3d=solid.reshape(-1, 3),
        kind=np.full(len(parts), int(LineKind.HATCH)),
        directions=np.where(whole[:, None], parts.directions, np.nan),
        handles=np.where(cut[:, None], parts.handles, np.nan),
    )


def _long_enough(parts: Paths, shortest_mm: float) -> Paths:
    """Straight parts without those that follow each other along a curve and are too short together."""
    if not len(parts) or shortest_mm <= 0.0:
        return parts
    ends = parts.points.reshape(-1, 2, 2)
    new = np.ones(len(parts), dtype=np.bool_)
    gap = np.linalg.norm(ends[1:, 0] - ends[:-1, 1], axis=1)
    new[1:] = (parts.curve[1:] != parts.curve[:-1]) | (gap > COINCIDENT_MM)
    run = np.cumsum(new) - 1
    length = np.bincount(run, weights=np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    return chosen(parts, np.flatnonzero(length[run] >= shortest_mm))


# What hatching lines run along: directions on the page, or in the planes of faces.


@dataclass(frozen=True, eq=False)
class PageFrame:
    """Lines at an angle on the page, in mm."""

    angle: float

    def coordinates(self, regions: TonedRegions) -> tuple[Floats, Floats]:
        """Where the corners (c,) of regions are along the lines and across them."""
        return self.places(regions.points)

    def places(self, points: Floats) -> tuple[Floats, Floats]:
        """(c,) where points (2,c) of the page are along the lines, and (c,) across them."""
        along, across = self._axes()
        return matmul(along, points), matmul(across, points)

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
    """Lines in the planes of polygons (n,): origin, along and across (n,3) in space, as long as a mm is on the page at
    the middle of the polygons of a plane; plane (n,) their numbers."""

    origin: Floats
    along: Floats
    across: Floats
    plane: Ints
    corners: Floats
    of: Ints

    def coordinates(self, regions: TonedRegions) -> tuple[Floats, Floats]:
        """Where the corners (c,) of the polygons are along the lines and across them."""
        return self.places

    @property
    def places(self) -> tuple[Floats, Floats]:
        """(c,) where the corners of the polygons are along the lines, and (c,) across them."""
        arm = self.corners - self.origin[self.of]
        along, across = self.along[self.of], self.across[self.of]
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


def _frame_of_regions(regions: TonedRegions, angle: float, page_from_world: Floats) -> PlaneFrame:
    """Lines in the planes of regions. Edge cases: a plane seen edge-on has no regions."""
    of = np.repeat(regions.of, np.diff(regions.offsets))
    corners = in_space(regions.fills, regions.points.T, regions.source[of], page_from_world)
    normal, place = (column[regions.source] for column in planes_of_fills(regions.fills))
    return plane_frame(corners, of, normal, place, regions.item, angle, page_from_world)


def plane_frame(
    corners: Floats, of: Ints, normal: Floats, place: Floats, item: Ints, angle: float, page_from_world: Floats
) -> PlaneFrame:
    """Lines at an angle to what is level in the planes of polygons (n,), evenly apart on the page in their middles.

    corners (c,3) in space, of (c,): whose; normal, place (n,3): the planes; item (n,). In level planes the angle is
    from the x axis. Planes of one item with one normal are one where they coincide but for SAME_PLANE_OF_EXTENT.
    """
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = (low + high) / 2.0
    plane = _plane_numbers(item, normal, dot(normal, place - middle), float(norm(high - low)))
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
    return PlaneFrame(origin, along / mm[:, None], across / apart[:, None], plane, corners, of)


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


# Parallel lines cut off where they enter and leave regions, all at once.

MOST_STROKES = 10_000_000
"""No sheet of paper takes more strokes."""


@dataclass(frozen=True, eq=False)
class Scanned:
    """The parts (k,) of lines inside regions: region and line, ascending, and where along the line each begins and
    ends, low and high."""

    region: Ints
    line: Ints
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.region)


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where lines cross the sides of polygons (n,): side, by the corner that it begins at, line, its number, share,
    which part of the side lies before, and along, where on the line that is; polygon by polygon, line by line, in the
    order along the lines: every line enters and leaves a polygon by turns."""

    side: Ints
    line: Ints
    share: Floats
    along: Floats


def crossings(u: Floats, v: Floats, offsets: Ints, polygon: Ints, spacing: Floats) -> Crossings:
    """Where lines along u cross polygons: line k of a polygon is where v is k + 1/2 times its spacing.

    u, v (c,): corners of rings offsets (n+1,); polygon (n,): which each ring bounds, from outside or as a hole; spacing
    (r,) of polygons. So neighbours of one spacing share their lines, and lines meet corners seldom: a corner on a line
    counts as above it.
    Errors: InputError for more than MOST_STROKES parts. Edge cases: polygons between two lines have none.
    """
    of = np.repeat(polygon, np.diff(offsets))
    after = ragged.following(offsets)
    place = v / spacing[of] - 0.5
    here, there = place, place[after]
    low, high = np.ceil(np.minimum(here, there)), np.ceil(np.maximum(here, there))
    crossed = high - low
    if not crossed.sum() < 2 * MOST_STROKES:
        raise InputError(f"strokes {spacing.min():g} apart are too fine: more than {MOST_STROKES} of them")
    count = crossed.astype(np.intp)
    side = ragged.owner(count)
    line = low[side] + ragged.place(count)
    share = (line - here[side]) / (there - here)[side]
    along = u[side] + share * (u[after] - u)[side]
    order = np.lexsort((along, line, of[side]))
    return Crossings(side[order], line[order].astype(np.intp), share[order], along[order])


def scanned(u: Floats, v: Floats, offsets: Ints, region: Ints, spacing: Floats) -> Scanned:
    """The parts inside regions of lines along u; all else as in crossings."""
    found = crossings(u, v, offsets, region, spacing)
    low, high = found.along[0::2], found.along[1::2]
    full = np.flatnonzero(high > low)
    of = np.repeat(region, np.diff(offsets))[found.side[2 * full]]
    return Scanned(of, found.line[2 * full], low[full], high[full])


# Regions stippled: dots that lie closer where it is darker, and nowhere else than they have to.

PLACES = 12
"""So many places of the page belong to a dot where it is darkest, and more elsewhere."""

WHITE = 0.02
"""What is no darker has no dots: one alone would be a speck, and no shade."""

ROUNDS = 12
"""So often dots move to the middles of their cells: from then on they move by hundredths of their distances."""

BESIDE = 7
"""So many dots next to one are looked at for places near it, before all are."""

PLACES_AT_ONCE = 1 << 16
"""Places whose nearest dots are looked for at once."""

FINEST_MM = 0.02
"""Places are no closer: dots are not, either."""

BITS = 16
"""Digits of places along the curve that goes through all of them."""


def stippled(regions: TonedRegions, stippling: Stippling, page_from_world: Floats) -> Paths:
    """As many dots as a stippling asks for, in regions, so dense as these are dark.

    Dots begin at equal shares of the darkness along a curve that fills the page, and move to the middles of the
    darkness that is nearer to each than to the others, again and again.
    Edge cases: where all is white there are none; and no more than there are places FINEST_MM apart.
    Source: Lloyd, Least squares quantization in PCM (1982); Secord, Weighted Voronoi stippling (2002).
    """
    from scipy.spatial import cKDTree

    if not len(regions):
        return Paths.empty()
    pitch = _pitch(regions, stippling)
    places, region, weight = _places(regions, stippling, pitch)
    if not len(places):
        return Paths.empty()
    order = radix_order(_along_curve(places), 2 * BITS)
    places, region, weight = places[order], region[order], weight[order]
    total = np.cumsum(weight)
    count = min(stippling.dots, len(places))
    start = np.searchsorted(total, (np.arange(count) + 0.5) / count * total[-1])
    start = np.unique(np.minimum(start, len(places) - 1))
    dots = places[start]
    nearest = np.searchsorted(start, np.arange(len(places)), side="right") - 1
    nearest = np.maximum(nearest, 0)
    moments = weight * places.T
    for _ in in_turn(range(ROUNDS)):
        nearest = nearest_dots(places, dots, nearest)
        mass = np.bincount(nearest, weight, len(dots))
        middle = np.stack([np.bincount(nearest, moment, len(dots)) for moment in moments], axis=1)
        dots = np.where(mass[:, None] > 0.0, middle / np.where(mass > 0.0, mass, 1.0)[:, None], dots)
    # The middle of a cell may lie beside a region that is not convex: then the nearest place of it does.
    distance, near = cKDTree(places).query(dots, workers=workers(len(dots)))
    dots = np.where((distance <= pitch)[:, None], dots, places[near])
    return _dots(regions, dots, region[near], page_from_world)


def nearest_dots(places: Floats, dots: Floats, guess: Ints) -> Ints:
    """(n,) which of dots (m,2) is the nearest to each of places (n,2), given the numbers (n,) of dots that are near.

    No dot is nearer than the guess that is twice as far from it as the place is; so mostly no other one has to be
    looked at, or a few of those next to it.
    Source: Elkan, Using the triangle inequality to accelerate k-means (2003).
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(dots)
    apart, beside = tree.query(dots, min(BESIDE + 1, len(dots)), workers=workers(len(dots)))
    square = np.ascontiguousarray((0.5 * apart.reshape(len(dots), -1).T) ** 2)
    beside = np.ascontiguousarray(beside.reshape(len(dots), -1).T)
    x, y = np.ascontiguousarray(dots.T)

    def found(some: slice) -> Ints:
        u, v = places[some].T
        near = guess[some].copy()
        far = (u - x[near]) ** 2 + (v - y[near]) ** 2
        left, step = np.arange(len(near)), 1
        first, best = near, far
        while step < len(square):
            kept = np.flatnonzero(far > square[step][first])
            left, first, u, v, far, best = (column[kept] for column in (left, first, u, v, far, best))
            other = beside[step][first]
            here = (u - x[other]) ** 2 + (v - y[other]) ** 2
            nearer = np.flatnonzero(here < best)
            near[left[nearer]], best[nearer] = other[nearer], here[nearer]
            step += 1
        if step < len(dots):
            near[left] = tree.query(places[some][left])[1]
        return near

    return np.concatenate([*mapped(found, slices(len(places), PLACES_AT_ONCE))])


def _pitch(regions: TonedRegions, stippling: Stippling) -> float:
    """How far places have to be apart, so that PLACES of them in the darkest regions belong to a dot."""
    after = ragged.following(regions.offsets)
    x, y = regions.points
    signed = np.add.reduceat(x * y[after] - x[after] * y, regions.offsets[:-1]) / 2.0
    # Of the rings of a region the first one is around it, and the others are its holes.
    outer = np.append(True, regions.of[1:] != regions.of[:-1])
    area = np.where(outer, np.abs(signed), -np.abs(signed))
    dark = (regions.lowest + regions.highest) / 2.0
    ink = float(area.sum() if stippling.by == "even" else matmul(area, dark[regions.of]))
    return max(float(np.sqrt(max(ink, 0.0) / (PLACES * stippling.dots))), FINEST_MM)


def _places(regions: TonedRegions, stippling: Stippling, pitch: float) -> tuple[Floats, Ints, Floats]:
    """(n,2) places of a grid on the page that lie in regions (n,) and are not white, and (n,) how dark it is there."""
    page = PageFrame(0.0)
    parts = scanned(*page.coordinates(regions), regions.offsets, regions.of, np.full(len(regions), pitch))
    first = np.ceil(parts.low / pitch - 0.5).astype(np.intp)
    sizes = np.maximum(np.ceil(parts.high / pitch - 0.5).astype(np.intp) - first, 0)
    of = ragged.owner(sizes)
    places = np.asarray((np.stack([ragged.ranges(first, sizes), parts.line[of]], axis=1) + 0.5) * pitch)
    region = parts.region[of]
    weight = np.ones(len(places)) if stippling.by == "even" else regions.darkness_at(places, region)
    dark = np.flatnonzero(weight >= WHITE)
    return places[dark], region[dark], weight[dark]


def _along_curve(places: Floats) -> ShortKeys:
    """(n,) how far along Hilbert's curve places (n,2) are.

    Source: Hilbert, Ueber die stetige Abbildung einer Linie auf ein Flaechenstueck (1891).
    """
    low, high = places.min(axis=0), places.max(axis=0)
    size = max(float((high - low).max()), FINEST_MM)
    x, y = np.minimum((places - low) / size * (1 << BITS), (1 << BITS) - 1).T.astype(np.uint32)
    result = np.zeros(len(places), dtype=np.uint32)
    for bit in range(BITS - 1, -1, -1):
        right, top = (x >> bit) & 1, (y >> bit) & 1
        result = 4 * result + (3 * right ^ top)
        turned = (top == 0) & (right == 1)
        x, y = np.where(turned, (1 << BITS) - 1 - x, x), np.where(turned, (1 << BITS) - 1 - y, y)
        x, y = np.where(top == 0, y, x), np.where(top == 0, x, y)
    return result


def _dots(regions: TonedRegions, dots: Floats, region: Ints, page_from_world: Floats) -> Paths:
    """Dots as short strokes."""
    count = len(dots)
    ends = np.repeat(dots, 2, axis=0)
    ends[0::2, 0] -= DOT_MM / 2.0
    ends[1::2, 0] += DOT_MM / 2.0
    none = np.zeros(count, dtype=np.intp)
    space = in_space(regions.fills, ends, np.repeat(regions.source[region], 2), page_from_world)
    kind = np.full(count, int(LineKind.HATCH))
    open_ = np.zeros(count, dtype=np.bool_)
    return Paths(ends, 2 * np.arange(count + 1), open_, kind, regions.item[region], none, space)


# Filled polygons hatched: strokes of a pen in what is seen of them.

CRUMB = 4.0
"""Regions of one shade that are smaller, in squares of the distance between lines, have no strokes of their own."""


def hatched_fills(fills: Fills, hatching: Sequence[Hatching | Stippling | None], page_from_world: Floats) -> Paths:
    """Strokes, as they come, that hatch the visible regions of polygons as dark as their colours.

    Parameters
    ----------
    fills : Fills
        Each painted over those before it.
    hatching : sequence of Hatching or None
        Of every item that has polygons.
    page_from_world : (4, 4) array of float
        As in Drawing.

    Returns
    -------
    Paths
        Strokes of two points, of the kind HATCH.

    Raises
    ------
    InputError
        Where there are more strokes than any paper takes.

    Notes
    -----
    A plain region, and neighbours of it that are as dark, has strokes at equal distances; where the darkness varies,
    strokes begin where it is dark enough for them. All regions of an item share their lines.

    Error: regions are known to a few GRID_MM; gaps in a stroke below HATCH_GAP_MM, as between the facets of what is
    round, are closed.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import Fills, hatched_fills
    >>> square = np.array([(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)])
    >>> black = Fills.flat(square, np.array([0, 4]), np.zeros((1, 3), dtype=np.uint8), item=0)
    >>> strokes = hatched_fills(black, [vp.Hatching(spacing_mm=1.0, angle_deg=0.0)], np.eye(4))
    >>> len(strokes), strokes.points[:2].tolist()
    (10, [[10.0, 10.5], [20.0, 10.5]])
    """
    return hatched_regions(toned_regions(fills), hatching, page_from_world)


def hatched_regions(
    regions: TonedRegions,
    hatching: Sequence[Hatching | Stippling | None],
    page_from_world: Floats,
    followed: Sequence[FollowedLines] = (),
) -> Paths:
    """Strokes, as they come, that hatch regions. followed: the lines of items that are hatched along such; the others
    as of hatched_fills."""
    given = [Hatching("none") if one is None else one for one in hatching]
    scan = _without_lines(regions, followed)
    found = []
    for lines in followed:
        along = given[lines.item]
        assert isinstance(along, Hatching)
        own = regions.take(regions.item == lines.item)
        if len(own):
            found.append(dark_parts(lines, along, partial(darkness_along, own)))
    for one in dict.fromkeys(given):
        if one.by == "none":
            continue
        mine = np.array([other == one for other in given], dtype=np.bool_)
        some = regions.take(mine[regions.item] & (regions.item >= 0) & scan)
        if isinstance(one, Stippling):
            found.append(stippled(some, one, page_from_world))
            continue
        for family in (0, 1) if one.cross else (0,):
            found += _family(some, one, family, page_from_world)
    return concatenated((Paths.empty(), *found))


def _without_lines(regions: TonedRegions, followed: Sequence[FollowedLines]) -> Bools:
    """(n,) the regions that no followed lines lie on: of items that have such the flat ends."""
    found = np.ones(len(regions), dtype=np.bool_)
    if not followed or not len(regions):
        return found
    normal = planes_of_fills(regions.fills)[0][regions.source]
    for lines in followed:
        tilted = np.linalg.norm(cross(normal, lines.ends), axis=1) > SAME_PLANE_SINE
        found &= (regions.item != lines.item) | (lines.ends.any() & ~tilted)
    return found


def _family(regions: TonedRegions, hatching: Hatching, family: int, page_from_world: Floats) -> list[Paths]:
    """The strokes of one direction: of plain regions, and of those where darkness varies."""
    angle = float(np.radians(hatching.angle_deg)) + family * np.pi / 2.0
    page = PageFrame(angle)
    plain = regions.plain & ~_fragments(regions, hatching.spacing_mm) | (hatching.by == "even")
    even, varied = regions.take(plain), regions.take(~plain)
    found = []
    spacing = even_spacings(hatching, np.ones(len(even)) if hatching.by == "even" else even.lowest)[family]
    even, spacing = even.take(np.isfinite(spacing)), spacing[np.isfinite(spacing)]
    if len(even):
        frame = page if hatching.along != "surface" else _frame_of_regions(even, angle, page_from_world)
        parts = scanned(*frame.coordinates(even), even.offsets, even.of, spacing)
        tone = np.unique(spacing, return_inverse=True)[1].ravel()
        found.append(_strokes(even, frame, parts, spacing, tone, page_from_world))
    if len(varied):
        spacing = np.full(len(varied), hatching.spacing_mm)
        parts = scanned(*page.coordinates(varied), varied.offsets, varied.of, spacing)
        parts = _dark_enough(varied, page, parts, thresholds(hatching, family, parts.line), hatching.spacing_mm)
        found.append(_strokes(varied, page, parts, spacing, np.zeros(len(varied), dtype=np.intp), page_from_world))
    return found


def _fragments(regions: TonedRegions, spacing_mm: float) -> Bools:
    """(n,) the regions of items with varying darkness in planes of less than CRUMB squares between lines: triangles of
    round bodies that happen to have one shade. Their strokes are those of the regions around them."""
    round_ = np.unique(regions.item[~regions.plain])
    normal = planes_of_fills(regions.fills)[0][regions.source]
    rows = np.column_stack([regions.item, np.rint(normal / SAME_PLANE_SINE)])
    group = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    area = np.bincount(group, regions.areas, minlength=len(rows))[group]
    return np.isin(regions.item, round_) & (area < CRUMB * spacing_mm * spacing_mm)


def _dark_enough(
    regions: TonedRegions, frame: PageFrame, parts: Scanned, threshold: Floats, spacing_mm: float
) -> Scanned:
    """The parts of lines, each as far as it is darker than a threshold (k,)."""
    of, v = parts.region, np.asarray((parts.line + 0.5) * spacing_mm)
    first, last = (regions.darkness_at(frame.on_page(u, v), of) for u in (parts.low, parts.high))
    dark, dark_end = first > threshold, last > threshold
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip((threshold - first) / (last - first), 0.0, 1.0)
    cut = parts.low + share * (parts.high - parts.low)
    low, high = np.where(dark, parts.low, cut), np.where(dark_end, parts.high, cut)
    kept = np.flatnonzero((dark | dark_end) & (high > low))
    return Scanned(parts.region[kept], parts.line[kept], low[kept], high[kept])


def _strokes(
    regions: TonedRegions,
    frame: PageFrame | PlaneFrame,
    parts: Scanned,
    spacing: Floats,
    tone: Ints,
    page_from_world: Floats,
) -> Paths:
    """The parts as strokes, those that follow each other on a line of one item and tone (n,) as one."""
    item = regions.item
    order = np.lexsort(
        (parts.low, parts.line, tone[parts.region], frame.sheet(regions)[parts.region], item[parts.region])
    )
    region, line, low, high = (column[order] for column in (parts.region, parts.line, parts.low, parts.high))
    rows = np.stack([line, tone[region], frame.sheet(regions)[region], item[region]])
    new = np.ones(len(line), dtype=np.bool_)
    new[1:] = (rows[:, 1:] != rows[:, :-1]).any(axis=0) | (low[1:] > high[:-1] + HATCH_GAP_MM)
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(new))[: len(first)] - 1
    ends = np.stack([first, last], axis=1).ravel()
    u = np.stack([low[first], high[last]], axis=1).ravel()
    v = (line[ends] + 0.5) * spacing[region[ends]]
    points, in_space = frame.points(regions, region[ends], u, v, page_from_world)
    count = len(first)
    none = np.zeros(count, dtype=np.intp)
    kind = np.full(count, int(LineKind.HATCH))
    open_ = np.zeros(count, dtype=np.bool_)
    return Paths(points, 2 * np.arange(count + 1), open_, kind, item[region[first]], none, in_space)


# From which darkness on lines are drawn, so that those that are drawn are evenly apart.

MOST_PLACES = 24
"""Places on one line at which it is compared with others to find the order of lines, at most."""

GROWTH = 1.4
"""Lines are compared with those before them in groups, each larger than the last one by this factor."""

NEIGHBOURS = 12
"""So many places are looked at for one of a line before it in its own group."""

FIRST_ONES = 16
"""Lines with whose places all others are compared: later ones are so many that only what is near them can change."""

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)

SMOOTHED = 9
"""Along so many places of a line ranks are averaged: else a line would be dashed where two others end beside it."""


def place_ranks(where: Floats, lines: Ints, lengths: Floats, apart: float, area: float) -> Floats:
    """(s,) the ranks of places where (s,d) on lines (s,), which follow each other: what is drawn where the part x of
    all lines, apart from each other, is asked for is what has a rank below x. lengths (s,): of lines, for which each
    place stands; area: that the lines cover.

    Lines come in an order: each is the one that is farthest from all before. A place that is r from the lines before
    its own comes between a half of apart / r and the whole of it, spread evenly: where lines run together only some go
    on. Ranks are such that on the whole a part x of the area is covered by what has a rank below x.
    Source: Gonzalez, Clustering to minimize the maximum intercluster distance (1985), with lines for points.
    """
    if not len(lines):
        return np.zeros(0)
    sizes = np.bincount(lines)
    place = np.argsort(_farthest_first(where, ragged.starts(sizes), sizes), kind="stable")
    turn = place[lines]
    away = _from_those_before(where, turn)
    spread = 0.5 + 0.5 * np.mod(GOLDEN * turn, 1.0)
    comes = _averaged(spread * apart / np.maximum(away, np.nextafter(0.0, 1.0)), lines)
    order = np.argsort(comes, kind="stable")
    covered = np.cumsum(lengths[order]) - 0.5 * lengths[order]
    result = np.empty(len(lines))
    result[order] = covered * apart / area
    return result


def _farthest_first(where: Floats, starts: Ints, sizes: Ints) -> Ints:
    """(n,) the lines in their order: that with the most places first, then always the one whose places are farthest
    from all lines before, on average."""
    from scipy.spatial import cKDTree

    count = len(sizes)
    taken = np.minimum(sizes, MOST_PLACES)
    of = ragged.owner(taken)
    share = ragged.place(taken) / np.maximum(taken - 1, 1)[of]
    some = where[starts[of] + np.rint(share * (sizes[of] - 1)).astype(np.intp)]
    first = ragged.starts(taken)
    away = np.full(len(some), np.inf)
    order = np.zeros(count, dtype=np.intp)
    line, every = int(np.argmax(sizes)), cKDTree(some)
    for turn in range(count):
        order[turn] = line
        own = slice(first[line], first[line] + taken[line])
        # Lines that have had their turn are nearer to themselves than any is to others.
        away[own] = -1.0
        tree = cKDTree(some[own])
        if turn < FIRST_ONES:
            away = np.minimum(away, tree.query(some, workers=workers(len(some)))[0])
        else:
            # What is nearer to lines before than to this one is not asked.
            pairs = tree.sparse_distance_matrix(every, max(float(away.max()), 0.0), output_type="ndarray")
            np.minimum.at(away, pairs["j"], pairs["v"])
        line = int(np.argmax(np.add.reduceat(away, first) / taken))
    return order


def _from_those_before(where: Floats, turn: Ints) -> Floats:
    """(s,) how far places are from the lines that came before theirs, by whose turn (s,) they came."""
    from scipy.spatial import cKDTree

    away = np.full(len(where), np.inf)
    begin, count = 1, int(turn.max()) + 1
    while begin < count:
        may_stop()
        end = max(begin + 1, int(GROWTH * begin))
        own = np.flatnonzero((turn >= begin) & (turn < end))
        # Trees of halves of boxes, not of places, are built in less time than they lose.
        before = cKDTree(where[turn < begin], balanced_tree=False)
        away[own] = before.query(where[own], workers=workers(len(own)))[0]
        may_stop()
        if end > begin + 1 and len(own):
            beside, most = cKDTree(where[own], balanced_tree=False), float(away[own].max())
            far, which = beside.query(
                where[own], min(NEIGHBOURS, len(own)), distance_upper_bound=most, workers=workers(len(own))
            )
            # What is not found is as far as nothing; it has the number after the last place.
            own_turn = np.append(turn[own], count)
            far = np.where(own_turn[which] < own_turn[:-1, None], far, np.inf)
            away[own] = np.minimum(away[own], far.min(axis=1))
        begin = end
    return away


def _averaged(values: Floats, lines: Ints) -> Floats:
    """(s,) means of values over neighbouring places of a line."""
    total, count = np.zeros(len(values)), np.zeros(len(values))
    number = np.arange(len(values))
    for step in range(-(SMOOTHED // 2), SMOOTHED // 2 + 1):
        other = np.clip(number + step, 0, len(values) - 1)
        same = lines[other] == lines
        total += np.where(same, values[other], 0.0)
        count += same
    return np.asarray(total / count)
