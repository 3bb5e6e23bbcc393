"""World and screen, the planes that clip what one sees, and the angle of the field of vision.

First the image plane through the target, upright on the principal ray, with the axes of the world and those of the
screen. Then the neutral plane through the eye, the near and the far plane: the rod reaches behind the near plane, and
only its red part is drawn. Last three fields of vision from one eye. Source: Glaeser, sections 2.1 to 2.3, figures 1,
4 and 5.
"""

import sys
from pathlib import Path

import diagrams as d
import numpy as np
from diagrams import line, outline, sheet

import vectorplot as vp
from vectorplot.geometry import box, placed, prism

SEEN = vp.Camera(eye=(-5.5, -4.5, 4.6), target=(0, 0, 0.9), fov_deg=24)
ASIDE = vp.Camera(eye=(7, -19, 10), target=(-2.4, -1.6, 1.9), fov_deg=30)
EYE, TARGET = np.array(SEEN.eye), np.array(SEEN.target)
RIGHT, UP, BACK = map(np.array, SEEN.axes)
LAMPS = tuple(vp.Light(way, parallel=True, intensity=0.6) for way in ((2, -5, 6), ASIDE.eye))
HOUSE = prism([(-0.9, -0.7, 0), (0.9, -0.7, 0), (0.9, -0.7, 1.1), (0, -0.7, 1.9), (-0.9, -0.7, 1.1)], (0, 1.4, 0))
GLASS = vp.Material("transparent", 0.55)
WIDTHS = {d.INK: 0.35, d.GREY: 0.35, d.OCHRE: 0.35, d.RED: 0.6, d.BLUE: 0.25}


def frame(middle, half: float, wide: float = 1.4) -> np.ndarray:
    """(4,3) the corners of a picture about a point of the principal ray."""
    return np.array([middle + half * (s * wide * RIGHT + t * UP) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def shown(folder: Path, name: str, lines, planes, arrows, body=HOUSE) -> None:
    """Save a picture of a body with lines, planes of glass, and arrows."""
    sheets = [sheet(f"PLANE{k}", corners, colour, material=GLASS) for k, (corners, colour) in enumerate(planes)]
    solids = (vp.Item("BODY", body, "#e8d3a4"),)
    scene = vp.Scene((vp.Item("BODY", body, d.INK), *lines), title=name.replace("_", " "))
    drawing = d.drawn(scene, ASIDE, vp.Page(150, 104, 5), WIDTHS)
    painted = vp.Scene((*solids, *sheets), LAMPS)
    drawing = d.tinted(drawing, painted, ASIDE, shadows="none", flat=tuple(item.name for item in sheets))
    for colour, ways in arrows.items():
        drawing = d.with_arrows(drawing, *zip(*ways, strict=True), colour, 3.2)
    vp.save(d.with_dots(drawing, [EYE], d.OCHRE, 1.8), folder / f"viewing_pyramid_{name}.svg")


def main(folder: Path) -> None:
    picture, ray = frame(TARGET, 1.9), line("RAY", EYE, TARGET, d.OCHRE)
    world = [(np.zeros(3), end) for end in np.diag([2.6, 2.6, 2.9])]
    screen = [(TARGET, TARGET + 2.3 * way) for way in (RIGHT, UP, BACK)]
    lines = [ray, *outline("PICTURE", picture, d.BLUE), line("PLUMB", EYE, EYE * (1, 1, 0), d.GREY)]
    lines += [line(f"W{k}", a, b, d.INK) for k, (a, b) in enumerate(world)]
    lines += [line(f"S{k}", a, b, d.RED) for k, (a, b) in enumerate(screen)]
    shown(folder, "world_and_screen", lines, [(picture, d.SKY)], {d.INK: world, d.RED: screen})
    assert np.allclose(BACK, (EYE - TARGET) / np.linalg.norm(EYE - TARGET)), "back points from the target to the eye"

    slope, far = np.tan(np.radians(SEEN.fov_deg / 2)), np.linalg.norm(EYE - TARGET) + 3.0
    depths = {"NEUTRAL": (0.0, d.SAND), "NEAR": (2.2, d.ROSE), "FAR": (far, d.SKY)}
    planes = [(frame(EYE - t * BACK, max(slope * t, 1.25)), colour) for t, colour in depths.values()]
    rod = np.array([EYE - 4.6 * BACK - 0.35 * UP, EYE + 1.4 * BACK - 1.0 * RIGHT])
    depth = (EYE - rod) @ BACK
    cut = rod[0] + (rod[1] - rod[0]) * (depth[0] - 2.2) / (depth[0] - depth[1])
    assert np.isclose((EYE - cut) @ BACK, 2.2), "the visible part ends in the near plane"
    lines = [
        line("ROD", rod[0], cut, d.RED),
        line("LOST", cut, rod[1], d.GREY),
        line("RAY", EYE, EYE - far * BACK, d.OCHRE),
    ]
    lines += [side for k, (corners, _) in enumerate(planes) for side in outline(f"P{k}", corners, d.INK)]
    lines += [line(f"EDGE{k}", EYE, corner, d.BLUE) for k, corner in enumerate(planes[2][0])]
    shown(folder, "clipping_planes", lines, planes, {d.RED: [(rod[1], cut)]})

    fields = {10: (d.RED, d.ROSE), 24: (d.OCHRE, d.SAND), 45: (d.BLUE, d.SKY)}
    lines, planes, size = [ray], [], np.linalg.norm(EYE - TARGET)
    for angle, (ink, tint) in fields.items():
        corners = frame(TARGET, np.tan(np.radians(angle / 2)) * size)
        planes.append((corners, tint))
        lines += [
            *outline(f"F{angle}", corners, ink),
            *(line(f"E{angle} {k}", EYE, c, ink) for k, c in enumerate(corners)),
        ]
    tile = placed(box((0.01, 0.01, 0.01)), (1, 0, 0, TARGET[0], 0, 1, 0, TARGET[1], 0, 0, 1, TARGET[2]))
    shown(folder, "field_of_vision", lines, planes[::-1], {d.OCHRE: [(EYE, TARGET)]}, tile)
    assert np.isclose(SEEN.picture_height, 2 * np.tan(np.radians(SEEN.fov_deg / 2)) * size)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
