"""``vectorplot try`` prints one line with the address, and ends when it is told to."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from support.paths import ROOT

from vectorplot.animation.movies import read_movie
from vectorplot.cli.main import run


@pytest.fixture
def pencils(tmp_path, monkeypatch):
    """A folder with the pencil and its animation, of four frames, where the book has them; and what is served there."""
    for folder, name in (("data", "pencil.scene"), ("anim", "pencil.anim")):
        (tmp_path / folder).mkdir()
        shutil.copy(ROOT / "data" / name, tmp_path / folder)
    path = tmp_path / "anim" / "pencil.anim"
    path.write_text(path.read_text(encoding="utf-8").replace("frames 48", "frames 4"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    served = []

    async def serve(answers, started, timeout):
        started("http://127.0.0.1/")
        served.append(answers)

    monkeypatch.setattr("vectorplot.viewer.server.serve", serve)
    return served


@pytest.mark.slow
@pytest.mark.capability("GA.3-pencil")
def test_the_pencil_is_tried_animated_and_recorded(pencils, tmp_path):
    assert run(["try", "pencil", "--no-browser"]) == 0
    assert pencils[0].source.scene(None).title == "Pencil" and pencils[0].film is None
    assert run(["try", "pencil", "-a", "pencil", "--no-browser"]) == 0
    assert len(pencils[1].film(pencils[1].source.scene(None))) == 4
    assert not (tmp_path / "video").exists()
    assert run(["try", "pencil", "-a", "pencil", "-v", "pencil"]) == 0
    assert sorted(path.name for path in (tmp_path / "video").iterdir()) == ["pencil.vd1", "pencil.vd2"]
    assert len(read_movie("video/pencil")) == 4
    assert run(["replay", "pencil", "--no-browser", "--timeout", "0.01"]) == 0


@pytest.mark.capability("GA.3-cli")
@pytest.mark.parametrize(
    ("options", "status", "pages"),
    [
        ([], 0, 1),
        (["-a", "pencil"], 0, 1),
        (["-a", "anim/pencil.anim", "-v", "video/turn"], 0, 0),
        (["-a", "pencil", "-v", "turn.svg"], 0, 0),
        (["-v", "turn"], 0, 1),
        (["-v", "none/turn"], 1, 0),
        (["-v", "none/turn.pdf"], 1, 0),
        (["-a", "none"], 1, 0),
        (["-a"], 2, 0),
    ],
    ids=lambda given: " ".join(given) or "alone" if isinstance(given, list) else None,
)
def test_options_show_a_page_or_make_a_movie(pencils, options, status, pages, capsys):
    assert run(["try", "pencil", "--no-browser", *options]) == status
    assert len(pencils) == pages
    assert not pages or pencils[0].video == (Path("video/turn.vd1") if "-v" in options else None)
    assert Path("turn.svg").exists() == ("turn.svg" in options)
    assert bool(capsys.readouterr().err.strip()) == (status != 0)


@pytest.mark.slow
def test_it_stops_by_a_signal_and_leaves_with_status_0(cube):
    command = [sys.executable, "-m", "vectorplot", "try", str(cube), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address = process.stdout.readline().strip()
            with urllib.request.urlopen(address, timeout=600) as answer:
                assert b"<title>vectorplot</title>" in answer.read()
            os.kill(process.pid, signal.SIGTERM)
            out, said = process.communicate(timeout=600)
        finally:
            process.kill()
    assert (process.returncode, out, said) == (0, "", "")


def test_it_stops_when_its_time_is_over(cube, capsys):
    assert run(["try", str(cube), "--no-browser", "--timeout", "0.05"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("http://127.0.0.1:") and out.count("\n") == 1


def test_what_is_wrong_is_one_line_before_anything_is_served(cube, capsys, monkeypatch):
    assert run(["try", "no-such-scene", "--no-browser"]) == 1
    cube.write_text("f 1 2 3\n", encoding="utf-8")
    assert run(["try", str(cube), "--no-browser"]) == 1
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    cube.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    assert run(["try", str(cube), "--no-browser"]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert len(told.err.splitlines()) == 3 and "pip install '.[viewer]'" in told.err
