"""How far smooth surfaces bulge over the triangles in their place: of two that touch, triangles pierce each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.columns import cross, dot
from vectorplot.geometry.elementary import arccos
from vectorplot.scene.view import View
from vectorplot.tolerances.of_parameters import AT_APEX
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points

TURNED = 0.5
"""Triangles with a corner at which the surface makes an angle with a larger cosine than this with them have a bulge."""

TRUSTED = 0.3
"""By this part of itself a bulge may be off: it is known by its second derivatives only."""


CONSTANT, ALONG_X, ALONG_Y, SQUARE_X, PRODUCT, SQUARE_Y, SHARE, SHARE_X, SHARE_Y, MOST, TURN, ITEM = range(12)
"""The rows of ImageFaces.bulges: a quadratic function over a linear one of what x and y are more than those of planes;
how much it is at most; the largest angle between normals of the surface and of the face; and the item."""


def with_bulges(view: View, faces: ImageFaces, normals: Floats) -> ImageFaces:
    """Faces in the image that know how far the surfaces in whose place they are bulge over them. normals (3,c): of
    these at the corners of the faces of the view, 0 where there are none.

    Between two corners a surface is taken for the cubic in its tangent planes there, and within a triangle for the
    quadratic function with the same heights in the middles of its sides, or at an apex for a cone.
    Source: Vlachos, Peters, Boyd, Mitchell, Curved PN triangles (2001), boundary curves.
    """
    bulges = np.zeros((ITEM + 1, len(faces)))
    bulges[SHARE] = 1.0
    bulges[ITEM] = view.face_item[faces.source]
    own = np.flatnonzero(view.face_sizes[faces.source] == 3)
    position = view.offsets[faces.source[own]] + np.arange(3)[:, None]
    known = (dot(normals, normals)[position] > 0.0).any(axis=0)
    kept = np.flatnonzero(known & (view.depth[view.corners[position]] > view.near).all(axis=0))
    own, position = own[kept], position[:, kept]
    if not len(own):
        return replace(faces, bulges=bulges)
    points = view.points[:, view.corners[position]]
    places = image_points(view, points.reshape(3, -1)).reshape(points.shape)
    tilted = _in_image(view, points, normals[:, position])
    sides = np.roll(places, -1, axis=1) - places
    area = cross(sides[:, 0], sides[:, 1])
    # At an apex a surface has no normal: it goes on straight from there.
    apex = ~(tilted != 0.0).any(axis=0)
    tilted = np.where(apex, area[:, None], tilted)
    upright = dot(tilted, area[:, None])
    size = np.sqrt(dot(tilted, tilted) * dot(area, area))
    after = np.roll(upright, -1, axis=0)
    safe = (np.abs(upright) > TURNED * size).all(axis=0) & (area[2] != 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        rises, falls = -dot(tilted, sides) / upright, -dot(np.roll(tilted, -1, axis=1), sides) / after
        middle = (rises - falls) / 8.0 * (dot(area, area) / area[2])
    middle = np.where(safe & ~apex & ~np.roll(apex, -1, axis=0), middle, 0.0)
    x0, y0 = faces.planes[:2, own]
    weights = np.zeros((3, 3, len(own)))
    for k in range(3):
        # The side across from a corner bounds where its weight is 0.
        x, y, _ = places[:, (k + 1) % 3]
        along = sides[:, (k + 1) % 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            weights[1, k], weights[2, k] = -along[1] / area[2], along[0] / area[2]
        weights[0, k] = weights[1, k] * (x0 - x) + weights[2, k] * (y0 - y)
    for k in range(3):
        (a, b, c), (d, e, f) = weights[:, k], weights[:, (k + 1) % 3]
        product = np.stack([a * d, a * e + b * d, a * f + c * d, b * e, b * f + c * e, c * f])
        bulges[:SHARE, own] += np.where(safe, 4.0 * middle[k] * product, 0.0)
        straight = np.flatnonzero(apex[k])
        bulges[SHARE:MOST, own[straight]] -= weights[:, k, straight]
    bulges[MOST, own] = np.abs(middle).max(axis=0)
    bulges[TURN, own] = arccos(np.minimum(np.abs(upright) / np.where(size > 0.0, size, 1.0), 1.0)).max(axis=0)
    return replace(faces, bulges=bulges)


def bulge(faces: ImageFaces, face: Ints, x: Floats, y: Floats) -> Floats:
    """(..., p) how far above faces (p,) surfaces are at points x, y (..., p) of the image."""
    assert faces.bulges is not None
    one, right, up, square_x, product, square_y, *share = faces.bulges[:MOST, face]
    x, y = x - faces.planes[0, face], y - faces.planes[1, face]
    height = one + right * x + up * y + square_x * x * x + product * x * y + square_y * y * y
    return np.asarray(height / np.maximum(share[0] + share[1] * x + share[2] * y, AT_APEX))


def may_touch(faces: ImageFaces, first: Ints, second: Ints) -> tuple[Floats, Bools]:
    """(p,) how far surfaces may bulge over pairs of faces at most, and which pairs are of different items whose
    surfaces are parallel somewhere, as far as the turns of their normals tell: others cross if they meet."""
    assert faces.bulges is not None
    most, turn = (faces.bulges[row, first] + faces.bulges[row, second] for row in (MOST, TURN))
    one, two = (
        np.stack([-faces.planes[3, face], -faces.planes[4, face], np.ones(len(face))]) for face in (first, second)
    )
    cosine = dot(one, two) / np.sqrt(dot(one, one) * dot(two, two))
    near = arccos(np.clip(cosine, -1.0, 1.0)) <= turn
    return most, np.asarray(near & (most > 0.0) & (faces.bulges[ITEM, first] != faces.bulges[ITEM, second]))


def _in_image(view: View, points: Floats, normals: Floats) -> Floats:
    """(3,3,n) normals of the images of planes through points of a view with normals (3,3,n), as of image_points."""
    if view.eye is None:
        return normals
    eye = np.array([view.eye[0], view.eye[1], view.eye[2] - view.focus])
    found = normals.copy()
    found[2] += dot(normals, eye[:, None, None] - points) / view.focus
    return found
