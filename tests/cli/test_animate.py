"""``vectorplot animate`` and ``vectorplot replay``."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.paths import DATA, ROOT

import vectorplot as vp
from vectorplot.animation.animation import MODES
from vectorplot.animation.movies import frame_drawings, read_movie
from vectorplot.cli.commands.animate import KNOWN, NOT_OF_FRAMES, animate
from vectorplot.cli.main import run
from vectorplot.save import write


@pytest.fixture
def workplace(tmp_path, monkeypatch):
    """A folder with data, anim and video in it."""
    (tmp_path / "data").mkdir()
    (tmp_path / "anim").mkdir()
    (tmp_path / "data" / "die.scene").write_text("camera eye 9 -9 6 DIE red box solid 2 2 2", encoding="utf-8")
    (tmp_path / "anim" / "turn.anim").write_text("frames 3 item DIE rotation z at 0 0 at 1 40", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
@pytest.mark.capability("GA.1-layout")
def test_files_lie_where_the_book_has_them(workplace):
    assert run(["animate", "die", "-a", "turn", "-v", "turn"]) == 0
    assert sorted(path.name for path in Path("video").iterdir()) == ["turn.vd1", "turn.vd2"]
    assert run(["animate", "data/die.scene", "-a", "anim/turn", "-v", "video/again"]) == 0
    assert Path("video/again.vd1").read_bytes() == Path("video/turn.vd1").read_bytes()
    # What lies in the current folder comes first.
    Path("die").write_text("DIE blue box 1 1 1", encoding="utf-8")
    assert run(["animate", "die", "-a", "turn", "-v", "other"]) == 0
    assert Path("video/other.vd2").read_bytes() != Path("video/turn.vd2").read_bytes()
    page = ["--no-browser", "--timeout", "0.01"]
    assert run(["replay", "turn", *page]) == run(["replay", "video/turn.vd1", *page]) == 0


@pytest.mark.slow
def test_the_pencil_is_animated_recorded_and_replayed(tmp_path, monkeypatch, capsys):
    (tmp_path / DATA.name).mkdir()
    for name in ("pencil.scene", "pencil.anim"):
        shutil.copy(DATA / name, tmp_path / DATA.name)
    monkeypatch.chdir(tmp_path)
    assert run(["animate", "pencil", "-a", "pencil", "-v", "pencil", "-o", "film.pdf", "--frames", "4"]) == 0
    assert len(read_movie("video/pencil")) == 4
    assert run(["replay", "pencil", "-o", "again.pdf"]) == 0
    for name in ("film.pdf", "again.pdf"):
        told = subprocess.run(["pdfinfo", name], capture_output=True, text=True, check=True).stdout
        assert "Pages:           4" in told
    assert run(["replay", "pencil", "--no-browser", "--timeout", "0.01"]) == 0
    assert "4 frames, 0 of them frozen; 2 palettes" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.capability("GA.4-learn")
@pytest.mark.parametrize("lesson", sorted(DATA.glob("Learn.*")), ids=lambda path: path.name)
def test_lessons_are_drawn_and_painted(lesson):
    scene = vp.read(lesson)
    number = int(lesson.name.removeprefix("Learn."))
    assert scene.title.startswith(f"Lesson {number}: ") and len(scene) >= min(number, 2)
    for picture in (vp.draw(scene), vp.paint(scene, tolerance_mm=1.0, page="60x40")):
        assert sum(len(mark) for layer in picture.layers for mark in layer.marks) > 2


@pytest.mark.capability("GA.4-learn")
def test_there_are_several_dozen_samples():
    assert len(list(DATA.glob("Learn.*"))) == 6 and len(list(DATA.glob("*.scene"))) > 30


@pytest.mark.slow
def test_options_mean_what_they_mean_to_the_verbs(workplace):
    assert run(["animate", "die", "-a", "turn", "-o", "a.svg", "--eye", "-9,4,3", "--hidden", "dashed"]) == 0
    text = Path("a.svg").read_text(encoding="utf-8")
    assert text.count("hidden") > 3 and 'viewBox="0 0 210 297"' in text
    wide = ["--page", "100x50", "--mode", "shading", "--frames", "2", "--background", "yellow"]
    assert run(["animate", "die", "-a", "turn", "-o", "b/", "--format", "png", *wide]) == 0
    assert sorted(path.name for path in Path("b").glob("[!.]*")) == ["0001.png", "0002.png"]
    assert run(["animate", "die", "-a", "turn", "-o", "c/", "--mode", "pixels", "--size", "40x30"]) == 0
    assert len(list(Path("c").glob("*.png"))) == 3


def test_frames_have_every_option_of_the_verbs_that_make_them(workplace):
    own = {option.name for option in animate.params}
    assert len(own) > 60 and all(set(options) - NOT_OF_FRAMES <= own for options in KNOWN.values())
    fine = [
        "--thin-ends",
        "--curves",
        "polyline",
        "--longest",
        "20",
        "--text",
        "real",
        "--title",
        "Die",
        "--frames",
        "1",
    ]
    assert run(["animate", "die", "-a", "turn", "-o", "a.svg", "--title", "Die", *fine]) == 0
    assert "<text" in Path("a.svg").read_text(encoding="utf-8")
    seen = ["--mode", "shading", "--fills", "visible", "--frames", "1", "-o"]
    for more in ([], ["--sections", "z,2"]):
        assert run(["animate", "die", "-a", "turn", *seen, "b.svg" if more else "c.svg", *more]) == 0
    assert "section" in Path("b.svg").read_text(encoding="utf-8") and "section" not in Path("c.svg").read_text("utf-8")
    small = ["--mode", "pixels", "--size", "20x15", "--samples", "1", "--shadows", "exact", "--frames", "1"]
    assert run(["animate", "die", "-a", "turn", "-o", "d/", *small]) == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "status", "cause"),
    [
        (["animate", "die", "-a", "turn"], 2, "nothing to write: give -o OUT, or -v NAME, or both"),
        (["animate", "die", "-o", "a.pdf"], 2, "Missing option '-a'"),
        (["animate", "dye", "-a", "turn", "-o", "a.pdf"], 1, "dye: no such data file, nor in data/"),
        (["animate", "die", "-a", "trun", "-o", "a.pdf"], 1, "trun: no such animation file, nor in anim/ or data/"),
        (["animate", "die", "-a", "turn", "-o", "a.ps"], 2, "frames are written as .pdf, .svg, .mp4"),
        (["animate", "die", "-a", "turn", "-o", "no/a.pdf"], 1, "no: No such file or directory"),
        (["animate", "die", "-a", "turn", "-o", "a.pdf", "--format", "svg"], 2, "--format is that of single frames"),
        (["animate", "die", "-a", "turn", "-o", "a.pdf", "--mode", "shadows", "--hidden", "solid"], 2, "--hidden does"),
        (
            ["animate", "die", "-a", "turn", "-o", "a.pdf", "--samples", "2"],
            2,
            "--samples does not go with frames that",
        ),
        (["animate", "die", "-a", "turn", "-o", "a.pdf", "--text", "latex"], 2, "--text latex is of one picture"),
        (["animate", "die", "-a", "turn", "-o", "a.pdf", "--fps", "0"], 1, "0 frames a second"),
        (["animate", "die", "-a", "turn", "-v", "a", "--mode", "pixels"], 1, "frames of pixels do not go into a movie"),
        (["replay", "none"], 1, "no such movie: neither none.vd1 nor video/none.vd1"),
        (["replay", "bad"], 1, "bad.vd1: byte 0: the movie breaks off here"),
    ],
    ids=range(14),
)
def test_what_is_wrong_is_one_line_and_nothing_is_written(arguments, status, cause, workplace, capsys):
    Path("bad.vd1").write_bytes(b"")
    Path("bad.vd2").write_bytes(bytes.fromhex("0ff000000000000000000000"))
    before = sorted(workplace.rglob("*"))
    assert run(arguments) == status
    err = capsys.readouterr().err
    assert cause in err and (status == 2 or err.count("\n") == 1)
    assert [path for path in sorted(workplace.rglob("*")) if path.name != "video"] == before


@pytest.mark.slow
def test_a_stop_leaves_no_half_file(workplace):
    script = (
        "import os, signal, sys, vectorplot.pictures.film as film\n"
        "made = film.Film.picture\n"
        "def stopping(self, frame, progress=None):\n"
        "    if frame == 2: os.kill(os.getpid(), signal.SIGTERM)\n"
        "    return made(self, frame, progress)\n"
        "film.Film.picture = stopping\n"
        "from vectorplot.cli.main import main\n"
        "sys.argv = ['vectorplot', 'animate', 'die', '-a', 'turn', '-o', 'a.pdf']\n"
        "main()\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert found.returncode == 143 and "terminated" in found.stderr
    assert sorted(path.name for path in workplace.iterdir()) == ["anim", "data"]


@pytest.mark.slow
def test_frames_are_told_what_pictures_are(workplace, capsys):
    """The options of the verbs reach their frames, and what is on the scene moves with it."""
    drawn = ["--halo", "1", "--hatch", "even", "--layers", "object", "--sections", "z,2", "--cut", "x+y=1"]
    assert run(["animate", "die", "-a", "turn", "-o", "film.pdf", "--mode", "lines", *drawn, "--explain"]) == 0
    stages = capsys.readouterr().err
    assert {"hatching", "cuts"} <= set(stages.replace("\n", " ").split()) and "section" in stages
    frames = {}
    for words in (["--palette", "32"], ["--palette", "3"], ["--exposure", "0.5"], ["--flat", "--aura", "1"]):
        assert run(["animate", "die", "-a", "turn", "-o", "frames/", "--mode", "shading", "--frames", "1", *words]) == 0
        frames[" ".join(words)] = Path("frames/0001.svg").read_bytes()
    assert len(set(frames.values())) >= 3
    assert (
        run(["animate", "die", "-a", "turn", "-o", "pixels/", "--mode", "pixels", "--frames", "1", "--levels", "4"])
        == 0
    )
    capsys.readouterr()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--mode", "shading", "--hatch", "tone"], "--hatch does not go with"),
        (["--mode", "lines", "--flat"], "--flat does not go with"),
        (["--mode", "pixels", "--halo", "1"], "--halo does not go with"),
        (["--mode", "lines", "--spacing", "1"], "--spacing goes with --hatch"),
        (["--workers", "1", "--explain"], "--explain is of work in this process"),
    ],
    ids=lambda given: " ".join(given) if isinstance(given, list) else None,
)
def test_options_of_other_verbs_are_refused(workplace, words, said, capsys):
    assert run(["animate", "die", "-a", "turn", "-o", "frames/", *words]) == 2
    assert said in capsys.readouterr().err.splitlines()[-1]
    assert not Path("frames").exists()


@pytest.mark.slow
@pytest.mark.capability("GA.4-anim", "GA.1-samples")
@pytest.mark.parametrize("name", sorted(path.stem for path in DATA.glob("*.anim")))
def test_every_sample_animation_moves_what_the_verb_of_its_mode_shows(name, tmp_path, monkeypatch):
    """Its frames are those one gets by hand, of a scene and a camera that stand still."""
    monkeypatch.chdir(ROOT)
    scene = vp.read(DATA / f"{name}.scene")
    moving = vp.read_animation(DATA / f"{name}.anim", scene)
    assert moving.frames >= 24 and moving.mode in MODES
    film = vp.animate(replace(moving, frames=3, loop=False), page="80x60", fit=False)
    pages = [write(film.picture(frame), "svg") for frame in range(3)]
    assert len(set(pages)) >= 2, "it moves"
    mode, (still, camera) = MODES[moving.mode], film.view(1)
    alone = {"draw": vp.draw, "paint": vp.paint}[mode.verb](still, camera, page="80x60", **mode.options, fit=False)
    made = film.picture(1)
    assert [layer.name for layer in made.layers] == [layer.name for layer in alone.layers]
    for one, other in zip(made.layers, alone.layers, strict=True):
        for ours, theirs in ((one.strokes, other.strokes), (one.fills, other.fills)):
            ends = [
                np.unique(np.concatenate([np.zeros((0, 2)), *(mark.points for mark in marks)]), axis=0)
                for marks in (ours, theirs)
            ]
            assert ends[0].shape == ends[1].shape and np.allclose(*ends, atol=1e-9)
    monkeypatch.chdir(tmp_path)
    told = ["-a", str(DATA / f"{name}.anim"), "-v", "played", "--frames", "2"]
    assert run(["animate", str(DATA / f"{name}.scene"), *told, "-q"]) == 0
    assert len(read_movie("video/played")) == 2


@pytest.mark.capability("GA.1-samples")
def test_the_sample_movie_plays(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    assert run(["replay", "pencil", "--no-browser", "--timeout", "0.01"]) == 0
    assert capsys.readouterr().out.startswith("48 frames, 0 of them frozen")
    assert (
        len({drawing.layers[0].fills[0].points.tobytes() for drawing in frame_drawings(read_movie("data/pencil"))})
        == 48
    )


@pytest.mark.slow
def test_films_read_molecules_and_parts_as_pictures_do(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("turn.anim").write_text("mode lines frames 2 azimuth at 0 0 at 1 40", encoding="utf-8")
    Path("water.xyz").write_text("3\nwater\nO 0 0 0\nH 0.76 0.59 0\nH -0.76 0.59 0\n", encoding="utf-8")
    sizes = []
    for style in ("ball-and-stick", "space-filling"):
        assert run(["animate", "water.xyz", "-a", "turn", "-o", f"{style}/", "--molecules", style]) == 0
        frame, _ = sorted(Path(style).glob("*.svg"))
        sizes.append(frame.read_text(encoding="utf-8").count("<path"))
    assert sizes[0] != sizes[1]
    assert run(["animate", "water.xyz", "-a", "turn", "-o", "film.pdf", "--parts", "exact"]) == 1
    assert "for CAD parts only" in capsys.readouterr().err
