"""A room of mirrors, in lines: what is seen in them, and what is seen in those, three mirrors deep.

Every blue line is a line of a thing as one sees it in a mirror, hidden by what stands before it there, on a layer of
its own. The corner of two mirrors shows everything twice, and between them once more, turned round. Source: Glaeser,
section 6.4.
"""

import sys
from pathlib import Path

import vectorplot as vp
from vectorplot.geometry import box, revolution
from vectorplot.surfaces import Torus


def main(folder: Path) -> None:
    mirror = vp.Material("mirror")
    back = vp.Item("BACK", box((7, 0.1, 3.6)), material=mirror).moved(-3.5, 2.6, 0.1)
    left = vp.Item("LEFT", box((0.1, 6.0, 3.6)), material=mirror).moved(-3.7, -3.5, 0.1)
    floor = vp.Item("FLOOR", box((8, 7, 0.2))).moved(-4, -4, -0.2)
    ring = vp.Item("RING", Torus(0.85, 0.32), curves=vp.SurfaceLines(columns=12)).moved(-0.4, 0.3, 0.33)
    spike = vp.Item("SPIKE", revolution([(0.8, 0, 0), (0.25, 0, 1.2), (0, 0, 2.6)], 6)).moved(-1.9, -1.7, 0)
    cube = vp.Item("CUBE", box((1.1, 1.1, 1.1))).moved(1.5, -1.2, 0)
    scene = vp.Scene((floor, back, left, ring, spike, cube), title="A room of mirrors")
    camera = vp.Camera((8.5, -9.5, 6.0), (-0.3, -0.6, 1.1), fov_deg=34)
    lines, pens = "contour,boundary,crease,parameter", "reflected=0.15:#2f6fb0"
    drawing = vp.draw(scene, camera, page=vp.Page(160, 120, 5), lines=lines, reflections=3, pens=pens)
    vp.save(drawing, folder / "mirror_room.svg")

    reflected = next(layer for layer in drawing.layers if layer.name == "reflected")
    once = vp.draw(scene, camera, page=vp.Page(160, 120, 5), lines=lines)
    (shown,) = (layer for layer in once.layers if layer.name == "reflected")
    # Deeper mirrors show more, and nothing less.
    assert len(reflected.strokes[0]) > len(shown.strokes[0]) > 0


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
