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
                with urllib.request.urlopen(address + name, timeout=600) as answer:
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
    assert found[""][:2] == (200, "text/html") and f'data-frames="{len(places)}" data-fps="{fps:g}"' in found[""][2]
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


def looked_at(address):
    """What the page does, in a browser: what it is told is forbidden or fails, and a place for each look at it."""
    from playwright.sync_api import sync_playwright
    from support.browser import launched

    errors, places = [], {}
    with sync_playwright() as playwright:
        browser = launched(playwright)
        page = browser.new_page(viewport={"width": 800, "height": 500})
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
        page.goto(address)
        page.wait_for_selector("#film svg")
        number = page.locator("output[for=frame]")
        passed = set()
        for _ in range(200):
            passed.add(number.inner_text())
            if len(passed) == 4:
                break
            page.wait_for_timeout(20)
        places["passed"] = passed
        page.keyboard.press(" ")
        places["still"] = (number.inner_text(), page.locator("#pause").inner_text())
        page.wait_for_timeout(600)
        places["later"] = (number.inner_text(), page.locator("#pause").inner_text())
        page.locator("#frame").fill("2")
        places["second"] = (number.inner_text(), page.locator("#film svg").screenshot())
        page.keyboard.press("ArrowRight")
        places["third"] = (number.inner_text(), page.locator("#film svg").screenshot())
        page.keyboard.press("ArrowLeft")
        places["back"] = (number.inner_text(), page.locator("#film svg").screenshot())
        page.evaluate("document.activeElement.blur()")
        page.keyboard.press("Home")
        page.keyboard.press("ArrowLeft")
        places["last"] = number.inner_text()
        page.get_by_role("button", name="Play").click()
        places["plays"] = page.locator("#pause").inner_text()
        browser.close()
    quit_it = urllib.request.Request(f"{address}quit", b"{}", {"Content-Type": "application/json"})
    with urllib.request.urlopen(quit_it, timeout=600):
        return errors, places


@pytest.mark.slow
@pytest.mark.capability("G10.2-screen")
def test_a_film_is_stopped_and_stepped_through(tmp_path, monkeypatch):
    pytest.importorskip("playwright")
    monkeypatch.chdir(tmp_path)
    vp.save_frames([frame(place) for place in (10, 25, 40, 60)], "turn.vd1")
    with ThreadPoolExecutor(1) as pool:
        looks = []
        monkeypatch.setattr("webbrowser.open", lambda address: looks.append(pool.submit(looked_at, address)))
        assert run(["replay", "turn", "--fps", "5", "--timeout", "60"]) == 0
        errors, places = looks[0].result(timeout=600)
    assert errors == []
    assert places["passed"] == {"1", "2", "3", "4"}
    assert places["still"] == places["later"] and places["still"][1] == "Play"
    assert (places["second"][0], places["third"][0], places["last"]) == ("2", "3", "4")
    assert places["second"] == places["back"] and places["second"][1] != places["third"][1]
    assert places["plays"] == "Pause"
