"""Lines on the surfaces of items: what words about them say."""

from __future__ import annotations

from collections.abc import Callable

from vectorplot.io.scenes.items.item_cursor import ItemCursor
from vectorplot.io.scenes.items.scene_curves import (
    CurveDraft,
    read_detail,
    read_integral_lines,
    read_isophote_edges,
    read_isophotes,
    read_level_lines,
    read_parameter_lines,
    read_sections,
    read_slices,
    read_smooth_contours,
    read_smooth_lines,
    read_surface_curve,
    read_terrain_lines,
)
from vectorplot.io.scenes.items.scene_item import Draft
from vectorplot.io.scenes.scene_words import INTEGRAL_WORDS, TERRAIN_WORDS, Words


def _curves(
    read: Callable[[Words, int, str, CurveDraft], tuple[CurveDraft, int]],
) -> Callable[[ItemCursor, Draft], None]:
    """How to read words about the lines of a surface."""

    def handle(reader: ItemCursor, draft: Draft) -> None:
        draft.curves, reader.at = read(reader.source, reader.at, draft.owner, draft.curves)

    return handle


def _integral_lines(reader: ItemCursor, draft: Draft) -> None:
    """Words about integral curves: what they begin with depends on the kind of the item."""
    draft.curves, reader.at = read_integral_lines(reader.source, reader.at, draft.owner, draft.curves, draft.kind)


SURFACE_LINE_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    "parameter_lines": _curves(read_parameter_lines),
    "isophotes": _curves(read_isophotes),
    "sections": _curves(read_sections),
    "level_lines": _curves(read_level_lines),
    "slices": _curves(read_slices),
    "surface_curve": _curves(read_surface_curve),
    **dict.fromkeys(TERRAIN_WORDS, _curves(read_terrain_lines)),
    "smooth_lines": _curves(read_smooth_lines),
    "smooth_contours": _curves(read_smooth_contours),
    "isophote_edges": _curves(read_isophote_edges),
    "detail": _curves(read_detail),
    **dict.fromkeys(INTEGRAL_WORDS, _integral_lines),
}
"""What reads words about lines on an item."""
