"""Ramps of colours: what the shades of one palette lie on, so that gradients can be parts of one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.algebra import matmul

ERROR = 1.5
"""By how many steps of 255 colours may be off their ramp: three times what rounding makes of them."""

NONE = -1
"""No ramp."""


@dataclass(frozen=True, eq=False)
class Ramps:
    """Colours that lie between two each: ends (r,2,3) of the ramps; of_item: the number of the ramp of each item."""

    ends: Floats
    of_item: dict[int, int]

    def numbers(self, item: Ints) -> Ints:
        """(n,) the ramps of items (n,), NONE for those without one."""
        return np.array([self.of_item.get(number, NONE) for number in item.tolist()], dtype=np.intp)

    def parts(self, ramp: Ints, colours: Floats) -> Floats:
        """(n,k) where on their ramps (n,) colours (n,k,3) lie, from 0 to 1."""
        first, way = self.ends[ramp, 0], self.ends[ramp, 1] - self.ends[ramp, 0]
        return np.asarray(((colours - first[:, None]) * way[:, None]).sum(axis=2) / (way * way).sum(axis=1)[:, None])

    def on(self, ramp: Ints, colours: Floats) -> Floats:
        """Colours (n,k,3) moved onto their ramps (n,)."""
        first, way = self.ends[ramp, 0], self.ends[ramp, 1] - self.ends[ramp, 0]
        return np.asarray(first[:, None] + self.parts(ramp, colours)[..., None] * way[:, None])


def item_ramps(colours: Floats, item: Ints) -> Ramps:
    """The ramps of those items all of whose colours lie on one: colours (t,k,3) of parts of items (t,)."""
    ends, of_item = [np.zeros((0, 2, 3))], {}
    for number in np.unique(item).tolist():
        own = colours[item == number].reshape(-1, 3)
        first = own[np.argmax(((own - own[0]) ** 2).sum(axis=1))]
        last = own[np.argmax(((own - first) ** 2).sum(axis=1))]
        way = last - first
        if not way.any():
            continue
        part = matmul(own - first, way) / (matmul(way, way))
        if np.abs(own - first - part[:, None] * way).max() <= ERROR:
            of_item[number] = len(ends) - 1
            ends.append(np.stack((first, last))[None])
    return Ramps(np.concatenate(ends), of_item)
