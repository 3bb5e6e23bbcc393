"""What a picture shows besides its scene to be read as a chart: colours that are numbers, a box with ticks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vectorplot.arrays import Floats
from vectorplot.errors import InputError

MOST_STEPS = 100
"""Of colours."""


@dataclass(frozen=True)
class Colouring:
    """The colours of all bodies by a number at every point, and the bar beside the picture that says which is which.

    Parameters
    ----------
    by : str or callable
        x, y, z (or height), slope, curvature, the name of a field of items, or a formula in x, y and z, such as "x*y";
        or by(points), which gives (n,) numbers for points (n, 3).
    colour_map : str
        viridis, heat, diverging, land or gray, or the name of one of matplotlib, if that is installed.
    steps : int
        How many colours, 2 to 100.
    label : str, optional
        Above the bar: what by says where None.

    Raises
    ------
    InputError
        For counts out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import Colouring
    >>> block = vp.Scene((vp.Item("block", box((3, 2, 1))),), colouring=Colouring("z", steps=12))
    >>> vp.paint(block, page="A5").width_mm
    148.0
    """

    by: str | Callable[[Floats], Floats]
    colour_map: str = "viridis"
    steps: int = 24
    label: str | None = None

    def __post_init__(self) -> None:
        if not (2 <= self.steps <= MOST_STEPS and float(self.steps).is_integer()):
            raise InputError(f"a colouring of {self.steps} steps: expected 2 to {MOST_STEPS}")

    @property
    def title(self) -> str:
        """What stands above the bar."""
        if self.label is not None:
            return self.label
        return self.by if isinstance(self.by, str) else ""


@dataclass(frozen=True)
class BoxAxes:
    """A box around the scene: grids on its three far sides, numbers and names along its outer edges.

    Parameters
    ----------
    names : three str
        Of the axes.
    size_mm : float
        Height of the capitals of the names; numbers have three quarters of it.

    Raises
    ------
    InputError
        For a size that is not positive, and names that are not three.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.scene import BoxAxes
    >>> from vectorplot.surfaces import Sphere
    >>> drawing = vp.draw(vp.Scene((vp.Item("ball", Sphere()),), box=BoxAxes(("a", "b", "c"))))
    >>> "box" in drawing.items[1]
    True
    """

    names: tuple[str, str, str] = ("x", "y", "z")
    size_mm: float = 3.5

    def __post_init__(self) -> None:
        if len(self.names) != 3 or not all(isinstance(name, str) for name in self.names):
            raise InputError("box: expected three names")
        if not 0.0 < self.size_mm < float("inf"):
            raise InputError(f"box: a size of {self.size_mm:g} mm: expected a number that is finite and positive")
