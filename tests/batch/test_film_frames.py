"""Frames of a film as files of their own."""

import pytest

import vectorplot as vp
from vectorplot.batch import run
from vectorplot.batch.running import Tally, frame_tasks
from vectorplot.cli.main import run as run_command
from vectorplot.geometry import box

DIE = vp.Item("die", box((1, 1, 1)))
SCENE = "camera eye 9 9 9\nDIE blue box 1 1 1"
TURN = "frames 4 loop\nazimuth linear at 0 0 at 1 360"


@pytest.mark.slow
def test_tasks_write_what_saving_writes(tmp_path):
    film = vp.animate(vp.Animation(lambda time: DIE.turned("z", 90 * time), frames=3), page="60x50")
    vp.save_frames(film, tmp_path / "saved")
    assert run(frame_tasks(film, tmp_path / "run")) == Tally(written=3)
    names = sorted(path.name for path in (tmp_path / "saved").iterdir())
    assert names == ["0001.svg", "0002.svg", "0003.svg"] == sorted(path.name for path in (tmp_path / "run").iterdir())
    assert all((tmp_path / "saved" / name).read_bytes() == (tmp_path / "run" / name).read_bytes() for name in names)


def test_formats_of_frames_are_known():
    film = vp.animate(vp.Animation(lambda time: DIE, frames=1), page="60x50")
    with pytest.raises(vp.InputError, match="unknown format 'gif'"):
        next(frame_tasks(film, "x", format="gif"))


@pytest.mark.slow
def test_animate_makes_only_the_frames_that_have_changed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "die.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "turn.anim").write_text(TURN, encoding="utf-8")
    words = ["animate", "die", "-a", "turn", "-o", "out/", "--page", "60x50"]

    def made(*more):
        before = {path.name: path.stat().st_ino for path in tmp_path.glob("out/*.svg")}
        assert run_command([*words, *more]) == 0
        return {path.name for path in tmp_path.glob("out/*.svg") if before.get(path.name) != path.stat().st_ino}

    every = {f"000{number}.svg" for number in range(1, 5)}
    assert made() == every
    (tmp_path / "out" / "0002.svg").unlink()
    assert made("--jobs", "2") == {"0002.svg"}
    (tmp_path / "die.scene").write_text(SCENE.replace("1 1 1", "1 1 2"), encoding="utf-8")
    assert made() == every
    assert run_command([*words[:-4], "-o", "out.pdf", "--workers", "2"]) == 2
    assert "frames into a folder alone" in capsys.readouterr().err
