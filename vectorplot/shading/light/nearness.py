"""Where the surfaces of other items are near: points of them, so close together that nothing of them is missed."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.features.edge_splitting import Edges, surface_numbers
from vectorplot.features.facet_demands import INSIDE, AllSidesAlike, off_chords
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import norm
from vectorplot.scene.item import Item
from vectorplot.surfaces.surface import is_implicit, is_parametrised

if TYPE_CHECKING:
    from vectorplot.features.facets import Facets

CLOSENESS = 1.0 / 80.0
"""Points are no farther apart than this part of the diagonal of the box in which they are looked for."""

COARSENESS = 1.0 / 512.0
"""The triangles that points lie on are no farther off a surface than this part of the diagonal of its box."""

MOST_COARSE = 1 << 14
"""Surfaces that take more triangles than these are taken to be everywhere in their boxes."""

ROUNDS = 48
"""Triangles are halved so many times at most: to a sixteen millionth of their sides."""

BETWEEN = 2.0 / 3.0
"""No point of a triangle is farther from its middle than this part of its longest side."""


@dataclass(frozen=True)
class Coarse(AllSidesAlike):
    """Triangles that are no farther than a distance from their surface, each of one or several, whatever is seen of
    them, as features.edge_splitting.Demand."""

    distances: tuple[float, ...]

    @property
    def alike(self) -> Hashable:
        """Equal for what can be asked at once: all of them."""
        return None

    @classmethod
    def joined(cls, asked: Sequence[Coarse]) -> Coarse:
        """All of these distances, of surfaces one after the other."""
        return cls(tuple(chain(*(some.distances for some in asked))))

    def excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand."""
        distance = np.array(self.distances)[surface_numbers(edges.start.places)]
        return np.asarray(off_chords(edges) / (INSIDE * distance))


@dataclass(frozen=True, eq=False)
class Nearby:
    """What there is of an item in a box (2,3): points (p,3), none of its own being farther than gap from all of them;
    none, and an infinite gap, where it may be everywhere."""

    box: Floats
    points: Floats
    gap: float

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        # It is asked for few points beside its own: a tree that is soon made does.
        return cKDTree(self.points, balanced_tree=False, compact_nodes=False)

    def distances(self, points: Floats, most: Floats) -> Floats:
        """(...,) how far points (..., 3) are from the item at least, up to most (...); most of all beside the box."""
        inside = np.asarray(((points >= self.box[0]) & (points <= self.box[1])).all(axis=-1), dtype=np.bool_)
        found = most.copy()
        if not np.isfinite(self.gap):
            found[inside] = 0.0
        elif len(self.points) and inside.any():
            far = float(most[inside].max()) + self.gap
            distance, _ = self._tree.query(points[inside], distance_upper_bound=far)
            found[inside] = np.clip(distance - self.gap, 0.0, most[inside])
        return found


def triangles_of_items(items: Sequence[Item], boxes: Sequence[Floats]) -> list[tuple[Floats, float]]:
    """Of each of some items with these boxes (2,3) triangles (t,3,3) that are near all that there is of it, and how
    near; an infinite distance where they are not. Those of curves are sides, with one corner twice."""
    extents = [float(norm(box[1] - box[0])) for box in boxes]
    smooth = [k for k, item in enumerate(items) if is_parametrised(item.shape) or is_implicit(item.shape)]
    found: dict[int, Facets] = {}
    if smooth:
        from vectorplot.features.stacked_facets import facets_of_all

        demands = [Coarse((COARSENESS * extents[k],)) for k in smooth]
        made = facets_of_all([items[k].shape for k in smooth], demands.__getitem__, MOST_COARSE)
        found = dict(zip(smooth, made, strict=True))
    return [_triangles(item, extents[k], found.get(k)) for k, item in enumerate(items)]


def _triangles(item: Item, extent: float, found: Facets | None) -> tuple[Floats, float]:
    """As triangles_of_items, of an item with a box of this diagonal, and with these facets if it is smooth."""
    if is_curve(item.shape):
        with np.errstate(invalid="ignore", over="ignore"):
            points = item.shape.points(np.linspace(item.shape.start, item.shape.end, 1 << 12))
        sides = np.stack((points[:-1], points[1:], points[1:]), axis=1)
        return sides[np.isfinite(sides).all(axis=(1, 2))], COARSENESS * extent
    mesh, off = item.mesh, 0.0
    if found is not None:
        mesh, off = found.mesh, COARSENESS * extent if found.complete else np.inf
    corners, _ = ragged.fans(mesh.offsets)
    return mesh.vertices[mesh.corners[corners]], off


def nearby(triangles: Floats, off: float, box: Floats) -> Nearby:
    """What an item has in a box (2,3), by triangles (t,3,3) that are no farther off than a distance."""
    extent = float(norm(box[1] - box[0]))
    # Closer than the triangles are to the item no points need be, however small the box.
    longest = max(CLOSENESS * extent, off)
    # Corners, coordinates, triangles: sums along short axes take several times as long.
    done, left = [np.zeros((3, 0))], np.ascontiguousarray(np.moveaxis(triangles, 0, 2))
    low, high = box[0, :, None] - off - longest, box[1, :, None] + off + longest
    for _ in range(ROUNDS):
        inside = ((np.minimum.reduce(left) <= high) & (np.maximum.reduce(left) >= low)).all(axis=0)
        # take moves columns several times as fast as an index between brackets does.
        left = left.take(np.flatnonzero(inside), axis=2)
        way = np.roll(left, -1, axis=0) - left
        sides = np.sqrt(way[:, 0] ** 2 + way[:, 1] ** 2 + way[:, 2] ** 2)
        small = np.maximum.reduce(sides) <= longest
        done.append((left[0] + left[1] + left[2])[:, small] / 3.0)
        large = np.flatnonzero(~small)
        if not len(large):
            break
        one, two, three = sides.take(large, axis=1)
        first, second = (one >= two) & (one >= three), two >= three
        corners = left.take(large, axis=2)
        # By the longest side, the first one of several.
        a, b, c = (
            np.where(first, corners[k], np.where(second, corners[(k + 1) % 3], corners[(k + 2) % 3])) for k in range(3)
        )
        middle = (a + b) / 2.0
        left = np.concatenate((np.stack((a, middle, c)), np.stack((middle, b, c))), axis=2)
    else:
        off = np.inf
    return Nearby(box, np.ascontiguousarray(np.concatenate(done, axis=1).T), off + BETWEEN * longest)
