"""Conics on solids: the same oblique planes cut cones, a can and a dome in ellipses, parabolas, hyperbolas and circles.

On cones and cylinders isophotes of the sun are straight: along a ruling nothing turns. All lines are in closed form.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.scene import even_cosines, even_sections, with_lines
from vectorplot.surfaces import Capped, Cone, Cylinder, Frustum, Sphere
from vectorplot.testing import curves_in_space

SUN = vp.Light((-3, -2, 4), parallel=True)
NORMAL = (0.55, -0.25, 0.8)


def solids() -> vp.Scene:
    """Five bodies on a ground that is not drawn."""
    shapes = {
        "cone": Capped(Cone.standing(1.6, 3.6, (0.0, 0.0, 0.0))),
        "can": Capped(Cylinder(1.0, 0.0, 2.4, (3.3, 1.2, 0.0))),
        "dome": Capped(Sphere(1.5, (2.7, -2.2, 0.0)), (0.0, 0.5 * np.pi)),
        "pot": Capped(Frustum(0.7, 1.2, 1.8, (-2.6, -2.0, 0.0))),
        "hat": Capped(Cone.standing(1.3, 1.2, (-2.9, 1.6, 0.0))),
    }
    return vp.Scene(tuple(vp.Item(name, shape) for name, shape in shapes.items()), lights=(SUN,))


def main(folder: Path) -> None:
    scene = solids()
    planes = even_sections(scene, NORMAL, 28)
    pictures = {
        "sections": with_lines(scene, sections=(planes,)),
        "isophotes": with_lines(scene, isophotes=even_cosines(19)),
    }
    camera = vp.Camera(eye=(4, -17, 10), target=(0, 0, 1), fov_deg=30)
    drawn = {name: vp.draw(shown, camera, page=vp.Page(150, 100, 5)) for name, shown in pictures.items()}
    for name, drawing in drawn.items():
        vp.save(drawing, folder / f"conics_on_solids_{name}.svg")

    for curve in curves_in_space(drawn["sections"], kind="section"):
        heights = curve @ np.array(planes.normal)
        assert np.abs(np.array(planes.offsets) - heights[0]).min() < 1e-9 and np.ptp(heights) < 1e-9, "in one plane"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
