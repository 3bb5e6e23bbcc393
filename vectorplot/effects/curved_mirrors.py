"""Curved mirrors that stand on paper: where what an eye sees in them lies on the paper, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import dot
from vectorplot.words import check_word

MIRRORS = ("cylinder", "cone", "none")
"""The kinds of mirrors; none: the paper itself is looked at, aslant."""


@dataclass(frozen=True)
class CurvedMirror:
    """A mirror of revolution about the z axis that stands on the paper, the plane z = 0, in mm.

    kind: one of MIRRORS; radius: of its foot; height: of its upper rim or its tip, infinite where a cylinder has none.
    A cylinder and a cone are x^2 + y^2 = constant + linear z + square z^2. Errors: InputError for another kind, and a
    cone that is no higher than wide: it sends what comes from above into the sky.
    """

    kind: str
    radius: float
    height: float

    def __post_init__(self) -> None:
        check_word("mirror", self.kind, MIRRORS)
        if self.kind == "cone" and not self.radius < self.height < np.inf:
            raise InputError(
                f"mirror: a cone of radius {self.radius:g} mm, {self.height:g} mm high, is too flat to show the paper: "
                f"make it higher than {self.radius:g} mm"
            )

    @property
    def profile(self) -> tuple[float, float, float]:
        """constant, linear and square."""
        if self.kind == "cylinder":
            return self.radius**2, 0.0, 0.0
        slope = self.radius / self.height
        return self.radius**2, -2.0 * slope * self.radius, slope**2

    def seen(self, eye: Floats, ways: Floats) -> Floats:
        """(k,3) where the ways (k,3) from an eye (3,) first meet the outside of the mirror; not finite where they miss
        it. Without a mirror the eye itself: nothing turns the ways."""
        if self.kind == "none":
            return np.broadcast_to(eye, ways.shape)
        constant, linear, square = self.profile
        level = ways[:, :2]
        with np.errstate(all="ignore"):
            a = dot(level, level) - square * ways[:, 2] ** 2
            b = dot(level, eye[:2]) - (0.5 * linear + square * eye[2]) * ways[:, 2]
            c = float(dot(eye[:2], eye[:2])) - constant - linear * float(eye[2]) - square * float(eye[2]) ** 2
            # The sum of two numbers of one sign: no digits are lost.
            q = -(b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(b * b - a * c))
            found = np.full(len(ways), np.inf)
            for far in (q / a, c / q):
                place = eye + far[:, None] * ways
                good = (far > 0.0) & (place[:, 2] >= 0.0) & (place[:, 2] <= self.height)
                good &= dot(ways, self.normals(place)) < 0.0
                found = np.where(good & (far < found), far, found)
            return np.asarray(np.where(np.isfinite(found)[:, None], eye + found[:, None] * ways, np.nan))

    def normals(self, places: Floats) -> Floats:
        """(k,3) vectors that point out of the mirror at places (k,3) of it, of no particular length."""
        _, linear, square = self.profile
        return np.column_stack([places[:, :2], -0.5 * linear - square * places[:, 2]])

    def on_paper(self, eye: Floats, ways: Floats) -> Floats:
        """(k,2) the points of the paper that are seen in the mirror along ways (k,3) from an eye (3,); not finite where
        a way misses the mirror, or leads from it into the sky."""
        return self.on_paper_with_slopes(eye, ways, np.zeros_like(ways))[0]

    def on_paper_with_slopes(self, eye: Floats, ways: Floats, turns: Floats) -> tuple[Floats, Floats]:
        """The same, and (k,2) how fast these points move where the ways change by turns (k,3)."""
        place = self.seen(eye, ways)
        with np.errstate(all="ignore"):
            if self.kind == "none":
                moved, ahead, turned = np.zeros_like(ways), ways, turns
            else:
                square = self.profile[2]
                normal = self.normals(place)
                facing, size = dot(ways, normal), dot(normal, normal)
                far = (dot(place - eye, ways) / dot(ways, ways))[:, None]
                # The place stays on the mirror: it moves across its normal.
                along = -far[:, 0] * dot(normal, turns) / facing
                moved = along[:, None] * ways + far * turns
                bent = np.column_stack([moved[:, :2], -square * moved[:, 2]])
                double = 2.0 * facing / size
                faster = 2.0 * (dot(turns, normal) + dot(ways, bent) - double * dot(normal, bent)) / size
                ahead = ways - double[:, None] * normal
                turned = turns - faster[:, None] * normal - double[:, None] * bent
            down = place[:, 2] / ahead[:, 2]
            lower = (moved[:, 2] - down * turned[:, 2]) / ahead[:, 2]
            points = place - down[:, None] * ahead
            slopes = moved - lower[:, None] * ahead - down[:, None] * turned
            lost = ~(ahead[:, 2] < 0.0)
        points[lost], slopes[lost] = np.nan, np.nan
        return points[:, :2], slopes[:, :2]
