"""Where a surface meets itself."""

from __future__ import annotations

import numpy as np

from vectorplot.features.intersections.contacts import contacts
from vectorplot.features.intersections.curve_ends import at_border
from vectorplot.features.intersections.double_curves import DoubleCurves, no_double_curves
from vectorplot.features.intersections.joined_courses import joined
from vectorplot.features.intersections.surface_intersection import double_curves
from vectorplot.features.intersections.surface_patches import SurfacePatch
from vectorplot.features.intersections.triangle_pairs import overlapping_within, piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.outline import concat
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import cross, norm
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()

LEAST_COSINE = 0.1
"""Triangles that all face one way within this cosine lie side by side in its plane, and the surface between them too.
"""

POINTS_A_CURVE = 64
"""There are so many times fewer double curves than points that the budget allows: a surface that all but covers itself
has thousands of them, a few chords each; beside an isolated double point there are some hundreds."""


def self_intersections(surface: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which a surface meets itself: its double curves.

    Parameters
    ----------
    surface : Surface
        Seams and poles are no double curves.
    tracing : Tracing
        As of `surface_intersection`.

    Returns
    -------
    DoubleCurves
        Polylines, each point known by its two places on the surface, and in space.

    Raises
    ------
    InputError
        For a grid that is too coarse.

    Notes
    -----
    Degenerate: of more curves than the budget allows there is none, with a doubt. A double curve ends exactly in a
    pinch point, or in a swallowtail; where the surface passes through a point in all directions (the axis of a spindle
    torus, the apex of a double cone) that point is isolated. Loops that are smaller than three cells are not found.

    Source: Glaeser, section 8.4 (self-intersections by face-face sections of the polygonised surface).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> loop = surfaces.surface_of_function(lambda u, v: (u**2, u**3 - u, v), surfaces.Domain(-1.5, 1.5, 0, 1))
    >>> curves = features.self_intersections(loop, tracing=features.Tracing(columns=20, rows=5))
    >>> len(curves), bool(np.allclose(curves.points[:, :2], (1.0, 0.0)))
    (1, True)
    """
    patch = SurfacePatch(surface, tracing.columns, tracing.rows)
    own = patch.tessellation
    if _stands_over_a_plane(patch):
        return no_double_curves()
    found = piercings(own, own, overlapping_within(patch))
    # Each curve stands there twice, with its two places exchanged.
    if len(concat(found.pairs)) > 2 * max(1, tracing.budget.points // POINTS_A_CURVE):
        return no_double_curves((unresolved("the surface meets itself in very many curves, none is drawn"),))
    touching = contacts(patch, patch, same=True)
    # Borders along which the surface goes on (a Moebius strip's ends) are no contacts.
    seam = at_border(patch, touching.one) & at_border(patch, touching.two)
    return double_curves(patch, joined(patch, patch, found, touching.of(~seam), tracing, same=True))


def _stands_over_a_plane(patch: SurfacePatch) -> bool:
    """Whether the triangles, of a rectangle without seams, poles and holes, all face one way, and their border, seen
    from there, does not cross itself: then no two of them are above each other.

    Source: Volino and Magnenat Thalmann, Efficient self-collision detection on smoothly discretized surface animations
    using geometrical shape regularity (1994).
    """
    import shapely

    own, columns, rows = patch.tessellation, patch.columns, patch.rows
    if len(own.triangles) < 2 * columns * rows or own.border.sum() < 2 * (columns + rows):
        return False
    a, b, c = (own.points[own.triangles[:, k]] for k in range(3))
    normals = cross(b - a, c - a)
    along = normals.sum(axis=0)
    if not (matmul(normals, along) > LEAST_COSINE * norm(normals) * norm(along)).all():
        return False
    at = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    ring = np.concatenate([at[:-1, 0], at[-1, :-1], at[:0:-1, -1], at[0, ::-1]])
    level = axis_frame(along)[:2]
    return bool(shapely.LineString(matmul(own.points[ring], level.T)).is_simple)
