from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from support.backend_samples import drawing_of, paths_of

from vectorplot.backends.json import json_bytes, read_drawing
from vectorplot.drawing.drawing import Paths
from vectorplot.errors import InputError
from vectorplot.save import save
from vectorplot.words import LineKind


def mixed() -> Paths:
    """Strokes of several kinds, items and lengths with awkward numbers."""
    random = np.random.default_rng(5)
    counts = random.integers(1, 6, 40)
    total = int(counts.sum())
    world = random.normal(size=(total, 3)) * 10.0 ** random.integers(-12, 12, (total, 1))
    world[0] = -0.0
    columns = (random.integers(0, top, 40) for top in (6, 2, 3))
    return Paths(
        random.uniform(0, 80, (total, 2)), np.concatenate(([0], np.cumsum(counts))), counts > 3, *columns, world
    )


def test_the_file_keeps_to_the_contract():
    world = np.arange(16.0).reshape(4, 4) + 0.1
    drawing = drawing_of(paths_of([(1, 2), (3.25, 4)], kind=2, hidden_by=3, closed=True), page_from_world=world)
    data = json.loads(json_bytes(drawing))
    assert list(data) == ["format", "version", "page_mm", "page_from_world", "strokes", "fills"]
    assert (data["format"], data["version"], data["page_mm"]) == ("vectorplot-drawing", 1, [120.0, 80.0])
    assert data["page_from_world"] == world.tolist()
    assert data["fills"] == []
    assert data["strokes"] == [
        {
            "kind": "crease",
            "item": "box",
            "hidden_by": 3,
            "points": [[1.0, 2.0], [3.25, 4.0]],
            "points3d": [[1.0, 2.0, 0.0], [3.25, 4.0, 0.0]],
            "closed": True,
        }
    ]


def test_every_stroke_comes_with_its_own_numbers_in_full():
    paths = mixed()
    strokes = json.loads(json_bytes(drawing_of(paths, items=("a", "b"))))["strokes"]
    assert len(strokes) == len(paths)
    for i, stroke in enumerate(strokes):
        part = slice(paths.offsets[i], paths.offsets[i + 1])
        assert np.array_equal(stroke["points"], paths.points[part])
        assert np.array_equal(stroke["points3d"], paths.points3d[part])
        assert stroke["kind"] == LineKind(paths.kind[i]).word
        assert stroke["item"] == "ab"[paths.item[i]]
        assert (stroke["hidden_by"], stroke["closed"]) == (paths.hidden_by[i], paths.closed[i])
    assert b"-0.0," not in json_bytes(drawing_of(paths))


@pytest.mark.parametrize("name", ["100% %r %s", '"}]', "a\x00\n\ud800", "Würfel"])
def test_any_item_name_comes_back(name, tmp_path):
    save(drawing_of(paths_of([(1, 1), (2, 2)]), items=(name,)), tmp_path / "a.json")
    assert read_drawing(tmp_path / "a.json").items == (name,)


def test_read_gives_back_what_was_written_in_layers_by_kind(tmp_path):
    drawing = drawing_of(mixed(), items=("a", "b"), page_from_world=np.diag([2.0, 3.0, 1.0, 1.0]))
    save(drawing, tmp_path / "a.json")
    back = read_drawing(tmp_path / "a.json")
    assert (back.width_mm, back.height_mm) == (120.0, 80.0)
    assert np.array_equal(back.page_from_world, drawing.page_from_world)
    assert all(layer.plotted for layer in back.layers)
    for layer in back.layers[:-1]:
        (marks,) = layer.marks
        assert {LineKind(kind).word for kind in marks.kind} == {layer.name} and not marks.hidden_by.any()
    key = "points hidden_by kind item points3d closed".split()
    ours, theirs = (json.loads(json_bytes(d))["strokes"] for d in (drawing, back))
    assert sorted([[s[k] for k in key] for s in ours]) == sorted([[s[k] for k in key] for s in theirs])


def curved() -> Paths:
    """Strokes of which every other one is smooth, with directions that are known in part, and numbers of curves."""
    paths = mixed()
    random = np.random.default_rng(6)
    directions = random.uniform(-np.pi, np.pi, (len(paths.points), 2))
    directions[random.random(directions.shape) < 0.3] = np.nan
    number = np.arange(len(paths))
    smooth = number % 2 == 1
    directions[np.repeat(~smooth, np.diff(paths.offsets))] = np.nan
    return replace(paths, smooth=smooth, directions=directions, curve=np.where(smooth & (number > 9), number, -1))


