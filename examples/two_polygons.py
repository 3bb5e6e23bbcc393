"""The section of two convex polygons in space.

Two plane sheets pierce each other; the segment they have in common is drawn as a line of its own kind.
Source: Glaeser, section 1.3, figure 3.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import rotation_about, translated
from vectorplot.textbook import polygons_common_segment

HEXAGON = np.array([(np.cos(a), np.sin(a), 0) for a in np.radians(np.arange(0, 360, 60))])
SHEET = np.array([(-1.5, -0.6, 0), (1.2, -0.9, 0), (1.4, 0.8, 0), (-0.9, 1.0, 0)])


def sheet(name: str, corners: np.ndarray) -> vp.Item:
    """A flat polygon as an item."""
    return vp.Item(name, vp.Mesh.from_polygons(corners, [range(len(corners))]))


def main(folder: Path) -> None:
    first = HEXAGON @ rotation_about((1, 0, 0), 0.5) * 1.3
    second = translated(SHEET @ rotation_about((1, 0.4, 0.2), -1.1), (0.2, 0.1, 0.1))
    scene = vp.Scene((sheet("HEXAGON", first), sheet("SHEET", second)), title="Two polygons")
    camera = vp.Camera(eye=(4, -7, 4), fov_deg=25)
    vp.save(vp.draw(scene, camera, page=vp.Page(130, 100, 6), hidden="dashed"), folder / "two_polygons.svg")

    ends, exists = polygons_common_segment(first, second)
    whole = vp.draw(scene, camera, hidden="solid")
    drawn = [
        paths.points3d[np.repeat(paths.kind == vp.LineKind.INTERSECTION, np.diff(paths.offsets))]
        for layer in whole.layers
        for paths in layer.strokes
    ]
    gap = np.linalg.norm(np.concatenate(drawn)[:, None] - ends, axis=2)
    assert exists and np.allclose(gap.min(axis=0), 0, atol=1e-9), "the drawn line ends where the polygons' borders do"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
