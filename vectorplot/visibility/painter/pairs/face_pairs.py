"""Which of two faces is in front of the other where their images overlap."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.bulges import TRUSTED, bulge, may_touch
from vectorplot.visibility.painter.pairs.outlines import Outlines, common_points, overlapping

Codes = NDArray[np.int8]

APART, IN_FRONT, BEHIND, STRADDLING, COPLANAR = 0, 1, 2, 3, 4
"""What the first face of a pair does to the second one: nothing, hides it, is hidden by it, both in parts, or lies in
its plane."""

ON_OUTLINE = 0.125
"""A corner counts as inside an outline up to so many tolerances beyond it: far less than what counts in height."""


def face_relations(faces: ImageFaces, first: Ints, second: Ints, tolerance: float) -> Codes:
    """(p,) codes for pairs of faces.

    Both planes are compared at all corners of the common part of the images; their difference is linear, so these tell
    all. A difference counts from a tolerance on, measured across the planes rather than in height. Of faces that stand
    for surfaces of different items that may touch there, these are compared, as far as their bulges are known.
    Source: Glaeser, section 5.5 (intersection of outlines); errata G5-02, G6-06.
    """
    codes = np.zeros(len(first), dtype=np.int8)
    if not len(first):
        return codes
    used, local = np.unique(np.concatenate([first, second]), return_inverse=True)
    if len(used) < len(faces):
        return face_relations(faces.some(used), local[: len(first)], local[len(first) :], tolerance)
    outlines = Outlines.of(faces.points, faces.offsets, tolerance)
    common = np.flatnonzero(overlapping(outlines, first, second, tolerance))
    first, second = first[common], second[common]
    least, most = _span(faces, outlines, first, second, tolerance, False)
    limit = tolerance * np.maximum(faces.steepness[first], faces.steepness[second])
    found = _codes(least, most, limit)
    if faces.bulges is not None:
        reach, curved = may_touch(faces, first, second)
        near = np.flatnonzero(curved & (least <= most) & (least < reach) & (most > -reach))
        span = _span(faces, outlines, first[near], second[near], tolerance, True)
        found[near] = _curved_codes(*span, limit[near] + TRUSTED * reach[near], found[near])
    codes[common] = found
    return codes


def _span(
    faces: ImageFaces, outlines: Outlines, first: Ints, second: Ints, tolerance: float, curved: bool
) -> tuple[Floats, Floats]:
    """The least and the largest height (p,) of faces above others where their images overlap; curved: of the surfaces
    that they stand for."""
    least, most = np.full(len(first), np.inf), np.full(len(first), -np.inf)
    for one, row, two, other, part in outlines.groups(first, second):
        a, b = first[part], second[part]
        for x, y, there in common_points(one, row, two, other, ON_OUTLINE * tolerance):
            above = faces.heights(a, x, y) - faces.heights(b, x, y)
            if curved:
                above += bulge(faces, a, x, y) - bulge(faces, b, x, y)
            least[part] = np.minimum(least[part], np.where(there, above, np.inf).min(axis=0))
            most[part] = np.maximum(most[part], np.where(there, above, -np.inf).max(axis=0))
    return least, most


def _curved_codes(least: Floats, most: Floats, limit: Floats, flat: Codes) -> Codes:
    """(p,) the codes of faces of surfaces that bulge over them, of which flat are those of the faces: where surfaces
    are on one side of each other, or touch, so are faces, wherever these pierce each other."""
    pierce = (most > limit) & (least < -limit)
    return np.where(pierce, flat, np.where(most > -least, IN_FRONT, BEHIND)).astype(np.int8)


def _codes(least: Floats, most: Floats, limit: Floats) -> Codes:
    above, below = most > limit, least < -limit
    return np.select(
        [above & below, above, below, most < least],
        [STRADDLING, IN_FRONT, BEHIND, APART],
        COPLANAR,
    ).astype(np.int8)


def drawn_before(faces: ImageFaces, first: Ints, second: Ints, codes: Codes) -> tuple[Ints, Ints]:
    """The pairs as demands on the order: (k,) faces to be drawn before the others (k,).

    Faces that pierce each other make both demands; of faces in one plane that of lower rank goes first.
    """
    level = codes == COPLANAR
    lower = faces.rank[first] < faces.rank[second]
    first_later = (codes == IN_FRONT) | (codes == STRADDLING) | (level & ~lower)
    second_later = (codes == BEHIND) | (codes == STRADDLING) | (level & lower)
    before = np.concatenate([second[first_later], first[second_later]])
    after = np.concatenate([first[first_later], second[second_later]])
    return before, after
