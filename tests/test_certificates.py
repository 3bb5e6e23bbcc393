"""Certificates of drawings: right ones are proved, mutated ones are caught, and what cannot be proved is said."""

import ast
import json
import runpy
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.effort import several
from support.mutations import MUTATIONS, SCENES, SMOOTH, SMOOTH_PAGE, Proof, faults, mutated
from support.mutations import drawn as drawn_of
from support.paths import DATA, PACKAGE

import vectorplot as vp
from vectorplot.backends.json import json_bytes
from vectorplot.cli.main import run
from vectorplot.curves import Circle, Line
from vectorplot.errors import InputError
from vectorplot.features import mesh_of_grid
from vectorplot.geometry import box
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces import (
    Capped,
    Cone,
    Cylinder,
    Ellipsoid,
    Frustum,
    HyperbolicParaboloid,
    Hyperboloid,
    Paraboloid,
    Sphere,
    Torus,
    helical_surface,
    helicoid_to_catenoid,
    revolution_surface,
    translation_surface,
)
from vectorplot.testing import assert_certified, certificate
from vectorplot.testing.certificates import feet_in_planes, surfaces_of
from vectorplot.testing.certified_image import image_of
from vectorplot.testing.certified_surfaces import NUMBERS, contour_cells, deviations, patch_of, value_of
from vectorplot.testing.check_certificate import check

CHECKER = PACKAGE / "testing" / "check_certificate.py"


def told(drawing, made):
    """What the checker says of two files that are read again."""
    return check(json.loads(json_bytes(drawing)), json.loads(bytes(made)))


@pytest.fixture(scope="module")
def drawn():
    """Scenes of data/ with all their lines, as in a file."""
    return [Proof(*pair, "solid") for pair in drawn_of(SCENES, "solid")]


@pytest.mark.parametrize("hidden", ["none", "dashed", "solid"])
def test_drawings_of_meshes_are_proved(hidden):
    for name in SCENES:
        scene = vp.read(DATA / f"{name}.scene")
        counts = assert_certified(scene, vp.draw(scene, hidden=hidden, reflections=0), hidden=hidden)
        assert counts["strokes"] and counts["lines"] and counts["triangles"]


@pytest.mark.slow
def test_a_scanned_model_is_proved():
    rabbit = vp.read(DATA / "rabbit.ply")
    assert assert_certified(rabbit, vp.draw(rabbit, hidden="solid"), hidden="solid")["triangles"] == 36588


def test_what_few_strokes_prove_is_so_of_the_whole(drawn):
    """Faults that are found by the strokes that changed alone are faults of the whole drawing."""
    proof = drawn[SCENES.index("table")]
    rng = np.random.default_rng(4)
    for mutation in MUTATIONS:
        other = mutated(rng, proof.drawing, mutation)
        assert proof.faults(other) and faults(proof.scene, other, "solid")


def test_the_dash_of_a_level_line_begins_in_its_plane():
    """Ends of dashes are on chords: the point of a ball that is nearest to one is 0.01 higher or lower."""
    turn, height = np.linspace(0.4, 6.0, 9), np.array([-0.8, 0.3, 0.8] * 3)
    away = 0.98 * np.sqrt(1.0 - height**2)
    chord = np.stack([away * np.cos(turn), away * np.sin(turn), height], axis=1)
    feet = np.stack([turn, np.arcsin(height / np.linalg.norm(chord, axis=1))], axis=1)
    planes = np.array([[0.0, 0.0, 2.0, 2.0 * offset] for offset in (-0.8, 0.3, 0.8)])
    patch = ball_of()
    assert np.abs(patch.points(*feet.T)[:, 2] - height).min() > 0.005
    found = feet_in_planes(patch, feet, chord, planes)
    assert np.abs(patch.points(*found.T)[:, 2] - height).max() < 1e-4
    assert np.abs(found[:, 0] - turn).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.__name__)
def test_mutated_drawings_are_caught(drawn, mutation):
    rng = np.random.default_rng(6)
    caught = 0
    while caught < several(8, long=170):
        proof = drawn[int(rng.integers(len(drawn)))]
        other = mutated(rng, proof.drawing, mutation)
        if other is not None:
            assert proof.faults(other)
            caught += 1


