"""The sheet of a long shaft, in views that are interrupted: two stretches that are the same all along are left out.

Whole it would be 1:5 on this sheet; so it is 1:1, and its measures are those of the whole.
"""

import sys
from pathlib import Path

import vectorplot as vp
from vectorplot.geometry import revolution

LENGTHS = (0, 40, 400, 420, 790, 820)
"""Where the steps of the shaft are along x."""


def shaft() -> vp.Mesh:
    """A shaft along x with a collar."""
    radii = (16, 20, 28, 20, 14)
    steps = [(r, 0, x) for r, one, two in zip(radii, LENGTHS, LENGTHS[1:], strict=False) for x in (one, two)]
    return revolution([(0, 0, 0), *steps, (0, 0, LENGTHS[-1])], 96).turned("y", 90)


def main(folder: Path) -> None:
    notes = [
        vp.chain_dimension([(x, 0, 20) for x in LENGTHS], (0, 0, 28), gap=2, beyond=2),
        vp.leader((55, 0, -20), (47, 0, -36), "ø40 h6"),
        vp.leader((410, 0, -28), (426, 0, -38), "ø56"),
        vp.leader((805, 0, 14), (814, 0, 30), "ø28 k6"),
    ]
    sheet = vp.technical_sheet(
        [vp.Item("shaft", shaft()), *notes],
        **{"views": "front", "interrupted": ["x=62..375", "x=444..768"], "section": "x=20"},
        **{"dimensions": True, "centre_lines": True, "frame": True, "title": "Shaft", "fields": {"Material": "C45E"}},
    )
    vp.save(sheet, folder / "long_shaft.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
