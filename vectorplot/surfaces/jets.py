"""Points and derivatives of a surface at once: what they have in common, sines say, is computed a single time."""

from __future__ import annotations

from typing import Protocol, TypeGuard

from vectorplot.arrays import Floats
from vectorplot.surfaces.surface import Surface

FirstJets = tuple[Floats, Floats, Floats]
"""Points (..., 3), and their derivatives by u and by v."""

SecondJets = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
"""These, and the second derivatives: by u twice, by u and v, by v twice."""


class WithJets(Protocol):
    """A surface that tells its points and derivatives at once; to the last bit what it says when asked for each."""

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v."""
        ...

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these, and the second derivatives: by u twice, by u and v, by v twice."""
        ...


def tells_jets(surface: Surface) -> TypeGuard[WithJets]:
    """Whether a surface tells its points and derivatives at once.

    isinstance, which looks through all members of the protocol, takes as long as evaluating a few points.
    """
    return hasattr(surface, "first_jets") and hasattr(surface, "second_jets")


def first_jets(surface: Surface, u: Floats, v: Floats) -> FirstJets:
    """(..., 3) points of any surface and derivatives by u and by v, asked for one after the other where it does not
    tell them at once."""
    if tells_jets(surface):
        return surface.first_jets(u, v)
    return surface.points(u, v), *surface.partials(u, v)


def second_jets(surface: Surface, u: Floats, v: Floats) -> SecondJets:
    """(..., 3) these, and the second derivatives: by u twice, by u and v, by v twice."""
    if tells_jets(surface):
        return surface.second_jets(u, v)
    return surface.points(u, v), *surface.partials(u, v), *surface.second_partials(u, v)
