"""Proves a drawing from its certificate: ``python check_certificate.py drawing.json certificate.json``.

All is taken into the image: x and y in mm on the page and a height z towards the eye, in which lines and planes stay
what they are and sight lines run along -z. What a triangle hides there is convex: a segment is hidden by it if both its
ends are, and clear if no triangle hides a part of it. Proved is, but for strips of width_mm beside outlines of what is
in front and for parts shorter than size_mm: each visible stroke is on a line of its kind, and clear; each hidden one is
behind what is named; each contour, crease and border that it says it has is drawn, or behind what is named. The rest is
"not proven". The exit status: 0 all is proved, 1 something is wrong, 2 something is not proven, 3 bad files.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]
Rows = TypeVar("Rows", bound="Segments | Parts")

if __package__:
    from .certified_shapes import LEAST, MOST_CELLS, OFF, SEAM_MM, STRICT_MM
    from .certified_shapes import contour_cells, deviations, edges_of, net_of, patch_of, welded
else:
    sys.path.insert(0, str(Path(__file__).parent))
    from certified_shapes import LEAST, MOST_CELLS, OFF, SEAM_MM, STRICT_MM
    from certified_shapes import contour_cells, deviations, edges_of, net_of, patch_of, welded

FORMATS = ("vectorplot-drawing", "vectorplot-certificate")
EDGE_KINDS = ("contour", "boundary", "crease")
FACE_KINDS = ("intersection", "pattern", "section", "isophote", "parameter", "integral")
BLOCK, PAIRS = 64, 1 << 17
"""Segments that are compared with all others at once, and pairs that are held at once: all arrays are below 100 MB."""
OUTSIDE, DEEP = 3.0, 40.0
"""Times the slack: so far outside of a contour one looks whether it is visible; strokes are so much off in depth."""
Fault = tuple[str, "Segments", "Parts", int]
"""What is wrong, where, and whether what smooth shapes hide may explain it."""


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


class Triangles(NamedTuple):
    """Triangles in the image: corners (t,3,3); halves (t,4,4): x, y, z, 1 times them are mm inside of each side, and mm
    behind; outline (t,3): where the image of the surface ends; hiding (h,): all that hide and are no narrow strips; off,
    slack (t,): mm that each is off its surface, and that are left open beside it."""

    corners: Floats
    halves: Floats
    outline: Bools
    hiding: Ints
    off: Floats
    slack: Floats


class Model(NamedTuple):
    """A drawing and the shapes of its certificate in the image. strokes: its segments, those on surfaces as pieces of
    these; whole: as they are drawn; bare: parts that should be on surfaces, and are not; lifted (m,): strokes on them; proved (s,): segments of strokes to prove, without tiny
    ones; kind, hidden (m,): of each stroke; sides: edges of shapes; ends (e,2): their vertices; may: which of them each
    kind may show; wanted (w,): those that are drawn or hidden; cells (c,9): where contours of surfaces are, see
    contour_cells; drawn (c,): whether they have to be; shift (p,): mm that points are off their places; off: mm that
    rounding may do; smooth: something hides that is not certified; coarse: what is wrong with nets, a few words each."""

    strokes: Segments
    whole: Segments
    bare: Parts
    lifted: Bools
    proved: Bools
    kind: NDArray[np.str_]
    hidden: Bools
    sides: Segments
    ends: Ints
    may: dict[str, Bools]
    wanted: Ints
    of: Triangles
    cells: Floats
    drawn: Ints
    shift: Floats
    off: float
    smooth: bool
    coarse: list[str]


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
    middle, columns = 0.5 * (low[:, :2] + high[:, :2]), [np.ascontiguousarray(one.T) for one in (others_low, others_high)]
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
    """Parts of segments that are within a share of the slack of others; depth: how much heights count, on the page 0."""
    start, end, one, two = (side * [1.0, 1.0, depth] for side in (*lines[:2], *others[:2]))
    length = np.linalg.norm(two - one, axis=1)
    unit = (two - one) / np.maximum(length, LEAST)[:, None]
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


def stacked(lists: list[Any], columns: int) -> tuple[Floats, Ints]:
    """The rows of all lists as (n,columns), and how many each has. Errors: ValueError for what is not finite."""
    rows = np.array([row for one in lists for row in one], dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(rows).all():
        raise ValueError("a number is not finite")
    return rows, np.array([len(one) for one in lists], dtype=np.intp)


def named_parts(table: Floats, names: Ints) -> tuple[Parts, Ints]:
    """Those of some rows (two numbers that name a segment, from, to, by what) on segments with the names (n,2), in
    rising order; and which rows."""
    base = float(max(names.max(initial=0), table[:, :2].max(initial=0))) + 1.0
    keys, key = np.append(names[:, 0] * base + names[:, 1], np.inf), table[:, 0] * base + table[:, 1]
    line = np.searchsorted(keys, key)
    kept = np.flatnonzero(keys[line] == key)
    return Parts(line[kept], table[kept, 2], table[kept, 3], table[kept, 4].astype(np.intp)), kept


def places_of(lines: Segments) -> Ints:
    """(n,2) the numbers of strokes, in rising order, and of the segments in each."""
    return np.stack([lines.owner, np.arange(len(lines.owner)) - np.searchsorted(lines.owner, lines.owner)], axis=1)


def on_surfaces(lines: Segments, rows: Any, kinds: Any, patches: Any, items: Any, view: Floats) -> tuple[Segments, Parts]:
    """Straight pieces, which follow surfaces, of segments that do, parameter lines and sections those of their item; and
    what parts these are. rows: the number of a segment (2), from, to, which surface, u and v at both ends (4)."""
    table, slack = stacked([rows], 9)[0], float(lines.slack.max(initial=0.0))
    parts, kept = named_parts(table, places_of(lines))
    ends, right, start, end = table[kept, 5:], np.zeros(len(kept), dtype=np.bool_), *np.zeros((2, len(kept), 3))
    for number, (item, surface) in enumerate(patches):
        own = np.flatnonzero(parts.by == number)
        (u, v), word = ends[own].reshape(-1, 2, 2).transpose(2, 0, 1), kinds[lines.owner[parts.line[own]]]
        cells = np.hstack([np.sort(u, axis=1), np.sort(v, axis=1)])
        inside = (cells[:, ::2] >= [surface.u[0], surface.v[0]]) & (cells[:, 1::2] <= [surface.u[-1], surface.v[-1]])
        near = deviations(surface, view, cells).sum(axis=1) <= OFF * slack
        points = surface.points(u, v)
        image = placed(view, points)
        start[own], end[own] = image.swapaxes(0, 1)
        along = ~np.isin(word, ["parameter", "section"])
        for axis, values in enumerate(items[item]["parameters"]):
            nearest = np.array([*values, np.inf])[np.abs(np.subtract.outer(ends[own, axis], [*values, 1e300])).argmin(axis=1)]
            there = surface.points(*(nearest[:, None] + 0.0 * u, v) if axis == 0 else (u, nearest[:, None] + 0.0 * v))
            along |= (word == "parameter") & (np.abs(placed(view, there) - image) <= slack).all(axis=(1, 2))
        for *normal, offset in items[item]["planes"]:
            above = (points * normal).sum(axis=-1) - offset
            there = points - above[..., None] * np.array(normal) / max(float(np.square(normal).sum()), LEAST)
            along |= (word == "section") & (np.abs(placed(view, there) - image) <= slack).all(axis=(1, 2))
        right[own] = near & along & inside.all(axis=1) & np.isfinite(start[own] + end[own]).all(axis=1)
    for share, at, tip in ((parts.low, start, 0.0), (parts.high, end, 1.0)):
        way = at - lines.at(parts.line, share)
        right &= (np.hypot(*way.T[:2]) <= slack) & ((share != tip) | (np.abs(way[:, 2]) <= DEEP * slack))
    order = np.lexsort((parts.low, parts.line))
    order = order[right[order]]
    pieces = Segments(start, end, lines.owner[parts.line], np.full(len(kept), slack))
    return take(pieces, order), take(parts, order)


def placed(view: Floats, points: Floats) -> Floats:
    """(...,3) the image of points (...,3) in the world."""
    with np.errstate(all="ignore"):
        return image_of(view, points.reshape(-1, 3))[0].reshape(points.shape)


def model_of(drawing: Any, certificate: Any) -> Model:
    """The two in the image. Errors: ValueError, KeyError, TypeError or IndexError for what is neither."""
    if [(one["format"], one["version"]) for one in (drawing, certificate)] != [(name, 1) for name in FORMATS]:
        raise ValueError(f"expected files of the formats {' and '.join(FORMATS)}, version 1")
    items, rows = certificate["items"], drawing["strokes"]
    width, fine = (float(certificate[key]) for key in ("width_mm", "smooth_mm"))
    (world, vertices), (corners, faces) = (stacked([one[key] for one in items], 3) for key in ("vertices", "triangles"))
    item = np.repeat(np.arange(len(items)), faces)
    triangles, patch = corners.astype(np.intp), np.full(len(corners), -1)
    if ((triangles < 0) | (triangles >= vertices[item][:, None])).any():
        raise ValueError("a triangle has a vertex that there is not")
    triangles += (np.cumsum(vertices) - vertices)[item][:, None]
    patches = [(number, patch_of(row)) for number, one in enumerate(items) for row in one["surfaces"]]
    for number, (owner, surface) in enumerate(patches):
        points, more = net_of(surface)
        triangles, world = np.concatenate([triangles, more + len(world)]), np.concatenate([world, points])
        item, patch = (np.append(one, np.full(len(more), k)) for one, k in ((item, owner), (patch, number)))
    if len(triangles) > 4 * MOST_CELLS:
        raise ValueError("the nets have too many cells")
    # A closed stroke ends in its first point.
    ways = ([[*row[key], *row[key][: row["closed"]]] for row in rows] for key in ("points", "points3d"))
    (page, many), (space, again) = (stacked(way, columns) for way, columns in zip(ways, (2, 3), strict=True))
    if not np.array_equal(many, again) or not many.all():
        raise ValueError("points and points3d of a stroke differ")
    view = image_rows(stacked([drawing["page_from_world"]], 4)[0], world)
    image, off = image_of(view, np.concatenate([world, space]))
    image, points = image[: len(world)], image[len(world) :]
    stroke = np.repeat(np.arange(len(rows)), many)
    begin = np.flatnonzero(stroke[:-1] == stroke[1:])
    strokes = Segments(points[begin], points[begin + 1], stroke[begin], np.full(len(begin), fine if patches else width))
    if patches:
        same = welded(image)[triangles]
        kept = (patch < 0) | (same != np.roll(same, 1, axis=1)).all(axis=1)
        triangles, item, patch = np.where(patch[:, None] < 0, triangles, same)[kept], item[kept], patch[kept]
    open_ = fine if patches else width
    slack, nets, cells, drawn, coarse = np.full(len(patch), open_), np.zeros(len(patch)), [], [], list[str]()
    for number, (owner, surface) in enumerate(patches):
        name, off_net = items[owner]["name"], float(deviations(surface, view, surface.grid()).sum(axis=1).max())
        found, every = contour_cells(surface, view, fine)
        nets[patch == number] = off_net
        cells.append(found)
        drawn.append(np.full(len(found), owner if "contour" in items[owner]["lines"] else -1))
        coarse += [f"what {name} shows and hides: its net may be {off_net:.2g} mm off"] * (not off_net <= OFF * fine)
        coarse += [f"that contours of {name} are complete: too many cells"] * (not every)
    ends, at, may, must, outline = edges_of(
        world, image, triangles, certificate["crease_angle_deg"], 0.01 * width, patch
    )
    sides = Segments(image[ends[:, 0]], image[ends[:, 1]], np.arange(len(ends)), slack[at])
    has = {word: np.array([word in one["lines"] for one in items], dtype=np.bool_)[item[at]] for word in EDGE_KINDS}
    wanted = np.logical_or.reduce([must[word] & has[word] for word in EDGE_KINDS]) & (sides.length > 4.0 * width)
    placed, hides = image[triangles], np.array([one["hides"] for one in items], dtype=np.bool_)[item]
    area = np.abs(np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])[:, 2])
    broad = area > 0.02 * width * np.ptp(placed[..., :2], axis=1).max(axis=1, initial=0.0)
    of = Triangles(placed, halves_of(placed), outline, np.flatnonzero(hides & broad), nets, slack)
    kind, hidden, names = (np.array([row[key] for row in rows]) for key in ("kind", "hidden_by", "item"))
    smooth = {one["name"]: bool(one["surfaces"]) for one in items if one["smooth"]}
    of_kind = np.isin(kind, [*may, *FACE_KINDS])[strokes.owner] & (strokes.length > 4.0 * width)
    on = np.isin(names, [name for name, certified in smooth.items() if certified])
    lifted = on[strokes.owner]
    pieces, told = on_surfaces(strokes, certificate["on_surfaces"], kind, patches, items, view)
    pieces = take(pieces, lifted[told.line])
    bare = gaps(told, strokes.least(ratio_of(certificate)))
    bare = take(bare, (lifted & of_kind)[bare.line])
    every = Segments(*map(np.concatenate, zip(take(strokes, ~lifted), pieces, strict=True)))
    every = take(every, np.argsort(every.owner, kind="stable"))
    proved = np.isin(kind, [*may, *FACE_KINDS])[every.owner] & (every.length > 4.0 * width)
    proved &= ~np.isin(names, [name for name, certified in smooth.items() if not certified])[every.owner]
    shift = np.asarray(np.hypot(*(page - points[:, :2]).T))
    rest = shift, off, any(one["smooth"] and one["hides"] and not one["surfaces"] for one in items), coarse
    where = np.concatenate([np.zeros((0, 9)), *cells]), np.concatenate([np.zeros(0, dtype=np.intp), *drawn])
    return Model(every, strokes, bare, on, proved, kind, hidden > 0, sides, ends, may, np.flatnonzero(wanted), of, *where, *rest)


def check(drawing: Any, certificate: Any) -> tuple[list[str], list[str], dict[str, int]]:
    """What is wrong with a drawing, and what is not proven, a line each, and how much was compared; both are given as
    they are read from JSON. Errors: see model_of."""
    wrong, unproven, model = list[str](), list[str](certificate["not_certified"]), model_of(drawing, certificate)
    if drawing["page_from_world"] != certificate["page_from_world"]:
        wrong.append("the drawing is seen by another camera than the certificate")
    seen = np.isfinite(model.shift).all() and np.isfinite(model.of.corners).all()
    if not seen or model.off > SEAM_MM:
        why = f"rounding moves points by {model.off:.2g} mm" if seen else "the scene reaches behind the eye"
        return wrong, [*unproven, f"anything: {why}"], {}
    unproven += model.coarse
    if (model.shift > certificate["width_mm"]).any():
        wrong.append(f"points of strokes are up to {model.shift.max():.4g} mm off their places in space")
    only = {*model.kind[np.flatnonzero(model.lifted)].tolist()} & {"isophote", "integral", "pattern", "intersection"}
    unproven += [f"that each {word} stroke on a surface, where it is, is one" for word in sorted(only)]
    unproven += [f"strokes of the kind {word}" for word in sorted({*model.kind.tolist()} - {*model.may, *FACE_KINDS})]
    faults = (faults(model, certificate) for faults in (check_places, check_sight, check_missing, check_contours))
    for what, lines, parts, open_ in (fault for some in faults for fault in some if len(fault[2].line)):
        mm = (parts.high - parts.low) * lines.length[parts.line]
        # On surfaces lines are in short pieces, and contours in cells: what is shorter all in all is not looked at.
        total = np.bincount(lines.owner[parts.line], mm)[lines.owner[parts.line]]
        long = (total > ratio_of(certificate) * lines.slack[parts.line]) | (lines.slack[parts.line] < certificate["smooth_mm"])
        if not long.any():
            continue
        parts, mm = take(parts, long), mm[long]
        worst = take(parts, [int(np.argmax(mm))])
        (x, y, _), (u, v, _) = (lines.at(worst.line, share)[0] for share in (worst.low, worst.high))
        where = f"{lines.owner[worst.line[0]]}, for {mm.max():.4g} mm, from ({x:.4f}, {y:.4f}) to ({u:.4f}, {v:.4f}) mm"
        (unproven if open_ > 1 or open_ and model.smooth else wrong).append(f"{what} {len(mm)} times, the longest: number {where}")
    counts = {"strokes": len(model.kind), "triangles": len(model.of.halves), "lines": len(model.wanted)}
    return (
        wrong,
        unproven,
        {**counts, "witnesses": len(certificate["hidden_strokes"]) + len(certificate["hidden_lines"])},
    )


def check_places(model: Model, certificate: Any) -> Iterator[Fault]:
    """Strokes are on lines of their kind, and drawn once."""
    ratio, fine, long = ratio_of(certificate), certificate["smooth_mm"], take(model.strokes, model.proved)
    yield "on no surface, or no such line of it, of stroke", model.whole, model.bare, 0
    for word in np.unique(model.kind[long.owner]).tolist():
        own = take(long, (model.kind[long.owner] == word) & (~model.lifted[long.owner] | np.isin(word, EDGE_KINDS)))
        mesh = take(model.sides, model.may[word]) if word in model.may else None
        on = [*(lying_parts(own, model.of) if mesh is None else parts_along(own, mesh, 1.0, 1.0 / ratio))]
        on += parts_near(own, model.cells, fine, DEEP * fine) if word == "contour" else []
        yield f"{word} where there is none, of stroke", own, gaps(joined(on), own.least(ratio)), False
    twice = joined(parts_along(long, long, 0.1, 1.0))
    again = (twice.by < twice.line) & (twice.high - twice.low > long.least(ratio)[twice.line])
    again &= (long.slack[twice.line] < fine) | (long.owner[twice.line] != long.owner[twice.by])
    again &= model.kind[long.owner[twice.line]] == model.kind[long.owner[twice.by]]
    yield "drawn twice, of stroke", long, take(twice, again), 0


def check_sight(model: Model, certificate: Any) -> Iterator[Fault]:
    """What is drawn as visible is, and what is drawn as hidden is behind what is named."""
    ratio, behind = ratio_of(certificate), model.hidden[model.strokes.owner]
    seen = take(model.strokes, model.proved & ~behind)
    parts = united(joined(hidden_parts(seen, model.of, 1.0)), seen.least(ratio))
    parts = take(parts, parts.high - parts.low > seen.least(ratio)[parts.line])
    yield "visible, but hidden, of stroke", seen, parts, False
    told = named_parts(stacked([certificate["hidden_strokes"]], 5)[0], places_of(model.strokes))[0]
    dark, away = model.proved & behind, hidden_by(model.strokes, told, model.of)
    left = gaps(away, model.strokes.least(ratio))
    # In the strips beside outlines lines may be hidden or not: there is no proof.
    every = take(model.strokes, dark)
    strips = joined([*hidden_parts(every, model.of, -1.0), *parts_near(every, model.cells, certificate["smooth_mm"])])
    strips = take(strips._replace(line=np.flatnonzero(dark)[strips.line]), every.slack[strips.line] > certificate["width_mm"])
    left = gaps(joined([away, strips]), model.strokes.least(ratio))
    yield "hidden by nothing that is named, of stroke", model.strokes, take(left, dark[left.line]), True


def check_missing(model: Model, certificate: Any) -> Iterator[Fault]:
    """Lines of meshes are drawn, or hidden by what is named; hidden ones, if any is drawn, but for gaps of dashes."""
    lines, ratio = take(model.sides, model.wanted), ratio_of(certificate)
    away = hidden_by(lines, named_parts(stacked([certificate["hidden_lines"]], 5)[0], model.ends[model.wanted])[0], model.of)
    visible, window = take(model.strokes, ~model.hidden[model.strokes.owner]), stacked([certificate["window_mm"]], 2)[0]
    ends = (np.hstack([side[:, :2] - window[0], window[1] - side[:, :2]]) for side in lines[:2])
    outside = gaps(clipped(every := np.arange(len(model.wanted)), every, *ends), np.zeros(len(every)))
    there = joined([*parts_along(lines, visible, 1.0, 0.0), away, outside])
    yield "neither drawn nor hidden, of edge", lines, gaps(there, lines.least(ratio)), True
    if (gap := certificate["hidden_gap_mm"]) is not None:
        there = joined([*parts_along(lines, model.strokes, 1.0, 0.0), outside])
        shortest = lines.least(ratio) + gap / np.maximum(lines.length, LEAST)
        yield "hidden lines are drawn, but not, of edge", lines, gaps(there, shortest), True


def check_contours(model: Model, certificate: Any) -> Iterator[Fault]:
    """Contours of surfaces are drawn, or hidden; nothing is, that close to their ends, where they may be either."""
    fine, window = certificate["smooth_mm"], stacked([certificate["window_mm"]], 2)[0]
    within = ((model.cells[:, :2] > window[0] + fine) & (model.cells[:, :2] < window[1] - fine)).all(axis=1)
    within &= model.drawn >= 0
    cells = model.cells[within]
    slack, every = np.full(len(cells), fine), np.arange(len(cells))
    place, beyond = cells[:, :3], cells[:, :3] + OUTSIDE * fine * np.hstack([cells[:, 6:8], 0.0 * cells[:, :1]])
    lines = Segments(place - cells[:, 3:6], place + cells[:, 3:6], model.drawn[within], slack)
    visible = take(model.strokes, ~model.hidden[model.strokes.owner])
    left = np.ones(len(cells), dtype=np.bool_)
    left[joined(parts_near(visible, cells, fine)).by] = False
    left[joined(hidden_parts(Segments(place, place, every, slack), model.of, 0.0)).line] = False
    maybe = np.zeros(len(cells), dtype=np.bool_)
    maybe[joined(hidden_parts(Segments(beyond, beyond, every, slack), model.of, -1.0)).line] = True
    parts, sure = Parts(every, 0.0 * slack, 0.0 * slack + 1.0, every), cells[:, 8] > 0.0
    left &= reaches(place, left, ratio_of(certificate) * fine)
    yield "contour neither drawn nor hidden, of item", lines, take(parts, left & ~maybe & sure), False
    yield "contour that may be left out, of item", lines, take(parts, left & ~maybe & ~sure), 2
    yield "contour beside outlines, drawn or hidden, of item", lines, take(parts, left & maybe), 2
    if (gap := certificate["hidden_gap_mm"]) is not None:
        bare = sure.copy()
        bare[joined(parts_near(model.strokes, cells, fine + gap)).by] = False
        bare &= reaches(place, bare, ratio_of(certificate) * fine + gap)
        yield "hidden contours are drawn, but not, of item", lines, take(parts, bare), False


def reaches(place: Floats, which: Bools, size: float) -> Bools:
    """(n,) which of some points have another one between half so far and so far on the page: not those of tiny ovals."""
    points, number, found = place[which], np.flatnonzero(which), np.zeros(len(place), dtype=np.bool_)
    room = np.array([size, size, np.inf])
    for one, other in near(points, points, points - room, points + room):
        found[number[one[np.hypot(*(points[one] - points[other]).T[:2]) > 0.5 * size]]] = True
    return found


def ratio_of(certificate: Any) -> float:
    """Parts that are not looked at are so many times as long as what is left open is wide."""
    return float(certificate["size_mm"] / certificate["width_mm"])


def main(names: list[str]) -> int:
    """Say what is wrong and what is not proven of a drawing; the exit status."""
    try:
        wrong, unproven, counts = check(*(json.loads(Path(name).read_bytes()) for name in names))
    except (OSError, ValueError, KeyError, TypeError, IndexError, RecursionError) as error:
        sys.stderr.write(f"cannot check: {type(error).__name__}: {error}; expected drawing.json certificate.json\n")
        return 3
    told = [*(f"wrong: {line}" for line in wrong), *(f"not proven: {line}" for line in unproven)]
    told.append(", ".join(f"{number} {name}" for name, number in counts.items()))
    sys.stdout.write("\n".join(told) + "\n")
    return 1 if wrong else 2 if unproven else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
