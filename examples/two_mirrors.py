"""Things between two mirrors, with a floor of tiles: what the eye sees in each is clipped by its window.

The mirrors show no mutual reflections: in each other they are plain boards. Dashed red lines join the tip of the spike
with its doubles, across the mirrors. Source: Glaeser, section 6.4, figure 8.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import RED, circle, dashes, layer, on_page, polygons, strokes

import vectorplot as vp
from vectorplot.drawing import FillKind
from vectorplot.geometry import box, revolution, translated

LIGHTS = (vp.Light((5, -6, 7), parallel=True, intensity=0.7), vp.Light((-1.0, -7.0, 9.0), intensity=0.45))
PLANES = {"MIRROR1": (np.array([0.0, -1.0, 0.0]), -3.0), "MIRROR2": (np.array([1.0, 0.0, 0.0]), -3.4)}
"""Normal, towards the room, and level of each mirror."""


TOP = 5
"""The face of a box that lies on top."""


def placed(name: str, mesh: vp.Mesh, place: tuple[float, float, float], colour: str, word: str = "normal") -> vp.Item:
    """A body in its place."""
    moved = vp.Mesh(translated(mesh.vertices, place), mesh.corners, mesh.offsets)
    return vp.Item(name, moved, colour, vp.Material(word))


def tiles() -> tuple[vp.Pattern, ...]:
    """Every other square of the floor."""
    square = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    spots = [(x, y) for x in np.arange(-4, 5) for y in np.arange(-4, 5) if (x + y) % 2]
    return tuple(vp.Pattern(f"TILE{k}", "#b9c4cf", TOP, square + spot) for k, spot in enumerate(spots))


def main(folder: Path) -> None:
    vase = revolution([(0.5, 0, 0), (0.85, 0, 0.45), (1, 0, 0.9), (0.8, 0, 1.4), (0.4, 0, 1.9), (0.7, 0, 2.5)], 36)
    items = (
        replace(placed("FLOOR", box((9, 9, 0.3)), (-3.6, -6, -0.3), "#f4efe4"), patterns=tiles()),
        placed("MIRROR1", box((6, 0.15, 4.2)), (-2.9, 3.0, 0.2), "#f2f6f8", "mirror"),
        placed("MIRROR2", box((0.15, 6.2, 4.2)), (-3.55, -3.6, 0.2), "#f2f6f8", "mirror"),
        placed("VASE", vase, (-0.6, 0.6, 0), "orange"),
        placed("BLOCK", box((1.6, 1.1, 1.3)), (1.6, -1.4, 0), "green"),
        placed("SPIKE", revolution([(0.6, 0, 0), (0, 0, 2.2)], 4), (-0.8, -2.6, 0), "pink"),
    )
    scene = vp.Scene(items, LIGHTS, title="Two mirrors")
    camera = vp.Camera(eye=(11, -15, 9), target=(-0.2, -0.8, 1.2), fov_deg=28)
    drawing = vp.paint(scene, camera, page=vp.Page(150, 128, 4), lines="contour,boundary,crease", tolerance_mm=0.1)
    tip = np.array([-0.8, -2.6, 2.2])
    doubles = [tip - 2 * (tip @ normal - level) * normal for normal, level in PLANES.values()]
    places = on_page(drawing, [tip, *doubles])
    joins = layer("joins", strokes(part for end in places[1:] for part in dashes(places[0], end)), RED, 0.45)
    dots = layer("dots", polygons([circle(place, 1.1) for place in places], RED))
    vp.save(replace(drawing, layers=(*drawing.layers, joins, dots)), folder / "two_mirrors.svg")

    (fills,) = drawing.layers[0].fills
    owner = np.repeat(fills.item, np.diff(fills.offsets))
    reflected = np.repeat(fills.kind == FillKind.REFLECTION, np.diff(fills.offsets))
    seen = {drawing.items[k] for k in np.unique(owner[reflected])}
    assert seen >= {"FLOOR", "VASE", "BLOCK", "SPIKE", "MIRROR1", "MIRROR2"}
    assert reflected.sum() > 100
    # A double lies on the far side of one of the mirrors, and what it is the double of before it.
    points = fills.points3d[reflected]
    beyond = np.array([points @ normal < level + 1e-6 for normal, level in PLANES.values()])
    assert beyond.any(axis=0).all()
    for number in (3, 4, 5):
        own, vertices = points[owner[reflected] == number], items[number].mesh.vertices
        back = np.array([own - 2.0 * np.outer(own @ normal - level, normal) for normal, level in PLANES.values()])
        inside = ((back > vertices.min(axis=0) - 1e-6) & (back < vertices.max(axis=0) + 1e-6)).all(axis=2)
        assert inside.any(axis=0).all(), f"reflected once more they are points of {items[number].name}"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
