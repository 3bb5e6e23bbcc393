"""How dark shadows are."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.shading.light.illumination import DIRECT_SHARE, SHADOW_SHARE

LEVELS = 9
"""From light to shadow there are so many steps: those between them, one fewer, are the soft border of a shadow."""


def shadow_shades(
    shares: ArrayLike,
    intensity: ArrayLike,
    lacking: ArrayLike,
    cue: ArrayLike = 0.0,
    *,
    dimmed: ArrayLike = -1,
    step: ArrayLike = 1,
) -> Floats:
    """(n,) shades 0 to 1 of points in shadows: those of points in the light, less half of what each light that does
    not get there would give. Where no light gets, half of the face's shade is left, and the cue.

    shares (l,n), intensity (l,) or (l,3), which makes (3,n) shades, and cue as of illumination.shades, with the cue at
    the depth of each point, so that large shadows vary with it; lacking (n,): bit k for light k, as of Decals; dimmed
    (n,): a light that gets there in part, as in a border, or -1; step (n,): how far into the border, 1 to LEVELS - 1.
    Degenerate: points that no light reaches anyway keep their shade.
    Source: Glaeser, section 6.3; decision D-5.
    """
    strength = np.asarray(intensity, dtype=np.float64)
    if strength.ndim == 2:
        return np.stack([shadow_shades(shares, one, lacking, cue, dimmed=dimmed, step=step) for one in strength.T])
    given = np.asarray(shares, dtype=np.float64) * strength[:, None]
    number = np.arange(len(given))[:, None]
    gone = (np.asarray(lacking, dtype=np.int64)[None] >> number) & 1
    # In the middle of each step.
    part = (np.asarray(step)[None] - 0.5) / (LEVELS - 1)
    soft = np.where(np.asarray(dimmed)[None] == number, 1.0 - part * (1.0 - SHADOW_SHARE), 1.0)
    kept = np.where(gone == 1, SHADOW_SHARE, soft)
    total = given.sum(axis=0)
    left = (given * kept).sum(axis=0) / np.where(total > 0.0, total, 1.0)
    return np.asarray(np.clip(DIRECT_SHARE * np.minimum(total, 1.0) * left + np.asarray(cue), 0.0, 1.0))
