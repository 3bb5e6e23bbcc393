"""A rabbit made of soft balls: level lines, and suggestive contours that show its folds.

Its mesh is polygonized, made even, and written as other programs write theirs; data/rabbit.ply came about so.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import polygonized
from vectorplot.scene import round_sections, with_lines
from vectorplot.surfaces import implicit_of_function

BALLS = np.array(
    [
        # middle x, y, z; radii along x, y, z; weight
        (0.45, 0.0, 0.95, 0.80, 0.62, 0.72, 1.0),  # body
        (0.80, 0.42, 0.62, 0.48, 0.30, 0.52, 0.8),  # haunch
        (-0.25, 0.0, 1.02, 0.46, 0.44, 0.56, 0.8),  # chest
        (-0.72, 0.0, 1.86, 0.44, 0.38, 0.40, 1.0),  # head
        (-1.10, 0.0, 1.74, 0.22, 0.22, 0.20, 0.7),  # nose
        (-0.92, 0.16, 1.62, 0.20, 0.16, 0.16, 0.35),  # cheek
        (-0.42, 0.24, 2.62, 0.11, 0.17, 0.62, 0.95),  # ear
        (-0.60, 0.22, 0.30, 0.30, 0.15, 0.24, 0.7),  # fore foot
        (0.42, 0.52, 0.22, 0.52, 0.17, 0.17, 0.8),  # hind foot
        (1.32, 0.0, 0.72, 0.26, 0.26, 0.26, 0.9),  # tail
    ]
)
BALLS = np.concatenate([BALLS, (BALLS * (1, -1, 1, 1, 1, 1, 1))[BALLS[:, 1] > 0.0]])


def thickness(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    total = np.full_like(x, -0.32)
    for a, b, c, width, depth, height, weight in BALLS:
        lean = 0.22 * (z - c) if height > 0.6 and width < 0.2 else 0.0
        total += weight * np.exp(-(((x - a - lean) / width) ** 2 + ((y - b) / depth) ** 2 + ((z - c) / height) ** 2))
    return -total


def onto(points: np.ndarray) -> np.ndarray:
    """Points nearby moved onto the surface, along its normals."""
    for _ in range(4):
        rises = [thickness(*(points + h).T) - thickness(*(points - h).T) for h in np.eye(3) * 1e-4]
        slopes = np.stack(rises, axis=1) / 2e-4
        points = points - (thickness(*points.T) / (slopes**2).sum(axis=1))[:, None] * slopes
    return points


def even(mesh: vp.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a mesh with each vertex amid the triangles around it, and on the surface."""
    points, triangles = mesh.vertices, mesh.corners.reshape(-1, 3)
    for _ in range(10):
        a, b, c = points[triangles].swapaxes(0, 1)
        areas = np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1), 3)
        middles = np.repeat((a + b + c) / 3.0, 3, axis=0) * areas[:, None]
        sums = [np.bincount(triangles.ravel(), w, len(points)) for w in (*middles.T, areas)]
        points = onto(np.stack(sums[:3], axis=1) / sums[3][:, None])
    return points, triangles


def write_ply(points: np.ndarray, triangles: np.ndarray, path: Path) -> None:
    places = "".join(f"property float {axis}\n" for axis in "xyz")
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{places}"
    head += f"element face {len(triangles)}\nproperty list uchar ushort vertex_indices\nend_header\n"
    rows = np.full(len(triangles), 3, dtype=[("count", "u1"), ("corners", "<u2", 3)])
    rows["corners"] = triangles
    path.write_bytes(head.encode() + points.astype("<f4").tobytes() + rows.tobytes())


def main(folder: Path) -> None:
    soft = implicit_of_function(thickness, np.array([(-2.0, -1.4, -0.4), (2.2, 1.4, 4.0)]))
    with tempfile.TemporaryDirectory() as place:
        write_ply(*even(polygonized(soft, 120)), Path(place) / "rabbit.ply")
        rabbit = vp.read(Path(place) / "rabbit.ply")
    vp.draw(
        with_lines(rabbit, sections=round_sections(rabbit, count=40), smooth_contours=True),
        vp.Camera((-9.0, -14.0, 6.0), (0.0, 0.0, 1.5), fov_deg=16.0),
        page="fit",
        width="120mm",
        lines="contour,suggestive,section,index",
        crease_angle_deg=90.0,
        pens="contour=0.5,suggestive=0.4,section=0.1:#777777,index=0.1:#777777",
    ).save(folder / "rabbit.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
