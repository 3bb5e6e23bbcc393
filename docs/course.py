"""Draws the figures of the course, and of the pages on surfaces: the Python of a page runs, and what it saves is shown.

``python docs/course.py [PAGE...]`` writes docs/course/figures/*.svg. A test compares them with what this would write.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parent
FIGURES = DOCS / "course" / "figures"

PAGES = [*sorted((DOCS / "course").glob("[1-8]-*.md")), DOCS / "curves-on-surfaces.md", DOCS / "own-surfaces.md"]
"""The pages whose figures are drawn by their own Python."""


def code_of(page: Path) -> str:
    """All Python of a page, one block after the other."""
    return "\n".join(re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL))


def figures_of(page: Path) -> dict[str, bytes]:
    """The figures that the page shows, by their names, as its Python draws them."""
    shown = re.findall(r"figures/(\w+\.svg)\)", page.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        exec(compile(code_of(page), page.name, "exec"), {"__name__": "page"})
        return {name: Path(name).read_bytes() for name in shown}


def main() -> None:
    """Draw the figures of all pages; or of those whose names begin as given."""
    FIGURES.mkdir(exist_ok=True)
    for page in PAGES:
        if len(sys.argv) == 1 or page.name.startswith(tuple(sys.argv[1:])):
            for name, content in figures_of(page).items():
                (FIGURES / name).write_bytes(content)


if __name__ == "__main__":
    main()
