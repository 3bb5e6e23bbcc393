"""A picture with nothing on it is said to be empty, why it is, and what would show something."""

import shlex

import pytest
from click.testing import CliRunner

from vectorplot.cli.verbs import vectorplot

BOX = "CUBE blue box 1 1 1"
SHEET = "SHEET blue polyhedron solid\n vertices 0 0 0, 1 0 0, 1 1 0, 0 1 0\n faces 1 2 3 4"
NOWHERE = 'NONE blue surface implicit "x^2 + y^2 + z^2 + 1" box -1 1 -1 1 -1 1'
DIAGONAL = 'SHEET blue surface graph "x" x 0 1 y 0 1 lines none'

CASES = [
    ("# nothing stands here", "", "there is nothing in it: a line such as 'CUBE blue box 1 1 1'"),
    (BOX, "--eye 10,0,0 --target 20,0,0", "behind the eye: it looks from 10,0,0 to 20,0,0"),
    (BOX, "--eye 10,0,0 --target 20,0,0 --no-fit", "try --target 0.5,0.5,0.5"),
    (BOX, "--eye 10,0,0 --target 10,10,0 --no-fit", "left of the page: all lies between 0,0,0 and 1,1,1; try --fit"),
    (BOX, "--eye 10,5,0 --target 10,-10,0 --no-fit", "right of the page"),
    (BOX, "--eye 10,0,0 --target 0,0,30 --no-fit", "below the page"),
    (BOX, "--eye 10,0.5,0 --target 8,0.5,-30", "above the page"),
    (BOX, "--near 100", "nearer than 100, 2.979 to 4.642 away; leave out --near"),
    (BOX, "--eye 5,5,5 --far 1", "farther than 1, 6.928 to 8.66 away; leave out --far"),
    (BOX, "--cut x>-1", "all is cut away"),
    (DIAGONAL, "", "seen from its edge"),
    (NOWHERE, "", "has nothing that shows"),
]


def said(tmp_path, verb: str, text: str, options: str) -> str:
    (tmp_path / "x.scene").write_text(text + "\n", encoding="utf-8")
    out = tmp_path / ("x.png" if verb == "render" else "x.svg")
    result = CliRunner().invoke(vectorplot, [verb, str(tmp_path / "x.scene"), "-o", str(out), *shlex.split(options)])
    assert result.exit_code == 0 and out.exists()
    return result.stderr


@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
@pytest.mark.parametrize(("text", "options", "why"), CASES)
def test_an_empty_picture_says_why_and_what_to_type(tmp_path, verb, text, options, why):
    lines = [line for line in said(tmp_path, verb, text, options).splitlines() if "the picture is empty: " in line]
    assert len(lines) == 1 and "x.scene: " in lines[0] and why in lines[0]


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("--lines none", "kinds asked for (none)"),
        ("--lines isophote", "kinds asked for (isophote) are seen; try --lines contour,boundary,crease"),
        ("--eye 0.5,0.5,0.5 --target 1,0.5,0.5", "amid what it looks at: all lies between 0,0,0 and 1,1,1; try --eye"),
    ],
)
def test_a_drawing_without_lines_says_so(tmp_path, options, why):
    assert why in said(tmp_path, "draw", BOX, options)


def test_a_picture_with_something_on_it_and_a_quiet_command_say_nothing(tmp_path):
    assert said(tmp_path, "draw", BOX, "") == ""
    assert said(tmp_path, "draw", "# nothing", "--quiet") == ""


def test_an_empty_sheet_is_said(tmp_path):
    assert "there is nothing in it" in said(tmp_path, "sheet", "# nothing", "--no-block")
