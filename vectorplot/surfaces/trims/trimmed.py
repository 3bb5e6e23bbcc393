"""Parts of parametrised surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import parameter_range
from vectorplot.errors import InputError
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_numbers import ROUNDING

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class TrimmedSurface(MovableSurface):
    """The part of a parametrised surface over smaller ranges of u and v.

    Parameters
    ----------
    surface : Surface
        What is trimmed.
    u, v : (float, float), optional
        Start and end of the parameters; the whole range where None.

    Raises
    ------
    InputError
        For empty ranges, and for ranges that leave the domain or are more than one round.

    Notes
    -----
    Where the surface is closed a range may run over the seam; if it is as long as the whole one the part is closed too.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> dome = surfaces.TrimmedSurface(surfaces.Sphere(), v=(0.0, np.pi / 2))
    >>> dome.domain.v_start, dome.domain.closed_u
    (0.0, True)
    """

    surface: Surface
    u: Range | None = None
    v: Range | None = None

    def __post_init__(self) -> None:
        # Asked once, so that a range that does not fit is an error here and now.
        _ = self.domain

    @cached_property
    def domain(self) -> Domain:
        """The smaller rectangle."""
        d = self.surface.domain
        u_start, u_end, closed_u = _part("u", self.u, d.u_start, d.u_end, d.closed_u)
        v_start, v_end, closed_v = _part("v", self.v, d.v_start, d.v_end, d.closed_v)
        return Domain(u_start, u_end, v_start, v_end, closed_u=closed_u, closed_v=closed_v)

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.surface.points(u, v)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)


def _part(name: str, wanted: Range | None, start: float, end: float, closed: bool) -> tuple[float, float, bool]:
    """Start and end of a part of a range, and whether it is closed."""
    if wanted is None:
        return start, end, closed
    low, high = parameter_range(name, *wanted)
    slack = ROUNDING * (end - start)
    if closed:
        if high - low > end - start + slack:
            raise InputError(f"{name} from {low:g} to {high:g} is more than one round of {end - start:g}")
        return low, high, high - low >= end - start - slack
    if low < start - slack or high > end + slack:
        raise InputError(f"{name} from {low:g} to {high:g} leaves the range from {start:g} to {end:g}")
    return max(low, start), min(high, end), False
