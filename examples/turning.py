"""A card turned about an axis in space, twenty steps of 18 degrees.

The axis is neither parallel to a coordinate axis nor through the origin. Twenty turns of eighteen degrees bring the
card back to where it was. Source: Glaeser, section 1.6, figure 5.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import axis_frame, box, revolution, rotated_about_line, translated

FOOT, AXIS = np.array([1.0, 2.0, 0.5]), np.array([0.35, -0.2, 1.0])
STEPS = 20


def main(folder: Path) -> None:
    card = box((2.6, 0.12, 1.7))
    start = translated(card.vertices, (1.1, -0.06, -0.85)) @ axis_frame(AXIS) + FOOT
    steps = [rotated_about_line(start, FOOT, AXIS, angle) for angle in 2 * np.pi * np.arange(STEPS) / STEPS]
    rod = revolution([(0.07, 0, -2.6), (0.07, 0, 2.6)], 16)
    items = [vp.Item("AXIS", replace(rod, vertices=rod.vertices @ axis_frame(AXIS) + FOOT))]
    items += [vp.Item(f"CARD{k}", replace(card, vertices=points)) for k, points in enumerate(steps)]
    camera = vp.Camera(eye=(9, -16, 14), target=tuple(FOOT), fov_deg=24)
    drawing = vp.draw(vp.Scene(tuple(items), title="Turning"), camera, page=vp.Page(130, 110, 6))
    vp.save(drawing, folder / "turning.svg")

    assert np.allclose(rotated_about_line(steps[-1], FOOT, AXIS, 2 * np.pi / STEPS), start)
    unit = AXIS / np.linalg.norm(AXIS)
    radii = [np.linalg.norm(np.cross(points - FOOT, unit), axis=1) for points in steps]
    assert np.allclose(radii, radii[0]), "every corner keeps its distance from the axis"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
