"""Pictures of hard cases, for the table of docs/stability.md: the scenes of docs/hard_case_pictures.toml, drawn small.

``python docs/hard_case_pictures.py [NUMBER...]`` writes docs/hard_cases/*.svg. A test looks for all of them, and draws
some again.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import vectorplot as vp
from vectorplot.io import parse_scene

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "hard_cases"

PAGE = vp.Page(60.0, 45.0, 2.0)
PENS = "contour=0.35,crease=0.25,boundary=0.35,intersection=0.35:#c0392b,curve=0.3:#c0392b,hidden=0.15:#8090a0,0.2"


class Picture(NamedTuple):
    """A scene in the scene language, which lines are drawn of it, and what becomes of hidden ones; painted: with light
    on its faces, and lines on top."""

    scene: str
    lines: str = "contour,boundary,crease,intersection,curve"
    hidden: str = "none"
    painted: bool = False

    def drawing(self) -> vp.Drawing:
        """The picture on its page."""
        scene = parse_scene(self.scene)
        if self.painted:
            return vp.paint(scene, page=PAGE, lines="contour,boundary,crease", tolerance_mm=0.1)
        return vp.draw(scene, page=PAGE, lines=self.lines, hidden=self.hidden, pens=PENS)


PICTURES = {
    int(number): Picture(**told)
    for number, told in tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")).items()
}
"""By the numbers of docs/hard_cases.toml."""


def main() -> None:
    """Draw all pictures; or those whose numbers are given."""
    FOLDER.mkdir(exist_ok=True)
    for number in [int(word) for word in sys.argv[1:]] or PICTURES:
        vp.save(PICTURES[number].drawing(), FOLDER / f"{number}.svg")


if __name__ == "__main__":
    main()
