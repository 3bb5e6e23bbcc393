"""Proves a drawing from its certificate: ``python check_certificate.py drawing.json certificate.json``.

All is taken into the image: x and y in mm on the page and a height z towards the eye, in which lines and planes stay
what they are and sight lines run along -z. What a triangle hides there is convex: a segment is hidden by it if both its
ends are, and clear if no triangle hides a part of it. Surfaces are nets of triangles, proved to be so near to them that
what covers a disc of width_mm in the one covers its middle in the other (the degree of a map). Proved is, but for
strips of width_mm beside outlines of what is in front and for parts shorter than size_mm, where there are surfaces of
smooth_mm and as many times longer: each visible stroke is on a line of its kind, and clear; each hidden one is behind
what is named; each contour, crease and border that it says it has is drawn, or hidden. The rest is "not proven".
The exit status: 0 all is proved, 1 something is wrong, 2 something is not proven, 3 bad files.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING or __package__:
    from . import certified_image as geo
    from . import certified_surfaces as formulas
else:
    sys.path.insert(0, str(Path(__file__).parent))
    import certified_image as geo
    import certified_surfaces as formulas

FORMATS = ("vectorplot-drawing", "vectorplot-certificate")
EDGE_KINDS = ("contour", "boundary", "crease")
FACE_KINDS = ("intersection", "pattern", "section", "isophote", "parameter", "integral")
OUTSIDE, DEEP, OFF = 3.0, 40.0, 0.5
"""Times what is left open: so far outside of a contour one looks whether it is visible; strokes may be so much off in
depth, and nets at all."""
Fault = tuple[str, geo.Segments, geo.Parts, int]
"""What is wrong, where, and 0, or 1 where shapes without formulas may explain it, or 2 where it is just not proven."""


class Model(NamedTuple):
    """A drawing and the shapes of its certificate in the image. strokes: its segments, those on surfaces as pieces of
    these; whole: as they are drawn; bare: parts that should be on surfaces, and are not; lifted (m,): strokes on them;
    proved (s,): segments of strokes to prove, without tiny ones; kind, hidden (m,): of each stroke; sides: edges of
    shapes; ends (e,2): their vertices; may: which of them each kind may show; wanted (w,): those that are drawn or
    hidden; cells (c,9): where contours of surfaces are, see contour_cells; drawn (c,): of which item, -1 where they
    need not be drawn; shift (p,): mm that points are off their places; off: mm that rounding may do; smooth: something
    hides that is not certified; coarse: what is wrong with nets, a few words each."""

    strokes: geo.Segments
    whole: geo.Segments
    bare: geo.Parts
    lifted: geo.Bools
    proved: geo.Bools
    kind: NDArray[np.str_]
    hidden: geo.Bools
    sides: geo.Segments
    ends: geo.Ints
    may: dict[str, geo.Bools]
    wanted: geo.Ints
    of: geo.Triangles
    cells: geo.Floats
    drawn: geo.Ints
    shift: geo.Floats
    off: float
    smooth: bool
    coarse: list[str]


def stacked(lists: list[Any], columns: int) -> tuple[geo.Floats, geo.Ints]:
    """The rows of all lists as (n,columns), and how many each has. Errors: ValueError for what is not finite."""
    rows = np.array([row for one in lists for row in one], dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(rows).all():
        raise ValueError("a number is not finite")
    return rows, np.array([len(one) for one in lists], dtype=np.intp)


def named_parts(table: geo.Floats, names: geo.Ints) -> tuple[geo.Parts, geo.Ints]:
    """Those of some rows (two numbers that name a segment, from, to, by what) on segments with the names (n,2), in
    rising order; and which rows."""
    base = float(max(names.max(initial=0), table[:, :2].max(initial=0))) + 1.0
    keys, key = np.append(names[:, 0] * base + names[:, 1], np.inf), table[:, 0] * base + table[:, 1]
    line = np.searchsorted(keys, key)
    kept = np.flatnonzero(keys[line] == key)
    return geo.Parts(line[kept], table[kept, 2], table[kept, 3], table[kept, 4].astype(np.intp)), kept


def places_of(lines: geo.Segments) -> geo.Ints:
    """(n,2) the numbers of strokes, in rising order, and of the segments in each."""
    return np.stack([lines.owner, np.arange(len(lines.owner)) - np.searchsorted(lines.owner, lines.owner)], axis=1)


def on_surfaces(
    lines: geo.Segments, rows: Any, kinds: Any, patches: Any, items: Any, view: geo.Floats
) -> tuple[geo.Segments, geo.Parts]:
    """Straight pieces, which follow surfaces, of segments that do, parameter lines and sections as their items say; and
    what parts these are. rows: the number of a segment (2), from, to, which surface, u and v at both ends (4)."""
    table, slack = stacked([rows], 9)[0], float(lines.slack.max(initial=0.0))
    parts, kept = named_parts(table, places_of(lines))
    ends, right, start, end = table[kept, 5:], np.zeros(len(kept), dtype=np.bool_), *np.zeros((2, len(kept), 3))
    for number, (item, surface) in enumerate(patches):
        own = np.flatnonzero(parts.by == number)
        (u, v), word = ends[own].reshape(-1, 2, 2).transpose(2, 0, 1), kinds[lines.owner[parts.line[own]]]
        cells = np.hstack([np.sort(u, axis=1), np.sort(v, axis=1)])
        inside = (cells[:, ::2] >= [surface.u[0], surface.v[0]]) & (cells[:, 1::2] <= [surface.u[-1], surface.v[-1]])
        close = formulas.deviations(surface, view, cells).sum(axis=1) <= OFF * slack
        points = surface.points(u, v)
        image = geo.placed(view, points)
        start[own], end[own] = image.swapaxes(0, 1)
        along = ~np.isin(word, ["parameter", "section"])
        for axis, values in enumerate(items[item]["parameters"]):
            nearest = np.array([*values, np.inf])[
                np.abs(np.subtract.outer(ends[own, axis], [*values, 1e300])).argmin(axis=1)
            ]
            there = surface.points(*(nearest[:, None] + 0.0 * u, v) if axis == 0 else (u, nearest[:, None] + 0.0 * v))
            along |= (word == "parameter") & (np.abs(geo.placed(view, there) - image) <= slack).all(axis=(1, 2))
        for *normal, offset in items[item]["planes"]:
            above = (points * normal).sum(axis=-1) - offset
            there = points - above[..., None] * np.array(normal) / max(float(np.square(normal).sum()), geo.LEAST)
            along |= (word == "section") & (np.abs(geo.placed(view, there) - image) <= slack).all(axis=(1, 2))
        right[own] = close & along & inside.all(axis=1) & np.isfinite(start[own] + end[own]).all(axis=1)
    for share, at, tip in ((parts.low, start, 0.0), (parts.high, end, 1.0)):
        way = at - lines.at(parts.line, share)
        right &= (np.hypot(*way.T[:2]) <= slack) & ((share != tip) | (np.abs(way[:, 2]) <= DEEP * slack))
    order = np.lexsort((parts.low, parts.line))
    order = order[right[order]]
    pieces = geo.Segments(start, end, lines.owner[parts.line], np.full(len(kept), slack))
    return geo.take(pieces, order), geo.take(parts, order)


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
    patches = [(number, formulas.patch_of(row)) for number, one in enumerate(items) for row in one["surfaces"]]
    for which, (owner, surface) in enumerate(patches):
        points, more = formulas.net_of(surface)
        triangles, world = np.concatenate([triangles, more + len(world)]), np.concatenate([world, points])
        item, patch = (np.append(one, np.full(len(more), k)) for one, k in ((item, owner), (patch, which)))
    if len(triangles) > 4 * formulas.MOST_CELLS:
        raise ValueError("the nets have too many cells")
    # A closed stroke ends in its first point.
    ways = ([[*row[key], *row[key][: row["closed"]]] for row in rows] for key in ("points", "points3d"))
    (page, many), (space, again) = (stacked(way, columns) for way, columns in zip(ways, (2, 3), strict=True))
    if not np.array_equal(many, again) or not many.all():
        raise ValueError("points and points3d of a stroke differ")
    view = geo.image_rows(stacked([drawing["page_from_world"]], 4)[0], world)
    image, off = geo.image_of(view, np.concatenate([world, space]))
    image, points = image[: len(world)], image[len(world) :]
    stroke = np.repeat(np.arange(len(rows)), many)
    begin = np.flatnonzero(stroke[:-1] == stroke[1:])
    strokes = geo.Segments(
        points[begin], points[begin + 1], stroke[begin], np.full(len(begin), fine if patches else width)
    )
    if patches:
        same = geo.welded(image)[triangles]
        kept = (patch < 0) | (same != np.roll(same, 1, axis=1)).all(axis=1)
        triangles, item, patch = np.where(patch[:, None] < 0, triangles, same)[kept], item[kept], patch[kept]
    open_ = fine if patches else width
    slack, nets, cells, drawn, coarse = np.full(len(patch), open_), np.zeros(len(patch)), [], [], list[str]()
    for number, (owner, surface) in enumerate(patches):
        name, off_net = (
            items[owner]["name"],
            float(formulas.deviations(surface, view, surface.grid()).sum(axis=1).max()),
        )
        found, every = formulas.contour_cells(surface, view, fine)
        nets[patch == number] = off_net
        cells.append(found)
        drawn.append(np.full(len(found), owner if "contour" in items[owner]["lines"] else -1))
        coarse += [f"what {name} shows and hides: its net may be {off_net:.2g} mm off"] * (not off_net <= OFF * fine)
        coarse += [f"that contours of {name} are complete: too many cells"] * (not every)
    ends, at, may, must, outline = geo.edges_of(
        world, image, triangles, certificate["crease_angle_deg"], 0.01 * width, patch
    )
    # Edges of one surface count together.
    places = np.where(patch[at] < 0, np.arange(len(ends)), len(ends) + patch[at])
    sides = geo.Segments(image[ends[:, 0]], image[ends[:, 1]], places, slack[at])
    has = {word: np.array([word in one["lines"] for one in items], dtype=np.bool_)[item[at]] for word in EDGE_KINDS}
    wanted = np.logical_or.reduce([must[word] & has[word] for word in EDGE_KINDS]) & (sides.length > 4.0 * width)
    spots, hides = image[triangles], np.array([one["hides"] for one in items], dtype=np.bool_)[item]
    area = np.abs(np.cross(spots[:, 1] - spots[:, 0], spots[:, 2] - spots[:, 0])[:, 2])
    broad = area > 0.02 * width * np.ptp(spots[..., :2], axis=1).max(axis=1, initial=0.0)
    of = geo.Triangles(spots, geo.halves_of(spots), outline, np.flatnonzero(hides & broad), nets, slack)
    kind, hidden, names = (np.array([row[key] for row in rows]) for key in ("kind", "hidden_by", "item"))
    smooth = {one["name"]: bool(one["surfaces"]) for one in items if one["smooth"]}
    of_kind = np.isin(kind, [*may, *FACE_KINDS])[strokes.owner] & (strokes.length > 4.0 * width)
    on = np.isin(names, [name for name, certified in smooth.items() if certified])
    lifted = on[strokes.owner]
    pieces, told = on_surfaces(strokes, certificate["on_surfaces"], kind, patches, items, view)
    pieces = geo.take(pieces, lifted[told.line])
    bare = geo.gaps(told, strokes.least(ratio_of(certificate)))
    bare = geo.take(bare, (lifted & of_kind)[bare.line])
    own = geo.together(geo.take(strokes, ~lifted), pieces)
    own = geo.take(own, np.argsort(own.owner, kind="stable"))
    proved = np.isin(kind, [*may, *FACE_KINDS])[own.owner] & (own.length > 4.0 * width)
    proved &= ~np.isin(names, [name for name, certified in smooth.items() if not certified])[own.owner]
    shift = np.asarray(np.hypot(*(page - points[:, :2]).T))
    bare_smooth = any(one["smooth"] and one["hides"] and not one["surfaces"] for one in items)
    where = np.concatenate([np.zeros((0, 9)), *cells]), np.concatenate([np.zeros(0, dtype=np.intp), *drawn])
    lines = own, strokes, bare, on, proved, kind, hidden > 0, sides, ends, may, np.flatnonzero(wanted), of
    return Model(*lines, *where, shift, off, bare_smooth, coarse)


def check(drawing: Any, certificate: Any) -> tuple[list[str], list[str], dict[str, int]]:
    """What is wrong with a drawing, and what is not proven, a line each, and how much was compared; both are given as
    they are read from JSON. Errors: see model_of."""
    wrong, unproven, model = list[str](), list[str](certificate["not_certified"]), model_of(drawing, certificate)
    if drawing["page_from_world"] != certificate["page_from_world"]:
        wrong.append("the drawing is seen by another camera than the certificate")
    seen = np.isfinite(model.shift).all() and np.isfinite(model.of.corners).all()
    if not seen or model.off > geo.SEAM_MM:
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
        long = (total > ratio_of(certificate) * lines.slack[parts.line]) | (
            lines.slack[parts.line] < certificate["smooth_mm"]
        )
        if not long.any():
            continue
        parts, mm = geo.take(parts, long), mm[long]
        worst = geo.take(parts, [int(np.argmax(mm))])
        (x, y, _), (u, v, _) = (lines.at(worst.line, share)[0] for share in (worst.low, worst.high))
        where = f"{lines.owner[worst.line[0]]}, for {mm.max():.4g} mm, from ({x:.4f}, {y:.4f}) to ({u:.4f}, {v:.4f}) mm"
        (unproven if open_ > 1 or (open_ and model.smooth) else wrong).append(
            f"{what} {len(mm)} times, the longest: number {where}"
        )
    counts = {"strokes": len(model.kind), "triangles": len(model.of.halves), "lines": len(model.wanted)}
    return (
        wrong,
        unproven,
        {**counts, "witnesses": len(certificate["hidden_strokes"]) + len(certificate["hidden_lines"])},
    )


def check_places(model: Model, certificate: Any) -> Iterator[Fault]:
    """Strokes are on lines of their kind, and drawn once."""
    ratio, fine, long = ratio_of(certificate), certificate["smooth_mm"], geo.take(model.strokes, model.proved)
    yield "on no surface, or no such line of it, of stroke", model.whole, model.bare, 0
    for word in np.unique(model.kind[long.owner]).tolist():
        own = geo.take(long, (model.kind[long.owner] == word) & (~model.lifted[long.owner] | np.isin(word, EDGE_KINDS)))
        mesh = geo.take(model.sides, model.may[word]) if word in model.may else None
        on = [*(geo.lying_parts(own, model.of) if mesh is None else geo.parts_along(own, mesh, 1.0, 1.0 / ratio))]
        on += geo.parts_near(own, model.cells, fine, DEEP * fine) if word == "contour" else []
        yield f"{word} where there is none, of stroke", own, geo.gaps(geo.joined(on), own.least(ratio)), False
    twice = geo.joined(geo.parts_along(long, long, 0.1, 1.0))
    again = (twice.by < twice.line) & (twice.high - twice.low > long.least(ratio)[twice.line])
    again &= (long.slack[twice.line] < fine) | (long.owner[twice.line] != long.owner[twice.by])
    again &= model.kind[long.owner[twice.line]] == model.kind[long.owner[twice.by]]
    yield "drawn twice, of stroke", long, geo.take(twice, again), 0


def check_sight(model: Model, certificate: Any) -> Iterator[Fault]:
    """What is drawn as visible is, and what is drawn as hidden is behind what is named."""
    ratio, behind = ratio_of(certificate), model.hidden[model.strokes.owner]
    seen = geo.take(model.strokes, model.proved & ~behind)
    parts = geo.united(geo.joined(geo.hidden_parts(seen, model.of, 1.0)), seen.least(ratio))
    parts = geo.take(parts, parts.high - parts.low > seen.least(ratio)[parts.line])
    yield "visible, but hidden, of stroke", seen, parts, False
    told = named_parts(stacked([certificate["hidden_strokes"]], 5)[0], places_of(model.strokes))[0]
    dark, away = model.proved & behind, geo.hidden_by(model.strokes, told, model.of)
    left = geo.gaps(away, model.strokes.least(ratio))
    # In the strips beside outlines lines may be hidden or not: there is no proof.
    every = geo.take(model.strokes, dark)
    strips = geo.joined(
        [*geo.hidden_parts(every, model.of, -1.0), *geo.parts_near(every, model.cells, certificate["smooth_mm"])]
    )
    strips = geo.take(
        strips._replace(line=np.flatnonzero(dark)[strips.line]), every.slack[strips.line] > certificate["width_mm"]
    )
    left = geo.gaps(geo.joined([away, strips]), model.strokes.least(ratio))
    yield "hidden by nothing that is named, of stroke", model.strokes, geo.take(left, dark[left.line]), True


def check_missing(model: Model, certificate: Any) -> Iterator[Fault]:
    """Lines of meshes are drawn, or hidden by what is named; hidden ones, if any is drawn, but for gaps of dashes."""
    lines, ratio = geo.take(model.sides, model.wanted), ratio_of(certificate)
    away = geo.hidden_by(
        lines, named_parts(stacked([certificate["hidden_lines"]], 5)[0], model.ends[model.wanted])[0], model.of
    )
    visible, window = (
        geo.take(model.strokes, ~model.hidden[model.strokes.owner]),
        stacked([certificate["window_mm"]], 2)[0],
    )
    ends = (np.hstack([side[:, :2] - window[0], window[1] - side[:, :2]]) for side in lines[:2])
    outside = geo.gaps(geo.clipped(every := np.arange(len(model.wanted)), every, *ends), np.zeros(len(every)))
    there = geo.joined([*geo.parts_along(lines, visible, 1.0, 0.0), away, outside])
    yield "neither drawn nor hidden, of edge", lines, geo.gaps(there, lines.least(ratio)), True
    if (gap := certificate["hidden_gap_mm"]) is not None:
        there = geo.joined([*geo.parts_along(lines, model.strokes, 1.0, 0.0), outside])
        shortest = lines.least(ratio) + gap / np.maximum(lines.length, geo.LEAST)
        yield "hidden lines are drawn, but not, of edge", lines, geo.gaps(there, shortest), True


def check_contours(model: Model, certificate: Any) -> Iterator[Fault]:
    """Contours of surfaces are drawn, or hidden; nothing is, that close to their ends, where they may be either."""
    fine, window = certificate["smooth_mm"], stacked([certificate["window_mm"]], 2)[0]
    within = ((model.cells[:, :2] > window[0] + fine) & (model.cells[:, :2] < window[1] - fine)).all(axis=1)
    within &= model.drawn >= 0
    cells = model.cells[within]
    slack, every = np.full(len(cells), fine), np.arange(len(cells))
    place, beyond = cells[:, :3], cells[:, :3] + OUTSIDE * fine * np.hstack([cells[:, 6:8], 0.0 * cells[:, :1]])
    lines = geo.Segments(place - cells[:, 3:6], place + cells[:, 3:6], model.drawn[within], slack)
    visible = geo.take(model.strokes, ~model.hidden[model.strokes.owner])
    left = np.ones(len(cells), dtype=np.bool_)
    left[geo.joined(geo.parts_near(visible, cells, fine)).by] = False
    left[geo.joined(geo.hidden_parts(geo.Segments(place, place, every, slack), model.of, 0.0)).line] = False
    maybe = np.zeros(len(cells), dtype=np.bool_)
    maybe[geo.joined(geo.hidden_parts(geo.Segments(beyond, beyond, every, slack), model.of, -1.0)).line] = True
    parts, sure = geo.Parts(every, 0.0 * slack, 0.0 * slack + 1.0, every), cells[:, 8] > 0.0
    left &= reaches(place, left, ratio_of(certificate) * fine)
    yield "contour neither drawn nor hidden, of item", lines, geo.take(parts, left & ~maybe & sure), False
    yield "contour that may be left out, of item", lines, geo.take(parts, left & ~maybe & ~sure), 2
    yield "contour beside outlines, drawn or hidden, of item", lines, geo.take(parts, left & maybe), 2
    if (gap := certificate["hidden_gap_mm"]) is not None:
        bare = sure.copy()
        bare[geo.joined(geo.parts_near(model.strokes, cells, fine + gap)).by] = False
        bare &= reaches(place, bare, ratio_of(certificate) * fine + gap)
        yield "hidden contours are drawn, but not, of item", lines, geo.take(parts, bare), False


def reaches(place: geo.Floats, which: geo.Bools, size: float) -> geo.Bools:
    """(n,) which of some points have another one between half so far and so far on the page: not those of ovals."""
    points, number, found = place[which], np.flatnonzero(which), np.zeros(len(place), dtype=np.bool_)
    room = np.array([size, size, np.inf])
    for one, other in geo.near(points, points, points - room, points + room):
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
