"""Anamorphoses: an anamorphosis with its mirror, a cylinder, and one with a cone, on paper and as one sees them.

One sees nothing but a bent ring until a mirror stands on the circle and the eye is where the arrow and the letters say.
The second picture of each is what one sees then: the mirror, the ring in it, and around it the paper.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import Torus


def ring() -> vp.Scene:
    """A ring with its circles."""
    lines = vp.SurfaceLines(columns=24, rows=12)
    return vp.Scene((vp.Item("RING", Torus(3.0, 1.0), curves=lines),), camera=vp.Camera((8, -16, 11)))


def heights_on_mirror(drawing: vp.Drawing, radius: float, eye: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How high on a cylinder the eye sees points of the paper, by the law of reflection."""
    paper = np.column_stack([points - drawing.page_from_world[:2, 3], np.zeros(len(points))])
    # The direction of the place where light meets the mirror lies half-way; it is found by halving.
    low, high = np.full(len(paper), -np.pi), np.zeros(len(paper))
    for _ in range(60):
        turn = 0.5 * (low + high)
        normal = np.column_stack([np.cos(turn), np.sin(turn)])
        to_eye, to_paper = eye[:2] - radius * normal, paper[:, :2] - radius * normal
        one, other = (way / np.linalg.norm(way, axis=1)[:, None] for way in (to_eye, to_paper))
        side = normal[:, 0] * (one + other)[:, 1] - normal[:, 1] * (one + other)[:, 0]
        low, high = np.where(side > 0, turn, low), np.where(side > 0, high, turn)
    far, near = np.linalg.norm(to_eye, axis=1), np.linalg.norm(to_paper, axis=1)
    return eye[2] * near / (far + near)


def main(folder: Path) -> None:
    scene = ring()
    laid = vp.anamorphosis(scene, mirror="cylinder")
    vp.save(laid, folder / "anamorphoses_cylinder.svg")
    vp.save(vp.anamorphosis_view(scene, mirror="cylinder"), folder / "anamorphoses_cylinder_seen.svg")
    vp.save(vp.anamorphosis(scene, mirror="cone"), folder / "anamorphoses_cone.svg")
    vp.save(vp.anamorphosis_view(scene, mirror="cone"), folder / "anamorphoses_cone_seen.svg")

    points = np.concatenate([paths.points for layer in laid.layers[:-3] for paths in layer.strokes])
    heights = heights_on_mirror(laid, 25.0, np.array([0.0, -400.0, 350.0]), points)
    assert 0.0 < heights.min() and heights.max() < 50.0, "light from all of the paper meets the mirror, low enough"
    (foot,) = laid.layers[-3].marks[0].arcs.take(np.array([0])).centre
    assert np.allclose(foot, laid.page_from_world[:2, 3]), "the mirror stands where the world begins"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
