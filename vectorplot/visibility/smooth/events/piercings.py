"""Where curves pierce sheets that they do not lie on."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import ALONG_SHEET_SINE
from vectorplot.tolerances.of_extent import MET_OF_EXTENT, NEARLY_MET, SETTLED_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import APART_OF_DOMAIN
from vectorplot.visibility.smooth.blocks import Block, in_blocks
from vectorplot.visibility.smooth.events.events import Events, all_events, hopped, on_chord, once
from vectorplot.visibility.smooth.events.unmet import unmet_stretches
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.sheets.sheet import Sheet
from vectorplot.visibility.smooth.targets import Target, inside, weights
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

ROUNDS, HOPS = 10, 3
"""Steps of Newton; how often a place may go over to a neighbouring chord."""

ULPS = 16.0
"""So many times the rounding of points may be between them too."""

APART_AT_FIRST = 0.04
"""Where a sheet meets itself, parts of its domain that the two places are apart at least: at the start of the search,
and at its end."""

SHARPEST = 1e3
"""Where a sheet bends more strongly, in a scene about 1 large, its normal tells nothing about the sides of it: it is at
an apex, a pinch point or a cuspidal edge, or as good as there."""

_Found = tuple[Ints, Floats, Floats, Ints, Floats, Floats]
"""Chords that come close to a sheet, the parts of them where they do, and within how far; and chords that meet it, the
parts of them where they do, and the places there."""


def piercings(
    view: View, targets: tuple[Target, ...], curves: Curves, meets_itself: Bools, pairs: int
) -> tuple[Events, tuple[int, ...]]:
    """The events where curves pierce sheets, behind which there is one more in front; and the items for which the
    budget's pairs did not do. Where curves come close to a sheet and no such event is found they are cut, with no
    change (see unmet).

    meets_itself (s,): sheets that may be pierced by curves that lie on them.
    """
    depth, image = projection.depth(view, curves.points), projection.image(view, curves.points)
    parts, short = [], list[int]()
    for number, target in enumerate(targets):
        stranger = ((curves.sheet != number) & (curves.second_sheet != number)) | meets_itself[number]
        chord = curves.chords[stranger[curves.owner[curves.chords]]]
        chord = chord[(depth[chord] > view.near) & (depth[chord + 1] > view.near)]
        if len(chord) and len(target.corners):

            def look(rows: Ints, target: Target = target, number: int = number) -> Block[_Found]:
                block = _close(target, curves, rows, image, depth)
                chord, part, places, reach = block.found
                kept = _elsewhere(target.sheet, number, curves, chord, part, places, APART_AT_FIRST)
                chord, part, places, reach = chord[kept], part[kept], places[kept], reach[kept]
                at, at_part, met = _met(view, target.sheet, curves, chord, part, places)
                kept = _elsewhere(target.sheet, number, curves, at, at_part, met, APART_OF_DOMAIN)
                return Block((chord, part, reach, at[kept], at_part[kept], met[kept]), block.partners, len(chord))

            found, done = in_blocks(chord, pairs, look)
            if done < len(chord):
                short.append(target.sheet.item)
            near, near_part, reach, chord, part, places = (
                np.concatenate(column) for column in zip(*found, strict=True)
            )
            pierced = _pierced(view, target.sheet, curves, chord, part, places)
            parts += [pierced, unmet_stretches(curves, near, near_part, reach, pierced, target.sheet.item)]
    return all_events(parts), tuple(short)


def _elsewhere(
    sheet: Sheet, number: int, curves: Curves, chord: Ints, part: Floats, places: Floats, apart: float
) -> Bools:
    """(k,) which places on a sheet are not those of the curves themselves, which may lie on it once or twice."""
    away = np.ones(len(chord), dtype=np.bool_)
    for on, own_places in ((curves.sheet, curves.places), (curves.second_sheet, curves.second_places)):
        mine = np.flatnonzero(on[curves.owner[chord]] == number)
        at, begin = part[mine, None], chord[mine]
        own = own_places[begin] + at * (own_places[begin + 1] - own_places[begin])
        away[mine] &= sheet.apart(places[mine], own) > apart
    return away


def _close(
    target: Target, curves: Curves, chord: Ints, image: Floats, depth: Floats
) -> Block[tuple[Ints, Floats, Floats, Floats]]:
    """Chords, parts of them and places on the sheet where they come close to it, and within how far."""
    a, b = image[chord], image[chord + 1]
    box, triangle = target.near_boxes(np.minimum(a, b), np.maximum(a, b))
    looked = len(box)
    one, two = depth[chord[box]], depth[chord[box] + 1]
    deep = target.depth[triangle]
    margin = target.off[triangle]
    near = (np.minimum(one, two) <= deep.max(axis=1) + margin) & (np.maximum(one, two) >= deep.min(axis=1) - margin)
    box, triangle, margin = box[near], triangle[near], margin[near]
    chord = chord[box]
    corners = target.sheet.vertices[target.corners[triangle]]
    a, b = curves.points[chord], curves.points[chord + 1]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    with np.errstate(invalid="ignore", divide="ignore"):
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        one, two = dot(a - corners[:, 0], normal), dot(b - corners[:, 0], normal)
        part = np.clip(np.where(one != two, one / (one - two), 0.5), 0.0, 1.0)
        reach = ~(np.minimum(one, two) > margin) & ~(np.maximum(one, two) < -margin)
    middle = a + part[:, None] * (b - a)
    size = np.sqrt(((corners[:, 1:] - corners[:, :1]) ** 2).sum(axis=2)).max(axis=1)
    weight = _in_space(corners, middle)
    at = np.einsum("ij,ijk->ik", inside(weight), corners)
    within = margin + 0.25 * size
    reach &= np.linalg.norm(at - middle, axis=1) <= within
    places = np.einsum("ij,ijk->ik", inside(weight), target.sheet.vertex_places[target.corners[triangle]])
    return Block((chord[reach], part[reach], places[reach], within[reach]), looked, int(reach.sum()))


def _in_space(corners: Floats, points: Floats) -> Floats:
    """(k,3) barycentric coordinates of points (k,3) projected into the planes of triangles (k,3,3)."""
    ab, ac, ap = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    zero = np.zeros(len(points))
    long = np.sqrt(dot(ab, ab))
    with np.errstate(invalid="ignore", divide="ignore"):
        x = ab / long[:, None]
        across = ac - dot(ac, x)[:, None] * x
        y = across / np.sqrt(dot(across, across))[:, None]
    flat = [
        np.stack(pair, axis=1)
        for pair in ((zero, zero), (long, zero), (dot(ac, x), dot(ac, y)), (dot(ap, x), dot(ap, y)))
    ]
    return weights(np.stack(flat[:3], axis=1), flat[3])


def _met(
    view: View, sheet: Sheet, curves: Curves, chord: Ints, part: Floats, places: Floats
) -> tuple[Ints, Floats, Floats]:
    """Places where the curves meet the sheet: chords, parts, places on the sheet."""
    part = part.copy()
    for _ in range(HOPS):
        off = np.full(len(chord), np.inf)
        places, active = places.copy(), np.arange(len(chord))
        for _ in range(ROUNDS):
            if not len(active):
                break
            at = curves.at(chord[active], part[active])
            away = at.points - sheet.points(places[active])
            off[active] = np.sqrt(dot(away, away))
            step, places[active] = sheet.missed(at.points, at.slopes, places[active])
            step = np.clip(np.where(np.isfinite(step), step, 0.0), -0.7, 0.7)
            part[active] = np.clip(part[active] + step, -1.5, 2.5)
            active = active[off[active] > SETTLED_OF_EXTENT]
        kept = np.isfinite(places).all(axis=1) & ((off <= NEARLY_MET) | (part < 0.0) | (part > 1.0))
        chord, part, places = chord[kept], part[kept], places[kept]
        now, part = hopped(curves, chord, part)
        moved = (now != chord).any()
        chord = now
        if not moved:
            break
    away = curves.at(chord, part).points - sheet.points(places)
    met = (np.sqrt(dot(away, away)) <= max(MET_OF_EXTENT, ULPS * projection.rounding(view))) & sheet.on_sheet(places)
    on, part = on_chord(part)
    kept = met & on
    return chord[kept], part[kept], places[kept]


def _pierced(view: View, sheet: Sheet, curves: Curves, chord: Ints, part: Floats, places: Floats) -> Events:
    """The events of places where curves meet a sheet, each once; where they only touch it nothing happens, and at
    singular places nothing that is known."""
    kept = once(curves, chord, part, np.zeros(len(chord)))
    chord, part, places = chord[kept], part[kept], places[kept]
    at, normal = curves.at(chord, part), sheet.normals(places)
    through = dot(at.slopes, normal) / np.linalg.norm(at.slopes, axis=1).clip(LEAST_DIVISOR)
    towards = dot(projection.sight(view, at.points), normal)
    crosses = (np.abs(through) > ALONG_SHEET_SINE) & ~_sharp(sheet, places)
    change = np.where(crosses, -np.sign(through * towards), 0.0)
    change = np.where(np.isfinite(change), change, 0.0).astype(np.intp)
    return Events(chord, part, np.full(len(chord), sheet.item), change)


def _sharp(sheet: Sheet, places: Floats) -> Bools:
    """(k,) whether the sheet is all but singular at places."""
    bends = [np.abs(sheet.bends(places, np.broadcast_to(axis, places.shape))) for axis in np.eye(3)]
    return np.asarray(~(np.max(bends, axis=0) <= SHARPEST))
