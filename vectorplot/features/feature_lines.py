"""Feature lines of smooth surfaces: curvatures, the zeros of their derivatives, and which lines are drawn."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, no_curves
from vectorplot.features.holes import ways_between, wrapped
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.elementary import arctan2, power
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.geometry.weld import chained
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians
from vectorplot.tolerances import (
    BENT_ASIDE_OF_POLE,
    CHORD_OF_EXTENT,
    LEAST_DIVISOR,
    SECOND_DIFFERENCE,
    THIRD_DIFFERENCE_IN_SPACE,
    ZERO_OF_EXTENT,
)
from vectorplot.words import LineKind

# How a shape bends at points of it: its curvatures, and how these change.


@dataclass(frozen=True, eq=False)
class Bending(Elements):
    """Points of a shape with its third-order approximation. points, normals (n,3); along (n,3): a unit tangent; second
    (n,3): the second fundamental form p, m, q by along and the tangent to its left, positive towards the normal;
    third (n,4): derivatives of p by both tangents, and of q by both. Unknown values are NaN.
    """

    points: Floats
    normals: Floats
    along: Floats
    second: Floats
    third: Floats

    def __len__(self) -> int:
        return len(self.points)

    @property
    def aside(self) -> Floats:
        """(n,3) unit tangents a quarter turn to the left of along."""
        return cross(self.normals, self.along)

    def turned_over(self, side: Floats) -> Bending:
        """The same where sides (n,) are 1, and seen from the other side, but in the same tangents, where they are -1:
        only for what asks for no normals."""
        return Bending(self.points, self.normals, self.along, side[:, None] * self.second, side[:, None] * self.third)

    def in_plane(self, vectors: Floats) -> Floats:
        """(n,2) the tangential parts of vectors (n,3)."""
        return np.stack([dot(vectors, self.along), dot(vectors, self.aside)], axis=1)

    def in_space(self, tangents: Floats) -> Floats:
        """(n,3) vectors from their tangential parts (n,2)."""
        return np.asarray(tangents[:, :1] * self.along + tangents[:, 1:] * self.aside)

    def bent(self, tangents: Floats) -> Floats:
        """(n,2) the shape operator applied to tangents (n,2)."""
        return applied(self.second, tangents)

    def changing(self, tangents: Floats) -> Floats:
        """(n,3) the derivatives of the second fundamental form in the directions of tangents (n,2)."""
        x, y = tangents.T
        d, e, f, g = self.third.T
        return np.stack([x * d + y * e, x * e + y * f, x * f + y * g], axis=1)

    def cubed(self, tangents: Floats) -> Floats:
        """(n,) how fast the normal curvature changes along tangents (n,2), in their direction."""
        return dot(applied(self.changing(tangents), tangents), tangents)


def applied(form: Floats, tangents: Floats) -> Floats:
    """(n,2) symmetric matrices (n,3), by p, m and q, applied to vectors (n,2)."""
    x, y = tangents.T
    p, m, q = form.T
    return np.stack([p * x + m * y, m * x + q * y], axis=1)


def principal_axes(form: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """The larger and the smaller eigenvalues (n,) of symmetric matrices (n,3), by p, m and q, and their unit
    eigenvectors (n,2), of either sense."""
    p, m, q = form.T
    angle = 0.5 * arctan2(2.0 * m, p - q)
    one = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    other = np.stack([-one[:, 1], one[:, 0]], axis=1)
    middle, apart = 0.5 * (p + q), np.hypot(0.5 * (p - q), m)
    return middle + apart, middle - apart, one, other


@dataclass(frozen=True, eq=False)
class Sight:
    """From where one looks: at an eye (3,), or from infinitely far away in a direction (3,) of length one."""

    eye: Floats | None
    direction: Floats

    def ways(self, points: Floats) -> tuple[Floats, Floats]:
        """Unit vectors (n,3) to the eye from points (n,3), and one over the distances (n,)."""
        if self.eye is None:
            return np.broadcast_to(self.direction, points.shape), np.zeros(len(points))
        way = self.eye - points
        far = np.sqrt(dot(way, way))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(way / far[:, None]), np.asarray(1.0 / far)


# Which of the segments of feature lines are drawn: clear ones, with what hangs on them, and no short bits.

BEGINS = {
    LineKind.SUGGESTIVE: 24.0,
    LineKind.RIDGE: 5.0,
    LineKind.VALLEY: 5.0,
    LineKind.APPARENT: 12.0,
}
"""So strong a line is somewhere: curvatures are those of a body as large as 1, the diagonal of its box."""

GOES_ON = 0.4
"""Part of that strength down to which it goes on from there."""

SHORTEST = 0.03
"""So much of the extent of the body it is long at least."""


@dataclass(frozen=True)
class Detail:
    """How much is drawn: twice as much detail, thresholds of half the size, and lines half as long."""

    factor: float = 1.0

    def begins(self, kind: LineKind) -> float:
        """How strong a line of a kind is somewhere."""
        return BEGINS[kind] / self.factor

    @property
    def shortest(self) -> float:
        """How long lines are, as a part of the extent."""
        return SHORTEST / self.factor


def clear_segments(
    pairs: Ints, strength: Floats, lengths: Floats, kind: LineKind, extent: float, detail: Detail
) -> Bools:
    """(s,) which segments between points, pairs (s,2), are drawn: those of lines that begin strong, go on while they
    are not much weaker (hysteresis), and are long enough.

    strength, lengths (s,): of the segments; extent: of the body.
    """
    begins = detail.begins(kind)
    kept = strength >= GOES_ON * begins
    which = np.flatnonzero(kept)
    if not len(which):
        return kept
    label = chained(int(pairs.max()) + 1, *pairs[which].T)[pairs[which, 0]]
    _, line = np.unique(label, return_inverse=True)
    many = int(line.max()) + 1
    strong = np.zeros(many)
    np.maximum.at(strong, line, strength[which])
    long = np.bincount(line, lengths[which], many)
    kept[which] = ((strong >= begins) & (long >= detail.shortest * extent))[line]
    return kept


# The functions on a shape whose zeros are its feature lines, and how strong a line is where they vanish.
#
# Curvatures count as positive where a shape bends away from who looks at it, or from what is outside of it.

LineFunction = Callable[[Bending], "LineField"]

ROUND = 0.1
"""Where the curvature falls off beside a ridge by less than so many times its third power it is nearly a circle's."""


