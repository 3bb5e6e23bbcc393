"""Writes docs/tolerances.md: the table of tolerances, from the file that holds it.

Run it after changing a tolerance: ``python docs/tolerances.py``. A test compares the file with what this would write.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "vectorplot"
TABLE = PACKAGE / "tolerances.py"
PAGE = ROOT / "docs" / "tolerances.md"
IMPORT = re.compile(r"^from vectorplot\.tolerances import (?:\([^)]*\)|.*$)", re.MULTILINE)


@dataclass(frozen=True)
class Tolerance:
    """A name of the table, the number as it is written there, and why it is that number."""

    name: str
    value: str
    reason: str


def tolerances(text: str) -> Iterator[Tolerance]:
    """The tolerances of one section of the table, in its order; reason is empty where none is given."""
    body, lines = ast.parse(text).body, text.splitlines()
    for node, after in zip(body, [*body[1:], None], strict=True):
        if not isinstance(node, ast.Assign):
            continue
        told = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        reason = " ".join(str(ast.literal_eval(after.value)).split()) if told else ""
        target = node.targets[0]
        if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
            pairs = zip(target.elts, node.value.elts, strict=True)
        else:
            pairs = iter([(target, node.value)])
        for name, value in pairs:
            written = lines[value.lineno - 1].encode()[value.col_offset : value.end_col_offset].decode()
            yield Tolerance(ast.unparse(name), written, reason)


def sections() -> Iterator[tuple[str, str]]:
    """The sections of the table: what its comment says, and its statements."""
    text = TABLE.read_text(encoding="utf-8")
    for part in re.split(r"\n\n(?=# )", text)[1:]:
        comment, _, body = part.partition("\n\n")
        yield "\n".join(line.lstrip("# ") for line in comment.splitlines()), body


@cache
def uses() -> dict[str, list[str]]:
    """The files of the package that import each name of the table."""
    found: dict[str, list[str]] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        for statement in IMPORT.findall(path.read_text(encoding="utf-8")):
            # Parsed alone: whole files take two hundred times as long.
            for alias in ast.parse(statement).body[0].names:
                found.setdefault(alias.name, []).append(path.relative_to(ROOT).as_posix())
    return found


def page() -> str:
    """The text of docs/tolerances.md."""
    used = uses()
    intro = " ".join((ast.get_docstring(ast.parse(TABLE.read_text(encoding="utf-8"))) or "").split())
    lines = [
        "# Tolerances",
        "",
        "Written by docs/tolerances.py from vectorplot/tolerances.py.",
        "",
        intro,
        "",
    ]
    for heading, body in sections():
        first, _, rest = heading.partition("\n")
        lines += [f"## {first.rstrip('.')}", ""]
        if rest.strip():
            lines += [" ".join(rest.split()), ""]
        lines += ["| name | value | why | used by |", "|---|---|---|---|"]
        for entry in tolerances(body):
            where = ", ".join(f"[{Path(file).stem}](../{file})" for file in used.get(entry.name, []))
            lines.append(f"| `{entry.name}` | `{entry.value}` | {entry.reason} | {where} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}: {page().count(chr(10))} lines")
