"""Meshes divided by a convex region: what lies in it, and what lies outside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.cuts.half_spaces import HalfSpaces, nothing_beside
from vectorplot.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Divided:
    """The parts of a mesh outside and inside of a region, open where they were cut; place (f,): where each face is
    found outside, -1 if it is gone or cut."""

    outside: Mesh
    inside: Mesh
    place: Ints


@dataclass(frozen=True, eq=False)
class _Polygons:
    """Corners (c,) and offsets (p+1,) of polygons."""

    corners: Ints
    offsets: Ints

    @property
    def count(self) -> int:
        return len(self.offsets) - 1

    def some(self, which: Bools) -> _Polygons:
        corners, offsets = ragged.take(self.offsets, which)
        return _Polygons(self.corners[corners], offsets)


@dataclass(frozen=True, eq=False)
class _Made:
    """Vertices that were made on sides: the ends (2,m) of these, the smaller number first, and their numbers (m,)."""

    ends: Ints
    numbers: Ints


def divided_mesh(mesh: Mesh, region: HalfSpaces) -> Divided:
    """The parts of a mesh outside and inside of a region; new vertices lie on edges, one for all faces there.

    Degenerate: vertices no farther from a plane than rounding are on it; a face in a plane belongs to the side where
    its body is. Faces that are not convex are divided into convex parts where they are cut; faces that are not
    present are left out.
    """
    points = mesh.vertices
    heights = _snapped(region.heights(points), points)
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    every = _Polygons(mesh.corners, mesh.offsets)
    sides = np.stack([_sides(every, one, points, normal) for one, normal in zip(heights, region.normals, strict=True)])
    out, within = present & (sides < 0).any(axis=0), present & (sides > 0).all(axis=0)
    cut = present & ~out & ~within
    outer, inner = [every.some(out)], every.some(within)
    if not cut.any():
        place = np.where(out, np.cumsum(out) - 1, -1)
        return Divided(_mesh(points, outer), _mesh(points, [inner]), place)
    current = _convex(points, every.some(cut))
    tables = []
    for number, normal in enumerate(region.normals):
        current, points, heights, made = _split(current, points, heights, number)
        tables.append(made)
        side = _sides(current, heights[number], points, normal)
        outer.append(current.some(side < 0))
        current = current.some(side >= 0)
    if len(tables) > 1:
        outer = [_with_corners(some, tables, len(points)) for some in outer]
        inner = _with_corners(inner, tables, len(points))
    place = np.where(out, np.cumsum(out) - 1, -1)
    return Divided(_mesh(points, outer), _mesh(points, [inner, current]), place)


def section_sides(mesh: Mesh, region: HalfSpaces, number: int) -> Floats:
    """(2,s,3) the sides, from start to end, of the section of a closed mesh with one of the planes of a region: they
    run around the inside of the body counter-clockwise, seen from the side to which the normal leads.

    Degenerate: a face in the plane counts to the side where its body is, so that a body that stands on the plane has
    no section.
    """
    one = HalfSpaces(region.normals[number : number + 1], region.offsets[number : number + 1])
    points, normal = mesh.vertices, one.normals[0]
    heights = _snapped(one.heights(points), points)
    every = _Polygons(mesh.corners, mesh.offsets)
    # What lies wholly on one side does not meet the plane.
    below, above = heights[0] <= 0.0, heights[0] >= 0.0
    near = _count(every, below) * _count(every, above) > 0
    near &= (_count(every, below & above) > 1) | ((_count(every, ~above) > 0) & (_count(every, ~below) > 0))
    some = every.some(near)
    side = _sides(some, heights[0], points, normal)
    pieces, points, heights, _ = _split(_convex(points, some.some(side == 0)), points, heights, 0)
    kept = [some.some(side < 0), pieces.some(_sides(pieces, heights[0], points, normal) < 0)]
    starts, ends = [], []
    for part in kept:
        here, there = part.corners, part.corners[ragged.following(part.offsets)]
        on = (heights[0][here] == 0.0) & (heights[0][there] == 0.0)
        starts.append(here[on])
        ends.append(there[on])
    start, end = np.concatenate(starts), np.concatenate(ends)
    low, high = np.minimum(start, end), np.maximum(start, end)
    keys, first, which = np.unique(low * len(points) + high, return_index=True, return_inverse=True)
    # Two faces that stay and share a side leave nothing open there.
    net = np.bincount(which.reshape(-1), np.where(start < end, 1, -1), len(keys)).astype(np.intp)
    low, high = low[first], high[first]
    start, end = (np.repeat(np.where(net > 0, one, other), np.abs(net)) for one, other in ((low, high), (high, low)))
    # Seen from above the plane what is below has these sides the other way round.
    return np.stack([points[end], points[start]])


def _snapped(heights: Floats, points: Floats) -> Floats:
    return np.where(np.abs(heights) <= nothing_beside(points), 0.0, heights)


def _count(polygons: _Polygons, vertices: Bools) -> Ints:
    """(p,) how many corners of each are among some vertices (v,)."""
    if polygons.offsets[-1] == 3 * polygons.count:
        return np.asarray(vertices[polygons.corners].reshape(-1, 3).sum(axis=1, dtype=np.intp))
    return np.add.reduceat(vertices[polygons.corners], polygons.offsets[:-1], dtype=np.intp)


def _sides(polygons: _Polygons, height: Floats, points: Floats, normal: tuple[float, float, float]) -> Ints:
    """(p,) 1 for what lies above a plane, -1 below, 0 on both sides; what lies in it is where its body is."""
    above, below = _count(polygons, height > 0.0) > 0, _count(polygons, height < 0.0) > 0
    side = above.astype(np.intp) - below
    flat = np.flatnonzero(~above & ~below)
    if len(flat):
        in_plane = np.zeros(polygons.count, dtype=np.bool_)
        in_plane[flat] = True
        some = polygons.some(in_plane)
        areas = Mesh(points, some.corners, some.offsets).area_vectors
        side[flat] = np.where(matmul(areas, np.array(normal)) < 0.0, 1, -1)
    return side


def _convex(points: Floats, polygons: _Polygons) -> _Polygons:
    """Convex polygons in place of others."""
    found = convex_faces(np.ascontiguousarray(points.T), polygons.corners, polygons.offsets, nothing_beside(points))
    return _Polygons(found.corners, found.offsets)


def _split(
    polygons: _Polygons, points: Floats, heights: Floats, number: int
) -> tuple[_Polygons, Floats, Floats, _Made]:
    """Convex polygons, those on both sides of a plane as two each; the points and heights (k,v) with those of new
    vertices; and these."""
    height = heights[number]
    here = polygons.corners
    there = here[ragged.following(polygons.offsets)]
    crossing = height[here] * height[there] < 0.0
    low, high = np.minimum(here, there)[crossing], np.maximum(here, there)[crossing]
    _, first, which = np.unique(low * (len(points) + 1) + high, return_index=True, return_inverse=True)
    low, high = low[first], high[first]
    share = height[low] / (height[low] - height[high])
    new = points[low] + share[:, None] * (points[high] - points[low])
    more = heights[:, low] + share * (heights[:, high] - heights[:, low])
    more[number] = 0.0
    slots = np.stack([here, np.full(len(here), -1)], axis=1)
    slots[crossing, 1] = len(points) + which.reshape(-1)
    points, heights = np.concatenate([points, new]), np.concatenate([heights, more], axis=1)
    height = heights[number]
    both = (_count(polygons, height > 0.0) > 0) & (_count(polygons, height < 0.0) > 0)
    owner = ragged.owner(np.diff(polygons.offsets))
    parts = []
    for sign in (-1.0, 1.0):
        # What is on one side only comes once, whole.
        kept = np.stack([sign * height[here] >= 0.0, crossing], axis=1)
        kept[~both[owner]] = (True, False) if sign < 0.0 else (False, False)
        sizes = np.bincount(owner, kept.sum(axis=1), polygons.count).astype(np.intp)
        parts.append(_Polygons(slots[kept], ragged.offsets(sizes[sizes > 0])))
    made = _Made(np.stack([low, high]), np.arange(len(points) - len(new), len(points)))
    return _joined(parts), points, heights, made


def _with_corners(polygons: _Polygons, tables: list[_Made], count: int) -> _Polygons:
    """The polygons with the vertices that were made on sides they share with others; count: of all vertices."""
    for made in tables:
        low, high = made.ends
        keys = low * count + high
        order = np.argsort(keys, kind="stable")
        if not len(keys):
            continue
        here = polygons.corners
        there = here[ragged.following(polygons.offsets)]
        asked = np.minimum(here, there) * count + np.maximum(here, there)
        at = np.minimum(np.searchsorted(keys[order], asked), len(keys) - 1)
        found = keys[order][at] == asked
        if not found.any():
            continue
        slots = np.stack([here, made.numbers[order][at]], axis=1)
        kept = np.stack([np.ones(len(here), dtype=np.bool_), found], axis=1)
        owner = ragged.owner(np.diff(polygons.offsets))
        sizes = np.bincount(owner, kept.sum(axis=1), polygons.count).astype(np.intp)
        polygons = _Polygons(slots[kept], ragged.offsets(sizes))
    return polygons


def _joined(parts: list[_Polygons]) -> _Polygons:
    sizes = np.concatenate([np.diff(part.offsets) for part in parts])
    return _Polygons(np.concatenate([part.corners for part in parts]), ragged.offsets(sizes))


def _mesh(points: Floats, parts: list[_Polygons]) -> Mesh:
    """The mesh of polygons, without the vertices that none of them has."""
    polygons = _joined(parts)
    used = np.zeros(len(points), dtype=np.bool_)
    used[polygons.corners] = True
    return Mesh(points[used], (np.cumsum(used) - 1)[polygons.corners], polygons.offsets)
