"""The cusps of apparent contours: where the line of sight touches the contour itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.conditions import Contour
from vectorplot.features.parametric.stacked_conditions import StackedConditions, alone
from vectorplot.features.parametric.surface_curves import SurfaceCurves, with_points
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry import ragged, records
from vectorplot.geometry.polylines import joined
from vectorplot.geometry.vectors import dot, length
from vectorplot.surfaces.normals import unit_normals_of
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_lengths import BESIDE_POLE, BEYOND_END
from vectorplot.tolerances.of_parameters import CURVATURE_DIFFERENCE, CUSP_FOUND, CUSP_SETTLED, ROUNDING_OF_DOMAIN
from vectorplot.tolerances.of_values import LEVEL_CURVATURE

NEAR = 0.5
"""Part of a smallest curvature among points down to which the parabola through it and its neighbours must come, for
two cusps to be looked for there."""

PARTS = 8
"""Parts of a piece of a curve among whose ends the least curvature is looked for."""

ROUNDS = 6
"""How often that is done around the least one found."""


@dataclass(frozen=True, eq=False)
class Cusps:
    """Where the image of a contour turns back.

    Parameters
    ----------
    u, v : (k,) array of float
        Parameters, running on with those of the curves.
    after : (k,) array of int
        Positions of the points of the curves that come before them; in the order along the curves.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> torus = surfaces.Torus(3.0, 1.0)
    >>> condition = features.ParallelContour(torus, direction=(2, 0, 1))
    >>> cusps = features.contour_cusps(condition, features.parallel_contour(torus, (2, 0, 1)))
    >>> isinstance(cusps, features.Cusps), torus.points(cusps.u, cusps.v).shape
    (True, (4, 3))
    """

    u: Floats
    v: Floats
    after: Ints


def sight_curvatures(contour: Contour, u: Floats, v: Floats) -> Floats:
    """(...,) normal curvatures of the surface along the line of sight: a^2 L + 2 a b M + b^2 N, where the unit vector
    to the eye has the tangential part a x_u + b x_v, and L, M, N are the parts of the second partials along the unit
    normal.

    On the contour the sight is tangential. Zero: it is an asymptotic direction there.
    Degenerate: NaN at poles, in holes, and where the eye is on the surface.
    """
    surface = contour.surface
    along_u, along_v = surface.partials(u, v)
    uu, uv, vv = surface.second_partials(u, v)
    normal = unit_normals_of(surface, u, v, (along_u, along_v))
    sight = contour.sights(u, v)
    with np.errstate(invalid="ignore", divide="ignore"):
        sight = sight / length(sight)[..., None]
    e, f, g = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
    p, q = dot(sight, along_u), dot(sight, along_v)
    # Close to a pole the partials say as little as in it.
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        area = e * g - f * f
        a, b = (g * p - f * q) / area, (e * q - f * p) / area
        return np.asarray(a * a * dot(normal, uu) + 2.0 * a * b * dot(normal, uv) + b * b * dot(normal, vv))


def contour_cusps(contour: Contour, curves: SurfaceCurves) -> Cusps:
    """The cusps of a contour: where its image turns back, since the line of sight touches it.

    Parameters
    ----------
    contour : CentralContour or ParallelContour
        The condition that the curves satisfy.
    curves : SurfaceCurves
        The contour, as of `contour` or `parallel_contour`.

    Returns
    -------
    Cusps
        u, v (k,): parameters, running on with those of the curves; after (k,): positions of the points of the curves
        that come before them; in the order along the curves.

    Notes
    -----
    Each is a common zero of the contour's condition and of `sight_curvatures`, by Newton's method from a change of sign
    along the curves, to rounding. Two cusps between neighbouring points of a curve are found where the curvatures of
    the points around lead there. Degenerate: where the sight is an asymptotic direction all along a contour (a ruling
    seen along itself) none is given; nor is one that lies in a pole.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> torus, eye = surfaces.Torus(3.0, 1.0), (12, 0, 4)
    >>> curves = features.contour(torus, eye)
    >>> cusps = features.contour_cusps(features.CentralContour(torus, eye), curves)
    >>> len(curves), len(cusps.u)  # the outer outline, and the inner one with its four cusps
    (2, 4)
    """
    return _cusps_of_each(alone(contour.surface, contour), [curves])[0]


def contour_with_cusps(contour: Contour, curves: SurfaceCurves) -> tuple[SurfaceCurves, Ints]:
    """The curves of a contour with its cusps among their points.

    Parameters
    ----------
    contour : CentralContour or ParallelContour
        The condition that the curves satisfy.
    curves : SurfaceCurves
        The contour, as of `contour` or `parallel_contour`.

    Returns
    -------
    curves : SurfaceCurves
        With the cusps put in.
    at : (k,) array of int
        The positions of the cusps in curves.points.

    Notes
    -----
    Degenerate: as for `contour_cusps`.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> torus, eye = surfaces.Torus(3.0, 1.0), (12, 0, 4)
    >>> curves, at = features.contour_with_cusps(features.CentralContour(torus, eye), features.contour(torus, eye))
    >>> curves.points[at].shape
    (4, 3)
    """
    return contours_with_cusps(alone(contour.surface, contour), [curves])[0]


def contours_with_cusps(
    contours: StackedConditions[Contour], curves: Sequence[SurfaceCurves]
) -> list[tuple[SurfaceCurves, Ints]]:
    """For the contour (s,) of each of several surfaces what `contour_with_cusps` gives."""
    cusps = _cusps_of_each(contours, curves)
    u, v = (np.concatenate([getattr(own, name) for own in cusps]) for name in ("u", "v"))
    sizes = [len(own.u) for own in cusps]
    surface = contours.surface(ragged.owner(sizes))
    points = np.split(surface.points(*wrapped(surface.domain, u, v)), ragged.starts(sizes)[1:])
    return [
        with_points(own, found.after, found.u, found.v, there)
        for own, found, there in zip(curves, cusps, points, strict=True)
    ]


def _cusps_of_each(contours: StackedConditions[Contour], curves: Sequence[SurfaceCurves]) -> list[Cusps]:
    """The cusps of the contour (s,) of each of several surfaces."""
    # Positions in all curves together, of which each surface has its own.
    first = ragged.offsets([len(own.u) for own in curves])
    all_curves = joined(curves)
    pieces = _changing(contours, all_curves, ragged.owner(np.diff(first)))
    at, found = _by_newton(contours, pieces)
    at, pieces = at[found], pieces.chosen(np.flatnonzero(found))
    start, size = np.stack([all_curves.u, all_curves.v], axis=1)[pieces.after], _sizes(contours, pieces.of)
    along = ((at - start) / size * (pieces.end - pieces.start) / size).sum(axis=1)
    order = np.lexsort((along, pieces.after))
    at, after = at[order], pieces.after[order]
    bounds = np.searchsorted(after, first)
    return [Cusps(at[a:b, 0], at[a:b, 1], after[a:b] - first[k]) for k, (a, b) in enumerate(pairwise(bounds.tolist()))]


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Pieces of curves on surfaces with the numbers of (k,): parameters start, end (k,2) and curvatures low, high (k,)
    there; after (k,): the last point of the curves before them."""

    of: Ints
    start: Floats
    end: Floats
    low: Floats
    high: Floats
    after: Ints

    def chosen(self, which: Ints) -> _Pieces:
        """Those at some positions."""
        return records.some(self, which)


