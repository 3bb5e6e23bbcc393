"""A table seen by the eye, and by its lamp.

A lamp is a camera without twist: what it sees is lit, and what it does not see lies in shadow. So one code serves both.
Source: Glaeser, section 2.4, figure 8.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import CoordinateSystem
from vectorplot.textbook import changed_coordinates

DATA = Path(__file__).resolve().parent.parent / "data"


def main(folder: Path) -> None:
    table = vp.read(DATA / "table.scene")
    (lamp,) = table.lights
    assert table.camera is not None
    page = vp.Page(140, 110, 6)
    seen_by_lamp = vp.Camera(eye=lamp.position, target=table.camera.target)
    vp.save(vp.draw(table, page=page), folder / "light_system_eye.svg")
    vp.save(vp.draw(table, seen_by_lamp, page=page), folder / "light_system_lamp.svg")

    light = CoordinateSystem.of_light(lamp.position, table.camera.target)
    screen = CoordinateSystem.of_image(table.camera)
    lit = light.from_world(table.vertices)
    assert np.allclose(CoordinateSystem.of_image(seen_by_lamp).from_world(table.vertices), lit)
    assert np.allclose(changed_coordinates(screen.from_world(table.vertices), screen, light), lit)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
