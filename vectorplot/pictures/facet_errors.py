"""How far the triangles of smooth surfaces are from these, measured in a picture."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.facet_resolution import FacetedScene

MOST = 1 << 16
"""So many sides are measured at most, evenly among all."""

TURNED = float(np.cos(np.radians(60.0)))
"""Sides at the ends of which normals are farther apart than by the angle of this cosine lead over a crease."""


def facet_error(facets: FacetedScene, view: View, placement: Placement) -> float | None:
    """How far the sides of triangles are at most from the surfaces they stand for, on the page in mm (or pixels): at
    the middle of each side, from the cubic in the true tangent planes at its ends; None without such triangles.
    Error: of fourth order in the side's length, what is measured of second.
    Source: Vlachos, Peters, Boyd, Mitchell, Curved PN triangles (2001), boundary curves.
    """
    return _side_error(facets, view, placement, np.arange(len(view.corners)))


def outline_error(facets: FacetedScene, view: View, placement: Placement) -> float | None:
    """The same of sides in outlines alone: those of one triangle, and those of two of which one is seen from behind."""
    start, end = view.corners, view.corners[ragged.following(view.offsets)]
    x, y = view.image_of(view.points)
    turn = np.add.reduceat(x[start] * y[end] - x[end] * y[start], view.offsets[:-1]) if view.face_count else np.zeros(0)
    front = np.repeat(turn > 0.0, np.diff(view.offsets))
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.argsort(low * view.points.shape[1] + high, kind="stable")
    new = np.append(True, (np.diff(low[order]) != 0) | (np.diff(high[order]) != 0))[: len(order)]
    first = np.flatnonzero(new)
    uses, ahead = np.diff(np.append(first, len(order))), np.add.reduceat(front[order].astype(np.intp), first)
    return _side_error(facets, view, placement, order[first[(uses == 1) | ((ahead > 0) & (ahead < uses))]])


def _side_error(facets: FacetedScene, view: View, placement: Placement, sides: Ints) -> float | None:
    """The same of sides that begin at some corners of the view."""
    normals = np.zeros((3, view.points.shape[1]))
    for item, own in enumerate(facets.normals):
        if own is not None:
            part = slice(view.item_vertices[item], view.item_vertices[item + 1])
            normals[:, part] = np.where(own.on_edge, 0.0, (matmul(own.at_vertices, view.axes.T)).T)
    start, end = view.corners[sides], view.corners[ragged.following(view.offsets)[sides]]
    known = np.flatnonzero((normals[:, start] * normals[:, end]).sum(axis=0) > TURNED)
    known = known[:: 1 + len(known) // MOST]
    if not len(known):
        return None
    (p, q), (m, n) = (([x[:, start[known]], x[:, end[known]]]) for x in (view.points, normals))
    chord, middle = q - p, 0.5 * (p + q)
    bulge = ((chord * n).sum(axis=0) * n - (chord * m).sum(axis=0) * m) / 8.0
    on, off = (placement.on_page(view.image_of(x)) for x in (middle, middle + bulge))
    page = placement.page
    shown = ((on >= 0.0) & (on <= [page.width_mm, page.height_mm])).all(axis=1)
    return float(np.hypot(*(on - off).T)[shown].max()) if shown.any() else None