def test_what_is_known_of_smooth_curves_comes_back(tmp_path):
    paths = curved()
    save(drawing_of(paths, items=("a", "b")), tmp_path / "a.json")
    strokes = json.loads((tmp_path / "a.json").read_text())["strokes"]
    for number, stroke in enumerate(strokes):
        assert ("smooth" in stroke, "directions" in stroke) == (number % 2 == 1,) * 2
        assert stroke.get("curve", -1) == paths.curve[number]
    back = read_drawing(tmp_path / "a.json")
    rows = [
        sorted(
            (s.points[s.offsets[i]].tolist(), bool(s.smooth[i]), int(s.curve[i]), repr(d.tolist()))
            for s in some
            for i in range(len(s))
            for d in [s.directions[s.offsets[i] : s.offsets[i + 1]]]
        )
        for some in ((paths,), [strokes for layer in back.layers for strokes in layer.strokes])
    ]
    assert rows[0] == rows[1]


def test_files_without_directions_are_still_read(tmp_path):
    data = json.loads(json_bytes(drawing_of(curved(), items=("a", "b"))))
    for stroke in data["strokes"]:
        for key in ("smooth", "curve", "directions"):
            stroke.pop(key, None)
    (tmp_path / "a.json").write_text(json.dumps(data))
    for layer in read_drawing(tmp_path / "a.json").layers:
        for strokes in layer.strokes:
            assert not strokes.smooth.any() and np.isnan(strokes.directions).all() and (strokes.curve == -1).all()


def test_a_drawing_without_strokes_comes_back(empty, tmp_path):
    save(empty, tmp_path / "a.json")
    assert read_drawing(tmp_path / "a.json").layers == ()


@pytest.mark.hard(53)
def test_hard_53_world_points_that_are_not_finite_are_refused():
    paths = paths_of([(1, 1), (2, 2)])
    with pytest.raises(InputError, match="not finite"):
        json_bytes(drawing_of(replace(paths, points3d=paths.points3d * np.nan)))


GOOD = json.loads(json_bytes(drawing_of(paths_of([(1, 1), (2, 2)]))))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("format", "svg"),
        ("version", 2),
        ("page_mm", [1]),
        ("page_mm", [0, 5]),
        ("page_from_world", [[1]]),
        ("strokes", 3),
        ("strokes", [3]),
        ("strokes", [GOOD["strokes"][0] | {"kind": "wavy"}]),
        ("strokes", [GOOD["strokes"][0] | {"hidden_by": -1}]),
        ("strokes", [GOOD["strokes"][0] | {"hidden_by": True}]),
        ("strokes", [GOOD["strokes"][0] | {"points": [[1, 1], [2, "2"]]}]),
        ("strokes", [GOOD["strokes"][0] | {"points": [[1, 1], [2]]}]),
        ("strokes", [GOOD["strokes"][0] | {"points": [[1, 1], [2, float("nan")]]}]),
        ("strokes", [GOOD["strokes"][0] | {"points": [[1, 1]]}]),
        ("strokes", [GOOD["strokes"][0] | {"closed": 0}]),
        ("strokes", [GOOD["strokes"][0] | {"smooth": 1}]),
        ("strokes", [GOOD["strokes"][0] | {"curve": -2}]),
        ("strokes", [GOOD["strokes"][0] | {"directions": 0}]),
        ("strokes", [GOOD["strokes"][0] | {"directions": [[0, 0]]}]),
        ("strokes", [GOOD["strokes"][0] | {"directions": [[0, 0], [0]]}]),
        ("strokes", [GOOD["strokes"][0] | {"directions": [[0, None], [0, "1"]]}]),
        ("strokes", [GOOD["strokes"][0] | {"directions": [[0, None], [0, float("inf")]]}]),
    ],
)
def test_a_file_that_is_no_drawing_is_refused_in_one_line(tmp_path, key, value):
    file = tmp_path / "a.json"
    file.write_text(json.dumps(GOOD | {key: value}))
    with pytest.raises(InputError) as error:
        read_drawing(file)
    assert error.value.file == str(file) and "\n" not in str(error.value)


@pytest.mark.parametrize("text", ["", "{", "[1, 2]", "\n\n{]", "[" * 100_000, "\xff"])
def test_a_file_that_is_not_json_is_refused_in_one_line(tmp_path, text):
    file = tmp_path / "a.json"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=r"JSON|not a drawing") as error:
        read_drawing(file)
    assert error.value.file == str(file)
    assert error.value.line == (3 if text.startswith("\n") else error.value.line)


@pytest.mark.parametrize("large", [1e200, 1e308, 5e-324])
def test_numbers_as_large_as_any_are_cut_at_the_border_of_the_page(tmp_path, large):
    """Lines are cut by the ratio of the depths of their ends, however large these are."""
    world = np.eye(4)
    world[3] = (large, 0.0, 0.0, 1.0)
    paths = paths_of([np.array([(-500.0, 10.0), (20.0, 10.0), (300.0, 40.0)])])
    paths = replace(paths, points3d=np.array([(1.0, 0.0, 0.0), (large, 0.0, 0.0), (3.0, 1.0, 0.0)]))
    save(replace(drawing_of(paths), page_from_world=world), tmp_path / "a.json")
    save(read_drawing(tmp_path / "a.json"), tmp_path / "a.svg")
    assert b"polyline" in (tmp_path / "a.svg").read_bytes()
