"""The swimming pool from a second place, higher up: the floor seems raised, and less so the steeper one looks.

Where its points are seen is known in closed form: a ray from the eye is bent where it meets the water. Looking
straight down the water seems to have the depth a / c. Source: Glaeser, section 6.6, figure 12.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind
from vectorplot.effects import seen_in_surface

POOL = vp.read(Path(__file__).resolve().parent.parent / "data" / "pool.scene")
EYES = {"low": np.array([-9.0, -15.0, 17.0]), "high": np.array([3.0, -7.0, 24.0])}
DEPTH, LEVEL, C = 2.1, -0.3, 1.333
"""Of the water: how deep it is, how high, and its constant."""


def on_page(drawing: vp.Drawing, points: np.ndarray) -> np.ndarray:
    """Where points of space are on the page."""
    flat = np.column_stack([points, np.ones(len(points))]) @ drawing.page_from_world.T
    return flat[:, :2] / flat[:, 3:]


def main(folder: Path) -> None:
    tiles = np.array([(x, y, LEVEL - DEPTH) for x in np.arange(1.5, 11, 1.5) for y in (1.5, 3.0, 4.5)])
    raised = {}
    for name, eye in EYES.items():
        camera = vp.Camera(eye=tuple(eye), target=(6, 2.6, -1), fov_deg=26)
        drawing = vp.paint(POOL, camera, page=vp.Page(110, 90, 3), tolerance_mm=0.3)
        if name == "high":
            vp.save(drawing, folder / "swimming_pool.svg")

        (fills,) = drawing.layers[0].fills
        under = fills.take(np.flatnonzero((fills.kind == FillKind.GLASS) | (fills.kind == FillKind.FACE)))
        seen = seen_in_surface(eye, tiles, (0, 0, 1), (0, 0, LEVEL), C)
        assert np.allclose(seen[:, 2], LEVEL)
        gap = np.linalg.norm(on_page(drawing, seen)[:, None] - under.points, axis=2).min(axis=1)
        assert np.median(gap) < 1e-6, "corners of tiles are where the closed form says"
        # How high the floor seems to be right below the places where one sees it.
        towards = seen - eye
        apparent = (np.hypot(*(tiles - seen)[:, :2].T) / np.hypot(*towards[:, :2].T)) * -towards[:, 2]
        raised[name] = float(np.median(apparent))
    assert raised["low"] < raised["high"] < DEPTH / C < DEPTH

    above = seen_in_surface((6.0, 3.0, 40.0), [(6.001, 3.0, LEVEL - DEPTH)], (0, 0, 1), (0, 0, LEVEL), C)[0]
    straight_down = (6.001 - above[0]) / (above[0] - 6.0) * (40.0 - LEVEL)
    assert np.isclose(straight_down, DEPTH / C, rtol=1e-6)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
