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

FORMATS = ("vectorplot-drawing", "vectorplot-certificate")
EDGE_KINDS = ("contour", "boundary", "crease")
FACE_KINDS = ("intersection", "pattern", "section", "isophote")
BLOCK, PAIRS = 64, 1 << 17
"""Segments that are compared with all others at once, and pairs that are held at once: all arrays are below 100 MB."""
STRICT_MM, SEAM_MM, ANGLE_DEG, LEAST = 1e-6, 1e-8, 1e-3, 1e-300
"""What is no farther behind a face is not hidden by it; faces hide so far beyond sides they share, and rounding moves
points less; edges that turn by the crease angle, but for so much, may be drawn or not; the least divisor."""
Fault = tuple[str, "Segments", "Parts", bool]
"""What is wrong, where, and whether what smooth shapes hide may explain it."""


class Segments(NamedTuple):
    """Segments in the image: ends (n,3), and of which stroke or edge each is a part, from 0."""

    start: Floats
    end: Floats
    owner: Ints

    def at(self, which: Ints, share: Floats) -> Floats:
        """(k,3) points of them."""
        return self.start[which] + share[:, None] * (self.end[which] - self.start[which])

    def least(self, mm: float) -> Floats:
        """(n,) the part of each that is so many mm long, but half of one that is short."""
        return np.minimum(mm / np.maximum(self.length, LEAST), 0.5)

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
    behind; outline (t,3): where the image of the surface ends; hiding (h,): all that hide and are no narrow strips."""

    corners: Floats
    halves: Floats
    outline: Bools
    hiding: Ints


class Model(NamedTuple):
    """A drawing and the meshes of its certificate in the image. proved (s,): segments of strokes to prove, without tiny
    ones; kind, hidden (m,): of each stroke; sides: edges of meshes; ends (e,2): their vertices; may: which of them each
    kind may show; wanted (w,): those that are drawn or hidden; shift (p,): mm that points are off their places; off: mm
    that rounding may do; smooth: something hides that is no mesh."""

    strokes: Segments
    proved: Bools
    kind: NDArray[np.str_]
    hidden: Bools
    sides: Segments
    ends: Ints
    may: dict[str, Bools]
    wanted: Ints
    of: Triangles
    shift: Floats
    off: float
    smooth: bool


def times(matrix: Floats, points: Floats) -> Floats:
    """(n,r) points (n,3), to which 1 is added, by a matrix (r,4)."""
    return np.asarray((points[:, None, :] * matrix[None, :, :3]).sum(axis=2) + matrix[:, 3])


def image_of(matrix: Floats, points: Floats, anchor: Floats) -> tuple[Floats, float]:
    """(n,3) the image of points in the world, NaN for those behind the eye, and by how many mm rounding moves it at
    most. anchor (m,3): points in the middle of which heights are as long as what stands across the sight line."""
    x, y, _, last = matrix
    far = float(np.sqrt((last[:3] ** 2).sum()))
    # Planes stay planes where heights are as 1 / w, w being the depth; or along the sight lines, if they are parallel.
    rows = np.array([x, y, [*np.cross(x[:3], y[:3]) / np.sqrt((x[:3] ** 2).sum()), 0.0], last])
    if far > 0.0:
        across = x[:3] - (x[:3] * last[:3]).sum() / far**2 * last[:3]
        middle = np.median(times(last[None], anchor)) if len(anchor) else 1.0
        rows[2] = [0.0, 0.0, 0.0, np.sqrt((across**2).sum()) * middle / far]
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


def edges_of(world: Floats, image: Floats, triangles: Ints, angle_deg: float, doubt: float) -> tuple[Any, ...]:
    """The edges: their vertices (e,2); a triangle at each (e,); by kind, whether they may and must be drawn as such;
    (t,3) at which sides of triangles the image of the surface ends, without a triangle on the other side. doubt: mm
    within which a triangle may be on either side."""
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
    may = {"contour": (count > 1) & one_sided[0], "boundary": count == 1, "edges": count > 0}
    may["crease"] = (count > 2) | (count == 2) & ((turn > angle_deg - ANGLE_DEG) | ~sure)
    must = {"contour": (count > 1) & one_sided[1] & facing, "boundary": count == 1}
    must["crease"] = (count == 2) & (turn > angle_deg + ANGLE_DEG) & sure
    return ends, first // 3, may, must, one_sided[1][edge].reshape(triangles.shape)


def near(start: Floats, end: Floats, others_low: Floats, others_high: Floats) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of segments and boxes (m,3) that these may reach, in chunks: some neighbours at once against all boxes."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    middle = 0.5 * (low[:, :2] + high[:, :2])
    order = np.lexsort((middle[:, 1], *np.floor(middle * 32.0 / np.abs(middle).max(initial=LEAST)).T))
    for own in (order[begin : begin + BLOCK] for begin in range(0, len(order), BLOCK)):
        over, under = others_high >= low[own].min(axis=0), others_low <= high[own].max(axis=0)
        other = np.flatnonzero((over & under).all(axis=1))
        rows = max(1, PAIRS // max(len(other), 1))
        for part in (own[k : k + rows] for k in range(0, len(own), rows)):
            hit = [others_high[other, axis] >= low[part, axis, None] for axis in range(3)]
            hit += [others_low[other, axis] <= high[part, axis, None] for axis in range(3)]
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


def hidden_parts(lines: Segments, of: Triangles, beside: float, depth: float) -> Iterator[Parts]:
    """Parts of segments that some triangle hides, more than depth before them, and so far inside of its outline."""
    low, high = of.corners[of.hiding].min(axis=1), of.corners[of.hiding].max(axis=1)
    low[:, 2] = -np.inf
    for line, number in near(*lines[:2], low, high):
        by = of.hiding[number]
        margin = np.concatenate([np.where(of.outline[by], beside, -SEAM_MM), np.full((len(by), 1), depth)], axis=1)
        yield clipped(line, by, *(inside(side[line], of, by) - margin for side in lines[:2]))


def lying_parts(lines: Segments, of: Triangles, tolerance: float) -> Iterator[Parts]:
    """Parts of segments that lie in triangles, within a tolerance."""
    for line, by in near(*lines[:2], of.corners.min(axis=1) - tolerance, of.corners.max(axis=1) + tolerance):
        ends = (inside(side[line], of, by) for side in lines[:2])
        yield clipped(line, by, *(np.concatenate([rows, -rows[:, 3:]], axis=1) + tolerance for rows in ends))


def parts_along(lines: Segments, others: Segments, tolerance: float, depth: float) -> Iterator[Parts]:
    """Parts of segments that are within a tolerance of other ones; depth: how much heights count, on the page 0."""
    start, end, one, two = (side * [1.0, 1.0, depth] for side in (*lines[:2], *others[:2]))
    length = np.linalg.norm(two - one, axis=1)
    unit = (two - one) / np.maximum(length, LEAST)[:, None]
    across = np.cross(unit, np.eye(3)[np.abs(unit).argmin(axis=1)])
    across /= np.maximum(np.linalg.norm(across, axis=1), LEAST)[:, None]
    frame = np.stack([unit, across, np.cross(unit, across)], axis=1)
    for line, by in near(start, end, np.minimum(one, two) - tolerance, np.maximum(one, two) + tolerance):
        room = length[by, None] * [1.0, 0.0, 0.0] + tolerance
        places = [(frame[by] * (side[line] - one[by])[:, None]).sum(axis=2) for side in (start, end)]
        yield clipped(line, by, *(np.concatenate([place + tolerance, room - place], axis=1) for place in places))


def hidden_by(lines: Segments, parts: Parts, of: Triangles) -> Parts:
    """Those parts of segments that are hidden by the triangles that are named: both of their ends are."""
    parts = take(parts, np.isin(parts.by, of.hiding) & (0.0 <= parts.low) & (parts.high <= 1.0))
    inner = np.minimum(*(inside(lines.at(parts.line, share), of, parts.by) for share in parts[1:3]))
    return take(parts, (inner >= [-STRICT_MM, -STRICT_MM, -STRICT_MM, STRICT_MM]).all(axis=1))


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


def named_parts(rows: Any, names: Ints) -> Parts:
    """The rows (two numbers that name a segment, from, to, triangle) on those with the names (n,2), in rising order."""
    table = stacked([rows], 5)[0]
    base = float(max(names.max(initial=0), table[:, :2].max(initial=0))) + 1.0
    keys, key = np.append(names[:, 0] * base + names[:, 1], np.inf), table[:, 0] * base + table[:, 1]
    parts = Parts(np.searchsorted(keys, key), table[:, 2], table[:, 3], table[:, 4].astype(np.intp))
    return take(parts, keys[parts.line] == key)


def model_of(drawing: Any, certificate: Any) -> Model:
    """The two in the image. Errors: ValueError, KeyError, TypeError or IndexError for what is neither."""
    if [(one["format"], one["version"]) for one in (drawing, certificate)] != [(name, 1) for name in FORMATS]:
        raise ValueError(f"expected files of the formats {' and '.join(FORMATS)}, version 1")
    items, rows, width = certificate["items"], drawing["strokes"], certificate["width_mm"]
    (world, vertices), (corners, faces) = (stacked([one[key] for one in items], 3) for key in ("vertices", "triangles"))
    triangles, item = corners.astype(np.intp), np.repeat(np.arange(len(items)), faces)
    if ((triangles < 0) | (triangles >= vertices[item][:, None])).any():
        raise ValueError("a triangle has a vertex that there is not")
    triangles += (np.cumsum(vertices) - vertices)[item][:, None]
    # A closed stroke ends in its first point.
    ways = ([[*row[key], *row[key][: row["closed"]]] for row in rows] for key in ("points", "points3d"))
    (page, many), (space, again) = (stacked(way, columns) for way, columns in zip(ways, (2, 3), strict=True))
    if not np.array_equal(many, again) or not many.all():
        raise ValueError("points and points3d of a stroke differ")
    image, off = image_of(stacked([drawing["page_from_world"]], 4)[0], np.concatenate([world, space]), world)
    image, points = image[: len(world)], image[len(world) :]
    ends, at, may, must, outline = edges_of(world, image, triangles, certificate["crease_angle_deg"], 0.01 * width)
    sides = Segments(image[ends[:, 0]], image[ends[:, 1]], np.arange(len(ends)))
    has = {word: np.array([word in one["lines"] for one in items], dtype=np.bool_)[item[at]] for word in EDGE_KINDS}
    wanted = np.logical_or.reduce([must[word] & has[word] for word in EDGE_KINDS]) & (sides.length > 4.0 * width)
    placed, hides = image[triangles], np.array([one["hides"] for one in items], dtype=np.bool_)[item]
    area = np.abs(np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])[:, 2])
    broad = area > 0.02 * width * np.ptp(placed[..., :2], axis=1).max(axis=1, initial=0.0)
    of = Triangles(placed, halves_of(placed), outline, np.flatnonzero(hides & broad))
    stroke = np.repeat(np.arange(len(rows)), many)
    begin = np.flatnonzero(stroke[:-1] == stroke[1:])
    kind, hidden = (np.array([row[key] for row in rows]) for key in ("kind", "hidden_by"))
    strokes = Segments(points[begin], points[begin + 1], stroke[begin])
    proved = np.isin(kind, [*may, *FACE_KINDS])[strokes.owner] & (strokes.length > 4.0 * width)
    smooth = [one["name"] for one in items if one["smooth"]]
    proved &= ~np.isin(np.array([row["item"] for row in rows], dtype=np.str_), smooth)[strokes.owner]
    shift = np.asarray(np.hypot(*(page - points[:, :2]).T))
    rest = shift, off, any(one["smooth"] and one["hides"] for one in items)
    return Model(strokes, proved, kind, hidden > 0, sides, ends, may, np.flatnonzero(wanted), of, *rest)


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
    if (model.shift > certificate["width_mm"]).any():
        wrong.append(f"points of strokes are up to {model.shift.max():.4g} mm off their places in space")
    unproven += [f"strokes of the kind {word}" for word in sorted({*model.kind.tolist()} - {*model.may, *FACE_KINDS})]
    faults = (faults(model, certificate) for faults in (check_places, check_sight, check_missing))
    for what, lines, parts, open_ in (fault for some in faults for fault in some if len(fault[2].line)):
        mm = (parts.high - parts.low) * lines.length[parts.line]
        worst = take(parts, [int(np.argmax(mm))])
        (x, y, _), (u, v, _) = (lines.at(worst.line, share)[0] for share in (worst.low, worst.high))
        where = f"{lines.owner[worst.line[0]]}, for {mm.max():.4g} mm, from ({x:.4f}, {y:.4f}) to ({u:.4f}, {v:.4f}) mm"
        (unproven if open_ and model.smooth else wrong).append(f"{what} {len(mm)} times, the longest: number {where}")
    counts = {"strokes": len(model.kind), "triangles": len(model.of.halves), "lines": len(model.wanted)}
    return (
        wrong,
        unproven,
        {**counts, "witnesses": len(certificate["hidden_strokes"]) + len(certificate["hidden_lines"])},
    )


def check_places(model: Model, certificate: Any) -> Iterator[Fault]:
    """Strokes are on lines of their kind, and drawn once."""
    width, size, long = certificate["width_mm"], certificate["size_mm"], take(model.strokes, model.proved)
    for word in np.unique(model.kind[long.owner]).tolist():
        own = take(long, model.kind[long.owner] == word)
        mesh = take(model.sides, model.may[word]) if word in model.may else None
        on = lying_parts(own, model.of, width) if mesh is None else parts_along(own, mesh, width, width / size)
        yield f"{word} where there is none, of stroke", own, gaps(joined(on), own.least(size)), False
    twice = joined(parts_along(long, long, 0.1 * width, 1.0))
    again = (twice.by < twice.line) & (twice.high - twice.low > long.least(size)[twice.line])
    yield "drawn twice, of stroke", long, take(twice, again), False


def check_sight(model: Model, certificate: Any) -> Iterator[Fault]:
    """What is drawn as visible is, and what is drawn as hidden is behind what is named."""
    width, size, behind = certificate["width_mm"], certificate["size_mm"], model.hidden[model.strokes.owner]
    seen = take(model.strokes, model.proved & ~behind)
    parts = united(joined(hidden_parts(seen, model.of, width, width)), seen.least(size))
    parts = take(parts, parts.high - parts.low > seen.least(size)[parts.line])
    yield "visible, but hidden, of stroke", seen, parts, False
    segment = np.arange(len(behind)) - np.searchsorted(model.strokes.owner, model.strokes.owner)
    told = named_parts(certificate["hidden_strokes"], np.stack([model.strokes.owner, segment], axis=1))
    left = gaps(hidden_by(model.strokes, told, model.of), model.strokes.least(size))
    left = take(left, (model.proved & behind)[left.line])
    yield "hidden by nothing that is named, of stroke", model.strokes, left, True


def check_missing(model: Model, certificate: Any) -> Iterator[Fault]:
    """Lines of meshes are drawn, or hidden by what is named; hidden ones, if any is drawn, but for gaps of dashes."""
    lines, width, size = take(model.sides, model.wanted), certificate["width_mm"], certificate["size_mm"]
    away = hidden_by(lines, named_parts(certificate["hidden_lines"], model.ends[model.wanted]), model.of)
    visible, window = take(model.strokes, ~model.hidden[model.strokes.owner]), stacked([certificate["window_mm"]], 2)[0]
    ends = (np.hstack([side[:, :2] - window[0], window[1] - side[:, :2]]) for side in lines[:2])
    outside = gaps(clipped(every := np.arange(len(model.wanted)), every, *ends), np.zeros(len(every)))
    there = joined([*parts_along(lines, visible, width, 0.0), away, outside])
    yield "neither drawn nor hidden, of edge", lines, gaps(there, lines.least(size)), True
    if (gap := certificate["hidden_gap_mm"]) is not None:
        there = joined([*parts_along(lines, model.strokes, width, 0.0), outside])
        shortest = lines.least(size) + gap / np.maximum(lines.length, LEAST)
        yield "hidden lines are drawn, but not, of edge", lines, gaps(there, shortest), True


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
