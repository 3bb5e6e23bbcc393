"""From the world to the screen in three rotations.

The world is turned about z until the eye stands over the y-axis, about x until it stands on the z-axis, and about z
again by the twist. Then the image plane is z = 0, and projecting is easy. Source: Glaeser, section 2.1, figure 2.
"""

import sys
from dataclasses import replace
from itertools import accumulate
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import CoordinateSystem, box, prism, revolution, rotation_about, rotation_x, rotation_z

EYE, TWIST_DEG = (2.4, -2.2, 1.7), 25.0


def world() -> dict[str, vp.Mesh]:
    """A house on the origin, and a small ball where the eye is."""
    gable = [(-0.8, -0.6, 0), (0.8, -0.6, 0), (0.8, -0.6, 0.8), (0, -0.6, 1.5), (-0.8, -0.6, 0.8)]
    ball = revolution([(0, 0, -0.2), (0.17, 0, -0.1), (0.17, 0, 0.1), (0, 0, 0.2)], 8)
    ray = revolution([(0.02, 0, 0), (0.02, 0, 1)], 6)
    lying = ray.vertices * (1, 1, np.linalg.norm(EYE)) @ CoordinateSystem.of_image(vp.Camera(EYE)).rotation.T
    plate = box((2.4, 2.0, -0.1))
    return {
        "HOUSE": prism(gable, (0, 1.2, 0)),
        "PLATE": replace(plate, vertices=plate.vertices - np.array([1.2, 1.0, 0])),
        "EYE": replace(ball, vertices=ball.vertices + np.array(EYE)),
        "RAY": replace(ray, vertices=lying),
    }


def axes() -> list[vp.Item]:
    """Three thin rods along the axes."""
    rod = revolution([(0.025, 0, -3), (0.025, 0, 3), (0.09, 0, 3), (0, 0, 3.4)], 8)
    turns = {"X": rotation_about((0, 1, 0), np.pi / 2), "Y": rotation_about((1, 0, 0), -np.pi / 2), "Z": np.eye(3)}
    return [vp.Item(name, replace(rod, vertices=rod.vertices @ turn)) for name, turn in turns.items()]


def main(folder: Path) -> None:
    eye = vp.Camera(EYE, twist_deg=TWIST_DEG)
    alpha, beta, gamma = eye.euler_angles
    turns = list(accumulate([np.eye(3), rotation_z(-gamma), rotation_x(-beta), rotation_z(-alpha)], np.matmul))
    camera = vp.Camera(eye=(9, -14, 8.3), target=(0, 0, 0.3), parallel=True, height=8.0)
    for number, turn in enumerate(turns):
        turned = [vp.Item(name, replace(mesh, vertices=mesh.vertices @ turn)) for name, mesh in world().items()]
        scene = vp.Scene((*axes(), *turned))
        drawing = vp.draw(scene, camera, page=vp.Page(80, 100, 0), fit=False, layers="object")
        vp.save(drawing, folder / f"three_rotations_{number + 1}.svg")

    assert np.isclose((EYE @ turns[1])[0], 0) and np.allclose(EYE @ turns[2], (0, 0, eye.distance))
    assert np.allclose(turns[3], CoordinateSystem.of_image(eye).rotation)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
