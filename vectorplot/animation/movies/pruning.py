"""Polygons that nobody sees in the end: left out of a movie."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.animation.movies.movie import MovieFrame
from vectorplot.arrays import Bools, Ints
from vectorplot.geometry.regions import polygons_of, unions

INSIDE = 8.0
"""What is left out lies inside what covers it by so many units of the grid: so that no pixel of a picture of a thousand
pixels a side shows both, be it blended."""


def pruned(frame: MovieFrame, item: Ints) -> Bools:
    """(m,) the polygons of a frame that are needed; item (m,): of which item each is, negative for none.

    Not needed is a polygon inside a later one, inside the outline of an item all of which is painted later, or inside
    an earlier one of the same palette and shade, as long as nothing else that comes between them reaches it. Lines and
    the first polygon, which is the paper, stay; so do polygons that cross themselves, which cover nothing either.
    Source: Glaeser, section 10.1 (necessary_to_plot); errata G10-07, G10-08.
    """
    import shapely

    needed = np.ones(len(frame), dtype=np.bool_)
    sizes = frame.sizes
    faces = np.flatnonzero(sizes > 2)
    if len(faces) < 2:
        return needed
    whole = frame.some(faces)
    shapes = polygons_of(whole.points.T.astype(np.float64), whole.offsets)
    sound = shapely.is_valid(shapes)
    faces, shapes = faces[sound], shapes[sound]
    inner = shapely.buffer(shapes, -INSIDE, join_style="mitre")
    tree = shapely.STRtree(inner)
    within, around = tree.query(shapes, predicate="covered_by")
    needed[faces[within[around > within]]] = False
    needed[faces[_behind_items(shapes, item[faces])]] = False
    earlier = around < within
    needed[faces[_repeated(frame, faces, shapes, within[earlier], around[earlier])]] = False
    needed[0] = True
    return needed


def _behind_items(shapes: Any, item: Ints) -> Ints:
    """The polygons inside the outline of an item that is painted after them; item (n,): of each polygon."""
    import shapely

    owned = np.flatnonzero(item >= 0)
    if not len(owned):
        return owned
    _, first, group = np.unique(item[owned], return_index=True, return_inverse=True)
    outlines = shapely.buffer(unions(shapes[owned], group, None), -INSIDE, join_style="mitre")
    within, around = shapely.STRtree(outlines).query(shapes, predicate="covered_by")
    return np.unique(within[owned[first][around] > within])


def _repeated(frame: MovieFrame, faces: Ints, shapes: Any, within: Ints, around: Ints) -> Ints:
    """Of pairs of polygons, of which the one is within the other, which is painted before it: those within in the same
    colour, that nothing else comes between."""
    import shapely

    first, last = frame.offsets[:-1], frame.offsets[1:]
    low, high = np.minimum.reduceat(frame.shades, first), np.maximum.reduceat(frame.shades, first)
    flat = low == high
    one, other = faces[within], faces[around]
    alike = flat[one] & flat[other] & (low[one] == low[other]) & (frame.palette[one] == frame.palette[other])
    within, one, other = within[alike], one[alike], other[alike]
    if not len(within):
        return within
    asked, place = np.unique(within, return_inverse=True)
    every = shapely.convex_hull(
        shapely.multipoints(frame.points.astype(np.float64), indices=np.repeat(np.arange(len(frame)), last - first))
    )
    near, reached = shapely.STRtree(every).query(shapes[asked], predicate="dwithin", distance=INSIDE)
    mine = faces[asked[near]]
    different = ~flat[reached] | (low[reached] != low[mine]) | (frame.palette[reached] != frame.palette[mine])
    before = different & (reached < mine)
    latest = np.full(len(asked), -1, dtype=np.intp)
    np.maximum.at(latest, near[before], reached[before])
    return np.unique(within[other > latest[place]])