@dataclass(frozen=True, eq=False)
class LineField:
    """A function at points of a shape. values (n,): lines are where they vanish; strength (n,): how clear a line is,
    independent of scale, NaN for none; directions (n,3) or None: those of values, which change sign with them: a
    line is where height (n,), what values are derivatives of, is largest; sides (n,): -1 where the shape turns away
    from the eye, if that matters.
    """

    values: Floats
    strength: Floats
    directions: Floats | None
    height: Floats | None = None
    sides: Floats | None = None


def line_function(kind: LineKind, sight: Sight, extent: float, outward: float | None) -> LineFunction:
    """The function whose zeros are lines of a kind, on a body of an extent.

    outward: 1 or -1 as the normals of a closed body point out of or into it, or None, where the side one sees counts.
    """
    if kind == LineKind.SUGGESTIVE:
        return lambda bending: _suggestive(bending, sight, extent)
    if kind == LineKind.APPARENT:
        return lambda bending: _apparent(bending, sight, extent)
    sign = 1.0 if kind == LineKind.RIDGE else -1.0
    return lambda bending: _ridge(bending.turned_over(sign * _sides(bending, sight, outward)), extent)


def _sides(bending: Bending, sight: Sight, outward: float | None) -> Floats:
    """(n,) -1 where normals point outwards, or to the eye, else 1: where curvatures are those of the convex."""
    if outward is not None:
        return np.full(len(bending), -outward)
    return np.where(dot(sight.ways(bending.points)[0], bending.normals) < 0.0, 1.0, -1.0)


def _suggestive(bending: Bending, sight: Sight, extent: float) -> LineField:
    """The radial curvature, and how fast it grows towards the eye.

    With w the part of the way to the eye in the tangent plane: values are the second fundamental form of w; a line is
    where it grows along w. Source: DeCarlo, Finkelstein, Rusinkiewicz, Santella (2003), section 3.
    """
    ways, _ = sight.ways(bending.points)
    cosine = dot(ways, bending.normals)
    seen = bending.turned_over(np.where(cosine < 0.0, 1.0, -1.0))
    w = bending.in_plane(ways)
    aside = np.stack([-w[:, 1], w[:, 0]], axis=1)
    values = dot(bending.bent(w), w)
    sine = np.sqrt(dot(w, w))
    twist = dot(seen.bent(w), aside)
    with np.errstate(divide="ignore", invalid="ignore"):
        # Divided by the cosine: where the surface nearly turns away, a faint line will soon be a contour.
        growth = (seen.cubed(w) / sine - 2.0 * np.abs(cosine) * (twist / sine) ** 2 / sine) / np.abs(cosine)
    return LineField(values, extent * extent * growth, None, sides=np.sign(cosine))


