"""A plane cuts a cone in an ellipse: a figure as in a textbook, with names, axis, dimension and angle.

The plane is less steep than the sides of the cone, so the section is closed. Hidden lines are dashed, and so are the
letters of hidden points; the lines of the figure end before the letters.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.surfaces import Capped, Cone

RADIUS, HEIGHT = 2.0, 4.0
LEVEL, SLOPE = 1.7, 0.55
"""The plane z = LEVEL + SLOPE x."""


def vertices() -> np.ndarray:
    """(2,3) the ends of the longer axis of the ellipse: where the plane meets the sides of the cone at y = 0."""
    # On the sides the height is HEIGHT (1 - |x| / RADIUS).
    x = np.array([(HEIGHT - LEVEL) / (SLOPE + side * HEIGHT / RADIUS) for side in (-1.0, 1.0)])
    return np.column_stack([x, np.zeros(2), LEVEL + SLOPE * x])


def figure() -> list[vp.Scene | vp.Item]:
    """The cone with its section, and what is said about it."""
    normal = np.array([-SLOPE, 0.0, 1.0])
    section = vp.Section(tuple(normal), (LEVEL / float(np.linalg.norm(normal)),))
    cone = vp.Item(
        "cone",
        Capped(Cone(RADIUS / HEIGHT, -HEIGHT, 0.0, (0.0, 0.0, HEIGHT))),
        curves=vp.SurfaceLines(sections=(section,)),
    )
    one, other = vertices()
    apex, foot, edge = (0.0, 0.0, HEIGHT), (0.0, 0.0, 0.0), (0.0, -RADIUS, 0.0)
    thin = [
        vp.Item("axis", Line.through((0, 0, -0.4), (0, 0, HEIGHT + 0.7)), "black", lines=("label",)),
        vp.Item("radius", Line.through(foot, edge), "black", lines=("label",)),
        vp.Item("major", Line.through(one, other), "black", lines=("label",)),
    ]
    labels = (
        vp.Label("S", apex, mark="dot"),
        vp.Label("M", foot, mark="dot", hidden="solid"),
        vp.Label("A", tuple(one), mark="dot", hidden="solid"),
        vp.Label("B", tuple(other), mark="dot"),
        vp.Label("r", vp.Along("radius"), place="above", hidden="solid"),
        vp.Label("a", vp.OnCurve("axis"), mark="arrow"),
    )
    return [
        vp.Scene((cone, *thin), labels=labels),
        vp.dimension((RADIUS, 0, 0), (RADIUS, 0, HEIGHT), (1.2, 0, 0), "h"),
    ]


def main(folder: Path) -> None:
    camera = vp.Camera((3.0, -12.0, 5.0), target=(0.3, 0.0, 1.9))
    drawing = vp.draw(
        figure(), camera, page=vp.Page(130, 130), hidden="dashed", title="Plane section of a cone", frame=True
    )
    vp.save(drawing, folder / "cone_section.svg")
    letters = [paths for layer in drawing.layers if layer.name == "label" for paths in layer.strokes]
    assert sum(map(len, letters)) > 20, "names, arrowheads and thin lines share a layer"
    middle = vertices().mean(axis=0)
    assert abs(middle[2] - LEVEL - SLOPE * middle[0]) < 1e-12, "the middle of the ellipse lies in the plane"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
