"""Where along level lines labels fit: where they are nearly straight, and away from each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.parameters import positive
from vectorplot.features.meshes.mesh_curves import MeshCurves
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import closed_round

PARTS = 8
"""Steps along a label, at whose ends lines are looked at."""

STRAIGHTEST = 0.9
"""Chord over length of the part of a line beside a label, at least."""

PLACES = 3
"""Digits in which parts of lines are compared: none is straighter than another by rounding."""

MOST_LABELS = 10_000
"""Labels at most."""


@dataclass(frozen=True, eq=False)
class LabelPlaces:
    """Places of labels on level lines.

    Parameters
    ----------
    points : (k, 3) array of float
        Their middles, on the lines, in world coordinates.
    directions : (k, 3) array of float
        Unit vectors along the lines: the higher ground is on the left, at the heads of letters.
    heights : (k,) array of float
        The level of the line.
    straightness : (k,) array of float
        Chord over length of the part of the line beside the label, 1 where it is straight.

    Notes
    -----
    Made by `label_places`.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features
    >>> features.LabelPlaces(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0)).heights.tolist()
    []
    """

    points: Floats
    directions: Floats
    heights: Floats
    straightness: Floats


def label_places(curves: MeshCurves | SurfaceCurves, length: float, apart: float) -> LabelPlaces:
    """Where labels fit on level lines: the straightest parts first.

    Parameters
    ----------
    curves : MeshCurves or SurfaceCurves
        Such as `mesh_level_lines` and `level_lines` give.
    length : float
        Of a label, in world units.
    apart : float
        How far the middles of labels are apart, at least.

    Returns
    -------
    LabelPlaces
        None on lines that are shorter than a label, and where they turn too much.

    Raises
    ------
    InputError
        For lengths that are not positive.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> levels = features.mesh_level_lines(geometry.box((8, 2, 2)), [0.5, 1.0])
    >>> features.label_places(levels, length=1.0, apart=3.0).heights.tolist()
    [0.5, 0.5, 0.5]
    """
    length, apart = positive("labels: length", length), positive("labels: distance", apart)
    middles, directions, straight, owner = _windows(curves, length)
    good = straight >= STRAIGHTEST
    middles, directions, straight, owner = middles[good], directions[good], straight[good], owner[good]
    heights = curves.levels[owner]
    free = np.ones(len(straight), dtype=np.bool_)
    chosen: list[int] = []
    # The straightest of all first; parts alike in the order of the lines.
    for k in np.lexsort((np.arange(len(straight)), -straight.round(PLACES))).tolist():
        if free[k] and len(chosen) < MOST_LABELS:
            chosen.append(k)
            free &= ((middles - middles[k]) ** 2).sum(axis=1) >= apart * apart
    return LabelPlaces(middles[chosen], directions[chosen], heights[chosen], straight[chosen])


def _windows(curves: MeshCurves | SurfaceCurves, length: float) -> tuple[Floats, Floats, Floats, Ints]:
    """Parts of the lines as long as a label: their middles (k,3), directions, chord over length (k,), and lines."""
    rounds = closed_round(curves)
    points, offsets = curves.points[rounds.index], rounds.offsets
    after = ragged.following(offsets)
    last = offsets[1:] - 1
    step = np.sqrt(((points[after] - points) ** 2).sum(axis=1))
    step[last] = 0.0
    # Lengths along all lines, one after the other.
    along = np.concatenate([[0.0], np.cumsum(step)[:-1]])
    begin, whole = along[offsets[:-1]], along[last] - along[offsets[:-1]]
    count = np.maximum(np.floor(PARTS * (whole / length - 1.0)).astype(np.intp) + 1, 0)
    count[whole < length] = 0
    line = ragged.owner(count)
    start = begin[line] + ragged.place(count) * (length / PARTS)
    ends = [_at(points, along, start + share * length, last[line], offsets[line]) for share in (0.0, 0.5, 1.0)]
    chord = ends[2] - ends[0]
    size = np.sqrt((chord**2).sum(axis=1))
    return ends[1], chord / np.where(size > 0.0, size, 1.0)[:, None], size / length, line


def _at(points: Floats, along: Floats, where: Floats, last: Ints, first: Ints) -> Floats:
    """(k,3) the points at lengths (k,) along lines with these first and last points."""
    place = np.clip(np.searchsorted(along, where, side="right") - 1, first, np.maximum(last - 1, first))
    gap = along[place + 1] - along[place]
    share: Floats = np.clip((where - along[place]) / np.where(gap > 0.0, gap, 1.0), 0.0, 1.0)
    inner: Bools = gap > 0.0
    share = np.where(inner, share, 0.0)
    return np.asarray(points[place] + share[:, None] * (points[place + 1] - points[place]))
