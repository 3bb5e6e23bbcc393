"""Names of items: in every error about them, and in what is said of items that pierce each other."""

import json
import warnings

import pytest

from vectorplot.cli.main import run
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.scene_language import parse_scene

NAMES = ["PYRAMID", "CUBE1", "TRANSLATIONAL_SWEEP", '"my box"', "Straße", '"camera"', '"a \\"b\\""', "x.y-3"]
WRONG = {
    "no kind": "gray",
    "a length": "box 1 x 1",
    "a second kind": "box 1 1 1 revolution",
    "an order": "revolution meridian 1 0 0, 1 0 1 order 2",
    "a meridian": "revolution meridian 1 0 0 order 9",
    "a vertex": "vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 9",
    "an edge": "vertices 0 0 0, 1 0 0, 0 1 0 edges 1 4 faces 1 2 3",
    "a face": "box 1 1 1 removed_faces 7",
    "a pattern": "box 1 1 1 patterns face 7 polygon P red 0 0, 1 0, 0 1",
    "too few points": "box 1 1 1 patterns face 1 polygon P red 0 0, 1 0",
    "an opacity": "opacity 2 box 1 1 1",
    "a refraction": "refraction -1 box 1 1 1",
    "lines": "lines contours box 1 1 1",
    "occludes": "occludes maybe box 1 1 1",
    "a group": "group 3 box 1 1 1",
    "a family": "surface tours 3 1",
    "a slot": "surface torus major x",
    "parameter lines": "surface torus 3 1 parameter_lines -1 2",
    "isophotes": "surface torus 3 1 isophotes at 2",
    "sections": "surface torus 3 1 sections w 3",
    "a curve": 'curve "t" "t"',
    "parts": "intersection NOBODY OTHER",
    "a base": "translation base_points 0 0 0, 1 0 0 trans_vector 0 0 1",
    "a scale": "box 1 1 1 scale 0",
    "a rotation": "box 1 1 1 rotation w 3",
}


def plain(name: str) -> str:
    return json.loads(name) if name.startswith('"') else name


@pytest.mark.capability("G3.L-name")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("wrong", WRONG)
def test_every_error_about_an_item_says_its_name(name, wrong):
    with pytest.raises(InputError) as told:
        parse_scene(f"FIRST box 1 1 1\n{name} {WRONG[wrong]}")
    assert plain(name) in str(told.value) and "FIRST" not in str(told.value)


@pytest.mark.capability("G3.L-name")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    "what",
    [
        "gren box 1 1 1",
        "translation base_points 0 0 0, 1 0 0, 1 1 0.3, 0 1 0 trans_vector 0 0 1",
        "convex vertices 0 0 0, 4 0 0, 4 4 0, 2 1 0, 0 4 0, 0 0 1, 4 0 1, 4 4 1, 2 1 1, 0 4 1\n"
        "faces 5 4 3 2 1, 6 7 8 9 10, 1 2 7 6, 2 3 8 7, 3 4 9 8, 4 5 10 9, 5 1 6 10",
    ],
)
def test_every_warning_about_an_item_says_its_name(name, what):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", InputWarning)
        refused = []
        try:
            parse_scene(f"{name} {what}")
        except InputError as error:
            refused.append(str(error))
    said = refused + [str(one.message) for one in told]
    assert said and all(plain(name) in one for one in said)


@pytest.mark.capability("G3.L-name")
@pytest.mark.parametrize("name", NAMES)
def test_the_list_of_gordian_knots_has_the_names(name, tmp_path, capsys):
    path = tmp_path / "knot.scene"
    path.write_text(
        f"camera eye 9 -14 7\n{name} box 4 1 1\nOTHER box 1 4 1 translation 1 -1 0.5\n"
        "LOOSE box 1 1 1 translation 9 9 0\n",
        encoding="utf-8",
    )
    assert run(["paint", str(path), "-o", str(tmp_path / "x.svg"), "--explain"]) == 0
    told = next(line for line in capsys.readouterr().err.splitlines() if line.startswith("cut "))
    assert plain(name) in told and "OTHER" in told and "LOOSE" not in told


@pytest.mark.capability("G3.L-name")
@pytest.mark.parametrize("verb", ["draw", "paint", "info"])
def test_names_stand_in_what_every_verb_gives(verb, tmp_path, capsys):
    path = tmp_path / "named.scene"
    path.write_text(
        "".join(f"{name} box 1 1 1 translation {3 * k} 0 0\n" for k, name in enumerate(NAMES)), encoding="utf-8"
    )
    if verb == "info":
        assert run(["info", str(path)]) == 0
        text = capsys.readouterr().out
        assert all(plain(name) in text for name in NAMES)
        return
    assert run([verb, str(path), "-o", str(tmp_path / "x.json")]) == 0
    marks = json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))
    found = {mark["item"] for mark in marks["strokes" if verb == "draw" else "fills"]}
    assert found == {plain(name) for name in NAMES}
