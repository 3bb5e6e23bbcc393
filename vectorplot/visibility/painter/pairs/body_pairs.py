"""Which of two convex bodies is in front of the other, decided in one point where that suffices."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.convex_bodies import Bodies, faces_between, spheres_apart
from vectorplot.visibility.painter.pairs.face_pairs import BEHIND, IN_FRONT, ON_OUTLINE, Codes
from vectorplot.visibility.painter.pairs.outlines import Outlines, Table, common_points, overlapping

UNDECIDED = 5
"""The code of two bodies that may pierce each other, as far as spheres and planes of faces can tell."""


def body_relations(view: View, faces: ImageFaces, bodies: Bodies, first: Ints, second: Ints) -> Codes:
    """(p,) codes for pairs of convex bodies: of face_relations, or UNDECIDED.

    Of bodies that do not pierce each other the one that is nearer in one common point of the images is nearer in all.
    That point is found on the line between the centres, or in the middle of the common part of the outlines.
    Source: Glaeser, section 5.5 (chord test, soap bubbles, separating planes).
    """
    codes = np.zeros(len(first), dtype=np.int8)
    outlines = Outlines.of(bodies.corners, bodies.offsets, view.tolerance)
    x, y, found = _on_chord(outlines, bodies, first, second, view.tolerance)
    others = np.flatnonzero(~found)
    others = others[overlapping(outlines, first[others], second[others], view.tolerance)]
    x[others], y[others] = _middles(outlines, first[others], second[others], view.tolerance)
    common = np.concatenate([np.flatnonzero(found), others])
    a, b = first[common], second[common]
    height, limit = _front_height(faces, bodies, a, x[common], y[common])
    other_height, other_limit = _front_height(faces, bodies, b, x[common], y[common])
    above = height - other_height
    clear = np.abs(above) > view.tolerance * np.maximum(limit, other_limit)
    code = np.where(clear, np.where(above > 0.0, IN_FRONT, BEHIND), UNDECIDED)
    near = np.flatnonzero(clear & ~spheres_apart(bodies, a, b))
    nearer = np.where(code[near] == IN_FRONT, a[near], b[near])
    farther = np.where(code[near] == IN_FRONT, b[near], a[near])
    code[near[~faces_between(view, faces, bodies, nearer, farther)]] = UNDECIDED
    codes[common] = code
    return codes


def _on_chord(
    outlines: Outlines, bodies: Bodies, first: Ints, second: Ints, tolerance: float
) -> tuple[Floats, Floats, Bools]:
    """A common point of both outlines on the line between their centres: x, y (p,), and whether there is one.

    Source: Glaeser, section 5.5 (chord test).
    """
    x, y = np.zeros((2, len(first)))
    found = np.zeros(len(first), dtype=np.bool_)
    centre = np.add.reduceat(bodies.corners, bodies.offsets[:-1], axis=1) / np.diff(bodies.offsets)
    for one, row, two, other, part in outlines.groups(first, second):
        start, end = centre[:, first[part]], centre[:, second[part]]
        leaves = 1.0 - _part_beyond(one, row, end, start)
        enters = _part_beyond(two, other, start, end)
        length = np.hypot(*(end - start))
        found[part] = (leaves - enters) * length > tolerance
        found[part] |= (length <= tolerance) & (leaves > enters)
        x[part], y[part] = start + (leaves + enters) / 2.0 * (end - start)
    return x, y, found


def _part_beyond(table: Table, row: Ints, outer: Floats, inner: Floats) -> Floats:
    """(p,) the parameter at which segments outer -> inner (2,p) enter outlines; inner is inside. 0: outer is too."""
    enters = np.zeros(len(row))
    for side in range(len(table)):
        start = table.distances(side, row, outer[0], outer[1])
        end = table.distances(side, row, inner[0], inner[1])
        crossing = start < 0.0
        enters = np.maximum(enters, np.where(crossing, start / np.where(crossing, start - np.abs(end), 1.0), 0.0))
    return enters


def _middles(outlines: Outlines, first: Ints, second: Ints, tolerance: float) -> tuple[Floats, Floats]:
    """Points (p,) inside the common part of pairs of outlines that overlap: the means of its corners."""
    x, y, count = np.zeros((3, len(first)))
    for one, row, two, other, part in outlines.groups(first, second):
        for u, v, there in common_points(one, row, two, other, ON_OUTLINE * tolerance):
            x[part] += np.where(there, u, 0.0).sum(axis=0)
            y[part] += np.where(there, v, 0.0).sum(axis=0)
            count[part] += there.sum(axis=0)
    count = np.maximum(count, 1.0)
    return x / count, y / count


def _front_height(faces: ImageFaces, bodies: Bodies, which: Ints, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Heights of the fronts of bodies above points of the image, and the steepness of the face met there."""
    lowest, steepness = np.full(len(which), np.inf), np.ones(len(which))
    counts = np.diff(bodies.first)[which]
    left = np.arange(len(which))
    for step in range(int(counts.max(initial=0))):
        left = left[counts[left] > step]
        face = bodies.shown[bodies.first[which[left]] + step]
        height = faces.heights(face, x[left], y[left])
        lower = height < lowest[left]
        lowest[left] = np.where(lower, height, lowest[left])
        steepness[left] = np.where(lower, faces.steepness[face], steepness[left])
    return lowest, steepness