def _ridge(bending: Bending, extent: float) -> LineField:
    """The derivative of the largest curvature along its own direction.

    A line is where it is largest, and larger than the other curvature turned the other way.
    Source: Ohtake, Belyaev, Seidel (2004), section 2.
    """
    most, least, direction, _ = principal_axes(bending.second)
    clear = np.maximum(most - np.abs(least), 0.0)
    return LineField(bending.cubed(direction), extent * clear, bending.in_space(direction), most)


def _apparent(bending: Bending, sight: Sight, extent: float) -> LineField:
    """The derivative of the view-dependent curvature along its own direction. That curvature is the larger singular
    value of S P^-1, S the shape operator, P the projection of the tangent plane to the image; its square is the
    larger eigenvalue of A = S S + (S w) (S w)' / c^2, w the tangential and c the normal part of the way to the eye.
    Source: Judd, Durand, Adelson (2007), section 3.
    """
    ways, nearness = sight.ways(bending.points)
    cosine, w = dot(ways, bending.normals), bending.in_plane(ways)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        tangent = bending.bent(w) / cosine[:, None]
        p, m, q = bending.second.T
        one, two = tangent.T
        form = np.stack([p * p + m * m + one * one, m * (p + q) + one * two, m * m + q * q + two * two], axis=1)
        square, other, a, _ = principal_axes(form)
        turning = bending.bent(a)
        # The direction in the tangent plane whose image is that of the curvature.
        x = turning + (dot(turning, w) / cosine**2)[:, None] * w
        x = x / np.sqrt(dot(x, x))[:, None]
        change = bending.changing(x)
        bent = bending.bent(x)
        along = dot(x, w)
        turn = dot(a, bending.bent(w))
        way_turns = dot(turning, -(x - along[:, None] * w)) * nearness
        normal_turns = -dot(bent, w) + along * cosine * nearness
        twisted = dot(a, applied(change, w)) + dot(a, bending.bent(bent)) * cosine + way_turns
        derivative = (
            2.0 * dot(turning, applied(change, a))
            + 2.0 * turn * twisted / cosine**2
            - 2.0 * turn * turn * normal_turns / power(cosine, 3)
        )
        # Where one looks straight at a ball all directions are alike.
        clear = np.sqrt(square) - np.sqrt(np.maximum(other, 0.0))
        return LineField(
            derivative / (np.maximum(square, 0.0) * np.sqrt(np.maximum(square, 0.0))),
            extent * clear,
            bending.in_space(x),
            None,
            np.sign(cosine),
        )