def test_a_part_in_front_of_nothing_is_not_taken_for_hidden():
    """A certificate that names what does not hide a stroke: the stroke lies in the face that is named, or before it."""
    cube = box((2, 2, 2))
    drawing = json.loads(json_bytes(vp.draw(cube, "iso")))
    made = certificate(cube, vp.draw(cube, "iso"), "iso").content
    assert check(drawing, made)[:2] == ([], [])
    for stroke in drawing["strokes"]:
        stroke["hidden_by"] = 1
    segments = [
        (k, j) for k, one in enumerate(drawing["strokes"]) for j in range(len(one["points"]) - (not one["closed"]))
    ]
    for triangle in range(12):
        rows = [[stroke, segment, 0.0, 1.0, triangle] for stroke, segment in segments]
        wrong, _, _ = check(drawing, {**made, "hidden_strokes": rows})
        assert any(line.startswith("hidden by nothing that is named") for line in wrong)


def test_lines_that_the_certificate_does_not_name_are_missing():
    cube = box((2, 2, 2))
    drawing = vp.draw(cube, "iso")
    made = certificate(cube, drawing, "iso").content
    wrong, _, _ = check(json.loads(json_bytes(drawing)), {**made, "hidden_lines": made["hidden_lines"][1:]})
    assert len(wrong) == 1 and wrong[0].startswith("neither drawn nor hidden")


def test_another_camera_is_told():
    cube = box((2, 2, 2))
    wrong, _, _ = told(vp.draw(cube, "iso"), certificate(cube, vp.draw(cube, "front"), "front"))
    assert wrong[0] == "the drawing is seen by another camera than the certificate"


def test_every_body_hides_and_so_does_a_sheet():
    """Lines behind a square that stands alone, from both of its sides."""
    square = vp.Mesh.from_triangles([(-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)], [(0, 1, 2), (0, 2, 3)])
    scene = vp.Scene((vp.Item("SHEET", square), vp.Item("PART", box((1, 1, 1)))))
    for eye in ((1, 9, 2), (1, -9, 2)):
        camera = vp.Camera(eye)
        assert_certified(scene, vp.draw(scene, camera, hidden="solid"), camera, hidden="solid")


def test_what_leaves_the_page_need_not_be_drawn():
    camera = vp.Camera((4, 5, 6), fov_deg=12.0)
    drawing = vp.draw(box((2, 2, 2)), camera, fit=False)
    assert_certified(box((2, 2, 2)), drawing, camera)


def test_fine_meshes_are_proved_where_their_edges_are_tiny():
    turn = np.linspace(0.0, 2.0 * np.pi, 41)
    ring = mesh_of_grid(Torus(3.0, 1.0).points(*np.meshgrid(turn, turn, indexing="ij")), closed_u=True, closed_v=True)
    drawing = vp.draw(ring, "iso", page="40x30", hidden="solid")
    assert assert_certified(ring, drawing, "iso", hidden="solid")["lines"] > 80


def test_offsets_and_scales_are_proved_or_said():
    for factor, offset in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e4)):
        part = box((2 * factor, 2 * factor, 2 * factor))
        part = vp.Mesh(part.vertices + offset, part.corners, part.offsets)
        assert_certified(part, vp.draw(part, "iso", hidden="solid"), "iso", hidden="solid")
    far = vp.Mesh(part.vertices + 1e9, part.corners, part.offsets)
    drawing = vp.draw(far, "iso")
    assert "rounding moves points" in told(drawing, certificate(far, drawing, "iso"))[1][-1]


def test_an_empty_scene_is_proved():
    assert assert_certified(vp.Scene(()), vp.draw(vp.Scene(()))) == {
        "strokes": 0,
        "triangles": 0,
        "lines": 0,
        "witnesses": 0,
    }


def test_shapes_without_formulas_are_not_proved_and_not_called_wrong():
    scene = vp.read(DATA / "implicit.scene")
    drawing = vp.draw(scene, hidden="solid", page="60x40")
    made = certificate(scene, drawing, hidden="solid", page="60x40")
    assert made.unproved[0] == "what CUBE shows and hides, which is a smooth shape without formulas, or too large"
    wrong, unproven, _ = told(drawing, made)
    assert not wrong and unproven[0] == made.unproved[0]
    with pytest.raises(AssertionError, match="not proven: what CUBE"):
        assert_certified(scene, drawing, hidden="solid", page="60x40")


