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
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING or __package__:
    from . import certified_drawing as given
    from . import certified_image as geo
else:
    sys.path.insert(0, str(Path(__file__).parent))
    import certified_drawing as given
    import certified_image as geo

FORMATS = ("vectorplot-drawing", "vectorplot-certificate")
OUTSIDE = 3.0
"""Times what is left open: so far outside of a contour one looks whether it is visible."""
Fault = tuple[str, geo.Segments, geo.Parts, int]
"""What is wrong, where, and 0, or 1 where shapes without formulas may explain it, or 2 where it is just not proven."""


def check(drawing: Any, certificate: Any) -> tuple[list[str], list[str], dict[str, int]]:
    """What is wrong with a drawing, and what is not proven, a line each, and how much was compared; both are given as
    they are read from JSON. Errors: see shapes_of."""
    if [(one["format"], one["version"]) for one in (drawing, certificate)] != [(name, 1) for name in FORMATS]:
        raise ValueError(f"expected files of the formats {' and '.join(FORMATS)}, version 1")
    shapes = given.shapes_of(certificate)
    model = given.model_of(drawing, certificate, shapes)
    wrong, unproven = list[str](), list[str](certificate["not_certified"])
    if drawing["page_from_world"] != certificate["page_from_world"]:
        wrong.append("the drawing is seen by another camera than the certificate")
    seen, off = np.isfinite(model.shift).all() and np.isfinite(shapes.of.corners).all(), max(model.off, shapes.off)
    if not seen or off > geo.SEAM_MM:
        why = f"rounding moves points by {off:.2g} mm" if seen else "the scene reaches behind the eye"
        return wrong, [*unproven, f"anything: {why}"], {}
    unproven += shapes.coarse + unproved_kinds(drawing, model, shapes)
    if (model.shift > shapes.limits.width).any():
        wrong.append(f"points of strokes are up to {model.shift.max():.4g} mm off their places in space")
    if (model.item[np.isin(model.kind, [*shapes.may, *given.FACE_KINDS])] < 0).any():
        wrong.append("strokes are of items that there are not")
    if sorted(certificate["clear"]) != np.flatnonzero(~model.hidden).tolist():
        wrong.append("other strokes are visible than the certificate says")
    found = judged(model, certificate, shapes, (check_places, check_sight, check_missing, check_contours))
    counts = {"strokes": len(model.kind), "triangles": len(shapes.of.halves), "lines": len(shapes.wanted)}
    counts["witnesses"] = len(certificate["hidden_strokes"]) + len(certificate["hidden_lines"])
    return wrong + found[0], unproven + found[1], counts


def unproved_kinds(drawing: Any, model: given.Model, shapes: given.Shapes) -> list[str]:
    """What of a drawing is not looked at, a few words each."""
    on, known = (
        np.isin(model.kind, [*shapes.may, *given.FACE_KINDS]),
        {"format", "version", "page_mm", "page_from_world"},
    )
    only = {*model.kind[model.lifted].tolist()} & {"integral", "pattern"}
    said = [f"that each {word} stroke on a surface, where it is, is one" for word in sorted(only)]
    said += [f"strokes of the kind {word}" for word in sorted({*model.kind[~on].tolist()})]
    for one in shapes.items:
        drawn = (on & (model.item == shapes.names[one["name"]])).any()
        if one["smooth"] and not one["surfaces"] and (drawn or one["hides"]):
            said.append(f"what {one['name']} shows and hides, which has no formulas")
    complete = {word for one in shapes.items for word in one["lines"]}
    if shapes.items and not complete & {*given.EDGE_KINDS}:
        said.append("that all lines of any kind are there")
    said += [
        f"that each {word} is there"
        for word in given.EDGE_KINDS
        if complete and (model.kind == word).any() and word not in complete
    ]
    if model.hidden.any() and shapes.limits.gap is None:
        said.append("that all hidden lines are there")
    return said + [f"{key} of the drawing" for key in sorted({*drawing} - {*known, "strokes"}) if drawing[key]]


