"""Sketches in a page: their parameters, what they draw, their errors, and that they end in time."""

from __future__ import annotations

import asyncio
import base64
import threading
import time

import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.viewer.pictures import Job, SupersededError
from vectorplot.viewer.sketches import Sketch, made_by

SKETCH = """
from typing import Annotated, Literal
import vectorplot as vp
from vectorplot.geometry import box

def sketch(side: Annotated[float, 1, 5] = 2.0, count=3, whole: bool = True, name: str = "a",
           view: Literal["iso", "top"] = "iso", seed: int = 7):
    print("seed", seed)
    return vp.draw(vp.Item(name, box((side, side, side))), view, page="A6")
"""


@pytest.fixture
def sketch_of(tmp_path):
    """A sketch with a text."""

    def written(text, timeout_s=30.0):
        path = tmp_path / "art.py"
        path.write_text(text, encoding="utf-8")
        return Sketch(path, timeout_s)

    return written


def test_parameters_are_what_annotations_and_defaults_say(sketch_of):
    made = made_by(sketch_of(SKETCH).path, {"side": 3, "count": "many", "view": "left", "unknown": 1})
    told = [(one["name"], one["kind"], one["value"], one["low"], one["high"]) for one in made["parameters"]]
    assert told[:3] == [
        ("side", "float", 2.0, 1.0, 5.0),
        ("count", "int", 3, 0.0, 6.0),
        ("whole", "bool", True, 0.0, 1.0),
    ]
    assert [one[:3] for one in told[3:]] == [("name", "text", "a"), ("view", "choice", "iso"), ("seed", "int", 7)]
    assert made["parameters"][4]["choices"] == ("iso", "top")
    assert made["kind"] == "image/svg+xml" and b"<svg" in base64.b64decode(made["picture"])


def test_shapes_are_drawn_and_pixels_are_pixels(sketch_of):
    for text, kind in (
        ("return box((1, 1, 1))", "image/svg+xml"),
        ("return vp.render(box((1, 1, 1)), size=(20, 10))", "image/png"),
    ):
        head = f"import vectorplot as vp\nfrom vectorplot.geometry import box\ndef sketch():\n    {text}\n"
        assert made_by(sketch_of(head).path, {})["kind"] == kind


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("def other(): pass", "has no function sketch"),
        ("def sketch(n): pass", "n has no default, such as n=1.0"),
        ("def sketch(n: list = ()): pass", "n is of no type that the page has a control for"),
        ("from __future__ import annotations\ndef sketch(n: Size = 3): pass", "name 'Size' is not defined"),
    ],
)
def test_sketches_that_say_too_little_are_told(sketch_of, text, cause):
    with pytest.raises(vp.InputError, match=cause):
        made_by(sketch_of(text).path, {})


@pytest.mark.slow
def test_a_process_of_its_own_draws_and_tells_what_is_wrong_and_where(sketch_of):
    made = sketch_of(SKETCH).drawn({"values": {"seed": 5}}, Job())
    assert made["printed"] == "seed 5\n" and made["stamp"] and "error" not in made
    made = sketch_of("def sketch(n: int = 1):\n    return 1 / 0\n").drawn({}, Job())
    assert "ZeroDivisionError" in made["error"] and "line 2, in sketch" in made["error"]
    assert "vectorplot/viewer" not in made["error"]
    assert "SyntaxError" in sketch_of("def sketch(:").drawn({}, Job())["error"]
    assert "status 3" in sketch_of("import os\ndef sketch():\n    os._exit(3)\n").drawn({}, Job())["error"]
    assert "SystemExit" in sketch_of("raise SystemExit(0)").drawn({}, Job())["error"]


@pytest.mark.slow
def test_a_sketch_that_takes_too_long_or_that_nobody_waits_for_ends(sketch_of):
    endless = "import time\ndef sketch():\n    time.sleep(600)\n"
    start = time.monotonic()
    assert sketch_of(endless, 0.5).drawn({}, Job())["error"] == "stopped after 0.5 seconds (--sketch-timeout)"
    job = Job()
    threading.Timer(0.3, job.stopped.set).start()
    with pytest.raises(SupersededError):
        sketch_of(endless).drawn({}, job)
    assert time.monotonic() - start < 300


def test_the_command_says_what_goes_with_sketches(tmp_path, capsys):
    assert run(["try", str(tmp_path / "none.py")]) == 1
    assert "there is no such file" in capsys.readouterr().err
    assert run(["try", "art.py", "-a", "film.anim"]) == 2


@pytest.mark.slow
def test_the_page_draws_again_when_the_file_or_a_parameter_changes(sketch_of, tmp_path):
    pytest.importorskip("aiohttp")
    from playwright.async_api import async_playwright
    from support.browser import CHROMIUM

    from vectorplot.viewer.server import Server, serving, sketch_pages

    sketch = sketch_of(SKETCH)

    async def all_of_it():
        async with serving(Server(sketch, sketch_pages(sketch))) as address, async_playwright() as play:
            browser = await play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
            page = await browser.new_page(viewport={"width": 1100, "height": 700})
            faults = []
            page.on("pageerror", lambda error: faults.append(str(error)))
            await page.goto(address)
            state = page.locator("#state:has-text('drawn in')")
            await state.wait_for(timeout=600_000)
            assert await page.locator("#parameters input[type=range]").count() == 2
            first = await page.get_attribute("#picture", "src")
            await page.fill("[data-name=seed]", "12")
            await page.locator("#printed:has-text('seed 12')").wait_for(timeout=600_000)
            assert "%22seed%22%3A12" in page.url and await page.get_attribute("#picture", "src") != first
            sketch.path.write_text(SKETCH.replace("side, side, side", "side, side, 1 / 0"), encoding="utf-8")
            await page.locator("#error:has-text('ZeroDivisionError')").wait_for(timeout=600_000)
            sketch.path.write_text(SKETCH.replace("count=3", "count=30"), encoding="utf-8")
            await page.locator("#error").wait_for(state="hidden", timeout=600_000)
            await state.wait_for(timeout=600_000)
            assert await page.get_attribute("[data-name=count]", "max") == "60"
            await page.screenshot(path=str(tmp_path / "page.png"))
            async with page.expect_download() as downloading:
                await page.click("#save")
            assert (await downloading.value).suggested_filename == "art-12.svg"
            await browser.close()
            assert not faults

    asyncio.run(all_of_it())
