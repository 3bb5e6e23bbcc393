"""Light through a plate of glass: what comes out runs on in its old direction, beside its old line.

Rays fall in at angles of 0, 15, ... 60 degrees. Inside, sin α = c sin β holds; along the plate each is shifted by a
(tan α - tan β). Thin lines are the rays as they would go on without the glass. Source: Glaeser, section 6.6, figure
11.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.effects import angle_of_refraction, inverse_refraction, plate_shift, refracted
from vectorplot.shading import palette

C, THICKNESS = 1.5, 24.0
TOP, BOTTOM = 52.0, 28.0
"""The faces of the plate on the page, in mm."""


def lines(starts: np.ndarray, ends: np.ndarray, colour: np.ndarray) -> Fills:
    """Lines of one colour."""
    points = np.stack([starts, ends], axis=1).reshape(-1, 2)
    colours = np.tile(colour, (len(starts), 1))
    return Fills.flat(points, 2 * np.arange(len(starts) + 1), colours, kind=FillKind.EDGE)


def main(folder: Path) -> None:
    alpha = np.radians(np.arange(0, 75, 15))
    beta = angle_of_refraction(alpha, C)
    enter = np.column_stack([20.0 + 15.0 * np.arange(len(alpha)), np.full(len(alpha), TOP)])
    along = np.column_stack([np.sin(alpha), -np.cos(alpha)])
    leave = np.column_stack([enter[:, 0] + THICKNESS * np.tan(beta), np.full(len(alpha), BOTTOM)])
    straight = np.column_stack([enter[:, 0] + THICKNESS * np.tan(alpha), np.full(len(alpha), BOTTOM)])

    inside, total = refracted(np.insert(along, 1, 0, axis=1), (0, 0, -1), C)
    outside, _ = refracted(inside, (0, 0, -1), 1 / C)
    assert np.allclose(np.sin(alpha), C * np.sin(beta)) and not total.any()
    assert np.allclose(inside[:, [0, 2]], np.column_stack([np.sin(beta), -np.cos(beta)]), atol=1e-12)
    assert np.allclose(outside[:, [0, 2]], along, atol=1e-12), "parallel to what came in"
    assert np.allclose(straight[:, 0] - leave[:, 0], plate_shift(alpha, THICKNESS, C), atol=1e-12)
    angle = float(inverse_refraction(7.0, 5.0, 2.0, 4 / 3))
    below = float(angle_of_refraction(angle, 4 / 3))
    assert abs(3.0 * np.tan(angle) + 2.0 * np.tan(below) - 7.0) < 1e-12, "the ray that reaches the eye is found too"
    assert np.allclose((angle, below), (1.05408375667294, 0.710332591269137), atol=1e-12)

    plate = Fills.flat(
        np.array([(4, BOTTOM), (146, BOTTOM), (146, TOP), (4, TOP)]), np.array([0, 4]), palette("cyan")[-1:]
    )
    blue, gray = palette("blue")[6], palette("gray")[18]
    rays = (lines(enter - 18 * along, enter, blue), lines(enter, leave, blue), lines(leave, leave + 18 * along, blue))
    guides = Fills.joined(lines(enter, straight, gray), lines(straight, straight + 18 * along, gray))
    inked = Fills.joined(*rays)
    drawing = vp.Drawing(
        150,
        76,
        (vp.Layer("plate", vp.Pen(0.13), (plate, guides)), vp.Layer("rays", vp.Pen(0.4), (inked,))),
        title="Plate",
    )
    vp.save(drawing, folder / "parallel_planes.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