def judged(
    model: given.Model, certificate: Any, shapes: given.Shapes, checks: tuple[Callable[..., Iterator[Fault]], ...]
) -> tuple[list[str], list[str]]:
    """What some checks find wrong, and not proven, a line each."""
    wrong, unproven, limits = list[str](), list[str](), shapes.limits
    for what, lines, parts, open_ in chain.from_iterable(check(model, certificate, shapes) for check in checks):
        length, slack = lines.length[parts.line], lines.slack[parts.line]
        mm = (parts.high - parts.low) * length
        # On surfaces lines are in short pieces, and contours in cells: what is shorter all in all is not looked at.
        total = np.bincount(lines.owner[parts.line], mm)[lines.owner[parts.line]] if len(mm) else mm
        long = (total > limits.ratio * slack) | ((slack < limits.fine) & (length > 4.0 * limits.width))
        if not long.any():
            continue
        parts, mm = geo.take(parts, long), mm[long]
        worst = geo.take(parts, [int(np.argmax(mm))])
        (x, y, _), (u, v, _) = (lines.at(worst.line, share)[0] for share in (worst.low, worst.high))
        where = f"{lines.owner[worst.line[0]]}, for {mm.max():.4g} mm, from ({x:.4f}, {y:.4f}) to ({u:.4f}, {v:.4f}) mm"
        (unproven if open_ > 1 or (open_ and shapes.smooth) else wrong).append(
            f"{what} {len(mm)} times, the longest: number {where}"
        )
    return wrong, unproven


def check_places(model: given.Model, certificate: Any, shapes: given.Shapes) -> Iterator[Fault]:
    """Strokes are on lines of their kind, and drawn once."""
    ratio, fine, long = shapes.limits.ratio, shapes.limits.fine, geo.take(model.strokes, model.proved)
    yield "on no surface, or no such line of it, of stroke", model.whole, model.bare, 0
    for word in np.unique(model.kind[long.owner]).tolist():
        own = geo.take(long, model.kind[long.owner] == word)
        flat, least = ~model.lifted[own.owner], own.least(ratio)
        if word in shapes.may:
            on = [*geo.parts_along(own, geo.take(shapes.sides, shapes.may[word]), 1.0, 1.0 / ratio)]
            cells = geo.joined(geo.parts_near(own, shapes.cells, fine, given.DEEP * fine) if word == "contour" else [])
            alike = model.item[own.owner[cells.line]] == shapes.cell_item[cells.by]
            yield (
                f"{word} where there is none, of stroke",
                own,
                geo.gaps(geo.joined([*on, geo.take(cells, alike)]), least),
                0,
            )
            continue
        lying = geo.joined(geo.lying_parts(own, shapes.of))
        bare = geo.gaps(lying, least)
        yield f"{word} where there is none, of stroke", own, geo.take(bare, flat[bare.line]), 0
        if word == "intersection":
            # What is on two items is so without any one of them.
            items = shapes.item[lying.by]
            alone = geo.joined(geo.gaps(geo.take(lying, items != one), least) for one in np.unique(items))
            yield "intersection with nothing, of stroke", own, geo.united(alone, 0.0 * least), 1
        if word == "isophote":
            doubt = np.flatnonzero(model.doubt[model.proved][model.kind[long.owner] == word])
            whole = geo.Parts(doubt, np.zeros(len(doubt)), np.ones(len(doubt)), doubt)
            yield "isophote that may be none, of stroke", own, whole, 2
        if word == "section":
            planes = np.concatenate([geo.planes_in(shapes.view, one["planes"]) for one in shapes.items])
            bare = geo.gaps(geo.joined(geo.parts_in(own, planes)), least)
            yield "section in no plane, of stroke", own, geo.take(bare, flat[bare.line]), 0
    twice = geo.joined(geo.parts_along(long, long, 0.1, 1.0))
    again = (twice.by < twice.line) & (twice.high - twice.low > long.least(ratio)[twice.line])
    again &= (long.slack[twice.line] < fine) | (long.owner[twice.line] != long.owner[twice.by])
    # Edges of meshes are of one kind each; of surfaces a contour may run beside a rim.
    one, two = long.owner[twice.line], long.owner[twice.by]
    edge = np.isin(model.kind, given.EDGE_KINDS) & ~model.lifted
    again &= (model.kind[one] == model.kind[two]) | (edge[one] & edge[two])
    yield "drawn twice, of stroke", long, geo.take(twice, again), 0


