"""Sweeps of scenes of polyhedra."""

from __future__ import annotations

import numpy as np
from support.drawn import EVERY_EDGE, Drawn, drawn, plate
from sweeps.sweep import Sweep

import vectorplot as vp
from vectorplot.testing.shapes import box, scene_of
from vectorplot.tolerances import ZERO_OF_EXTENT

GAPS = 3.0 * 10.0 ** -np.arange(1.0, 16.0)
SLANTED = vp.Camera((5.0, -7.0, 4.0), (0.0, 0.0, 0.0))
ABOVE = vp.Camera((0.3, -0.4, 8.0), (0.0, 0.0, 0.0))

NO_DISTANCE = "a distance in space of less than 1e-9 of the extent is zero"

NO_LENGTH = 1e-6
"""About 0.0001 mm on the pages of these sweeps."""
NOT_DRAWN = "strokes shorter than 0.0001 mm are not drawn"
DRAWN_ONCE = "lines less than 0.0001 mm apart are drawn once"


def seen_behind_a_plate(gap: float) -> float:
    """The visible length of a plate's four sides of length 1, a larger plate being nearer to the eye by a gap."""
    scene = scene_of(FRONT=plate((-1, -1), (1, 1), gap), BACK=plate((-0.5, -0.5), (0.5, 0.5), 0.0))
    return drawn(vp.draw(scene, ABOVE)).of(1).visible.length


def end_at_a_crossing(sine: float) -> float:
    """How much of an edge from x = -1 to x = 1 is seen, which another edge crosses at x = 0, under an angle."""
    rise = sine / np.sqrt(1.0 - sine * sine)
    front = vp.Mesh.from_polygons([(-1, -rise, 1), (1, rise, 1), (1, 1, 1), (-1, 1, 1)], [[0, 1, 2, 3]])
    scene = scene_of(FRONT=front, BACK=plate((-1, -1), (1, 0), 0.0))
    lines = drawn(vp.draw(scene, vp.Camera((0, 0, 10), parallel=True, up=(0, 1, 0)))).of(1).visible
    return lines.where((np.abs(lines.world[:, :, 1]) < 1e-12).all(axis=1)).length


def seen_through_a_slit(width: float) -> float:
    """How much of a line is seen through a slit between two plates, in parts of the width of the slit."""
    left, right = plate((-1, -1), (-0.5 * width, 1), 1.0), plate((0.5 * width, -1), (1, 1), 1.0)
    scene = scene_of(LEFT=left, RIGHT=right, BACK=plate((-0.9, -0.9), (0.9, 0.0), 0.0))
    from_above = vp.Camera((0, 0, 10), parallel=True, up=(0, 1, 0))
    lines = drawn(vp.draw(scene, from_above, shortest_mm=0.0)).of(2).visible
    return lines.where((np.abs(lines.world[:, :, 1]) < 1e-12).all(axis=1)).length


def foot_of_a_box(lift: float) -> float:
    """The visible length of the foot of a box above a table, or sunk into it, whatever kind of line it is."""
    scene = scene_of(TABLE=plate((-2, -2), (2, 2), 0.0), BOX=box((-0.5, -0.5, lift), (0.5, 0.5, 1.0)))
    lines = drawn(vp.draw(scene, SLANTED, lines=EVERY_EDGE)).visible
    return foot_length(lines, abs(lift))


def twins_beside_each_other(shift: float) -> float:
    """The length on the page, in parts of a side, of two squares of which one is shifted along their common side."""
    scene = scene_of(LEFT=plate((0, 0), (1, 1), 0.0), RIGHT=plate((1, shift), (2, 1 + shift), 0.0))
    drawing = vp.draw(scene, vp.Camera.view("top", (1, 0.5, 0), 5), page=vp.Page(220, 220, 10))
    return drawn(drawing).length


def sliver_in_front(width: float) -> float:
    """How much of an edge of length 2 is seen behind a triangle of length 2 and some width, in parts of the width."""
    sliver = vp.Mesh.from_triangles([(-0.5 * width, -1, 1), (0.5 * width, -1, 1), (0, 1, 1)], [[0, 1, 2]])
    scene = scene_of(FRONT=sliver, BACK=plate((-1, -0.5), (1, 0.0), 0.0))
    lines = drawn(vp.draw(scene, vp.Camera((0, 0, 10), parallel=True, up=(0, 1, 0)), hidden="solid")).of(1)
    lines = lines.where((np.abs(lines.world[:, :, 1]) < 1e-12).all(axis=1))
    return lines.hidden.length


def turned_plate(sine: float) -> float:
    """How much is hidden of a line of length 2 straight behind a square of side 2 that is seen nearly edge-on."""
    tilt = np.arcsin(sine)
    front = plate((-1, -1), (1, 1), 0.0)
    turn = np.eye(4)
    turn[1:3, 1:3] = [[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]]
    wall = vp.Mesh.from_polygons([(0, 2, -1), (0.5, 2, -1), (0.5, 2, 1), (0, 2, 1)], [[0, 1, 2, 3]])
    scene = scene_of(PLATE=front.transformed(turn), WALL=wall)
    lines = drawn(vp.draw(scene, vp.Camera((0, -10, 0), parallel=True), hidden="solid")).of(1)
    at = lines.where((np.abs(lines.world[:, :, 0]) < 1e-12).all(axis=1))
    return at.hidden.length


