"""The eight palettes, and the light and dark subpalettes that each of them holds.

A dark subpalette has every shade of the lower half of its parent twice, a light one every shade of the upper half: 24
palettes share one colour map of 256 entries. Source: Glaeser, section 4.3, figure 1.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.shading import PALETTE_LIMITS, PALETTE_SIZE, colour_map, palette

CELL_MM = np.array([3.6, 6.0])


def row(shades: np.ndarray, left: float, bottom: float, height: float) -> Fills:
    """The shades of a palette side by side."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * (CELL_MM[0], height)
    steps = np.column_stack([np.arange(len(shades)) * CELL_MM[0], np.zeros(len(shades))])
    points = np.array((left, bottom)) + (steps[:, None] + corners).reshape(-1, 2)
    return Fills.flat(points, 4 * np.arange(len(shades) + 1), shades)


def main(folder: Path) -> None:
    rows = []
    for number, name in enumerate(reversed(PALETTE_LIMITS)):
        bottom = 6.0 + 14.0 * number
        shades, light, dark = palette(name), palette(f"light{name}"), palette(f"dark{name}")
        rows += [
            row(shades, 6, bottom + 5, 5),
            row(dark, 6, bottom, 4),
            row(light, 6 + PALETTE_SIZE * CELL_MM[0], bottom, 4),
        ]
        assert (light[-1] == shades[-1]).all() and (dark[0] == shades[0]).all()
        assert (light[::2] == shades[PALETTE_SIZE // 2 :]).all() and (dark[::2] == shades[: PALETTE_SIZE // 2]).all()
        assert {tuple(c) for c in (*light.tolist(), *dark.tolist())} == {tuple(c) for c in shades.tolist()}
    drawing = vp.Drawing(246, 124, (vp.Layer("palettes", vp.Pen(), (Fills.joined(*rows),)),), title="Palettes")
    vp.save(drawing, folder / "subpalettes.svg")

    entries = colour_map([f"{half}{name}" for half in ("", "light", "dark") for name in PALETTE_LIMITS])
    assert len(entries.entries) == 256 and entries.size == PALETTE_SIZE


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
