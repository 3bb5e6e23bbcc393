"""A terrain made of noise: level lines with index lines, water, and its watersheds; and tinted, in the light of maps.

The noise is a sum of waves with random directions, the shorter the lower: the same for the same seed.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import basins, water_courses
from vectorplot.scene import WaterCourses, Watersheds, hill_light, level_sections, round_heights, terrain_mesh, tinted
from vectorplot.surfaces import Terrain, terrain
from vectorplot.testing import curves_in_space

WIDE, DEEP, CELL = 12.0, 8.0, 0.08
PAGE = vp.Page(180, 120, 6)


def noise(seed: int) -> Terrain:
    """Hills of many sizes, on a slope down to the front."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(0.0, WIDE, CELL), np.arange(0.0, DEEP, CELL), indexing="ij")
    heights = 0.1 * y
    for octave in range(5):
        for turn, phase in random.uniform(0.0, 2.0 * np.pi, (4, 2)):
            wave = 0.8 * 1.9**octave
            heights = heights + 0.34 * 0.42**octave * np.cos(wave * (np.cos(turn) * x + np.sin(turn) * y) + phase)
    return terrain(heights, (0.0, WIDE), (0.0, DEEP))


def main(folder: Path) -> None:
    land = noise(7)
    mesh = terrain_mesh(land)
    heights = round_heights(*land.relief, 24)
    x, y = np.meshgrid(np.arange(1.0, WIDE, 2.0), np.arange(1.0, DEEP, 2.0))
    water = WaterCourses(tuple(zip(x.ravel().tolist(), y.ravel().tolist(), strict=True)))
    camera = vp.Camera(eye=(-4.0, -13.0, 11.0), target=(6.2, 3.6, 0.0), fov_deg=30)

    lines = vp.SurfaceLines(sections=level_sections(heights), terrain=(water, Watersheds()))
    kinds = ("contour", "boundary", "section", "index", "integral")
    drawn = vp.draw(vp.Scene((vp.Item("LAND", mesh, lines=kinds, curves=lines),)), camera, page=PAGE)
    vp.save(drawn, folder / "terrain.svg")

    index, others = level_sections(heights)
    bands = tinted("LAND", mesh, index.offsets, curves=vp.SurfaceLines(sections=(others,)))
    picture = vp.render(vp.Scene(bands, (hill_light(),)), camera, lines="contour,boundary,section")
    vp.save(picture, folder / "terrain_tinted.png")

    levels = np.concatenate(curves_in_space(drawn, kind="index"))[:, 2]
    assert np.abs(levels - np.round(levels / 0.5) * 0.5).max() < 1e-9, "index lines have round heights"
    assert all((np.diff(course[:, 2]) <= 1e-9).all() for course in water_courses(mesh, water.places)), "it runs down"
    assert 2 < len(np.unique(basins(land.heights))) < 100


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