def check_sight(model: given.Model, certificate: Any, shapes: given.Shapes) -> Iterator[Fault]:
    """What is drawn as visible is, and what is drawn as hidden is behind what is named."""
    ratio, behind = shapes.limits.ratio, model.hidden[model.strokes.owner]
    seen = geo.take(model.strokes, model.proved & ~behind)
    parts = geo.united(geo.joined(geo.hidden_parts(seen, shapes.of, 1.0)), seen.least(ratio))
    parts = geo.take(parts, parts.high - parts.low > seen.least(ratio)[parts.line])
    yield "visible, but hidden, of stroke", seen, parts, 0
    told = given.named_parts(given.stacked([certificate["hidden_strokes"]], 5)[0], given.places_of(model.strokes))[0]
    dark, away = model.proved & behind, geo.hidden_by(model.strokes, told, shapes.of)
    # In the strips beside outlines lines may be hidden or not: there is no proof.
    every = geo.take(model.strokes, dark)
    strips = geo.joined(
        [*geo.hidden_parts(every, shapes.of, -1.0), *geo.parts_near(every, shapes.cells, shapes.limits.fine)]
    )
    strips = geo.take(
        strips._replace(line=np.flatnonzero(dark)[strips.line]), every.slack[strips.line] > shapes.limits.width
    )
    left = geo.gaps(geo.joined([away, strips]), model.strokes.least(ratio))
    yield "hidden by nothing that is named, of stroke", model.strokes, geo.take(left, dark[left.line]), 1


def check_missing(model: given.Model, certificate: Any, shapes: given.Shapes) -> Iterator[Fault]:
    """Lines of meshes are drawn, or hidden by what is named; hidden ones, if any is drawn, but for gaps of dashes."""
    lines, ratio, window = geo.take(shapes.sides, shapes.wanted), shapes.limits.ratio, shapes.limits.window
    told = given.named_parts(given.stacked([certificate["hidden_lines"]], 5)[0], shapes.ends[shapes.wanted])[0]
    visible = geo.take(model.strokes, ~model.hidden[model.strokes.owner])
    ends = (np.hstack([side[:, :2] - window[0], window[1] - side[:, :2]]) for side in lines[:2])
    outside = geo.gaps(geo.clipped(every := np.arange(len(shapes.wanted)), every, *ends), np.zeros(len(every)))
    there = [*geo.parts_along(lines, visible, 1.0, 0.0), geo.hidden_by(lines, told, shapes.of), outside]
    yield "neither drawn nor hidden, of edge", lines, geo.gaps(geo.joined(there), lines.least(ratio)), 1
    if (gap := shapes.limits.gap) is not None:
        there = [*geo.parts_along(lines, model.strokes, 1.0, 0.0), outside]
        shortest = lines.least(ratio) + gap / np.maximum(lines.length, geo.LEAST)
        yield "hidden lines are drawn, but not, of edge", lines, geo.gaps(geo.joined(there), shortest), 1


def check_contours(model: given.Model, certificate: Any, shapes: given.Shapes) -> Iterator[Fault]:
    """Contours of surfaces are drawn, or hidden; nothing is, that close to their ends, where they may be either."""
    fine, window, size = shapes.limits.fine, shapes.limits.window, shapes.limits.ratio * shapes.limits.fine
    within = ((shapes.cells[:, :2] > window[0] + fine) & (shapes.cells[:, :2] < window[1] - fine)).all(axis=1)
    within &= shapes.drawn
    cells = shapes.cells[within]
    slack, every = np.full(len(cells), fine), np.arange(len(cells))
    place, beyond = cells[:, :3], cells[:, :3] + OUTSIDE * fine * np.hstack([cells[:, 6:8], 0.0 * cells[:, :1]])
    lines = geo.Segments(place - cells[:, 3:6], place + cells[:, 3:6], shapes.cell_item[within], slack)
    visible = geo.take(model.strokes, ~model.hidden[model.strokes.owner])
    left = np.ones(len(cells), dtype=np.bool_)
    left[geo.joined(geo.parts_near(visible, cells, fine)).by] = False
    left[geo.joined(geo.hidden_parts(geo.Segments(place, place, every, slack), shapes.of, 0.0)).line] = False
    maybe = np.zeros(len(cells), dtype=np.bool_)
    maybe[geo.joined(geo.hidden_parts(geo.Segments(beyond, beyond, every, slack), shapes.of, -1.0)).line] = True
    parts, sure = geo.Parts(every, 0.0 * slack, 0.0 * slack + 1.0, every), cells[:, 8] > 0.0
    left &= reaches(place, left, size)
    yield "contour neither drawn nor hidden, of item", lines, geo.take(parts, left & ~maybe & sure), 0
    yield "contour that may be left out, of item", lines, geo.take(parts, left & ~maybe & ~sure), 2
    yield "contour beside outlines, drawn or hidden, of item", lines, geo.take(parts, left & maybe), 2
    if (gap := shapes.limits.gap) is not None:
        bare = sure.copy()
        bare[geo.joined(geo.parts_near(model.strokes, cells, fine + gap)).by] = False
        bare &= reaches(place, bare, size + gap)
        yield "hidden contours are drawn, but not, of item", lines, geo.take(parts, bare), 0


