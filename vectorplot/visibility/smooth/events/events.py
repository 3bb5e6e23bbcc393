"""Where along a curve the number of sheets in front of it changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.tolerances.of_lengths import BEYOND_END, SAME_EVENT
from vectorplot.visibility.smooth.tracing.traced_curves import Curves


@dataclass(frozen=True, eq=False)
class Events:
    """Places on curves: the chord (k,) by the point at which it begins, the part (k,) of it; and by how much (k,) the
    number of sheets of an item (k,) in front of the curve rises there, going forwards."""

    chord: Ints
    part: Floats
    item: Ints
    change: Ints

    def __len__(self) -> int:
        return len(self.chord)


def all_events(parts: Sequence[Events]) -> Events:
    """All events of all parts."""
    none = np.zeros(0, dtype=np.intp)
    return records.joined((Events(none, np.zeros(0), none, none), *parts))


def hopped(curves: Curves, chord: Ints, part: Floats) -> tuple[Ints, Floats]:
    """The same places, those beyond an end of their chord on the next one, if the curve goes on there."""
    owner = curves.owner[chord]
    first, last = curves.offsets[owner], curves.offsets[owner + 1] - 2
    closed = curves.closed[owner]
    on, back = part > 1.0, part < 0.0
    forth = np.where(chord < last, chord + 1, np.where(closed, first, chord))
    moved = np.where(forth != chord, part - 1.0, part)
    before = np.where(chord > first, chord - 1, np.where(closed, last, chord))
    moved_back = np.where(before != chord, part + 1.0, part)
    return np.where(on, forth, np.where(back, before, chord)), np.where(on, moved, np.where(back, moved_back, part))


def on_chord(part: Floats) -> tuple[Bools, Floats]:
    """Which places (k,) lie on their chords, and the parts of it without rounding beyond its ends."""
    inside = (part >= -BEYOND_END) & (part <= 1.0 + BEYOND_END)
    return np.asarray(inside), np.clip(part, 0.0, 1.0)


def once(curves: Curves, chord: Ints, part: Floats, other: Floats) -> Ints:
    """The indices of different places: of several that agree, along the curve and in other (k,), one stays."""
    owner = curves.owner[chord]
    # The end of a closed curve is its start.
    last = curves.closed[owner] & (chord == curves.offsets[owner + 1] - 2) & (part > 1.0 - SAME_EVENT)
    where = np.where(last, curves.offsets[owner] + (part - 1.0), chord + part)
    kept = np.lexsort((other, where, owner))
    for _ in range(2):
        # Places that agree along the curve stand together; those that differ in other may stand between them.
        o, w, x = owner[kept], where[kept], other[kept]
        same = (o[1:] == o[:-1]) & (np.abs(w[1:] - w[:-1]) < SAME_EVENT) & (np.abs(x[1:] - x[:-1]) < SAME_EVENT)
        kept = kept[np.concatenate([[True], ~same])] if len(kept) else kept
        kept = kept[np.lexsort((where[kept], other[kept], owner[kept]))]
    return kept
