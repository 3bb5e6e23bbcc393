"""A box around a scene, with grids on its far sides and numbers along its outer edges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.families.line import Line
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.naming.annotations import thin_line
from vectorplot.scene.naming.labels import Label
from vectorplot.scene.naming.scales import BoxAxes
from vectorplot.scene.scene import Scene
from vectorplot.scene.terrains.level_lines import round_heights
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

FLAT = 0.05
"""What is flat has a box so thick to both sides, as a part of its longest side."""

TICKS = 5
"""About so many on every axis."""

NUMBERS_OFF, NAMES_OFF = 0.05, 0.14
"""Part of the mean side of the box by which numbers and names are beside its edges."""

CORNER = 0.06
"""The same for the lowest number upwards."""

SMALLER = 0.75
"""Numbers as a part of the names."""


def with_box(scene: Scene, camera: Camera) -> tuple[Scene, Floats]:
    """The scene with the box that it asks for: thin lines, hidden by the scene like any others, and labels; and the
    points (k,3) that a picture of it has to hold: the corners and the places of labels.

    Degenerate: a side along which the scene has no extent is as long as a tenth of the longest one.
    """
    box = scene.box
    if box is None or not len(scene.items):
        return replace(scene, box=None), np.zeros((0, 3))
    low, high = _sides(scene.bounds)
    towards = camera.direction if camera.parallel else np.asarray(camera.eye) - 0.5 * (low + high)
    near_high = towards >= 0.0
    far, near = np.where(near_high, low, high), np.where(near_high, high, low)
    ticks = [_ticks(a, b) for a, b in zip(low.tolist(), high.tolist(), strict=True)]
    labels = _labels(box, camera, (low, high), far, near, ticks)
    items = _grids(far, low, high, ticks)
    corners = np.where(np.array(list(np.ndindex(2, 2, 2)), dtype=np.bool_), high, low)
    reach = np.concatenate([corners, [label.at for label in labels if isinstance(label.at, tuple)]])
    return replace(scene, items=(*scene.items, *items), labels=(*scene.labels, *labels), box=None), reach


def _sides(bounds: Floats) -> tuple[Floats, Floats]:
    """The lowest and the highest corner of the box."""
    size = np.ptp(bounds, axis=0)
    longest = float(size.max()) or 1.0
    grown = np.where(size > ZERO_OF_EXTENT * longest, 0.0, FLAT * longest)
    return bounds[0] - grown, bounds[1] + grown


def _ticks(low: float, high: float) -> list[float]:
    """Round numbers from one end to the other, both included where they are round."""
    inner = [float(value) for value in round_heights(low, high, TICKS)]
    if len(inner) < 2:
        return inner
    step, slack = inner[1] - inner[0], ZERO_OF_EXTENT * (high - low)
    before, after = inner[0] - step, inner[-1] + step
    return [*([before] if before >= low - slack else []), *inner, *([after] if after <= high + slack else [])]


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
    box: BoxAxes, camera: Camera, sides: tuple[Floats, Floats], far: Floats, near: Floats, ticks: list[list[float]]
) -> list[Label]:
    """Numbers and names along the edges where a far side meets a near one: upright ones on the left."""
    low, high = sides
    near_above = near[2] == high[2]
    middle, unit = 0.5 * (low + high), float(np.mean(high - low))
    right = camera.axes[0]
    found = []
    for axis in range(3):
        one, two = (k for k in range(3) if k != axis)
        # On the floor: near in one direction, far in the upright one.
        choices = [(one, two)] if two == 2 else [(one, two), (two, one)]
        corners = []
        for ahead, behind in choices:
            corner = middle.copy()
            corner[ahead], corner[behind] = near[ahead], far[behind]
            out = np.zeros(3)
            out[ahead] = np.sign(near[ahead] - middle[ahead])
            corners.append((float(right @ corner), corner, out))
        _, corner, out = min(corners, key=lambda choice: choice[0])
        # Numbers of the upright axis end before those along the floor.
        least = low[2] + CORNER * unit if axis == 2 and near_above else -np.inf
        for value in ticks[axis]:
            if value < least:
                continue
            place = corner + NUMBERS_OFF * unit * out
            place[axis] = value
            found.append(_label(f"{value:.6g}", place, f"box {axis} {value:.6g}", SMALLER * box.size_mm))
        place = corner + NAMES_OFF * unit * out
        if box.names[axis]:
            found.append(_label(box.names[axis], place, f"box {axis}", box.size_mm))
    return found


def _label(text: str, at: Floats, name: str, size_mm: float) -> Label:
    x, y, z = at.tolist()
    return Label(text, (x, y, z), name, size_mm, "centre", "solid")
