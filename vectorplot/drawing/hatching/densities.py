"""How dense strokes are for a darkness: so that the ink covers the share of the paper that is asked."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.hatching import Hatching

CROSSED_FROM = 0.5
"""From this darkness on strokes cross."""

LEAST_COVER = 0.02
"""What needs less ink than this share of the paper stays white: a stroke alone would be a line, and no shade."""

LEVELS = 4
"""Lines begin at two to this power different darknesses: more of them look restless, fewer show as steps."""


def even_spacings(hatching: Hatching, darkness: Floats) -> tuple[Floats, Floats]:
    """(n,) the distances of the strokes of the first and of the second family in places of one darkness (n,), 0 to 1;
    infinite where there are none.

    Strokes of one width w at a distance s cover w/s of the paper, crossing ones 1 - (1 - w/s)^2.
    """
    cover = darkness * hatching.darkest
    cover = np.where(cover >= LEAST_COVER, cover, 0.0)
    crossed = (darkness >= CROSSED_FROM) & hatching.cross
    share = np.where(crossed, 1.0 - np.sqrt(1.0 - np.minimum(cover, 1.0)), cover)
    with np.errstate(divide="ignore"):
        first = hatching.width_mm / share
    return first, np.where(crossed, first, np.inf)


def covers(hatching: Hatching, darkness: Floats) -> tuple[Floats, Floats]:
    """(n,) the shares of the paper that the strokes of the first and of the second family cover where it is as dark as
    (n,) and darkness varies: the second one begins where the first one is as dense as can be."""
    cover = darkness * hatching.darkest
    cover = np.where(cover >= LEAST_COVER, cover, 0.0)
    first = np.minimum(cover, hatching.width_mm / hatching.spacing_mm)
    with np.errstate(invalid="ignore", divide="ignore"):
        second = np.where(cover > first, 1.0 - (1.0 - cover) / (1.0 - first), 0.0)
    return first, second


def thresholds(hatching: Hatching, family: int, line: Ints) -> Floats:
    """(k,) the darkness above which a line of a family, 0 or 1, is drawn where darkness varies: covers turned round."""
    rank = ranks(line, 1 << LEVELS)
    share = hatching.width_mm / hatching.spacing_mm
    cover = rank * share if family == 0 else 1.0 - (1.0 - share) * (1.0 - rank * share)
    return np.asarray(np.maximum(cover, LEAST_COVER) / hatching.darkest)


def ranks(line: Ints, count: int) -> Floats:
    """(k,) the order in which lines, by their numbers, come to be drawn where it becomes darker, from 0 to 1: the
    binary digits of the number turned round, as many as count lines need.

    So lines half as dense as the densest ones are every second one of these, and every stroke runs on into what is
    darker.
    Source: van der Corput, Verteilungsfunktionen (1935).
    """
    digits = max(count - 1, 1).bit_length()
    rest = line % (1 << digits)
    result = np.zeros(len(line), dtype=np.intp)
    for _ in range(digits):
        result = 2 * result + (rest & 1)
        rest = rest >> 1
    return np.asarray((result + 0.5) / (1 << digits))
