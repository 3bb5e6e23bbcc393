"""The page in a real browser: keys, mouse, editor, files, two pages, the end of the server; one start for all."""

from __future__ import annotations

import asyncio
import json
import threading
import time
import zipfile
from urllib.parse import unquote

import numpy as np
import pytest
from playwright.sync_api import sync_playwright
from support.browser import launched
from support.paths import ROOT

from vectorplot.animation.animation import Animation
from vectorplot.animation.movies import read_movie
from vectorplot.pictures.film import animate
from vectorplot.viewer.answers import MOST_SEGMENTS, Answers
from vectorplot.viewer.pictures import Source
from vectorplot.viewer.server import Server, serving

pytestmark = pytest.mark.slow

TEXT = 'title "Die"\npage 60x40 margin 2\ncamera eye 5 -7 4\nlight LAMP position 6 -5 8\nDIE red box solid 1 2 1\n'
PATIENCE_MS = 120_000


class Served:
    """A server in a thread of its own."""

    def __init__(self, path, film=None, video=None):
        self.address, self.end, ready = "", None, threading.Event()

        async def all_of_it():
            server = Server(Answers(Source(path), film, video))
            loop = asyncio.get_running_loop()
            async with serving(server) as address:
                self.address, self.end = address, lambda: loop.call_soon_threadsafe(server.stop.set)
                ready.set()
                await server.stop.wait()

        self.thread = threading.Thread(target=lambda: asyncio.run(all_of_it()))
        self.thread.start()
        ready.wait(20)

    def stop(self):
        if self.thread.is_alive():
            self.end()
        self.thread.join(20)
        assert not self.thread.is_alive()


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        found = launched(playwright)
        yield found
        found.close()


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("browser") / "die.scene"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def served(file):
    found = Served(file)
    yield found
    found.stop()


def still(page):
    page.wait_for_selector("#stage[data-exact=yes]", timeout=PATIENCE_MS)


def until(page, expression):
    """Wait until it is true; the page's policy lets nobody evaluate texts in it, not even a tool that waits."""
    end = time.monotonic() + PATIENCE_MS / 1000
    while not page.evaluate(expression):
        assert time.monotonic() < end, expression
        page.wait_for_timeout(30)


def state(page):
    return json.loads(unquote(page.url.partition("#")[2]))


@pytest.fixture
def opened(browser, served):
    """How to open a page in a window of its own; errors in the page, and what its policy forbids, fail the test."""
    contexts, errors = [], []

    def opening(address=None, **options):
        context = browser.new_context(viewport=options.pop("viewport", {"width": 1000, "height": 700}), **options)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda said: errors.append(said.text) if "Content Security" in said.text else None)
        page.goto(address or served.address)
        still(page)
        return page

    yield opening
    for context in contexts:
        context.close()
    assert errors == []


@pytest.mark.capability("G4.4-interactive")
def test_keys_turn_the_picture_and_a_reload_keeps_it(opened):
    page = opened()
    before = state(page)
    for key in ("a", "a", "e", "w", "x", "1"):
        page.keyboard.press(key)
    until(page, "decodeURIComponent(location.hash).includes('\"parallel\":true')")
    page.keyboard.press("u")
    until(page, "decodeURIComponent(location.hash).includes('\"parallel\":false')")
    still(page)
    after = state(page)
    assert after["azimuth"] == pytest.approx(before["azimuth"] + 0.1)
    assert after["elevation"] == pytest.approx(before["elevation"] + 0.05)
    assert after["mode"] == "wire" and after["fov_deg"] < before["fov_deg"]
    page.reload()
    still(page)
    assert state(page) == after
    assert page.locator("[name=mode][value=wire]").is_checked()


