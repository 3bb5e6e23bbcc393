"""Curves on implicit surfaces: contours and their cusps, isophotes, sections, borders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.features.implicit.implicit_conditions import (
    ImplicitCentralContour,
    ImplicitIsophote,
    ImplicitParallelContour,
    ImplicitPointIsophote,
    MeetsImplicit,
    MeetsPlane,
    SpatialCondition,
    sight_line_bending,
)
from vectorplot.features.implicit.implicit_refinement import curve_in_space, refined_chords
from vectorplot.features.implicit.implicit_tracing import (
    ImplicitCurves,
    ImplicitTracing,
    all_curves,
    box_sides,
    curves_in_space,
    curves_of_lines,
    mesh_of,
    no_curves,
)
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.geometry.vectors import normalize
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT
from vectorplot.tolerances.of_values import FLAT_OF_VALUES, ZERO_OF_BENDING

DEFAULT = ImplicitTracing()


def implicit_contour(surface: ImplicitSurface, eye: ArrayLike, *, tracing: ImplicitTracing = DEFAULT) -> ImplicitCurves:
    """The points x of an implicit surface with N.(x - eye) = 0, N the unit gradient of F.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    eye : (3,) array_like of float
        In world coordinates.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        Polylines on the surface. Seen from where F > 0 the side that is turned away from the eye is on the left.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers, what `polygonized` refuses, and a resolution or tolerance that is
        not positive.

    Notes
    -----
    What lies behind the eye is traced too. Degenerate: a flat surface whose plane contains the eye has no contour, and
    a doubt says so. Contours run into singular points of the surface (the apex of a cone).

    Source: Glaeser, section 8.4, equations 25 to 27.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> curves = features.implicit_contour(surfaces.implicit_sphere(1.0), (4, 0, 0), tracing=tracing)
    >>> curves.closed.tolist(), bool(np.allclose(curves.points[:, 0], 0.25))  # a circle in front of the centre
    ([True], True)
    """
    place = vector("contour: eye", eye)
    condition = ImplicitCentralContour(surface, place)
    return curves_in_space(surface, condition, size=_farthest(surface, place), tracing=tracing)


def implicit_parallel_contour(
    surface: ImplicitSurface, direction: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The points of an implicit surface with N.d = 0, N the unit gradient of F: seen along d it turns away there.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    direction : (3,) array_like of float
        d, of any length, towards the eye.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        Polylines on the surface. Seen from where F > 0 the side with N.d > 0 is on the left.

    Raises
    ------
    InputError
        For a direction without length, what `polygonized` refuses, and a resolution or tolerance that is not positive.

    Notes
    -----
    Degenerate: as for `implicit_contour`.

    Source: Glaeser, section 8.4, equation 27 for an eye at infinity.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> curves = features.implicit_parallel_contour(surfaces.implicit_sphere(1.0), (0, 0, 1), tracing=tracing)
    >>> curves.closed.tolist(), bool(np.allclose(curves.points[:, 2], 0.0))
    ([True], True)
    """
    return curves_in_space(surface, ImplicitParallelContour(surface, direction), size=1.0, tracing=tracing)


