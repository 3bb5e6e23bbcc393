"""Where items stand: words that move what stands before them, or repeat it."""

from __future__ import annotations

from collections.abc import Callable

from vectorplot.io.scenes.items.item_cursor import ItemCursor
from vectorplot.io.scenes.items.scene_item import Draft
from vectorplot.io.scenes.items.scene_placement import Placement, moved, read_matrix, read_rotation, read_scale, turned
from vectorplot.io.scenes.scene_words import Words

MOST_COPIES = 100_000
"""So often a single item, or a group of them, may be repeated."""


def _read_ring(reader: ItemCursor, draft: Draft) -> None:
    """How many copies stand around an axis."""
    reader.at += 1
    axis = "z"
    if reader.words[reader.at] in ("x", "y", "z"):
        axis = reader.words[reader.at]
        reader.at += 1
    count = _count(reader, draft, "a ring")
    draft.places = [turned(place, axis, 360.0 * k / count) for k in range(count) for place in draft.places]


def _read_grid(reader: ItemCursor, draft: Draft) -> None:
    """How many copies stand along x, y and perhaps z, and how far apart."""
    reader.at += 1
    counts = [_count(reader, draft, "a grid")]
    while reader.words[reader.at] != "apart" and len(counts) < 3:
        counts.append(_count(reader, draft, "a grid"))
    if reader.words[reader.at] != "apart":
        reader.fail(f"grid: expected 'apart' and distances, got {reader.source.shown(reader.at)}", draft)
    steps, reader.at = reader.source.numbers(reader.at + 1, len(counts), draft.owner, "a distance of the grid")
    for axis, (count, step) in enumerate(zip(counts, steps, strict=True)):
        _check_copies(reader, draft, count)
        ways = [[step * k if axis == one else 0.0 for one in range(3)] for k in range(count)]
        draft.places = [moved(place, *way) for way in ways for place in draft.places]


def _count(reader: ItemCursor, draft: Draft, what: str) -> int:
    count = reader.source.whole(reader.at, draft.owner, f"the copies of {what}")
    if count < 1:
        reader.fail(f"{what} of {count} copies: expected 1 or more", draft)
    _check_copies(reader, draft, count)
    reader.at += 1
    return count


def _check_copies(reader: ItemCursor, draft: Draft, count: int) -> None:
    if count * len(draft.places) > MOST_COPIES:
        reader.fail(f"more than {MOST_COPIES} copies", draft)


def _modifier(
    read: Callable[[Words, int, str, Placement], tuple[Placement, int]],
) -> Callable[[ItemCursor, Draft], None]:
    """How to read words that move an item."""

    def handle(reader: ItemCursor, draft: Draft) -> None:
        found = [read(reader.source, reader.at, draft.owner, place) for place in draft.places]
        draft.places, reader.at = [place for place, _ in found], found[0][1]

    return handle


PLACE_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    "rotation": _modifier(read_rotation),
    "scale": _modifier(read_scale),
    "matrix": _modifier(read_matrix),
    "ring": _read_ring,
    "grid": _read_grid,
}
"""What reads words that move and repeat, but for the translation."""

MODIFIERS = ("translation", *PLACE_WORDS)
"""The words that move and repeat."""
