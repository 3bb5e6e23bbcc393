"""Sizes of painted surfaces as files, for docs/paint.md: run with ``pytest tests/bench/bench_sizes.py -s``.

Each surface alone, on A4, in the default view, without lights of its own, at several tolerances.
"""

from __future__ import annotations

import time

import pytest

import vectorplot as vp
from vectorplot.save import write

pytestmark = pytest.mark.bench

FORMATS = ("svg", "pdf", "ps")
TOLERANCES_MM = (0.02, 0.05, 0.2)
SURFACES = {
    "sphere": "sphere 1",
    "torus": "torus 3 1",
    "Dupin's cyclide": "cyclide 3 1 centre 6.5 0 0 radius 5",
    "x^4 + y^4 + z^4 = 4": 'implicit "x^4+y^4+z^4-4" box -2 2 -2 2 -2 2',
    "sin(3x) cos(2y)": 'graph "sin(3*x)*cos(2*y)" x -2 2 y -2 2',
    "a spring of three turns": "helical 0.4 circle 0.5 centre 3 0 0 axis 0 1 0 angle 0 1080",
}


def sizes(surface: str, folder: str, tolerance_mm: float) -> list[float]:
    """The sizes of a picture of a surface in kB, one a format, and the seconds that it takes without writing."""
    with open(f"{folder}/a.scene", "w", encoding="utf-8") as file:
        file.write(f"S gray surface {surface}\n")
    start = time.process_time()
    drawing = vp.paint(vp.read(f"{folder}/a.scene"), tolerance_mm=tolerance_mm)
    seconds = time.process_time() - start
    return [*(len(write(drawing, form)) / 1000.0 for form in FORMATS), seconds]


def report(folder: str) -> str:
    """The sizes as a table of Markdown."""
    columns = [f"{form.upper()} at {size:g}" for size in TOLERANCES_MM for form in (*FORMATS, "seconds")]
    rows = [f"| | {' | '.join(columns)} |", "| --- " * (len(columns) + 1) + "|"]
    for name, surface in SURFACES.items():
        found = [sizes(surface, folder, size) for size in TOLERANCES_MM]
        rows.append(f"| {name} | {' | '.join(f'{number:.3g}' for some in found for number in some)} |")
    return "\n".join(rows)


def test_sizes_of_surfaces(tmp_path):
    found = report(str(tmp_path))
    print("\n" + found)


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as place:
        print(report(place))
