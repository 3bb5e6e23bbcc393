"""Shaded triangles for formats that shade along one direction only.

A triangle the colours of which change along one direction, as shades of one palette do, is exact. One that mixes three
colours is cut into strips along the direction of its greatest change, so narrow that what changes across them cannot be
seen.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.backends.page.areas import Areas, Polygons, rounded
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse, singular_decomposition
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some
from vectorplot.tolerances.of_lengths import NARROW_OF_LENGTH

SHADE_ERROR = 2.0
"""By how many steps of 255 a shaded piece that is painted in one colour may differ from what it should be."""

SMALLEST_MICRONS, NARROWEST_MICRONS = 250.0, 60.0
"""Triangles that are no longer, or no wider, than this are painted in one colour: less than a pixel of a screen."""


DARKEST, LIGHTEST = 0.0, 255.0
"""What there is of each of the three colours."""


@dataclass(frozen=True, eq=False)
class Strips:
    """Polygons with linear gradients: microns (p,2) int64, offsets (s+1,); triangle (s,) that each is a part of,
    ascending; ends (s,2,2) in microns from where to where the gradient runs; colours (s,2,3) there.

    Ends may lie beside the triangle, where colours go on beyond 0 and 255; what is shown there are these.
    """

    microns: Ints = field(metadata=EACH_POINT)
    offsets: Ints
    triangle: Ints = field(metadata=EACH_LINE)
    ends: Floats = field(metadata=EACH_LINE)
    colours: Floats = field(metadata=EACH_LINE)


def joined_strips(one: Strips, other: Strips) -> Strips:
    """The strips of both by their triangles."""
    both = joined((one, other))
    return some(both, np.argsort(both.triangle, kind="stable"))


def stops_of(colours: Floats) -> tuple[Floats, Ints, Ints]:
    """Where linear gradients (s,2,3) bend that show what colours there are: parts (k,) of the way, 0 and 1 among them,
    the colours (k,3) there, and the gradient (k,) of each, ascending."""
    start, way = colours[:, 0], colours[:, 1] - colours[:, 0]
    limit = np.array([DARKEST, LIGHTEST])[:, None]
    # What rounding leads back needs no stop.
    shown = np.rint(colours)
    beyond = np.stack([shown.min(axis=1) < DARKEST, shown.max(axis=1) > LIGHTEST], axis=1) & (way != 0.0)[:, None]
    part = (limit - start[:, None]) / np.where(beyond, way[:, None], 1.0)
    inner, *_ = within = np.nonzero(beyond & (part > 0.0) & (part < 1.0))
    ends = np.arange(len(colours))
    gradient = np.concatenate([ends, inner, ends])
    part = np.concatenate([np.zeros(len(ends)), part[within], np.ones(len(ends))])
    order = np.lexsort((part, gradient))
    gradient, part = gradient[order], part[order]
    found = np.clip(start[gradient] + part[:, None] * way[gradient], DARKEST, LIGHTEST)
    return part, np.rint(found).astype(np.intp), gradient


def nearly_flat(areas: Areas) -> Areas:
    """The same, but triangles that are very small or narrow, or the colours of which span no more than twice
    SHADE_ERROR, have the middle one."""
    which = np.flatnonzero(areas.shaded)
    corner = areas.offsets[which, None] + np.arange(3)
    of_corners = areas.colours[corner].astype(np.intp)
    low, high = of_corners.min(axis=1), of_corners.max(axis=1)
    sides = (areas.microns[corner] - areas.microns[np.roll(corner, 1, axis=1)]).astype(np.float64)
    near = ((high - low) <= 2.0 * SHADE_ERROR).all(axis=1)
    longest = np.hypot(sides[..., 0], sides[..., 1]).max(axis=1)
    width = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / longest
    near |= (longest <= SMALLEST_MICRONS) | (width <= NARROWEST_MICRONS)
    colours = areas.colours.copy()
    colours[corner[near]] = ((low + high) // 2)[near, None].astype(np.uint8)
    return replace(areas, colours=colours)


def strips_of(corners: Floats, colours: Floats) -> Strips:
    """Triangles with corners (t,3,2) in microns, shaded linearly from colours (t,3,3) there, as strips. No colour is
    off by more than SHADE_ERROR, and what rounding adds.

    The linear map from places to colours is, by its singular values, a change along one direction and a smaller one
    across it. A strip has the colours of its middle line.
    """
    slopes = _slopes(corners, colours)
    directions, sizes, _ = singular_decomposition(slopes)
    # On the page, where y runs downwards, the second direction is a quarter turn from the first, as clipping wants it.
    directions[:, :, 1] = np.stack([directions[:, 1, 0], -directions[:, 0, 0]], axis=1)
    local = matmul(corners - corners[:, :1], directions)
    low, high = local.min(axis=1), local.max(axis=1)
    number = np.ceil((high[:, 1] - low[:, 1]) * sizes[:, 1] / (2.0 * SHADE_ERROR))
    number = np.maximum(number, 1.0).astype(np.intp)
    owner = ragged.owner(number)
    step = ragged.place(number)
    width = ((high - low)[:, 1] / number)[owner]
    middle = low[owner, 1] + (step + 0.5) * width
    # Strips at the ends are wider, so that rounding cannot cut anything off.
    before, behind = np.where(step == 0, 1.0, 0.5) * width, np.where(step == number[owner] - 1, 1.0, 0.5) * width
    reach = (high - low).max(axis=1)[owner]
    slabs = _rectangles(low[owner, 0] - reach, high[owner, 0] + reach, middle - before, middle + behind)
    quads = corners[owner, :1] + matmul(slabs, directions[owner].transpose(0, 2, 1))
    microns, offsets, strip = _cut(corners[owner], quads)
    owner, middle = owner[strip], middle[strip]
    size = np.diff(offsets)
    from_first = microns - np.repeat(corners[owner, 0], size, axis=0)
    along = np.einsum("pi,pi->p", from_first, np.repeat(directions[owner, :, 0], size, axis=0))
    ways = np.stack([np.stack((end, middle), axis=-1) for end in _extremes(along, offsets)], axis=1)
    ways = matmul(ways, directions[owner].transpose(0, 2, 1))
    return Strips(microns, offsets, owner, corners[owner, :1] + ways, colours[owner, :1] + matmul(ways, slopes[owner]))


def _slopes(corners: Floats, colours: Floats) -> Floats:
    """(t,2,3): a way on the page times it is the change of colour. Across triangles too thin for that there is none."""
    sides, changes = corners[:, 1:] - corners[:, :1], colours[:, 1:] - colours[:, :1]
    return np.asarray(matmul(pseudo_inverse(sides, rcond=NARROW_OF_LENGTH), changes))


def _cut(triangles: Floats, quads: Floats) -> tuple[Ints, Ints, Ints]:
    """Triangles (s,3,2) clipped by quadrilaterals (s,4,2): corners, offsets, and which ones are left."""
    points, offsets, which = clipped_by_convex(
        triangles.reshape(-1, 2).T,
        np.arange(0, 3 * len(triangles) + 1, 3),
        quads.reshape(-1, 2).T,
        np.arange(0, 4 * len(quads) + 1, 4),
    )
    blank = np.zeros((points.shape[1], 3), dtype=np.uint8)
    microns, offsets, _, kept = rounded(Polygons(points.T / 1000.0, offsets, blank, which))
    return microns, offsets, which[kept]


def _rectangles(left: Floats, right: Floats, low: Floats, high: Floats) -> Floats:
    """(s,4,2) the corners of rectangles."""
    return np.stack(
        [np.stack(corner, axis=-1) for corner in ((left, low), (right, low), (right, high), (left, high))], 1
    )


def _extremes(values: Floats, offsets: Ints) -> tuple[Floats, Floats]:
    """Smallest and largest of the values of each polygon."""
    if len(offsets) == 1:
        return np.zeros(0), np.zeros(0)
    return np.minimum.reduceat(values, offsets[:-1]), np.maximum.reduceat(values, offsets[:-1])
