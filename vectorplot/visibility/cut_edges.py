"""Which lines are edges of cuts, and which are ghosts of what was cut away."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import CUT_EDGE_OF_EXTENT
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind


def with_kinds_of_cuts(scene: Scene, view: View, lines: Lines, kinds: frozenset[LineKind]) -> Lines:
    """The lines; borders of items on what was cut away of them are edges of cuts, and in the planes of these; all
    outlines of ghosts but those are ghosts, and sections of cut faces are hatches. Borders that
    were looked for only because of that are left out."""
    kind, kept = lines.kind.copy(), np.ones(len(lines), dtype=np.bool_)
    start, end = lines.start, lines.end
    for number, item in enumerate(scene.items):
        own = kinds if item.lines is None else frozenset(map(LineKind.from_word, item.lines))
        if item.is_cut_face:
            kind[(lines.item == number) & (kind == LineKind.SECTION)] = LineKind.HATCH
        if not item.cut_by or not own & {LineKind.CUT, LineKind.BOUNDARY, LineKind.GHOST}:
            continue
        which = np.flatnonzero((lines.item == number) & (kind == LineKind.BOUNDARY))
        shifts, cut = _onto_cuts(item.cut_by, view, lines.some(which), 2 if item.is_cut_face else 1)
        which, other = which[cut], which[~cut]
        if LineKind.GHOST in own:
            kind[lines.item == number] = LineKind.GHOST
            # Where it was cut the edge of what is left runs.
            kept[which] = False
            continue
        kind[which] = LineKind.CUT
        kept[which], kept[other] = LineKind.CUT in own, LineKind.BOUNDARY in own and not item.is_cut_face
        start, end = start.copy(), end.copy()
        start[:, which] += shifts[0][:, cut]
        end[:, which] += shifts[1][:, cut]
    if kept.all() and (kind == lines.kind).all():
        return lines
    return replace(lines, kind=kind, start=start, end=end).some(kept)


def _onto_cuts(regions: tuple[HalfSpaces, ...], view: View, lines: Lines, planes: int) -> tuple[Floats, Bools]:
    """The ways (2,3,n) of both ends of lines onto the planes on which they run along the borders of regions, and which
    of them do so on so many planes. Rims of holes are looked at from a little inside of the surface."""
    ways, found = np.zeros((2, 3, len(lines))), np.zeros(len(lines), dtype=np.intp)
    for region in regions:
        normals = matmul(np.array(region.normals), view.axes.T)
        offsets = (np.array(region.offsets) - matmul(np.array(region.normals), view.centre)) / view.scale
        here = HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))
        heights = np.stack([here.heights(points.T) for points in (lines.start, lines.end)])
        before = (heights >= -CUT_EDGE_OF_EXTENT).all(axis=(0, 1))
        off = np.abs(heights).max(axis=0)
        nearest = np.argmin(off, axis=0)
        column = np.arange(len(lines))
        on = before & (off[nearest, column] <= CUT_EDGE_OF_EXTENT)
        way = -heights[:, nearest, column][:, None, :] * normals[nearest].T
        ways[:, :, on] = way[:, :, on]
        found += np.where(before, (off <= CUT_EDGE_OF_EXTENT).sum(axis=0), 0)
    return ways, found >= planes