def test_what_labels_and_lists_of_edges_leave_out_is_said():
    town, pyramid = (vp.read(DATA / name) for name in ("plotted_town.scene", "pyramid.scene"))
    for scene, what in ((town, "lines beside labels"), (pyramid, "crease of PYRAMID")):
        made = certificate(scene, vp.draw(scene))
        assert what in made.unproved[0]
        assert not told(vp.draw(scene), made)[0]


def test_dashes_of_visible_lines_are_said():
    drawing = vp.draw(box((2, 2, 2)), "iso", dashes="3,1")
    made = certificate(box((2, 2, 2)), drawing, "iso")
    assert made.unproved == ("that dashed lines are complete",) and not told(drawing, made)[0]


def test_wireframes_have_no_certificate():
    with pytest.raises(InputError, match="wireframe"):
        certificate(box((2, 2, 2)), vp.draw(box((2, 2, 2)), style="wireframe"), style="wireframe")


@pytest.mark.parametrize("name", ["check_certificate", "certified_drawing", "certified_image", "certified_surfaces"])
def test_the_checker_is_short_and_knows_nothing_of_the_package(name):
    source = CHECKER.with_name(f"{name}.py").read_text("utf-8")
    assert len(source.splitlines()) <= 400
    imports = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import | ast.ImportFrom)]
    names = {(getattr(node, "module", None) or node.names[0].name).split(".")[0] for node in imports}
    assert names <= sys.stdlib_module_names | {"numpy", "certified_drawing", "certified_image", "certified_surfaces"}


