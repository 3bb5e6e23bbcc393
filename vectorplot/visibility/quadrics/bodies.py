"""Round bodies as the eye of a view sees them, which is the origin: balls, frusta, capped quadrics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import inverse_matrix, matmul
from vectorplot.geometry.elementary import arccos, arctan2
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.records import APART, Elements
from vectorplot.geometry.vectors import dot
from vectorplot.scene.item import Item
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import Ball, CappedQuadric

# Coordinates in which the eye is the origin, or a point at infinity.


@dataclass(frozen=True, eq=False)
class EyeCoordinates:
    """x to the right, y upwards, z the depth; central: the eye is the origin, else it is infinitely far, against z.

    What is seen of a homogeneous point (x,y,z,w) is (x,y,z), or of a parallel projection (x,y,w): homogeneous
    coordinates of its image. Its own inverse but for the shift. origin (3,): of the view; near: the least depth that is
    seen.
    """

    central: bool
    origin: Floats
    near: float

    def points(self, points: Floats) -> Floats:
        """(...,3) points of the view in these coordinates."""
        return self.vectors(points - self.origin)

    def vectors(self, vectors: Floats) -> Floats:
        """(...,3) vectors of the view in these coordinates, or back."""
        return np.asarray(vectors * _MIRROR)

    def points_of_view(self, points: Floats) -> Floats:
        """(...,3) points in these coordinates as points of the view."""
        return self.vectors(points) + self.origin

    @property
    def seen(self) -> list[int]:
        """Which homogeneous coordinates of a point are those of its image."""
        return [0, 1, 2] if self.central else [0, 1, 3]


def eye_coordinates(projection: Projection) -> EyeCoordinates:
    """Those of a projection."""
    eye = projection.eye
    return EyeCoordinates(eye is not None, np.zeros(3) if eye is None else eye, projection.near)


_MIRROR = np.array([1.0, 1.0, -1.0])


# Round bodies of a scene as its eye sees them: images of unit bodies.


@dataclass(frozen=True, eq=False)
class UnitBodies(Elements):
    """Images of unit bodies in the coordinates of sight: the points centre + s @ frame; centre (n,3), frame (n,3,3),
    item (n,); hides (n,); tolerance: what counts as distance zero."""

    sight: EyeCoordinates = field(metadata=APART)
    centre: Floats
    frame: Floats
    item: Ints
    hides: Bools
    tolerance: float = field(metadata=APART)

    def __len__(self) -> int:
        return len(self.item)

    @cached_property
    def inverse(self) -> Floats:
        """(n,3,3): s = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(self.frame))

    @cached_property
    def eye(self) -> Floats:
        """(n,3) the eye in the coordinates of the unit body; of a parallel projection the unit vector towards it."""
        if self.sight.central:
            return np.asarray(np.einsum("ni,nij->nj", -self.centre, self.inverse))
        towards = -self.inverse[:, 2]
        return np.asarray(towards / np.sqrt(dot(towards, towards))[:, None])

    @property
    def eye_weight(self) -> float:
        """The fourth homogeneous coordinate of the eye: 0 where it is infinitely far."""
        return 1.0 if self.sight.central else 0.0

    def contours(self, which: Ints) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of the contours of whole balls; NaN where the eye is inside of them."""
        eye = self.eye[which]
        distance = np.sqrt(dot(eye, eye))
        height = self.eye_weight / distance
        outside = np.where(height <= 1.0, height, np.nan)
        return sphere_sections(self.centre[which], self.frame[which], eye / distance[:, None], outside)


class Placed(Protocol):
    """A body of the world: the points centre + s @ frame of a unit body."""

    @property
    def centre(self) -> Any:
        """(3,)."""

    @property
    def frame(self) -> Any:
        """(3,3)."""


def bodies_in_sight(view: View, items: Sequence[Item], which: Ints, bodies: Sequence[Placed]) -> UnitBodies:
    """Bodies of the world, those of the items which (n,), as the eye of a view sees them."""
    sight = eye_coordinates(view)
    centre = np.array([body.centre for body in bodies]).reshape(-1, 3)
    frame = np.array([body.frame for body in bodies]).reshape(-1, 3, 3)
    turned = view.axes.T / view.scale
    hides = np.array([items[k].hides for k in which.tolist()], dtype=np.bool_)
    in_view = matmul(centre - view.centre, turned)
    return UnitBodies(sight, sight.points(in_view), sight.vectors(matmul(frame, turned)), which, hides, view.tolerance)


# The spheres and ellipsoids of a scene as its eye sees them.


@dataclass(frozen=True, eq=False)
class Balls(UnitBodies):
    """Images of the unit sphere."""

    @cached_property
    def reach(self) -> Floats:
        """(n,3) half the sides of the boxes around the balls."""
        return np.asarray(np.sqrt((self.frame * self.frame).sum(axis=1)))

    @cached_property
    def same(self) -> Ints:
        """(n,) the first ball at the same place and of the same form: each other hides nothing of it."""
        shape = np.einsum("nki,nkj->nij", self.frame, self.frame).reshape(-1, 9)
        size = self.reach.max(axis=1, initial=0.0, keepdims=True)
        numbers = np.concatenate([self.centre, shape / np.where(size > 0.0, size, 1.0)], axis=1)
        return same_numbers(numbers, self.tolerance)

    def farthest(self, which: Ints, directions: Floats) -> Floats:
        """(k,3) points of balls which (k,) that reach as far in directions (k,3) as they do."""
        s = np.einsum("nij,nj->ni", self.frame[which], directions)
        size = np.sqrt(dot(s, s))
        s /= np.where(size > 0.0, size, 1.0)[:, None]
        return np.asarray(self.centre[which] + np.einsum("ni,nij->nj", s, self.frame[which]))

    def polar_planes(self, which: Ints) -> Floats:
        """(k,4) linear forms, of unit gradient, positive on the eye's side of the polar plane: where a ball shows."""
        gradient = np.einsum("nij,nj->ni", self.inverse[which], self.eye[which])
        constant = -dot(gradient, self.centre[which]) - self.eye_weight
        form = np.concatenate([gradient, constant[:, None]], axis=1)
        return np.asarray(form / np.sqrt(dot(gradient, gradient))[:, None])

    def circles(self, which: Ints, normal: Floats, height: Floats) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of the sections of balls with planes: s.normal = height of the unit
        sphere, unit normals (k,3)."""
        return sphere_sections(self.centre[which], self.frame[which], normal, height)


def balls_of(view: View, items: Sequence[Item], which: Ints, balls: Sequence[Ball]) -> Balls:
    """Balls of the world, those of the items which (n,), as the eye of a view sees them."""
    seen = bodies_in_sight(view, items, which, balls)
    return Balls(seen.sight, seen.centre, seen.frame, seen.item, seen.hides, seen.tolerance)


def sphere_sections(centre: Floats, frame: Floats, normal: Floats, height: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres and two conjugate radii (k,3) of what the planes s.normal = height cut out of the unit sphere, at the
    points centre + s @ frame: centre, unit normals (k,3), frame (k,3,3)."""
    first, second = _across(normal)
    radius = np.sqrt(np.maximum(1.0 - height * height, 0.0))[:, None]
    parts = (height[:, None] * normal, radius * first, radius * second)
    middle, p, q = (np.einsum("ni,nij->nj", part, frame) for part in parts)
    return centre + middle, p, q


