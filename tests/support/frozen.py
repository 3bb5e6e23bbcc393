"""Digests of many pictures, a line each: what is compared between two states of the package, or two processors.

``python tests/support/frozen.py FILE [PART/PARTS] [EXAMPLES]`` draws, paints and renders every scene of data/, as it is
and with options of a seed, and runs the first EXAMPLES scripts of examples/. It writes ``digest bytes picture`` of
each. Two such files that are the same say that the pictures are; ``diff`` names those that are not.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import vectorplot as vp

ROOT = Path(__file__).resolve().parents[2]

CHOICES: dict[str, list[Any]] = {
    "camera": ["iso", "front", "top", "left"],
    "hidden": ["dashed", "solid"],
    "lines": ["contour,crease,boundary"],
    "curves": ["polyline"],
    "tolerance_mm": [0.1],
    "halo_mm": [1.0],
    "layers": ["object", "colour"],
    "text": ["real"],
    "thin_ends": [True],
}
"""What is varied, besides pictures as they are."""

FORMATS = {"draw": ["svg", "ps", "pdf", "dxf", "json"], "paint": ["svg", "eps", "pdf", "tex"], "render": ["png"]}


def main(arguments: list[str]) -> None:
    """Write the file."""
    part, parts = map(int, arguments[1].split("/")) if len(arguments) > 1 else (0, 1)
    count = int(arguments[2]) if len(arguments) > 2 else 1000
    with open(arguments[0], "w", encoding="utf-8") as file, tempfile.TemporaryDirectory() as desk:
        for path in sorted((ROOT / "data").glob("*.scene"))[part::parts]:
            file.writelines(f"{line}\n" for line in of_scene(path, Path(desk)))
            file.flush()
        for path in sorted((ROOT / "examples").glob("*.py"))[:count][part::parts]:
            file.writelines(f"{line}\n" for line in of_example(path, Path(desk)))
            file.flush()


def of_scene(path: Path, desk: Path) -> list[str]:
    """The lines of a scene: every verb as it is, in every format, and drawn with a set of options."""
    scene, lines = vp.read(path), []
    for verb, formats in FORMATS.items():
        picture = getattr(vp, verb)(scene)
        lines += [_line(f"{path.stem} {verb} {kind}", _saved(picture, desk / f"x.{kind}")) for kind in formats]
    random = np.random.default_rng([*path.stem.encode()])
    for _ in range(2):
        names = sorted(random.choice(sorted(CHOICES), size=3, replace=False).tolist())
        chosen: dict[str, Any] = {name: CHOICES[name][int(random.integers(len(CHOICES[name])))] for name in names}
        lines.append(_line(f"{path.stem} draw {chosen}", _saved(vp.draw(scene, **chosen), desk / "x.svg")))
    return lines


def of_example(path: Path, desk: Path) -> list[str]:
    """The lines of the files that a script makes."""
    sys.path.append(str(ROOT / "docs"))
    from gallery import run_example

    return [_line(f"{path.stem} {file.name}", file.read_bytes()) for file in run_example(path, desk)]


def _saved(picture: Any, path: Path) -> bytes:
    vp.save(picture, path)
    return path.read_bytes()


def _line(name: str, data: bytes) -> str:
    return f"{hashlib.sha256(data).hexdigest()[:16]} {len(data)} {name}"


if __name__ == "__main__":
    main(sys.argv[1:])