def _sizes(contours: StackedConditions[Contour], of: Ints) -> Floats:
    """(k,2) the sizes of the domains of the surfaces with these numbers."""
    return np.array([domain.size for domain in contours.domains])[of]


def _changing(contours: StackedConditions[Contour], curves: SurfaceCurves, of: Ints) -> _Pieces:
    """The pieces along which the curvature changes its sign; of (n,): the surface on which each point of the curves
    lies."""
    pieces = _segments(contours, curves, of)
    larger = np.abs(np.stack([pieces.low, pieces.high])).max(axis=0, initial=0.0)
    largest = np.zeros(len(contours))
    np.maximum.at(largest, pieces.of, larger)
    doubtful = pieces.chosen(np.flatnonzero(_may_dip(_sizes(contours, pieces.of), curves, pieces)))
    change = ((pieces.low < 0.0) != (pieces.high < 0.0)) & (larger > LEVEL_CURVATURE * largest[pieces.of])
    plain = pieces.chosen(np.flatnonzero(change))
    if not len(doubtful.after):
        return plain
    cut = _cut_at_least(contours, doubtful)
    fine = cut.chosen(np.flatnonzero(cut.low * cut.high < 0.0))
    return records.joined((plain, fine))


def _segments(contours: StackedConditions[Contour], curves: SurfaceCurves, of: Ints) -> _Pieces:
    """The pieces between neighbouring points, without those that stay at a pole."""
    first = np.arange(len(curves.u))
    second, last = first + 1, curves.offsets[1:] - 1
    second[last] = curves.offsets[:-1]
    periods = np.zeros((len(first), 2))
    periods[last] = curves.turns
    real = np.ones(len(first), dtype=np.bool_)
    real[last] = curves.closed
    at = np.stack([curves.u, curves.v], axis=1)
    start, end = at[first], at[second] + periods * _sizes(contours, of)
    curvature = _curvatures(contours, of, at)
    low, high = curvature[first], curvature[second]
    for ends, own, other in ((low, start, end), (high, end, start)):
        # Right beside a pole there is a curvature.
        pole = np.isnan(ends)
        ends[pole] = _curvatures(contours, of[pole], (own + BESIDE_POLE * (other - own))[pole])
    real &= np.isfinite(low) & np.isfinite(high)
    return _Pieces(of, start, end, low, high, first).chosen(np.flatnonzero(real))


