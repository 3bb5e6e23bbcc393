"""How far the colours of painted polygons are from those of the surfaces they show."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry import ragged
from vectorplot.painting.seen import Seen
from vectorplot.shading.light.painted_colours import Lighting, corner_shades_of, smooth_faces
from vectorplot.visibility.painter.image_faces import view_points

MOST = 4096
"""So many polygons are measured at most, evenly among all."""

STEPS = 255.0
"""Of a colour, from its darkest to its brightest shade."""


def shade_error_steps(seen: Seen, lighting: Lighting) -> float | None:
    """By how many of 255 steps the linear shading of polygons is off the light in the middles of their sides, at most;
    None where all polygons have one shade each."""
    faces = seen.faces
    smooth = np.flatnonzero(smooth_faces(seen.view, lighting.normals)[faces.source])
    smooth = smooth[:: 1 + len(smooth) // MOST]
    if not len(smooth):
        return None
    position, offsets = ragged.take(faces.offsets, smooth)
    points = faces.points[:, position]
    after = ragged.following(offsets)
    both = np.concatenate([points, 0.5 * (points + points[:, after])], axis=1)
    ends = np.concatenate([offsets, offsets[-1] + offsets[1:]])
    source = np.tile(faces.source[smooth], 2)
    shade = np.atleast_2d(corner_shades_of(seen.view, lighting, view_points(seen.view, both), ends, source).total)
    corner, middle = np.split(shade, 2, axis=-1)
    off = np.abs(middle - 0.5 * (corner + corner[..., after])).max(axis=0)
    return float(STEPS * off.max())
