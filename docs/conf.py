"""How the site is made of docs/: ``sphinx-build -W docs site``."""

from __future__ import annotations

import re
from pathlib import Path

from docutils import nodes
from jinja2 import BaseLoader
from jinja2.sandbox import SandboxedEnvironment
from numpydoc import docscrape_sphinx
from sphinx.application import Sphinx
from sphinx.pycode.parser import Parser

from vectorplot import __version__

ROOMS = (
    "geometry curves surfaces features scene io visibility shading drawing effects textbook backends "
    "batch testing accuracy"
).split()
"""The rooms whose names the reference lists."""

project = "vectorplot"
copyright = "the vectorplot authors, MIT licence"
release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc", "sphinx_copybutton"]
exclude_patterns = ["_build"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
html_theme = "furo"
html_title = "vectorplot"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "html_image"]
numpydoc_show_class_members = False
autodoc_member_order = "alphabetical"
autodoc_typehints = "none"
autodoc_use_type_comments = False


def reference(app: Sphinx) -> None:
    """A page for every room of the package, with what it exports: written before pages are read."""
    folder = Path(app.srcdir) / "reference"
    folder.mkdir(exist_ok=True)
    for room in ("vectorplot", *ROOMS):
        name, index = (room, "   :no-index:\n") if room == "vectorplot" else (f"vectorplot.{room}", "")
        text = f"{name}\n{'=' * len(name)}\n\n.. automodule:: {name}\n   :members:\n   :imported-members:\n{index}"
        page = folder / f"{room}.rst"
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


def with_contents(app: Sphinx, name: str, source: list[str]) -> None:
    """The front page gets the table of contents that the site shows beside every page: its headings, and the pages it
    lists below them."""
    if name == "index":
        for section in source[0].split("\n## ")[1:]:
            heading, _, text = section.partition("\n")
            pages = re.findall(r"^\| \[.*\]\((.*)\.md\)", text, flags=re.MULTILINE)
            if heading == "Reference":
                pages += [f"reference/{room}" for room in ("vectorplot", *ROOMS)]
            if pages:
                source[0] += "\n```{toctree}\n:hidden:\n:caption: " + heading + "\n\n" + "\n".join(pages) + "\n```\n"


def without_links_outside(app: Sphinx, name: str, source: list[str]) -> None:
    """Links to files of the repository that are no pages become their texts."""
    folder = (Path(app.srcdir) / name).parent

    def shown(link: re.Match[str]) -> str:
        inside = (folder / link[2]).resolve().is_relative_to(Path(app.srcdir).resolve())
        return link[0] if inside else f"`{link[1].strip('`')}`"

    source[0] = re.sub(r"(?<!!)\[([^\]]+)\]\((\.\./[^)#]*)[^)]*\)", shown, source[0])


def with_long_names(app: Sphinx, doctree: nodes.document) -> None:
    """Names of tests and the like may break anywhere, so that tables of them fit their page."""
    for literal in doctree.findall(nodes.literal):
        if max(map(len, literal.astext().split()), default=0) > 30:
            literal["classes"].append("long")


def setup(app: Sphinx) -> None:
    """What sphinx calls."""
    environments: dict[type[BaseLoader], SandboxedEnvironment] = {}

    def environment(loader: BaseLoader) -> SandboxedEnvironment:
        return environments.setdefault(type(loader), SandboxedEnvironment(loader=loader))

    # Numpydoc makes an environment for each of a thousand docstrings, and compiles its one template in each anew.
    docscrape_sphinx.SandboxedEnvironment = environment
    # Sphinx looks for the lines on which names are defined, which only pages that show the sources tell of, in two
    # thirds of the time that it reads a module in.
    Parser.parse_definition = lambda parser: None
    app.connect("builder-inited", reference)
    app.connect("source-read", without_links_outside)
    app.connect("source-read", with_contents)
    app.connect("doctree-read", with_long_names)
