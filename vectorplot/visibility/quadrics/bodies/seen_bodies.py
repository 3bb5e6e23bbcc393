"""All bodies of a scene that are drawn in closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.visibility.quadrics.bodies.capped_covers import capped_covers
from vectorplot.visibility.quadrics.bodies.covers import Covers, ball_covers
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.visibility.quadrics.bodies.seen_balls import Balls
from vectorplot.visibility.quadrics.bodies.seen_capped import CappedBodies


@dataclass(frozen=True, eq=False)
class Bodies:
    """Balls and, numbered on from them, capped bodies."""

    balls: Balls
    capped: CappedBodies

    def __len__(self) -> int:
        return len(self.balls) + len(self.capped)

    @property
    def sight(self) -> EyeCoordinates:
        """The coordinates in which they are given."""
        return self.balls.sight

    @property
    def tolerance(self) -> float:
        """What counts as distance zero."""
        return self.balls.tolerance

    @cached_property
    def item(self) -> Ints:
        """(n,) the items whose shapes they are."""
        return np.concatenate([self.balls.item, self.capped.item])

    @cached_property
    def hides(self) -> Bools:
        """(n,) whether they hide."""
        return np.concatenate([self.balls.hides, self.capped.hides])

    @cached_property
    def same(self) -> Ints:
        """(n,) the first body at the same place and of the same form: each other hides nothing of it."""
        return np.concatenate([self.balls.same, self.capped.same + len(self.balls)])

    @cached_property
    def reach(self) -> Floats:
        """(n,2,3) smallest and largest coordinates."""
        around = np.stack([self.balls.centre - self.balls.reach, self.balls.centre + self.balls.reach], axis=1)
        return np.concatenate([around, self.capped.reach])

    def hiding_alike(self, which: Ints) -> tuple[Ints, Ints]:
        """The bodies that hide and are equal to those which (k,), these included: index into which, and body (n,)."""
        hiding = np.flatnonzero(self.hides)
        hiding = hiding[np.argsort(self.same[hiding], kind="stable")]
        first, last = (np.searchsorted(self.same[hiding], self.same[which], side) for side in ("left", "right"))
        return ragged.owner(last - first), hiding[ragged.ranges(first, last - first)]

    def covers(self, which: Ints) -> tuple[Covers, ...]:
        """What bodies hide, by their kinds; covers of kinds that the scene lacks are not among them."""
        count = len(self.balls)
        capped = capped_covers(self.capped, which[which >= count] - count)
        every = [*ball_covers(self.balls, which[which < count]), *(replace(c, body=c.body + count) for c in capped)]
        return tuple(some for some in every if len(some))

    def some(self, which: Bools) -> Bodies:
        """Some of the bodies, those of a mask (n,)."""
        count = len(self.balls)
        return Bodies(self.balls.some(which[:count]), self.capped.some(which[count:]))