def test_mouse_and_wheel_turn_move_and_enlarge(opened):
    page = opened()
    before, box = state(page), page.locator("#stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 20)
    assert page.get_attribute("#stage", "data-exact") == "no"
    page.mouse.up()
    turned = state(page)
    assert turned["azimuth"] < before["azimuth"] and turned["elevation"] > before["elevation"]
    page.mouse.down(button="right")
    page.mouse.move(x, y)
    page.mouse.up(button="right")
    page.mouse.wheel(0, -200)
    still(page)
    moved = state(page)
    assert moved["azimuth"] == turned["azimuth"] and moved["target"] != turned["target"]
    assert moved["fov_deg"] < turned["fov_deg"]


def test_files_are_saved_and_the_command_is_told(opened):
    page = opened()
    for word, head in (("svg", b"<?xml"), ("dxf", b"  0"), ("png", b"\x89PNG")):
        page.select_option("#format", word)
        with page.expect_download() as download:
            page.click("#save")
        assert download.value.suggested_filename == f"die.{word}"
        with open(download.value.path(), "rb") as saved:
            assert saved.read(len(head)) == head
    page.focus("#stage")
    with page.expect_download() as download:
        page.keyboard.press("p")
    assert download.value.suggested_filename == "die.ps"
    page.click("#copy")
    until(page, "document.getElementById('status').textContent.includes('vectorplot draw')")


def test_what_is_typed_is_drawn_and_mistakes_are_told_at_their_line(opened):
    page = opened()
    page.fill("#text", TEXT.replace("1 2 1", "1 two 1"))
    page.wait_for_selector("#error:visible")
    assert page.inner_text("#error").startswith("Line 5: ") and "two" in page.inner_text("#error")
    assert page.inner_text("#numbers .bad") == "5"
    page.fill("#text", TEXT + "BAR blue box solid 1 1 2 translation 2 0 0\n")
    page.wait_for_selector("#error", state="hidden")
    until(page, "document.getElementById('exact').alt === 'Die: 2 items'")
    still(page)
    page.reload()
    still(page)
    assert "BAR" in page.input_value("#text")
    page.click("#as-file")
    until(page, "document.getElementById('exact').alt === 'Die: 1 items'")
    assert page.input_value("#text") == TEXT


def test_two_pages_have_their_own_states(opened):
    one, other = opened(), opened()
    one.keyboard.press("c")
    until(one, "decodeURIComponent(location.hash).includes('shadows')")
    still(one)
    assert state(other)["mode"] == "lines" and state(one)["mode"] == "shadows"


def test_the_keyboard_reaches_everything_in_order_and_focus_is_seen(opened):
    page = opened()
    order = []
    for _ in range(8):
        page.keyboard.press("Tab")
        order.append(page.evaluate("document.activeElement.id || document.activeElement.name"))
        width = "(e => parseFloat(getComputedStyle(e.type === 'radio' ? e.nextElementSibling : e).outlineWidth))"
        assert page.evaluate(f"{width}(document.activeElement)") >= 1.0, order
    assert order[:6] == ["mode", "format", "save", "copy", "help", "stage"]
    page.focus("#help")
    page.keyboard.press("Enter")
    assert page.locator("#keys").is_visible()
    page.keyboard.press("Escape")
    assert page.locator("#keys").is_hidden() and page.locator("#gone").is_hidden()
    page.focus("#crease")
    page.keyboard.press("ArrowRight")
    assert state(page)["crease_angle_deg"] == 26
    nameless = """[...document.querySelectorAll('button, input, select, textarea')].filter(
        e => !(e.textContent.trim() || (e.labels && e.labels.length))).map(e => e.id)"""
    assert page.evaluate(nameless) == []
    assert page.get_attribute("#status", "aria-live") == "polite" and page.get_attribute("#error", "role") == "alert"


CONTRAST = """() => {
  const light = (rgb) => { const [r, g, b] = rgb.match(/[\\d.]+/g).map(Number).map(v => v / 255).map(
    v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  const back = (e) => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor;
    if (!c.startsWith('rgba(0, 0, 0, 0')) return c; } return 'rgb(255, 255, 255)'; };
  const words = 'h1 span, summary, label, button:enabled, output, kbd, #where, #numbers';
  return [...document.querySelectorAll(words)].filter(e => e.offsetParent).map(e => {
    const [a, b] = [light(getComputedStyle(e).color), light(back(e))].sort((p, q) => q - p);
    return (a + 0.05) / (b + 0.05); }).reduce((a, b) => Math.min(a, b)); }"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_words_stand_out_in_the_light_and_in_the_dark(opened, scheme):
    page = opened(color_scheme=scheme)
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert (ground == "rgb(25, 27, 30)") == (scheme == "dark")
    assert page.evaluate(CONTRAST) >= 4.5


def test_a_small_window_shows_everything_below_each_other(opened):
    page = opened(viewport={"width": 360, "height": 640}, has_touch=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    stage, text = page.locator("#stage").bounding_box(), page.locator("#text").bounding_box()
    assert stage["width"] > 300 and text["y"] > stage["y"] + stage["height"] and text["width"] > 250


FRAMES = """async () => {
  const stage = document.getElementById('stage'), box = stage.getBoundingClientRect();
  const send = (type, x) => stage.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: box.x + x,
    clientY: box.y + 100, buttons: 1, bubbles: true }));
  stage.setPointerCapture = () => {};
  send('pointerdown', 100);
  const before = Number(stage.dataset.frames || 0), began = performance.now();
  for (let k = 0; performance.now() - began < 400; k++) {
    send('pointermove', 100 + (k % 150));
    await new Promise(requestAnimationFrame);
  }
  const found = (Number(stage.dataset.frames) - before) / ((performance.now() - began) / 1000);
  send('pointerup', 100);
  return found; }"""


def test_a_town_turns_fifteen_times_a_second(opened):
    town = Served(ROOT / "data" / "town.scene")
    try:
        page = opened(town.address)
        # What else the machine does may take the time of some.
        assert any(page.evaluate(FRAMES) >= 15.0 for _ in range(4))
    finally:
        town.stop()


@pytest.mark.filterwarnings("ignore:.*open mesh")
def test_of_a_large_mesh_some_edges_move_and_all_are_drawn_when_it_is_still(opened, tmp_path):
    """How many edges move is what a browser has to do for a frame: as many of 300,000 triangles as of these."""
    path, size = tmp_path / "hills.obj", 72
    column, row = np.meshgrid(np.arange(size), np.arange(size))
    corner = (row * size + column)[:-1, :-1].ravel() + 1
    lower = np.stack([corner, corner + 1, corner + size + 1], axis=1)
    upper = np.stack([corner, corner + size + 1, corner + size], axis=1)
    heights = 4.0 * np.sin(column / 7.0) * np.cos(row / 9.0)
    points = np.stack([column, row, heights], axis=-1).reshape(-1, 3)
    lines = ["v {} {} {}".format(*point) for point in points.round(4).tolist()]
    lines += ["f {} {} {}".format(*face) for face in np.concatenate([lower, upper]).tolist()]
    path.write_text("\n".join(lines), encoding="utf-8")
    hills = Served(path)
    try:
        page = opened(hills.address)
        rate = page.evaluate(FRAMES)
        print(f"{rate:.0f} frames a second")
        assert rate > 0.0 and MOST_SEGMENTS // 2 < int(page.get_attribute("#stage", "data-lines")) <= MOST_SEGMENTS
        still(page)
    finally:
        hills.stop()


def test_one_finger_turns_and_two_move_and_enlarge(opened):
    page = opened(has_touch=True)
    fingers = page.context.new_cdp_session(page)
    before, box = state(page), page.locator("#stage").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def touch(kind, *points):
        told = [{"x": x + dx, "y": y + dy, "id": number} for number, (dx, dy) in enumerate(points)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": told})

    touch("touchStart", (0, 0))
    touch("touchMove", (60, 20))
    touch("touchEnd")
    still(page)
    turned = state(page)
    assert turned["azimuth"] < before["azimuth"] and turned["elevation"] > before["elevation"]
    assert turned["fov_deg"] == before["fov_deg"] and turned["target"] == before["target"]
    touch("touchStart", (-40, 0), (40, 0))
    touch("touchMove", (-80, 10), (80, 10))
    touch("touchEnd")
    still(page)
    moved = state(page)
    assert moved["azimuth"] == turned["azimuth"] and moved["fov_deg"] < turned["fov_deg"]
    assert moved["target"] != turned["target"]
    assert page.locator("#stage.held").count() == 0


def test_a_film_plays_in_the_mode_of_the_page_until_somebody_turns_the_scene(opened, file):
    scene = Source(file).scene(None)
    turning = Animation(lambda time: scene.items[0].turned("z", 90.0 * time), frames=5, fps=15.0, mode="shading")
    other = Served(file, lambda scene: animate(turning))
    try:
        page = opened(other.address)
        assert page.locator("[name=mode][value=shading]").is_checked()
        page.get_by_role("button", name="Play").press("Enter")
        for number in (2, 5, 1):
            page.wait_for_selector(f"#stage[data-frame='{number}']", timeout=PATIENCE_MS)
        page.locator("[name=mode][value=lines]").check(force=True)
        assert page.locator("#play").get_attribute("aria-pressed") == "true"
        page.wait_for_selector("#stage[data-frame='3']", timeout=PATIENCE_MS)
        page.locator("#stage").press("a")
        until(page, "document.getElementById('play').getAttribute('aria-pressed') === 'false'")
        still(page)
        page.locator("#frame").fill("4")
        page.wait_for_selector("#stage[data-frame='4']", timeout=PATIENCE_MS)
    finally:
        other.stop()


HALF_ARRIVED = """const whole = window.fetch;
window.fetch = async (what, how) => {
  const answer = await whole(what, how);
  if (what !== "ask/frame") return answer;
  document.title = "half arrived";
  const stalled = (body) => how.signal.addEventListener("abort", () => body.error(how.signal.reason));
  return new Response(new ReadableStream({ start: stalled }));
};"""


def test_a_frame_of_which_half_has_arrived_is_given_up_without_a_word(opened, file):
    other = Served(file, lambda scene: animate(Animation(lambda time: scene.items[0].turned("z", time), frames=2)))
    try:
        page = opened(other.address)
        page.evaluate(HALF_ARRIVED)
        page.get_by_role("button", name="Play").press("Enter")
        until(page, "document.title === 'half arrived'")
        page.locator("#stage").press("a")
        until(page, "document.getElementById('play').getAttribute('aria-pressed') === 'false'")
        still(page)
        assert not page.locator("#gone").is_visible()
    finally:
        other.stop()


LATE = """window.late = [];
const whole = window.fetch, decode = HTMLImageElement.prototype.decode;
window.fetch = async (what, how) => {
  const answer = await whole(what, how);
  if (what !== LATE) return answer;
  await new Promise((go) => window.late.push(go));
  return answer;
};
if (LATE === "decode") HTMLImageElement.prototype.decode = async function () {
  await decode.call(this).catch(() => {});
  await new Promise((go) => window.late.push(go));
};
null;"""
"""Answers of one kind, or pictures, are held back until they are let go."""


def held_back(page, what):
    page.evaluate(LATE.replace("LATE", json.dumps(what)))


def test_a_frame_that_is_decoded_late_does_not_cover_what_moves(opened, file):
    other = Served(file, lambda scene: animate(Animation(lambda time: scene.items[0].turned("z", time), frames=3)))
    try:
        page = opened(other.address)
        held_back(page, "decode")
        page.locator("#frame").fill("2")
        until(page, "window.late.length === 1")
        page.locator("#stage").press("a")
        until(page, "document.getElementById('stage').classList.contains('moves')")
        page.evaluate("window.late.shift()()")
        until(page, "window.late.length === 1")
        assert page.locator("#stage.moves[data-exact=no]").count() == 1
        assert page.locator("#stage[data-frame]").count() == 0
        page.evaluate("window.late.shift()()")
        still(page)
        assert page.locator("#stage.moves").count() == 0
    finally:
        other.stop()


def test_a_scene_that_comes_late_does_not_replace_that_of_a_newer_text(opened):
    page = opened()
    held_back(page, "ask/scene")
    page.locator("#text").fill(TEXT.replace("Die", "Older"))
    until(page, "window.late.length === 1")
    page.locator("#text").fill(TEXT.replace("Die", "Newer"))
    until(page, "window.late.length === 2")
    page.evaluate("window.late.pop()()")
    until(page, "document.getElementById('exact').alt.startsWith('Newer')")
    page.evaluate("window.late.pop()()")
    page.wait_for_timeout(100)
    assert page.locator("#exact").get_attribute("alt").startswith("Newer")


@pytest.mark.parametrize(("what", "asked"), [("ask/fit", "#fit"), ("ask/keys", "[data-key='6']")])
def test_an_answer_that_comes_late_leaves_what_has_changed_since(opened, what, asked):
    page = opened()
    before = state(page)
    held_back(page, what)
    page.locator(asked).first.click()
    until(page, "window.late.length === 1")
    page.locator("[name=mode][value=wire]").check(force=True)
    assert state(page)["mode"] == "wire" and state(page)["azimuth"] == before["azimuth"]
    page.evaluate("window.late.shift()()")
    changed = "fov_deg" if what == "ask/fit" else "azimuth"
    until(page, f"JSON.parse(decodeURIComponent(location.hash.slice(1))).{changed} !== {before[changed]!r}")
    assert state(page)["mode"] == "wire"
    still(page)


def recorded(page, *keys):
    """Record a few keys."""
    page.locator("#stage").press("v")
    page.wait_for_selector("#recording:visible", timeout=PATIENCE_MS)
    for key in keys:
        before = page.url
        page.keyboard.press(key)
        until(page, f"location.href !== {before!r}")
    page.keyboard.press("v")


@pytest.mark.capability("G4.4-interactive")
def test_what_is_done_is_recorded_and_drawn_as_a_movie(opened, tmp_path):
    page = opened()
    page.select_option("#movie-format", "vd1")
    with page.expect_download() as download:
        recorded(page, "a", "a", "e")
    assert download.value.suggested_filename == "die.zip"
    with zipfile.ZipFile(download.value.path()) as archive:
        assert archive.namelist() == ["die.vd1", "die.vd2"]
        archive.extractall(tmp_path)
    movie = read_movie(tmp_path / "die")
    # Keys within one twenty-fifth of a second are one frame.
    assert 2 <= len(movie) <= 4 and movie.frames[0] != movie.frames[-1]
    told = f"Saved die.zip: {len(movie)} frames"
    until(page, f"document.getElementById('movie-told').textContent === {told!r}")
    assert page.locator("#making").is_hidden() and page.locator("#recording").is_hidden()
    page.locator("#record").press("Enter")
    assert page.get_attribute("#record", "aria-pressed") == "true"


def test_a_recording_goes_to_its_file_and_its_drawing_can_be_stopped(opened, file, tmp_path, monkeypatch):
    began = threading.Event()

    def endless(state, scene, *, progress):
        began.set()
        while True:
            progress("lines", 0.5)
            time.sleep(0.01)

    video = tmp_path / "turn.svg"
    other = Served(file, video=video)
    try:
        page = opened(other.address)
        with monkeypatch.context() as patched:
            patched.setattr("vectorplot.viewer.answers.picture", endless)
            recorded(page, "a")
            page.wait_for_selector("#stop-movie:visible", timeout=PATIENCE_MS)
            assert began.wait(PATIENCE_MS / 1000) and page.locator("#record").is_disabled()
            page.click("#stop-movie")
            until(page, "document.getElementById('movie-told').textContent === 'Nothing was saved'")
        recorded(page, "a")
        until(page, "document.getElementById('movie-told').textContent.startsWith('Saved')")
        assert video.read_bytes().count(b"<animate") and not list(tmp_path.glob("*.tmp"))
    finally:
        other.stop()


def test_the_end_of_the_server_is_told(opened, file):
    other = Served(file)
    page = opened(other.address)
    page.keyboard.press("q")
    page.wait_for_selector("#gone:visible")
    assert "stopped" in page.inner_text("#gone")
    other.stop()
