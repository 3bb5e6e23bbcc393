"""The widget answers by messages, as in a notebook, and its script runs in a real browser; no Jupyter is needed."""

from __future__ import annotations

import base64
import json
import queue
import sys

import pytest
from playwright.sync_api import sync_playwright
from support.browser import launched

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.geometry.solids import box
from vectorplot.viewer.state import first_state

PATIENCE_S = 120.0
TEXT = "page 60x40 margin 2\ncamera eye 5 -7 4\nDIE red box solid 1 2 1\n"
SCENE = vp.Scene((vp.Item("die", box((1, 2, 1))),), camera=vp.Camera((4, -5, 3)), page=vp.Page(60, 40, 2))


class Kernel:
    """What a notebook's kernel does with the messages of a widget."""

    def __init__(self, widget, monkeypatch):
        self.widget, self.sent = widget, queue.Queue()
        monkeypatch.setattr(widget, "send", lambda content, buffers=None: self.sent.put((content, buffers or [])))

    def tell(self, message):
        self.widget._handle_custom_msg(message, [])

    def answer(self, message):
        """The last message that answers one, and how many others came before it."""
        self.tell(message)
        before = 0
        while True:
            content, buffers = self.sent.get(timeout=PATIENCE_S)
            if "of" not in content:
                return content, buffers, before
            before += 1


@pytest.fixture
def kernel(monkeypatch):
    widget = vp.show(SCENE)
    yield Kernel(widget, monkeypatch)
    widget.close()


def question(what, **asked):
    return {"id": f"p {what}", "page": "p", "what": what, "asked": {"text": None, **asked}}


def test_questions_are_answered_by_messages(kernel):
    state = first_state(SCENE).values()
    start, (told,), _ = kernel.answer(question("start"))
    assert start["id"] == "p start" and not json.loads(told)["file"] and json.loads(told)["text"] is None
    drawn, (svg,), _ = kernel.answer(question("picture", state=state))
    assert drawn["kind"] == "image/svg+xml" and svg.startswith(b"<?xml")
    frames = {"frames": [state, {"azimuth": 1.0}], "fps": 25, "format": "svg"}
    movie, (content,), before = kernel.answer(question("movie", **frames))
    assert movie["name"] == "scene.svg" and content.startswith(b"<?xml") and before == 3
    for wrong in (question("nothing"), {**question("picture"), "asked": None}, question("picture", state={"mode": 1})):
        assert kernel.answer(wrong)[0]["cause"]


def test_faults_are_told_and_what_is_stopped_says_so(kernel, monkeypatch):
    def fault(state, scene, *, progress):
        raise ZeroDivisionError("of ours")

    monkeypatch.setattr("vectorplot.viewer.answers.picture", fault)
    state = first_state(SCENE).values()
    assert kernel.answer(question("picture", state=state))[0]["cause"] == "ZeroDivisionError: of ours"

    def endless(state, scene, *, progress):
        kernel.tell({"page": "p", "what": "picture", "stop": True})
        while True:
            progress("lines", 0.5)

    monkeypatch.setattr("vectorplot.viewer.answers.picture", endless)
    assert kernel.answer(question("picture", state=state))[0]["superseded"]
    assert kernel.widget._workers.pictures.latest == {}


def test_python_sees_what_the_page_shows_and_can_set_it(kernel):
    first = kernel.widget.picture()
    kernel.widget.set_state({"state": {**first_state(SCENE).values(), "mode": "shading"}})
    assert any(layer.fills for layer in kernel.widget.picture().layers)
    assert not any(layer.fills for layer in first.layers)
    kernel.widget.state = {"azimuth": "north"}
    with pytest.raises(InputError, match="azimuth"):
        kernel.widget.picture()


def test_what_is_wrong_is_said_in_the_cell(tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError):
        vp.show(tmp_path / "none.scene")
    monkeypatch.setitem(sys.modules, "vectorplot.viewer.widget", None)
    with pytest.raises(InputError, match=r"pip install '\.\[notebook\]'"):
        vp.show(SCENE)


MODEL = """async ([source, state]) => {
  const { default: { render } } = await import(URL.createObjectURL(new Blob([source], { type: 'text/javascript' })));
  const on = {}, values = { state };
  const model = {
    get: (name) => values[name], set: (name, value) => { values[name] = value; },
    save_changes: () => { window.kept(JSON.stringify(values.state)); },
    on: (what, heard) => { on[what] = heard; }, off: (what) => { delete on[what]; },
    send: async (message) => {
      for (const [content, buffers] of await window.told(message))
        on['msg:custom']?.(content, buffers.map(
          (one) => new DataView(Uint8Array.from(atob(one), (c) => c.charCodeAt(0)).buffer)));
    },
  };
  const el = document.body.appendChild(document.createElement('div'));
  window.set = (state) => { values.state = { ...values.state, ...state }; on['change:state'](); };
  window.leave = render({ model, el });
  window.heard = () => Object.keys(on).length;
}"""


@pytest.mark.slow
@pytest.mark.capability("G4.4-interactive")
def test_the_page_runs_in_a_notebook(tmp_path, monkeypatch):
    path = tmp_path / "die.scene"
    path.write_text(TEXT, encoding="utf-8")
    kernel, errors = Kernel(vp.show(path), monkeypatch), []

    def told(message):
        if message.get("stop"):
            return []
        content, buffers, _ = kernel.answer(message)
        return [[content, [base64.b64encode(one).decode() for one in buffers]]]

    with sync_playwright() as playwright:
        browser = launched(playwright)
        page = browser.new_page(viewport={"width": 900, "height": 700})
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.expose_function("told", told)
        page.expose_function("kept", lambda state: kernel.widget.set_state({"state": json.loads(state)}))
        page.evaluate("document.addEventListener('keydown', () => { window.leaked = true; })")
        page.evaluate(MODEL, [kernel.widget._esm, kernel.widget.state])
        page.wait_for_selector("#stage[data-exact=yes]")
        page.locator("#stage").press("a")
        page.locator("#text").fill(TEXT.replace("1 2 1", "1 two 1"))
        page.wait_for_selector("#error:visible")
        assert page.inner_text("#error").startswith("Line 3: ")
        page.locator("#text").fill(TEXT)
        page.wait_for_selector("#error", state="hidden")
        page.evaluate("window.set({ mode: 'shading' })")
        page.wait_for_selector("#stage[data-exact=yes]")
        assert page.locator("[name=mode][value=shading]").is_checked()
        page.select_option("#movie-format", "pdf")
        page.locator("#record").press("Enter")
        page.wait_for_selector("#recording:visible")
        page.locator("#crease").fill("40")
        with page.expect_download() as download:
            page.locator("#record").press("Enter")
        assert download.value.suggested_filename == "die.pdf"
        assert not page.evaluate("window.leaked") and page.locator("#gone").is_hidden()
        page.screenshot(path=tmp_path / "widget.png")
        page.evaluate("window.leave()")
        assert page.evaluate("window.heard()") == 0
        browser.close()
    assert errors == []
    kernel.widget.close()
