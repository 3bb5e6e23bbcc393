"""Developable surfaces of straight lines, unrolled into the plane without a stretch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.elementary import arcsin
from vectorplot.geometry.vectors import component_sum, cross, dot, norm
from vectorplot.surfaces.surface import Surface, Transposed, normals, second_jets
from vectorplot.tolerances import DEVELOPABLE_ANGLE, LEAST_DIVISOR, UNROLLED_OF_LENGTH

NODES = 8
"""Of Gauss and Legendre, in every step along the surface."""

COARSEST, FINEST = 32, 1 << 13
"""So many steps around the surface are the fewest, and the most."""


@dataclass(frozen=True, eq=False)
class Unrolled:
    """The plane development of a surface whose lines u = const. are straight, and along which its tangent plane does
    not turn.

    surface: u runs across the straight lines; along: the v of the curve that is unrolled first, from which they are
    measured; bend: the largest angle, in radians, by which the normal turns along one of them: what is no rounding of
    it is no developable surface.

    The curve v = along goes over into one with the same geodesic curvature, and each straight line keeps its angle with
    it and its lengths. Source: do Carmo, Differential geometry of curves and surfaces, sections 4-2 and 4-4.
    """

    surface: Surface
    along: float
    bend: float

    @classmethod
    def of(cls, surface: Surface) -> Unrolled:
        """That of a surface with straight lines in one direction. Errors: InputError for one that has none, and for one
        that is not developable."""
        for one in (surface, Transposed(surface, surface.domain.transposed)):
            domain = one.domain
            u, v = (grid.ravel() for grid in np.meshgrid(*domain.grid(48, 6), indexing="ij"))
            points = one.points(u, v)
            if not np.isfinite(points).all():
                raise InputError("a surface with holes has no development")
            points = points.reshape(49, 7, 3)
            way = points[:, -1:] - points[:, :1]
            length = np.maximum(norm(way), LEAST_DIVISOR)
            off = norm(cross(points - points[:, :1], way)) / length
            if float((off / length).max()) > DEVELOPABLE_ANGLE:
                continue
            normal = normals(one, u, v).reshape(49, 7, 3)
            size = norm(normal)
            there = size > DEVELOPABLE_ANGLE * size.max()
            unit = normal / np.where(there, size, 1.0)[..., None]
            best = np.argmax(size, axis=1)
            own = unit[np.arange(49), best][:, None]
            sine = np.where(there, norm(cross(unit, own)), 0.0)
            bend = float(sine.max())
            if bend > DEVELOPABLE_ANGLE:
                degrees = float(np.degrees(arcsin(min(bend, 1.0))))
                raise InputError(f"is not developable: its tangent plane turns by {degrees:.3g} degrees along a ruling")
            ends = size.reshape(49, 7)[:, [0, -1]].min(axis=0)
            return cls(one, domain.v_start if ends[0] >= ends[1] else domain.v_end, bend)
        raise InputError("is not developable: it has no straight lines along its parameters")

    def placed(self, u: Floats, v: Floats) -> Floats:
        """(n,2) where the points with parameters (n,) lie in the plane: lengths are kept to 1e-9 and better."""
        nodes, curve, angle = self._curve
        step = np.clip(np.searchsorted(nodes, u, side="right") - 1, 0, len(nodes) - 2)
        way, turned = self._steps(nodes[step], u - nodes[step], angle[step])
        at, turn = curve[step] + way, angle[step] + turned
        foot = np.full(len(u), self.along)
        origin = self.surface.points(u, foot)
        tangent, left = self._frame(u)
        arm = self.surface.points(u, v) - origin
        # Seen from where the normal of the surface points to, whichever of its parameters is u here.
        side = -1.0 if isinstance(self.surface, Transposed) else 1.0
        x, y = dot(arm, tangent), side * dot(arm, left)
        cosine, sine = np.cos(turn), side * np.sin(turn)
        at = at * np.array([1.0, side])
        return np.stack([at[:, 0] + cosine * x - sine * y, at[:, 1] + sine * x + cosine * y], axis=1)

    def _frame(self, u: Floats) -> tuple[Floats, Floats]:
        """(n,3) unit vectors along the curve, and to its left in the surface."""
        foot = np.full(len(u), self.along)
        by_u, by_v = self.surface.partials(u, foot)
        tangent = by_u / np.maximum(norm(by_u), LEAST_DIVISOR)[:, None]
        rest = by_v - dot(by_v, tangent)[:, None] * tangent
        return tangent, rest / np.maximum(norm(rest), LEAST_DIVISOR)[:, None]

    @cached_property
    def _curve(self) -> tuple[Floats, Floats, Floats]:
        """Ends of steps along u, and there the unrolled curve and its direction; twice as many steps move nothing."""
        domain = self.surface.domain
        count, before = COARSEST, None
        while True:
            may_stop()
            nodes = np.linspace(domain.u_start, domain.u_end, count + 1)
            _, turned = self._steps(nodes[:-1], np.diff(nodes), np.zeros(count))
            angle = np.concatenate([[0.0], np.cumsum(turned)])
            way, _ = self._steps(nodes[:-1], np.diff(nodes), angle[:-1])
            curve = np.concatenate([np.zeros((1, 2)), np.cumsum(way, axis=0)])
            if before is not None:
                size = max(float(np.ptp(curve, axis=0).max()), LEAST_DIVISOR)
                if float(norm(curve[::2] - before).max()) <= UNROLLED_OF_LENGTH * size or count >= FINEST:
                    return nodes, curve, angle
            before, count = curve, 2 * count

    def _steps(self, low: Floats, step: Floats, angle: Floats) -> tuple[Floats, Floats]:
        """(n,2) how far the unrolled curve goes from u (n,) in steps (n,), beginning in directions (n,), and (n,) by
        how much it turns."""
        x, weight, within = _rule()
        at = low[:, None] + step[:, None] * x
        speed, rate = (values.reshape(at.shape) for values in self._turning(at.ravel()))
        direction = angle[:, None] + step[:, None] * (rate[:, None, :] * within).sum(axis=2)
        ways = [step * (speed * weight * wave(direction)).sum(axis=1) for wave in (np.cos, np.sin)]
        return np.stack(ways, axis=1), step * (rate * weight).sum(axis=1)

    def _turning(self, u: Floats) -> tuple[Floats, Floats]:
        """(n,) how fast the curve runs at u (n,), and how fast it turns in the surface."""
        foot = np.full(len(u), self.along)
        _, by_u, by_v, uu, _, _ = second_jets(self.surface, u, foot)
        normal = cross(by_u, by_v)
        normal = normal / np.maximum(norm(normal), LEAST_DIVISOR)[:, None]
        square = np.maximum(component_sum(by_u * by_u), LEAST_DIVISOR)
        return np.sqrt(square), dot(normal, cross(by_u, uu)) / square


@cache
def _rule() -> tuple[Floats, Floats, Floats]:
    """Places and weights (k,) of Gauss and Legendre between 0 and 1, and (k,k) what the values there are to be
    multiplied with for the integrals from 0 to each of the places."""
    x, weight = np.polynomial.legendre.leggauss(NODES)
    values = np.polynomial.legendre.legvander(x, NODES)
    degree = np.arange(NODES)
    # Of Legendre's polynomials: their coefficients in what goes through the values, and their integrals.
    coefficients = (degree + 0.5)[:, None] * weight * values[:, :NODES].T
    lower = np.column_stack([-np.ones(NODES), values[:, : NODES - 1]])
    integrals = (values[:, 1:] - lower) / (2.0 * degree + 1.0)
    return 0.5 * (1.0 + x), 0.5 * weight, 0.5 * matmul(integrals, coefficients)
