"""Hidden lines by painting, on the page: every face erases what is behind it, and then its edges are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted import Overlay, Placed, fills_on_page, interleaved
from vectorplot.scene.view import View
from vectorplot.visibility.painter.erasing import erasing_edges
from vectorplot.visibility.painter.image_faces import ImageFaces


def erased_fills(
    view: View, faces: ImageFaces, placed: Placed, paper: Colours, ink: Colours, overlays: Sequence[Overlay] = ()
) -> Fills:
    """Painted polygons in the colour of the paper (1,3), each followed by its edges, lines of two corners, and by what
    else is drawn on it; ink (i,3): the colours of the edges of items.

    Source: Glaeser, section 7.1, figure 1.
    """
    erased = erasing_edges(view, faces)
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
        kind=np.full(len(faces), int(FillKind.BACKGROUND)),
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
