"""Light and shadow with a pen: a town hatched, rings combed by their parameter lines, a ring in dots.

Planes have evenly spaced strokes, and more of them in shadows; they cross where it is dark. Rings are hatched along
their meridians, which begin and end where the shade asks for them, and are crossed by parallels. Dots lie in the
middles of their cells, closer where it is darker. All are strokes for a plotter, cut off where something hides them.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import Torus

TOWN = Path(__file__).resolve().parent.parent / "data" / "town.scene"
SUN = vp.Light((-6.0, -4.0, 9.0), parallel=True, intensity=1.0, name="SUN")
CAMERA = vp.Camera(eye=(7.0, -13.0, 10.0), target=(0.2, 0.0, 0.1), fov_deg=26.0)


def strokes_of(drawing: vp.Drawing) -> vp.Paths:
    """What hatches a drawing."""
    (paths,) = [paths for layer in drawing.layers if layer.name == "hatch" for paths in layer.strokes]
    return paths


def main(folder: Path) -> None:
    crossed = vp.Hatching("tone", spacing_mm=0.5, cross=True)
    town = vp.draw(vp.read(TOWN), page=vp.Page(150, 106), hatch=crossed)
    vp.save(town, folder / "hatched_town.svg")

    standing = vp.Item("STANDING", Torus(1.6, 0.45)).turned("x", 90.0).moved(2.4, 0.0, 0.6)
    rings = vp.Scene((vp.Item("LYING", Torus(2.4, 0.85)), standing), (SUN,), title="Rings")
    combed = vp.Hatching("tone", spacing_mm=0.6, cross=True, along="surface")
    lines = ("contour", "intersection")
    drawing = vp.draw(rings, CAMERA, page=vp.Page(120, 85), lines=lines, hatch=combed, tolerance_mm=0.1)
    vp.save(drawing, folder / "combed_rings.svg")

    ring = vp.Scene(rings.items[:1], (SUN,), title="Ring")
    dots = vp.draw(ring, CAMERA, page=vp.Page(150, 105), lines=lines, hatch=vp.Stippling(4000), tolerance_mm=0.1)
    vp.save(dots, folder / "stippled_ring.svg")

    assert len(strokes_of(dots)) == 4000
    on = strokes_of(drawing)
    lying = on.points3d[np.repeat(on.item == 0, np.diff(on.offsets))]
    off = np.hypot(np.hypot(lying[:, 0], lying[:, 1]) - 2.4, lying[:, 2]) - 0.85
    # Between the points of a stroke is a chord, which is right on the page.
    assert np.abs(off).max() < 0.01 and np.median(np.abs(off)) < 1e-6


if __name__ == "__main__":
    main(Path(sys.argv[1]))
