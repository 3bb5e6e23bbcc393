"""Heights on a grid as a smooth surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.parameters import parameter_range
from vectorplot.curves.splines.kinds import AkimaSpline, SplineKind
from vectorplot.errors import InputError
from vectorplot.surfaces.splines.spline_surface import Pair, SplineSurface, spline_surface


def landscape(heights: ArrayLike, x: Pair, y: Pair, kind: SplineKind | None = None) -> SplineSurface:
    """The smooth surface through heights on a regular grid: a terrain.

    Parameters
    ----------
    heights : (m, n) array_like of float
        In world units: x runs along the first index, y along the second.
    x, y : (float, float)
        The coordinates of the first and the last of them.
    kind : SplineKind, optional
        Where None AkimaSpline, which makes no swings beside cliffs and plains; CubicSpline is smoother.

    Returns
    -------
    SplineSurface
        With normals upwards; u and v count the points, 0, 1, 2, ....

    Raises
    ------
    InputError
        For heights that are not finite, fewer than two each way, empty ranges, and closed kinds.

    Notes
    -----
    Of heights that are known at scattered points `grid_of_scattered` makes a grid.

    Source: Glaeser, section 9.5, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> hill = surfaces.landscape([[0, 1, 0], [1, 3, 1], [0, 1, 0]], x=(0, 20), y=(0, 10))
    >>> hill.points(np.array(1.0), np.array(1.0)).round(9).tolist()
    [10.0, 5.0, 3.0]
    """
    kind = AkimaSpline() if kind is None else kind
    if kind.closed:
        raise InputError("landscape: x and y do not come back, its splines cannot be closed")
    try:
        h = np.array(heights, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("landscape: expected rows of heights, all equally long") from None
    if h.ndim != 2 or min(h.shape) < 2:
        raise InputError("landscape: expected at least two heights each way, all rows equally long")
    ranges = parameter_range("landscape: x", *x), parameter_range("landscape: y", *y)
    places = np.meshgrid(*(np.linspace(*r, n) for r, n in zip(ranges, h.shape, strict=True)), indexing="ij")
    return spline_surface(np.stack([*places, h], axis=-1), kind)
