"""A town for the plotter: windows, tone by hatching, a street name and a title, all of it strokes of one pen.

The sun hatches roofs, walls and ground by their light, and leaves shadows; the panes of the windows, sheets a little
before the walls, have a denser hatching of their own.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box

PANE = np.array([(-0.22, 1.02, -0.3), (-0.22, 1.02, 0.3), (0.22, 1.02, 0.3), (0.22, 1.02, -0.3)])
TURN = np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])


def house(x: float, y: float, floors: int) -> list[vp.Item]:
    """A block of flats, and the panes on all of its walls."""
    block = vp.Item("house", box((2, 2, 0.9 * floors + 0.3)), "gray").moved(x - 1, y - 1, 0)
    places = [(across, 0.0, 0.6 + 0.9 * floor) for across in (-0.6, 0.0, 0.6) for floor in range(floors)]
    corners = [(PANE + place) @ np.linalg.matrix_power(TURN, wall) for wall in range(4) for place in places]
    sheet = vp.Mesh.from_polygons(np.concatenate(corners), np.arange(4 * len(corners)).reshape(-1, 4).tolist())
    return [block, vp.Item("panes", sheet, "black", hatch=vp.Hatching("even", 0.35, 90.0)).moved(x, y, 0)]


def main(folder: Path) -> None:
    rng = np.random.default_rng(7)
    houses = [house(3.4 * column, 3.4 * row, int(rng.integers(2, 6))) for column in range(4) for row in range(3)]
    ground = vp.Item("ground", box((15, 11.8, 0.2)).moved(-2.4, -3, -0.2), "white")
    street = vp.Scene((), (vp.Light((-4, 2, 7), parallel=True),), labels=(vp.Label("MILL LANE", (8.5, -2.2, 0)),))
    drawing = vp.draw(
        [street, ground, houses],
        vp.Camera((-14, -24, 17), target=(5, 2.6, 1)),
        page="A4 landscape",
        hatch=vp.Hatching("tone", 0.5),
        title="Mill Lane at noon",
        frame=True,
    )
    vp.save(drawing, folder / "plotted_town.svg")
    strokes = sum(len(paths) for layer in drawing.layers for paths in layer.strokes)
    assert strokes > 2000 and not any(layer.fills for layer in drawing.layers), "a pen draws all of it"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
