"""The six main views of a body on one sheet, hidden edges dashed.

First angle projection, as European drawing offices lay it out: the view from above stands below the front view, the
view from the left to its right. All views share one scale, so corresponding points are aligned.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, prism, translated

CELL = 62.0
PLACES = {"bottom": (1, 2), "right": (0, 1), "front": (1, 1), "left": (2, 1), "back": (3, 1), "top": (1, 0)}


def bracket() -> vp.Scene:
    """An angle with a slanted rib."""
    angle = prism(
        [(-2, -1.5, 0), (2, -1.5, 0), (2, -1.5, 0.8), (-1.2, -1.5, 0.8), (-1.2, -1.5, 3), (-2, -1.5, 3)], (0, 3, 0)
    )
    rib = prism([(-1.2, -1.1, 0.8), (1.4, -1.1, 0.8), (-1.2, -1.1, 2.6)], (0, 0.6, 0))
    foot = box((0.8, 1.2, 0.7), placement=(1, 0, 0, 1.0, 0, 1, 0, 0.1, 0, 0, 1, 0.8))
    return vp.Scene((vp.Item("ANGLE", angle), vp.Item("RIB", rib), vp.Item("FOOT", foot)), title="Six views")


def moved(drawing: vp.Drawing, x_mm: float, y_mm: float) -> dict[str, vp.Layer]:
    """The layers of a drawing at another place of the sheet."""
    return {
        layer.name: replace(
            layer, marks=tuple(replace(paths, points=translated(paths.points, (x_mm, y_mm))) for paths in layer.strokes)
        )
        for layer in drawing.layers
    }


def main(folder: Path) -> None:
    scene, target = bracket(), (0.0, 0.0, 1.5)
    layers: dict[str, vp.Layer] = {}
    seen = {}
    for name, (column, row) in PLACES.items():
        camera = replace(vp.Camera.view(name, target, distance=10.0), height=5.0)
        drawing = vp.draw(scene, camera, page=vp.Page(CELL, CELL, 1), fit=False, hidden="dashed")
        for word, layer in moved(drawing, column * CELL, row * CELL).items():
            before = layers[word].marks if word in layers else ()
            layers[word] = replace(layer, marks=before + layer.marks)
        seen[name] = np.concatenate([paths.points for layer in drawing.layers for paths in layer.strokes])
    ordered = tuple(layers[word] for word in ("visible", "contour", "intersection", "hidden") if word in layers)
    names = tuple(item.name for item in scene.items)
    vp.save(vp.Drawing(4 * CELL, 3 * CELL, ordered, names, scene.title), folder / "six_views.svg")

    def span(name: str, axis: int) -> np.ndarray:
        return np.array([seen[name][:, axis].min(), seen[name][:, axis].max()])

    for name in ("top", "bottom"):
        assert np.allclose(span(name, 0), span("front", 0)), "widths stand above each other"
    for name in ("left", "right", "back"):
        assert np.allclose(span(name, 1), span("front", 1)), "heights stand beside each other"
    assert np.allclose(span("top", 1), span("right", 0)), "the depth is the same from above and from the side"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
