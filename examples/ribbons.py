"""A bowl of three lobes and a ring, each cut into slices that are painted ribbon by ribbon.

The scene says ``slices`` and how many: each surface is painted slice by slice towards the height of the eye, in each
slice one ribbon after the other, the farther one first. The lines between the slices are drawn on top. Source: Glaeser,
section 5.3, figures 4 and 5.
"""

import sys
from pathlib import Path

import vectorplot as vp

SCENE = Path(__file__).parent.parent / "data" / "slices.scene"


def main(folder: Path) -> None:
    scene = vp.read(SCENE)
    told = []
    drawing = vp.paint(
        scene, page=vp.Page(120, 80, 4), lines="contour,boundary,section", tolerance_mm=0.05, explain=told.append
    )
    found = [report for report in told if report.name == "ribbons"]
    assert [report.why.split(":")[0] for report in found] == ["BOWL", "RING"], "both are painted slice by slice"
    assert all(report.count > 12 for report in found), "slices fall into several ribbons"
    vp.save(drawing, folder / "ribbons.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
