"""A bearing housing that a plane cuts in two: the cut faces hatched, what lay before the plane as a ghost.

The strokes of a part have one direction, those of the part beside it the other one. The shaft runs through uncut, as
shafts do in sections of machines. Source: ISO 128-50 (hatching of cut faces).
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.effects import cut_scene
from vectorplot.geometry import revolution

SIDES = 96

HOUSING = [(0.8, 0), (3.6, 0), (3.6, 3.2), (4.6, 3.2), (4.6, 4.0), (2.9, 4.0), (2.9, 0.7), (0.8, 0.7)]
LID = [(1.2, 3.6), (2.9, 3.6), (2.9, 4.0), (4.6, 4.0), (4.6, 4.8), (1.2, 4.8)]
BUSHES = {
    "lower bush": [(0.5, 0), (0.8, 0), (0.8, 0.7), (1.5, 0.7), (1.5, 1.1), (0.5, 1.1)],
    "upper bush": [(0.5, 3.2), (1.6, 3.2), (1.6, 3.6), (1.2, 3.6), (1.2, 4.9), (0.5, 4.9)],
}
SHAFT = [(0, -1.3), (0.5, -1.3), (0.5, 1.5), (1.7, 1.5), (1.7, 2.5), (0.5, 2.5), (0.5, 6.3), (0, 6.3)]


def turned(profile: list[tuple[float, float]]) -> vp.Mesh:
    """What a closed polygon of radii and heights, counter-clockwise, sweeps about the z-axis."""
    radius, height = np.array(profile, dtype=float).T
    turn = 2.0 * np.pi * np.arange(SIDES)[:, None] / SIDES
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height + 0.0 * turn], axis=-1)
    number = np.arange(SIDES * len(profile)).reshape(SIDES, -1)
    after, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    quads = np.stack([number, after, np.roll(after, -1, axis=1), up], axis=-1).reshape(-1, 4)
    return vp.Mesh.from_polygons(points.reshape(-1, 3), quads)


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(7, -24, 12), target=(0, 0, 2.4), fov_deg=24)
    parts = [vp.Item(name, turned(profile)) for name, profile in {"housing": HOUSING, "lid": LID, **BUSHES}.items()]
    half = cut_scene(vp.cut(vp.Scene(tuple(parts)), "y = 0", away="ghost"), camera)
    # The ghosts of the bushes would lie over one another.
    shown = tuple(item for item in half.items if not item.name.endswith("bush ghost"))
    shaft = vp.Item("shaft", revolution([(r, 0, z) for r, z in SHAFT], SIDES))
    drawing = vp.draw(
        vp.Scene((*shown, shaft)),
        camera,
        page=vp.Page(160, 132, 5),
        lines="contour,crease,boundary,cut",
        pens="contour=0.5,crease=0.3,cut=0.6,hatch=0.18:#a63d2f,ghost=0.15:#5b7a99",
    )
    vp.save(drawing, folder / "cut_housing.svg")
    assert {"cut", "hatch", "ghost"} <= {layer.name for layer in drawing.layers if len(layer.strokes[0])}


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
