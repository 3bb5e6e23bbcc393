"""What was measured as a drawing: time over size, and what one thing costs."""

from __future__ import annotations

from vectorplot.charts.chart import Curve, Panel, chart
from vectorplot.drawing.drawing import Drawing
from vectorplot.speed.log import Log, Measured


def plot(log: Log, before: Log | None = None) -> Drawing:
    """The seconds of all pictures over their sizes, and what one thing costs in points, with an earlier log dashed.

    Parameters
    ----------
    log : Log
        What is plotted.
    before : Log, optional
        Pictures of the same names are drawn as dashed lines from the first of their sizes to the last.

    Returns
    -------
    Drawing
        Two panels with logarithmic axes; `vectorplot.save` writes it in any format.
    """
    numbers = {one.name: number for number, one in enumerate(log.pictures)}
    seconds = [Curve(one.name, one.sizes, one.seconds, numbers[one.name]) for one in log.pictures]
    points = [Curve(one.name, one.sizes, _points(one, log), numbers[one.name]) for one in log.pictures]
    if before is not None:
        known = [one for one in before.pictures if one.name in numbers]
        seconds += [_dashed(one, one.seconds, numbers[one.name]) for one in known]
        points += [_dashed(one, _points(one, before), numbers[one.name]) for one in known]
    panels = (
        Panel("things", "seconds", tuple(seconds)),
        Panel("things", "points projected and sorted, for each", tuple(points)),
    )
    return chart("speed", panels, "dashed: before" if before is not None else "")


def _points(one: Measured, log: Log) -> tuple[float, ...]:
    """What one thing costs at each size, in points projected and sorted."""
    return tuple(1e6 * s / n / log.point_us for s, n in zip(one.seconds, one.sizes, strict=True))


def _dashed(one: Measured, values: tuple[float, ...], number: int) -> Curve:
    return Curve(one.name, (one.sizes[0], one.sizes[-1]), (values[0], values[-1]), number, marked=False, dashed=True)