def _may_dip(size: Floats, curves: SurfaceCurves, pieces: _Pieces) -> Bools:
    """(k,) pieces along which the curvature has one sign at both ends and may have the other between: a parabola
    through three points in a row comes near zero; size (k,2): of their domains."""
    second = pieces.after + 1
    curve = np.searchsorted(curves.offsets, second)
    back = curves.offsets[curve] == second
    second[back] = curves.offsets[curve[back] - 1]
    following = np.searchsorted(pieces.after, second)
    with_next = np.flatnonzero(np.isin(second, pieces.after))
    following = following[with_next]
    first, last = (np.linalg.norm((pieces.end[k] - pieces.start[k]) / size[k], axis=1) for k in (with_next, following))
    before, middle, after = pieces.low[with_next], pieces.high[with_next], pieces.high[following]
    sign = np.sign(middle)
    with np.errstate(invalid="ignore", divide="ignore"):
        down, up = (middle - before) / first * sign, (after - middle) / last * sign
        bend = (up - down) / (first + last)
        slope = (down * last + up * first) / (first + last)
        least, place = np.abs(middle) - slope * slope / (4.0 * bend), -slope / (2.0 * bend)
    dips = (before * sign > 0.0) & (after * sign > 0.0) & (bend > 0.0) & (-first <= place) & (place <= last)
    dips &= least <= NEAR * np.abs(middle)
    found = np.zeros(len(pieces.after), dtype=np.bool_)
    found[with_next[dips]] = found[following[dips]] = True
    return found & (pieces.low * pieces.high > 0.0)


def _cut_at_least(contours: StackedConditions[Contour], pieces: _Pieces) -> _Pieces:
    """The pieces cut in two where, on the contour beside them, the curvature is least or has changed its sign."""
    sign = np.sign(pieces.low)
    low, high = np.zeros(len(sign)), np.ones(len(sign))
    each, of = np.arange(len(sign)), np.tile(pieces.of, PARTS + 1)
    for _ in range(ROUNDS):
        t = low + np.linspace(0.0, 1.0, PARTS + 1)[:, None] * (high - low)
        at = pieces.start + t[..., None] * (pieces.end - pieces.start)
        at = _onto(contours, of, at.reshape(-1, 2)).reshape(at.shape)
        curvature = _curvatures(contours, of, at.reshape(-1, 2)).reshape(t.shape)
        least = np.argmin(np.where(np.isfinite(curvature), curvature * sign, np.inf), axis=0)
        low, high = t[np.maximum(least - 1, 0), each], t[np.minimum(least + 1, PARTS), each]
    cut, between = at[least, each], curvature[least, each]
    return _Pieces(
        np.tile(pieces.of, 2),
        np.concatenate([pieces.start, cut]),
        np.concatenate([cut, pieces.end]),
        np.concatenate([pieces.low, between]),
        np.concatenate([between, pieces.high]),
        np.tile(pieces.after, 2),
    )


def _curvatures(contours: StackedConditions[Contour], of: Ints, at: Floats) -> Floats:
    """(k,) curvatures along the sight at parameters (k,2), of surfaces with the numbers of (k,), that run on over
    seams."""
    contour = contours.at(of)
    return sight_curvatures(contour, *wrapped(contour.surface.domain, at[:, 0], at[:, 1]))


