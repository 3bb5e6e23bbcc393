"""Long strokes in parts: some plotters stutter on paths of many metres."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated, sections, unrolled
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_lengths import SUM_OF_LENGTHS


def split_long(paths: Paths, max_mm: float, page_from_world: Floats | None = None) -> Paths:
    """The same strokes, those longer than a limit cut into equal parts that are no longer, one after the other.

    Parameters
    ----------
    paths : Paths
        On the page, in mm.
    max_mm : float
        The longest that a stroke may be.
    page_from_world : (4, 4) array of float, optional
        As of Drawing, by default a parallel projection: points3d is divided where the page is.

    Returns
    -------
    Paths
        A closed stroke that is cut becomes open ones.

    Raises
    ------
    InputError
        Unless the limit is positive.

    Notes
    -----
    Degenerate: strokes without length stay.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import Paths, split_long
    >>> points, none = np.array([(0.0, 0.0), (100.0, 0.0)]), np.zeros(1, dtype=int)
    >>> line = Paths(points, np.array([0, 2]), np.array([False]), none, none, none, np.zeros((2, 3)))
    >>> split_long(line, max_mm=60.0).points.tolist()
    [[0.0, 0.0], [50.0, 0.0], [50.0, 0.0], [100.0, 0.0]]
    """
    if not max_mm > 0.0:
        raise InputError(f"the longest stroke must be a positive length in mm, not {max_mm:g}")
    loops = paths.closed & (np.diff(paths.offsets) > 0)
    line = unrolled(paths, np.zeros(len(paths), dtype=np.intp), loops.astype(np.intp))
    along, length = _arc_length(line)
    # Rounding of the sum must not make a stroke of exactly the right length too long.
    parts = np.ceil(length / max_mm * (1.0 - SUM_OF_LENGTHS))
    cut = parts > 1.0
    if not cut.any():
        return paths
    count = parts[cut].astype(np.intp)
    stroke = np.repeat(np.flatnonzero(cut), count)
    number, count = ragged.place(count), np.repeat(count, count)
    first, last = line.offsets[:-1][stroke], line.offsets[1:][stroke] - 1
    begin = along[first] + number * (length[stroke] / count)
    end = along[first] + (number + 1) * (length[stroke] / count)
    start_at, t_start = _on_segment(along, np.searchsorted(along, begin, side="right") - 1, begin, first, last)
    end_at, t_end = _on_segment(along, np.searchsorted(along, end, side="left") - 1, end, first, last)
    # The ends of the whole are its own ends, whatever the sums round to.
    start_at, t_start = np.where(number == 0, first, start_at), np.where(number == 0, 0.0, t_start)
    end_at, t_end = np.where(number == count - 1, last - 1, end_at), np.where(number == count - 1, 1.0, t_end)
    world = np.eye(4) if page_from_world is None else page_from_world
    pieces = sections(line, stroke, start_at, t_start, end_at, t_end, world)
    order = np.argsort(np.concatenate((np.flatnonzero(~cut), stroke)), kind="stable")
    return chosen(concatenated((chosen(paths, ~cut), pieces)), order)


def _arc_length(line: Paths) -> tuple[Floats, Floats]:
    """How far along all open strokes, laid end to end, each point lies (p,); and the length of each stroke (m,)."""
    steps = np.zeros(len(line.points))
    steps[1:] = np.hypot(*np.diff(line.points, axis=0).T)
    filled = np.diff(line.offsets) > 0
    steps[line.offsets[:-1][filled]] = 0.0
    along = np.cumsum(steps)
    length = np.zeros(len(line))
    length[filled] = along[line.offsets[1:][filled] - 1] - along[line.offsets[:-1][filled]]
    return along, length


def _on_segment(along: Floats, segment: Ints, place: Floats, first: Ints, last: Ints) -> tuple[Ints, Floats]:
    """The segment of the stroke from first to last, and the fraction of it, at a place along."""
    segment = np.clip(segment, first, last - 1)
    run = along[segment + 1] - along[segment]
    return segment, np.clip((place - along[segment]) / np.where(run > 0.0, run, 1.0), 0.0, 1.0)
