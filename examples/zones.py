"""A lath behind convex bodies: the hidden zones on its edges.

Each body hides one stretch of an edge, whatever its shape; the stretches are united, and what is left is visible. Where
two bodies overlap in the picture, the lath is hidden by both, and the drawing knows it.
Source: Glaeser, section 7.2, figures 2 and 3.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, revolution, rotation_about

ARC = np.radians(np.arange(-90, 91, 15))


def bodies() -> dict[str, vp.Mesh]:
    """A ball, a cone, a die and a drum."""
    ball = revolution([(np.cos(a), 0, np.sin(a)) for a in ARC.tolist()], 36)
    cone = revolution([(1, 0, -1), (0, 0, 1.4)], 36)
    die = box((1.3, 1.3, 1.3))
    drum = revolution([(0.8, 0, -0.7), (0.8, 0, 0.7)], 36)
    return {
        "BALL": replace(ball, vertices=ball.vertices + np.array([-4.2, 0, 0])),
        "CONE": replace(cone, vertices=cone.vertices + np.array([-2.6, -1.4, -0.2])),
        "DIE": replace(die, vertices=(die.vertices - 0.65) @ rotation_about((1, 2, 0.5), 0.9) + np.array([0.6, 0, 0])),
        "DRUM": replace(drum, vertices=drum.vertices @ rotation_about((1, 0.3, 0), 1.2) + np.array([3.4, 0, 0])),
    }


def main(folder: Path) -> None:
    lath = box((13, 0.12, 0.5))
    behind = replace(lath, vertices=lath.vertices + np.array([-6.5, 2, -0.4]))
    items = [vp.Item(name, mesh) for name, mesh in bodies().items()]
    scene = vp.Scene((vp.Item("LATH", behind), *items), title="Zones")
    camera = vp.Camera(eye=(2, -22, 5), fov_deg=24)
    vp.save(vp.draw(scene, camera, page=vp.Page(190, 80, 6), hidden="dashed"), folder / "zones.svg")

    drawing = vp.draw(scene, camera, hidden="solid")
    counts = np.concatenate([paths.hidden_by[paths.item == 0] for layer in drawing.layers for paths in layer.strokes])
    assert counts.min() == 0 and counts.max() == 3, "by itself, the ball and the cone"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
