"""Where in the water an eye sees a point: Newton's iteration for the angle, and for its tangent."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.arrays import Floats
from vectorplot.effects.glass.refraction import angle_of_refraction, tangents_of_rays
from vectorplot.geometry.elementary import arctan, tan

WATER = 4.0 / 3.0

HEIGHT, DEPTHS, DISTANCES = 1.0, np.linspace(0.2, 3.0, 29), np.linspace(0.1, 8.0, 80)
"""An eye so high above the surface; depths of points, and how far they are from the eye along the surface."""


def _study() -> Study:
    far, deep = np.meshgrid(DISTANCES, DEPTHS)

    def exact() -> Floats:
        return tangents_of_rays(far, HEIGHT + deep, deep, WATER)[0]

    truth = exact()

    def error(tangent: Floats) -> float:
        return float((np.abs(tangent - truth) / truth).max())

    ways = (
        Way("by the angle", lambda steps: by_angle(far, deep, int(steps))),
        Way("by the tangent", lambda steps: by_tangent(far, deep, int(steps))),
    )
    return Study(ways, error, np.size, exact=exact)


def by_angle(far: Floats, deep: Floats, steps: int) -> Floats:
    """Tangents of the angles of incidence after some steps of Newton's method for the angle itself, from the straight
    line on.

    Source: Glaeser, section 6.6, equation 5.
    """
    alpha = arctan(far / (HEIGHT + deep))
    for _ in range(steps):
        beta = angle_of_refraction(alpha, WATER)
        excess = HEIGHT * tan(alpha) + deep * tan(beta) - far
        bend = np.cos(alpha) / (WATER * np.cos(beta))
        slope = HEIGHT / np.cos(alpha) ** 2 + deep * bend / np.cos(beta) ** 2
        alpha = np.clip(alpha - excess / slope, 0.0, arctan(far / HEIGHT))
    return np.asarray(tan(alpha))


def by_tangent(far: Floats, deep: Floats, steps: int) -> Floats:
    """The same by the tangent, as the package has it: from zero the iteration climbs to the solution and never passes
    it. The first step gives the apparent depth, deep / WATER."""
    t = np.zeros_like(far)
    for _ in range(steps):
        root = np.sqrt(WATER**2 + (WATER**2 - 1.0) * t * t)
        slope = HEIGHT + deep * (WATER / root) ** 2 / root
        t = t + (far - HEIGHT * t - deep * t / root) / slope
    return np.asarray(t)


REFRACTION = Approximation(
    name="refraction",
    title="Rays into water",
    about="The rays from points below the water to an eye above it, 2320 of them. The error is the largest one of the "
    "tangent of the angle of incidence, as a part of it; each step of Newton's method squares it. One step for the "
    "tangent is the rule that water looks three quarters as deep. Exact: as many steps as help.",
    knob="steps of Newton's method",
    values=(1, 2, 3, 4, 5, 6),
    limits=(1, 100),
    unit="parts of the tangent",
    counts="rays",
    study=_study,
)