@pytest.mark.slow
def test_the_command_writes_what_the_checker_proves_on_its_own(tmp_path):
    drawing, proof = tmp_path / "table.json", tmp_path / "proof.json"
    assert run(["draw", str(DATA / "table.scene"), "-o", str(drawing), "--certificate", str(proof)]) == 0
    words = [sys.executable, "-I", str(CHECKER), str(drawing), str(proof)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "triangles" in done.stdout and not done.stderr
    drawing.write_text(drawing.read_text().replace('"hidden_by": 0', '"hidden_by": 1', 1))
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "\nwrong: hidden by nothing that is named" in done.stdout


@pytest.mark.parametrize(
    "content", ["", "[]", "{}", '{"format": "vectorplot-certificate", "version": 1}', "[" * 100_000]
)
def test_files_that_are_none_are_one_line(tmp_path, capsys, content):
    (tmp_path / "bad.json").write_text(content)
    vp.save(vp.draw(box((2, 2, 2))), tmp_path / "good.json")
    main = runpy.run_path(str(CHECKER))["main"]
    assert main([str(tmp_path / "good.json"), str(tmp_path / "bad.json")]) == 3
    assert main([str(tmp_path / "nothing.json")]) == 3
    assert all(line.startswith("cannot check: ") for line in capsys.readouterr().err.splitlines())


def test_numbers_that_point_nowhere_are_told(tmp_path):
    cube = box((2, 2, 2))
    drawing, made = vp.draw(cube, "iso", hidden="solid"), certificate(cube, vp.draw(cube, "iso", hidden="solid"), "iso")
    read = json.loads(json_bytes(drawing))
    for number in (-1, 12, 10**6):
        rows = [[*row[:4], number] for row in made.content["hidden_strokes"]]
        assert check(read, {**made.content, "hidden_strokes": rows})[0]
    item = {**made.content["items"][0], "triangles": [[0, 1, 8]]}
    with pytest.raises(ValueError, match="a vertex that there is not"):
        check(read, {**made.content, "items": [item]})


def test_the_command_says_what_is_not_proved(tmp_path, capsys):
    words = ["draw", str(DATA / "implicit.scene"), "-o", str(tmp_path / "soft.svg"), "--page", "60x40", "--certificate"]
    assert run([*words, str(tmp_path / "soft.json")]) == 0
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1 and "the certificate does not prove what CUBE" in said[0]


@pytest.mark.parametrize(
    ("words", "status"),
    [
        (["--certificate", "-"], 2),
        (["--certificate", "OUT"], 2),
        (["--certificate", "proof.json", "--halo", "1"], 2),
        (["--certificate", "proof.json", "--thin-ends"], 2),
        (["--certificate", "proof.json", "--style", "wireframe"], 1),
        (["--certificate", "nowhere/proof.json"], 1),
    ],
)
def test_where_there_is_no_certificate_there_is_no_drawing(tmp_path, monkeypatch, words, status):
    monkeypatch.chdir(tmp_path)
    words = ["cube.svg" if word == "OUT" else word for word in words]
    assert run(["draw", str(DATA / "box.scene"), "-o", "cube.svg", *words]) == status
    assert not list(tmp_path.iterdir())


def test_a_folder_of_pictures_has_none(tmp_path):
    words = ["draw", str(DATA / "box.scene"), "-o", f"{tmp_path}/out/", "--certificate", f"{tmp_path}/proof.json"]
    assert run(words) == 2


def test_names_are_escaped(tmp_path):
    name = 'a"b\\c\u2028<script>'
    scene = vp.Scene((vp.Item(name, box((2, 2, 2))),))
    made = certificate(scene, vp.draw(scene))
    made.save(tmp_path / "proof.json")
    text = (tmp_path / "proof.json").read_text("ascii")
    assert json.loads(text)["items"][0]["name"] == name


# Certificates that are made to deceive.


def files(scene, **how):
    """A drawing and its certificate, as they are read."""
    drawing = vp.draw(scene, "iso", **how)
    return json.loads(json_bytes(drawing)), json.loads(bytes(certificate(scene, drawing, "iso", **how)))


@pytest.fixture(scope="module")
def cube_files():
    return files(box((2, 2, 2)), hidden="solid")


@pytest.fixture(scope="module")
def ball_files():
    """A ball with an isophote, before a post, on a stamp."""
    lines = vp.SurfaceLines(isophotes=(0.4,))
    post = vp.Item("POST", box((0.3, 0.3, 3.0)), lines=("contour", "crease"))
    ball = vp.Item("BALL", Sphere(1.0), curves=lines, lines=("contour", "isophote", "intersection"))
    return files(vp.Scene((ball, post)), hidden="solid", page=vp.Page(16.0, 16.0, 2.0))


def told_of(pair, *, drawing=None, proof=None):
    """What the checker says of two files, changed."""
    return check({**pair[0], **(drawing or {})}, {**pair[1], **(proof or {})})[:2]


def test_right_files_are_proved(cube_files, ball_files):
    assert told_of(cube_files) == told_of(ball_files) == ([], [])


@pytest.mark.parametrize("number", [float("nan"), float("inf"), -1.0, 0.0, 1e6])
@pytest.mark.parametrize("key", ["width_mm", "size_mm", "smooth_mm"])
def test_what_is_left_open_is_a_small_length(cube_files, key, number):
    with pytest.raises(ValueError, match="what is left open"):
        told_of(cube_files, proof={key: number})


@pytest.mark.parametrize(
    "change",
    [
        {"window_mm": [[282, 195], [15, 15]]},
        {"window_mm": [[15, 15], [15, 195]]},
        {"window_mm": [[float("nan"), 15], [282, 195]]},
        {"window_mm": []},
        {"crease_angle_deg": float("nan")},
        {"crease_angle_deg": -1.0},
        {"hidden_gap_mm": float("nan")},
        {"hidden_gap_mm": -1.0},
        {"version": 2},
        {"hidden_strokes": [[0, 0, float("nan"), 1.0, 0]]},
    ],
)
def test_numbers_that_would_excuse_everything_are_none(cube_files, change):
    with pytest.raises(ValueError, match=r"window|open|gap|version|finite"):
        told_of(cube_files, proof=change)


def test_planes_have_normals(cube_files):
    item = {**cube_files[1]["items"][0], "planes": [[0.0, 0.0, 0.0, 0.0]]}
    section = {**cube_files[0]["strokes"][0], "kind": "section"}
    with pytest.raises(ValueError, match="a plane has no normal"):
        told_of(cube_files, drawing={"strokes": [section]}, proof={"items": [item]})


def test_strokes_are_open_or_closed(cube_files):
    strokes = [{**one, "closed": 3} for one in cube_files[0]["strokes"]]
    with pytest.raises(ValueError, match="neither open nor closed"):
        told_of(cube_files, drawing={"strokes": strokes})


def test_a_stroke_in_crumbs_is_looked_at(cube_files):
    """Hidden strokes that are shown, divided into segments that are shorter than what is left open."""
    drawing, _ = cube_files
    strokes = json.loads(json.dumps(drawing["strokes"]))
    for one in strokes:
        for key in ("points", "points3d"):
            points = np.array(one[key])[:2]
            one[key] = (points[0] + np.linspace(0.0, 1.0, 40001)[:, None] * (points[1] - points[0])).tolist()
        one["closed"] = False
    behind = [{**one, "hidden_by": 0} for one in strokes if one["hidden_by"]][:1]
    clear = [number for number, one in enumerate(drawing["strokes"]) if not one["hidden_by"]]
    strokes = [one for one in drawing["strokes"] if not one["hidden_by"]] + behind
    wrong, _ = told_of(cube_files, drawing={"strokes": strokes}, proof={"clear": [*range(len(clear) + 1)]})
    assert any(line.startswith("visible, but hidden") for line in wrong)


def test_a_point_that_stands_twice_covers_no_lines(cube_files):
    """A hidden stroke less, and in all others every point twice: segments without a length."""
    strokes = cube_files[0]["strokes"]
    gone = next(number for number, one in enumerate(strokes) if one["hidden_by"])
    rest = [
        {**one, **{key: np.repeat(one[key], 2, axis=0).tolist() for key in ("points", "points3d")}}
        for number, one in enumerate(strokes)
        if number != gone
    ]
    wrong, _ = told_of(cube_files, drawing={"strokes": rest})
    assert any(line.startswith("hidden lines are drawn, but not") for line in wrong)


def test_what_is_not_compared_is_said(cube_files):
    _, unproven = told_of(cube_files, drawing={"fills": [{"colour": "#000000"}]})
    assert unproven == ["fills of the drawing"]
    _, unproven = told_of(cube_files, proof={"hidden_gap_mm": None})
    assert unproven == ["that all hidden lines are there"]
    item = cube_files[1]["items"][0]
    _, unproven = told_of(cube_files, proof={"items": [{**item, "lines": []}]})
    assert unproven == ["that all lines of any kind are there"]
    _, unproven = told_of(cube_files, proof={"items": [{**item, "smooth": True}]})
    assert unproven[0].endswith("shows and hides, which has no formulas")


def test_strokes_of_no_item_and_other_clear_ones_are_wrong(cube_files):
    strokes = [{**one, "item": "GHOST"} for one in cube_files[0]["strokes"]]
    assert told_of(cube_files, drawing={"strokes": strokes})[0] == ["strokes are of items that there are not"]
    assert told_of(cube_files, proof={"clear": []})[0] == ["other strokes are visible than the certificate says"]


@pytest.mark.parametrize(("kind", "what"), [("intersection", "with nothing"), ("section", "in no plane")])
def test_a_line_across_a_face_is_none(cube_files, kind, what):
    drawing, _ = cube_files
    matrix = np.array(drawing["page_from_world"])
    ends = np.array([[-0.5, -0.4, 1.0], [0.5, 0.3, 1.0]])
    lift = np.array(cube_files[1]["items"][0]["vertices"]).max(axis=0) - 1.0
    image = np.hstack([ends + lift, np.ones((2, 1))]) @ matrix.T
    more = {"kind": kind, "item": drawing["strokes"][0]["item"], "hidden_by": 0, "closed": False}
    more |= {"points": (image[:, :2] / image[:, 3:]).tolist(), "points3d": (ends + lift).tolist()}
    clear = [*cube_files[1]["clear"], len(drawing["strokes"])]
    wrong, _ = told_of(cube_files, drawing={"strokes": [*drawing["strokes"], more]}, proof={"clear": clear})
    assert len(wrong) == 1 and wrong[0].startswith(f"{kind} {what}")


def test_an_edge_that_is_drawn_as_two_kinds_is_drawn_twice(cube_files):
    strokes = cube_files[0]["strokes"]
    again = next(one for one in strokes if one["kind"] == "contour")
    edges = [{**again, "kind": "crease"}]
    clear = [*cube_files[1]["clear"], len(strokes)]
    wrong, _ = told_of(cube_files, drawing={"strokes": strokes + edges}, proof={"clear": clear})
    assert wrong and all(line.startswith("drawn twice") for line in wrong)


def test_strokes_on_surfaces_are_what_they_are_called(ball_files):
    """An isophote that is called an edge, or an intersection; none, those of another cosine, and of another light."""
    drawing, proof = ball_files
    renamed = [{**one, "kind": "edges"} if one["kind"] == "isophote" else one for one in drawing["strokes"]]
    assert told_of(ball_files, drawing={"strokes": renamed})[0][0].startswith("edges where there is none")
    renamed = [{**one, "kind": "intersection"} if one["kind"] == "isophote" else one for one in drawing["strokes"]]
    assert told_of(ball_files, drawing={"strokes": renamed})[0][0].startswith("intersection with nothing")
    ball, post = proof["items"]
    for rows in ([], [[*row[:4], row[4] + 0.1] for row in ball["isophotes"]], [[0, 0, 1, 0, 0.4]]):
        wrong, _ = told_of(ball_files, proof={"items": [{**ball, "isophotes": rows}, post]})
        assert any(line.startswith("on no surface, or no such line of it") for line in wrong)


def test_parts_beyond_a_segment_stand_for_nothing(ball_files):
    """One row that reaches far beyond its segment, instead of all rows."""
    for low, high in ((0.0, 1e6), (-1.0, 2.0), (0.6, 0.4)):
        rows = [[*row[:2], low, high, *row[4:]] for row in ball_files[1]["on_surfaces"]]
        wrong, _ = told_of(ball_files, proof={"on_surfaces": rows})
        assert any(line.startswith("on no surface") for line in wrong)


def test_strokes_of_one_item_are_not_on_another(ball_files):
    """A ball of the same shape as the one that the strokes are of, which has another name."""
    ball, post = ball_files[1]["items"]
    other = {**ball, "name": "TWIN"}
    far = {**ball, "surfaces": [{**ball["surfaces"][0], "placement": [[1, 0, 0, 9], [0, 1, 0, 0], [0, 0, 1, 0]]}]}
    rows = [[*row[:4], 1, *row[5:]] for row in ball_files[1]["on_surfaces"]]
    wrong, _ = told_of(ball_files, proof={"items": [far, other, post], "on_surfaces": rows})
    assert any(line.startswith("on no surface") for line in wrong)


@pytest.mark.parametrize("formula", ["1/0", "10.0**1000", "(" * 300, "u +", "u**(1/0)", "9" * 5000])
def test_formulas_that_are_none_are_one_line(tmp_path, capsys, ball_files, formula):
    ball, post = ball_files[1]["items"]
    surface = {**ball["surfaces"][0], "formulas": [formula, "u", "v"]}
    proof = {**ball_files[1], "items": [{**ball, "surfaces": [surface]}, post]}
    for name, content in (("drawing", ball_files[0]), ("proof", proof)):
        (tmp_path / name).write_text(json.dumps(content))
    main = runpy.run_path(str(CHECKER))["main"]
    assert main([str(tmp_path / "drawing"), str(tmp_path / "proof")]) == 3
    assert capsys.readouterr().err.startswith("cannot check: ")


def test_what_is_taken_as_given_is_said(tmp_path, capsys, cube_files):
    main = runpy.run_path(str(CHECKER))["main"]
    item = {**cube_files[1]["items"][0], "hides": False}
    for name, content in (("drawing", cube_files[0]), ("proof", {**cube_files[1], "items": [item]})):
        (tmp_path / name).write_text(json.dumps(content))
    main([str(tmp_path / "drawing"), str(tmp_path / "proof")])
    said = capsys.readouterr().out
    assert f"given: {item['name']} hides nothing" in said and "given: complete: boundary, contour, crease" in said
    bent = [{**one, "directions": [0.0, 0.0]} for one in cube_files[0]["strokes"]]
    (tmp_path / "drawing").write_text(json.dumps({**cube_files[0], "strokes": bent}))
    main([str(tmp_path / "drawing"), str(tmp_path / "proof")])
    assert "strokes are straight between their points, whatever directions" in capsys.readouterr().out
    assert main(["--help"]) == 0 and "exit status" in capsys.readouterr().out
    text = (tmp_path / "drawing").read_text()
    (tmp_path / "drawing").write_text(text.replace('"strokes"', '"strokes": [], "strokes"', 1))
    assert main([str(tmp_path / "drawing"), str(tmp_path / "proof")]) == 3
    assert "a name stands twice" in capsys.readouterr().err


# Surfaces by formulas: balls, rods, cones, rings and others.


def small_pictures():
    """Surfaces of every family that has formulas, and where to look from."""
    circle = Circle(centre=(2.0, 0.0, 0.0), radius=0.6, axis=(0.0, 1.0, 0.0))
    leaning = Circle(centre=(0.0, 0.0, 0.0), radius=0.5, axis=(1.0, 0.0, 0.3))
    saddle = parse_scene('S surface function "u" "v" "u^2/2 - v^3/3" u -1 1 v -1 1').items[0].shape
    hill = parse_scene('H surface graph "exp(-x^2-y^2)" x -2 2 y -2 2').items[0].shape
    return {
        "ball": Sphere(1.0),
        "egg": Ellipsoid((3.0, 2.0, 1.4)),
        "pipe": Cylinder(1.0, 0.0, 2.0),
        "funnel": Cone(0.5, 0.5, 2.0),
        "bucket": Frustum(1.0, 0.6, 1.5),
        "can": Capped(Cylinder(1.0, 0.0, 2.0)),
        "hat": Capped(Cone(0.5, -2.0, 0.0)),
        "dome": Capped(Sphere(1.0), v=(0.0, 0.5 * np.pi)),
        "waist": Hyperboloid((1.0, 1.0, 1.0)),
        "bowl": Paraboloid(1.0, 1.0, 1.0),
        "ring": Torus(3.0, 1.0),
        "pass": HyperbolicParaboloid(),
        "spring": helical_surface(circle, 0.3, end=9.0),
        "turned": revolution_surface(Line((1.0, -1.2, -2.0), (0.0, 2.4, 4.0))),
        "shifted": translation_surface(leaning, Line((0.0, 0.0, 0.0), (3.0, 0.0, 0.0))),
        "sail": helicoid_to_catenoid(0.8),
        "formula": saddle,
        "hill": hill,
    }


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("name", list(small_pictures()))
@pytest.mark.parametrize("eye", [(8.0, -11.0, 6.0), (2.0, 12.0, 0.5)])
def test_surfaces_of_all_families_are_proved(name, eye):
    scene = vp.Scene((vp.Item("SHAPE", small_pictures()[name]), vp.Item("POST", box((0.3, 0.3, 4.0)))))
    camera = vp.Camera(eye)
    drawing = vp.draw(scene, camera, hidden="solid", page="50x40", lines="contour,boundary,crease")
    how = {"hidden": "solid", "page": "50x40", "lines": "contour,boundary,crease"}
    assert assert_certified(scene, drawing, camera, **how)["triangles"] > 100


@pytest.mark.slow
@pytest.mark.spread(parts=7)
@pytest.mark.parametrize("hidden", ["none", "dashed", "solid"])
@pytest.mark.parametrize("name", SMOOTH)
def test_right_drawings_of_surfaces_are_not_called_wrong(name, hidden):
    scene = vp.read(DATA / f"{name}.scene")
    drawing = vp.draw(scene, hidden=hidden, page=SMOOTH_PAGE)
    wrong, unproven, counts = told(drawing, certificate(scene, drawing, hidden=hidden, page=SMOOTH_PAGE))
    assert not wrong and counts["triangles"] > 1000
    open_ = ("stroke on a surface, where it is, is one", "isophote that may be none")
    assert all(any(what in line for what in open_) for line in unproven)


@pytest.mark.slow
@pytest.mark.parametrize("hidden", ["none", "dashed", "solid"])
def test_lines_that_glass_bends_are_not_proved_and_not_called_wrong(hidden):
    scene = vp.read(DATA / "pool.scene")
    drawing = vp.draw(scene, hidden=hidden)
    wrong, unproven, _ = told(drawing, certificate(scene, drawing, hidden=hidden))
    assert not wrong and "strokes of the kind refracted" in unproven
    assert hidden == "none" or "that hidden lines behind glass are complete" in unproven


@pytest.fixture(scope="module")
def drawn_surfaces():
    """Scenes of surfaces with all their lines, as in a file."""
    return [Proof(*pair, "solid") for pair in drawn_of(["house", "torus"], "solid")]


@pytest.mark.slow
@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.__name__)
def test_mutated_drawings_of_surfaces_are_caught(drawn_surfaces, mutation):
    rng = np.random.default_rng(8)
    caught = 0
    while caught < several(2, long=50):
        proof = drawn_surfaces[int(rng.integers(len(drawn_surfaces)))]
        other = mutated(rng, proof.drawing, mutation)
        if other is not None:
            assert proof.faults(other)
            caught += 1


