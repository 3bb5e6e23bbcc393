"""Lines as strokes on the page."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.duplicates import without_duplicates
from vectorplot.drawing.strokes.paths import chosen, concatenated
from vectorplot.drawing.strokes.smooth_duplicates import without_smooth_duplicates
from vectorplot.scene.placement import Placement, fitted_picture
from vectorplot.scene.scene import Page
from vectorplot.scene.view import View
from vectorplot.tolerances.of_the_page import COINCIDENT_MM
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind


def fitted_lines(view: View, lines: Lines, seen: Visibility, page: Page) -> Placement:
    """The place of a picture that fills the page with the parts of lines."""
    ends = np.concatenate(lines.ends(view, seen.segment, seen.low, seen.high), axis=1)
    return fitted_picture(view, page, view.image_of(ends))


def strokes_on_page(view: View, lines: Lines, seen: Visibility, placement: Placement) -> Paths:
    """The parts of lines as strokes on the page, each line once where several lie on each other.

    Of coincident strokes the visible one stays, then the one whose kind comes first, then the one nearer the eye.
    """
    ends = np.stack(lines.ends(view, seen.segment, seen.low, seen.high), axis=2).reshape(3, -1)
    points = placement.on_page(view.image_of(ends))
    count = len(seen.segment)
    kind, item = lines.kind[seen.segment], lines.item[seen.segment]
    offsets = np.arange(0, 2 * count + 1, 2)
    open_ = np.zeros(count, dtype=np.bool_)
    # Lines at the same depth but for rounding go by their items: so neither size nor place decides which one stays.
    depth = np.round(view.depth_of(ends).reshape(-1, 2).sum(axis=1), 8)
    order = np.lexsort((item, depth, kind, seen.hidden_by > 0))
    rank = np.empty(count, dtype=np.intp)
    rank[order] = np.arange(count)
    paths = Paths(points, offsets, open_, kind, item, seen.hidden_by, view.world_of(ends), lines.smooth[seen.segment])
    straight, smooth = np.flatnonzero(~paths.smooth), chosen(paths, paths.smooth)
    once = without_duplicates(chosen(paths, straight), rank[straight], COINCIDENT_MM, placement.page_from_world)
    if not len(smooth):
        return once
    curve_rank = ((smooth.hidden_by > 0) * len(LineKind) + smooth.kind) * len(view.item_vertices) + smooth.item
    return concatenated((once, without_smooth_duplicates(smooth, curve_rank, COINCIDENT_MM)))
