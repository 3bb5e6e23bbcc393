"""Two convex outlines in the image: apart, crossing, or one inside the other.

Where they cross, the depths of both bodies at a crossing tell which one is in front; where one lies inside the other,
the depths at a corner of it: red dots. Source: Glaeser, sections 5.5 and 6.2, figure 10 of chapter 5.
"""

import sys
from pathlib import Path

import numpy as np
import shapely
from diagrams import BLUE, INK, OCHRE, RED, circle, layer, polygons, strokes

import vectorplot as vp
from vectorplot.geometry import box, convex_hull, placed
from vectorplot.scene import look
from vectorplot.textbook import Position, relative_position
from vectorplot.visibility import image_points

CASES = {
    Position.DISJOINT: ((3.9, 0.0, 0.0), 0.9),
    Position.CROSSING: ((1.5, -2.6, 0.4), 0.9),
    Position.SECOND_IN_FIRST: ((0.4, -3.2, 0.3), 0.35),
}
"""Where the second box stands, and how large it is."""

CAMERA = vp.Camera(eye=(1.5, -13, 5), target=(1.0, 0, 0), fov_deg=30)


def turned(size: float, degrees: float, place: tuple[float, float, float]) -> vp.Mesh:
    """A cube about a place, turned about the z-axis."""
    c, s = np.cos(a := np.radians(degrees)), np.sin(a)
    first = placed(box((2 * size, 2 * size, 2 * size)), (1, 0, 0, -size, 0, 1, 0, -size, 0, 0, 1, -size))
    return placed(first, (c, -s, 0, place[0], s, c, 0, place[1], 0, 0, 1, place[2]))


def main(folder: Path) -> None:
    for number, (position, (place, size)) in enumerate(CASES.items()):
        meshes = turned(1.4, 20, (0, 0, 0)), turned(size, 55, place)
        items = (vp.Item("FIRST", meshes[0], "blue"), vp.Item("SECOND", meshes[1], "orange"))
        scene = vp.Scene(items, (vp.Light((-3, -5, 6), parallel=True, intensity=0.9),), title=position.value)
        drawing = vp.paint(scene, CAMERA, page=vp.Page(84, 62, 5), shadows="none")

        view = look(scene, CAMERA)
        outlines, rings = [], []
        for item, start, end in zip(items, view.item_vertices[:-1], view.item_vertices[1:], strict=True):
            points = image_points(view, view.points[:, start:end]).T
            outlines.append(points[convex_hull(points)])
            flat = np.column_stack([item.mesh.vertices, np.ones(8)]) @ drawing.page_from_world.T
            rings.append((flat[:, :2] / flat[:, 3:])[convex_hull(points)])
        found = relative_position(*outlines)
        assert found.position is position
        (fills,) = drawing.layers[0].fills
        if position is not Position.DISJOINT:
            # Larger depths are nearer to the eye: the second box is in front, and comes last.
            assert found.second_depth > found.first_depth
            assert np.flatnonzero(fills.item == 0).max() < np.flatnonzero(fills.item == 1).min()

        first, second = map(shapely.Polygon, rings)
        crossings = shapely.get_coordinates(first.exterior & second.exterior)
        spots = {Position.DISJOINT: [], Position.CROSSING: crossings, Position.SECOND_IN_FIRST: rings[1][:1]}[position]
        over = (
            layer("first", strokes(rings[:1], closed=True), BLUE, 0.7),
            layer("second", strokes(rings[1:], closed=True), OCHRE, 0.7),
            layer("tested", (polygons([circle(spot, 1.3) for spot in spots], RED), *ring(spots)), INK, 0.25),
        )
        vp.save(
            vp.Drawing(84, 62, (*drawing.layers, *over), title=position.value),
            folder / f"outline_cases_{number + 1}.svg",
        )


def ring(spots):
    """A thin circle about each dot."""
    return [strokes([circle(spot, 2.0) for spot in spots], closed=True)] if len(spots) else []


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