def ball_of(radius=1.0):
    """The row of a certificate for a ball with a rough net."""
    u, v = np.linspace(0.0, 2.0 * np.pi, 33), np.linspace(-1.5, 1.5, 17)
    formulas = [f"{radius}*cos(v)*cos(u)", f"{radius}*cos(v)*sin(u)", f"{radius}*sin(v)"]
    place = np.eye(3, 4).tolist()
    return patch_of({"formulas": formulas, "placement": place, "u": u.tolist(), "v": v.tolist()})


PERSPECTIVE = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 5.0], [0.0, 0.0, -1.0, 5.0]])
"""An eye at height 5 above the origin, in which planes stay planes."""


def image_at(patch, u, v):
    """(n,3) the image of points of a surface."""
    return image_of(PERSPECTIVE, patch.points(u, v))[0]


@given(st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3))
def test_points_of_cells_are_in_their_ranges(shares):
    patch, (a, b, c) = ball_of(), shares
    cells = patch.grid()
    cell = cells[int(a * (len(cells) - 1))]
    u, v = cell[0] + b * (cell[1] - cell[0]), cell[2] + c * (cell[3] - cell[2])
    point = image_at(patch, np.array([u]), np.array([v]))[0]
    for one, x in zip(patch.jets(PERSPECTIVE, cell[None]), point, strict=True):
        assert one.value.low[0] <= x <= one.value.high[0]


