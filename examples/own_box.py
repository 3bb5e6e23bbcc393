"""The box of an object in its own coordinates, turned with it, and the box along the axes that is taken later.

Blue is the box that was taken before the house was turned; it is the smaller one, and kept for the search for
separating planes. Red arrows are the axes of each. Source: Glaeser, section 5.8, figure 13.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, GREY, INK, RED, drawn, tinted, with_arrows

import vectorplot as vp
from vectorplot.geometry import prism, rotation_about
from vectorplot.textbook import own_box

HOUSE = prism([(-1, -2, 0), (1, -2, 0), (1, -2, 1.4), (0, -2, 2.4), (-1, -2, 1.4)], (0, 4, 0))
FACES = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (4, 5, 7, 6), (2, 3, 1, 0)]
"""The sides of a box of eight corners, as own_box numbers them."""

CAMERA = vp.Camera(eye=(7, -13, 8), target=(0, 0, 1), fov_deg=24)


def frame(name: str, corners: np.ndarray, colour: str, **options) -> vp.Item:
    """A box of eight corners."""
    return vp.Item(name, vp.Mesh.from_polygons(corners, FACES), colour, **options)


def volume(corners: np.ndarray) -> float:
    """Of a box of eight corners."""
    return float(abs(np.linalg.det(corners[[1, 2, 4]] - corners[0])))


def main(folder: Path) -> None:
    turn = rotation_about((0.4, 0.2, 1), np.radians(40)).T
    points = HOUSE.vertices @ turn.T
    own, later = own_box(HOUSE.vertices) @ turn.T, own_box(points)
    house = vp.Mesh(points, HOUSE.corners, HOUSE.offsets)
    boxes = (
        frame("OWN", own, BLUE, lines=("contour", "crease"), occludes=False),
        frame("LATER", later, GREY, lines=("contour", "crease"), occludes=False),
    )
    starts = np.array([own[0]] * 3 + [later[0]] * 3)
    ends = starts + np.concatenate(
        [[1.1 * way / np.linalg.norm(way) for way in b[[1, 2, 4]] - b[0]] for b in (own, later)]
    )
    items = (vp.Item("HOUSE", house, INK), *boxes)
    drawing = drawn(vp.Scene(items, title="Boxes"), CAMERA, vp.Page(120, 105, 5), {INK: 0.35, BLUE: 0.5})
    glass = frame("OWN", own, "#cfe2f3", material=vp.Material("transparent", 0.45))
    lamp = vp.Light((-2, -5, 6), parallel=True, intensity=1.0)
    drawing = tinted(
        drawing, vp.Scene((vp.Item("HOUSE", house, "orange"), glass), (lamp,)), CAMERA, shadows="none", flat=("OWN",)
    )
    vp.save(with_arrows(drawing, starts, ends, RED, 3.0, 0.5), folder / "own_box.svg")

    assert np.isclose(volume(own), np.prod(np.ptp(HOUSE.vertices, axis=0)))
    assert volume(own) < 0.7 * volume(later)
    sides = (own[[1, 2, 4]] - own[0]) / np.linalg.norm(own[[1, 2, 4]] - own[0], axis=1, keepdims=True)
    height = (points - own[0]) @ sides.T
    reach = np.linalg.norm(own[[1, 2, 4]] - own[0], axis=1)
    assert (height >= -1e-12).all() and (height <= reach + 1e-12).all(), "nothing of the house is outside"
    assert np.allclose(height.min(axis=0), 0) and np.allclose(height.max(axis=0), reach), "and it touches all sides"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
