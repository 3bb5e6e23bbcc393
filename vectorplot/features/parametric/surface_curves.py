"""Curves that lie on a parametrised surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import APART, DOUBTS, EACH_LINE, EACH_POINT, NumberedLines, joined
from vectorplot.tolerances.of_parameters import REPEATED_OF_DOMAIN


@dataclass(frozen=True, eq=False)
class SurfaceCurves(NumberedLines):
    """Polylines on a surface, each point known by its parameters and in space.

    Parameters
    ----------
    u, v : (n,) array of float
        Parameters: along a curve they run on over seams, beyond the domain.
    points : (n, 3) array of float
        In world coordinates.
    offsets : (m+1,) array of int
        Curve i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first, which is not repeated.
    turns : (m, 2) array of int
        The periods that a closed curve has run through when it is back at its start.
    levels : (m,) array of float
        The level a curve of a family belongs to, the constant parameter of a parameter line; otherwise 0.
    isolated : (i, 2) array of float
        Parameters of single points that satisfy the condition.
    nodes : (k, 2) array of float
        Parameters of points where curves cross.
    touching : (t, 2) array of float
        Parameters of places where the condition is just touched along a line.
    doubts : tuple of str
        A sentence for each thing that could not be decided.
    directions : (n, 2) array of float
        In proportion to how u and v grow by the length of a curve, where that is known, as of integral curves; NaN
        elsewhere, and at poles.

    Notes
    -----
    A curve through a pole has the pole twice, with the parameters it comes and goes with.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.Sphere()
    >>> curves = features.v_lines(ball, [0.0, 0.5])
    >>> isinstance(curves, features.SurfaceCurves), len(curves), curves.levels.tolist(), curves.turns.tolist()
    (True, 2, [0.0, 0.5], [[1, 0], [1, 0]])
    >>> bool(np.allclose(ball.points(curves.u, curves.v), curves.points)), curves[0].shape[1]
    (True, 3)
    """

    u: Floats = field(metadata=EACH_POINT)
    v: Floats = field(metadata=EACH_POINT)
    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    turns: Ints = field(metadata=EACH_LINE)
    levels: Floats = field(metadata=EACH_LINE)
    isolated: Floats = field(metadata=APART)
    nodes: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)
    directions: Floats = field(default_factory=lambda: np.zeros((0, 2)), metadata=EACH_POINT)

    def __post_init__(self) -> None:
        if len(self.directions) != len(self.u):
            object.__setattr__(self, "directions", np.full((len(self.u), 2), np.nan))


def together(families: Sequence[SurfaceCurves]) -> SurfaceCurves:
    """All the curves in one; a doubt that several of them have is said once."""
    return joined([no_curves(), *families])


def with_points(curves: SurfaceCurves, after: Ints, u: Floats, v: Floats, points: Floats) -> tuple[SurfaceCurves, Ints]:
    """The curves with points put in, and (k,) where these stand among the new points.

    after (k,): positions in curves.u of the points that the new ones follow, one for each; u, v (k,) and points (k,3):
    what is put in, in the order along the curves, parameters running on with those of the curve. A point of the curve
    in whose place a new one comes, to within 1e-9 of what the parameters span, gives way to it.
    """
    place = np.asarray(after, dtype=np.intp)
    if not len(place):
        return curves, place
    order = np.argsort(place, kind="stable")
    at = np.empty_like(place)
    at[order] = place[order] + 1 + np.arange(len(place))
    curve = np.searchsorted(curves.offsets, place, side="right") - 1
    span = np.array([np.ptp(x) if len(x) else 0.0 for x in (curves.u, curves.v)])
    gone = np.zeros(len(curves.u) + len(place), dtype=np.bool_)
    old_to_new = np.arange(len(curves.u)) + np.searchsorted(place[order], np.arange(len(curves.u)))
    last = curves.offsets[curve + 1] - 1
    for neighbour in (place, np.where(place < last, place + 1, place)):
        apart = np.abs(np.stack([u - curves.u[neighbour], v - curves.v[neighbour]], axis=1))
        gone[old_to_new[neighbour[(apart <= REPEATED_OF_DOMAIN * span).all(axis=1)]]] = True
    kept = ~gone
    sizes = np.diff(curves.offsets) + np.bincount(curve, minlength=len(curves))
    bounds = ragged.offsets(sizes)
    counts = ragged.offsets(kept)

    def merged(old: Floats, new: Floats) -> Floats:
        result = np.insert(old, place[order] + 1, np.asarray(new)[order], axis=0)
        return np.asarray(result[kept])

    return replace(
        curves,
        u=merged(curves.u, u),
        v=merged(curves.v, v),
        points=merged(curves.points, points),
        directions=merged(curves.directions, np.full((len(place), 2), np.nan)),
        offsets=counts[bounds].astype(np.intp),
    ), counts[at].astype(np.intp)


def no_curves(doubts: tuple[str, ...] = ()) -> SurfaceCurves:
    """No curve at all."""
    none, pairs = np.zeros(0), np.zeros((0, 2))
    return SurfaceCurves(
        none,
        none,
        np.zeros((0, 3)),
        np.zeros(1, dtype=np.intp),
        np.zeros(0, dtype=np.bool_),
        np.zeros((0, 2), dtype=np.intp),
        none,
        pairs,
        pairs,
        pairs,
        doubts,
    )
