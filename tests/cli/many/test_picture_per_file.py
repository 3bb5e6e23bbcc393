"""A picture of each of many files, into a folder, by the command."""

from __future__ import annotations

import os
import signal

import pytest

from vectorplot.batch.running import RECORD
from vectorplot.cli.main import run, stoppable
from vectorplot.cli.many import files_of, out_names


@pytest.fixture
def parts(tmp_path, cube):
    """A folder with two meshes, a scene that names one of them, and a text that is none of it."""
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "a.obj").write_bytes(cube.read_bytes())
    (folder / "b.obj").write_bytes(cube.read_bytes().replace(b"1 1 1", b"1 1 2"))
    (folder / "c.scene").write_text('light LAMP position 5 -6 9\nC red mesh "a.obj"', encoding="utf-8")
    (folder / "readme.md").write_text("Parts", encoding="utf-8")
    return folder


@pytest.mark.parametrize(("verb", "suffix"), [("draw", "svg"), ("paint", "svg"), ("render", "png")])
def test_every_verb_makes_the_pictures_that_it_makes_alone(verb, suffix, parts, tmp_path, capsys):
    size = ["--size", "40x30"] if verb == "render" else ["--page", "A6"]
    assert run([verb, str(parts), "-o", str(tmp_path / "out") + "/", *size]) == 0
    assert sorted(os.listdir(tmp_path / "out")) == [RECORD, *(f"{name}.{suffix}" for name in "abc")]
    for name, source in (("a", "a.obj"), ("c", "c.scene")):
        alone = tmp_path / f"{name}.{suffix}"
        assert run([verb, str(parts / source), "-o", str(alone), *size]) == 0
        assert alone.read_bytes() == (tmp_path / "out" / alone.name).read_bytes()
    assert capsys.readouterr() == ("", "")


@pytest.mark.slow
def test_only_what_has_changed_is_made_again(parts, tmp_path):
    out = tmp_path / "out"
    words = ["draw", str(parts), "-o", f"{out}/", "--page", "A6"]

    def made(*more):
        before = {path.name: path.stat().st_ino for path in out.glob("*.svg")}
        assert run([*words, *more]) == 0
        return {path.name for path in out.glob("*.svg") if before.get(path.name) != path.stat().st_ino}

    out.mkdir()
    assert made() == {"a.svg", "b.svg", "c.svg"}
    assert made("--jobs", "2", "-q") == set()
    (parts / "b.obj").write_bytes((parts / "a.obj").read_bytes())
    assert made() == {"b.svg"}
    (parts / "a.obj").write_bytes((parts / "a.obj").read_bytes().replace(b"1 1 1", b"1 1 3"))
    assert made() == {"a.svg", "c.svg"}
    assert made("--crease-angle", "50") == {"a.svg", "b.svg", "c.svg"}


def test_bad_input_is_a_line_and_the_others_are_made(parts, tmp_path, capsys):
    (parts / "b.obj").write_text("v 1 2 x", encoding="utf-8")
    (parts / "c.scene").write_text("C nocolour box 1 1 1", encoding="utf-8")
    assert (
        run(["draw", str(parts), str(parts / "none.stl"), "-o", str(tmp_path / "out") + "/", "--format", "json"]) == 1
    )
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 4 and told[3] == "vectorplot: 2 of 4 pictures failed"
    assert "b.obj:1: " in told[0] and "nocolour" in told[1] and "none.stl" in told[2]
    assert sorted(os.listdir(tmp_path / "out")) == [RECORD, "a.json", "c.json"]


def test_a_signal_leaves_what_is_finished(parts, tmp_path, monkeypatch, capsys):
    from vectorplot.batch import running as finished_pictures

    real = finished_pictures.Records.add

    def add(self, path, *rest):
        real(self, path, *rest)
        if path.endswith("b.svg"):
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(finished_pictures.Records, "add", add)
    with stoppable():
        assert run(["draw", str(parts), "-o", str(tmp_path / "out") + "/"]) == 143
    assert capsys.readouterr().err == "vectorplot: terminated\n"
    assert sorted(os.listdir(tmp_path / "out")) == [RECORD, "a.svg", "b.svg"]


def test_inputs_that_are_called_alike(tmp_path):
    assert list(out_names(["x/a.stl", "x/a.obj", "b.obj"], tmp_path, "svg").values()) == [
        str(tmp_path / name) for name in ("a.stl.svg", "a.obj.svg", "b.svg")
    ]


def test_files_that_texts_name_in_a_circle(tmp_path):
    (tmp_path / "a.scene").write_text('include "b.scene" "none.obj"', encoding="utf-8")
    (tmp_path / "b.scene").write_text('include "a.scene"', encoding="utf-8")
    names = {path.resolve().name for path in files_of((str(tmp_path / "a.scene"), "\0", "x" * 5000))}
    assert names == {"a.scene", "b.scene"}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["a.obj", "-o", "a.svg", "--workers", "2"], "OUT must be one, FOLDER/"),
        (["a.obj", "-o", "out/", "--workers", "2", "--cluster", "tcp://x:1"], "exclude each other"),
        (["a.obj", "-o", "out/", "--explain"], "--explain is of one picture"),
        (["a.obj", "-o", "out/", "--text", "latex"], "--text latex is of one picture"),
        (["a.obj", "-o", "out/", "--fov", "9", "--parallel"], "--fov and --parallel exclude each other"),
        (["x/a.obj", "y/a.obj", "-o", "out/"], "would both become"),
        ([".", "-o", "out/"], "no file in it"),
    ],
    ids=["file", "both", "explain", "latex", "camera", "names", "empty"],
)
def test_bad_usage_is_said_before_the_work(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["draw", *words]) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