def implicit_contour_in_view(
    surface: ImplicitSurface, camera: Camera, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The contour of an implicit surface as a camera sees it, by central or parallel projection."""
    if camera.parallel:
        return implicit_parallel_contour(surface, camera.direction, tracing=tracing)
    return implicit_contour(surface, camera.eye, tracing=tracing)


def implicit_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in parallel light, N the unit gradient of F, l the light.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    light : (3,) array_like of float
        l, of any length, towards the light.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        Polylines with c as level; seen from where F > 0 the brighter side is on the left.

    Raises
    ------
    InputError
        For a light without length, cosines not within -1 and 1, what `polygonized` refuses, and a resolution or
        tolerance that is not positive.

    Notes
    -----
    Degenerate: a flat part at just that angle gives no lines, and a doubt; c = 1 gives isolated points.

    Source: Glaeser, section 8.4, equation 28.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> curves = features.implicit_isophotes(surfaces.implicit_sphere(1.0), (0, 0, 1), [0.0, 0.5], tracing=tracing)
    >>> curves.levels.tolist(), bool(np.allclose(curves[1][:, 2], 0.5))
    ([0.0, 0.5], True)
    """
    return _family(surface, lambda c: (ImplicitIsophote(surface, light, c), 1.0), _cosines(cosines), tracing)


def implicit_point_light_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in the light of a point, l from the surface to the light.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    light : (3,) array_like of float
        Where the light stands, in world coordinates.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        As of `implicit_isophotes`.

    Raises
    ------
    InputError
        For a light that is not three finite numbers, cosines not within -1 and 1, what `polygonized` refuses, and a
        resolution or tolerance that is not positive.

    Notes
    -----
    Degenerate: as for `implicit_isophotes`.

    Source: Glaeser, section 8.4, equation 28.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> curves = features.implicit_point_light_isophotes(ball, (0, 0, 4), 0.5, tracing=tracing)
    >>> curves.closed.tolist(), curves.levels.tolist()
    ([True], [0.5])
    """
    return _family(surface, lambda c: (ImplicitPointIsophote(surface, light, c), 1.0), _cosines(cosines), tracing)


def implicit_intersection(
    surface: ImplicitSurface, other: ImplicitSurface, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves in which two implicit surfaces meet, within the box of the first.

    Parameters
    ----------
    surface : ImplicitSurface
        On which they are traced.
    other : ImplicitSurface
        Its F is taken wherever the first surface is, inside its box and outside.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        F of the other is positive on the left, seen from where F of the first is.

    Raises
    ------
    InputError
        For what `polygonized` refuses, and a resolution or tolerance that is not positive.

    Notes
    -----
    Degenerate: surfaces that touch in a point give an isolated one; that coincide in an area, a doubt.

    Source: Glaeser, section 8.4, equation 29.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> one, two = surfaces.implicit_sphere(1.0), surfaces.implicit_sphere(1.0, centre=(1, 0, 0))
    >>> curves = features.implicit_intersection(one, two, tracing=features.ImplicitTracing(cells=12))
    >>> len(curves), bool(np.allclose(curves.points[:, 0], 0.5))
    (1, True)
    """
    own, _ = mesh_of(surface, tracing)
    mesh, tracing = own.mesh, replace(tracing, mesh=own)
    if not mesh.face_count:
        return no_curves()
    long = np.linalg.norm(other.gradients(mesh.vertices), axis=1)
    slope = float(np.quantile(long[np.isfinite(long)], 0.95)) if np.isfinite(long).any() else 0.0
    size = slope * float(np.ptp(np.asarray(surface.box), axis=0).max())
    return curves_in_space(surface, MeetsImplicit(other), size=size or 1.0, tracing=tracing)


def implicit_plane_sections(
    surface: ImplicitSurface, normal: ArrayLike, offsets: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The sections of an implicit surface with the parallel planes n.x = d, n the unit normal.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    normal : (3,) array_like of float
        Of any length.
    offsets : (k,) array_like of float
        d, in world units; or one of them.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        Polylines with d as level; seen from where F > 0, the side the normal points to is on the left.

    Raises
    ------
    InputError
        For a normal without length, offsets that are not finite, what `polygonized` refuses, and a resolution or
        tolerance that is not positive.

    Notes
    -----
    Degenerate: as for `implicit_intersection`.

    Source: Glaeser, section 8.4, equation 29.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> curves = features.implicit_plane_sections(ball, (1, 0, 0), [-0.5, 0.5], tracing=tracing)
    >>> curves.levels.tolist(), bool(np.allclose(curves[0][:, 0], -0.5))
    ([-0.5, 0.5], True)
    """
    levels = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise InputError("plane sections: offsets must be finite numbers")
    n = normalize(vector("plane sections: normal", normal))
    size = float(np.ptp(np.asarray(surface.box), axis=0).max())
    return _family(surface, lambda d: (MeetsPlane(n, d), size), levels, tracing)


def implicit_level_lines(
    surface: ImplicitSurface, heights: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves of an implicit surface at given heights: `implicit_plane_sections` with z up.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    heights : (k,) array_like of float
        In world units; or one of them.
    tracing : ImplicitTracing
        How finely they are looked for and followed.

    Returns
    -------
    ImplicitCurves
        Polylines with the height as level.

    Raises
    ------
    InputError
        For heights that are not finite, what `polygonized` refuses, and a resolution or tolerance that is not positive.

    Notes
    -----
    Degenerate: as for `implicit_intersection`.

    Source: as of `implicit_plane_sections`.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> curves = features.implicit_level_lines(surfaces.implicit_sphere(1.0), [0.0, 0.5, 2.0], tracing=tracing)
    >>> curves.levels.tolist()
    [0.0, 0.5]
    """
    return implicit_plane_sections(surface, (0.0, 0.0, 1.0), heights, tracing=tracing)


def implicit_borders(surface: ImplicitSurface, *, tracing: ImplicitTracing = DEFAULT) -> ImplicitCurves:
    """Where an implicit surface ends: its curves on the sides of its box, cut at the edges of the box, and the rims of
    its holes. The surface is on the left, seen from where F > 0.

    Rims of holes, where F is not finite, are known to a cell of the lattice only, and a doubt says so.
    """
    own, _ = mesh_of(surface, tracing)
    mesh = own.mesh
    if not mesh.face_count:
        return no_curves()
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first[uses.count == 1]]
    a, b = mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]
    sides = box_sides(surface, mesh.vertices)
    # On singular lines sheets go on in each other, with vertices of their own.
    ends = ~(own.on_line[a] & own.on_line[b])
    a, b = a[ends], b[ends]
    common = sides[a] & sides[b]
    families = [
        _border(surface, mesh.vertices, a, b, axis, np.flatnonzero(common[:, axis]), tracing) for axis in range(3)
    ]
    rims = np.flatnonzero(~common.any(axis=1))
    if len(rims):
        families.append(_rims(mesh.vertices, a[rims], b[rims]))
    return all_curves(families)


