"""The page of the viewer as one module of JavaScript, as widgets in notebooks have it."""

from __future__ import annotations

import base64
import json
import re
from importlib.resources import files

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
