"""A box around a scene, with grids on its far sides and numbers along its outer edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.families.line import Line
from vectorplot.drawing.lettering.text import typeset
from vectorplot.effects.scales.axis_numbers import AxisNumbers, axis_numbers, single_number
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.unit_projection import Projection, projection_of
from vectorplot.scene.item import Item
from vectorplot.scene.naming.annotations import thin_line
from vectorplot.scene.naming.labels import BesidePoint, Label
from vectorplot.scene.naming.scales import BoxAxes
from vectorplot.scene.scene import Scene
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

FLAT = 0.05
"""What is flat has a box so thick to both sides, as a part of its longest side."""

THIN = 0.01
"""A side that is a smaller part of the longest one has a single number: more would stand in one place."""

GAP_MM, NAME_GAP_MM = 1.2, 1.4
"""From the edges of the box to the numbers beside them, and from these to the names: lines end 0.6 mm before letters,
and edges do not."""

SMALLER = 0.75
"""Numbers as a part of the names."""

SLANTED = 0.5
"""Numbers stand in line with the grid beside an edge, unless the cosine of its angle to what is upright to the edge is
smaller."""

SHORT = 0.02
"""Edges of which the image is a smaller part of that of the longest one are seen end-on: they are not numbered."""


def with_box(scene: Scene, camera: Camera) -> tuple[Scene, Floats]:
    """The scene with the box that it asks for: thin lines, hidden by the scene like any others, and labels; and the
    points (k,3) that a picture of it has to hold besides these: the corners.

    Degenerate: a side along which the scene has no extent is as long as a tenth of the longest one.
    """
    box = scene.box
    if box is None or not len(scene.items):
        return replace(scene, box=None), np.zeros((0, 3))
    bounds = scene.bounds
    low, high = _sides(bounds)
    towards = camera.direction if camera.parallel else np.asarray(camera.eye) - 0.5 * (low + high)
    # Square to a side the lower and the left edge are numbered.
    near_high = np.append(towards[:2] > 0.0, towards[2] >= 0.0)
    far, near = np.where(near_high, low, high), np.where(near_high, high, low)
    thin = THIN * float((high - low).max())
    numbers = [
        _numbers(a / times, b / times, thin / times).drawn(times)
        for (a, b), times in zip(bounds.T.tolist(), (1.0, 1.0, scene.exaggeration), strict=True)
    ]
    labels = _labels(box, projection_of(camera, np.stack([low, high])), (low, high), far, near, numbers)
    items = _grids(far, low, high, [list(one.values) for one in numbers])
    corners = np.where(np.array(list(np.ndindex(2, 2, 2)), dtype=np.bool_), high, low)
    return replace(scene, items=(*scene.items, *items), labels=(*scene.labels, *labels), box=None), corners


def _sides(bounds: Floats) -> tuple[Floats, Floats]:
    """The lowest and the highest corner of the box."""
    size = np.ptp(bounds, axis=0)
    longest = float(size.max()) or 1.0
    grown = np.where(size > ZERO_OF_EXTENT * longest, 0.0, FLAT * longest)
    return bounds[0] - grown, bounds[1] + grown


def _numbers(low: float, high: float, thin: float) -> AxisNumbers:
    return axis_numbers(low, high) if high - low > thin else single_number(low, high)


def _grids(far: Floats, low: Floats, high: Floats, ticks: list[list[float]]) -> list[Item]:
    """The lines on the three far sides; the edges between two of them once."""
    ends: list[tuple[Floats, Floats]] = []
    for side in range(3):
        for across in range(3):
            if across == side:
                continue
            along = 3 - side - across
            ends_of_side = float(low[across]), float(high[across])
            slack = ZERO_OF_EXTENT * (ends_of_side[1] - ends_of_side[0])
            inner = [at for at in ticks[across] if ends_of_side[0] + slack < at < ends_of_side[1] - slack]
            for at in [*inner, *ends_of_side]:
                if at == far[across] and across < side:
                    continue
                start, end = far.copy(), far.copy()
                start[across] = end[across] = at
                start[along], end[along] = low[along], high[along]
                ends.append((start, end))
    return [thin_line(f"box {k + 1}", Line.through(a, b), "box") for k, (a, b) in enumerate(ends)]


def _labels(
    box: BoxAxes,
    projection: Projection,
    sides: tuple[Floats, Floats],
    far: Floats,
    near: Floats,
    numbers: Sequence[AxisNumbers],
) -> list[Label]:
    """Names and numbers along the edges where a far side meets a near one: upright ones on the left.

    Names come first, then numbers that are alone on their axis: where there is no room for all, later ones are left
    out.
    """
    middle = 0.5 * (sides[0] + sides[1])
    names, alone, found = list[Label](), list[Label](), list[Label]()
    edges = [_edge(axis, projection, sides, far, near) for axis in range(3)]
    longest = max(edge.length for edge in edges)
    for axis, (edge, along) in enumerate(zip(edges, numbers, strict=True)):
        if not edge.length > SHORT * longest:
            continue
        deep, size = 0.0, SMALLER * box.size_mm
        for value, text in zip(along.values, along.texts, strict=True):
            place = edge.corner.copy()
            place[axis] = value
            away = edge.away(projection, place)
            room, reach = _beside(text, place, size, edge.upright, away, GAP_MM)
            (found if len(along.values) > 1 else alone).append(
                Label(text, room, f"box {axis} {text}", size, "centre", "solid")
            )
            deep = max(deep, reach)
        text = "\n".join(filter(None, (box.names[axis], along.common)))
        if text:
            place = edge.corner.copy()
            place[axis] = middle[axis]
            off = deep + NAME_GAP_MM
            room, _ = _beside(text, place, box.size_mm, edge.upright, edge.upright, off)
            room = replace(room, is_dispensable=False)
            names.append(Label(text, room, f"box {axis}", box.size_mm, "centre", "solid"))
    return [*names, *alone, *found]


@dataclass(frozen=True, eq=False)
class _Edge:
    """An edge that is numbered: a point of it but for the coordinate along it, the direction (3,) of the grid beside it
    out of the box; and on the page the unit normal (2,) that points out, and its length."""

    corner: Floats
    out: Floats
    upright: Floats
    length: float

    def away(self, projection: Projection, place: Floats) -> Floats:
        """(2,) the unit direction on the page in which a number is beside a place of the edge: on with the grid."""
        ends = _image(projection, np.stack([place - self.out, place]))
        way = ends[1] - ends[0]
        long = float(np.hypot(*way))
        return way / long if matmul(way, self.upright) > SLANTED * long else self.upright


def _edge(axis: int, projection: Projection, sides: tuple[Floats, Floats], far: Floats, near: Floats) -> _Edge:
    """The edge along which an axis is numbered: on the floor or the ceiling, and for the upright axis the left one."""
    low, high = sides
    middle = 0.5 * (low + high)
    one, two = (k for k in range(3) if k != axis)
    choices = []
    for ahead, behind in [(one, two)] if two == 2 else [(one, two), (two, one)]:
        corner, out = middle.copy(), np.zeros(3)
        corner[ahead], corner[behind] = near[ahead], far[behind]
        out[ahead] = near[ahead] - middle[ahead]
        choices.append((float(_image(projection, corner[None])[0, 0]), corner, out))
    _, corner, out = min(choices, key=lambda choice: choice[0])
    ends = np.stack([corner, corner])
    ends[:, axis] = low[axis], high[axis]
    start, end = _image(projection, ends)
    (across, up), long = end - start, float(np.hypot(*(end - start)))
    upright = np.array([-up, across]) / long if long > 0.0 else np.array([0.0, 1.0])
    inward = float(matmul(upright, _image(projection, middle[None])[0] - start))
    return _Edge(corner, out, -upright if inward > 0.0 else upright, long)


def _image(projection: Projection, world: Floats) -> Floats:
    """(n,2) the images of points of the world (n,3)."""
    return projection.image_of(projection.points_of(world)).T


def _beside(
    text: str, at: Floats, size_mm: float, upright: Floats, away: Floats, gap: float
) -> tuple[BesidePoint, float]:
    """The room of a text in a direction away from a point of an edge, a gap off the edge; and how far from the edge
    that ends. upright (2,): unit normal of the edge."""
    half = 0.5 * np.ptp(typeset(text, size_mm=size_mm).bounds, axis=0)
    deep = float(matmul(np.abs(upright), half))
    middle = (gap + deep) / float(matmul(away, upright)) * away
    (left, bottom), (right, top) = (middle - half).tolist(), (middle + half).tolist()
    x, y, z = at.tolist()
    return BesidePoint((x, y, z), (left, bottom), (right, top)), gap + 2.0 * deep
