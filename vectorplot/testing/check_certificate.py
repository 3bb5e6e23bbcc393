"""Proves a drawing from its certificate: ``python check_certificate.py drawing.json certificate.json``.

It imports nothing of vectorplot. Everything is taken into the image: x and y in mm on the page, and a height z towards
the eye, in which straight lines and planes stay what they are and all sight lines run along -z. There a triangle hides
a convex set of points; so a segment that is said to be hidden by a triangle is hidden if both of its ends are, and a
segment is clear if no triangle, of all there are, hides a part of it.

What is proved, but for strips of width_mm beside the outlines of what is in front, and for parts shorter than size_mm:
every visible stroke lies on a line of its kind and nothing hides it; every hidden one is behind what is named; every
contour, crease and border of the kinds that the drawing says it has is drawn, or hidden by what is named.
What cannot be proved is listed as "not proven". The exit status is 0 where all is proved, 1 where something is wrong,
2 where something is left unproven, 3 where the files cannot be read.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]

BLOCK, PAIRS = 64, 1 << 17
"""Segments that are compared with all others at once, and pairs of which all numbers are held at once: under 100 MB."""
STRICT_MM = 1e-6
"""What is no farther behind a face is not hidden by it; what is no farther outside of it is not beside it."""
SEAM_MM = 1e-9
"""Faces that meet hide so far beyond the side they have in common; rounding must not move a point farther."""
ANGLE_DEG = 0.1
"""Edges whose faces turn by the crease angle, but for this, may be drawn or not."""
EDGE_KINDS, FACE_KINDS = (
    ("contour", "boundary", "crease"),
    ("intersection", "pattern", "section", "isophote", "integral"),
)
FORMATS = ("vectorplot-drawing", "vectorplot-certificate")


class Verdict(NamedTuple):
    """What is wrong, what is not proven, a line each; and how much was compared, by name."""

    wrong: list[str]
    unproven: list[str]
    counts: dict[str, int]


class Segments(NamedTuple):
    """Segments in the image: ends (n,3), and of which stroke, edge or arc each is a part, from 0."""

    start: Floats
    end: Floats
    owner: Ints

    def take(self, which: Any) -> Segments:
        """Some of them."""
        return Segments(self.start[which], self.end[which], self.owner[which])

    def at(self, which: Ints, share: Floats) -> Floats:
        """(k,3) points of them."""
        return self.start[which] + share[:, None] * (self.end[which] - self.start[which])

    @property
    def length(self) -> Floats:
        """(n,) in mm on the page."""
        return np.hypot(*(self.end - self.start).T[:2])


class Parts(NamedTuple):
    """Parts of segments: line (n,), from where to where, of 0 to 1; by (n,): what makes them parts."""

    line: Ints
    low: Floats
    high: Floats
    by: Ints

    def take(self, which: Any) -> Parts:
        """Some of them."""
        return Parts(*(column[which] for column in self))


class Triangles(NamedTuple):
    """Triangles in the image: corners (t,3,3); sides (t,3,3), by which x, y, 1 become mm inside of each side; planes
    (t,4), by which x, y, z, 1 become mm in front; outline (t,3): sides where the image of the surface ends; thin (t,):
    those that are seen edge-on, which hide nothing but a strip."""

    corners: Floats
    sides: Floats
    planes: Floats
    outline: Bools
    thin: Bools


# The image, and what is in it.


def times(matrix: Floats, points: Floats) -> Floats:
    """(n,r) points (n,c) or (n,c-1), to which 1 is added, by a matrix (r,c)."""
    inner = points.shape[1]
    found: Floats = (points[:, None, :] * matrix[None, :, :inner]).sum(axis=2)
    return found + matrix[:, -1] if matrix.shape[1] > inner else found


def image_of(matrix: Floats, points: Floats, anchor: Floats) -> tuple[Floats, float]:
    """(n,3) the image of points in the world, NaN for those behind the eye, and by how many mm rounding moves it at
    most. anchor (m,3): points in the middle of which heights are as long as what stands across the sight line."""
    x, y, _, last = matrix
    far = np.linalg.norm(last[:3])
    if far > 0.0:
        # Planes stay planes where heights are as 1 / w, w being the depth.
        middle = float(np.median(times(last[None], anchor))) if len(anchor) else 1.0
        across = x[:3] - (x[:3] * last[:3]).sum() / far**2 * last[:3]
        rows = np.array([x, y, [0.0, 0.0, 0.0, np.linalg.norm(across) * middle / far], last])
    else:
        rows = np.array([x, y, [*(np.cross(x[:3], y[:3]) / np.linalg.norm(x[:3])), 0.0], last])
    found, least = times(rows, points), times(np.abs(rows), np.abs(points))
    with np.errstate(all="ignore"):
        w = np.where(found[:, 3:] > 0.0, found[:, 3:], np.nan)
        image = found[:, :3] / w
        off = 5.0 * np.finfo(float).eps * (least[:, :3] + np.abs(image) * least[:, 3:]) / w
    return image, float(np.nan_to_num(off).max(initial=0.0))


def triangles_of(points: Floats, triangles: Ints, thinnest: float) -> Triangles:
    """The triangles (t,3) on points (v,3) of the image; those that are narrower than so many mm are thin."""
    corners = points[triangles]
    along = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(along[:, 0], along[:, 1])
    turn = np.where(normal[:, 2] >= 0.0, 1.0, -1.0)
    length = np.hypot(along[..., 0], along[..., 1])
    thin = ~(np.abs(normal[:, 2]) > thinnest * length.max(axis=1, initial=0.0))
    inward = (
        np.stack([-along[..., 1], along[..., 0]], axis=2)
        * (turn[:, None] / np.where(length > 0, length, 1.0))[..., None]
    )
    sides = np.concatenate([inward, -(inward * corners[..., :2]).sum(axis=2)[..., None]], axis=2)
    size = np.linalg.norm(normal, axis=1)
    up = normal * (turn / np.where(size > 0.0, size, 1.0))[:, None]
    planes = np.concatenate([up, -(up * corners[:, 0]).sum(axis=1)[:, None]], axis=1)
    return Triangles(corners, sides, planes, np.ones(triangles.shape, dtype=np.bool_), thin)


class Edges(NamedTuple):
    """The edges of all meshes: ends (e,2), vertices; item (e,); by kind what each may be drawn as, and what it must."""

    ends: Ints
    item: Ints
    may: dict[str, Bools]
    must: dict[str, Bools]


def edges_of(
    world: Floats, image: Floats, triangles: Ints, of: Triangles, item: Ints, angle_deg: float, doubt: float
) -> tuple[Edges, Bools]:
    """The edges, and (t,3) at which sides of triangles the image of the surface ends: no triangle is on the other side.
    item (t,); doubt: mm within which a triangle is on neither side."""
    one, two = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    key = np.minimum(one, two) * len(world) + np.maximum(one, two)
    keys, first, edge, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    ends = np.stack([keys // len(world), keys % len(world)], axis=1)
    apex, a, b = np.roll(triangles, 1, axis=1).ravel(), image[ends[edge, 0]], image[ends[edge, 1]]
    way = b - a
    arm = image[apex] - a
    length = np.hypot(way[:, 0], way[:, 1])
    beside = (way[:, 0] * arm[:, 1] - way[:, 1] * arm[:, 0]) / np.where(length > 0.0, length, 1.0)
    side = np.where((length > doubt) & ~np.repeat(of.thin, 3), np.sign(beside) * (np.abs(beside) > doubt), 0.0)
    left, right = (np.bincount(edge, weights=side == s, minlength=len(keys)) > 0 for s in (1.0, -1.0))
    # The directions in which faces leave an edge: two faces are flat where these are opposite.
    along = world[ends[edge, 1]] - world[ends[edge, 0]]
    along /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    leaving = world[apex] - world[ends[edge, 0]]
    leaving -= (leaving * along).sum(axis=1)[:, None] * along
    height = np.linalg.norm(leaving, axis=1)
    leaving /= np.maximum(height, 1e-300)[:, None]
    order = np.argsort(edge, kind="stable")
    start = np.searchsorted(edge[order], np.arange(len(keys)))
    pair = np.flatnonzero(count == 2)
    f, g = order[start[pair]], order[start[pair] + 1]
    turn = np.zeros(len(keys))
    turn[pair] = 180.0 - np.degrees(
        2.0 * np.arctan2(*(np.linalg.norm(leaving[f] + s * leaving[g], axis=1) for s in (-1.0, 1.0)))
    )
    flat = np.zeros(len(keys), dtype=np.bool_)
    flat[pair] = np.minimum(height[f], height[g]) > 1e-9 * np.abs(world).max(initial=0.0)
    contour = (count > 1) & ~(left & right)
    may = {"contour": contour, "boundary": count == 1, "edges": count > 0}
    may["crease"] = (count > 2) | ((count == 2) & ((turn > angle_deg - ANGLE_DEG) | ~flat))
    must = {"contour": contour & (left | right), "boundary": count == 1}
    must["crease"] = (count == 2) & (turn > angle_deg + ANGLE_DEG) & flat
    ends_here = ~(left & right)[edge].reshape(triangles.shape)
    return Edges(ends, item[first // 3], may, must), ends_here


# Pairs of segments and of what is near them, clipped.


def near(low: Floats, high: Floats, others_low: Floats, others_high: Floats) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of boxes (n,d) and others (m,d) that overlap, in chunks: neighbours at once against all others."""
    middle = 0.5 * (low[:, :2] + high[:, :2])
    cell = np.floor(middle * 32.0 / max(float(np.abs(middle).max(initial=0.0)), 1e-300))
    order = np.lexsort((middle[:, 1], cell[:, 1], cell[:, 0]))
    for begin in range(0, len(order), BLOCK):
        own = order[begin : begin + BLOCK]
        met = (others_high >= low[own].min(axis=0)).all(axis=1) & (others_low <= high[own].max(axis=0)).all(axis=1)
        other = np.flatnonzero(met)
        rows = max(1, PAIRS // max(len(other), 1))
        for part in (own[k : k + rows] for k in range(0, len(own), rows)):
            hit = np.ones((len(part), len(other)), dtype=np.bool_)
            for axis in range(low.shape[1]):
                hit &= others_high[None, other, axis] >= low[part, None, axis]
                hit &= others_low[None, other, axis] <= high[part, None, axis]
            a, b = np.nonzero(hit)
            if len(a):
                yield part[a], other[b]


def clipped(at_start: Floats, at_end: Floats) -> tuple[Floats, Floats]:
    """(n,) from where to where, of 0 to 1, all of the linear functions (n,k) are zero or more; low > high: nowhere."""
    with np.errstate(all="ignore"):
        root = at_start / (at_start - at_end)
    low = np.where(at_start < 0.0, np.where(at_end >= 0.0, root, 2.0), 0.0).max(axis=1)
    high = np.where(at_end < 0.0, np.where(at_start >= 0.0, root, -1.0), 1.0).min(axis=1)
    return low, high


def inside(points: Floats, of: Triangles, which: Ints, sides: Floats, depth: float) -> Floats:
    """(n,4) how far points are inside of the sides of triangles beyond margins (n,3), and more than depth behind."""
    rows = of.sides[which]
    within = rows[..., 0] * points[:, None, 0] + rows[..., 1] * points[:, None, 1] + rows[..., 2] - sides
    plane = of.planes[which]
    return np.concatenate([within, -((plane[:, :3] * points).sum(axis=1) + plane[:, 3])[:, None] - depth], axis=1)


def hidden_parts(lines: Segments, of: Triangles, some: Ints, beside: float, depth: float) -> Iterator[Parts]:
    """Parts of segments that are hidden by some triangles, more than depth behind and so far inside of outlines."""
    low, high = of.corners[some].min(axis=1), of.corners[some].max(axis=1)
    low[:, 2] = -np.inf
    inner = -SEAM_MM if beside > 0.0 else 0.0
    for line, number in near(np.minimum(lines.start, lines.end), np.maximum(lines.start, lines.end), low, high):
        number = some[number]
        margin = np.where(of.outline[number], beside, inner)
        a, b = clipped(*(inside(side[line], of, number, margin, depth) for side in (lines.start, lines.end)))
        yield Parts(line, a, b, number).take(b > a)


def lying_parts(lines: Segments, of: Triangles, tolerance: float) -> Iterator[Parts]:
    """Parts of segments that lie in triangles, within a tolerance."""
    low, high = of.corners.min(axis=1) - tolerance, of.corners.max(axis=1) + tolerance
    for line, number in near(np.minimum(lines.start, lines.end), np.maximum(lines.start, lines.end), low, high):
        margin = np.full((len(number), 3), -tolerance)
        ends = [inside(side[line], of, number, margin, -tolerance) for side in (lines.start, lines.end)]
        a, b = clipped(*(np.concatenate([rows, 2.0 * tolerance - rows[:, 3:]], axis=1) for rows in ends))
        yield Parts(line, a, b, number).take((b > a) & ~of.thin[number])


def behind(lines: Segments, parts: Parts, of: Triangles, hiding: Ints) -> Bools:
    """(n,) whether parts of segments are hidden by the triangles that are named: both of their ends are."""
    known = np.isin(parts.by, hiding) & (parts.low >= 0.0) & (parts.high <= 1.0)
    which = np.where(known, parts.by, 0)
    margin = np.full((len(which), 3), -STRICT_MM)
    for share in (parts.low, parts.high):
        if known.any():
            known &= (inside(lines.at(parts.line, share), of, which, margin, STRICT_MM) >= 0.0).all(axis=1)
    return known


def along(lines: Segments, others: Segments, tolerance: float, axes: int) -> Iterator[Parts]:
    """Parts of segments that are within a tolerance of other ones, on the page (axes: 2) or in the image (3)."""
    flat = np.arange(3) < axes
    others = Segments(np.where(flat, others.start, 0.0), np.where(flat, others.end, 0.0), others.owner)
    ends = tuple(np.where(flat, side, 0.0) for side in (lines.start, lines.end))
    way = others.end - others.start
    length = np.maximum(np.linalg.norm(way, axis=1), 1e-300)
    unit = way / length[:, None]
    across = np.cross(unit, np.eye(3)[np.full(len(unit), 2) if axes == 2 else np.abs(unit).argmin(axis=1)])
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    frame = np.stack([unit, across, np.cross(unit, across)], axis=1)
    low, high = np.minimum(others.start, others.end) - tolerance, np.maximum(others.start, others.end) + tolerance
    for line, number in near(np.minimum(*ends), np.maximum(*ends), low, high):
        places = [(frame[number] * (side[line] - others.start[number])[:, None]).sum(axis=2) for side in ends]
        most = np.stack([length[number], *np.zeros((2, len(number)))], axis=1) + tolerance
        least = np.stack([np.zeros((3, len(number)))], axis=2)[..., 0].T - tolerance
        a, b = clipped(*(np.concatenate([place - least, most - place], axis=1) for place in places))
        yield Parts(line, a, b, number).take(b > a)


def joined(parts: Iterable[Parts]) -> Parts:
    """All parts at once."""
    none = np.zeros(0, dtype=np.intp)
    found = [Parts(none, np.zeros(0), np.zeros(0), none), *parts]
    return Parts(*(np.concatenate(column) for column in zip(*found, strict=True)))


def united(parts: Parts, slack: Floats) -> Parts:
    """The parts, those of one segment that are no further apart than slack (n,) united; by is that of the first one."""
    order = np.lexsort((parts.low, parts.line))
    line, low, high, by = (column[order] for column in parts)
    reach = np.maximum.accumulate(high + 4.0 * line) - 4.0 * line
    new = np.ones(len(line), dtype=np.bool_)
    new[1:] = (line[1:] != line[:-1]) | (low[1:] > reach[:-1] + slack[line[1:]])
    last = np.append(new[1:], True)[: len(line)]
    return Parts(line[new], low[new], reach[last], by[new])


def gaps(parts: Parts, count: int, shortest: Floats) -> Parts:
    """What parts leave of 0 to 1 of count segments, where it is longer than shortest (n,)."""
    every, one = np.arange(count), np.ones(count)
    ends = (Parts(every, one * a, one * b, every) for a, b in ((-1.0, 0.0), (1.0, 2.0)))
    whole = united(joined([parts, *ends]), np.zeros(count))
    open_ = Parts(whole.line[:-1], whole.high[:-1], whole.low[1:], whole.by[:-1]).take(
        whole.line[1:] == whole.line[:-1]
    )
    return open_.take(open_.high - open_.low > shortest[open_.line])


# What a drawing and its certificate say, compared.


def numbers(value: Any, columns: int) -> Floats:
    """Lists of numbers as (n,columns). Errors: ValueError for what is not finite."""
    found = np.asarray(value, dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(found).all():
        raise ValueError("a number is not finite")
    return found


def stacked(lists: list[Any], columns: int) -> tuple[Floats, Ints]:
    """The rows of all lists, and how many each has."""
    found = [np.zeros((0, columns)), *(numbers(one, columns) for one in lists)]
    return np.concatenate(found), np.array([len(one) for one in found[1:]], dtype=np.intp)


def tell(into: list[str], what: str, lines: Segments, parts: Parts) -> None:
    """A line on parts, if there are any: how many, and where the longest is."""
    if len(parts.line):
        mm = (parts.high - parts.low) * lines.length[parts.line]
        k = int(np.argmax(mm))
        (x, y, _), (u, v, _) = (lines.at(parts.line[[k]], share[[k]])[0] for share in (parts.low, parts.high))
        into.append(
            f"{what} in {len(mm)} places, of stroke or edge {lines.owner[parts.line[k]]} for {mm[k]:.4g} mm, "
            f"from ({x:.4f}, {y:.4f}) to ({u:.4f}, {v:.4f}) mm"
        )


class Model(NamedTuple):
    """A drawing and the meshes of its certificate in the image: all segments of strokes, of points (p,3) that the page
    (p,2) shows; many (m,): points of each stroke; kind, hidden (m,); all edges as segments, and which of them have to
    be drawn, or hidden; the triangles, and which of them hide; off: how far rounding moves a point, in mm."""

    strokes: Segments
    page: Floats
    points: Floats
    many: Ints
    kind: NDArray[np.str_]
    hidden: Bools
    edges: Edges
    sides: Segments
    wanted: Ints
    of: Triangles
    hiding: Ints
    off: float


def model_of(drawing: Any, certificate: Any) -> Model:
    """The two files in the image. Errors: ValueError and those of missing keys for what is none."""
    for value, name in zip((drawing, certificate), FORMATS, strict=True):
        if value["format"] != name or value["version"] != 1:
            raise ValueError(f"not of the format {name!r}, version 1")
    items, rows, doubt = certificate["items"], drawing["strokes"], 0.01 * certificate["width_mm"]
    world, vertices = stacked([one["vertices"] for one in items], 3)
    corners, faces = stacked([one["triangles"] for one in items], 3)
    triangles, item = corners.astype(np.intp), np.repeat(np.arange(len(items)), faces)
    if ((triangles < 0) | (triangles >= vertices[item][:, None])).any():
        raise ValueError("a triangle has a vertex that there is not")
    triangles += (np.cumsum(vertices) - vertices)[item][:, None]
    (page, many), (space, again) = (
        stacked([[*row[key], *row[key][: row["closed"]]] for row in rows], n)
        for key, n in (("points", 2), ("points3d", 3))
    )
    if not np.array_equal(many, again) or not many.all():
        raise ValueError("points and points3d of strokes differ in number")
    matrix = numbers(drawing["page_from_world"], 4)
    image, off = image_of(matrix, np.concatenate([world, space]), world)
    image, points = image[: len(world)], image[len(world) :]
    of = triangles_of(image, triangles, doubt)
    edges, outline = edges_of(world, image, triangles, of, item, certificate["crease_angle_deg"], doubt)
    sides = Segments(image[edges.ends[:, 0]], image[edges.ends[:, 1]], np.arange(len(edges.ends)))
    must = np.zeros(len(edges.ends), dtype=np.bool_)
    for word in EDGE_KINDS:
        must |= edges.must[word] & np.array([word in one["lines"] for one in items], dtype=np.bool_)[edges.item]
    stroke = np.repeat(np.arange(len(rows)), many)
    start = np.flatnonzero(stroke[:-1] == stroke[1:])
    hides = np.array([bool(one["hides"]) for one in items], dtype=np.bool_)[item]
    return Model(
        Segments(points[start], points[start + 1], stroke[start]),
        page,
        points,
        many,
        np.array([row["kind"] for row in rows], dtype=np.str_),
        np.array([row["hidden_by"] > 0 for row in rows], dtype=np.bool_),
        edges,
        sides,
        np.flatnonzero(must & (sides.length > 4.0 * certificate["width_mm"])),
        of._replace(outline=outline),
        np.flatnonzero(hides & ~of.thin),
        off,
    )


def check(drawing: Any, certificate: Any) -> Verdict:
    """What the certificate proves of a drawing, both as they are read from JSON. Errors: see model_of."""
    wrong, unproven = list[str](), [str(line) for line in certificate["not_certified"]]
    if drawing["page_from_world"] != certificate["page_from_world"]:
        wrong.append("the drawing is seen by another camera than the certificate")
    model = model_of(drawing, certificate)
    if not np.isfinite(model.points).all() or not np.isfinite(model.sides.start).all():
        return Verdict(wrong, [*unproven, "anything: the scene reaches behind the eye"], {})
    if model.off > SEAM_MM:
        return Verdict(wrong, [*unproven, f"anything: rounding moves points by {model.off:.2g} mm"], {})
    counts = {"strokes": len(model.kind), "triangles": len(model.of.thin), "lines": len(model.wanted)}
    check_places(model, certificate, wrong, unproven)
    counts["witnesses"] = check_sight(model, certificate, wrong)
    check_missing(model, drawing, certificate, wrong)
    return Verdict(wrong, unproven, counts)


def least(lines: Segments, size: float) -> Floats:
    """(n,) the part of each segment that is size mm long, or half of it where it is short."""
    return np.minimum(size / np.maximum(lines.length, 1e-300), 0.5)


def check_places(model: Model, certificate: Any, wrong: list[str], unproven: list[str]) -> None:
    """Strokes are where their points in space are, and on lines of their kind."""
    width, strokes = certificate["width_mm"], model.strokes
    shifts = np.hypot(*(model.page - model.points[:, :2]).T)
    if (shifts > width).any():
        k = int(np.argmax(shifts))
        wrong.append(f"a point of a stroke is {shifts[k]:.4g} mm off its place, at {model.page[k].tolist()} mm")
    for word in np.unique(model.kind).tolist():
        own = strokes.take((model.kind[strokes.owner] == word) & (strokes.length > 4.0 * width))
        if word in model.edges.may:
            on = along(own, model.sides.take(model.edges.may[word]), width, 3)
        elif word in FACE_KINDS:
            on = lying_parts(own, model.of, width)
        else:
            unproven.append(f"{(model.kind == word).sum()} strokes of the kind {word}")
            continue
        tell(
            wrong,
            f"{word}: no such line there",
            own,
            gaps(joined(on), len(own.owner), least(own, certificate["size_mm"])),
        )


def check_sight(model: Model, certificate: Any, wrong: list[str]) -> int:
    """What is drawn as visible is, and what is drawn as hidden is behind what is named; how many names were right."""
    width, size = certificate["width_mm"], certificate["size_mm"]
    proved = np.isin(model.kind, [*model.edges.may, *FACE_KINDS])
    long = model.strokes.length > 4.0 * width
    seen = model.strokes.take((proved & ~model.hidden)[model.strokes.owner] & long)
    parts = united(joined(hidden_parts(seen, model.of, model.hiding, width, width)), least(seen, size))
    parts = parts.take(parts.high - parts.low > least(seen, size)[parts.line])
    tell(wrong, "drawn as visible, but hidden", seen, parts)
    claim, per = stacked(certificate["strokes"], 3)
    if len(per) != len(model.kind):
        raise ValueError("the certificate is of a drawing with another number of strokes")
    stroke = np.repeat(np.arange(len(per)), per)
    begin = np.clip(claim[:, 0].astype(np.intp), 0, model.many[stroke] - 2)
    line = np.searchsorted(model.strokes.owner, stroke) + begin
    told = Parts(line, claim[:, 0] - begin, claim[:, 1] - begin, claim[:, 2].astype(np.intp)).take(claim[:, 2] >= 0)
    true = behind(model.strokes, told, model.of, model.hiding)
    tell(wrong, "said to be hidden by what does not hide it", model.strokes, told.take(~true))
    told = told.take(true)
    left = gaps(told, len(long), least(model.strokes, size))
    left = left.take(((proved & model.hidden)[model.strokes.owner] & long)[left.line])
    tell(wrong, "drawn as hidden, but nothing is said to hide it", model.strokes, left)
    return len(told.line)


def check_missing(model: Model, drawing: Any, certificate: Any, wrong: list[str]) -> None:
    """All lines of the meshes are drawn, or hidden by what is named; where hidden ones are drawn, these too."""
    lines, width, size = model.sides.take(model.wanted), certificate["width_mm"], certificate["size_mm"]
    row, base = numbers(certificate["hidden"], 5), int(model.edges.ends.max(initial=0)) + 1
    keys = np.append(model.edges.ends[model.wanted, 0] * base + model.edges.ends[model.wanted, 1], -1)
    key = (row[:, 0] * base + row[:, 1]).astype(np.intp)
    place = np.searchsorted(keys[:-1], key)
    away = Parts(place, row[:, 2], row[:, 3], row[:, 4].astype(np.intp)).take(keys[place] == key)
    away = away.take(behind(lines, away, model.of, model.hiding))
    right, top = drawing["page_mm"]
    a, b = clipped(*(np.stack([x, y, right - x, top - y], axis=1) for x, y, _ in (lines.start.T, lines.end.T)))
    every = np.arange(len(lines.owner))
    outside = [Parts(every, *ends, every) for ends in ((a - 3.0, np.minimum(a, 1.0)), (np.maximum(b, 0.0), b + 3.0))]
    there = along(lines, model.strokes.take(~model.hidden[model.strokes.owner]), width, 2)
    tell(wrong, "missing", lines, gaps(joined([*there, away, *outside]), len(every), least(lines, size)))
    if certificate["hidden_gap_mm"] is not None:
        longest = (certificate["hidden_gap_mm"] + size) / np.maximum(lines.length, 1e-300)
        there = along(lines, model.strokes, width, 2)
        tell(
            wrong,
            "missing, though hidden lines are drawn",
            lines,
            gaps(joined([*there, *outside]), len(every), longest),
        )


def main(arguments: list[str]) -> int:
    """Say what is wrong and what is not proven of a drawing; the exit status."""
    try:
        drawing, certificate = (json.loads(open(name, "rb").read()) for name in arguments)
        wrong, unproven, counts = check(drawing, certificate)
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        print(f"cannot check: {type(error).__name__}: {error}", file=sys.stderr)
        return 3
    for line in [f"wrong: {line}" for line in wrong] + [f"not proven: {line}" for line in unproven]:
        print(line)
    print(", ".join(f"{number} {name}" for name, number in counts.items()))
    return 1 if wrong else 2 if unproven else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
