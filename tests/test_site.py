"""The site: every page of docs/ is on it, and it is built without a warning."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright
from support.browser import launched
from support.paths import ROOT

DOCS = ROOT / "docs"


BUILD = """
import gc, logging, sys
from sphinx.builders.html import StandaloneHTMLBuilder
from sphinx.cmd.build import main
gc.disable()
logging.disable(logging.DEBUG)
StandaloneHTMLBuilder.search = False
sys.exit(main(sys.argv[1:]))
"""
"""What ``sphinx-build`` does, without looking for garbage, of which there is little, without notes for who looks for
mistakes in sphinx, and without the index of words in the pages, of which there is nothing to warn: a fifth of the
time."""


WIDER = "document.scrollingElement.scrollWidth - innerWidth"
PAPER = "[...new Set([...document.querySelectorAll('article img')].map(i => getComputedStyle(i).backgroundColor))]"
TALL = "Math.max(...[...document.querySelectorAll('article img')].map(i => i.getBoundingClientRect().height))"


def assert_pages_fit_phones_and_the_dark(site: Path) -> None:
    """No page is wider than a phone, and pictures, whose lines are black, lie on white paper where pages are dark."""
    shown = "index gallery/README accuracy stability command scene-language course/2-hidden-line coverage".split()
    with sync_playwright() as playwright, closing(launched(playwright)) as browser:
        page = browser.new_page(viewport={"width": 390, "height": 800}, color_scheme="dark")
        for name in shown:
            page.goto((site / f"{name}.html").as_uri())
            assert page.evaluate(WIDER) <= 0, name
            assert page.evaluate(PAPER) in ([], ["rgb(255, 255, 255)"]), name
            if name == "gallery/README":
                assert page.evaluate(TALL) == 220, "as high as docs/gallery.py says"


@pytest.mark.slow
def test_the_site_is_built_without_a_warning_from_all_pages(tmp_path: Path) -> None:
    source, site = tmp_path / "docs", tmp_path / "site"
    shutil.copytree(DOCS, source, ignore=shutil.ignore_patterns("reference"))
    # A thousand names in the table of contents of every page take a sixth of the time, and curved quotation marks a
    # twentieth; neither has anything to warn of.
    options = ["-q", "-W", "--keep-going", "-b", "html", "-D", "toc_object_entries=0", "-D", "smartquotes=0"]
    command = [sys.executable, "-c", BUILD, *options, str(source), str(site)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-3000:]
    written = (*DOCS.glob("*.md"), *DOCS.glob("gallery/*.md"), *DOCS.glob("course/*.md"))
    pages = [page.relative_to(DOCS).with_suffix(".html") for page in written]
    assert all((site / page).stat().st_size > 1000 for page in pages)
    front = (site / "index.html").read_text(encoding="utf-8")
    assert all(f'href="{page.as_posix()}"' in front for page in pages if page.stem != "index")
    beside = front[front.index('class="sidebar-tree"') : front.index('<div class="main">')]
    listed = re.findall(r"^\| \[.*\]\((.*)\.md\)", (DOCS / "index.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert [link for link in re.findall(r'href="(.*?)\.html"', beside) if "reference/" not in link] == listed
    for page in site.rglob("*.html"):
        pictures = re.findall(r'<img [^>]*src="([^"]+)"', page.read_text(encoding="utf-8"))
        assert all((page.parent / picture).is_file() for picture in pictures), page.name
    assert (site / "gallery" / "README.html").read_text(encoding="utf-8").count("<img ") > 200
    film = (site / "course" / "8-film.html").read_text(encoding="utf-8")
    assert 'href="../animation.html"' in film, "links between folders of pages stay links"
    surfaces = (site / "reference" / "surfaces.html").read_text(encoding="utf-8")
    assert re.search(r"vectorplot\.surfaces.*Torus", surfaces, re.DOTALL)
    assert_pages_fit_phones_and_the_dark(site)
    assert "http-equiv" not in front and 'src="http' not in front, "nothing is loaded from elsewhere"
