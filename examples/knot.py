"""A trefoil knot: a mesh made with numpy, written as OBJ, read and drawn.

Sixteen lines run along the tube; where the tube passes behind itself they stop exactly at its contour.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import vectorplot as vp

AROUND, ALONG = 16, 360


def knot() -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n,3) and quadrilaterals (n,4) of a tube about a trefoil knot."""
    t = np.linspace(0, 2 * np.pi, ALONG, endpoint=False)
    middle = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    tangent = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    outward = np.cross(tangent, (0, 0, 1))
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    upward = np.cross(outward, tangent)
    upward /= np.linalg.norm(upward, axis=1)[:, None]
    turn = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)[:, None]
    ring = np.cos(turn) * outward[:, None] + np.sin(turn) * upward[:, None]
    here = np.arange(ALONG * AROUND).reshape(ALONG, AROUND)
    beside, ahead = np.roll(here, -1, axis=1), np.roll(here, -1, axis=0)
    quads = np.stack([here, ahead, np.roll(ahead, -1, axis=1), beside], axis=-1)
    return (middle[:, None] + 0.55 * ring).reshape(-1, 3), quads.reshape(-1, 4)


def main(folder: Path) -> None:
    vertices, quads = knot()
    with tempfile.TemporaryDirectory() as desk:
        path = Path(desk) / "knot.obj"
        lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in vertices]
        lines += ["f " + " ".join(map(str, quad)) for quad in quads + 1]
        path.write_text("\n".join(lines))
        scene = vp.read(path)
    mesh = scene.items[0].shape
    assert len(mesh.vertices) - len(mesh.corners) / 2 + mesh.face_count == 0, "a torus has the Euler number 0"

    camera = vp.Camera(eye=(1.5, -5, 17), fov_deg=30)
    drawing = vp.draw(scene, camera, page=vp.Page(150, 150, 8), crease_angle_deg=12)
    vp.save(drawing, folder / "knot.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
