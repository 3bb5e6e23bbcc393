"""Decals on what is painted of their faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.effects.decals.decal_polygons import Decals
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping.clipped_polygons import Polygons, cut_polygons
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import image_points


@dataclass(frozen=True, eq=False)
class Laid:
    """Parts of decals in the image: points (3,c), as of ImageFaces; offsets (n+1,); decal (n,) which decal each part is
    of; piece (n,) the painted polygon that it lies on, ascending, and for each the decals in the order of painting."""

    points: Floats
    offsets: Ints
    decal: Ints
    piece: Ints

    def __len__(self) -> int:
        return len(self.decal)


def laid(view: View, decals: Decals, points: Floats, offsets: Ints, source: Ints) -> Laid:
    """Decals clipped with the painted polygons that are their faces, or parts of these.

    points (2 or more, c), offsets (p+1,) and source (p,): convex polygons of the image and their faces in the view, as
    of Painted.faces; or doubles in a mirror, with mirrored decals.
    """
    shape, offset, which = _in_front(view, decals)
    order = np.argsort(source, kind="stable")
    first, last = (np.searchsorted(source[order], decals.face[which], side=side) for side in ("left", "right"))
    pair = ragged.owner(last - first)
    step = ragged.place(last - first)
    piece = order[first[pair] + step]
    corner, starts = ragged.take(offset, pair)
    border, borders = ragged.take(offsets, piece)
    cut, ends, kept = clipped_by_convex(
        image_points(view, shape[:, corner]), starts, points[:2, border], borders, tolerance=view.tolerance
    )
    decal, piece = which[pair[kept]], piece[kept]
    order = np.lexsort((decal, decals.level[decal], piece))
    position, ends = ragged.take(ends, order)
    return Laid(cut[:, position], ends, decal[order], piece[order])


def _in_front(view: View, decals: Decals) -> tuple[Floats, Ints, Ints]:
    """The decals cut off at the near plane: points, offsets, and which decal each one is."""
    if view.eye is None or not len(decals):
        return decals.points, decals.offsets, np.arange(len(decals))
    beyond = view.depth_of(decals.points) - view.near
    if not (beyond < 0.0).any():
        return decals.points, decals.offsets, np.arange(len(decals))
    cut, _ = cut_polygons(Polygons(decals.points.T, decals.offsets), beyond)
    full = np.flatnonzero(np.diff(cut.offsets))
    return np.ascontiguousarray(cut.points.T), np.append(cut.offsets[full], len(cut.points)), full