def _onto(contours: StackedConditions[Contour], of: Ints, at: Floats) -> Floats:
    """(k,2) parameters moved onto the contour, along the gradient of its condition."""
    contour, size = contours.at(of), _sizes(contours, of)
    domain = contour.surface.domain
    for _ in range(4):
        u, v = wrapped(domain, at[:, 0], at[:, 1])
        values, by_parameters = contour.values_and_slopes(u, v)
        slopes = np.stack(by_parameters, axis=1) * size
        square = (slopes * slopes).sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = (values / square)[:, None] * slopes
        step = np.where(np.isfinite(step), step, 0.0)
        at = _inside(domain, at - step * size)
        if np.abs(step).max(initial=0.0) <= CUSP_SETTLED:
            break
    return at


def _inside(domain: Domain, at: Floats) -> Floats:
    """(k,2) parameters, not beyond open borders."""
    u, v = at[:, 0], at[:, 1]
    u = u if domain.closed_u else np.clip(u, domain.u_start, domain.u_end)
    v = v if domain.closed_v else np.clip(v, domain.v_start, domain.v_end)
    return np.stack([u, v], axis=1)


def _by_newton(contours: StackedConditions[Contour], pieces: _Pieces) -> tuple[Floats, Bools]:
    """(k,2) parameters where condition and curvature are both zero, and which of them were found in their piece."""
    size = _sizes(contours, pieces.of)
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (pieces.low / (pieces.low - pieces.high))[:, None]
    start = pieces.start + np.where(np.isfinite(part), part, 0.5) * (pieces.end - pieces.start)
    at, travel = start.copy(), np.full(len(start), np.inf)
    active = np.arange(len(start))
    for _ in range(12):
        if not len(active):
            break
        here, own = at[active], size[active]
        contour = contours.at(pieces.of[active])
        domain = contour.surface.domain
        u, v = wrapped(domain, here[:, 0], here[:, 1])
        f, slopes = contour.values_and_slopes(u, v)
        f_u, f_v = (slope * side for slope, side in zip(slopes, own.T, strict=True))
        g, g_u, g_v = _curvatures_and_slopes(contours, pieces.of[active], here)
        with np.errstate(invalid="ignore", divide="ignore"):
            det = f_u * g_v - f_v * g_u
            step = np.stack([(g_v * f - f_v * g) / det, (f_u * g - g_u * f) / det], axis=1)
        step = np.where(np.isfinite(step), step, 0.0)
        travel[active] = np.where(np.isfinite(det) & (det != 0.0), np.abs(step).max(axis=1), np.inf)
        at[active] = _inside(domain, here - step * own)
        active = active[travel[active] > CUSP_SETTLED]
    # The root beside a piece is that of its neighbour.
    way = (pieces.end - pieces.start) / size
    square = (way * way).sum(axis=1)
    along = ((at - pieces.start) / size * way).sum(axis=1)
    own = (along >= -BEYOND_END * square) & (along <= (1.0 + BEYOND_END) * square)
    near = (
        np.abs((at - start) / size).max(axis=1, initial=0.0)
        <= np.abs(way).max(axis=1, initial=0.0) + ROUNDING_OF_DOMAIN
    )
    return at, np.asarray((travel <= CUSP_FOUND) & own & near, dtype=np.bool_)


def _curvatures_and_slopes(contours: StackedConditions[Contour], of: Ints, at: Floats) -> tuple[Floats, Floats, Floats]:
    """(k,) curvatures along the sight, and their derivatives for parameters of which the domain spans one."""
    domain, size = contours.surface(of).domain, _sizes(contours, of)
    steps = [CURVATURE_DIFFERENCE * size * axis for axis in np.eye(2)]
    ends = [_inside(domain, at + side * step) for step in steps for side in (-1.0, 1.0)]
    # All of them at once: a user's function takes longer to call than to compute.
    everywhere = _curvatures(contours, np.tile(of, 5), np.concatenate([at, *ends]))
    here, low_u, high_u, low_v, high_v = everywhere.reshape(5, -1)
    span_u, span_v = (((b - a) / size).sum(axis=1) for a, b in zip(ends[::2], ends[1::2], strict=True))
    return here, (high_u - low_u) / span_u, (high_v - low_v) / span_v