def sharpness(falls: Floats, height: Floats) -> Floats:
    """(n,) 0 to 1: how clearly a curvature falls off beside a ridge, by falls (n,), where it has a height (n,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.clip(-falls / (ROUND * height**3), 0.0, 1.0)


# Where a function at the corners of triangles vanishes, though its sign may be anyone's choice.


@dataclass(frozen=True, eq=False)
class Crossings:
    """Sides of triangles on which a function vanishes, and the segments between them.

    low, high (k,): the ends of the sides; part (k,): where between them; pairs (s,2): of sides, in the triangles
    triangle (s,); strength (s,): how clear the line is there.
    """

    low: Ints
    high: Ints
    part: Floats
    pairs: Ints
    triangle: Ints
    strength: Floats


def crossings(points: Floats, triangles: Ints, field: LineField) -> Crossings:
    """The segments across triangles (t,3) of points (n,3) on which a field is zero, and a line is.

    Directions at the ends of a side are compared with each other: the function has one sign where they go the same way.
    A triangle round which they do not come back to themselves has an umbilic inside, and no line.
    Edge cases: zero counts as positive; triangles with values that are not finite have no line.
    """
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1)
    usable = np.flatnonzero(np.isfinite(field.values)[triangles].all(axis=1))
    positive = field.values >= 0.0
    a, b = sides[usable, :, 0], sides[usable, :, 1]
    apart = positive[a] != positive[b]
    if field.directions is not None:
        opposite = dot(field.directions[a], field.directions[b]) < 0.0
        round_ = np.flatnonzero(opposite.sum(axis=1) % 2 == 0)
        usable, a, b = usable[round_], a[round_], b[round_]
        apart = apart[round_] ^ opposite[round_]
    crossed = np.flatnonzero(apart.sum(axis=1) == 2)
    usable, a, b, apart = usable[crossed], a[crossed], b[crossed], apart[crossed]
    row, which = np.nonzero(apart)
    low, high = np.minimum(a, b)[row, which], np.maximum(a, b)[row, which]
    _, first, number = np.unique(low * len(points) + high, return_index=True, return_inverse=True)
    low, high = low[first], high[first]
    pairs = number.reshape(-1, 2)
    sizes = np.abs(field.values[low]), np.abs(field.values[high])
    part = sizes[0] / np.maximum(sizes[0] + sizes[1], LEAST_DIVISOR)
    ends = field.strength[low], field.strength[high]
    with np.errstate(invalid="ignore"):
        between = (1.0 - part) * ends[0] + part * ends[1]
    if field.sides is not None:
        # A line goes on up to the contour, beyond which the strength has another sign; a derivative is infinite there.
        at_contour = np.fmax(*ends) if field.directions is None else 0.0
        between = np.where(field.sides[low] != field.sides[high], at_contour, between)
    strength = between[pairs].min(axis=1)
    if field.directions is not None:
        falls, height = _falls(points, triangles[usable], field)
        strength = np.where(falls < 0.0, strength if height is None else strength * sharpness(falls, height), 0.0)
    return Crossings(low, high, part, pairs, usable, np.nan_to_num(strength, nan=0.0, posinf=np.inf, neginf=0.0))


def _falls(points: Floats, triangles: Ints, field: LineField) -> tuple[Floats, Floats | None]:
    """(s,) how fast the derivative itself changes in its direction in each of these triangles, and the mean height."""
    directions = np.zeros((0, 3, 3)) if field.directions is None else field.directions[triangles]
    values = field.values[triangles]
    same = np.where(np.einsum("sij,sj->si", directions, directions[:, 0]) < 0.0, -1.0, 1.0)
    values, way = same * values, (same[:, :, None] * directions).sum(axis=1)
    corners = points[triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = cross(one, two)
    square = dot(normal, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        way = way / np.sqrt(dot(way, way))[:, None]
        rises = (values[:, 1] - values[:, 0]) * dot(cross(two, normal), way)
        rises += (values[:, 2] - values[:, 0]) * dot(cross(normal, one), way)
        falls = rises / square
    height = None if field.height is None else field.height[triangles].mean(axis=1)
    return np.asarray(falls), height


# Zeros between two places of a smooth shape where a function whose sign may be anyone's choice changes it.

Asked = Callable[[Floats], LineField]
"""Takes places (k,c) to what a line function says there."""

ROUNDS = 14
"""Steps of regula falsi, the Illinois way: each doubles the digits, nearly. So many and no more: where the sign changes
by rounding alone, as on a torus without ridges, `bracketed_zeros` would look 2.8 times as often before it gives up."""

BESIDE = 0.02
"""Part of a chord beside it at which the slope of a function is taken."""

FARTHEST = 0.3
"""So many lengths of a chord its curve may be away from it."""

STEPS = 4
"""Of the secant method from a chord to its curve."""


def zeros_between(asked: Asked, start: Floats, end: Floats, guess: Floats) -> Floats:
    """(k,c) the places between start and end (k,c), where the sign changes, at which the function vanishes.

    guess (k,): the part of the way where it may be. Where the function has no value on the way, the guess it is.
    """
    here, there = asked(start), asked(end)
    low, high = np.zeros(len(start)), np.ones(len(start))
    below, above = here.values.copy(), _as_at(there, here)
    at, last = guess.copy(), np.zeros(len(start))
    known: Bools = np.isfinite(below) & np.isfinite(above)
    for again in range(ROUNDS):
        if again:
            with np.errstate(all="ignore"):
                at = np.where(known, low - below * (high - low) / (above - below), guess)
            at = np.where(np.isfinite(at), np.clip(at, low, high), guess)
        value = _as_at(asked(start + at[:, None] * (end - start)), here)
        known &= np.isfinite(value)
        same = (value < 0.0) == (below < 0.0)
        # An end that stays twice is given half its weight.
        above = np.where(same & (last > 0.0), 0.5 * above, above)
        below = np.where(~same & (last < 0.0), 0.5 * below, below)
        low, below = np.where(same, at, low), np.where(same, value, below)
        high, above = np.where(same, high, at), np.where(same, above, value)
        last = np.where(same, 1.0, -1.0)
    return np.asarray(start + np.where(known, at, guess)[:, None] * (end - start))


def zeros_beside(asked: Asked, start: Floats, end: Floats, part: Floats, size: Floats) -> tuple[Floats, Bools]:
    """The places beside chords from start to end (k,2) at which the function vanishes, at a part (k,) of them, and
    whether it was found (k,). size (2,): of the domain of places."""
    way = (end - start) / size
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) * size
    base = start + part[:, None] * (end - start)
    here = asked(base)
    before, now = np.zeros(len(base)), np.full(len(base), BESIDE)
    value_before = here.values
    for _ in range(STEPS):
        value = _as_at(asked(base + now[:, None] * across), here)
        with np.errstate(all="ignore"):
            step = value * (now - before) / (value - value_before)
        step = np.clip(np.where(np.isfinite(step), step, 0.0), -FARTHEST, FARTHEST)
        before, value_before, now = now, value, now - step
    found: Bools = np.isfinite(value) & (np.abs(now) < FARTHEST) & (np.abs(step) < BESIDE)
    return base + np.where(found, now, 0.0)[:, None] * across, found


def _as_at(field: LineField, other: LineField) -> Floats:
    """(k,) the values, in the sense of the directions of another field at the same rows."""
    if field.directions is None or other.directions is None:
        return field.values
    return np.asarray(np.where(dot(field.directions, other.directions) < 0.0, -field.values, field.values))


# How smooth surfaces bend: second derivatives as they know them, third ones by differences.


def surface_bending(surface: Surface, u: Floats, v: Floats) -> Bending:
    """How a parametrised surface bends at parameters u, v (k,), which may have run on over seams.

    Error: third derivatives are differences of second ones, about 1e-7 of their size.
    Edge cases: not a number at poles, in holes and beside them.
    """
    domain = surface.domain
    steps = SECOND_DIFFERENCE * np.array(domain.size)
    with np.errstate(all="ignore"):
        by_u, by_v = surface.partials(*wrapped(domain, u, v))
        normals = cross(by_u, by_v)
        normals = normals / norm(normals)[:, None]
        along = by_u / norm(by_u)[:, None]
        aside = cross(normals, along)
        # Parts of the tangents by which the parameters move.
        across = dot(by_v, aside)
        slant = dot(by_v, along)
        of_along = np.stack([1.0 / norm(by_u), np.zeros_like(u)], axis=1)
        of_aside = np.stack([-slant / (across * norm(by_u)), 1.0 / across], axis=1)
        changes = np.stack([_difference(surface, u, v, steps, axis) for axis in (0, 1)])
        shape = _shape_operator(surface, u, v)
        first, other = (np.einsum("ka,akij->kij", part, changes) for part in (of_along, of_aside))
    points = surface.points(*wrapped(domain, u, v))
    return _bending(points, normals, along, aside, shape, first, other)


def implicit_bending(surface: ImplicitSurface, points: Floats, extent: float) -> Bending:
    """How an implicit surface bends at points (k,3) on it.

    extent: of the surface. Error: see surface_bending; where the surface has second derivatives by differences only,
    about 1e-4.
    Edge cases: not a number at singular points.
    """
    with np.errstate(all="ignore"):
        slopes = surface.gradients(points)
        normals = slopes / norm(slopes)[:, None]
        least = np.eye(3)[np.abs(np.nan_to_num(normals)).argmin(axis=1)]
        along = cross(normals, least)
        along = along / np.maximum(norm(along), LEAST_DIVISOR)[:, None]
        aside = cross(normals, along)
        step = THIRD_DIFFERENCE_IN_SPACE * extent
        first, other = (
            (_implicit_operator(surface, points + step * way) - _implicit_operator(surface, points - step * way))
            / (2.0 * step)
            for way in (along, aside)
        )
        shape = _implicit_operator(surface, points)
    return _bending(points, normals, along, aside, shape, first, other)


def _bending(
    points: Floats, normals: Floats, along: Floats, aside: Floats, shape: Floats, first: Floats, other: Floats
) -> Bending:
    """From the shape operator (k,3,3) in space and its derivatives in the directions along and aside."""

    def part(operator: Floats, one: Floats, two: Floats) -> Floats:
        return np.asarray(np.einsum("ki,kij,kj->k", one, operator, two))

    second = [part(shape, along, along), part(shape, along, aside), part(shape, aside, aside)]
    # By Codazzi's equations the derivatives are symmetric.
    third = [
        part(first, along, along),
        0.5 * (part(first, along, aside) + part(other, along, along)),
        0.5 * (part(first, aside, aside) + part(other, along, aside)),
        part(other, aside, aside),
    ]
    return Bending(points, normals, along, np.stack(second, axis=1), np.stack(third, axis=1))


def _difference(surface: Surface, u: Floats, v: Floats, steps: Floats, axis: int) -> Floats:
    """(k,3,3) the derivatives of the shape operator by u or v: one-sided at borders."""
    domain = surface.domain
    closed = (domain.closed_u, domain.closed_v)[axis]
    low, high = ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))[axis]
    own = (u, v)[axis]
    ends = [own - steps[axis], own + steps[axis]]
    if not closed:
        ends = [np.clip(end, low, high) for end in ends]
    before, after = (_shape_operator(surface, *((end, v) if axis == 0 else (u, end))) for end in ends)
    return np.asarray((after - before) / (ends[1] - ends[0])[:, None, None])


def _shape_operator(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(k,3,3) the shape operator in space: of tangents, zero along the normal."""
    u, v = wrapped(surface.domain, u, v)
    one, two = surface.partials(u, v)
    normal = cross(one, two)
    normal = normal / norm(normal)[:, None]
    p, m, q = (dot(normal, second) for second in surface.second_partials(u, v))
    e, f, g = dot(one, one), dot(one, two), dot(two, two)
    area = e * g - f * f
    dual = (g[:, None] * one - f[:, None] * two) / area[:, None], (e[:, None] * two - f[:, None] * one) / area[:, None]
    rows = p[:, None] * dual[0] + m[:, None] * dual[1], m[:, None] * dual[0] + q[:, None] * dual[1]
    return np.asarray(dual[0][:, :, None] * rows[0][:, None] + dual[1][:, :, None] * rows[1][:, None])