def test_nets_are_no_farther_off_than_proved():
    patch = ball_of()
    cells = patch.grid()
    bound = deviations(patch, PERSPECTIVE, cells).sum(axis=1)
    u0, u1, v0, v1 = cells.T
    rng = np.random.default_rng(3)
    worst = np.zeros(len(cells))
    for a, b in np.sort(rng.random((30, 2)), axis=1):
        on = image_at(patch, u0 + b * (u1 - u0), v0 + a * (v1 - v0))
        corners = [image_at(patch, u, v) for u, v in ((u0, v0), (u1, v0), (u1, v1))]
        flat = (1.0 - b) * corners[0] + (b - a) * corners[1] + a * corners[2]
        worst = np.maximum(worst, np.linalg.norm(on - flat, axis=1))
    assert (worst <= bound).all() and (worst > 0.2 * bound).mean() > 0.5


def test_contours_are_in_the_cells_and_nowhere_else():
    """The contour of a ball is a circle: at height r^2 / d, of radius r sqrt(1 - (r / d)^2)."""
    cells, every = contour_cells(ball_of(), PERSPECTIVE, 0.01)
    assert every
    radius = np.hypot(*cells[:, :2].T)
    assert np.abs(radius - np.sqrt(1.0 - 0.04) / (5.0 - 0.2)).max() < 0.01
    assert (cells[:, 8] > 0.0).mean() > 0.8
    outwards = (cells[:, :2] * cells[:, 6:8]).sum(axis=1)
    assert (outwards > 0.0).all()
    turn = np.sort(np.arctan2(cells[:, 1], cells[:, 0]))
    assert np.diff(turn).max() * 0.2 < 0.02


