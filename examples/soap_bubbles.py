"""Soap bubbles: bodies in balls that do not meet are painted in the order of the eye's power, not of its distance.

The power of a point with respect to a sphere is d² - r². Two spheres have equal power in a plane between them,
whatever their radii; a large ball whose centre is nearer may still lie behind a small one. Around every body is the
ball about its middle that holds it. Source: Glaeser, section 5.5, figure 9.
"""

import sys
from pathlib import Path

import numpy as np
import shapely
from diagrams import BLUE, INK, drawn, tinted

import vectorplot as vp
from vectorplot.geometry import box, hull_mesh, placed, polygons_of, revolution, rotation_about
from vectorplot.surfaces import PlacedSurface, Sphere
from vectorplot.textbook import spheres_power

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
CAMERA = vp.Camera(eye=tuple(EYE), fov_deg=30)
COLOURS = ("blue", "pink", "orange", "green", "yellow", "cyan")


def icosahedron() -> vp.Mesh:
    golden = (1 + 5**0.5) / 2
    signs = [(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)]
    return hull_mesh(np.array([np.roll(p, k) for p in signs for k in range(3)]))


def body(number: int) -> vp.Item:
    """A body whose farthest corners lie on its sphere."""
    octahedron = hull_mesh(np.concatenate([np.eye(3), -np.eye(3)]))
    cup = revolution([(0.5, 0, 0), (1.0, 0, 1.4)], 24)
    shapes = (icosahedron(), box((1, 1, 1)), octahedron, revolution([(1, 0, 0), (0, 0, 1.9)], 6), octahedron, cup)
    points = shapes[number].vertices - (
        np.ptp(shapes[number].vertices, axis=0) / 2 + shapes[number].vertices.min(axis=0)
    )
    turn = rotation_about((0.3, 0.5, 1.0), 0.7 * number) * SPHERES[number, 3] / np.linalg.norm(points, axis=1).max()
    mesh = vp.Mesh(points, shapes[number].corners, shapes[number].offsets)
    return vp.Item(f"BODY{number}", placed(mesh, np.column_stack([turn, SPHERES[number, :3]]).ravel()), COLOURS[number])


def main(folder: Path) -> None:
    lamp = vp.Light((-4, -6, 7), parallel=True, intensity=1.0)
    bodies = tuple(map(body, range(len(SPHERES))))
    scene = vp.Scene(bodies, (lamp,), title="Soap bubbles")
    clear = vp.Material("transparent", 0.12)
    balls = [PlacedSurface(Sphere(r), np.eye(3), (x, y, z)) for x, y, z, r in SPHERES]
    bubbles = tuple(vp.Item(f"BALL{k}", ball, BLUE, clear) for k, ball in enumerate(balls))
    edges = tuple(vp.Item(item.name, item.shape, INK) for item in bodies)
    drawing = drawn(vp.Scene((*edges, *bubbles)), CAMERA, vp.Page(130, 118, 5), {INK: 0.25, BLUE: 0.4})
    drawing = tinted(drawing, vp.Scene((*bodies, *bubbles), (lamp,)), CAMERA, shadows="none", tolerance_mm=0.3)
    vp.save(drawing, folder / "soap_bubbles.svg")

    arm = SPHERES[:, None, :3] - SPHERES[None, :, :3]
    gap = np.linalg.norm(arm, axis=2) - SPHERES[:, 3, None] - SPHERES[None, :, 3]
    assert gap[~np.eye(len(SPHERES), dtype=bool)].min() > 0, "no two meet"
    power = spheres_power(SPHERES, EYE)
    assert np.allclose(power, ((SPHERES[:, :3] - EYE) ** 2).sum(axis=1) - SPHERES[:, 3] ** 2)

    (fills,) = vp.paint(scene, CAMERA, shadows="none").layers[0].fills
    shapes = polygons_of(fills.points.T, fills.offsets)
    over = 0
    for one, two in np.argwhere(np.triu(np.ones((6, 6)), 1)):
        behind, before = (one, two) if power[one] > power[two] else (two, one)
        back, front = (np.flatnonzero(fills.item == k) for k in (behind, before))
        meet = shapely.area(shapely.intersection(shapes[back][:, None], shapes[front])) > 1e-9
        over += meet.any()
        assert (back[:, None] < front)[meet].all(), "what lies behind is painted before"
    assert over >= 4


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
