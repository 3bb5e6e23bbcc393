"""Hatching along lines of a surface: each of them as far as it is dark enough for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching.densities import covers
from vectorplot.drawing.hatching.toned_regions import TonedRegions
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import workers
from vectorplot.scene.hatching import Hatching
from vectorplot.tolerances.of_the_page import COINCIDENT_MM
from vectorplot.words import LineKind

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


def dark_parts(lines: FollowedLines, hatching: Hatching, regions: TonedRegions) -> Paths:
    """Those parts of lines that hatch an item as dark as its regions are.

    Of lines that are d mm apart, each has a rank between 0 and 1; it is drawn where its rank is less than the share of
    them that is needed for the ink. So where lines come closer on the page, there are fewer of them.
    Degenerate: places of no region are as dark as the nearest one.
    """
    paths = chosen(lines.paths, lines.paths.item == lines.item)
    some = regions.some(regions.item == lines.item)
    if not len(paths) or not len(some):
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
    dark = np.ones(len(flat)) if hatching.by == "even" else _darkness(some, flat)
    cover = covers(hatching, dark)[lines.family]
    excess = lines.apart[near] * cover / hatching.width_mm - rank
    return _long_enough(_cut(paths, of, share, excess), lines.shortest_mm)


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


def _darkness(regions: TonedRegions, points: Floats) -> Floats:
    """(n,) how dark regions are at points (n,2) of the page."""
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


def _cut(paths: Paths, of: Ints, share: Floats, excess: Floats) -> Paths:
    """The parts of straight paths where an excess, known at places share (n,) along paths of (n,), is positive."""
    same = of[1:] == of[:-1]
    first = np.flatnonzero(same)
    here, there = excess[first], excess[first + 1]
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
