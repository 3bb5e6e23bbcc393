"""Surfaces of revolution: any curve turned about the z-axis."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.surfaces.families.swept.motions import Screw
from vectorplot.surfaces.families.swept.swept import Swept


def revolution_surface(generator: Curve, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v.

    Parameters
    ----------
    generator : Curve
        Its meridian, or any other curve.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        Closed in v after whole turns.

    Raises
    ------
    InputError
        For an empty range.

    Notes
    -----
    Degenerate: where the curve meets the axis the surface has a pole; see `unit_normals`.

    Source: Glaeser, section 8.2, equation 11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> ring = surfaces.revolution_surface(curves.Circle((3, 0, 0), 1.0, axis=(0, 1, 0)))
    >>> ring.domain.closed_u, ring.domain.closed_v
    (True, True)
    """
    return Swept(generator, Screw(), start, end)