def depth_of_piercing(depth: float) -> float:
    """The visible length of everything in the plane in which one cube stands in another one, or on it."""
    scene = scene_of(LOW=box((-1, -1, -1), (1, 1, 0)), HIGH=box((-0.5, -0.5, -depth), (0.5, 0.5, 1)))
    lines = drawn(vp.draw(scene, SLANTED, lines=EVERY_EDGE)).visible
    return foot_length(lines, depth)


def foot_length(lines: Drawn, height: float) -> float:
    """The length of lines about the origin that are no higher or lower than some height, but for rounding."""
    low = (np.abs(lines.world[:, :, 2]) <= 1.001 * height + 1e-13).all(axis=1)
    inner = (np.abs(lines.world[:, :, :2]) < 0.9).all(axis=(1, 2))
    return lines.where(low & inner).length


def bars_on_each_other(gap: float) -> float:
    """The visible length of three bars, each above the next one by a gap: the last one above the first."""
    ends = [(np.cos(t), np.sin(t)) for t in np.linspace(0.0, 2.0 * np.pi, 4)[:3]]
    bars = {}
    for k in range(3):
        along, across = np.array(ends[k]), np.array([-ends[k][1], ends[k][0]])
        middle = 0.4 * across
        corners = [middle + s * along + t * across for s, t in ((-1, -0.1), (1, -0.1), (1, 0.1), (-1, 0.1))]
        heights = [-0.5 * gap, 0.5 * gap, 0.5 * gap, -0.5 * gap]
        bars[f"B{k}"] = vp.Mesh.from_polygons([(*c, h) for c, h in zip(corners, heights, strict=True)], [[0, 1, 2, 3]])
    camera = vp.Camera((0, 0, 10), parallel=True, up=(0, 1, 0))
    lines = drawn(vp.draw(scene_of(**bars), camera)).visible.world[..., :2]
    return float(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum())


# Three bars of 2 by 0.2; each crosses another one at 60 degrees and hides of its two sides what it is wide.
_BARS = 3.0 * (2.0 * 2.2 - 2.0 * 0.2 / np.sin(np.pi / 3.0))

SWEEPS = (
    Sweep(
        "gap between two plates",
        (24, 6),
        "gap",
        "visible length of the plate behind",
        GAPS,
        seen_behind_a_plate,
        lambda gap: 0.0 if gap > ZERO_OF_EXTENT else 4.0,
        lambda gap: 1e-12,
        (ZERO_OF_EXTENT, NO_DISTANCE),
    ),
    Sweep(
        "angle between crossing edges",
        (23,),
        "sine of the angle",
        "visible part of an edge that another one crosses in its middle",
        GAPS,
        end_at_a_crossing,
        lambda sine: 1.0 if sine > NO_LENGTH else 0.0,
        lambda sine: max(1e-12, 1e-15 / sine) if sine > NO_LENGTH else 1e-12,
        (NO_LENGTH, DRAWN_ONCE),
    ),
    Sweep(
        "width of a slit",
        (11,),
        "width",
        "length of a line that is seen through it",
        GAPS,
        seen_through_a_slit,
        lambda width: width if width > NO_LENGTH else 0.0,
        lambda width: 1e-13,
        (NO_LENGTH, NOT_DRAWN),
    ),
    Sweep(
        "width of a sliver",
        (17,),
        "width",
        "length of a line that is hidden by it",
        GAPS,
        sliver_in_front,
        lambda width: 0.5 * width if width > NO_LENGTH else 0.0,
        lambda width: 1e-13,
        (NO_LENGTH, NOT_DRAWN),
    ),
    Sweep(
        "plate seen edge-on",
        (1,),
        "sine of the angle to the sight lines",
        "length of a line that is hidden by it",
        GAPS,
        turned_plate,
        lambda sine: 2.0 * sine if sine > NO_LENGTH else 0.0,
        lambda sine: 1e-12,
        (NO_LENGTH, NOT_DRAWN),
    ),
    Sweep(
        "box above a table",
        (7,),
        "height",
        "visible length of its foot",
        GAPS,
        foot_of_a_box,
        lambda lift: 2.0,
        lambda lift: 1e-12,
    ),
    Sweep(
        "box sunk into another one",
        (21,),
        "depth",
        "visible length of the line where it goes in",
        GAPS,
        depth_of_piercing,
        lambda depth: 2.0,
        lambda depth: 1e-12,
    ),
    Sweep(
        "sides that nearly coincide",
        (8,),
        "shift",
        "length of what is drawn",
        GAPS,
        twins_beside_each_other,
        lambda shift: 7.0 + (shift if shift > NO_LENGTH else 0.0),
        lambda shift: 1e-12,
        (NO_LENGTH, DRAWN_ONCE),
    ),
    Sweep(
        "three bars, each over the next",
        (20,),
        "gap where they cross",
        "visible length",
        GAPS,
        bars_on_each_other,
        lambda gap: _BARS if gap > ZERO_OF_EXTENT else 13.2,
        lambda gap: 1e-12,
        (ZERO_OF_EXTENT, NO_DISTANCE),
    ),
)
