"""Smooth surfaces in steps of shade, cut along the lines of equal shade between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.cuts.level_bands import level_bands
from vectorplot.painting.seen import Seen
from vectorplot.shading.light.painted_colours import Lighting, smooth_faces
from vectorplot.tolerances.of_values import SAME_SHADE
from vectorplot.visibility.painter.image_faces import ImageFaces

SPACE = 3
"""Coordinates of a point; shades come behind them."""


PLAIN_STEPS, FINEST_BORDERS = 64, 0.2
"""Of fewer shades than so many the borders are seen as lines: they are made finer in proportion, to such a part."""


def border_tolerance_mm(tolerance_mm: float, shades: int) -> float:
    """How far polygons may be off on the page so that borders between so many shades look smooth."""
    return tolerance_mm * min(max(shades / PLAIN_STEPS, FINEST_BORDERS), 1.0)


def stepped(seen: Seen, lighting: Lighting, shade: Floats) -> tuple[Seen, Floats, Ints]:
    """What is seen with polygons of smooth surfaces cut where the palette goes from one shade to the next, and the
    shades (n,) or (3,n) of the corners then: of each of these polygons one, that of its entry of the palette; and (m,)
    the polygon that each is a part of.

    shade: at the corners of the polygons as they are, linear between these. In coloured light red, green and blue have
    steps of their own. Polygons with one shade stay as they are.
    """
    size = lighting.smooth_size
    faces, shades = seen.faces, np.atleast_2d(shade)
    smooth = np.flatnonzero(smooth_faces(seen.view, lighting.normals)[faces.source])
    if size is None or not len(smooth):
        return seen, shade, np.arange(len(faces))
    position, offsets = ragged.take(faces.offsets, smooth)
    points, corners = _welded(faces.points[:, position].T, shades[:, position].T)
    levels, owner = (np.arange(size - 1) + 0.5) / size, smooth
    steps: list[Floats] = []
    for channel in range(len(shades)):
        fans, of = ragged.fans(offsets)
        fans = corners[fans]
        full = _full(points[fans])
        owner, steps = owner[of[full]], [step[of[full]] for step in steps]
        found = level_bands(points, points[:, SPACE + channel], fans[full], levels)
        source = found.source
        points, corners, offsets = found.points, found.corners, found.offsets
        owner, steps = owner[source], [*(step[source] for step in steps), found.band / size]
    kept = np.setdiff1d(np.arange(len(faces)), smooth)
    position, ends = ragged.take(faces.offsets, kept)
    number = np.concatenate([kept, owner])
    order = np.argsort(number, kind="stable")
    every = np.concatenate([faces.points[:, position], points[corners, :SPACE].T], axis=1)
    sizes = np.diff(offsets)
    flat = np.concatenate([shades[:, position], np.repeat(np.array(steps), sizes, axis=1)], axis=1)
    position, starts = ragged.take(np.concatenate([ends, ends[-1] + offsets[1:]]), order)
    parent = number[order]
    cut = ImageFaces(every[:, position], starts, faces.planes[:, parent], faces.source[parent], faces.rank[parent])
    result = flat[:, position]
    return replace(seen, faces=cut), result[0] if shade.ndim == 1 else result, parent


def _welded(points: Floats, shades: Floats) -> tuple[Floats, Ints]:
    """(k,3+s) the different points among (n,3) with their shades (n,s), equal but for rounding; and the number of each:
    so that neighbours are cut in the same points."""
    key = np.column_stack([points, np.rint(shades / SAME_SHADE)])
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return np.column_stack([points, shades])[first], number.reshape(-1)


def _full(corners: Floats) -> np.ndarray:
    """(t,) triangles (t,3,k) no two corners of which are in one place."""
    after = np.roll(corners, -1, axis=1)
    return np.asarray((corners[..., :SPACE] != after[..., :SPACE]).any(axis=2).all(axis=1), dtype=np.bool_)
