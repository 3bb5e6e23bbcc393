"""Soap bubbles: balls that do not meet are painted in the order of the eye's power, not of its distance.

The power of a point with respect to a sphere is d² - r². Two spheres have equal power in a plane between them,
whatever their radii; a large ball whose centre is nearer may still lie behind a small one. Source: Glaeser, section
5.5, figure 9.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import revolution, spheres_power, translated

SPHERES = np.array(
    [
        (0.0, 3.4, 0.0, 3.0),
        (0.9, -0.9, 1.6, 0.75),
        (-2.6, -0.6, -0.4, 1.2),
        (2.9, -0.6, -0.5, 0.9),
        (-1.0, -3.0, 1.9, 0.6),
        (0.6, -3.2, -0.9, 0.9),
    ]
)
"""Centre and radius of each."""

EYE = np.array([2.0, -16.0, 5.0])
COLOURS = ("blue", "pink", "orange", "green", "yellow", "cyan")


def ball(number: int) -> vp.Item:
    """A ball of many faces inside its sphere."""
    *centre, radius = SPHERES[number]
    latitude = np.linspace(-np.pi / 2, np.pi / 2, 15)
    meridian = radius * np.column_stack([np.cos(latitude), 0 * latitude, np.sin(latitude)])
    meridian[[0, -1], 0] = 0.0
    mesh = revolution(meridian, 24)
    return vp.Item(
        f"BALL{number}", vp.Mesh(translated(mesh.vertices, centre), mesh.corners, mesh.offsets), COLOURS[number]
    )


def covers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which points lie in a convex polygon."""
    along, arm = np.roll(corners, -1, axis=0) - corners, points[:, None] - corners
    side = along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]
    return (side >= 0).all(axis=1) | (side <= 0).all(axis=1)


def main(folder: Path) -> None:
    scene = vp.Scene(tuple(map(ball, range(len(SPHERES)))), (vp.Light((-4, -6, 7), parallel=True, intensity=1.0),))
    camera = vp.Camera(eye=tuple(EYE), target=(0, 0, 0), fov_deg=30)
    drawing = vp.paint(scene, camera, page=vp.Page(100, 90, 3), shadows="none")
    vp.save(drawing, folder / "soap_bubbles.svg")

    arm = SPHERES[:, None, :3] - SPHERES[None, :, :3]
    gap = np.linalg.norm(arm, axis=2) - SPHERES[:, 3, None] - SPHERES[None, :, 3]
    assert gap[~np.eye(len(SPHERES), dtype=bool)].min() > 0, "no two meet"

    far = np.linalg.norm(SPHERES[:, :3] - EYE, axis=1)
    angle = np.arccos(
        np.clip(((SPHERES[:, :3] - EYE) / far[:, None]) @ ((SPHERES[:, :3] - EYE) / far[:, None]).T, -1, 1)
    )
    width = np.arcsin(SPHERES[:, 3] / far)
    overlap = np.triu(angle < 0.98 * (width[:, None] + width), 1)
    power = spheres_power(SPHERES, EYE)
    assert np.allclose(power, far**2 - SPHERES[:, 3] ** 2)
    (fills,) = drawing.layers[0].fills
    corners = [fills.points[a:b] for a, b in pairwise(fills.offsets)]
    pairs = np.argwhere(overlap)
    assert len(pairs) >= 4
    for one, two in pairs:
        behind, before = (one, two) if power[one] > power[two] else (two, one)
        middles = np.array([c.mean(axis=0) for c, item in zip(corners, fills.item, strict=True) if item == before])
        top = np.full(len(middles), -1)
        for number, corner in enumerate(corners):
            if fills.item[number] in (behind, before):
                top[covers(corner, middles)] = number
        assert (fills.item[top] == before).all(), "no part of the ball behind lies on the one before it"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
