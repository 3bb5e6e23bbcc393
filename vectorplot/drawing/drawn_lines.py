"""Lines as strokes on the page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.duplicates import without_duplicates, without_smooth_duplicates
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.geometry import ragged
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, fitted_picture
from vectorplot.scene.view import View
from vectorplot.tolerances import COINCIDENT_MM, EXACT_MM
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind

MOST_DIVISIONS = 8
"""A line is cut into so many parts at most in one go, to be Bézier curves; all together into so many times
their number."""

MOST_ROUNDS = 6
"""So often what is still no Bézier curve is cut again: where weights change fast the fourth power comes late."""


def fitted_lines(view: View, lines: Lines, seen: Visibility, page: Page) -> Placement:
    """The place of a picture that fills the page with the parts of lines."""
    ends = np.concatenate(lines.ends(view, seen.segment, seen.low, seen.high), axis=1)
    return fitted_picture(view, page, view.image_of(ends))


def strokes_on_page(view: View, lines: Lines, seen: Visibility, placement: Placement) -> Paths:
    """The parts of lines as strokes on the page, each line once where several lie on each other.

    Of coincident strokes the visible one stays, then the one whose kind comes first, then the one nearer the eye.
    """
    seen, parts, handles = _as_cubics(view, lines, seen, placement.scale)
    ends = np.stack([parts.start, parts.end], axis=2).reshape(3, -1)
    points = placement.on_page(view.image_of(ends))
    count, kind, item = len(parts), parts.kind, parts.item
    offsets = np.arange(0, 2 * count + 1, 2)
    open_ = np.zeros(count, dtype=np.bool_)
    # Lines at the same depth but for rounding go by their items: so neither size nor place decides which one stays.
    depth = np.round(view.depth_of(ends).reshape(-1, 2).sum(axis=1), 8)
    rank = np.stack([np.arange(count), item, depth, kind, seen.hidden_by > 0])
    paths = Paths(points, offsets, open_, kind, item, seen.hidden_by, view.world_of(ends), parts.smooth)
    if parts.chords:
        # A page shows the image larger, not turned.
        directions = _at_ends(parts.chords.directions(view))
        paths = replace(paths, directions=directions, curve=parts.chords.curve, handles=_at_ends(handles))
    world = placement.page_from_world
    if not paths.smooth.any():
        return without_duplicates(paths, rank, COINCIDENT_MM, world, seen.segment)
    straight, smooth = np.flatnonzero(~paths.smooth), chosen(paths, paths.smooth)
    given, line = chosen(paths, straight), seen.segment.take(straight)
    once = without_duplicates(given, rank.take(straight, axis=1), COINCIDENT_MM, world, line)
    importance = ((smooth.hidden_by > 0) * len(LineKind) + smooth.kind) * len(view.item_vertices) + smooth.item
    run = _runs(smooth)
    curve_rank = importance * (run.max(initial=0) + 1) + run
    return concatenated((once, without_smooth_duplicates(smooth, curve_rank, COINCIDENT_MM)))


def _runs(chords: Paths) -> Ints:
    """(n,) numbers of the parts of curves that chords (n,) belong to: one ends where its curve does, or turns back, as
    a border does that lies on itself."""
    along = chords.points[1::2] - chords.points[::2]
    back = (along[1:] * along[:-1]).sum(axis=1) < 0.0
    new = (chords.curve[1:] != chords.curve[:-1]) | (back & (chords.curve[1:] >= 0))
    return np.concatenate([[0], np.cumsum(new)])[: len(along)]


def _as_cubics(view: View, lines: Lines, seen: Visibility, scale: float) -> tuple[Visibility, Lines, Floats]:
    """Visible parts, cut so finely that they are cubics, as lines, and (n,2) how long the handles of these are in mm:
    NaN where a part is none."""
    parts, most = lines.cut(view, seen.segment, seen.low, seen.high), MOST_DIVISIONS * len(seen.segment)
    if parts.chords is None:
        return seen, parts, np.zeros((0, 2))
    handles, off = parts.chords.handles(view)
    for _ in range(MOST_ROUNDS):
        cuts = _divisions(scale * off)
        if (cuts == 1).all() or cuts.sum() > most:
            break
        seen = _divided(seen, cuts)
        parts = lines.cut(view, seen.segment, seen.low, seen.high)
        assert parts.chords is not None
        handles, off = parts.chords.handles(view)
    return seen, parts, np.where((scale * off <= EXACT_MM)[:, None], scale * handles, np.nan)


def _divisions(off_mm: Floats) -> Ints:
    """(n,) into how many parts lines have to be cut for each to be a cubic, 1 where nothing helps; off_mm (n,): how far
    cubics are off them.

    Source: Farin, Curves and Surfaces for CAGD, section 6.5: the difference falls with the fourth power of the length.
    """
    ratio = np.where(np.isfinite(off_mm), off_mm / EXACT_MM, 1.0)
    return np.clip(np.ceil(np.sqrt(np.sqrt(ratio))), 1, MOST_DIVISIONS).astype(np.intp)


def _divided(seen: Visibility, count: Ints) -> Visibility:
    """The parts cut into so many equal ones each (k,)."""
    own, share = ragged.owner(count), ragged.place(count) / count[ragged.owner(count)]
    step = (seen.high - seen.low)[own]
    low, high = seen.low[own] + share * step, seen.low[own] + (share + 1.0 / count[own]) * step
    ends = ragged.offsets(count)[1:] - 1
    high[ends] = seen.high
    return Visibility(seen.segment[own], low, high, seen.hidden_by[own])


def _at_ends(directions: Floats) -> Floats:
    """(2n,2) the directions, or the lengths of handles, at the ends of strokes of two points; (n,2): how each leaves
    its first, arrives at its last one."""
    result = np.full((2 * len(directions), 2), np.nan)
    result[::2, 1], result[1::2, 0] = directions.T
    return result
