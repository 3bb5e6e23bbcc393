"""One scene in four styles: the book's strong outlines, the draft's thin lines, a blueprint, and pens of one's own.

A style is a look: which lines are shown, and the pens, dashes and paper that go together. Pens go by kind of line, by
item, and by both; where lines converge they stop early in turn, so that the apex makes no blot.
"""

import sys
from pathlib import Path

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Cone, Torus

OWN = {"contour": "0.7:#20304a", "TENT": "0.18:red", "RING.contour": "0.7:orange"}


def scene() -> vp.Scene:
    """A tent of many poles, a ring around it, and a box in front."""
    poles, tiles = vp.SurfaceLines(columns=72), vp.SurfaceLines(columns=18, rows=8)
    tent = vp.Item("TENT", Cone(1.0).scaled(1.6, 1.6, -3.0).moved(z=3.0), curves=poles)
    ring = vp.Item("RING", Torus(2.6, 0.35), curves=tiles).moved(z=0.35)
    crate = vp.Item("CRATE", box((1.2, 1.2, 1.2))).turned("z", 25).moved(1.4, -3.9, 0.0)
    return vp.Scene((tent, ring, crate), title="Styles")


def main(folder: Path) -> None:
    shown = scene()
    camera, page = vp.Camera((6, -13, 6), (0.3, -0.6, 1.1), fov_deg=26), "90x80"
    drawings = {
        name: vp.draw(shown, camera, page=page, style=name, thin_ends=True) for name in ("book", "draft", "blueprint")
    }
    drawings["own"] = vp.draw(shown, camera, page=page, pens=OWN, layers="kind,object", thin_ends=True)
    for name, drawing in drawings.items():
        drawing.save(folder / f"styles_{name}.svg")

    pens = {layer.name: layer.pen.colour for layer in drawings["own"].layers}
    assert pens["contour RING"] != pens["contour CRATE"], "pens by item and kind"
    paper = drawings["blueprint"].layers[0]
    assert paper.name == "background" and not paper.plotted, "plotters skip the paper"
    assert all(layer.plotted for layer in drawings["book"].layers), "and nothing else"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
