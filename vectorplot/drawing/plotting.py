"""What a plotter has to do for a drawing: how far its pen goes, how often it is lifted, and how long that takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.pen_order import gaps_mm
from vectorplot.drawing.strokes import concatenated
from vectorplot.errors import InputError
from vectorplot.tolerances import COINCIDENT_MM

DOWN_MM_PER_S = 40.0
"""How fast pens draw, where nobody says it: a quarter of what small plotters can, as drivers of these have it."""

UP_MM_PER_S = 100.0
"""How fast a lifted pen goes."""

LIFT_S = 0.3
"""What it takes to lift a pen and to set it down again, by a servo."""


@dataclass(frozen=True)
class PlotEstimate:
    """The way of the pens of a plotter.

    Parameters
    ----------
    down_mm : float
        How far pens go on the paper.
    up_mm : float
        How far they go in the air from stroke to stroke of a layer.
    lifts : int
        How often they are lifted: at the end of each layer, and wherever a stroke does not begin where the last one
        ended.
    pens : int
        How many layers have strokes: the pens that somebody puts in.

    Examples
    --------
    >>> from vectorplot.drawing import PlotEstimate
    >>> PlotEstimate(down_mm=4000.0, up_mm=1000.0, lifts=100, pens=1).minutes()
    2.3333333333333335
    """

    down_mm: float
    up_mm: float
    lifts: int
    pens: int

    def minutes(
        self, down_mm_per_s: float = DOWN_MM_PER_S, up_mm_per_s: float = UP_MM_PER_S, lift_s: float = LIFT_S
    ) -> float:
        """How long the pens take at these speeds.

        Parameters
        ----------
        down_mm_per_s, up_mm_per_s : float
            On the paper and in the air, positive.
        lift_s : float
            Seconds to lift a pen and set it down again.

        Returns
        -------
        float
            Without the time that pens are changed in, and that a machine takes to get up to speed.

        Raises
        ------
        InputError
            For speeds that are not positive, and lifts in less than no time.

        Examples
        --------
        >>> from vectorplot.drawing import PlotEstimate
        >>> PlotEstimate(down_mm=600.0, up_mm=0.0, lifts=0, pens=1).minutes(down_mm_per_s=10.0)
        1.0
        """
        _check_speeds(down_mm_per_s, up_mm_per_s, lift_s)
        return (self.down_mm / down_mm_per_s + self.up_mm / up_mm_per_s + self.lifts * lift_s) / 60.0


def _check_speeds(down: float, up: float, lift: float) -> None:
    if not (down > 0.0 and up > 0.0 and lift >= 0.0):
        raise InputError(f"speeds of {down:g} and {up:g} mm/s, lifts of {lift:g} s: expected positive speeds")


def plot_estimate(drawing: Drawing) -> PlotEstimate:
    """What a plotter has to do for a drawing.

    Parameters
    ----------
    drawing : Drawing
        Its strokes, in their order, on layers that are plotted; curves count as the polylines that they were fitted to.

    Returns
    -------
    PlotEstimate
        How far pens go, and how often they are lifted.

    Raises
    ------
    InputError
        For what is no Drawing.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import plot_estimate
    >>> paths = vp.Paths.of_polylines([[(0, 0), (30, 0)], [(30, 10), (0, 10)]])
    >>> plot_estimate(vp.Drawing(100, 80, (vp.Layer("two lines", vp.Pen(), (paths,)),)))
    PlotEstimate(down_mm=60.0, up_mm=10.0, lifts=2, pens=1)
    """
    if not isinstance(drawing, Drawing):
        raise InputError(f"plot_estimate: expected a Drawing, got a {type(drawing).__name__}")
    layers = (concatenated(layer.strokes) for layer in drawing.layers if layer.plotted)
    parts = [paths for paths in layers if np.any(np.diff(paths.offsets) > 0)]
    gaps = [gaps_mm(paths) for paths in parts]
    return PlotEstimate(
        float(sum(stroke_lengths(paths).sum() for paths in parts)),
        float(sum(gap.sum() for gap in gaps)),
        sum(int((gap > COINCIDENT_MM).sum()) for gap in gaps) + len(parts),
        len(parts),
    )
