"""A surface in the colours of its heights, with a colour bar and a box with ticks."""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.scene import BoxAxes, Colouring


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 1.3 * np.sin(1.5 * x) * np.cos(1.2 * y) * np.exp(-(x * x + y * y) / 9.0)


def main(folder: Path) -> None:
    waves = vp.graph(height, (-3, 3), (-3, 3))
    sun = vp.Light((-1.0, -2.0, 3.0), parallel=True)
    chart = vp.Scene((waves,), lights=(sun,), colouring=Colouring("z", steps=16), box=BoxAxes(), title="A chart")
    picture = vp.render(chart, vp.Camera((9, -14, 9), fov_deg=24), size=(1280, 840))
    vp.save(picture, folder / "colour_map.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
