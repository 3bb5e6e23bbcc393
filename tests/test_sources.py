"""What docstrings name as a source, an erratum or a decision can be read in docs/."""

from __future__ import annotations

import ast
import re

import pytest
from support.paths import DOCS, PACKAGE
from support.sources import statements_of, text_of, tree_of

ERRATUM = re.compile(r"\b(?:G\d|N|R|V)-\d\d\b|\bD-\d\b")


def docstrings():
    """The docstrings of files that cite, those of constants too, each on one line."""
    for path in sorted(PACKAGE.rglob("*.py")):
        if not (ERRATUM.search(text_of(path)) or "Source:" in text_of(path)):
            continue
        for node in statements_of(tree_of(path)):
            if (
                isinstance(node, ast.Expr)
                and isinstance(node.value, ast.Constant)
                and isinstance(node.value.value, str)
            ):
                yield " ".join(node.value.value.split())


@pytest.fixture(scope="module")
def texts():
    return list(docstrings())


@pytest.mark.slow
def test_every_erratum_that_a_docstring_names_has_its_line(texts):
    rows = re.findall(r"^\| (\S+) \|", (DOCS / "errata.md").read_text(encoding="utf-8"), re.MULTILINE)
    cited = {name for text in texts for name in ERRATUM.findall(text)}
    assert len(cited) > 80
    assert cited <= set(rows)
    assert len(rows) == len(set(rows))


def test_every_erratum_has_a_place_and_a_test():
    for line in (DOCS / "errata.md").read_text(encoding="utf-8").splitlines():
        if ERRATUM.match(line.removeprefix("| ")):
            _, _, place, right, test, _ = line.split("|")
            assert place.strip() and right.strip() and "](../tests/" in test, line


def test_every_source_that_a_docstring_names_is_in_the_bibliography(texts):
    """By the names before the first comma: of authors, of who publishes a format, or of a standard."""
    page = (DOCS / "bibliography.md").read_text(encoding="utf-8")
    cited = {match for text in texts for match in re.findall(r"Source: ([A-Z0-9][^,;:(.]*)[,;:]", text)}
    assert len(cited) > 30
    missing = []
    for source in cited:
        names = re.findall(r"[A-Z][\w-]+(?<!-)", source.split(" for ")[0]) or [source]
        missing += [f"{name} ({source})" for name in names if name.removesuffix("'s") not in page and "'" not in source]
    assert not missing