def _implicit_operator(surface: ImplicitSurface, points: Floats) -> Floats:
    """(k,3,3) the shape operator in space of the surface F = const. through each point, by the unit gradient."""
    slopes = surface.gradients(points)
    long = norm(slopes)
    normal = slopes / long[:, None]
    onto = np.eye(3) - normal[:, :, None] * normal[:, None]
    return np.asarray(matmul(matmul(-onto, hessians(surface, points)), onto) / long[:, None, None])


# Feature lines of parametrised surfaces.

FINER = 2
"""Cells of the grid on which curvatures are looked at, for each one that other curves are looked for on."""


def surface_feature_lines(
    surface: Surface, sight: Sight, kinds: Collection[LineKind], detail: Detail, tracing: Tracing
) -> dict[LineKind, SurfaceCurves]:
    """The feature lines of a surface of each of these kinds: every point exact, chords within the tolerance."""
    found = {kind: no_curves() for kind in kinds}
    grid = _grid(surface, FINER * tracing.columns, FINER * tracing.rows)
    bending = surface_bending(surface, *grid.places.T)
    points = bending.points
    finite = np.isfinite(points).all(axis=1)
    extent = float(norm(np.ptp(points[finite], axis=0))) if finite.any() else 0.0
    if not extent > 0.0:
        return found
    outward = _outward(points, grid) if grid.is_closed else None
    for kind in kinds:
        function = line_function(kind, sight, extent, outward)

        def asked(places: Floats, function: LineFunction = function) -> LineField:
            return function(surface_bending(surface, *places.T))

        met = crossings(points, grid.triangles, function(bending))
        a = grid.places[met.low]
        b = a + ways_between(surface.domain, a, grid.places[met.high])
        places = zeros_between(asked, a, b, met.part)
        here = surface.points(*wrapped(surface.domain, *places.T))
        lengths = norm(here[met.pairs[:, 1]] - here[met.pairs[:, 0]])
        kept = clear_segments(met.pairs, met.strength, lengths, kind, extent, detail)
        found[kind] = _curves(surface, places, met.pairs[kept], asked, extent, tracing)
    return found


