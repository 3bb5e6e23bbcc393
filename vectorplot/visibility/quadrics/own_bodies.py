"""Curves that lie on bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.conic_arcs import OwnSides
from vectorplot.visibility.smooth.sheets.family import Along, Chords, Family
from vectorplot.visibility.smooth.tracing.traced_curves import Curves


@dataclass(frozen=True, eq=False)
class BodiesMeet:
    """Curves on one body or two: body (k,2) their numbers, or -1; form (k,2,4) linear forms, negative where a body is
    turned away; curves: what is known of them as curves of sheets, which are no sheets of the scene.

    The row of a curve is its level; one row is that of all of them.
    """

    curves: Family
    body: Ints
    form: Floats
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        return self.curves.between(chords, part)


def own_bodies(bodies: Bodies, curves: Curves, curve: Ints) -> tuple[Ints, OwnSides]:
    """The bodies (n,2) that some of the curves (n,), or -1 of none, lie on, and what these hide of them."""
    known = [(k, some) for k, some in enumerate(curves.families) if isinstance(some, BodiesMeet)]
    own, which, forms = np.full((len(curve), 2), -1), [np.zeros(0, dtype=np.intp)], [np.zeros((0, 2, 4))]
    family, level = np.append(curves.family, -1)[curve], np.append(curves.level, 0.0)[curve]
    for k, some in known:
        of = np.flatnonzero(family == k)
        row = level[of].astype(np.intp) if len(some.body) > 1 else np.zeros(len(of), dtype=np.intp)
        own[of] = some.body[row]
        which.append(of)
        forms.append(some.form[row])
    row, form = np.concatenate(which), np.concatenate(forms)
    hide: Bools = np.append(np.isin(bodies.same, bodies.same[bodies.hides]), False)
    line, place = np.nonzero((own[row] >= 0) & hide[own[row]])
    return own, OwnSides(row[line], form[line, place], own[row[line], place])
