"""The table of textbook surfaces, with their nodes, pinch points and double lines: each is drawn in seconds."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from support.effort import several
from support.pace import cpu_seconds

import vectorplot as vp
from vectorplot.errors import InputWarning

SECONDS = 15.0
"""Of the processor; each takes one to three."""

TABLE = {
    "cayley": 'implicit "x^2+y^2+z^2-2*x*y*z-1" box -1.5 1.5 -1.5 1.5 -1.5 1.5',
    "chmutov": 'implicit "8*(x^4+y^4+z^4)-8*(x^2+y^2+z^2)+3" box -1.1 1.1 -1.1 1.1 -1.1 1.1',
    "whitney, implicit": 'implicit "x^2-y^2*z" box -1 1 -1 1 -1 1',
    "whitney, by parameters": 'function "u*v" "u" "v^2" u -1 1 v -1 1',
    "dupin": "cyclide 3 1 centre 5 0 0 radius 4",
    "clebsch": 'implicit "81*(x^3+y^3+z^3)-189*(x^2*y+x^2*z+y^2*x+y^2*z+z^2*x+z^2*y)+54*x*y*z+126*(x*y+x*z+y*z)'
    '-9*(x^2+y^2+z^2)-9*(x+y+z)+1" box -1 1 -1 1 -1 1',
    "tanglecube": 'implicit "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8" box -2.5 2.5 -2.5 2.5 -2.5 2.5',
}


@pytest.mark.slow
@pytest.mark.parametrize("name", list(TABLE)[: several(4, long=len(TABLE))])
def test_textbook_surfaces_are_drawn_in_seconds(name: str, tmp_path: Path) -> None:
    file = tmp_path / "surface.scene"
    file.write_text(f"S gray surface {TABLE[name]}\n")
    with cpu_seconds(SECONDS), warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", InputWarning)
        drawing = vp.draw(vp.read(file), vp.Camera((16.0, -22.0, 14.0), (0.0, 0.0, 0.0)))
    assert all(str(warning.message).startswith("S: ") for warning in said)
    # A ring has no more than its outer outline and that of its hole.
    assert sum(len(mark) for layer in drawing.layers for mark in layer.marks) >= 2
