"""How far triangles may be from a surface, and how far its normals may turn on them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.edge_splitting import LOOKS, Edges
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.vectors import norm

Allowed = Callable[[Floats], Floats]
"""How far (...) triangles may be off a surface at points (..., 3)."""

TURN = np.radians(8.5)
"""By so much the normals at the ends of a side may differ, or flat shades would come out jagged."""

JUMP = np.radians(45.0)
"""Normals that differ by more at neighbouring looks jump, as on creases: finer sides would not help."""

INSIDE = 0.75
"""In the middle of a triangle the surface may be farther off than over its sides, by a third."""


class AllSidesAlike(ABC):
    """What a Demand has that treats all sides of triangles alike, outlines and borders among them."""

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """None."""
        return np.zeros((0, len(points)))

    @property
    def outlines(self) -> int:
        """None."""
        return 0

    @abstractmethod
    def excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand."""

    def too_coarse(self, edges: Edges) -> Floats:
        """(k,n) as Demand."""
        return self.excess(edges)

    def border_excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand: borders are as all sides."""
        return np.zeros(edges.t.shape)


@dataclass(frozen=True)
class Within(AllSidesAlike):
    """Triangles that are no farther from the surface than is allowed, and on which normals turn by no more than TURN,
    or nearly so: along rulings they turn though sides lie on the surface."""

    allowed: Allowed

    @property
    def alike(self) -> Hashable:
        """Equal where the same is allowed at the same points."""
        return self.allowed

    @classmethod
    def joined(cls, asked: Sequence[Within]) -> Within:
        """What is asked for is the same for all of these."""
        return asked[0]

    def excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand: the larger one of the distances and the turning of the normals, as parts of their limits."""
        far = off_chords(edges) / (INSIDE * self.allowed(edges.at.points))
        return np.asarray(np.maximum(far, turning(edges) / TURN))


def off_chords(edges: Edges) -> Floats:
    """(k,n) how far the surface is from the sides themselves, at the vertices over them."""
    chord = edges.end.points - edges.start.points
    length = norm(chord)[..., None]
    way = np.divide(chord, length, out=np.zeros_like(chord), where=length > 0.0)
    arm = edges.at.points - edges.start.points
    along = np.clip(component_sum(arm * way)[..., None], 0.0, length)
    return np.asarray(norm(arm - along * way))


def turning(edges: Edges) -> Floats:
    """(n,) by how much normals turn from end to end, as far as they do so smoothly."""
    nodes = np.stack((edges.start.normals, *edges.at.normals[: len(LOOKS)], edges.end.normals))
    steps = arccos(np.clip(component_sum(nodes[1:] * nodes[:-1]), -1.0, 1.0))
    smooth = np.isfinite(steps) & (steps < JUMP)
    return np.asarray(np.where(smooth, steps, 0.0).sum(axis=0))
