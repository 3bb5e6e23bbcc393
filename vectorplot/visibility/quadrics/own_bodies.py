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
    """Curves on one body or two: body (2,) their numbers, or -1; form (2,4) linear forms, negative where a body is
    turned away; curves: what is known of them as curves of sheets, which are no sheets of the scene."""

    curves: Family
    body: Ints
    form: Floats
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        return self.curves.between(chords, part)


def own_bodies(bodies: Bodies, curves: Curves, family: Ints) -> tuple[Ints, OwnSides]:
    """The bodies (k,2) that curves of some families (k,), or -1 of none, lie on, and what these hide of them."""
    many = len(curves.families)
    body, form = np.full((many + 1, 2), -1), np.zeros((many + 1, 2, 4))
    for number, known in enumerate(curves.families):
        if isinstance(known, BodiesMeet):
            body[number], form[number] = known.body, known.form
    own = body[family]
    hide: Bools = np.append(np.isin(bodies.same, bodies.same[bodies.hides]), False)
    which, place = np.nonzero((own >= 0) & hide[own])
    return own, OwnSides(which, form[family[which], place], own[which, place])
