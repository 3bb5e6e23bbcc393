"""A terrain through heights on a grid, with level lines, as a landscape with its outlines and as a map with heights.

On the map the heights stand on the heavier lines, which end before them. Akima's splines make no hills where there are
none: the lake stays flat. Source: Glaeser, section 9.5, example 1.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import CubicSpline
from vectorplot.surfaces import landscape
from vectorplot.testing import curves_in_space

HEIGHTS = np.array(
    [
        [3, 4, 6, 7, 5, 4, 3, 2, 2],
        [3, 5, 9, 8, 6, 4, 3, 2, 2],
        [2, 4, 6, 7, 5, 3, 2, 2, 3],
        [2, 2, 3, 5, 3, 1, 1, 2, 4],
        [2, 1, 1, 1, 1, 1, 1, 3, 6],
        [2, 1, 1, 1, 1, 1, 2, 5, 8],
        [3, 2, 1, 1, 1, 2, 4, 6, 7],
        [4, 3, 2, 2, 2, 3, 4, 5, 5],
    ],
    dtype=float,
)


def numbered(terrain) -> vp.Drawing:
    """The terrain from above, with heights on every second level line."""
    fine = vp.Section((0, 0, 1), tuple(np.arange(1.25, 9.0, 0.5)))
    heavy = vp.Section((0, 0, 1), tuple(np.arange(1.5, 9.0)), index=True, numbered=True)
    item = vp.Item("TERRAIN", terrain, curves=vp.SurfaceLines(sections=(fine, heavy)))
    above = vp.Camera((14, 16, 60), target=(14, 16, 0), up=(0, 1, 0), parallel=True)
    drawing = vp.draw(vp.Scene((item,), title="Map"), above, page=vp.Page(110, 122, 5), pens="section=0.13,index=0.3")
    assert any(layer.name == "label" for layer in drawing.layers), "some lines are long enough for a number"
    return drawing


def main(folder: Path) -> None:
    terrain = landscape(HEIGHTS, (0, 28), (0, 32))
    levels = vp.SurfaceLines(sections=(vp.Section((0, 0, 1), tuple(np.arange(1.25, 9.0, 0.5))),))
    scene = vp.Scene((vp.Item("TERRAIN", terrain, curves=levels),), title="Landscape")
    camera = vp.Camera((-30, -28, 34), target=(14, 16, 2), fov_deg=34)
    drawing = vp.draw(scene, camera, page=vp.Page(170, 110, 6))
    vp.save(drawing, folder / "landscape.svg")
    vp.save(numbered(terrain), folder / "landscape_numbers.svg")

    lines = np.concatenate(curves_in_space(drawing, kind="section"))
    steps = 2 * lines[:, 2] + 0.5
    assert np.abs(steps - np.round(steps)).max() < 1e-9, "every point has the height of its line"
    u, v = np.meshgrid(np.linspace(4, 5, 9), np.linspace(2, 3, 9))
    assert np.allclose(terrain.points(u, v)[..., 2], 1.0), "the lake is flat"
    waves = landscape(HEIGHTS, (0, 28), (0, 32), CubicSpline()).points(u, v)[..., 2]
    assert np.ptp(waves) > 0.01, "with continuous curvature it could not be"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
