"""Translation surfaces: one curve moved along another."""

from __future__ import annotations

from vectorplot.curves.curve import Curve
from vectorplot.surfaces.families.motions import Translation
from vectorplot.surfaces.families.swept import Swept


def translation_surface(generator: Curve, path: Curve) -> Swept:
    """The surface g(u) + h(v) of two curves. Source: Glaeser, section 8.2, equation 10."""
    return Swept(generator, Translation(path), path.start, path.end)
