"""What campaigns found and was mended: the smallest input of each cause, given to its target again."""

from __future__ import annotations

from pathlib import Path

import pytest
from fuzz.fuzz_oracle import judged

CAMERA = "camera eye 10 -5 6 target 1 0 0\n"

FOUND = {
    "a file of molecules without a block": ("cif", "cif", "\r\n"),
    "a catenoid without end": ("draw", "scene", "I4 surface catenoid 9223372036854775808 angle 0 360\n"),
    "a torus a milliard times as wide as thick": ("draw", "scene", "x surface implicit_torus 1e9\n"),
    "a shadow whose sides run back on each other": (
        "paint",
        "scene",
        CAMERA + "light LAMP position 0 0 9 intensity 0.5\n"
        "I5 lines curve revolution meridian -3.035484366 2.9761057101 -0.57, -4 0.71 .5, -0.25 3 -1.80\n"
        "order 8 hollow colour darkorange refraction 0.8 +bottom\n",
    ),
    "an intersection without digits": (
        "info",
        "scene",
        "A rotation x -2.183204595 box 1.147650224 -3.685244 5 hollow matrix 4294967296 -0.44252045 5. -1.646"
        " -0.25 -3.208 -1 3.6685119 6 2 -2.6396951 -0.94031\n"
        "B matrix -1 2.6 4 0.50297521 +1 -0.25 9223372036854775808 0.7446217867 .5 0.59507200 +1 3.8"
        " box -4.945 -0.3209 +1 translation 1.2067656 4 1e1\n"
        "C intersection B, A solid cyan\n",
    ),
}
"""Target, suffix and content, by what it is."""


@pytest.mark.parametrize("cause", FOUND)
def test_what_was_found_stays_mended(tmp_path: Path, cause: str) -> None:
    target, suffix, content = FOUND[cause]
    found = judged(target, content.encode(), suffix, tmp_path)
    assert found is None, found.story
