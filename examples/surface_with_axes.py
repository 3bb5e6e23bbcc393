"""A surface over the plane with coordinate axes, ticks and names; hidden lines of the axes are hidden exactly.

The axes are curves in space and pierce the surface where they must; their numbers keep off the lines.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp

REACH = 3.0


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A hill beside a hollow."""
    return 1.8 * np.exp(-((x - 0.9) ** 2) - y**2) - 1.2 * np.exp(-((x + 1.1) ** 2) - (y - 0.4) ** 2)


def main(folder: Path) -> None:
    ground = np.linspace(-REACH, REACH, 49)
    x, y = np.meshgrid(ground, ground, indexing="ij")
    peak = vp.Label("peak", (0.9, 0.0, float(height(np.array(0.9), np.array(0.0)))), mark="dot")
    scene = vp.Scene((vp.surface(x, y, height(x, y)),), labels=(peak,))
    camera = vp.Camera((9.0, -12.0, 8.0), target=(0.0, 0.0, 0.2))
    drawing = vp.draw([scene, vp.axes((4.2, 4.2, 3.0), ticks=1.0)], camera, page=vp.Page(150, 120), title="z = f(x, y)")
    vp.save(drawing, folder / "surface_with_axes.svg")
    (letters,) = [p for layer in drawing.layers if layer.name == "label" for p in layer.strokes if (p.item < 0).any()]
    assert (letters.hidden_by == 0).all(), "labels of hidden points are left out"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
