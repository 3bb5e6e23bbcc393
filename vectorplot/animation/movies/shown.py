"""What a movie shows: its frames as drawings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vectorplot.animation.movies.movie import Movie, MovieFrame, corner_colours
from vectorplot.animation.movies.packing import LARGEST_12_BIT
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills

LINE = Pen(0.3)
"""What lines are drawn with: a movie does not say it."""


def frame_drawings(movie: Movie, width_mm: float = 160.0) -> Iterator[Drawing]:
    """The frames of a movie as drawings.

    Parameters
    ----------
    movie : Movie
        What is shown.
    width_mm : float
        Of the page, which has the shape of the first polygon where this is a rectangle from the lower left corner,
        otherwise it is a square.

    Returns
    -------
    iterator of Drawing
        One layer of polygons and lines; of a frozen frame the one before it, or an empty one.

    Notes
    -----
    Source: Glaeser, section 10.2; erratum G10-09.

    Examples
    --------
    >>> from vectorplot import animation
    >>> [drawing.width_mm for drawing in animation.frame_drawings(animation.Movie((), (None, None)), 80.0)]
    [80.0, 80.0]
    """
    first = next((frame for frame in movie.frames if frame is not None), None)
    right, top = _sheet(first)
    scale = width_mm / right
    page = (float(width_mm), top * scale)
    shown = Drawing(*page, (Layer("polygons", LINE, (Fills.empty(),)),))
    for frame in movie.frames:
        if frame is not None:
            corners = np.asarray(frame.points * scale, dtype=np.float64)
            fills = Fills.flat(corners, frame.offsets, np.zeros((len(frame), 3), dtype=np.uint8))
            painted = replace(fills, colours=corner_colours(movie, frame))
            shown = Drawing(*page, (Layer("polygons", LINE, (painted,)),))
        yield shown


def _sheet(frame: MovieFrame | None) -> tuple[float, float]:
    """Width and height of the page in units of the grid."""
    whole = (float(LARGEST_12_BIT), float(LARGEST_12_BIT))
    if frame is None or not len(frame):
        return whole
    corners = frame.points[: frame.offsets[1]]
    x, y = corners.max(axis=0).tolist()
    rectangle = {(a, b) for a, b in corners.tolist()} == {(0, 0), (x, 0), (x, y), (0, y)} and min(x, y) > 0
    return (float(x), float(y)) if rectangle and max(x, y) == LARGEST_12_BIT else whole
