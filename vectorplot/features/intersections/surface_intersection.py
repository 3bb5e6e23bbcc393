"""Where two parametrised surfaces meet, or the surfaces of many pairs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.intersections.contacts import contacts
from vectorplot.features.intersections.double_curves import DoubleCurves, no_double_curves
from vectorplot.features.intersections.joined_courses import Joined, doubts_about, each_joined, repeats_dropped
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.intersections.stacked_pairs import alike, parts
from vectorplot.features.intersections.surface_patches import SurfaceGrids, SurfacePatch
from vectorplot.features.intersections.triangle_pairs import overlapping_triangles, piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.tessellation import finer_grids
from vectorplot.geometry.repair.weld import close_points
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import ONE_POINT_OF_EXTENT

DEFAULT = Tracing()

GridPair = tuple[SurfaceGrids, SurfaceGrids]


def surface_intersection(one: Surface, two: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which two surfaces meet.

    Parameters
    ----------
    one, two : Surface
        The surfaces.
    tracing : Tracing
        columns and rows of the grids that both are polygonised by; tolerance (a thousandth of the smaller extent where
        None) and picture.

    Returns
    -------
    DoubleCurves
        Polylines, each point known by its parameters on both surfaces, and in space.

    Raises
    ------
    InputError
        For a grid that is too coarse.

    Notes
    -----
    Closed curves smaller than a cell are found by the place inside them where the tangent planes are parallel: to any
    size, but one of them for each pair of triangles. Where triangles cannot tell curves from one another the grids are
    refined (up to 2^17 cells); what is left then is a doubt. Degenerate: where surfaces touch in a point it is
    isolated, or a node if curves cross there; where they touch along a line its points are touching, with a doubt;
    where they coincide in an area there is a doubt and no curve. Curves end at the last whole cell before a hole.

    Source: Glaeser, section 8.4 (face-face sections); Patrikalakis and Maekawa, Shape interrogation, chapter 5.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball, pipe = surfaces.Sphere(1.0), surfaces.Cylinder(radius=0.6, bottom=-2, top=2)
    >>> curves = features.surface_intersection(ball, pipe, tracing=features.Tracing(columns=15, rows=15))
    >>> len(curves), bool(np.allclose(np.abs(curves.points[:, 2]), 0.8))
    (2, True)
    """
    (found,) = intersections_of_grids([(SurfaceGrids(one), SurfaceGrids(two))], tracing)
    return found


def intersections_of_grids(pairs: Sequence[GridPair], tracing: Tracing) -> list[DoubleCurves]:
    """The same of each pair of surfaces, each of these polygonised once; pairs of placed surfaces are asked as one."""
    result = [no_double_curves()] * len(pairs)
    left = list(range(len(pairs)))
    for columns, rows in finer_grids(tracing.columns, tracing.rows):
        unsure: list[int] = []
        for numbers in alike([(one.surface, two.surface) for one, two in (pairs[n] for n in left)]):
            those = [left[k] for k in numbers]
            patches = [(pairs[n][0].patch(columns, rows), pairs[n][1].patch(columns, rows)) for n in those]
            for part in parts(patches):
                for k, all_ in zip(part.numbers, _joined(part.one, part.two, tracing), strict=True):
                    result[those[k]] = double_curves(patches[k][0], all_)
                    if all_.unsure or all_.close:
                        unsure.append(those[k])
        left = sorted(unsure)
    return result


def _joined(one: Patch, two: Patch, tracing: Tracing) -> list[Joined]:
    found = piercings(one.tessellation, two.tessellation, overlapping_triangles(one, two))
    return each_joined(one, two, found, contacts(one, two), tracing, same=False)


def double_curves(one: SurfacePatch, all_: Joined) -> DoubleCurves:
    """The curves of two surfaces, the first of which is given, or of one with itself."""
    alone = _each_once(np.concatenate([all_.isolated.points, all_.dots]), one.size[0])
    kept, offsets, closed = repeats_dropped(all_)
    a, b = all_.points.one[kept, :2], all_.points.two[kept, :2]
    return DoubleCurves(
        one.points(a), a, b, offsets, closed, all_.nodes.points, alone, all_.touching.points, doubts_about(all_)
    )


def _each_once(points: Floats, size: float) -> Floats:
    """The points (k,3) without those that are the same but for rounding; Newton comes slowly to where patches shrink to
    a point."""
    return points[np.unique(close_points(points, ONE_POINT_OF_EXTENT * size), return_index=True)[1]]
