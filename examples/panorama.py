"""What one sees from a summit: all round, unrolled, and to one side, in perspective.

The mountains are noise folded into ridges; the ridge lines of the pictures are contours. Every strip ends where the
next one begins, and what a ridge hides is found exactly.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.scene import terrain_mesh
from vectorplot.surfaces import Terrain, terrain

SIDE, CELLS = 24.0, 190


def mountains(seed: int) -> Terrain:
    """Ridges of many sizes, higher towards the border: the horizon is made of the highest ones."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(*[np.linspace(0.0, SIDE, CELLS)] * 2, indexing="ij")
    heights = np.zeros_like(x)
    for octave in range(6):
        wave = sum(
            np.cos(0.55 * 1.85**octave * (np.cos(turn) * x + np.sin(turn) * y) + phase)
            for turn, phase in random.uniform(0.0, 2.0 * np.pi, (3, 2))
        )
        folded = 1.0 - np.abs(np.clip(0.6 * wave, -1.0, 1.0)) if octave < 3 else 0.5 * wave
        heights = heights + 1.15 * 0.47**octave * folded
    far = np.hypot(x - SIDE / 2, y - SIDE / 2) / SIDE
    return terrain(heights * (0.45 + 1.5 * far), (0.0, SIDE), (0.0, SIDE))


def main(folder: Path) -> None:
    land = mountains(11)
    near = np.hypot(*(land.points[..., :2] - SIDE / 2).T) < 3.0
    summit = land.points[np.unravel_index(np.argmax(np.where(near.T, land.heights, -np.inf)), near.shape)]
    eye = (*summit[:2].tolist(), float(summit[2]) + 0.05)
    scene = vp.Scene((vp.Item("MOUNTAINS", terrain_mesh(land), lines=("contour", "boundary")),))

    pens = "contour=0.3,boundary=0.3"
    round_about = vp.Panorama(eye, lowest_deg=-12.0, strips=3)
    unrolled = vp.panorama(scene, round_about, page="A4 landscape", pens=pens)
    vp.save(unrolled, folder / "panorama.svg")

    ahead = vp.Camera(eye, (eye[0] + 3.0, eye[1] + 8.0, eye[2] - 0.9), fov_deg=30)
    view = vp.draw(scene, ahead, page=vp.Page(180, 84, 6), pens=pens, frame=True)
    vp.save(view, folder / "panorama_ahead.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
