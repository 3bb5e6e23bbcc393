"""What is compared in a certificate: segments, triangles, edges and cells in the image, and parts of segments.

It belongs to `check_certificate.py`, and imports nothing but the standard library and numpy either. Parts of segments
are found by linear functions at both ends: what a triangle hides is convex.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]
Rows = TypeVar("Rows", bound="Segments | Parts")

BLOCK, PAIRS = 64, 1 << 17
"""Segments that are compared with all others at once, and pairs that are held at once: all arrays are below 100 MB."""
LEAST, SEAM_MM, STRICT_MM, WELD_MM = 1e-300, 1e-8, 1e-6, 1e-6
"""The least divisor; faces hide so far beyond sides they share, and rounding moves points less; what is no farther
behind a face is not hidden by it; points of nets that are no farther apart are one."""
ANGLE_DEG, NET_DEG = 1e-3, 15.0
"""Edges that turn by the crease angle, but for so much, may be drawn or not: on meshes, and where nets meet."""


class Segments(NamedTuple):
    """Segments in the image: ends (n,3), of which stroke or edge each is a part, from 0, and mm that are left open."""

    start: Floats
    end: Floats
    owner: Ints
    slack: Floats

    def at(self, which: Ints, share: Floats) -> Floats:
        """(k,3) points of them."""
        return self.start[which] + share[:, None] * (self.end[which] - self.start[which])

    def least(self, ratio: float) -> Floats:
        """(n,) the part of each that is so many times its slack long, but half of one that is short."""
        return np.minimum(ratio * self.slack / np.maximum(self.length, LEAST), 0.5)

    @property
    def length(self) -> Floats:
        """(n,) in mm on the page."""
        return np.asarray(np.hypot(*(self.end - self.start).T[:2]))


class Parts(NamedTuple):
    """Parts of segments: line (n,), from where to where, of 0 to 1; by (n,): what makes them parts."""

    line: Ints
    low: Floats
    high: Floats
    by: Ints


def take(rows: Rows, which: Any) -> Rows:
    """Some segments or parts of all."""
    return type(rows)(*(column[which] for column in rows))


def together(one: Segments, other: Segments) -> Segments:
    """All segments of two."""
    return Segments(*(np.concatenate(pair) for pair in zip(one, other, strict=True)))


class Triangles(NamedTuple):
    """Triangles in the image: corners (t,3,3); halves (t,4,4): x, y, z, 1 times them are mm inside of each side, and mm
    behind; outline (t,3): where the image of the surface ends; hiding (h,): all that hide and are no narrow strips;
    off, slack (t,): mm that each is off its surface, and that are left open beside it."""

    corners: Floats
    halves: Floats
    outline: Bools
    hiding: Ints
    off: Floats
    slack: Floats


def times(matrix: Floats, points: Floats) -> Floats:
    """(n,r) points (n,3), to which 1 is added, by a matrix (r,4)."""
    return np.asarray((points[:, None, :] * matrix[None, :, :3]).sum(axis=2) + matrix[:, 3])


def image_rows(matrix: Floats, anchor: Floats) -> Floats:
    """(4,4) x, y, z and w of the image. anchor (m,3): points in whose middle heights are as long as what is across."""
    x, y, _, last = matrix
    far = float(np.sqrt((last[:3] ** 2).sum()))
    # Planes stay planes where heights are as 1 / w, w being the depth; or along the sight lines, if they are parallel.
    rows = np.array([x, y, [*np.cross(x[:3], y[:3]) / np.sqrt((x[:3] ** 2).sum()), 0.0], last])
    if far > 0.0:
        across = x[:3] - (x[:3] * last[:3]).sum() / far**2 * last[:3]
        middle = np.median(times(last[None], anchor)) if len(anchor) else 1.0
        rows[2] = [0.0, 0.0, 0.0, np.sqrt((across**2).sum()) * middle / far]
    return rows


def image_of(rows: Floats, points: Floats) -> tuple[Floats, float]:
    """(n,3) the image of points in the world, NaN for those behind the eye, and by how many mm rounding moves it."""
    found, most = times(rows, points), times(np.abs(rows), np.abs(points))
    with np.errstate(all="ignore"):
        w = np.where(found[:, 3:] > 0.0, found[:, 3:], np.nan)
        image = found[:, :3] / w
        off = 5.0 * np.finfo(float).eps * (most[:, :3] + np.abs(image) * most[:, 3:]) / w
    return image, float(np.nan_to_num(off).max(initial=0.0))


def placed(view: Floats, points: Floats) -> Floats:
    """(...,3) the image of points (...,3) in the world."""
    with np.errstate(all="ignore"):
        return image_of(view, points.reshape(-1, 3))[0].reshape(points.shape)


def planes_in(view: Floats, planes: list[Any]) -> Floats:
    """(n,4) planes, rows of normal and offset in the world, in the image: x, y, z, 1 times them are mm. Errors:
    ValueError for a normal without length."""
    rows = np.array(planes, dtype=np.float64).reshape(-1, 4) * [1.0, 1.0, 1.0, -1.0]
    if not np.isfinite(rows).all() or not (np.abs(rows[:, :3]).max(axis=1, initial=0.0) > 0.0).all():
        raise ValueError("a plane has no normal")
    found = (np.linalg.inv(view).T[None] * rows[:, None]).sum(axis=2)
    return np.asarray(found / np.linalg.norm(found[:, :3], axis=1)[:, None])


def parts_in(lines: Segments, planes: Floats) -> Iterator[Parts]:
    """Parts of segments that are within the slack of planes (n,4) in the image."""
    every = np.arange(len(lines.owner))
    for number, plane in enumerate(planes):
        away = ((side * plane[:3]).sum(axis=1) + plane[3] for side in lines[:2])
        ends = (np.stack([lines.slack - far, lines.slack + far], axis=1) for far in away)
        yield clipped(every, np.full(len(every), number), *ends)


def halves_of(corners: Floats) -> Floats:
    """(t,4,4) see Triangles, of corners (t,3,3)."""
    way = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(way[:, 0], way[:, 1])[:, None]
    sides = np.stack([-way[..., 1], way[..., 0], 0.0 * way[..., 2]], axis=2)
    rows = np.concatenate([sides, -normal], axis=1) * np.where(normal[..., 2:] < 0.0, -1.0, 1.0)
    rows /= np.maximum(np.linalg.norm(rows, axis=2), LEAST)[..., None]
    return np.concatenate([rows, -(rows * corners[:, [0, 1, 2, 0]]).sum(axis=2)[..., None]], axis=2)


def near(start: Floats, end: Floats, others_low: Floats, others_high: Floats) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of segments and boxes (m,3) that these may reach, in chunks: some neighbours at once against all boxes."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    middle, columns = (
        0.5 * (low[:, :2] + high[:, :2]),
        [np.ascontiguousarray(one.T) for one in (others_low, others_high)],
    )
    order = np.lexsort((middle[:, 1], *np.floor(middle * 32.0 / np.abs(middle).max(initial=LEAST)).T))
    for own in (order[begin : begin + BLOCK] for begin in range(0, len(order), BLOCK)):
        least, most = low[own].min(axis=0), high[own].max(axis=0)
        other = np.flatnonzero((columns[1][0] >= least[0]) & (columns[0][0] <= most[0]))
        for axis in (1, 2):
            other = other[(columns[1][axis][other] >= least[axis]) & (columns[0][axis][other] <= most[axis])]
        rows = max(1, PAIRS // max(len(other), 1))
        for part in (own[k : k + rows] for k in range(0, len(own), rows)):
            hit = [columns[1][axis][other] >= low[part, axis, None] for axis in range(3)]
            hit += [columns[0][axis][other] <= high[part, axis, None] for axis in range(3)]
            a, b = np.nonzero(np.logical_and.reduce(hit))
            yield part[a], other[b]


def clipped(line: Ints, by: Ints, at_start: Floats, at_end: Floats) -> Parts:
    """The parts of segments where all of some linear functions, (n,k) at both ends, are zero or more."""
    root = at_start / np.where(at_start == at_end, 1.0, at_start - at_end)
    low = np.where(at_start < 0.0, np.where(at_end >= 0.0, root, 2.0), 0.0).max(axis=1)
    high = np.where(at_end < 0.0, np.where(at_start >= 0.0, root, -1.0), 1.0).min(axis=1)
    return take(Parts(line, low, high, by), high > low)


def inside(points: Floats, of: Triangles, which: Ints) -> Floats:
    """(n,4) how many mm points are inside of the sides of triangles, and behind these."""
    rows = of.halves[which]
    return np.asarray((rows[..., :3] * points[:, None]).sum(axis=2) + rows[..., 3])


def hidden_parts(lines: Segments, of: Triangles, share: float) -> Iterator[Parts]:
    """Parts of segments that some triangle hides: farther before them than it is off, and than a share of the slack,
    which is left open beside its outline too, or added there, if it is negative."""
    pad = max(-share, 0.0) * of.slack[of.hiding, None]
    low, high = of.corners[of.hiding].min(axis=1) - pad, of.corners[of.hiding].max(axis=1) + pad
    low[:, 2] = -np.inf
    for line, number in near(*lines[:2], low, high):
        by = of.hiding[number]
        slack, open_ = share * np.maximum(of.slack[by], lines.slack[line]), 2.0 * (of.off[by] + STRICT_MM)
        depth = open_ + np.where(of.off[by] > 0.0, 2.0, 1.0) * np.maximum(slack, 0.0)
        margin = np.column_stack([np.where(of.outline[by], slack[:, None], -SEAM_MM), depth])
        yield clipped(line, by, *(inside(side[line], of, by) - margin for side in lines[:2]))


def lying_parts(lines: Segments, of: Triangles) -> Iterator[Parts]:
    """Parts of segments that lie in triangles, within the slack."""
    tolerance = np.maximum(of.slack, lines.slack.max(initial=0.0))[:, None]
    for line, by in near(*lines[:2], of.corners.min(axis=1) - tolerance, of.corners.max(axis=1) + tolerance):
        ends = (inside(side[line], of, by) for side in lines[:2])
        slack = np.maximum(of.slack[by], lines.slack[line])[:, None]
        yield clipped(line, by, *(np.concatenate([rows, -rows[:, 3:]], axis=1) + slack for rows in ends))


def parts_along(lines: Segments, others: Segments, share: float, depth: float) -> Iterator[Parts]:
    """Parts of segments that are within a share of the slack of others; depth: how heights count, on the page 0."""
    start, end, one, two = (side * [1.0, 1.0, depth] for side in (*lines[:2], *others[:2]))
    length = np.linalg.norm(two - one, axis=1)
    # A point has a frame as well: it covers no more than what is beside it.
    unit = np.where(length[:, None] > LEAST, (two - one) / np.maximum(length, LEAST)[:, None], [1.0, 0.0, 0.0])
    across = np.cross(unit, np.eye(3)[np.abs(unit).argmin(axis=1)])
    across /= np.maximum(np.linalg.norm(across, axis=1), LEAST)[:, None]
    frame = np.stack([unit, across, np.cross(unit, across)], axis=1)
    most = share * np.maximum(others.slack, lines.slack.max(initial=0.0))[:, None]
    for line, by in near(start, end, np.minimum(one, two) - most, np.maximum(one, two) + most):
        tolerance = share * np.maximum(lines.slack[line], others.slack[by])[:, None]
        room = length[by, None] * [1.0, 0.0, 0.0] + tolerance
        places = [(frame[by] * (side[line] - one[by])[:, None]).sum(axis=2) for side in (start, end)]
        yield clipped(line, by, *(np.concatenate([place + tolerance, room - place], axis=1) for place in places))


def parts_near(lines: Segments, cells: Floats, reach: float, deep: float = 1e9) -> Iterator[Parts]:
    """Parts of segments that are within a reach of cells, in mm on the page, and so near in depth."""
    room = cells[:, 3:6] + [reach, reach, deep]
    for line, by in near(*lines[:2], cells[:, :3] - room, cells[:, :3] + room):
        way = (side[line] - cells[by, :3] for side in lines[:2])
        yield clipped(line, by, *(np.concatenate([room[by] - one, room[by] + one], axis=1) for one in way))


def hidden_by(lines: Segments, parts: Parts, of: Triangles) -> Parts:
    """Those parts of segments that are hidden by the triangles that are named: both of their ends are."""
    parts = take(parts, np.isin(parts.by, of.hiding) & (0.0 <= parts.low) & (parts.high <= 1.0))
    inner = np.minimum(*(inside(lines.at(parts.line, share), of, parts.by) for share in parts[1:3]))
    inner[:, 3] -= 2.0 * (of.off[parts.by] + STRICT_MM)
    return take(parts, (inner >= -STRICT_MM).all(axis=1))


def joined(parts: Iterable[Parts]) -> Parts:
    """All parts at once."""
    none, zero = np.zeros(0, dtype=np.intp), np.zeros(0)
    return Parts(*map(np.concatenate, zip(Parts(none, zero, zero, none), *parts, strict=True)))


def united(parts: Parts, slack: Floats) -> Parts:
    """The parts, those of one segment that are no further apart than slack (n,) united; by is that of the first one."""
    line, low, high, by = take(parts, np.lexsort((parts.low, parts.line)))
    reach = np.maximum.accumulate(high + 4.0 * line) - 4.0 * line
    new = np.ones(len(line) + 1, dtype=np.bool_)
    new[1:-1] = (line[1:] != line[:-1]) | (low[1:] > reach[:-1] + slack[line[1:]])
    return Parts(line[new[:-1]], low[new[:-1]], reach[new[1:]], by[new[:-1]])


def gaps(parts: Parts, shortest: Floats) -> Parts:
    """What parts leave of 0 to 1 of some segments, where it is longer than shortest (n,)."""
    every, one = np.arange(len(shortest)), np.ones(len(shortest))
    ends = (Parts(every, low * one, low * one + 1.0, every) for low in (-1.0, 1.0))
    line, low, high, by = united(joined([parts, *ends]), 0.0 * one)
    left = Parts(line[1:], high[:-1], low[1:], by[1:])
    return take(left, (line[1:] == line[:-1]) & (low[1:] - high[:-1] > shortest[line[1:]]))


def welded(image: Floats) -> Ints:
    """(n,) the first of the points that are at the place of each: seams of nets, and poles."""
    _, first, place = np.unique(np.floor(image / WELD_MM + 0.37), axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[place.ravel()])


def edges_of(
    world: Floats, image: Floats, triangles: Ints, angle_deg: float, doubt: float, patch: Ints
) -> tuple[Any, ...]:
    """The edges: their vertices (e,2); a triangle at each (e,); by kind, whether they may and must be drawn as such;
    (t,3) at which sides of triangles the image of the surface ends, without a triangle on the other side. doubt: mm
    within which a triangle may be on either side; patch (t,): the surface, -1 on meshes; edges within one are none."""
    one, two, apex = (np.roll(triangles, -step, axis=1).ravel() for step in range(3))
    key, n = np.minimum(one, two) * len(world) + np.maximum(one, two), len(world)
    keys, first, edge, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    ends, edge = np.stack([keys // max(n, 1), keys % max(n, 1)], axis=1), edge.ravel()
    way, arm = (image[to] - image[ends[edge, 0]] for to in (ends[edge, 1], apex))
    beside = (way[:, 0] * arm[:, 1] - way[:, 1] * arm[:, 0]) / np.maximum(np.hypot(way[:, 0], way[:, 1]), LEAST)
    one_sided, facing = [], np.zeros(len(keys), dtype=np.bool_)
    for zero in (doubt, SEAM_MM):
        left, right = (np.bincount(edge, weights=s * beside > zero, minlength=len(keys)) > 0.0 for s in (1.0, -1.0))
        one_sided.append(~(left & right))
        facing = left | right
    # The directions in which faces leave an edge: two faces are flat where these are opposite.
    way, arm = (world[to] - world[ends[edge, 0]] for to in (ends[edge, 1], apex))
    arm -= ((arm * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), LEAST))[:, None] * way
    height = np.linalg.norm(arm, axis=1)
    arm /= np.maximum(height, LEAST)[:, None]
    start = np.searchsorted(edge, np.arange(len(keys)), sorter=(order := np.argsort(edge, kind="stable")))
    f, g = (order[np.minimum(start + step, len(order) - 1)] for step in (0, 1))
    apart, alike = (np.linalg.norm(arm[f] + sign * arm[g], axis=1) for sign in (-1.0, 1.0))
    turn = 180.0 - 2.0 * np.degrees(np.arctan2(apart, alike))
    sure = np.minimum(height[f], height[g]) > 1e-9 * np.abs(world).max(initial=0.0)
    across = (count == 1) | (patch[f // 3] < 0) | (patch[f // 3] != patch[g // 3])
    may = {"contour": (count > 1) & one_sided[0] & across, "boundary": count == 1, "edges": across}
    may["crease"] = (count > 2) | (count == 2) & ((turn > angle_deg - ANGLE_DEG) | ~sure)
    must = {"contour": (count > 1) & one_sided[1] & facing & across, "boundary": count == 1}
    bent = turn > angle_deg + np.where(patch[f // 3] < 0, ANGLE_DEG, NET_DEG)
    must["crease"] = (count == 2) & bent & sure & across
    return ends, first // 3, may, must, one_sided[1][edge].reshape(triangles.shape)