def implicit_contour_cusps(surface: ImplicitSurface, eye: ArrayLike, curves: ImplicitCurves) -> tuple[Floats, Ints]:
    """The points of a contour of an implicit surface where its image has a cusp.

    Parameters
    ----------
    surface : ImplicitSurface
        F.
    eye : (3,) array_like of float
        In world coordinates.
    curves : ImplicitCurves
        The contour for it, as of `implicit_contour`.

    Returns
    -------
    points : (k, 3) array of float
        The cusps: the line of sight is an asymptotic direction there. Refined to 1e-12 of the extent.
    after : (k,) array of int
        For each the position in curves.points of the point before it.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers.

    Notes
    -----
    Degenerate: where the line of sight is asymptotic all along the contour (on cones and cylinders), there is no cusp.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> torus, eye = surfaces.ImplicitTorus(3.0, 1.0), (12, 0, 4)
    >>> contour = features.implicit_contour(torus, eye, tracing=features.ImplicitTracing(cells=16))
    >>> cusps, after = features.implicit_contour_cusps(torus, eye, contour)
    >>> cusps.shape, after.shape
    ((4, 3), (4,))
    """
    place = vector("contour: eye", eye)
    far = _farthest(surface, place)
    return _cusps(surface, ImplicitCentralContour(surface, place), far, lambda x: place - x, curves)


def implicit_parallel_contour_cusps(
    surface: ImplicitSurface, direction: ArrayLike, curves: ImplicitCurves
) -> tuple[Floats, Ints]:
    """The points of a contour of an implicit surface where its image has a cusp, for an eye at infinity.

    Parameters
    ----------
    surface : ImplicitSurface
        F.
    direction : (3,) array_like of float
        Of any length, towards the eye.
    curves : ImplicitCurves
        The contour for it, as of `implicit_parallel_contour`.

    Returns
    -------
    points : (k, 3) array of float
        The cusps, as of `implicit_contour_cusps`.
    after : (k,) array of int
        For each the position in curves.points of the point before it.

    Raises
    ------
    InputError
        For a direction without length.

    Notes
    -----
    Degenerate: as for `implicit_contour_cusps`.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> contour = features.implicit_parallel_contour(ball, (0, 0, 1), tracing=features.ImplicitTracing(cells=12))
    >>> len(features.implicit_parallel_contour_cusps(ball, (0, 0, 1), contour)[0])  # the outline of a ball is smooth
    0
    """
    d = normalize(vector("contour: direction", direction))
    return _cusps(surface, ImplicitParallelContour(surface, d), 1.0, lambda x: np.broadcast_to(d, x.shape), curves)


def with_points(curves: ImplicitCurves, points: Floats, after: Ints) -> ImplicitCurves:
    """The curves with points (k,3) put in, each after the point at position after (k,) in curves.points."""
    counts = np.bincount(np.searchsorted(curves.offsets, after, side="right") - 1, minlength=len(curves))
    offsets = curves.offsets + ragged.offsets(counts)
    return replace(curves, points=np.insert(curves.points, after + 1, points, axis=0), offsets=offsets.astype(np.intp))


