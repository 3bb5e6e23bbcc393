"""What hides: the region behind each ball and the ball itself, as signs of linear and quadratic forms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.visibility.polyhedra.grid import Floats32
from vectorplot.visibility.quadrics.balls import Balls
from vectorplot.visibility.quadrics.pieces import packed_box
from vectorplot.visibility.quadrics.sight import Sight


@dataclass(frozen=True, eq=False)
class Covers:
    """Regions of space in which everything is hidden.

    Cover k hides the points X = (x,y,z,1) with linear[j,:,k].X > 0 for all j and, if there are squares, with
    squares[0,:,k].X squared larger than the sum of the squares of the others. linear (l,4,n): forms with gradients of
    length 1; squares (q,4,n): forms; slack (n,): what counts as zero of the difference, where squares[0,:,k].X is 1.
    body (n,): the ball; item (n,); box (4,n) left, right, bottom, top in the image; nearest, farthest (n,) depth.
    """

    linear: Floats
    squares: Floats
    slack: Floats
    body: Ints
    item: Ints
    box: Floats32
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.body)


def ball_covers(balls: Balls, which: Ints) -> tuple[Covers, Covers]:
    """What balls hide: all beyond their polar planes inside their outlines, and what is inside of them.

    The inside is taken whole, for a curve that pierces the ball near its contour would slip between two halves.
    """
    return _behind(balls, which), _inside(balls, which)


def _behind(balls: Balls, which: Ints) -> Covers:
    middle, first, second = balls.contours(which)
    m, p, q = (_seen(balls.sight, part, w) for part, w in ((middle, 1.0), (first, 0.0), (second, 0.0)))
    rows = np.stack([np.cross(p, q), np.cross(q, m), np.cross(m, p)], axis=1)
    volume = (rows[:, 0] * m).sum(axis=1)
    squares = np.zeros((3, 4, len(which)))
    squares[:, balls.sight.seen] = (rows / volume[:, None, None]).transpose(1, 2, 0)
    low, high, reach = _disc_box(balls.sight, (m, p, q), middle, first, second)
    return Covers(
        -balls.polar_planes(which).T[None],
        squares,
        _slack(balls, which),
        which,
        balls.item[which],
        packed_box(low, high),
        middle[:, 2] - reach,
        np.full(len(which), np.inf),
    )


def _inside(balls: Balls, which: Ints) -> Covers:
    squares = np.zeros((4, 4, len(which)))
    squares[0, 3] = 1.0
    inverse, centre = balls.inverse[which], balls.centre[which]
    squares[1:, :3] = inverse.transpose(2, 1, 0)
    squares[1:, 3] = -np.einsum("ni,nij->nj", centre, inverse).T
    middle, first, second = balls.contours(which)
    m, p, q = (_seen(balls.sight, part, w) for part, w in ((middle, 1.0), (first, 0.0), (second, 0.0)))
    low, high, _ = _disc_box(balls.sight, (m, p, q), middle, first, second)
    depth, reach = centre[:, 2], balls.reach[which, 2]
    return Covers(
        np.zeros((0, 4, len(which))),
        squares,
        _slack(balls, which),
        which,
        balls.item[which],
        packed_box(low, high),
        depth - reach,
        depth + reach,
    )


def _seen(sight: Sight, part: Floats, weight: float) -> Floats:
    """(n,3) what is seen of points or vectors (n,3)."""
    return np.concatenate([part, np.full((len(part), 1), weight)], axis=1)[:, sight.seen]


def _slack(balls: Balls, which: Ints) -> Floats:
    """A distance of the tolerance from the smallest axis of a ball, in squares of its radius."""
    return np.asarray(2.0 * balls.tolerance / balls.reach[which].min(axis=1, initial=np.inf))


def _disc_box(
    sight: Sight, seen: tuple[Floats, Floats, Floats], middle: Floats, first: Floats, second: Floats
) -> tuple[Floats, Floats, Floats]:
    """Lower left and upper right corners (2,n) of the images of elliptic discs, NaN where they come behind the eye; and
    how much their depth (n,) varies about that of their middle."""
    m, p, q = seen
    products = m[:, :, None] * m[:, None] - p[:, :, None] * p[:, None] - q[:, :, None] * q[:, None]
    reach = np.sqrt(first[:, 2] ** 2 + second[:, 2] ** 2)
    last = products[:, 2, 2]
    behind: Bools = (middle[:, 2] - reach < sight.near) if sight.central else np.zeros(len(m), dtype=np.bool_)
    with np.errstate(all="ignore"):
        centre = products[:, :2, 2] / last[:, None]
        square = products[:, :2, 2] ** 2 - products[:, [0, 1], [0, 1]] * last[:, None]
        half = np.sqrt(np.maximum(square, 0.0)) / last[:, None]
    hole = (behind | ~(last > 0.0))[:, None]
    return np.where(hole, np.nan, centre - half).T, np.where(hole, np.nan, centre + half).T, reach
