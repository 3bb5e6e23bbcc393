"""Two roads up a hill, nowhere steeper than seven degrees but in their bends: with few bends, and with many.

The legs bear to the left of the steepest way up and to its right in turn, with one slope; between them are arcs of
circles of the plan. Source: Glaeser, section 9.5, example 1.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.scene import Serpentine, level_sections, round_heights, terrain_mesh
from vectorplot.surfaces import terrain
from vectorplot.testing import curves_in_space

SLOPE_DEG, RADIUS = 7.0, 0.12
SLOPES = ((2.2, 0.5), (3.4, 5.4), 0.7), ((9.0, 0.5), (7.6, 4.9), 4.0)


def main(folder: Path) -> None:
    x, y = np.meshgrid(np.linspace(0, 12, 61), np.linspace(0, 8, 41), indexing="ij")
    heights = 2.4 * np.exp(-(((y - 7) / 4) ** 2)) + 0.25 * np.sin(0.9 * x) + 0.1 * np.sin(1.7 * x + 1.1 * y)
    land = terrain(heights, x=(0, 12), y=(0, 8))
    hill = terrain_mesh(land)
    asked = tuple(Serpentine(start, end, SLOPE_DEG, RADIUS, width) for start, end, width in SLOPES)
    lines = vp.SurfaceLines(sections=level_sections(round_heights(*land.relief, 24)), terrain=asked)
    kinds = ("contour", "boundary", "section", "index", "integral")
    item = vp.Item("HILL", hill, lines=kinds, curves=lines)
    camera = vp.Camera(eye=(5.5, -13, 12), target=(6, 3.6, 0.6), fov_deg=32)
    drawing = vp.draw(item, camera, page=vp.Page(180, 110, 6), pens="section=0.13,index=0.25,integral=0.6:#b03020")
    vp.save(drawing, folder / "serpentines.svg")

    for road in curves_in_space(drawing, kind="integral"):
        way = np.diff(road, axis=0)
        length = np.linalg.norm(way, axis=1)
        steep = np.degrees(np.arcsin(way[:, 2] / length)) > SLOPE_DEG + 1e-6
        assert length[steep].sum() < 0.2 * length.sum(), "only bends are steeper"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
