"""The sheet of an assembly: a half section, a detail, chains of dimensions, balloons, and a list of parts.

A shaft turns in a bush, which sits in a block on a base; two screws hold the block. Dimensions say with which fits.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import prism, regular_polygon

SCREWS = (15.0, 85.0)


def block() -> vp.Mesh:
    """A block with feet, 100 x 40 x 42, with a bore along y and two across its feet."""
    outline = [(0, 0, 0), (100, 0, 0), (100, 0, 14), (74, 0, 14), (74, 0, 42), (26, 0, 42), (26, 0, 14), (0, 0, 14)]
    return prism(outline, (0, 40, 0), holes=[upright(regular_polygon(64, 13), (50, 0, 24))])


def upright(ring: np.ndarray, centre: tuple[float, float, float]) -> np.ndarray:
    """A level ring, across y about a point."""
    return np.column_stack([ring[:, 0], np.zeros(len(ring)), ring[:, 1]]) + centre


def bush() -> vp.Mesh:
    """A tube along y, 46 long, with a little play in the block."""
    outer, inner = (upright(regular_polygon(64, radius), (50, -3, 24)) for radius in (12.9, 10))
    return prism(outer[::-1], (0, 46, 0), holes=[inner])


def shaft() -> vp.Mesh:
    """A cylinder along y, 64 long, with a little play in the bush."""
    return prism(upright(regular_polygon(64, 9.8), (50, -12, 24))[::-1], (0, 64, 0))


def screw(number: int, x: float) -> tuple[vp.Item, ...]:
    """A head with six sides on a shank."""
    name = f"screw {number}"
    head = prism(regular_polygon(6, 7, centre=(x, 20, 14)), (0, 0, 6))
    shank = prism(regular_polygon(32, 4, centre=(x, 20, 0)), (0, 0, 14))
    return vp.Item(f"head {number}", head, group=name), vp.Item(f"shank {number}", shank, group=name)


def main(folder: Path) -> None:
    parts = [
        vp.Item("block", block()),
        vp.Item("bush", bush()),
        vp.Item("shaft", shaft()),
        *(one for number, x in enumerate(SCREWS, start=1) for one in screw(number, x)),
    ]
    out = {"gap": 1, "beyond": 2}
    notes = [
        vp.chain_dimension([(0, 0, 0), (15, 0, 0), (85, 0, 0), (100, 0, 0)], (0, 0, -10), **out),
        vp.dimension((0, 0, 0), (100, 0, 0), (0, 0, -10), "<> h9", **out),
        vp.ordinate_dimension([(100, 0, 0), (100, 0, 14), (74, 0, 24), (74, 0, 42)], (12, 0, 0), gap=1),
        vp.leader((57, -12, 31), (84, -12, 62), "ø20 f7"),
        vp.centre_line((50, -16, 24), (50, 56, 24)),
        vp.centre_mark((50, -12, 24), 13, (0, 1, 0), beyond=4),
        *(vp.centre_line((x, 20, -3), (x, 20, 23)) for x in SCREWS),
    ]
    sheet = vp.technical_sheet(
        [*parts, *notes],
        **{"views": "front,top,iso", "section": ["half x=50", "y=20"], "detail_view": "B:15,20,14,9,2:1"},
        **{"balloons": True, "parts_list": True, "frame": True, "decimals": 2, "title": "Bearing"},
        **{"fields": {"Material": "see list", "Mass": "1,9 kg", "Tolerances": "ISO 2768-m"}, "author": "vectorplot"},
    )
    vp.save(sheet, folder / "assembly_sheet.svg")
    assert [(one.title, len(one)) for one in vp.part_scenes(vp.Scene(tuple(parts)))] == [
        ("block", 1),
        ("bush", 1),
        ("shaft", 1),
        ("screw", 2),
    ]


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
