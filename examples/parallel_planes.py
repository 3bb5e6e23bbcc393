"""Light through a plate of glass: what comes out runs on in its old direction, beside its old line.

Rays fall in at angles of 0, 15, ... 60 degrees. Inside, sin α = c sin β holds; along the plate each is shifted by a
(tan α - tan β). Dashed lines are the rays as they would go on without the glass, red the shifts, ochre and blue the
angles α and β of the last ray. Source: Glaeser, section 6.6, figure 11.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, GREY, INK, RED, SAND, SKY, dashes, heads, layer, polygons, strokes

import vectorplot as vp
from vectorplot.effects import angle_of_refraction, inverse_refraction, plate_shift, refracted

C, THICKNESS = 1.5, 34.0
TOP, BOTTOM = 68.0, 34.0
"""The faces of the plate on the page, in mm."""


def wedge(corner, one: float, two: float, radius: float) -> np.ndarray:
    """A piece of a disc between two directions."""
    turn = np.linspace(one, two, 25)
    return np.vstack([corner, corner + radius * np.column_stack([np.cos(turn), np.sin(turn)])])


def main(folder: Path) -> None:
    alpha = np.radians(np.arange(0, 75, 15))
    beta = angle_of_refraction(alpha, C)
    enter = np.column_stack([14.0 + 24.0 * np.arange(len(alpha)), np.full(len(alpha), TOP)])
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

    plate = np.array([(3, BOTTOM), (177, BOTTOM), (177, TOP), (3, TOP)])
    up, down, deep = np.pi / 2, -np.pi / 2, 30.0
    angles = [wedge(enter[4], up, up + alpha[4], 11.0), wedge(enter[4], down, down + beta[4], 13.0)]
    ends = leave + deep / np.cos(alpha)[:, None] * along * np.cos(alpha)[:, None]
    starts = enter - deep * along
    rays = np.concatenate([np.stack([starts, enter], 1), np.stack([enter, leave], 1), np.stack([leave, ends], 1)])
    on = straight + (deep * along) * (straight[:, 0] < 150)[:, None]
    guides = [part for a, b in zip(enter[1:], on[1:], strict=True) for part in dashes(a, b)]
    upright = [part for x, y in enter for part in dashes((x, y + 15), (x, y - 18), 2.4)]
    shifts = np.stack([leave[1:], straight[1:]], axis=1) - (0, 1.2)
    layers = (
        layer("plate", polygons([plate], SKY)),
        layer("angles", polygons(angles, [SAND, "#a9c8e6"])),
        layer("faces", strokes([plate[:2], plate[2:]]), INK, 0.35),
        layer("guides", strokes([*guides, *upright]), GREY, 0.25),
        layer("shifts", strokes(shifts), RED, 0.7),
        layer("rays", strokes(rays), BLUE, 0.5),
        layer("heads", heads(np.concatenate([starts, leave]), np.concatenate([enter, ends]), BLUE, 3.4)),
    )
    vp.save(vp.Drawing(180, 104, layers, title="Plate"), folder / "parallel_planes.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
