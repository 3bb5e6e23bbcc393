"""What hides: the region behind each ball and the ball itself, as signs of linear and quadratic forms."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.visibility.polyhedra.grid import Floats32
from vectorplot.visibility.quadrics.arc_pieces import packed_box
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.visibility.quadrics.bodies.seen_balls import Balls


@dataclass(frozen=True, eq=False)
class Covers:
    """Regions of space in which everything is hidden.

    Cover k hides the points X = (x,y,z,1) with linear[j,:,k].X > 0 for all j and, if there are squares, with
    squares[0,:,k].X squared larger than the sum of the squares of the others. linear (l,4,n): forms with gradients of
    length 1; squares (q,4,n): forms; slack (n,): what counts as zero of the difference, where squares[0,:,k].X is 1.
    body (n,): the ball; item (n,); box (4,n) left, right, bottom, top in the image; nearest, farthest (n,) depth.
    """

    linear: Floats = field(metadata=IN_COLUMNS)
    squares: Floats = field(metadata=IN_COLUMNS)
    slack: Floats
    body: Ints
    item: Ints
    box: Floats32 = field(metadata=IN_COLUMNS)
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.body)


def ball_covers(balls: Balls, which: Ints) -> tuple[Covers, Covers]:
    """What balls hide: all beyond their polar planes inside their outlines, and what is inside of them.

    The inside is taken whole, for a curve that pierces the ball near its contour would slip between two halves.
    """
    contours = balls.contours(which)
    box = packed_box(*disc_boxes(balls.sight, *contours))
    return _behind(balls, which, contours, box), _inside(balls, which, box)


def _behind(balls: Balls, which: Ints, contours: tuple[Floats, Floats, Floats], box: Floats32) -> Covers:
    middle, first, second = contours
    return Covers(
        -balls.polar_planes(which).T[None],
        outlines(balls.sight, contours),
        _slack(balls, which),
        which,
        balls.item[which],
        box,
        middle[:, 2] - np.hypot(first[:, 2], second[:, 2]),
        np.full(len(which), np.inf),
    )


def outlines(sight: EyeCoordinates, discs: tuple[Floats, Floats, Floats]) -> Floats:
    """(3,4,n) forms, as the squares of covers, of what lies in the same direction as elliptic discs with these middles
    and conjugate radii (n,3)."""
    m, p, q = (_seen(sight, part, w) for part, w in zip(discs, (1.0, 0.0, 0.0), strict=True))
    rows = np.stack([np.cross(p, q), np.cross(q, m), np.cross(m, p)], axis=1)
    volume = (rows[:, 0] * m).sum(axis=1)
    squares = np.zeros((3, 4, len(m)))
    with np.errstate(divide="ignore", invalid="ignore"):
        squares[:, sight.seen] = (rows / volume[:, None, None]).transpose(1, 2, 0)
    return squares


def _inside(balls: Balls, which: Ints, box: Floats32) -> Covers:
    squares = np.zeros((4, 4, len(which)))
    squares[0, 3] = 1.0
    inverse, centre = balls.inverse[which], balls.centre[which]
    squares[1:, :3] = inverse.transpose(2, 1, 0)
    squares[1:, 3] = -np.einsum("ni,nij->nj", centre, inverse).T
    depth, reach = centre[:, 2], balls.reach[which, 2]
    none = np.zeros((0, 4, len(which)))
    item = balls.item[which]
    return Covers(none, squares, _slack(balls, which), which, item, box, depth - reach, depth + reach)


def _seen(sight: EyeCoordinates, part: Floats, weight: float) -> Floats:
    """(n,3) what is seen of points or vectors (n,3)."""
    return np.concatenate([part, np.full((len(part), 1), weight)], axis=1)[:, sight.seen]


def _slack(balls: Balls, which: Ints) -> Floats:
    """A distance of the tolerance from the smallest axis of a ball, in squares of its radius."""
    return np.asarray(2.0 * balls.tolerance / balls.reach[which].min(axis=1, initial=np.inf))


def disc_boxes(sight: EyeCoordinates, middle: Floats, first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Lower left and upper right corners (2,n) of the images of elliptic discs with these middles and conjugate radii
    (n,3); NaN where a disc comes before the near plane."""
    if not sight.central:
        reach = np.hypot(first[:, :2], second[:, :2])
        return (middle[:, :2] - reach).T, (middle[:, :2] + reach).T
    depth, rise, other = middle[:, 2:], first[:, 2:], second[:, 2:]
    with np.errstate(all="ignore"):
        # Seen from the image of the middle, so that small discs keep their digits: a line through the eye that touches
        # the disc has a slope s with (p - s rise)^2 + (q - s other)^2 = (s depth)^2.
        centre = middle[:, :2] / depth
        p, q = first[:, :2] - centre * rise, second[:, :2] - centre * other
        a, b, c = depth * depth - rise * rise - other * other, p * rise + q * other, p * p + q * q
        root = np.sqrt(b * b + a * c)
        low, high = centre - (root + b) / a, centre + (root - b) / a
    hole = depth - np.hypot(rise, other) < sight.near
    return np.where(hole, np.nan, low).T, np.where(hole, np.nan, high).T
