"""Pairs of surfaces that are looked at as one: as many as fit into memory, and of each only what is near the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.intersections.surface_patches import StackedPatches, SurfacePatch
from vectorplot.features.intersections.triangle_pairs import overlapping_of_each
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Surface

MOST_NODES = 1 << 18
"""Points that the grids of the pairs looked at as one have in all: what is known of them fills memory."""

MOST_CELLS = 1 << 15
"""Cells near each other that they have in all, unless one pair has more."""

Couple = tuple[SurfacePatch, SurfacePatch]


@dataclass(frozen=True, eq=False)
class Part:
    """Some pairs, by their numbers, as two patches."""

    numbers: Sequence[int]
    one: Patch
    two: Patch


def alike(pairs: Sequence[tuple[Surface, Surface]]) -> list[list[int]]:
    """The numbers of pairs of surfaces, those together that can be asked as one: placed ones that are closed in the
    same directions."""
    members: dict[object, list[int]] = {}
    for number, pair in enumerate(pairs):
        placed = all(isinstance(surface, PlacedSurface) for surface in pair)
        ways = tuple((surface.domain.closed_u, surface.domain.closed_v) for surface in pair)
        members.setdefault(ways if placed else number, []).append(number)
    return list(members.values())


def parts(pairs: Sequence[Couple]) -> Iterator[Part]:
    """Pairs that are alike in parts of as many as fit into memory; those with nothing near each other are left out."""
    first = pairs[0][0]
    if not isinstance(first.surface, PlacedSurface):
        # Such pairs are not alike any other.
        yield Part((0,), *pairs[0])
        return
    most = max(1, MOST_NODES // ((first.columns + 1) * (first.rows + 1)))
    for begin in range(0, len(pairs), most):
        some = pairs[begin : begin + most]
        cells = _near_cells(some)
        sizes = np.array([min(map(len, own)) and sum(map(len, own)) for own in cells])
        there = np.flatnonzero(sizes)
        cuts = np.flatnonzero(np.diff(np.cumsum(sizes[there]) // MOST_CELLS)) + 1
        for own in np.split(there, cuts) if len(there) else ():
            sides = ((tuple(some[k][side] for k in own), tuple(cells[k][side] for k in own)) for side in (0, 1))
            one, two = (StackedPatches(patches, near) for patches, near in sides)
            yield Part((begin + own).tolist(), one, two)


def _near_cells(pairs: Sequence[Couple]) -> list[tuple[Ints, Ints]]:
    """For each pair the cells of both patches that come near one of the other."""
    whole = [[_around(patch) for patch in pair] for pair in pairs]
    low, high, cells, numbers = [], [], [], []
    for side in (0, 1):
        near = [_within(pair[side], others[1 - side]) for pair, others in zip(pairs, whole, strict=True)]
        cells.append(np.concatenate(near))
        numbers.append(np.repeat(np.arange(len(pairs)), [len(own) for own in near]))
        boxes = [(pair[side].cell_boxes, own) for pair, own in zip(pairs, near, strict=True)]
        low.append(np.concatenate([box[0][:, own] for box, own in boxes], axis=1))
        high.append(np.concatenate([box[1][:, own] for box, own in boxes], axis=1))
    found = [np.unique(which) for which in overlapping_of_each(low, high, numbers)]
    first, second = (
        np.split(own[which], np.searchsorted(number[which], np.arange(1, len(pairs))))
        for own, number, which in zip(cells, numbers, found, strict=True)
    )
    return list(zip(first, second, strict=True))


def _around(patch: SurfacePatch) -> tuple[Floats, Floats]:
    """(3,) and (3,) the box around all cells."""
    low, high = patch.cell_boxes
    return low.min(axis=1), high.max(axis=1)


def _within(patch: SurfacePatch, box: tuple[Floats, Floats]) -> Ints:
    """The cells of a patch that reach into a box."""
    (low, high), (start, end) = patch.cell_boxes, box
    return np.flatnonzero(((low <= end[:, None]) & (high >= start[:, None])).all(axis=0))
