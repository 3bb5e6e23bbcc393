"""The order of painting of polygons that are parts of bent faces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.convex.plane_cuts import polygon_areas
from vectorplot.geometry.polylines import joined
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.painter.mikado import component_ranks
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.pairs.box_pairs import box_pairs
from vectorplot.visibility.painter.pairs.face_pairs import drawn_before, face_relations
from vectorplot.visibility.painter.pairs.outlines import Outlines, overlapping


def refracted_order(view: View, parts: ImageFaces, face: Ints, tolerance: float) -> ImageFaces:
    """Parts of bent faces (n,), numbers from 0, back to front; parts of one face stand together, and are not compared.

    tolerance: how far, in units of the image, the sides of parts are off the curves they stand for: those that overlap
    by no more may stand in any order. Where whole faces pierce one another or lie on one another in circles their parts
    are put in order, and cut where there is no other way.
    """
    count = int(face.max(initial=-1)) + 1
    parts = replace(parts, rank=_larger_first(parts, face, count)[face])
    demands = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    outlines = Outlines.of(parts.points, parts.offsets, tolerance)
    for first, second in box_pairs(parts.box, tolerance):
        several = face[first] != face[second]
        first, second = first[several], second[several]
        common = overlapping(outlines, first, second, tolerance)
        first, second = first[common], second[common]
        before, after = drawn_before(parts, first, second, face_relations(parts, first, second, view.tolerance))
        demands.append((face[before], face[after]))
    before, after = (np.concatenate([some[k] for some in demands]) for k in (0, 1))
    rank = component_ranks(count, before, after)
    circled = (np.bincount(rank, minlength=1)[rank] > 1)[face]
    pieces = _pieces(view, parts.some(np.flatnonzero(circled)))
    whole = joined((parts.some(np.flatnonzero(~circled)), replace(pieces, rank=np.arange(len(pieces)))))
    number = np.empty(int(parts.source.max(initial=-1)) + 1, dtype=np.intp)
    number[parts.source] = rank[face]
    return whole.some(np.lexsort((whole.rank, number[whole.source])))


def _larger_first(parts: ImageFaces, face: Ints, count: int) -> Ints:
    """(count,) the ranks of faces by the areas of their images."""
    normal, _ = polygon_areas(parts.points * [[1.0], [1.0], [0.0]], parts.offsets)
    area = np.bincount(face, np.abs(normal[2]), minlength=count)
    return np.argsort(np.argsort(-area, kind="stable"), kind="stable")


def _pieces(view: View, parts: ImageFaces) -> ImageFaces:
    """Polygons back to front, each compared with each."""
    points: Floats = view_points(view, parts.points)
    corners = np.arange(points.shape[1])
    double = replace(
        view,
        points=points,
        corners=corners,
        offsets=parts.offsets,
        inner=np.zeros(len(corners), dtype=np.bool_),
        face_item=np.zeros(len(parts), dtype=np.intp),
        item_vertices=np.array([0, len(corners)]),
        occludes=np.ones(1, dtype=np.bool_),
    )
    found = painters_order(double).faces
    return replace(found, source=parts.source[found.source])
