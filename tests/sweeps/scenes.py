"""Sweeps of where a scene is, how large it is, and from where it is seen."""

from __future__ import annotations

from functools import cache

import numpy as np
from support.drawn import drawn, plate
from sweeps.sweep import Sweep

import vectorplot as vp
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import hausdorff
from vectorplot.testing.shapes import box
from vectorplot.tolerances import COINCIDENT_MM

GAPS = 3.0 * 10.0 ** -np.arange(1.0, 16.0)
PAGE = vp.Page(220.0, 220.0, 10.0)

DOT = COINCIDENT_MM / 50.0
"""Half of what is no stroke where 8 units fill the page."""


def room(scale: float, shift: float) -> vp.Scene:
    """Boxes, a ball and a torus, as large as one says and as far off the origin."""
    place = np.eye(4)
    place[:3, :3] *= scale
    place[:3, 3] = shift
    meshes = (plate((-2, -2), (2, 2), 0.0), box((-1.5, -1.5, 0.0), (-0.5, -0.5, 1.0)), box((0, -1.2, 0), (1, 1, 0.5)))
    curved = (Sphere(0.5, (0.5, 0.2, 1.0)), Torus(0.6, 0.2, (-1.2, 0.9, 0.5)))
    items = [vp.Item(f"M{k}", mesh.transformed(place)) for k, mesh in enumerate(meshes)]
    items += [vp.Item(f"S{k}", PlacedSurface(body, scale * np.eye(3), (shift,) * 3)) for k, body in enumerate(curved)]
    return vp.Scene(tuple(items))


@cache
def strokes(scale: float, shift: float) -> list[np.ndarray]:
    """The visible lines of the room on the page."""
    eye, target = (tuple(shift + scale * x for x in p) for p in ((5.0, -7.0, 4.0), (0.0, 0.0, 0.3)))
    return list(drawn(vp.draw(room(scale, shift), vp.Camera(eye, target), page=PAGE, curves="polyline")).page)


def apart(one: list[np.ndarray], two: list[np.ndarray]) -> float:
    """How many mm two sets of strokes are apart."""
    return hausdorff(one, two, accuracy=1e-9)


def larger(scale: float) -> float:
    """How many mm a scene of some scale is drawn off the one of scale 1."""
    return apart(strokes(scale, 0.0), strokes(1.0, 0.0))


def far_off(shift: float) -> float:
    """How many mm a scene far off the origin is drawn off the one about it."""
    return apart(strokes(1.0, shift), strokes(1.0, 0.0))


@cache
def strokes_from(distance: float, parallel: bool) -> list[np.ndarray]:
    """The visible lines of the room on the page, from an eye at some distance."""
    eye = np.array([5.0, -7.0, 4.0]) / np.linalg.norm([5.0, -7.0, 4.0])
    camera = vp.Camera(tuple(distance * eye), (0, 0, 0), parallel=parallel)
    return list(drawn(vp.draw(room(1.0, 0.0), camera, page=PAGE, curves="polyline")).page)


def far_eye(nearness: float) -> float:
    """How many mm a picture from far away is off the parallel one; nearness: one over the distance."""
    return apart(strokes_from(1.0 / nearness, False), strokes_from(10.0, True))


def upright(angle: float) -> float:
    """How many mm a picture whose up vector is that angle off the line of sight is off the one where it is square to
    it, in the same plane."""
    eye, up = np.array([5.0, -7.0, 4.0]), np.array([0.0, 0.0, 1.0])
    back = eye / np.linalg.norm(eye)
    square = up - (up @ back) * back
    boxes = vp.Scene(tuple(vp.Item(f"B{k}", box((k, 0, 0), (k + 0.6, 1, 1 + k))) for k in range(2)))
    ways = (up, np.cos(angle) * back + np.sin(angle) * square / np.linalg.norm(square))
    cameras = [vp.Camera(tuple(eye), up=tuple(way.tolist())) for way in ways]
    return apart(*(list(drawn(vp.draw(boxes, camera, page=PAGE)).page) for camera in cameras))


def behind_a_corner(depth: float) -> float:
    """How much is hidden of a line whose image passes that far inside of a corner of 90 degrees."""
    half = np.sqrt(0.5)
    turn = np.array([(half, -half, 0, 0), (half, half, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)])
    card = plate((0, 0), (2, 2), 1.0).transformed(turn)
    line = vp.Item("LINE", plate((-4, depth), (4, -4), 0.0))
    drawing = vp.draw(vp.Scene((vp.Item("CARD", card), line)), vp.Camera.view("top"), page=PAGE, hidden="solid")
    return drawn(drawing).of(1).hidden.length


SWEEPS = (
    Sweep(
        "scenes of any size",
        (19,),
        "size",
        "distance from the drawing of size 1, mm",
        10.0 ** np.arange(-12.0, 13.0, 2.0),
        larger,
        lambda scale: 0.0,
        lambda scale: 1e-9,
    ),
    Sweep(
        "scenes far off the origin",
        (18,),
        "distance from the origin, in sizes of the scene",
        "distance from the drawing about the origin, mm",
        10.0 ** np.arange(0.0, 10.0),
        far_off,
        lambda shift: 0.0,
        # Coordinates that large have steps of that size, and a unit is 50 mm.
        lambda shift: max(1e-9, 4.0 * 50.0 * float(np.spacing(shift))),
    ),
    Sweep(
        "eye far away",
        (31,),
        "one over the distance of the eye",
        "distance from the parallel projection, mm",
        GAPS[1:],
        far_eye,
        lambda nearness: 0.0,
        lambda nearness: 150.0 * nearness + 0.02,
    ),
    Sweep(
        "up vector near the line of sight",
        (30,),
        "angle between them",
        "distance from the drawing with an upright vector, mm",
        GAPS[:9],
        upright,
        lambda angle: 0.0,
        # A vector so near the line of sight has as many digits less.
        lambda angle: 1e-9 + 1e-12 / angle,
    ),
    Sweep(
        "line behind a corner",
        (10,),
        "how far inside of the corner it passes",
        "hidden length",
        GAPS[:12],
        behind_a_corner,
        lambda depth: 2.0 * depth if depth > DOT else 0.0,
        lambda depth: 1e-12,
        (DOT, "the hidden part is shorter than 0.0001 mm, and no stroke"),
    ),
)
