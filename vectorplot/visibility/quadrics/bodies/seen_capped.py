"""Frusta and parts of balls between flat ends as the eye of a view sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.elementary import arccos, arctan2
from vectorplot.geometry.vectors import dot
from vectorplot.scene.item import Item
from vectorplot.scene.view import View
from vectorplot.surfaces.quadric_bodies.capped_quadrics import CappedQuadric
from vectorplot.visibility.quadrics.bodies.seen_balls import same_numbers
from vectorplot.visibility.quadrics.bodies.unit_bodies import UnitBodies, bodies_in_sight

BOTTOM, TOP = 0, 1


@dataclass(frozen=True, eq=False)
class CappedBodies(UnitBodies):
    """Images of unit bodies with flat ends.

    A unit body lies between the planes z = ends[:,0] and z = ends[:,1]; within the frustum with the radii (n,2) there,
    or, where is_round (n,), within the unit ball.
    """

    ends: Floats
    radii: Floats
    is_round: Bools

    @cached_property
    def eye(self) -> Floats:
        """(n,4) the eye in the coordinates of the unit body, homogeneous; a direction of about unit length where it is
        infinitely far."""
        if self.sight.central:
            place = np.einsum("ni,nij->nj", -self.centre, self.inverse)
            return np.concatenate([place, np.ones((len(self), 1))], axis=1)
        towards = -self.inverse[:, 2]
        towards = towards / np.sqrt(dot(towards, towards))[:, None]
        return np.concatenate([towards, np.zeros((len(self), 1))], axis=1)

    @cached_property
    def growth(self) -> Floats:
        """(n,) by how much the radius of a frustum grows with z."""
        return np.where(self.is_round, 0.0, self.radii[:, TOP] - self.radii[:, BOTTOM])

    @cached_property
    def radius_at_eye(self) -> Floats:
        """(n,) of a frustum, at the height of the eye."""
        return self.radii[:, BOTTOM] * self.eye[:, 3] + self.growth * self.eye[:, 2]

    @cached_property
    def polar(self) -> Floats:
        """(n,4) forms in the unit coordinates: positive where the mantle shows the eye its outside."""
        plain, far = self.eye, self.radius_at_eye
        frustum = np.stack([plain[:, 0], plain[:, 1], -far * self.growth, -far * self.radii[:, BOTTOM]], axis=1)
        ball = np.stack([plain[:, 0], plain[:, 1], plain[:, 2], -plain[:, 3]], axis=1)
        return np.where(self.is_round[:, None], ball, frustum)

    @cached_property
    def faces_eye(self) -> Bools:
        """(n,2) whether the plane of the cap at the bottom, and at the top, shows the eye its outside."""
        height = self.eye[:, 2:3] - self.ends * self.eye[:, 3:]
        return np.asarray(height * np.array([-1.0, 1.0]) > 0.0)

    @cached_property
    def has_eye_inside(self) -> Bools:
        """(n,) which bodies have the eye in them, or on them."""
        if not self.sight.central:
            return np.zeros(len(self), dtype=np.bool_)
        e, (low, high) = self.eye, self.ends.T
        across = np.hypot(e[:, 0], e[:, 1])
        beyond = np.maximum(low - e[:, 2], e[:, 2] - high) * np.sqrt(dot(self.frame[:, 2], self.frame[:, 2]))
        smallest = np.sqrt((self.frame * self.frame).sum(axis=2)).min(axis=1, initial=np.inf)
        aside = np.where(self.is_round, np.hypot(across, e[:, 2]) - 1.0, across - self.radius_at_eye) * smallest
        return np.asarray(np.maximum(beyond, aside) <= self.tolerance)

    @cached_property
    def has_cap(self) -> Bools:
        """(n,2) whether there is a cap at the bottom, and at the top."""
        return np.asarray(self.radii > 0.0)

    @cached_property
    def turn(self) -> tuple[Floats, Floats]:
        """(n,) the angle u at which rims are next to the eye, and (n,2) how far on both sides of it, at the bottom and
        at the top, the mantle shows the eye its outside: 0 nowhere, pi all around."""
        e, (low, high) = self.eye, self.ends.T
        across = np.hypot(e[:, 0], e[:, 1])
        far = np.where(self.is_round, 0.0, self.radius_at_eye)[:, None]
        ball = np.where(self.is_round[:, None], e[:, 3:] - e[:, 2:3] * np.stack([low, high], axis=1), 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            least = np.where(self.is_round[:, None], ball / self.radii, far) / across[:, None]
            reach = arccos(np.clip(least, -1.0, 1.0))
        return arctan2(e[:, 1], e[:, 0]), np.where(np.isnan(reach), 0.0, reach)

    @cached_property
    def reach(self) -> Floats:
        """(n,2,3) smallest and largest coordinates."""
        every = np.arange(len(self))
        low, high = (
            [self.farthest(every, np.broadcast_to(sign * axis, (len(self), 3)))[:, k] for k, axis in enumerate(_AXES)]
            for sign in (-1.0, 1.0)
        )
        return np.stack([np.stack(low, axis=1), np.stack(high, axis=1)], axis=1)

    def farthest(self, which: Ints, directions: Floats) -> Floats:
        """(k,3) points of bodies which (k,) that reach as far in directions (k,3) as they do."""
        d = np.einsum("nij,nj->ni", self.frame[which], directions)
        across, size = np.hypot(d[:, 0], d[:, 1]), np.sqrt(dot(d, d))
        ends, radii = self.ends[which], self.radii[which]
        with np.errstate(divide="ignore", invalid="ignore"):
            out, height = d[:, :2] / across[:, None], d[:, 2] / size
            on_ball = d / size[:, None]
        out = np.where(across[:, None] > 0.0, out, np.array([1.0, 0.0]))
        top = (ends[:, 1] - ends[:, 0]) * d[:, 2] + (radii[:, 1] - radii[:, 0]) * across > 0.0
        radius, end = (np.where(top, values[:, 1], values[:, 0]) for values in (radii, ends))
        at_end = np.concatenate([radius[:, None] * out, end[:, None]], axis=1)
        bulges = self.is_round[which] & (ends[:, 0] <= height) & (height <= ends[:, 1])
        s = np.where(bulges[:, None], on_ball, at_end)
        return np.asarray(self.centre[which] + np.einsum("ni,nij->nj", s, self.frame[which]))

    @cached_property
    def same(self) -> Ints:
        """(n,) the first body at the same place and of the same form: each other hides nothing of it."""
        first, second, axis = (self.frame[:, k] for k in range(3))
        round_ = np.einsum("ni,nj->nij", first, first) + np.einsum("ni,nj->nij", second, second)
        size = np.abs(self.frame).max(axis=(1, 2), initial=0.0)[:, None]
        numbers = [self.centre, axis, round_.reshape(-1, 9) / np.where(size > 0.0, size, 1.0)]
        ways = [self.ends * size, self.radii * size, self.is_round[:, None]]
        return same_numbers(np.concatenate([*numbers, *ways], axis=1), self.tolerance)

    def forms(self, which: Ints, unit: Floats) -> Floats:
        """(k,4) linear forms of unit gradient in the coordinates of sight, of those (k,4) in the unit coordinates of
        bodies which (k,); constant ones have the value 1 or -1."""
        gradient = np.einsum("nij,nj->ni", self.inverse[which], unit[:, :3])
        form = np.concatenate([gradient, (unit[:, 3] - dot(gradient, self.centre[which]))[:, None]], axis=1)
        size = np.sqrt(dot(gradient, gradient))
        # A gradient that is rounding beside the constant is none.
        extent = np.sqrt(dot(self.inverse[which], self.inverse[which])).max(axis=1, initial=0.0)
        plain = size <= self.tolerance * extent * np.abs(unit).max(axis=1, initial=0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            form = form / size[:, None]
        form[plain] = np.sign(unit[plain, 3:]) * np.array([0.0, 0.0, 0.0, 1.0])
        return form

    def polar_planes(self, which: Ints) -> Floats:
        """(k,4) forms that are positive where the mantle shows the eye its outside."""
        return self.forms(which, self.polar[which])

    def outside_of_cap(self, which: Ints, end: int) -> Floats:
        """(k,4) forms that are positive outside of the plane of the cap at one end of bodies."""
        sign = 1.0 if end == TOP else -1.0
        zero = np.zeros(len(which))
        return self.forms(which, np.stack([zero, zero, zero + sign, -sign * self.ends[which, end]], axis=1))

    def circles(self, which: Ints, height: Floats, radius: Floats) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of horizontal circles of unit bodies which (k,), their angle u."""
        frame = self.frame[which]
        middle = self.centre[which] + height[:, None] * frame[:, 2]
        return middle, radius[:, None] * frame[:, 0], radius[:, None] * frame[:, 1]

    def rims(self, which: Ints, end: int) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of the rims at one end of bodies which (k,)."""
        return self.circles(which, self.ends[which, end], self.radii[which, end])

    def some(self, which: Ints | Bools) -> CappedBodies:
        """Some of the bodies."""
        return CappedBodies(
            self.sight,
            self.centre[which],
            self.frame[which],
            self.item[which],
            self.hides[which],
            self.tolerance,
            self.ends[which],
            self.radii[which],
            self.is_round[which],
        )


_AXES = np.eye(3)


def capped_bodies_of(view: View, items: Sequence[Item], which: Ints, bodies: Sequence[CappedQuadric]) -> CappedBodies:
    """Bodies of the world, those of the items which (n,), as the eye of a view sees them."""
    seen = bodies_in_sight(view, items, which, bodies)
    return CappedBodies(
        seen.sight,
        seen.centre,
        seen.frame,
        seen.item,
        seen.hides,
        seen.tolerance,
        np.array([(body.low, body.high) for body in bodies]).reshape(-1, 2),
        np.array([body.radii for body in bodies]).reshape(-1, 2),
        np.array([body.is_round for body in bodies], dtype=np.bool_),
    )