def same_numbers(numbers: Floats, tolerance: float) -> Ints:
    """(n,) the first of the rows (n,k) that are equal to each, but for the tolerance."""
    # Floats have room for the numbers of an eye far away, and zero has two signs.
    key = np.round(numbers / (4.0 * tolerance)) + 0.0
    _, first, group = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[group.reshape(-1)])


def _across(directions: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors (n,3) across each unit vector (n,3), and each other."""
    axis = np.zeros_like(directions)
    axis[np.arange(len(directions)), np.abs(directions).argmin(axis=1)] = 1.0
    first = np.cross(directions, axis)
    first /= np.sqrt(dot(first, first))[:, None]
    return first, np.cross(directions, first)


# Frusta and parts of balls between flat ends as the eye of a view sees them.

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
    def growth(self) -> Floats:
        """(n,) by how much the radius of a frustum grows with z."""
        return np.where(self.is_round, 0.0, self.radii[:, TOP] - self.radii[:, BOTTOM])

    @cached_property
    def radius_at_eye(self) -> Floats:
        """(n,) of a frustum, at the height of the eye."""
        return self.radii[:, BOTTOM] * self.eye_weight + self.growth * self.eye[:, 2]

    @cached_property
    def polar(self) -> Floats:
        """(n,4) forms in the unit coordinates: positive where the mantle shows the eye its outside."""
        plain, far = self.eye, self.radius_at_eye
        frustum = np.stack([plain[:, 0], plain[:, 1], -far * self.growth, -far * self.radii[:, BOTTOM]], axis=1)
        ball = np.stack([plain[:, 0], plain[:, 1], plain[:, 2], np.full(len(self), -self.eye_weight)], axis=1)
        return np.where(self.is_round[:, None], ball, frustum)

    @cached_property
    def faces_eye(self) -> Bools:
        """(n,2) whether the plane of the cap at the bottom, and at the top, shows the eye its outside."""
        height = self.eye[:, 2:3] - self.ends * self.eye_weight
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
        ball = np.where(self.is_round[:, None], self.eye_weight - e[:, 2:3] * np.stack([low, high], axis=1), 0.0)
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
