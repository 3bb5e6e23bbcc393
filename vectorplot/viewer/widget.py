"""The widget of the viewer in notebooks: its page as a module of JavaScript, its questions and answers as messages."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError, Future
from importlib.resources import files
from typing import Any

import anywidget
import traitlets

from vectorplot.drawing.drawing import Drawing
from vectorplot.shading.image import Image
from vectorplot.viewer.answers import ERRORS, Answers, json_bytes, told
from vectorplot.viewer.pictures import Given, Job, Source, SupersededError, Workers, picture
from vectorplot.viewer.state import ViewerState, first_state

# The page of the viewer as one module of JavaScript, as widgets in notebooks have it.

SCRIPTS = (
    *("program.js", "projection.js", "recording.js", "canvases.js", "recorder.js", "viewer.js"),
    "notebook.js",
)
"""What the widget runs; each file knows only those before it."""


def widget_script() -> str:
    """The scripts as one module, with the body of the page and its style: what a notebook is given."""
    page = _page_file("index.html").partition("<body>")[2].partition("</body>")[0]
    icon = base64.b64encode(_page_file("icon.svg").encode()).decode()
    page = page.replace('"icon.svg"', f'"data:image/svg+xml;base64,{icon}"')
    texts = [f"const PAGE = {json.dumps(page)};", f"const STYLE = {json.dumps(_page_file('viewer.css'))};"]
    return "\n".join([*texts, *(_without_imports(_page_file(name)) for name in SCRIPTS)])


def _page_file(name: str) -> str:
    return files("vectorplot.viewer").joinpath("page", name).read_text(encoding="utf-8")


def _without_imports(script: str) -> str:
    """A script whose imports stand before it in the same file; what others import of it is known there by itself."""
    inside = re.sub(r'^import .* from "\./.*";$', "", script, flags=re.MULTILINE)
    return re.sub(r"^export (?!default)", "", inside, flags=re.MULTILINE)


class ViewerWidget(anywidget.AnyWidget):
    """The page of `vectorplot try` in a notebook; made by `vp.show`.

    source: the scene that is looked at.
    """

    _esm = widget_script()
    state = traitlets.Dict().tag(sync=True)

    def __init__(self, source: Source | Given) -> None:
        super().__init__(state=first_state(source.scene(None)).values())
        self._answers = Answers(source)
        self._workers = Workers()
        self.on_msg(self._heard)

    def picture(self) -> Drawing | Image:
        """What is seen, by the verb of its mode."""
        return picture(ViewerState.of(self.state), self._answers.source.scene(None))

    def close(self) -> None:
        """Take the widget away, and stop its work."""
        self._workers.close()
        super().close()

    def _heard(self, _widget: object, content: object, _buffers: object) -> None:
        """A question of a page, or that it does not wait any more."""
        if not isinstance(content, Mapping):
            return
        what, number, asked = str(content.get("what")), content.get("id"), content.get("asked")
        page = f"{str(content.get('page'))[:64]} {what}"
        jobs = self._workers.of(what)
        if content.get("stop"):
            job = jobs.latest.get(page)
            if job is not None:
                job.stopped.set()
            return
        answer: Callable[[Mapping[str, Any], Job], Any] | None = (
            self._answers.movie if what == "movie" else self._answers.by_name(what)
        )
        if answer is None or not isinstance(asked, Mapping):
            self.send({"id": number, "cause": "no such question", "line": None, "file": None})
            return

        def heard(done: int, count: int) -> None:
            self.send({"id": number, "done": done, "of": count})

        try:
            job, made = jobs.submit(page, lambda job: answer(asked, job), heard)
        except SupersededError:
            self.send({"id": number, "superseded": True})
            return

        def tell(done: Future[Any]) -> None:
            jobs.end(job)
            message, buffers = _answered(done)
            self.send({"id": number, **message}, buffers)

        made.add_done_callback(tell)


def _answered(done: Future[Any]) -> tuple[dict[str, Any], list[bytes]]:
    """The message of an answer and what goes with it, as the page reads it."""
    try:
        made = done.result()
    except (SupersededError, CancelledError):
        return {"superseded": True}, []
    except ERRORS as error:
        return told(error), []
    except Exception as error:
        # The page would wait for ever.
        return {"cause": f"{type(error).__name__}: {error}", "line": None, "file": None}, []
    if not isinstance(made, tuple):
        return {"name": "", "kind": "application/json"}, [json_bytes(made)]
    *name, content, kind = made
    return {"name": name[0] if name else "", "kind": kind}, [content]
