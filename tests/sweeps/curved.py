"""Sweeps of smooth surfaces and of curves in the plane of parameters."""

from __future__ import annotations

import numpy as np
from support.drawn import drawn, on_page, plate
from sweeps.sweep import Sweep

import vectorplot as vp
from vectorplot.curves.families import Line
from vectorplot.features.scalar_fields import Function
from vectorplot.features.zero_curves import ZeroManifold, zero_manifold_of_f_uv
from vectorplot.geometry.polylines import segments
from vectorplot.surfaces.capped_bodies import Capped
from vectorplot.surfaces.quadrics import Cone, Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import curves_in_space
from vectorplot.tolerances import ZERO_OF_EXTENT

SLANTED = vp.Camera((5.0, -7.0, 4.0), (0.0, 0.0, 0.0))
SQUARE = Domain(-1.0, 1.0, -1.0, 1.0)
RESOLUTION = 2e-3


def item(name: str, shape: object) -> vp.Item:
    return vp.Item(name, shape)


def circle_of_two_balls(gap: float) -> float:
    """The radius of the circle in which two unit balls meet, by its length, whose centres are 2 - gap apart."""
    scene = vp.Scene((item("A", Sphere(1.0)), item("B", Sphere(1.0, (2.0 - gap, 0.0, 0.0)))))
    drawing = vp.draw(scene, SLANTED, lines=("intersection",), hidden="solid", tolerance_mm=1e-4)
    return drawn(drawing).length / (2.0 * np.pi)


def circle_in_a_plane(depth: float) -> float:
    """The radius of the circle in which a unit ball dips into a plane, by its length."""
    scene = vp.Scene((item("BALL", Sphere(1.0)), item("PLANE", plate((-2, -2), (2, 2), depth - 1.0))))
    return drawn(vp.draw(scene, SLANTED, lines=("intersection",), hidden="solid", tolerance_mm=1e-4)).length / (
        2.0 * np.pi
    )


def seen_of_a_ball_in_a_ball(gap: float) -> float:
    """The visible length of the contour of a ball of radius 1 - gap in the middle of a ball of radius 1."""
    scene = vp.Scene((item("OUTER", Sphere(1.0)), item("INNER", Sphere(1.0 - gap))))
    return drawn(vp.draw(scene, SLANTED)).of(1).visible.length


def can_along_its_axis(angle: float) -> float:
    """The visible length of a can of radius 1 and height 2, seen under an angle against its axis."""
    scene = vp.Scene((item("CAN", Capped(Cylinder(1.0, -1.0, 1.0))),))
    camera = vp.Camera((10.0 * np.sin(angle), 0.0, 10.0 * np.cos(angle)), parallel=True, up=(0.0, 1.0, 0.0))
    return drawn(vp.draw(scene, camera, tolerance_mm=1e-4)).visible.length


def line_beside_an_apex(offset: float) -> float:
    """How much is hidden of a line beside the axis of a cone of height 2, from the height of its apex down 1."""
    scene = vp.Scene((item("CONE", Cone(0.5, -2.0, 0.0)), item("LINE", Line((offset, 0.0, -1.0), (0.0, 0.0, 2.0)))))
    camera = vp.Camera((9.0, -14.0, 7.0), parallel=True)
    return drawn(vp.draw(scene, camera, lines="contour,curve", hidden="solid")).of(1).hidden.length


def cusps_of_a_torus(slant: float) -> float:
    """How many mm the cusps of the contour of a torus are from where they should be.

    slant: the angle of sight beyond the one at which the contour gets them.
    """
    from visibility.smooth.events.test_cusps import torus_cusps

    c = np.arccos(np.sqrt(1.0 / 3.0)) + slant
    camera = vp.Camera((0.0, 20.0 * np.sin(c), 20.0 * np.cos(c)), parallel=True)
    drawing = vp.draw(vp.Scene((item("T", Torus(3.0, 1.0)),)), camera, lines=("contour",), hidden="solid")
    points = on_page(drawing, np.concatenate(curves_in_space(drawing, kind="contour")))
    true = on_page(drawing, torus_cusps(3.0, 1.0, c))
    return float(np.linalg.norm(points[:, None] - true, axis=2).min(axis=0).max())


def zeros(f: Function, tolerance: float) -> ZeroManifold:
    """The curve f = 0 in the square of side 2, looked at in 24 by 24 cells first."""
    return zero_manifold_of_f_uv(f, SQUARE, columns=24, rows=24, tolerance=tolerance)


def length_of(curve: ZeroManifold) -> float:
    start, end = segments(curve).T
    return float(np.linalg.norm(curve.points[end] - curve.points[start], axis=1).sum())


def tiny_oval(radius: float) -> float:
    """The length of the circle u^2 + v^2 = r^2 in a square of side 2, in parts of its radius."""
    found = zeros(lambda u, v: (u - 0.1234) ** 2 + (v - 0.4321) ** 2 - radius**2, 1e-4 * radius)
    return length_of(found) / radius


