"""Labels that are not to be missed, and of others those that there is room for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.drawing.lettering.text import typeset
from vectorplot.scene.naming.labels import BesidePoint, Label, OnCurve
from vectorplot.scene.placement import Placement

TICKS_APART_MM = 1.0
"""Ticks that are nearer to each other are left out."""

BETWEEN = 0.3
"""From the number at a tick to the next one, at least, in heights of capitals."""


def labels_with_room(seen: SeenLabels, some: Sequence[int], mm: float) -> list[int]:
    """Of some labels, without those that are dispensable and would stand in the room of one before them; mm: how long a
    millimetre is in units of the page."""
    rooms = {k: at for k in some if isinstance(at := seen.anchors.labels[k].at, BesidePoint)}
    corners = mm * np.array([(at.low_mm, at.high_mm) for at in rooms.values()]).reshape(-1, 2, 2)
    corners += seen.points[[*rooms]][:, None]
    without, taken = set[int](), np.zeros((0, 2, 2))
    for (k, at), corner in zip(rooms.items(), corners, strict=True):
        if at.is_dispensable and ((taken[:, 0] < corner[1]) & (taken[:, 1] > corner[0])).all(axis=1).any():
            without.add(k)
        else:
            taken = np.concatenate([taken, corner[None]])
    return [k for k in some if k not in without]


def ticks_with_room(seen: SeenLabels, placement: Placement, mm: float) -> SeenLabels:
    """The labels without numbers at ticks that would stand in those before them on the same curve, and without ticks
    that are hardly apart: of a curve that is seen end-on there are none. mm: as of labels_with_room."""
    curves: dict[str, list[tuple[float, int]]] = {}
    for number, label in enumerate(seen.anchors.labels):
        if isinstance(label.at, OnCurve) and label.mark == "tick":
            curves.setdefault(label.at.item, []).append((label.at.part, number))
    labels, kept = [*seen.anchors.labels], np.ones(len(seen.anchors), dtype=np.bool_)
    for ticks in curves.values():
        # Numbers keep half their length from the beginning, where those of other axes may be.
        tick = last = _beginning(seen, ticks[0][1], placement)
        share = 0.5
        for _, number in sorted(ticks):
            point, label = seen.points[number], labels[number]
            kept[number] = float(np.hypot(*(point - tick))) >= TICKS_APART_MM * mm
            if not kept[number]:
                continue
            tick = point
            if _is_clear(label, point - last, share, mm):
                last, share = point, 1.0
            else:
                labels[number] = replace(label, text="")
    anchors = replace(seen.anchors, labels=tuple(labels))
    return replace(seen, anchors=anchors).chosen(np.flatnonzero(kept))


def _is_clear(label: Label, way: Floats, share: float, mm: float) -> bool:
    """Whether a text that is moved by way (2,) is clear of a share of one of the same size where it was."""
    size = label.size_mm * mm
    room = np.ptp(typeset(label.text, size_mm=size).bounds, axis=0) + BETWEEN * size
    return bool((np.abs(way) >= share * room).any())


def _beginning(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(2,) on the page, where the curve of a label begins before the eye."""
    course, projection = seen.anchors.courses[number], placement.projection
    assert course is not None
    points = projection.points_of(course)
    ahead = projection.depth_of(points) > projection.near
    return np.asarray(placement.on_page(projection.image_of(points.compress(ahead, axis=1)[:, :1]))[0])
