"""Writes docs/coverage.md: which test proves which row of the list of capabilities, and which hard case.

Run it after adding a mark: ``python docs/coverage.py``. A test compares the file with what this would write.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "coverage.md"
KINDS = ("capability", "hard")


def marks(tree: ast.Module) -> Iterator[tuple[str, str | int, str]]:
    """Mark, its argument and the test it stands on: capability and hard marks, those of a whole file included."""
    for node in tree.body:
        body = node.body if isinstance(node, ast.ClassDef) else [node]
        for part in body:
            if isinstance(part, ast.FunctionDef):
                named = [(mark, part.name) for mark in part.decorator_list]
            elif isinstance(part, ast.Assign) and "pytestmark" in {
                getattr(target, "id", "") for target in part.targets
            }:
                named = [(part.value, "all tests")]
            else:
                continue
            for mark, name in named:
                for call in ast.walk(mark):
                    if isinstance(call, ast.Call) and getattr(call.func, "attr", "") in KINDS:
                        for argument in call.args:
                            yield call.func.attr, ast.literal_eval(argument), name


def module_of(test: Path) -> str:
    """The module a test file is of by its name, or the folder of its test, as a link; the room where there is none."""
    room = Path("vectorplot", *test.relative_to(ROOT / "tests").parts[:-1])
    words = test.stem.removeprefix("test_").split("_")
    # Several files may be of one module: test_render_shadows.py is of render.py.
    names = ["_".join(words[:count]) for count in range(len(words), 0, -1)]
    rooms = [room, *list(room.parents)[:-1]]
    places = [place / file for place in rooms for name in names for file in (f"{name}.py", name)]
    folders = [place.with_suffix(".py") for place in rooms]
    shown = next(place for place in (*places, *folders, *rooms) if (ROOT / place).exists())
    return f"[{shown.as_posix()}](../{shown.as_posix()})"


def ordered(key: str | int) -> list[tuple[int, int, str]]:
    """A key that sorts G2.10 after G2.9."""
    return [(1, int(part), "") if part.isdigit() else (0, 0, part) for part in re.split(r"(\d+)", str(key))]


def page() -> str:
    """The text of docs/coverage.md."""
    rows: dict[str, dict[str | int, list[tuple[str, str]]]] = {"capability": {}, "hard": {}}
    for test in sorted((ROOT / "tests").rglob("test_*.py")):
        where, text = test.relative_to(ROOT).as_posix(), test.read_text(encoding="utf-8")
        for kind, key, name in marks(ast.parse(text)) if any(f"mark.{kind}" in text for kind in KINDS) else ():
            rows[kind].setdefault(key, []).append((module_of(test), f"[{name}](../{where})"))
    lines = ["# What is covered", "", "Written by docs/coverage.py from the marks on the tests.", ""]
    for kind, heading in (("capability", "Capabilities"), ("hard", "Hard cases")):
        lines += [
            f"## {heading}",
            "",
            f"{len(rows[kind])} rows.",
            "",
            "| id | implemented by | test |",
            "|---|---|---|",
        ]
        for key in sorted(rows[kind], key=ordered):
            modules = ", ".join(dict.fromkeys(module for module, _ in rows[kind][key]))
            tests = ", ".join(dict.fromkeys(name for _, name in rows[kind][key]))
            lines.append(f"| {key} | {modules} | {tests} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}: {page().count(chr(10))} lines")
