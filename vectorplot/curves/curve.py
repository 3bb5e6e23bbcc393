"""What every parametrised curve can do."""

from __future__ import annotations

from typing import Protocol, TypeGuard

from vectorplot.arrays import Floats


class Curve(Protocol):
    """A curve x(t) in space over start <= t <= end.

    closed: whether x(end) = x(start) with the same tangent, so that the parameter may run on.
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
    """Whether a shape is a curve in space: it has tangents."""
    return hasattr(shape, "tangents")
