"""One town through a wide, a normal and a tele lens: 24, 50 and 200 mm.

The eye steps back as the lens grows longer, so that the church keeps its size; only the perspective changes.
Source: Glaeser, section 2.2, figure 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp

DATA = Path(__file__).resolve().parent.parent / "data"
TARGET = np.array([0.0, 0.0, 4.0])
TOWARDS = np.array([0.55, -0.75, 0.38])
HEIGHT = 44.0


def main(folder: Path) -> None:
    town = vp.read(DATA / "town.scene")
    degrees = []
    for number, focal_length_mm in enumerate((24, 50, 200)):
        distance = HEIGHT / 2.0 * focal_length_mm / 12.0
        eye = TARGET + distance * TOWARDS / np.linalg.norm(TOWARDS)
        camera = vp.Camera.from_focal_length(focal_length_mm, tuple(eye), tuple(TARGET))
        drawing = vp.draw(town, camera, page=vp.Page(150, 100, 0), fit=False)
        vp.save(drawing, folder / f"lenses_{number + 1}.svg")
        degrees.append(camera.fov_deg)
        assert np.isclose(camera.picture_height, HEIGHT)
    assert np.allclose(degrees, [53.130, 26.991, 6.867], atol=1e-3)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
