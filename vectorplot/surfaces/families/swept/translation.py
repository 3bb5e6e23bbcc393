"""Translation surfaces: one curve moved along another."""

from __future__ import annotations

from vectorplot.curves.curve import Curve
from vectorplot.surfaces.families.swept.motions import Translation
from vectorplot.surfaces.families.swept.swept import Swept


def translation_surface(generator: Curve, path: Curve) -> Swept:
    """The surface g(u) + h(v) of two curves.

    Parameters
    ----------
    generator : Curve
        g.
    path : Curve
        h.

    Returns
    -------
    Swept
        Closed where a curve is a loop.

    Raises
    ------
    InputError
        For a path of an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 10.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> arch, road = curves.Circle(axis=(1, 0, 0), end=np.pi), curves.Line((0, 0, 0), (1, 0, 0), end=10.0)
    >>> tunnel = surfaces.translation_surface(arch, road)
    >>> tunnel.domain.size[1], tunnel.points(np.array(0.0), np.array(10.0)).tolist()
    (10.0, [10.0, 1.0, 0.0])
    """
    return Swept(generator, Translation(path), path.start, path.end)