def reaches(place: geo.Floats, which: geo.Bools, size: float) -> geo.Bools:
    """(n,) which of some points have another one between half so far and so far on the page: not those of ovals."""
    points, number, found = place[which], np.flatnonzero(which), np.zeros(len(place), dtype=np.bool_)
    room = np.array([size, size, np.inf])
    for one, other in geo.near(points, points, points - room, points + room):
        found[number[one[np.hypot(*(points[one] - points[other]).T[:2]) > 0.5 * size]]] = True
    return found


LOOKED_AT = {"kind", "item", "hidden_by", "points", "points3d", "closed"}
"""What is compared of a stroke, which is straight between its points."""


def premises(drawing: Any, certificate: Any) -> list[str]:
    """What is taken from the certificate as it is, a line each: a drawing of another scene is proved by another one."""
    items, limits = certificate["items"], given.limits_of(certificate)
    (left, low), (right, high) = limits.window
    said = [f"items: {len(items)}, in the window from ({left:g}, {low:g}) to ({right:g}, {high:g}) mm"]
    smooth = f", {limits.fine:g} mm where there are surfaces" * any(one["surfaces"] for one in items)
    said.append(f"left open: {limits.width:g} mm beside outlines{smooth}; creases turn by {limits.angle:g} degrees")
    said += ["hidden lines are not drawn"] * (limits.gap is None)
    kinds = sorted({word for one in items for word in one["lines"]})
    said.append(f"complete: {', '.join(kinds) or 'no kind of line'}")
    for one in items:
        without = [word for word in kinds if word not in one["lines"]]
        said += [f"{one['name']} hides nothing"] * (not one["hides"])
        said += [f"not every {', '.join(without)} of {one['name']} need be drawn"] * bool(without)
    more = sorted({key for stroke in drawing["strokes"] for key in stroke} - LOOKED_AT)
    return said + [f"strokes are straight between their points, whatever {', '.join(more)} of them say"] * bool(more)


def only_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object of JSON. Errors: ValueError for a name that stands in it twice."""
    if len(dict(pairs)) < len(pairs):
        raise ValueError("a name stands twice in an object")
    return dict(pairs)


def main(names: list[str]) -> int:
    """Say what is wrong and what is not proven of a drawing, and what is taken as given; the exit status."""
    if names == ["--help"]:
        sys.stdout.write(str(__doc__))
        return 0
    if len(names) != 2:
        sys.stderr.write(f"cannot check: expected drawing.json certificate.json, got {len(names)} names\n")
        return 3
    try:
        drawing, certificate = (json.loads(Path(name).read_bytes(), object_pairs_hook=only_once) for name in names)
        wrong, unproven, counts = check(drawing, certificate)
        told = [f"given: {line}" for line in premises(drawing, certificate)]
    except (
        ArithmeticError,
        LookupError,
        MemoryError,
        OSError,
        RecursionError,
        SyntaxError,
        TypeError,
        ValueError,
    ) as error:
        sys.stderr.write(f"cannot check: {type(error).__name__}: {error}; expected drawing.json certificate.json\n")
        return 3
    told = [*(f"wrong: {line}" for line in wrong), *(f"not proven: {line}" for line in unproven), *told]
    told.append(", ".join(f"{number} {name}" for name, number in counts.items()))
    sys.stdout.write("\n".join(told) + "\n")
    return 1 if wrong else 2 if unproven else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
