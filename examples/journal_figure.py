"""A figure for a journal: colours in classes with a scale bar, and two panels at one scale, on one line.

What is above the classes has a colour of its own. Letters are as large as type of so many points.
"""

import sys
from pathlib import Path

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Torus

BAR = vp.ScaleBar("nm", size_mm="8pt")


def main(folder: Path) -> None:
    classes = vp.Colouring("z", at=(-1.0, -0.5, 0.0, 0.5), over="red", label="$z$ in nm", size_mm="8pt")
    ring = vp.Scene((vp.Item("RING", Torus(3.0, 1.0)),), colouring=classes, scale_bar=BAR)
    vp.save(vp.paint(ring, "iso", page="scale 8:1", text="real"), folder / "journal_figure_classes.png")
    shapes = box((3.0, 2.0, 2.0)), Torus(1.5, 0.5), box((2.0, 2.0, 3.0))
    scenes = [vp.Scene((vp.Item("part", one),), page=vp.Page(margin_mm=1.0), scale_bar=BAR) for one in shapes]
    parts = [vp.draw(one, "iso", page="scale 10:1", hidden="dashed") for one in scenes]
    vp.save(vp.panels(parts, size_mm="10pt"), folder / "journal_figure_panels.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
