"""Eight numbers of twelve bits in three words of thirty-two: how coordinates of a film are stored.

Above the eight numbers, a colour each, below the three words; two of the numbers are cut by the border between words.
A filled square is a bit that is set. Source: Glaeser, section 10.1, figure 1.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import GREY, INK, layer, polygons, strokes

import vectorplot as vp

NUMBERS = np.array([0xA5C, 0x3F1, 0x90E, 0x6B7, 0xD22, 0x18F, 0xE64, 0x57B])
COLOURS = ["#1f5fa8", "#c2810c", "#2c7d4f", "#c8352b", "#5a8fc4", "#d9a23c", "#5fa57c", "#dc7269"]
PALE = ["#d3e3f3", "#f6e5c3", "#d3ebdb", "#f6d3cf", "#e3edf7", "#faf0da", "#e4f3ea", "#fae4e2"]
SIDE, GAP = 4.6, 3.4


def packed(numbers: np.ndarray) -> np.ndarray:
    """Three numbers of 32 bits that hold eight of 12."""
    bits = (numbers[:, None] >> np.arange(11, -1, -1)) & 1
    return (bits.reshape(3, 32) << np.arange(31, -1, -1)).sum(axis=1)


def main(folder: Path) -> None:
    words = packed(NUMBERS)
    back = ((words[:, None] >> np.arange(31, -1, -1)) & 1).reshape(8, 12)
    assert ((back << np.arange(11, -1, -1)).sum(axis=1) == NUMBERS).all(), "and out again"

    bit = np.arange(96)
    box = SIDE * np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    inner = SIDE * np.array([(0.24, 0.24), (0.76, 0.24), (0.76, 0.76), (0.24, 0.76)])
    wide = 32 * SIDE + 2 * 9
    high, low = 9 + 3 * (SIDE + GAP) + 48, 9
    row, column = np.divmod(bit // 12, 4)
    spread = (wide - 18 - 48 * SIDE * 0.62) / 3
    small = 0.62
    above = np.column_stack(
        [9 + column * (12 * SIDE * small + spread) + (bit % 12) * SIDE * small, high - row * 16.0 - 2.0]
    )
    below = np.column_stack([9 + (bit % 32) * SIDE, low + (2 - bit // 32) * (SIDE + 2 * GAP)])
    flag = back.ravel() == 1
    number = bit // 12
    cells = [*(above[:, None] + small * box), *(below[:, None] + box)]
    marks = [*(above[flag, None] + small * inner), *(below[flag, None] + inner)]
    tints = [PALE[k] for k in number] * 2
    inks = [COLOURS[k] for k in number[flag]] * 2
    curves, part = [], np.linspace(0, 1, 33)[:, None]
    for k in range(8):
        for run in np.split(bit[number == k], np.flatnonzero(np.diff(bit[number == k] // 32)) + 1):
            start = above[run].mean(axis=0) + small * SIDE * np.array([0.5, 0.0])
            end = below[run].mean(axis=0) + SIDE * np.array([0.5, 1.0])
            s, e = start - (0, 0.6), np.add(end, (0, 0.6))
            lift = np.array([0, 0.5 * (s[1] - e[1])])
            c = [s, s - lift, e + lift, e]
            curves.append(
                (
                    k,
                    (1 - part) ** 3 * c[0]
                    + 3 * (1 - part) ** 2 * part * c[1]
                    + 3 * (1 - part) * part**2 * c[2]
                    + part**3 * c[3],
                )
            )
    frames = [below[32 * w] + np.array([(0, 0), (32 * SIDE, 0), (32 * SIDE, SIDE), (0, SIDE)]) for w in range(3)]
    layers = (
        *(layer(f"way {k}", strokes([c for j, c in curves if j == k]), COLOURS[k], 0.5) for k in range(8)),
        layer("cells", polygons(cells, tints)),
        layer("grid", strokes(cells, closed=True), GREY, 0.15),
        layer("bits", polygons(marks, inks)),
        layer("words", strokes(frames, closed=True), INK, 0.5),
    )
    vp.save(vp.Drawing(wide, high + 12, layers, title="Packed numbers"), folder / "packed_coordinates.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
