"""Shadows of several lights on the same faces: where they overlap it is darker.

On every face the borders of all shadows make one arrangement of cells, each of which lacks the same lights all over.
There are no more of them than the borders and their crossings ask for, however many lights there are.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals.decal_polygons import Decals
from vectorplot.effects.decals.face_frames import FaceFrames
from vectorplot.effects.shadows.shadow_shades import LEVELS
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import mapped
from vectorplot.geometry.convex.plane_cuts import Parts
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.regions import cells_of, corners_of, polygons_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View

POLYGONS_AT_ONCE = 1 << 15
"""About so many shadows are cut into cells at once; those of one face always are."""

MANY_CELLS = 100_000
"""From here on a warning tells what takes long."""

MOST_CELLS = 3_000_000
"""More are refused: a file with them would have about a gigabyte."""


@dataclass(frozen=True, eq=False)
class Shadows:
    """Polygons on faces: points (3,c) in the view, offsets (m+1,); face (m,) of the view; lacking (m,): the lights that
    do not get there, bit k for light k; whole (m,): it is the whole face. Those that one light casts are convex."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    face: Ints = field(metadata=EACH_LINE)
    lacking: Ints = field(metadata=EACH_LINE)
    whole: Bools = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.face)

    @classmethod
    def of_light(cls, parts: Parts, face: Ints, light: int) -> Shadows:
        """Parts of faces that one light does not reach."""
        return cls(parts.points, parts.offsets, face, np.full(len(face), 1 << light, dtype=np.intp), parts.whole)

    @property
    def grade(self) -> Ints:
        """(m,) how many lights each lacks."""
        return np.bitwise_count(self.lacking).astype(np.intp)

    def some(self, which: Ints) -> Shadows:
        """Some of them, in the order asked for."""
        return some(self, which)

    def without_needless(self) -> Shadows:
        """The same without those on faces that another shadow for want of the same lights covers whole."""
        order = np.lexsort((~self.whole, self.lacking, self.face))
        face, lacking = self.face[order], self.lacking[order]
        first = np.ones(len(order), dtype=np.bool_)
        first[1:] = (face[1:] != face[:-1]) | (lacking[1:] != lacking[:-1])
        leader = np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
        kept = first | ~self.whole[order][leader]
        return self if kept.all() else self.some(np.sort(order[kept]))


def joined_shadows(shadows: Sequence[Shadows]) -> Shadows:
    """All shadows one after the other."""
    none = np.zeros(0, dtype=np.intp)
    nothing = Shadows(np.zeros((3, 0)), ragged.offsets(none), none, none, none.astype(np.bool_))
    return joined((nothing, *shadows))


def graded(view: View, shadows: Shadows) -> Shadows:
    """The cells of the arrangement of shadows of single lights, face by face: simple polygons, each with all the lights
    that do not get there, to be painted in the order of their grades.

    A face that lights do not reach at all comes as a whole, for want of these; other cells overlap only where one of a
    higher grade fills a hole of a lower one. So at any point the polygon of the highest grade tells what lacks there.
    A shadow that is alone on its face keeps every digit; cells move by less than a few tolerances.
    Errors: InputError for more than MOST_CELLS cells; an InputWarning from MANY_CELLS on. There are as many of them as
    the arrangement has: with m shadows on a face that all cross each other about m squared.
    Degenerate: cells narrower than a few tolerances are left out.
    Source: Glaeser, section 6.3, figure 6 (shadows of higher grades).
    """
    whole = np.flatnonzero(shadows.whole)
    faces, number = np.unique(shadows.face, return_inverse=True)
    dark = np.zeros(len(faces), dtype=np.intp)
    np.bitwise_or.at(dark, number[whole], shadows.lacking[whole])
    first = np.unique(number[whole], return_index=True)[1]
    found = [_lacking(shadows.some(whole[first]), dark[number[whole[first]]])]
    part = np.flatnonzero(~shadows.whole)
    several = np.bincount(number[part], minlength=len(faces))[number[part]] > 1
    alone = part[~several]
    found.append(_lacking(shadows.some(alone), shadows.lacking[alone] | dark[number[alone]]))
    crowd = part[several]
    count = 0
    for cells in mapped(lambda lot: _arranged(view, shadows.some(crowd[lot])), _lots(number[crowd])):
        count += len(cells)
        if count > MOST_CELLS:
            raise InputError(f"shadows overlap in more than {MOST_CELLS} parts: fewer lights, or the verb render")
        found.append(_lacking(cells, cells.lacking | dark[np.searchsorted(faces, cells.face)]))
    if count > MANY_CELLS:
        warnings.warn(f"shadows overlap in {count} parts: large, and slow to paint", InputWarning, stacklevel=2)
    return joined_shadows(found)


def _lacking(shadows: Shadows, lacking: Ints) -> Shadows:
    """The same polygons for want of these lights."""
    return Shadows(shadows.points, shadows.offsets, shadows.face, lacking, shadows.whole)


def _lots(group: Ints) -> Iterator[Ints]:
    """Numbers of what has some group (n,), whole groups together, in lots of about POLYGONS_AT_ONCE."""
    order = np.argsort(group, kind="stable")
    ends = np.append(np.flatnonzero(np.diff(group[order])) + 1, len(order))
    begin = 0
    while begin < len(order):
        one, many = np.searchsorted(ends, [begin, begin + POLYGONS_AT_ONCE], side="right")
        end = int(ends[max(one, many - 1)])
        yield order[begin:end]
        begin = end


