"""Parameters moved into the domain of a surface."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.surface import Domain


def wrapped(domain: Domain, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """The parameters moved by whole periods into the domain, in its closed directions."""
    width, height = domain.size
    if domain.closed_u:
        u = u - np.floor((u - domain.u_start) / width) * width
    if domain.closed_v:
        v = v - np.floor((v - domain.v_start) / height) * height
    return u, v
