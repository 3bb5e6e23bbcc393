"""What surfaces have in common whose horizontal sections are similar ellipses: they need a profile only."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.jets import FirstJets, SecondJets
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain

# (p, q), their first and their second derivatives.
Profile = tuple[tuple[Floats, Floats], tuple[Floats, Floats], tuple[Floats, Floats]]


class EllipticSections(MovableSurface):
    """The surface centre + (a p(v) cos u, b p(v) sin u, q(v)): p scales the ellipse of semi-axes a, b at height q.

    u runs counter-clockwise from above; where v rises on the outside, the normals point outwards.
    """

    @property
    @abstractmethod
    def domain(self) -> Domain:
        """Angle and v."""

    @abstractmethod
    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        """Semi-axes a, b of the ellipse."""

    @abstractmethod
    def _middle(self) -> Floats:
        """(3,) centre."""

    @abstractmethod
    def _profile(self, v: Floats) -> Profile:
        """(p, q), their first and their second derivatives by v."""

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend, if each of them may be a column, one value or row a point."""
        return ()

    @property
    def embedded(self) -> bool:
        """Whether it never meets itself: here, because each height has one ellipse at most."""
        return True

    @property
    def place(self) -> Floats:
        """(3,) the centre."""
        return self._middle()

    def about_origin(self) -> Self:
        """The same surface with its centre in the origin."""
        changes: Any = {"centre": (0.0, 0.0, 0.0)}
        return replace(self, **changes)  # type: ignore[type-var]

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        (p, q), _, _ = self._profile(np.asarray(v, dtype=np.float64))
        return np.asarray(self._middle() + self._at(p * np.cos(u), p * np.sin(u), q))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        (p, q), (dp, dq), _ = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        return self._at(-p * sine, p * cosine, 0.0 * q), self._at(dp * cosine, dp * sine, dq)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        (p, q), (dp, _), (ddp, ddq) = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        return (
            self._at(-p * cosine, -p * sine, 0.0 * q),
            self._at(-dp * sine, dp * cosine, 0.0 * q),
            self._at(ddp * cosine, ddp * sine, ddq),
        )

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once."""
        (p, q), (dp, dq), _ = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        x, y = p * cosine, p * sine
        points = np.asarray(self._middle() + self._at(x, y, q))
        return points, self._at(-y, x, 0.0 * q), self._at(dp * cosine, dp * sine, dq)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once."""
        (p, q), (dp, dq), (ddp, ddq) = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine, level = np.cos(u), np.sin(u), 0.0 * q
        x, y, dx, dy = p * cosine, p * sine, dp * cosine, dp * sine
        return (
            np.asarray(self._middle() + self._at(x, y, q)),
            self._at(-y, x, level),
            self._at(dx, dy, dq),
            self._at(-x, -y, level),
            self._at(-dy, dx, level),
            self._at(ddp * cosine, ddp * sine, ddq),
        )

    def _at(self, x: Floats, y: Floats, z: Floats) -> Floats:
        a, b = self._ellipse()
        return from_components(a * x, b * y, z)


class OnSemiAxes(EllipticSections):
    """Such a surface by its semi-axes a, b, c and its centre."""

    semi_axes: ArrayLike
    centre: ArrayLike

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        axes = np.asarray(self.semi_axes)
        return axes[..., 0], axes[..., 1]

    def _middle(self) -> Floats:
        return np.asarray(self.centre)