def _arranged(view: View, shadows: Shadows) -> Shadows:
    """The cells of shadows that are no whole faces, several on each of their faces."""
    frames = FaceFrames.of(view, shadows.face)
    owner = ragged.owner(np.diff(shadows.offsets))
    polygons = polygons_of(frames.flat(shadows.points, owner), shadows.offsets)
    faces, leader, number = np.unique(shadows.face, return_index=True, return_inverse=True)
    light, lacking = np.unique(shadows.lacking, return_inverse=True)
    key, of = np.unique(number * len(light) + lacking, return_inverse=True)
    on, light_of = np.divmod(key, len(light))
    one = (np.bincount(on) == 1)[on]
    region = np.empty(len(key), dtype=object)
    for which, grid in ((one, view.tolerance), (~one, None)):
        mine = np.flatnonzero(which[of])
        # The borders of several regions are brought to a grid when they meet.
        region[which] = unions(polygons[mine], np.searchsorted(np.flatnonzero(which), of[mine]), grid)
    cells, cell, missing = _cells(region, on, light[light_of], view.tolerance)
    cells, which = without_holes(cells, np.arange(len(cells)))
    flat, offsets = corners_of(cells)
    lead = leader[cell[which]]
    points = frames.lifted(flat, np.repeat(lead, np.diff(offsets)))
    return Shadows(points, offsets, faces[cell[which]], missing[which], np.zeros(len(which), dtype=np.bool_))


def _cells(region: Any, on: Ints, light: Ints, tolerance: float) -> tuple[Any, Ints, Ints]:
    """Regions on faces on (r,), ascending, that lack one light each, as cells: polygons (k,), their faces, and the
    lights that they lack; one region is its own cell."""
    one = (np.bincount(on) == 1)[on]
    parts, of = without_splinters(region[one], tolerance)
    several = np.flatnonzero(~one)
    if not len(several):
        return parts, on[one][of], light[one][of]
    faces, group = np.unique(on[several], return_inverse=True)
    cells, cell = cells_of(region[several], group, tolerance)
    missing = _missing(cells, cell, region[several], group, light[several])
    cells, cell, missing = _without_filled_holes(cells, cell, missing, tolerance)
    return (
        np.concatenate([parts, cells]),
        np.concatenate([on[one][of], faces[cell]]),
        np.concatenate([light[one][of], missing]),
    )


def _missing(cells: Any, cell: Ints, region: Any, on: Ints, light: Ints) -> Ints:
    """(k,) which lights cells on faces cell (k,) lack: those with a region on face on (r,) that covers them."""
    import shapely

    inner = shapely.get_coordinates(shapely.point_on_surface(cells))
    missing = np.zeros(len(cells), dtype=np.intp)
    shapely.prepare(region)
    for bit in np.unique(light).tolist():
        own = np.flatnonzero(light == bit)
        place = np.minimum(np.searchsorted(on[own], cell), len(own) - 1)
        here = np.flatnonzero(on[own][place] == cell)
        inside = shapely.contains_xy(region[own[place[here]]], *inner[here].T)
        missing[here[inside]] |= bit
    return missing


def _without_filled_holes(cells: Any, cell: Ints, missing: Ints, tolerance: float) -> tuple[Any, Ints, Ints]:
    """The cells that lack lights, on faces cell (k,), without those holes in which all lack more of them."""
    import shapely

    grade = np.bitwise_count(missing).astype(np.intp)
    pierced = np.flatnonzero((shapely.get_num_interior_rings(cells) > 0) & (missing > 0))
    if len(pierced):
        rings, owner = shapely.get_rings(cells[pierced], return_index=True)
        outer = np.concatenate([[True], owner[1:] != owner[:-1]])
        holes, owner = shapely.polygons(rings[~outer]), owner[~outer]
        least = _least_inside(holes, cell[pierced[owner]], shapely.point_on_surface(cells), cell, grade)
        open_still = least <= grade[pierced[owner]]
        filled = shapely.polygons(rings[outer])
        left = np.unique(owner[open_still])
        if len(left):
            cut = shapely.multipolygons(holes[open_still], indices=np.searchsorted(left, owner[open_still]))
            filled[left] = shapely.difference(filled[left], cut)
        cells[pierced] = filled
    kept = np.flatnonzero(missing)
    parts, of = without_splinters(cells[kept], tolerance)
    return parts, cell[kept[of]], missing[kept[of]]


def _least_inside(holes: Any, hole_face: Ints, inner: Any, cell: Ints, grade: Ints) -> Ints:
    """(h,) the smallest grade of the cells with inner points (k,) in holes (h,) of their face."""
    import shapely

    # Side by side on a line, so that one tree holds all faces.
    width = 2.0 * float(np.ptp(shapely.get_coordinates(holes), axis=0).max(initial=0.0)) + 16.0
    places = shapely.get_coordinates(inner)
    tree = shapely.STRtree(shapely.points(places[:, 0] + width * cell, places[:, 1]))
    xy, of = shapely.get_coordinates(holes, return_index=True)
    moved = shapely.set_coordinates(holes.copy(), np.stack([xy[:, 0] + width * hole_face[of], xy[:, 1]], axis=1))
    hole, found = tree.query(moved, predicate="intersects")
    least = np.full(len(holes), np.iinfo(np.intp).max)
    np.minimum.at(least, hole, grade[found])
    return least


def shadow_decals_of(shadows: Shadows, kind: FillKind) -> Decals:
    """Shadows as decals, higher grades above, with levels between them for the steps of soft borders."""
    grade = shadows.grade
    none = np.full(len(shadows), -1, dtype=np.intp)
    light = np.where(grade == 1, np.frexp(np.maximum(shadows.lacking, 1))[1].astype(np.intp) - 1, -1)
    return Decals(
        shadows.points,
        shadows.offsets,
        shadows.face,
        np.full(len(shadows), int(kind), dtype=np.intp),
        grade,
        light,
        none,
        LEVELS * grade,
        lacking=shadows.lacking,
    )