@dataclass(frozen=True, eq=False)
class _Grid:
    """Places (n,2) that divide a domain evenly, triangles (t,3) of them; is_closed: the surface has no border."""

    places: Floats
    triangles: Ints
    is_closed: bool


def _grid(surface: Surface, columns: int, rows: int) -> _Grid:
    """A grid over the domain of a surface, once round where it closes, and beside its poles instead of on them."""
    domain = surface.domain
    axes = list(domain.grid(columns, rows))
    whole = []
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        own, other = axes[axis], axes[1 - axis]
        if closed:
            axes[axis] = own[:-1]
            whole.append(True)
            continue
        poles = []
        for end, step in ((0, 1.0), (-1, -1.0)):
            along = [np.full(len(other), at) for at in (own[end], own[end] + step * (own[1] - own[0]))]
            border, inner = (surface.points(*((row, other) if axis == 0 else (other, row))) for row in along)
            poles.append(_is_point(border, inner))
            if poles[-1]:
                axes[axis][end] += step * BENT_ASIDE_OF_POLE * domain.size[axis]
        whole.append(all(poles))
    m, n = (len(axis) for axis in axes)
    i, j = np.meshgrid(np.arange(m if domain.closed_u else m - 1), np.arange(n if domain.closed_v else n - 1))
    a, b, c, d = ((((i + di) % m) * n + (j + dj) % n).ravel() for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    u, v = np.meshgrid(*axes, indexing="ij")
    return _Grid(np.stack([u.ravel(), v.ravel()], axis=1), triangles, all(whole))


def _is_point(border: Floats, inner: Floats) -> bool:
    """Whether a border is a single point, as the line beside it is not."""
    size = float(np.nan_to_num(np.ptp(inner, axis=0)).max())
    return float(np.nan_to_num(np.ptp(border, axis=0), nan=np.inf).max()) <= ZERO_OF_EXTENT * size


def _outward(points: Floats, grid: _Grid) -> float:
    """1 or -1 as the normals of a closed surface point out of or into it."""
    a, b, c = (points[grid.triangles[:, k]] - points.mean(axis=0) for k in range(3))
    return 1.0 if float(np.nansum(dot(cross(a, b), c))) >= 0.0 else -1.0


def _curves(
    surface: Surface, places: Floats, pairs: Ints, asked: Asked, extent: float, tracing: Tracing
) -> SurfaceCurves:
    """Curves from segments between places (k,2), with more points until chords are within the tolerance."""
    branches = concat(pairs)
    if not len(branches):
        return no_curves()
    domain, size = surface.domain, np.array(surface.domain.size)
    sizes, own = np.diff(branches.offsets), places[branches.points]
    first = np.repeat(ragged.starts(sizes), sizes)
    steps = ways_between(domain, np.concatenate([own[:1], own[:-1]]), own)
    run = np.cumsum(steps, axis=0)
    own = own[first] + run - run[first]
    ends = branches.offsets[1:] - 1
    starts = branches.offsets[:-1]
    again = own[ends] + ways_between(domain, own[ends], own[starts])
    turns = np.round((again - own[starts]) / size).astype(np.intp) * branches.closed[:, None]
    # Closed ones are led back to where they begin, whole periods away.
    back = np.flatnonzero(branches.closed)
    rows = np.insert(own, ends[back] + 1, again[back], axis=0)
    offsets = ragged.offsets(sizes + branches.closed)
    last = np.zeros(len(rows), dtype=np.bool_)
    last[offsets[1:] - 1] = True

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return zeros_beside(asked, start, end, part, size)

    def image(at: Floats) -> Floats:
        there = surface.points(*wrapped(domain, *at.T))
        return there if tracing.picture is None else tracing.picture(there)

    tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
    lines = refined(Traces(rows, last), between, image, tolerance or np.inf, tracing.budget.points).lines
    kept, offsets = lines.unrepeated(branches.closed)
    u, v = lines.points[kept].T
    none, many = np.zeros((0, 2)), len(branches)
    there = surface.points(*wrapped(domain, u, v))
    return SurfaceCurves(u, v, there, offsets, branches.closed, turns, np.zeros(many), none, none, none, ())
