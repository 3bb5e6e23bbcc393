"""What of quadric bodies is seen from a light, or the eye, in cells: which of them a place may lie behind or beside."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.rotations import look_rotation
from vectorplot.scene.light import Light, is_amid
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies

CELLS_OF_BODY, MOST_CELLS = 8, 256
"""So many cells of a grid there are for each body, and along its sides at most."""

MOST_ENTRIES = 1 << 24
"""So many times, in all, bodies may stand in cells."""

SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""The directions of the six windows of a lamp amid bodies."""


@dataclass(frozen=True, eq=False)
class LightWindows:
    """What a light sees of bodies: one window, or six around a lamp amid them."""

    windows: tuple[_Window, ...]

    @classmethod
    def of(cls, light: Light, bodies: QuadricBodies, beside: float = 0.0) -> LightWindows:
        """The windows of bodies in the coordinates of the light; places are told all bodies that their ways to the
        light run into, or past at no more than some distance."""
        points, reach = end_balls(bodies)
        reach = reach + beside
        corners = np.stack([(points - reach).min(axis=(0, 2)), (points + reach).max(axis=(0, 2))])
        place = np.asarray(light.position, dtype=np.float64)
        amid = is_amid(light, corners)
        origin = np.zeros(3) if light.parallel else place
        back = place if light.parallel else place - corners.mean(axis=0)
        turns = [_turned(way) for way in SIDES] if amid else [look_rotation(back).T]
        return cls(tuple(_Window.of(turn, origin, light.parallel, points, reach, amid) for turn in turns))

    def pairs(self, points: Floats) -> Iterator[tuple[Ints, Ints]]:
        """Pairs of points (3,m), by their numbers, and bodies that may be before or beside them; all of one point
        together."""
        for window in self.windows:
            yield from window.pairs(points)


def end_balls(bodies: QuadricBodies) -> tuple[Floats, Floats]:
    """(2,3,n) middles and (2,1,n) radii of two balls whose hull a body lies in."""
    wide = np.sqrt((bodies.sizes[:2] ** 2).sum(axis=0))
    wide = np.where(bodies.is_right, bodies.sizes[0], wide)
    whole = np.where(bodies.is_right, bodies.sizes[0], np.sqrt((bodies.sizes**2).sum(axis=0)))
    points, reach = [], []
    for end in (0, 1):
        points.append(bodies.centre + np.where(bodies.is_ball, 0.0, bodies.ends[end]) * bodies.frame[2])
        reach.append(np.where(bodies.is_ball, whole, bodies.radius_at(end) * wide))
    return np.stack(points), np.stack(reach)[:, None]


def _turned(way: Floats) -> Floats:
    """(3,3) rows right, up and back of a look along an axis."""
    right = np.roll(np.abs(way), 1)
    return np.stack([right, np.cross(right, way), -way])


@dataclass(frozen=True, eq=False)
class _Window:
    """A part of what a light sees, in cells: rows (3,3) right, up and back; low, size (2,) of the first cell; side: how
    many there are along both; body (k,), offsets (side * side + 1,): what may be seen in each; nearest (n,): the
    smallest distances of bodies from the light, along the window's axis."""

    rows: Floats
    origin: Floats
    parallel: bool
    low: Floats
    size: Floats
    side: int
    body: Ints
    offsets: Ints
    nearest: Floats

    @classmethod
    def of(cls, rows: Floats, origin: Floats, parallel: bool, points: Floats, reach: Floats, whole: bool) -> _Window:
        """The window of bodies in hulls of two balls, points (2,3,n) and reach (2,1,n); whole: a quarter turn."""
        there = np.stack([matmul(rows, end - origin[:, None]) for end in points])
        depth, radius = -there[:, 2], reach[:, 0]
        if parallel:
            boxes = np.stack([there[:, :2] - reach, there[:, :2] + reach])
        else:
            boxes = _slopes(there[:, :2], depth[:, None], reach)
        low, high = boxes[0].min(axis=0), boxes[1].max(axis=0)
        nearest = (depth - radius).min(axis=0)
        ahead = np.ones(len(nearest), dtype=np.bool_) if parallel else (depth + radius).max(axis=0) > 0.0
        if whole:
            start, end = np.full(2, -1.0), np.full(2, 1.0)
        else:
            start, end = low.min(axis=1), high.max(axis=1)
        side = 2 * int(min(max(np.sqrt(CELLS_OF_BODY * len(nearest)), 1.0), MOST_CELLS))
        entries = MOST_ENTRIES + 1
        while entries > MOST_ENTRIES and side > 1:
            side //= 2
            size = np.maximum((end - start) / side, LEAST_DIVISOR)
            first = np.clip(np.floor((low - start[:, None]) / size[:, None]), 0, side).astype(np.intp)
            last = np.clip(np.floor((high - start[:, None]) / size[:, None]), -1, side - 1).astype(np.intp)
            wide, tall = np.where(ahead, np.maximum(last - first + 1, 0), 0)
            count = wide * tall
            entries = int(count.sum())
        of, number = np.repeat(np.arange(len(count)), count), ragged.place(count)
        row, column = np.divmod(number, wide[of])
        cell = (first[1][of] + row) * side + first[0][of] + column
        order = np.argsort(cell, kind="stable")
        offsets = ragged.offsets(np.bincount(cell, minlength=side * side))
        return cls(rows, origin, parallel, start, size, side, of[order], offsets, nearest)

    def pairs(self, points: Floats) -> Iterator[tuple[Ints, Ints]]:
        """Pairs of points (3,m), by their numbers, and bodies that may be before them."""
        there = matmul(self.rows, points - self.origin[:, None])
        depth = -there[2]
        flat = there[:2]
        if not self.parallel:
            flat = flat / np.where(depth > 0.0, depth, 1.0)
        column, row = np.floor((flat - self.low[:, None]) / self.size[:, None])
        shown = (column >= 0) & (column < self.side) & (row >= 0) & (row < self.side)
        if not self.parallel:
            shown &= depth > 0.0
        which = np.flatnonzero(shown)
        cell = (row[which] * self.side + column[which]).astype(np.intp)
        count = np.diff(self.offsets)[cell]
        for begin, stop in ragged.batches(count, PAIRS_AT_ONCE):
            own = np.repeat(which[begin:stop], count[begin:stop])
            body = self.body[ragged.ranges(self.offsets[cell[begin:stop]], count[begin:stop])]
            near = self.nearest[body] < depth[own]
            yield own[near], body[near]


def _slopes(flat: Floats, depth: Floats, reach: Floats) -> Floats:
    """(2,2,2,n) the smallest and the largest slopes at which balls, two for each of n bodies, are seen from the origin:
    between planes that touch them; all slopes where there are none."""
    square = depth * depth - reach * reach
    root = reach * np.sqrt(np.maximum(flat * flat + square, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        low, high = (flat * depth - root) / square, (flat * depth + root) / square
    # A ball with the light beside it in depth has no end in the window.
    whole = np.broadcast_to((square <= 0.0) | (depth <= 0.0), flat.shape)
    return np.stack([np.where(whole, -np.inf, low), np.where(whole, np.inf, high)])
