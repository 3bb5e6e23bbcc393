"""Surfaces swept by a curve that moves; a line sweeps a ruled surface, a circle a tubular one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import parameter_range
from vectorplot.curves.second_derivatives import second_derivatives
from vectorplot.surfaces.families.swept.motions import Motion
from vectorplot.surfaces.jets import FirstJets, SecondJets
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True, eq=False)
class Swept(MovableSurface):
    """The points x(u, v) of a generating curve g(u) after a motion for the time v.

    Parameters
    ----------
    generator : Curve
        g; a line sweeps a ruled surface, a circle a tubular one.
    motion : Motion
        What carries it.
    start, end : float
        The range of v.

    Raises
    ------
    InputError
        For an empty range of v.

    Notes
    -----
    The domain closes in u where the curve is a loop, in v where the motion repeats. Derivatives are exact where the
    curve's are.

    Source: Glaeser, section 8.2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> pipe = surfaces.Swept(curves.Circle(), surfaces.Translation(curves.Line((0, 0, 0), (0, 0, 1))), 0.0, 5.0)
    >>> pipe.points(np.array(0.0), np.array(5.0)).tolist()
    [1.0, 0.0, 5.0]
    """

    generator: Curve
    motion: Motion
    start: float
    end: float

    def __post_init__(self) -> None:
        parameter_range("surface", self.start, self.end)

    @cached_property
    def domain(self) -> Domain:
        """u as on the generating curve, v from start to end."""
        g = self.generator
        repeats = self.motion.repeats(self.start, self.end)
        return Domain(g.start, g.end, self.start, self.end, closed_u=g.closed, closed_v=repeats)

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.motion.moved(self.generator.points(u), 1.0, np.asarray(v))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        g, v = self.generator, np.asarray(v)
        return self.motion.moved(g.tangents(u), 0.0, v), self.motion.velocities(g.points(u), 1.0, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        g, v = self.generator, np.asarray(v)
        return (
            self.motion.moved(second_derivatives(g, u), 0.0, v),
            self.motion.velocities(g.tangents(u), 0.0, v),
            self.motion.accelerations(g.points(u), 1.0, v),
        )

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v: the generating curve is asked once."""
        at, along, v = self.generator.points(u), self.generator.tangents(u), np.asarray(v)
        return self.motion.moved(at, 1.0, v), self.motion.moved(along, 0.0, v), self.motion.velocities(at, 1.0, v)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives."""
        at, along, v = self.generator.points(u), self.generator.tangents(u), np.asarray(v)
        return (
            self.motion.moved(at, 1.0, v),
            self.motion.moved(along, 0.0, v),
            self.motion.velocities(at, 1.0, v),
            self.motion.moved(second_derivatives(self.generator, u), 0.0, v),
            self.motion.velocities(along, 0.0, v),
            self.motion.accelerations(at, 1.0, v),
        )
