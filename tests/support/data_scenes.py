"""The scenes of data/, and those of them that take little time."""

from __future__ import annotations

from pathlib import Path

import vectorplot as vp
from support.effort import several
from support.paths import DATA

SCENES = sorted(DATA.glob("*.scene"))


def scenes_to_try() -> list[Path]:
    """In ci those with a polygon: with polygons there are smooth surfaces of all sorts, and curves; in long all."""
    return [path for path in SCENES if several(0, long=1) or any(i.mesh.face_count for i in vp.read(path).items)]
