"""The spheres and ellipsoids of a scene as its eye sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot
from vectorplot.scene.item import Item
from vectorplot.scene.view import View
from vectorplot.surfaces.quadric_bodies.balls import Ball
from vectorplot.visibility.quadrics.bodies.unit_bodies import UnitBodies, bodies_in_sight


@dataclass(frozen=True, eq=False)
class Balls(UnitBodies):
    """Images of the unit sphere."""

    @cached_property
    def eye(self) -> Floats:
        """(n,3) the eye where the ball is the unit sphere; of a parallel projection the unit vector towards it."""
        if self.sight.central:
            return np.asarray(np.einsum("ni,nij->nj", -self.centre, self.inverse))
        towards = -self.inverse[:, 2]
        return np.asarray(towards / np.sqrt(dot(towards, towards))[:, None])

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
        constant = -dot(gradient, self.centre[which]) - (1.0 if self.sight.central else 0.0)
        form = np.concatenate([gradient, constant[:, None]], axis=1)
        return np.asarray(form / np.sqrt(dot(gradient, gradient))[:, None])

    def circles(self, which: Ints, normal: Floats, height: Floats) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of the sections of balls with planes: s.normal = height of the unit
        sphere, unit normals (k,3)."""
        return sphere_sections(self.centre[which], self.frame[which], normal, height)

    def contours(self, which: Ints) -> tuple[Floats, Floats, Floats]:
        """Centres and two conjugate radii (k,3) of the contours."""
        eye = self.eye[which]
        distance = np.sqrt(dot(eye, eye))
        height = 1.0 / distance if self.sight.central else np.zeros(len(which))
        return self.circles(which, eye / distance[:, None], height)

    def some(self, which: Ints | Bools) -> Balls:
        """Some of the balls."""
        return Balls(
            self.sight, self.centre[which], self.frame[which], self.item[which], self.hides[which], self.tolerance
        )


def balls_of(view: View, items: Sequence[Item], which: Ints, balls: Sequence[Ball]) -> Balls:
    """Balls of the world, those of the items which (n,), as the eye of a view sees them."""
    seen = bodies_in_sight(view, items, which, balls)
    return Balls(seen.sight, seen.centre, seen.frame, seen.item, seen.hides, seen.tolerance)


def sphere_sections(centre: Floats, frame: Floats, normal: Floats, height: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres and two conjugate radii (k,3) of what the planes s.normal = height cut out of the unit sphere, at the
    points centre + s @ frame: centre, unit normals (k,3), frame (k,3,3)."""
    first, second = across(normal)
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


def across(directions: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors (n,3) across each unit vector (n,3), and each other."""
    axis = np.zeros_like(directions)
    axis[np.arange(len(directions)), np.abs(directions).argmin(axis=1)] = 1.0
    first = np.cross(directions, axis)
    first /= np.sqrt(dot(first, first))[:, None]
    return first, np.cross(directions, first)