def _family(
    surface: ImplicitSurface,
    condition: Callable[[float], tuple[SpatialCondition, float]],
    levels: Floats,
    tracing: ImplicitTracing,
) -> ImplicitCurves:
    """The curves of each level, on one mesh."""
    mesh, doubts = mesh_of(surface, tracing)
    tracing = replace(tracing, mesh=mesh)
    families = []
    for level in levels.tolist():
        one, size = condition(level)
        families.append(curves_in_space(surface, one, size=size, tracing=tracing, level=level))
    return all_curves([no_curves(doubts), *families])


def _farthest(surface: ImplicitSurface, place: Floats) -> float:
    """The largest distance of a place from points of the box."""
    low, high = np.asarray(surface.box, dtype=np.float64)
    return float(np.linalg.norm(np.maximum(np.abs(low - place), np.abs(high - place))))


def _cosines(cosines: ArrayLike) -> Floats:
    levels = np.atleast_1d(np.asarray(cosines, dtype=np.float64))
    if levels.ndim != 1 or not (np.abs(levels) <= 1.0).all():
        raise InputError("isophotes: cosines must lie between -1 and 1")
    return levels


def _border(
    surface: ImplicitSurface, vertices: Floats, a: Ints, b: Ints, axis: int, chosen: Ints, tracing: ImplicitTracing
) -> ImplicitCurves:
    """The borders on the two sides of the box across an axis, from the edges a, b (e,) that are chosen."""
    box = np.asarray(surface.box, dtype=np.float64)
    extent = float(np.ptp(box, axis=0).max())
    families = []
    for side in (0, 1):
        here = chosen[vertices[a[chosen], axis] == box[side, axis]]
        branches = concat(np.stack([a[here], b[here]], axis=1))
        if not len(branches):
            continue
        lines = Traces.of(vertices[branches.points], closed_round(branches))
        plane = MeetsPlane(np.eye(3)[axis], float(box[side, axis]))
        curve = curve_in_space(surface, plane, extent)
        tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
        most = tracing.budget.points
        finer = refined_chords(curve, lines, tolerance, tracing.picture, most)
        points = finer.lines.points.copy()
        points[:, axis] = box[side, axis]
        texts = [
            (finer.unsure.any(), f"{finer.unsure.sum()} chords of a border could not be refined"),
            (not finer.enough.all(), unresolved("borders are off by more than the tolerance")),
        ]
        doubts = tuple(text for said, text in texts if said)
        families.append(curves_of_lines(Traces(points, finer.lines.last), branches.closed, doubts=doubts))
    return all_curves(families)


def _rims(vertices: Floats, a: Ints, b: Ints) -> ImplicitCurves:
    """The rims of holes, as they are in the mesh."""
    branches = concat(np.stack([a, b], axis=1))
    none, doubt = np.zeros((0, 3)), "the rim of a hole of an implicit surface is known to a cell only"
    return ImplicitCurves(
        vertices[branches.points], branches.offsets, branches.closed, np.zeros(len(branches)), none, none, (doubt,)
    )


def _cusps(
    surface: ImplicitSurface,
    condition: SpatialCondition,
    scale: float,
    way: Callable[[Floats], Floats],
    curves: ImplicitCurves,
) -> tuple[Floats, Ints]:
    """Cusps from the changes of sign of the bending along the line of sight, between two points of a contour."""
    after = np.arange(1, len(curves.points) + 1)
    after[curves.offsets[1:] - 1] = np.where(curves.closed, curves.offsets[:-1], curves.offsets[1:] - 1)

    def bending(x: Floats) -> Floats:
        with np.errstate(all="ignore"):
            return sight_line_bending(surface, x, way(x))

    at = bending(curves.points)
    known = np.isfinite(at)
    size = np.abs(at[known]).max(initial=0.0)
    changes = known & known[after] & ((at < 0.0) != (at[after] < 0.0))
    before = np.flatnonzero(changes & (np.maximum(np.abs(at), np.abs(at[after])) > FLAT_OF_VALUES * size))
    a, b = curves.points[before], curves.points[after[before]]
    curve = curve_in_space(surface, condition, scale)
    reach = np.linalg.norm(b - a, axis=1)

    def place(t: Floats, which: Ints) -> Floats:
        return curve.onto(a[which] + t[:, None] * (b - a)[which], reach[which])[0]

    w0, w1 = at[before], at[after[before]]
    small = np.full(len(before), ZERO_OF_BENDING * size)
    t, _ = bracketed_zeros(lambda t, which: bending(place(t, which)), w0, w1, w0 / (w0 - w1), small)
    return place(t, np.arange(len(before))), before
