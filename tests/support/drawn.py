"""What can be measured on a finished drawing, for tests that look at nothing else."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.testing.drawings import path_segments
from vectorplot.words import LineKind

EVERY_EDGE = ("contour", "boundary", "crease", "edges", "intersection")


@dataclass(frozen=True)
class Drawn:
    """Straight pieces of strokes: page (n,2,2) their ends in mm, world (n,2,3) in space; kind, item, hidden_by (n,)."""

    page: np.ndarray
    world: np.ndarray
    kind: np.ndarray
    item: np.ndarray
    hidden_by: np.ndarray

    def __len__(self) -> int:
        return len(self.kind)

    def where(self, which: np.ndarray) -> Drawn:
        return Drawn(self.page[which], self.world[which], self.kind[which], self.item[which], self.hidden_by[which])

    @property
    def visible(self) -> Drawn:
        return self.where(self.hidden_by == 0)

    @property
    def hidden(self) -> Drawn:
        return self.where(self.hidden_by > 0)

    def of(self, item: int) -> Drawn:
        return self.where(self.item == item)

    def of_kind(self, *words: str) -> Drawn:
        return self.where(np.isin(self.kind, [LineKind.from_word(word) for word in words]))

    @property
    def length(self) -> float:
        """In world units."""
        return float(np.linalg.norm(self.world[:, 1] - self.world[:, 0], axis=1).sum())

    @property
    def length_mm(self) -> float:
        return float(np.linalg.norm(self.page[:, 1] - self.page[:, 0], axis=1).sum())


def drawn(drawing: Drawing) -> Drawn:
    """All strokes of a drawing, which must be finite, as straight pieces."""
    pieces = [Drawn(np.zeros((0, 2, 2)), np.zeros((0, 2, 3)), *(np.zeros(0, dtype=np.intp) for _ in range(3)))]
    for layer in drawing.layers:
        for marks in layer.strokes:
            assert np.isfinite(marks.points).all() and np.isfinite(marks.points3d).all()
            start, end, path = path_segments(marks.offsets, marks.closed)
            page = np.stack([marks.points[start], marks.points[end]], axis=1)
            world = np.stack([marks.points3d[start], marks.points3d[end]], axis=1)
            pieces.append(Drawn(page, world, marks.kind[path], marks.item[path], marks.hidden_by[path]))
    columns = zip(*((p.page, p.world, p.kind, p.item, p.hidden_by) for p in pieces), strict=True)
    return Drawn(*(np.concatenate(column) for column in columns))


def stroke_count(drawing: Drawing) -> int:
    return sum(len(marks) for layer in drawing.layers for marks in layer.strokes)


def on_page(drawing: Drawing, world: np.ndarray) -> np.ndarray:
    """(n,2) where points (n,3) of the world are on the page."""
    place = np.c_[np.reshape(world, (-1, 3)), np.ones(len(np.reshape(world, (-1, 3))))] @ drawing.page_from_world.T
    return place[:, :2] / place[:, 3:]


def plate(low: tuple[float, float], high: tuple[float, float], z: float) -> Mesh:
    """A rectangle at a height, its outside up."""
    (a, b), (c, d) = low, high
    return Mesh.from_polygons([(a, b, z), (c, b, z), (c, d, z), (a, d, z)], [[0, 1, 2, 3]])


def moved(scene: Scene, matrix: np.ndarray) -> Scene:
    """The scene under a 4x4 matrix."""
    return Scene(tuple(Item(item.name, item.shape.transformed(matrix)) for item in scene.items))
