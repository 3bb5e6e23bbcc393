"""Hidden lines by painting, on the page: every face erases what is behind it, and then its edges are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted import Overlay, Placed, fills_on_page, interleaved
from vectorplot.geometry.mesh import Bools
from vectorplot.scene.view import View
from vectorplot.shading.face_shades import shows_inside
from vectorplot.visibility.painter.erasing import erasing_edges
from vectorplot.visibility.painter.image_faces import ImageFaces


def drawn_sides(view: View, faces: ImageFaces, smooth: Bools) -> Bools:
    """(c,) the sides of the faces of a view, from each corner to the next, that are drawn: edges of polyhedra; of the
    facets of smooth items (i,) only outlines, sides that no other painted facet that shows the same side has."""
    drawn = ~view.inner
    of_smooth = smooth[view.face_item]
    if not of_smooth.any():
        return drawn
    shown = np.zeros(view.face_count, dtype=np.bool_)
    shown[faces.source] = True
    face = np.repeat(np.arange(view.face_count), view.face_sizes)
    side = np.flatnonzero(of_smooth[face] & shown[face])
    start, end = view.corners[side], view.corners[view.after(side)]
    # Neighbours that show the same side run along a common side in opposite directions.
    there, back = start * view.points.shape[1] + end, end * view.points.shape[1] + start
    inside = shows_inside(view)[face[side]]
    paired = np.isin(2 * there + inside, 2 * back + inside)
    drawn = drawn & ~of_smooth[face]
    drawn[side[~paired]] = True
    return np.asarray(drawn)


def erased_fills(
    view: View,
    faces: ImageFaces,
    placed: Placed,
    paper: Colours,
    ink: Colours,
    smooth: Bools,
    overlays: Sequence[Overlay] = (),
) -> Fills:
    """Painted polygons in the colour of the paper (1,3), each followed by its edges, lines of two corners, and by what
    else is drawn on it; ink (i,3): the colours of the edges of items; smooth (i,): those made of facets.

    Source: Glaeser, section 7.1, figure 1.
    """
    erased = erasing_edges(view, faces, drawn_sides(view, faces, smooth))
    count = len(erased)
    after = np.repeat(np.arange(len(faces)), np.diff(erased.first))
    item = view.face_item[faces.source]
    blank = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        placed,
        colours=np.repeat(paper, faces.points.shape[1], axis=0),
        opacity=np.ones(len(faces)),
        item=item,
        # A seam around a facet would take half of the outline beside it away, which is not drawn again.
        kind=np.where(smooth[item], int(FillKind.BACKGROUND), int(FillKind.FACE)),
    )
    edges = fills_on_page(
        view,
        np.stack([erased.start, erased.end], axis=2).reshape(3, -1),
        np.arange(0, 2 * count + 1, 2),
        placed,
        colours=np.repeat(ink[item[after]], 2, axis=0),
        opacity=np.ones(count),
        item=item[after],
        kind=np.full(count, int(FillKind.EDGE)),
    )
    return interleaved(blank, [Overlay(edges, after), *overlays])
