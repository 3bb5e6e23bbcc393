"""A mirror is a window to a room of doubles.

The double of a body stands behind the mirror, as far as the body before it, and the other way round. The first
picture shows the mirror, the second one all the doubles without it: through the frame they look the same. Source:
Glaeser, section 6.4, figure 7.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind
from vectorplot.geometry import box, prism, translated

NORMAL, LEVEL = np.array([0.0, -1.0, 0.0]), -2.0
"""The plane of the mirror: normal times x = level, the side of the eye above it."""

LIGHT = vp.Light((-3, -5, 6), parallel=True, intensity=0.9)


def reflected(points: np.ndarray, normal: np.ndarray, level: float) -> np.ndarray:
    """Points mirrored in a plane."""
    return points - 2.0 * np.outer((points @ normal - level) / (normal @ normal), normal)


def double(item: vp.Item) -> vp.Item:
    """The double of a body; its faces run the other way round."""
    mesh = item.mesh.reversed()
    return replace(item, name=f"{item.name}'", shape=replace(mesh, vertices=reflected(mesh.vertices, NORMAL, LEVEL)))


def main(folder: Path) -> None:
    house = prism([(-1, 0, 0), (1, 0, 0), (1, 0, 1.4), (0, 0, 2.6), (-1, 0, 1.4)], (0, 1.8, 0))
    block = box((1.2, 0.8, 0.9))
    bodies = (
        vp.Item("HOUSE", replace(house, vertices=translated(house.vertices, (-0.8, -1.0, 0))), "orange"),
        vp.Item("BLOCK", replace(block, vertices=translated(block.vertices, (1.2, -0.4, 0))), "blue"),
    )
    pane = vp.Mesh.from_polygons([(-2.8, 2, 0), (3, 2, 0), (3, 2, 3.4), (-2.8, 2, 3.4)], [range(4)])
    mirror = vp.Item("MIRROR", pane, "cyan", vp.Material("mirror"))
    camera = vp.Camera(eye=(4.5, -11, 5), target=(0.1, 1.4, 1.3), fov_deg=28)
    page = vp.Page(110, 80, 2)
    shown = vp.paint(vp.Scene((*bodies, mirror), (LIGHT,)), camera, page=page, fit=False, shadows="none")
    room = vp.Scene((*bodies, *map(double, bodies)), (LIGHT,))
    doubled = vp.paint(room, camera, page=page, fit=False, shadows="none")
    vp.save(shown, folder / "mirror_doubles_mirror.svg")
    vp.save(doubled, folder / "mirror_doubles_room.svg")

    at = reflected(np.array([(3.0, -2, 4)]), np.array([1.0, 2, 2]), 5.0)[0]
    assert np.allclose(at, (2.55555555555556, -2.88888888888889, 3.11111111111111))
    (fills,) = shown.layers[0].fills
    seen = fills.take(np.flatnonzero(fills.kind == FillKind.REFLECTION))
    corners = np.concatenate([item.mesh.vertices for item in map(double, bodies)])
    flat = np.column_stack([corners, np.ones(len(corners))]) @ shown.page_from_world.T
    images = flat[:, :2] / flat[:, 3:]
    frame = np.column_stack([pane.vertices, np.ones(4)]) @ shown.page_from_world.T
    frame = frame[:, :2] / frame[:, 3:]
    sides, arm = np.roll(frame, -1, axis=0) - frame, seen.points[:, None] - frame
    assert (sides[:, 0] * arm[..., 1] - sides[:, 1] * arm[..., 0] > -1e-6).all(), "only through the window"
    gap = np.linalg.norm(seen.points[:, None] - images, axis=2).min(axis=1)
    border = (sides[:, 0] * arm[..., 1] - sides[:, 1] * arm[..., 0]).min(axis=1) < 1e-6
    assert len(seen) >= 4 and ((gap < 1e-6) | border).all(), "the corners are images of corners of doubles"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
