"""What every parametrised curve can do."""

from __future__ import annotations

from typing import Protocol, TypeGuard

from vectorplot.arrays import Floats


class Curve(Protocol):
    """What every curve x(t) in space can do, start <= t <= end.

    Notes
    -----
    A protocol: whatever has these members is a curve, of this package or of a user. start and end are the first and the
    last parameter. closed says whether x(end) = x(start) with the same tangent, so that the parameter may run on.
    points(t) and tangents(t) take parameters of any shape (...) and give points and derivatives by t, (..., 3) both, in
    world units; NaN where the curve has a hole.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> def chord(curve: curves.Curve) -> float:
    ...     first, last = curve.points(np.array([curve.start, curve.end]))
    ...     return float(np.linalg.norm(last - first))
    >>> chord(curves.Line((0, 0, 0), (3, 4, 0)))
    5.0
    """

    @property
    def start(self) -> float:
        """The first parameter."""
        ...

    @property
    def end(self) -> float:
        """The last parameter."""
        ...

    @property
    def closed(self) -> bool:
        """Whether the curve is a smooth loop."""
        ...

    def points(self, t: Floats) -> Floats:
        """(..., 3) points at the parameters t (...)."""
        ...

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        ...


def is_curve(shape: object) -> TypeGuard[Curve]:
    """Whether a shape is a curve in space.

    Parameters
    ----------
    shape : object
        Whatever an item may show: a mesh, a surface, a curve.

    Returns
    -------
    bool
        True for what has tangents.

    Examples
    --------
    >>> from vectorplot import curves, surfaces
    >>> curves.is_curve(curves.Circle()), curves.is_curve(surfaces.Sphere())
    (True, False)
    """
    return hasattr(shape, "tangents")
