"""``vectorplot replay`` shows a movie in a page: all frames, one after the other, as long as they last."""

import re
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills

pytest.importorskip("aiohttp")


def frame(place):
    """A square on a sheet, both filled."""
    sheet, square = np.array([[0, 0], [100, 0], [100, 50], [0, 50.0]]), np.array([[0, 0], [9, 0], [9, 9], [0, 9.0]])
    corners = np.concatenate([sheet, square + np.array([place, 5])])
    colours = np.array([[255, 255, 255], [200, 30, 30]], dtype=np.uint8)
    return Drawing(100.0, 50.0, (Layer("polygons", Pen(0.3), (Fills.flat(corners, np.array([0, 4, 8]), colours),)),))


def page_of(command, monkeypatch):
    """What the command serves: its page and its film, and what is refused there."""
    found = {}

    def fetch(address):
        for name in ("", "film.svg", "viewer.js", "ask/draw"):
            try:
                with urllib.request.urlopen(address + name, timeout=10) as answer:
                    found[name] = answer.status, answer.headers.get_content_type(), answer.read().decode()
            except urllib.error.HTTPError as refused:
                found[name] = refused.code, "", ""

    with ThreadPoolExecutor(1) as pool:
        monkeypatch.setattr("webbrowser.open", lambda address: pool.submit(fetch, address))
        assert run([*command, "--timeout", "0.4"]) == 0
    return found


@pytest.mark.capability("G10.2-screen", "G10.2-replay", "GA.3-cli")
@pytest.mark.parametrize(("told", "fps"), [([], 30.0), (["--fps", "4"], 4.0)])
def test_a_movie_is_shown_in_a_page_at_its_rate(tmp_path, monkeypatch, capsys, told, fps):
    monkeypatch.chdir(tmp_path)
    places = (10, 20, 20, 30, 60)
    vp.save_frames([frame(place) for place in places], "turn.vd1", fps=12)
    found = page_of(["replay", "turn", *told], monkeypatch)
    out = capsys.readouterr().out
    assert out.startswith("5 frames, 1 of them frozen") and "http://127.0.0.1:" in out
    assert found[""][:2] == (200, "text/html") and '<img src="film.svg"' in found[""][2]
    status, kind, svg = found["film.svg"]
    assert (status, kind) == (200, "image/svg+xml")
    lasts = {float(text) for text in re.findall(r'dur="([\d.]+)s"', svg)}
    assert len(lasts) == 1 and lasts.pop() == pytest.approx(len(places) / fps, abs=1e-3)
    assert 'repeatCount="indefinite"' in svg and svg.count("<animate") >= len(set(places))
    # Nothing of the viewer is there.
    assert found["viewer.js"][0] == found["ask/draw"][0] == 404


@pytest.mark.capability("GA.3-cli")
def test_a_movie_that_is_written_opens_no_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda address: pytest.fail("a page was opened"))
    vp.save_frames([frame(place) for place in (10, 20)], "turn.vd1")
    assert run(["replay", "turn", "-o", "again.svg"]) == 0
    assert run(["replay", "turn", "--no-browser", "--timeout", "0.01"]) == 0