def branches_of_a_saddle(level: float) -> float:
    """How many branches u v = c has."""
    return float(len(zeros(lambda u, v: (u - 0.1) * (v + 0.2) - level, 1e-4)))


def twin_circles(gap: float) -> float:
    """How many closed branches there are of two circles about one middle, whose radii differ by a gap."""
    found = zeros(lambda u, v: (np.hypot(u, v) - 0.5) * (np.hypot(u, v) - 0.5 - gap), 1e-4)
    return float(len(found))


def hidden_beside_an_apex(offset: float) -> float:
    """The true length of what line_beside_an_apex measures, by bisection of the closed form of sight lines."""
    eye = np.array([9.0, -14.0, 7.0]) / np.linalg.norm([9.0, -14.0, 7.0])

    def hidden(z: float) -> bool:
        point = np.array([offset, 0.0, z])
        a, b, c = (
            p[0] * q[0] + p[1] * q[1] - 0.25 * p[2] * q[2] for p, q in ((eye, eye), (eye, point), (point, point))
        )
        roots = (-b + np.array([-1.0, 1.0]) * np.sqrt(b * b - a * c)) / a if b * b >= a * c else np.zeros(0)
        heights = z + roots * eye[2]
        return bool(((roots > 0.0) & (heights > -2.0) & (heights < 0.0)).any())

    low, high = -1.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if hidden(middle) else (low, middle)
    return 1.0 + low


GAPS = 3.0 * 10.0 ** -np.arange(1.0, 16.0)
NO_DISTANCE = "a distance in space of less than 1e-9 of the extent is zero"
ARC_ERROR = 2e-7
"""Radii are told by the lengths of polylines with a tolerance of 0.0001 mm."""

TOLERANCE = 1e-3
"""More than 0.02 mm on the pages of these sweeps."""

SWEEPS = (
    Sweep(
        "balls that nearly touch",
        (80, 43),
        "how deep they are in each other",
        "radius of their common circle",
        GAPS,
        circle_of_two_balls,
        lambda gap: float(np.sqrt(gap - 0.25 * gap * gap)) if gap > 1e-8 else 0.0,
        lambda gap: ARC_ERROR,
        (1e-8, "bodies that only touch have no curve in common"),
    ),
    Sweep(
        "ball that nearly touches a plane",
        (43,),
        "depth of the ball below the plane",
        "radius of the circle in the plane",
        GAPS,
        circle_in_a_plane,
        lambda depth: float(np.sqrt(2.0 * depth - depth * depth)) if depth > ZERO_OF_EXTENT else 0.0,
        lambda depth: ARC_ERROR,
        (ZERO_OF_EXTENT, NO_DISTANCE),
    ),
    Sweep(
        "ball in a ball",
        (80,),
        "difference of the radii",
        "visible length of the inner one",
        GAPS,
        seen_of_a_ball_in_a_ball,
        lambda gap: 0.0,
        lambda gap: 1e-12,
    ),
    Sweep(
        "can seen along its axis",
        (25, 80),
        "angle to the axis",
        "visible length",
        GAPS,
        can_along_its_axis,
        lambda angle: 3.0 * np.pi + 4.0 if angle > 1e-5 else 2.0 * np.pi,
        lambda angle: np.pi + 4.0 if 1e-6 < angle < 1e-5 else 1e-5,
        (1e-5, "lines less than 0.0001 mm apart are drawn once"),
    ),
    Sweep(
        "line beside the apex of a cone",
        (72,),
        "distance of the line from the axis",
        "hidden length",
        GAPS,
        line_beside_an_apex,
        hidden_beside_an_apex,
        lambda offset: TOLERANCE,
    ),
    Sweep(
        "torus contour that gets cusps",
        (29,),
        "angle beyond that of the first cusps",
        "distance of the cusps from true ones, mm",
        GAPS,
        cusps_of_a_torus,
        lambda slant: 0.0,
        lambda slant: TOLERANCE,
    ),
    Sweep(
        "tiny oval",
        (40,),
        "radius, in a square of side 2",
        "circumference over radius",
        GAPS,
        tiny_oval,
        lambda radius: 2.0 * np.pi if radius > RESOLUTION else 0.0,
        lambda radius: 1e-3,
        (RESOLUTION, "closed branches smaller than a thousandth of the domain may be missed"),
    ),
    Sweep(
        "saddle",
        (37,),
        "level beside that of the saddle",
        "number of branches",
        GAPS,
        branches_of_a_saddle,
        lambda level: 2.0,
        lambda level: 0.0,
    ),
    Sweep(
        "branches side by side",
        (39,),
        "distance of two circles",
        "number of circles",
        GAPS[:3],
        twin_circles,
        lambda gap: 2.0,
        lambda gap: 0.0,
        (
            RESOLUTION,
            "branches nearer to each other than a thousandth of the domain are not told apart: one line says so",
        ),
    ),
)
