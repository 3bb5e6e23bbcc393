"""How far from the images of edges sight lines pass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import SAFE_IN_IMAGE
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

TOGETHER = 8
"""So many chords that follow each other are searched as one line."""

BEYOND = 4.0
"""A point on a border is as safe as one so many times what is safe away from it, and no safer."""


def clearances(view: View, edges: Curves, points: Floats, tolerance: float) -> Floats:
    """(k,) distances in the image of points (k,3) from the nearest edge, those from borders on which points lie left
    out: what ends in a point is not in front of it on either side. tolerance: how far chords are off their curves.
    """
    if not len(points):
        return np.zeros(0)
    image, chord = sight_lines.image(view, points), edges.chords
    border = edges.kind[edges.owner[chord]] == LineKind.BOUNDARY
    distance = _distances(view, edges, chord[~border], image)
    nearest, from_border = _nearest_chords(view, edges, chord[border], image)
    on = np.flatnonzero(nearest >= 0)
    on = on[_lies_on(view, edges, nearest[on], points[on], tolerance)]
    if len(on):
        reach = BEYOND * SAFE_IN_IMAGE
        which, other = _chords_within(view, edges, chord[border], image[on], reach)
        apart = ~_lies_on(view, edges, other, points[on[which]], tolerance)
        which, other = on[which[apart]], other[apart]
        from_border[on] = reach
        np.minimum.at(from_border, which, _from_chords(view, edges, other, image[which]))
    return np.minimum(distance, from_border)


def _distances(view: View, edges: Curves, chord: Ints, image: Floats) -> Floats:
    """(k,) distances of points (k,2) of the image from the nearest of some chords, infinite without any."""
    import shapely

    distance = np.full(len(image), np.inf)
    if len(chord):
        # Chords that follow each other are few geometries, which are made and searched in less time than many.
        follows = np.append(False, np.diff(chord) == 1)
        first = np.flatnonzero(~follows)
        sizes = np.diff(np.append(first, len(chord)))
        first = np.flatnonzero(~follows | (ragged.place(sizes) % TOGETHER == 0))
        sizes = np.diff(np.append(first, len(chord)))
        points = sight_lines.image(view, edges.points[ragged.ranges(chord[first], sizes + 1)])
        lines = shapely.linestrings(points, indices=ragged.owner(sizes + 1))
        (which, _), found = shapely.STRtree(lines).query_nearest(
            shapely.points(image), return_distance=True, all_matches=False
        )
        distance[which] = found
    return distance


def _nearest_chords(view: View, edges: Curves, chord: Ints, image: Floats) -> tuple[Ints, Floats]:
    """Of some chords the nearest to each point (k,2) of the image, and its distance; -1 and infinity without any."""
    import shapely

    number, distance = np.full(len(image), -1), np.full(len(image), np.inf)
    if len(chord):
        tree = shapely.STRtree(_lines(view, edges, chord))
        (which, nearest), found = tree.query_nearest(shapely.points(image), return_distance=True, all_matches=False)
        number[which], distance[which] = chord[nearest], found
    return number, distance


def _chords_within(view: View, edges: Curves, chord: Ints, image: Floats, reach: float) -> tuple[Ints, Ints]:
    """The pairs of a point (k,2) of the image and one of some chords that come within reach of each other."""
    import shapely

    tree = shapely.STRtree(_lines(view, edges, chord))
    which, near = tree.query(shapely.points(image), predicate="dwithin", distance=reach)
    return which, chord[near]


def _from_chords(view: View, edges: Curves, chord: Ints, image: Floats) -> Floats:
    """(k,) distances of points (k,2) of the image from a chord each."""
    import shapely

    return np.asarray(shapely.distance(shapely.points(image), _lines(view, edges, chord)))


def _lines(view: View, edges: Curves, chord: Ints) -> NDArray[np.object_]:
    """(k,) chords in the image."""
    import shapely

    ends = sight_lines.image(view, edges.points)
    return np.asarray(shapely.linestrings(np.stack([ends[chord], ends[chord + 1]], axis=1)))


def _lies_on(view: View, edges: Curves, chord: Ints, points: Floats, tolerance: float) -> Bools:
    """(k,) whether points (k,3) on chords lie on chords of edges, in space."""
    start, way = edges.points[chord], edges.points[chord + 1] - edges.points[chord]
    arm = points - start
    part = np.clip(dot(arm, way) / np.maximum(dot(way, way), LEAST_DIVISOR), 0.0, 1.0)
    away = arm - part[:, None] * way
    size = 1.0 if view.eye is None else sight_lines.depth(view, points) / view.focus
    return np.asarray(np.sqrt(dot(away, away)) <= tolerance * size)
