"""A crystal of rock salt on a plate under two lamps: balls and rods in bands of equal shade.

What is round is not made of triangles: between isophotes every band has one colour, and outlines and borders of shadows
are those of the bodies. Bodies and the plate are in one order, and throw shadows on each other. Source: Glaeser,
sections 5.5 (bodies as wholes), 6.3 (shadows) and 7.3 (isophotes).
"""

import sys
from itertools import product
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere, rod

SIZE = (3, 3, 2)

LAMPS = (vp.Light((9, -7, 12)), vp.Light((-4, -6, 9), intensity=0.35))


def main(folder: Path) -> None:
    plate = box((4.4, 4.4, 0.2), placement=(1, 0, 0, -1.2, 0, 1, 0, -1.2, 0, 0, 1, -0.6))
    items = [vp.Item("PLATE", plate, "lightgray")]
    for place in product(*map(range, SIZE)):
        sodium = sum(place) % 2 == 0
        name = "".join(map(str, place))
        items.append(vp.Item(f"ATOM{name}", Sphere(0.24 if sodium else 0.36, place), "blue" if sodium else "green"))
        for axis in np.flatnonzero(np.array(place) < np.array(SIZE) - 1).tolist():
            end = tuple(number + (k == axis) for k, number in enumerate(place))
            items.append(vp.Item(f"BOND{name}{'xyz'[axis]}", rod(place, end, 0.07), "gray"))
    scene = vp.Scene(tuple(items), LAMPS, title="Rock salt")
    camera = vp.Camera((8, -10, 6), (1, 1, 0.3), fov_deg=26)
    drawing = vp.paint(scene, camera, width="80mm", lines="contour,crease", pens={"contour": "0.25", "crease": "0.15"})
    vp.save(drawing, folder / "crystal.svg")

    fills = drawing.layers[0].marks[0]
    round_ = np.isin(fills.item, [k for k, item in enumerate(items) if item.name != "PLATE"])
    assert (fills.kind[round_] == FillKind.BAND).all() and (fills.kind == FillKind.SHADOW).any(), (
        "in bands, with shadows"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
