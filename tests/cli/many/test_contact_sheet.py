"""``vectorplot contact-sheet``: files, views and values side by side, by any verb and any workers."""

from __future__ import annotations

import json

import pytest

from vectorplot.cli.main import run

SCENE = "camera eye 5 -7 4\nDIE red box solid 1 2 {}\n"


@pytest.fixture
def dice(tmp_path, monkeypatch):
    """A folder with two scenes, a and b, and what is no scene."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "dice").mkdir()
    for name, height in (("a", 1), ("b", 3)):
        (tmp_path / "dice" / f"{name}.scene").write_text(SCENE.format(height), encoding="utf-8")
    (tmp_path / "dice" / "notes.md").write_text("none", encoding="utf-8")
    return tmp_path


def sheet(*words):
    assert run(["contact-sheet", "dice", "-o", "sheet.json", *words]) == 0
    with open("sheet.json", encoding="utf-8") as file:
        return json.load(file)


def places(found, columns, rows):
    """How many strokes lie in each cell, from the upper left."""
    width, height = found["page_mm"]
    counts = [[0] * columns for _ in range(rows)]
    for stroke in found["strokes"]:
        x, y = (sum(axis) / len(axis) for axis in zip(*stroke["points"], strict=True))
        counts[int((height - y) / height * rows)][int(x / width * columns)] += 1
    return counts


def test_there_is_a_drawing_for_each_file_and_each_value_in_reading_order(dice):
    found = sheet("--vary", "view=front,iso", "--columns", "2", "--no-names", "--page", "120x100")
    assert found["page_mm"] == [120.0, 100.0]
    (front, iso), below = places(found, 2, 2)
    assert 0 < front < iso and below == [front, iso]


def test_sheets_may_be_landscape_as_pages_of_draw(dice):
    sizes = [sheet("--page", *words)["page_mm"] for words in (["A5", "--landscape"], ["A5 landscape"])]
    assert sizes == [[210.0, 148.0]] * 2


def test_names_say_what_each_drawing_shows(dice):
    bare, named = sheet("--no-names"), sheet()
    assert len(named["strokes"]) > len(bare["strokes"])
    letters = [stroke for stroke in named["strokes"] if stroke["kind"] not in {one["kind"] for one in bare["strokes"]}]
    assert letters


@pytest.mark.slow
def test_long_names_stand_in_smaller_letters_or_in_several_lines(dice):
    name = "a scene with a name as long as names of scenes can ever be in folders of people who like them.scene"
    (dice / "dice" / name).write_text(SCENE.format(2), encoding="utf-8")
    varied = ["--vary", "style=plain,book", "--vary", "view=front,iso", "--cell", "60x50"]
    found, bare = sheet(*varied), sheet(*varied, "--no-names")
    assert len(found["strokes"]) > len(bare["strokes"]) + 12 * 30


@pytest.mark.slow
def test_workers_make_the_same_sheet_and_paint_makes_one_too(dice):
    words = ["--with", "paint --shadows none --flat", "--vary", "palette=8,32"]
    for out, more in (("one.svg", []), ("two.svg", ["--workers", "1"])):
        assert run(["contact-sheet", "dice", "-o", out, *words, *more]) == 0
    assert (dice / "one.svg").read_bytes() == (dice / "two.svg").read_bytes()


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["--vary", "view"], 2, "OPTION=VALUE"),
        (["--vary", "view=front,aslant"], 2, "aslant"),
        (["--vary", "wrong=1"], 2, "No such option '--wrong'"),
        (["--vary", "fov=" + ",".join(["30"] * 600)], 2, "1200 drawings"),
        (["--with", "render"], 2, "none of draw, paint"),
        (["--with", "draw 'a"], 2, "closing quotation"),
        (["--with", "draw --explain"], 2, "--explain does not go into --with"),
        (["--with", "draw --text latex"], 2, "--text latex"),
        (["--cell", "fit"], 2, "expected a size"),
        (["--gap", "500"], 1, "no room for 2 drawings"),
        (["none.scene"], 1, "none.scene"),
        (["-o", "none/sheet.svg"], 1, "none"),
        (["-o", "sheet.exe"], 2, "must end in"),
    ],
    ids=lambda given: None if isinstance(given, int | str) else " ".join(given)[:30],
)
def test_what_is_wrong_is_said_and_nothing_is_written(dice, words, status, said, capsys):
    assert run(["contact-sheet", "dice", "-o", "sheet.svg", *words]) == status
    assert said in capsys.readouterr().err.splitlines()[-1]
    assert not list(dice.glob("sheet.*"))