@pytest.mark.parametrize(
    "text", ["__import__('os')", "u.real", "[u]", "u if v else 1", "open('x')", "lambda: u", "w", "sin(u, v)", "'u'"]
)
def test_formulas_are_never_run(text):
    with pytest.raises(ValueError, match="a formula has something else"):
        value_of(ast.parse(text, mode="eval"), {"u": np.ones(1), "v": np.ones(1)}, NUMBERS)


def test_a_surface_with_other_formulas_is_not_certified():
    """What gives other points than its formulas say is left out, and said."""

    class Bent(Sphere):
        def points(self, u, v):
            return super().points(u, v) * (1.0, 1.0, 1.5)

    assert len(surfaces_of(Sphere(1.0))) == 1 and surfaces_of(Bent(1.0)) == ()


def test_a_net_that_is_too_coarse_proves_nothing():
    scene = vp.Scene((vp.Item("BALL", Sphere(1.0)),))
    drawing = vp.draw(scene, page="30x30")
    made = certificate(scene, drawing, page="30x30").content
    assert check(json.loads(json_bytes(drawing)), made)[:2] == ([], [])
    item = made["items"][0]
    net = {**item["surfaces"][0], "u": item["surfaces"][0]["u"][::9]}
    _, unproven, _ = check(json.loads(json_bytes(drawing)), {**made, "items": [{**item, "surfaces": [net]}]})
    assert unproven[0].startswith("what BALL shows and hides: its net may be")
