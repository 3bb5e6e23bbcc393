"""A film: a pencil turns once around, its lines seen exactly in every frame.

The picture moves by itself, without a script: frames are groups that are visible one after the other. One fit holds for
all of them, and strokes keep their order. Source: Glaeser, chapter 10 and appendix A.3.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp

ROOT = Path(__file__).resolve().parent.parent


def main(folder: Path) -> None:
    scene = vp.read(ROOT / "data" / "pencil.scene")
    animation = vp.read_animation(ROOT / "data" / "pencil.anim", scene)
    once = vp.Animation(animation.motion, frames=16, fps=8, loop=True)
    film = vp.animate(once, mode="lines", page="120x90", lines="contour,crease", crease_angle_deg=40)
    frames = list(film)
    vp.save_frames(frames, folder / "turning_pencil.svg", fps=film.fps)

    # The target stays in the middle of the page.
    places = np.array([drawing.page_from_world @ (-5.6, 4.4, -3, 1) for drawing in frames])
    assert np.allclose(places[:, :2] / places[:, 3:], (60, 45))
    text = (folder / "turning_pencil.svg").read_text(encoding="utf-8")
    assert text.count("<animate ") == len(film) == 16


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
