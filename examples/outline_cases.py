"""Two convex outlines in the image: apart, crossing, or one inside the other.

Where they cross, the depths of both bodies at a crossing tell which one is in front; where one lies inside the other,
the depths at a corner of it. Source: Glaeser, sections 5.5 and 6.2, figure 10 of chapter 5.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, convex_hull, placed
from vectorplot.scene import look
from vectorplot.textbook import Position, relative_position
from vectorplot.visibility import image_points

CASES = {
    Position.DISJOINT: ((3.6, 0.0, 0.0), 1.0),
    Position.CROSSING: ((1.5, -2.6, 0.4), 1.0),
    Position.SECOND_IN_FIRST: ((0.4, -3.2, 0.3), 0.35),
}
"""Where the second box stands, and how large it is."""


def turned(size: float, degrees: float, place: tuple[float, float, float]) -> vp.Mesh:
    """A cube about a place, turned about the z-axis."""
    c, s = np.cos(a := np.radians(degrees)), np.sin(a)
    middle = (-size, -size, -size)
    first = placed(box((2 * size, 2 * size, 2 * size)), (1, 0, 0, middle[0], 0, 1, 0, middle[1], 0, 0, 1, middle[2]))
    return placed(first, (c, -s, 0, place[0], s, c, 0, place[1], 0, 0, 1, place[2]))


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(1.5, -13, 5), target=(1.0, 0, 0), fov_deg=30)
    for number, (position, (place, size)) in enumerate(CASES.items()):
        meshes = turned(1.4, 20, (0, 0, 0)), turned(size, 55, place)
        items = (vp.Item("FIRST", meshes[0], "blue"), vp.Item("SECOND", meshes[1], "orange"))
        scene = vp.Scene(items, (vp.Light((-3, -5, 6), parallel=True, intensity=0.9),), title=position.value)
        drawing = vp.paint(scene, camera, page=vp.Page(80, 60, 4), shadows="none")
        vp.save(drawing, folder / f"outline_cases_{number + 1}.svg")

        view = look(scene, camera)
        outlines = []
        for start, end in zip(view.item_vertices[:-1], view.item_vertices[1:], strict=True):
            points = image_points(view, view.points[:, start:end]).T
            outlines.append(points[convex_hull(points)])
        found = relative_position(*outlines)
        assert found.position is position
        (fills,) = drawing.layers[0].fills
        if position is not Position.DISJOINT:
            # Larger depths are nearer to the eye: the second box is in front, and comes last.
            assert found.second_depth > found.first_depth
            assert np.flatnonzero(fills.item == 0).max() < np.flatnonzero(fills.item == 1).min()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
