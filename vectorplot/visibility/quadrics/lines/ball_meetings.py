"""The circles in which spheres and ellipsoids meet each other and the faces of polyhedra."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.bounds.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.records import joined
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_values import HOMOTHETIC
from vectorplot.visibility.projected_faces import newell
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.visibility.quadrics.bodies.seen_balls import Balls
from vectorplot.visibility.quadrics.conic_arcs import arcs_on
from vectorplot.visibility.quadrics.lines.ball_arcs import Found, on_balls, own_sides, plane_circles, unit_planes
from vectorplot.visibility.quadrics.lines.parts_of_circles import parts_inside
from vectorplot.words import LineKind


def overlapping_balls(balls: Balls) -> tuple[Ints, Ints]:
    """Pairs i < j of balls that meet, and some that do not but nearly."""
    low, high = (balls.centre - balls.reach).T, (balls.centre + balls.reach).T
    one, two = overlapping_boxes(low, high, low, high)
    close = one < two
    one, two = one[close], two[close]
    near = np.zeros(len(one), dtype=np.bool_)
    for first in range(0, len(one), PAIRS_AT_ONCE):
        block = slice(first, first + PAIRS_AT_ONCE)
        near[block] = _near(balls, one[block], two[block]) & _near(balls, two[block], one[block])
    return one[near], two[near]


def _near(balls: Balls, one: Ints, two: Ints) -> Bools:
    """(n,) whether, where the first ball of a pair is the unit sphere, the second one comes so near its centre: a ball
    by its radius, another ellipsoid by its box; and not so near that one lies in the other."""
    frame = np.einsum("nij,njk->nik", balls.frame[two], balls.inverse[one])
    centre = np.einsum("ni,nij->nj", balls.centre[two] - balls.centre[one], balls.inverse[one])
    alike, ratio = are_homothetic(balls, two, one)
    beside = np.maximum(np.abs(centre) - np.sqrt((frame * frame).sum(axis=1)), 0.0)
    distance = np.sqrt(dot(centre, centre))
    radius = np.sqrt(ratio)
    # One inside the other meets it nowhere.
    met = (distance <= 1.0 + radius) & (distance >= np.abs(1.0 - radius))
    return np.where(alike, met, dot(beside, beside) <= 1.0)


def are_homothetic(balls: Balls, one: Ints, two: Ints) -> tuple[Bools, Floats]:
    """Which pairs are of one form, in one direction, so that they meet in a plane; and the square of the ratio of their
    sizes."""
    inside = np.einsum("nij,njk->nik", balls.frame[one], balls.inverse[two])
    product = np.einsum("nij,nkj->nik", inside, inside)
    ratio = np.einsum("nii->n", product) / 3.0
    off = np.abs(product - ratio[:, None, None] * np.eye(3)).max(axis=(1, 2), initial=0.0)
    return np.asarray(off <= HOMOTHETIC * ratio), ratio


def balls_with_balls(balls: Balls, one: Ints, two: Ints, wants: Bools) -> Found:
    """The circles of pairs of balls that are_homothetic; wants (n,): the balls that want them.

    A circle belongs to the item, of those that want it, that comes first in the scene. Degenerate: balls that touch, or
    are one, have none.
    """
    kept = (wants[one] | wants[two]) & (balls.same[one] != balls.same[two])
    one, two = one[kept], two[kept]
    swap = ~wants[one] | (wants[two] & (balls.item[two] < balls.item[one]))
    one, two = np.where(swap, two, one), np.where(swap, one, two)
    # The second ball where the first one is the unit sphere: |s inside + arm| = 1.
    inside = np.einsum("nij,njk->nik", balls.frame[one], balls.inverse[two])
    arm = np.einsum("ni,nij->nj", balls.centre[one] - balls.centre[two], balls.inverse[two])
    ratio = (inside * inside).sum(axis=(1, 2)) / 3.0
    normal = np.einsum("nij,nj->ni", inside, arm)
    size = np.sqrt(dot(normal, normal))
    with np.errstate(divide="ignore", invalid="ignore"):
        height = (1.0 - dot(arm, arm) - ratio) / (2.0 * size)
        touching = balls.tolerance / balls.reach[one].max(axis=1, initial=0.0)
        met = np.flatnonzero((np.abs(height) < 1.0 - touching) & (size > 0.0))
    one, two = one[met], two[met]
    circles = balls.circles(one, normal[met] / size[met, None], height[met])
    arcs, first = on_balls(balls, circles, LineKind.INTERSECTION, one)
    arcs.own[:, 1] = two
    return arcs, joined((first, own_sides(balls, two)))


def balls_with_faces(view: View, balls: Balls, wants: Bools) -> Found:
    """The arcs in which balls meet the faces of polyhedra; wants (i,): the items that want them.

    An arc belongs to the item, of those that want it, that comes first in the scene. Degenerate: a face that a ball
    touches has none.
    """
    sight = balls.sight
    points = sight.points(view.points.T)
    at_corner = points[view.corners].T
    starts = view.offsets[:-1]
    if not len(starts) or not len(balls):
        return plane_circles(balls, np.zeros(0, np.intp), np.zeros((0, 3)), np.zeros((0, 3)), LineKind.INTERSECTION)
    low, high = np.minimum.reduceat(at_corner, starts, axis=1), np.maximum.reduceat(at_corner, starts, axis=1)
    ball, face = overlapping_boxes((balls.centre - balls.reach).T, (balls.centre + balls.reach).T, low, high)
    kept = wants[balls.item[ball]] | wants[view.face_item[face]]
    ball, face = ball[kept], face[kept]
    normal, origin = _planes(view, sight, face)
    good = dot(normal, normal) > 0.0
    ball, face, normal, origin = ball[good], face[good], normal[good], origin[good]
    met, s, height = unit_planes(balls, ball, normal, origin)
    ball, face, normal = ball[met], face[met], normal[met]
    middle, first, second = balls.circles(ball, s, height)
    return _within_faces(view, points, balls, (middle, first, second), ball, face, normal, wants)


def _planes(view: View, sight: EyeCoordinates, face: Ints) -> tuple[Floats, Floats]:
    """Unit normals (n,3) of faces (n,) in the coordinates of sight, zero where there are none, and a corner of each."""
    which, number = np.unique(face, return_inverse=True)
    area, _, first = newell(view, which)
    # Coordinates of sight are mirrored ones: there a normal shows to the other side.
    normal = -sight.vectors(area.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = normal / np.sqrt(dot(normal, normal))[:, None]
    unit = np.where(np.isfinite(normal), normal, 0.0)
    return unit[number], sight.points(view.points[:, first].T)[number]


def _within_faces(
    view: View,
    points: Floats,
    balls: Balls,
    circles: tuple[Floats, Floats, Floats],
    ball: Ints,
    face: Ints,
    normal: Floats,
    wants: Bools,
) -> Found:
    """The parts of circles in the planes of faces that lie in these, which are convex."""
    middle, first, second = circles
    size = view.face_sizes[face]
    circle = ragged.owner(size)
    position = ragged.ranges(view.offsets[face], size)
    start = points[view.corners[position]]
    along = points[view.corners[view.after(position)]] - start
    inward = cross(normal[circle], along)
    with np.errstate(divide="ignore", invalid="ignore"):
        inward /= np.sqrt(dot(inward, inward))[:, None]
    forms = np.concatenate([inward, -dot(start, inward)[:, None]], axis=1)
    of, low, high = parts_inside(circles, circle, forms, balls.tolerance)
    item, other = balls.item[ball[of]], view.face_item[face[of]]
    item = np.where(wants[item] & (~wants[other] | (item < other)), item, other)
    own = np.stack([ball[of], np.full_like(of, -1)], axis=1)
    arcs = arcs_on((middle[of], first[of], second[of]), (low, high), LineKind.INTERSECTION, item, own)
    return arcs, own_sides(balls, ball[of])
