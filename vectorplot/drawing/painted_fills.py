"""Painted polygons on the page, and others between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.geometry import ragged
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision, fitted_picture
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces, framed_faces, view_points


@dataclass(frozen=True, eq=False)
class Overlay:
    """Polygons painted after others: fills, and after (m,): the number of the polygon that each of them comes right
    after; of equal numbers in the order they have here."""

    fills: Fills
    after: Ints


def stacked(overlays: Sequence[Overlay]) -> Overlay:
    """All polygons by what they come after; of several after one polygon those of the first overlay come first."""
    place = np.concatenate([overlay.after for overlay in overlays])
    order = np.argsort(place, kind="stable")
    return Overlay(Fills.joined(*(overlay.fills for overlay in overlays)).take(order), place[order])


def overlaid(base: Overlay, overlays: Sequence[Overlay]) -> Overlay:
    """The polygons of base with those of the overlays, which come after polygons of base, between them; of several
    after one polygon those of the first overlay come first."""
    overlays = [overlay for overlay in overlays if len(overlay.fills)]
    if not overlays:
        return base
    every = stacked([Overlay(base.fills, np.arange(len(base.fills))), *overlays])
    return Overlay(every.fills, base.after[every.after])


def interleaved(base: Fills, overlays: Sequence[Overlay]) -> Fills:
    """The polygons of base with those of the overlays between them."""
    return overlaid(Overlay(base, np.arange(len(base))), overlays).fills


def placement_of_faces(view: View, faces: ImageFaces, page: Page, fit: bool, beside: Floats | None = None) -> Placement:
    """The place on the page of a picture of painted polygons.

    Parameters
    ----------
    view : View
        What is painted.
    faces : ImageFaces
        The polygons in the image.
    page : Page
        The sheet of paper.
    fit : bool
        Whether the picture fills the page but for its margin; otherwise the page height is the camera's picture height.
    beside : (n, 3) array of float, optional
        Points of the world that are to be on it as well.

    Returns
    -------
    Placement
        With what takes the image to mm.

    Notes
    -----
    Edge cases: where the faces reach behind the eye, or more than 60 degrees off the principal ray, the picture shows
    the camera's field of vision. Without faces the origin of the image is in the middle.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import drawing, geometry
    >>> from vectorplot.scene import look
    >>> from vectorplot.visibility import image_faces
    >>> view = look(vp.Scene((vp.Item("slab", geometry.box((4, 2, 1))),)), vp.Camera.view("top"))
    >>> placement = drawing.placement_of_faces(view, image_faces(view, np.arange(6)), vp.Page(100, 80), fit=True)
    >>> placement.scale, (placement.page_from_world @ (4, 2, 1, 1))[:2].tolist()
    (40.0, [90.0, 60.0])
    """
    used = np.zeros(view.face_count, dtype=np.bool_)
    used[faces.source] = True
    points = view.points[:, view.corners[np.repeat(used, view.face_sizes)]]
    others = view.points_of(np.zeros((0, 3)) if beside is None else beside)
    if not fit or view.reaches_too_far(np.concatenate([points, others], axis=1)):
        return field_of_vision(view, page, fit)
    return fitted_picture(view, page, np.concatenate([faces.points[:2], view.image_of(others)], axis=1))


def shown_faces(faces: ImageFaces, placement: Placement) -> ImageFaces:
    """The polygons as far as the picture shows them."""
    if placement.whole:
        return faces
    return framed_faces(faces, *placement.window, placement.projection.tolerance)


def fills_on_page(
    view: View,
    points: Floats,
    offsets: Ints,
    placement: Placement,
    *,
    colours: Colours,
    opacity: Floats,
    item: Ints,
    kind: Ints,
) -> Fills:
    """Polygons of the image on the page: points (3,c) places and heights as in ImageFaces, colours (c,3), opacity,
    item and kind (m,) as in Fills."""
    flat = placement.on_page(points[:2])
    return Fills(
        np.ascontiguousarray(flat), offsets, colours, opacity, item, view.world_of(view_points(view, points)), kind
    )


# Hidden lines by painting, on the page: blank faces back to front, and the lines on each of them.


def erased_fills(blank: Fills, lines: Fills, width_mm: float) -> Fills:
    """Blank polygons back to front, with visible lines of two corners, so wide, between them.

    A line comes right after the last of the polygons that touch it, so that none takes away half of its width:
    polygons may end beside a line anywhere, along its face or where the painter cut another one.
    Source: Glaeser, section 7.1, figure 1.
    """
    if not len(blank):
        return lines
    return interleaved(blank, [Overlay(lines, _last_touching(blank, lines, width_mm / 2.0))])


def line_fills(strokes: Paths, ink: Colours) -> Fills:
    """Every straight part of strokes as a line of two corners in the ink (m,3) of its stroke."""
    sizes = np.diff(strokes.offsets)
    owner = ragged.owner(sizes)
    start = np.arange(len(strokes.points))
    end = start + 1
    last = strokes.offsets[1:][sizes > 0] - 1
    end[last] = strokes.offsets[:-1][sizes > 0]
    drawn = np.ones(len(start), dtype=np.bool_)
    drawn[last] = strokes.closed[sizes > 0]
    start, end, owner = start[drawn], end[drawn], owner[drawn]
    ends = np.stack([start, end], axis=1).ravel()
    return Fills(
        strokes.points[ends],
        2 * np.arange(len(start) + 1),
        np.repeat(ink[owner], 2, axis=0),
        np.ones(len(start)),
        strokes.item[owner],
        strokes.points3d[ends],
        np.full(len(start), int(FillKind.EDGE)),
    )


def _last_touching(polygons: Fills, lines: Fills, distance: float) -> Ints:
    """(n,) the last of the polygons that come so near to each line; the first of all where none does."""
    import shapely

    sizes = np.diff(polygons.offsets)
    full = np.flatnonzero(sizes >= 3)
    corner = np.repeat(sizes >= 3, sizes)
    rings = shapely.linearrings(polygons.points[corner], indices=ragged.owner(sizes[full]))
    tree = shapely.STRtree(shapely.polygons(rings))
    segments = shapely.linestrings(lines.points.reshape(-1, 2, 2))
    line, polygon = tree.query(segments, predicate="dwithin", distance=distance)
    found = np.zeros(len(lines), dtype=np.intp)
    np.maximum.at(found, line, full[polygon])
    return found
