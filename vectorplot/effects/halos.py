"""Lines that end a little before what is in front of them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import intervals, ragged
from vectorplot.geometry.vectors import norm
from vectorplot.scene.view import View
from vectorplot.tolerances import HALO_MARGIN, UNION_OF_SEGMENT
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines

OWN_DEPTH = 2.0
"""An outline interrupts lines of its own item only if they are so many widths behind it: others meet it."""


def halo(view: View, lines: Lines, seen: Visibility, width: float) -> Visibility:
    """The same parts without what is visible within some width of an outline in front of it, on its outer side; hidden
    parts stay. lines: segments with the sides on which they are outlines; seen: their parts; width: in units of the
    image. Outlines are the visible contours and boundaries among the lines.
    Edge cases: a visible part wholly within a halo is left out. Source: Glaeser, section 7.2, figure 4; decision D-7.
    """
    shown = np.flatnonzero(seen.hidden_by == 0)
    side = lines.sides(view)[seen.segment]
    outline = shown[side[shown] != 0]
    if not len(outline):
        return seen
    base = lines.start[:, seen.segment]
    along = lines.end[:, seen.segment] - base
    start, end = base + seen.low * along, base + seen.high * along
    # A halo wider than the picture is as good as one of the picture's size, and lets the grid keep its digits.
    width = min(width, _diameter(view.image_of(np.concatenate([start[:, shown], end[:, shown]], axis=1))))
    part, low, high = _zones(view, lines.item[seen.segment], side, start, end, shown, outline, width)
    fine = np.full(len(shown), UNION_OF_SEGMENT)
    part, low, high = intervals.union(part, low, high, fine)
    part, low, high = intervals.complement(len(shown), part, low, high, fine)
    which = shown[part]
    if view.eye is not None:
        near, far = view.depth_of(start)[which], view.depth_of(end)[which]
        low, high = grids.in_space(low, near, far), grids.in_space(high, near, far)
    length = (seen.high - seen.low)[which]
    hidden = np.flatnonzero(seen.hidden_by)
    segment = np.concatenate([seen.segment[which], seen.segment[hidden]])
    new_low = np.concatenate([seen.low[which] + low * length, seen.low[hidden]])
    new_high = np.concatenate([seen.low[which] + high * length, seen.high[hidden]])
    count = np.concatenate([np.zeros(len(which), dtype=np.intp), seen.hidden_by[hidden]])
    order = np.lexsort((new_low, segment))
    return Visibility(segment[order], new_low[order], new_high[order], count[order])


def _diameter(image: Floats) -> float:
    """At least the distance of any two points (2,n)."""
    return float(norm(np.ptp(image, axis=1)))


def _zones(
    view: View, item: Ints, side: Ints, start: Floats, end: Floats, shown: Ints, outline: Ints, width: float
) -> tuple[Ints, Floats, Floats]:
    """Where visible parts lie in the halo of outlines: (number in shown, low, high along the part's image).

    item, side (p,): those of the lines that the parts are of.
    """
    image_start, image_end = view.image_of(start), view.image_of(end)
    p0, p1 = image_start[:, shown], image_end[:, shown]
    q0, q1 = image_start[:, outline], image_end[:, outline]
    depth = [view.depth_of(points) for points in (start, end)]
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for part, near in _close_pairs(p0, p1, q0, q1, width):
        outer = side[outline[near]]
        low, high = outer_zones(p0[:, part], p1[:, part], q0[:, near], q1[:, near], outer, width)
        hit = np.flatnonzero(low < high)
        part, near, low, high = part[hit], near[hit], low[hit], high[hit]
        middle = 0.5 * (low + high)
        here = p0[:, part] + middle * (p1[:, part] - p0[:, part])
        behind = _depth_at(view, middle, depth[0][shown[part]], depth[1][shown[part]])
        foot = _foot(here, q0[:, near], q1[:, near])
        front = _depth_at(view, foot, depth[0][outline[near]], depth[1][outline[near]])
        own = item[shown[part]] == item[outline[near]]
        margin = np.where(own, OWN_DEPTH * width, 10.0 * view.tolerance)
        hit = np.flatnonzero(behind - front > margin)
        found.append((part[hit], low[hit], high[hit]))
    part, low, high = (np.concatenate(column) for column in zip(*found, strict=True))
    return part, low, high


def _close_pairs(p0: Floats, p1: Floats, q0: Floats, q1: Floats, width: float) -> list[tuple[Ints, Ints]]:
    """(part, outline) pairs that could be within width of each other."""
    low, high = np.minimum(p0, p1).min(axis=1), np.maximum(p0, p1).max(axis=1)
    typical = 2.0 * width + float(np.abs(q1 - q0).max(axis=0).mean())
    cell = max(grids.cell_size(p0, p1, typical), typical / 2.0)
    grid = grids.Grid.over((low[0], high[0], low[1], high[1]), cell)
    flat = np.ones(p0.shape[1])
    pieces = grids.cut(grid, p0, p1, flat, flat, False)
    left, right = np.minimum(q0, q1), np.maximum(q0, q1)
    margin = width + HALO_MARGIN * (width + float(np.abs(right).max() + np.abs(left).max()))
    box = np.stack([left[0] - margin, right[0] + margin, left[1] - margin, right[1] + margin]).astype(np.float32)
    outline_level = grids.entry_level(grid, box)
    thing, column, row = grids.touched(grid, box, outline_level)
    entries = grids.entries(grid, thing, column, row, outline_level[thing])
    pairs = []
    for level in entries.levels():
        begin, count = entries.of(grid.numbers(pieces.column >> level, pieces.row >> level, level))
        piece = ragged.owner(count)
        step = ragged.place(count)
        pairs.append((pieces.segment[piece], entries.thing[begin[piece] + step]))
    return pairs


def _depth_at(view: View, at: Floats, start: Floats, end: Floats) -> Floats:
    """(n,) depth of the points whose images divide those of segments with end depths start and end."""
    if view.eye is None:
        return start + at * (end - start)
    return 1.0 / ((1.0 - at) / start + at / end)


def _foot(point: Floats, q0: Floats, q1: Floats) -> Floats:
    """(n,) parameter of the point of q0 -> q1 next to a point."""
    axis = q1 - q0
    square = (axis * axis).sum(axis=0)
    at = ((point - q0) * axis).sum(axis=0) / np.where(square > 0.0, square, 1.0)
    return np.asarray(np.clip(at, 0.0, 1.0), dtype=np.float64)


def outer_zones(p0: Floats, p1: Floats, q0: Floats, q1: Floats, side: Ints, width: float) -> tuple[Floats, Floats]:
    """Parameters (n,) between which p0 -> p1 is nearer than width to q0 -> q1, all (2,n), on the side away from the
    surface: side 1 means that lies left of q0 -> q1, -1 right of it. low >= high: nowhere."""
    along, axis = p1 - p0, q1 - q0
    length = np.sqrt((axis * axis).sum(axis=0))
    unit = axis / np.where(length > 0.0, length, 1.0)
    outward = np.asarray(np.stack([unit[1], -unit[0]]) * side, dtype=np.float64)
    arm = p0 - q0
    low, high = _between(arm, along, unit, np.zeros_like(length), length, width, outward)
    for centre in (q0, q1):
        disc_low, disc_high = _in_disc(p0 - centre, along, width)
        one, two = _half_plane(p0 - centre, along, outward)
        disc_low, disc_high = np.maximum(disc_low, one), np.minimum(disc_high, two)
        some = disc_low < disc_high
        low = np.where(some, np.minimum(low, disc_low), low)
        high = np.where(some, np.maximum(high, disc_high), high)
    return np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)


def _between(
    arm: Floats, along: Floats, unit: Floats, least: Floats, most: Floats, width: float, outward: Floats
) -> tuple[Floats, Floats]:
    """Parameters in the rectangle of the given width on the outer side of an outline; (inf, -inf): nowhere."""
    low, high = np.full(least.shape, -np.inf), np.full(least.shape, np.inf)
    for direction, first, last in ((unit, least, most), (outward, np.zeros_like(least), np.full_like(least, width))):
        offset, rate = (arm * direction).sum(axis=0), (along * direction).sum(axis=0)
        safe = np.where(rate != 0.0, rate, 1.0)
        one, two = (first - offset) / safe, (last - offset) / safe
        within = (offset >= first) & (offset <= last)
        low = np.maximum(low, np.where(rate != 0.0, np.minimum(one, two), np.where(within, -np.inf, np.inf)))
        high = np.minimum(high, np.where(rate != 0.0, np.maximum(one, two), np.where(within, np.inf, -np.inf)))
    some = low < high
    return np.where(some, low, np.inf), np.where(some, high, -np.inf)


def _in_disc(arm: Floats, along: Floats, radius: float) -> tuple[Floats, Floats]:
    """Parameters within a disc about the origin of the arms; (inf, -inf): nowhere."""
    a, b = (along * along).sum(axis=0), (arm * along).sum(axis=0)
    root = b * b - a * ((arm * arm).sum(axis=0) - radius * radius)
    some = (root > 0.0) & (a > 0.0)
    half = np.sqrt(np.where(some, root, 0.0))
    safe = np.where(a > 0.0, a, 1.0)
    return np.where(some, (-b - half) / safe, np.inf), np.where(some, (-b + half) / safe, -np.inf)


def _half_plane(arm: Floats, along: Floats, outward: Floats) -> tuple[Floats, Floats]:
    """Parameters on the outer side of a line."""
    offset, rate = (arm * outward).sum(axis=0), (along * outward).sum(axis=0)
    where = -offset / np.where(rate != 0.0, rate, 1.0)
    low = np.where(rate > 0.0, where, np.where((rate == 0.0) & (offset < 0.0), np.inf, -np.inf))
    high = np.where(rate < 0.0, where, np.where((rate == 0.0) & (offset < 0.0), -np.inf, np.inf))
    return low, high
