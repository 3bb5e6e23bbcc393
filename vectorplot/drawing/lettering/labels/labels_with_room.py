"""Labels that are not to be missed, and of others those that there is room for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.scene.naming.labels import BesidePoint


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
