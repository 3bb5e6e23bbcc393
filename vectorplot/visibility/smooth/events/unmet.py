"""Stretches of curves that come close to a sheet and do not pierce it as far as is known: there sight lines decide.

At an apex, a pole, a pinch point or a cuspidal edge a sheet has no normal, and Newton's method finds no meeting; where
it finds one nothing says on which side of the sheet a curve goes on.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.exact import intervals
from vectorplot.visibility.smooth.events.events import Events
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves


def unmet_stretches(
    curves: Curves, sheets: Sheets, number: Ints, chord: Ints, part: Floats, reach: Floats, met: Ints, found: Events
) -> Events:
    """The ends of the stretches of curves that are close to a sheet, but for those with an event that was found: events
    that change nothing by themselves, so that what changes between them is looked for.

    chord, part (k,): places close to the sheets of these numbers (k,); reach (k,): how far around them the curve may
    meet the sheet; found (e,): the events, with the sheets of the numbers met (e,).
    """
    lengths = _Lengths(curves)
    owner, at = curves.owner[chord], lengths.at(chord, part)
    around = reach / lengths.total[owner]
    low, high = np.clip(at - around, 0.0, 1.0), np.clip(at + around, 0.0, 1.0)
    # A curve near several sheets counts once for each.
    cases, case = np.unique(owner * len(sheets) + number, return_inverse=True)
    case, low, high = intervals.union(case.ravel(), low, high, np.zeros(len(cases)))
    changing = np.flatnonzero(found.change)
    chord, where = found.chord[changing], curves.owner[found.chord[changing]] * len(sheets) + met[changing]
    there = np.searchsorted(cases, where)
    near = np.flatnonzero(there < len(cases))
    near = near[cases[there[near]] == where[near]]
    there, event = there[near], lengths.at(chord[near], found.part[changing[near]])
    last = np.searchsorted(2.0 * case + low, 2.0 * there + event, side="right") - 1
    inside = (last >= 0) & (case[last] == there) & (event <= high[last]) if len(case) else np.zeros(0, dtype=np.bool_)
    open_ = np.ones(len(case), dtype=np.bool_)
    open_[last[inside]] = False
    case, ends = np.tile(case[open_], 2), np.concatenate([low[open_], high[open_]])
    inner = (ends > 0.0) & (ends < 1.0)
    owner, number = np.divmod(cases[case[inner]], max(len(sheets), 1))
    chord, part = lengths.place(owner, ends[inner])
    return Events(chord, part, sheets.item[number], np.zeros(len(chord), dtype=np.intp))


class _Lengths:
    """Places along curves by lengths of chords, 0 to 1 on each curve; total (m,): the lengths."""

    def __init__(self, curves: Curves) -> None:
        self.curves = curves
        self.step = np.zeros(len(curves.points))
        first = curves.chords
        self.step[first] = np.linalg.norm(curves.points[first + 1] - curves.points[first], axis=1)
        self.before = np.cumsum(self.step) - self.step
        self.start = self.before[curves.offsets[:-1]]
        total = np.add.reduceat(self.step, curves.offsets[:-1]) if len(curves) else np.zeros(0)
        self.total = np.where(total > 0.0, total, 1.0)

    def at(self, chord: Ints, part: Floats) -> Floats:
        """(k,) where places are."""
        owner = self.curves.owner[chord]
        return np.asarray((self.before[chord] - self.start[owner] + part * self.step[chord]) / self.total[owner])

    def place(self, owner: Ints, at: Floats) -> tuple[Ints, Floats]:
        """(k,) chords and (k,) parts of places on the curves owner (k,)."""
        length = self.start[owner] + at * self.total[owner]
        first, last = self.curves.offsets[owner], self.curves.offsets[owner + 1] - 2
        chord = np.clip(np.searchsorted(self.before, length, side="right") - 1, first, last)
        step = np.where(self.step[chord] > 0.0, self.step[chord], 1.0)
        return chord, np.clip((length - self.before[chord]) / step, 0.0, 1.0)
