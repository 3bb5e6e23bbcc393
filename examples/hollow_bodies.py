"""Bodies with a convex outline that lack some faces: first the insides of the back, then the front.

Of a convex solid only the faces in front are painted, in any order. Where faces are missing one looks inside, and
paints what shows its inside before what shows its outside:
the first picture stops there. Source: Glaeser, section 5.1, figure 2.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, revolution, translated

EYE = np.array([7.5, -16.0, 12.0])


def placed(name: str, mesh: vp.Mesh, x: float, colour: str) -> vp.Item:
    """A body in its place."""
    return vp.Item(
        name,
        vp.Mesh(translated(mesh.vertices, (0.91 * x, 0.42 * x, 0)), mesh.corners, mesh.offsets, mesh.present),
        colour,
    )


def covered(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which points lie in a convex polygon."""
    along, arm = np.roll(corners, -1, axis=0) - corners, points[:, None] - corners
    side = along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]
    return (side > 0).all(axis=1) | (side < 0).all(axis=1)


def main(folder: Path) -> None:
    items = (
        placed("SOLID", box((2, 2, 2)), -5.6, "yellow"),
        placed("CRATE", box((2, 2, 2), caps=("bottom",)), -2.4, "orange"),
        placed("BOWL", revolution([(0.7, 0, 0), (1.3, 0, 2)], 72, caps=("bottom",)), 2.2, "cyan"),
        placed("PIPE", revolution([(1, 0, 0), (1, 0, 2)], 72, caps=()), 5.2, "green"),
    )
    scene = vp.Scene(items, (vp.Light((-3, -4, 6), parallel=True, intensity=1.0),), title="Hollow bodies")
    camera = vp.Camera(eye=tuple(EYE), target=(0.4, 0.2, 0.7), fov_deg=30)
    drawing = vp.paint(scene, camera, page=vp.Page(180, 58, 4), shadows="none", lines="contour,boundary,crease")

    (fills,) = drawing.layers[0].fills
    shows_inside = []
    for start, end, item in zip(fills.offsets[:-1], fills.offsets[1:], fills.item, strict=True):
        corners = fills.points3d[start:end]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[1])
        middle = items[item].mesh.vertices.mean(axis=0)
        outwards = normal * np.sign(normal @ (corners[0] - middle))
        shows_inside.append(bool(outwards @ (EYE - corners[0]) < 0))
    inside = np.array(shows_inside)
    whole = drawing.layers[0].marks
    for name, kept in (("insides", inside), ("whole", inside | True)):
        marks = tuple(mark.take(np.flatnonzero(kept)) if mark is fills else mark for mark in whole)
        layers = (replace(drawing.layers[0], marks=marks), *drawing.layers[1:])
        vp.save(replace(drawing, layers=layers), folder / f"hollow_bodies_{name}.svg")

    sample = np.random.default_rng(1).uniform(fills.points.min(axis=0), fills.points.max(axis=0), (3000, 2))
    covers = np.array(
        [covered(fills.points[a:b], sample) for a, b in zip(fills.offsets, fills.offsets[1:], strict=False)]
    )
    for number, item in enumerate(items):
        own = fills.item == number
        last_inside = np.where(covers & (own & inside)[:, None], np.arange(len(own))[:, None], -1).max(axis=0)
        first_outside = np.where(covers & (own & ~inside)[:, None], np.arange(len(own))[:, None], len(own)).min(axis=0)
        assert (last_inside < first_outside).all(), f"{item.name}: insides first"
        assert inside[own].any() == (item.name != "SOLID")
    assert (fills.item == 0).sum() == 3, "of a cube one sees three faces"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
