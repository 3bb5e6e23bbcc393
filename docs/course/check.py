"""Says which exercises of a chapter are right: ``python docs/course/check.py 3``; without a number, of all chapters."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

EXERCISES = Path(__file__).resolve().parent / "exercises"


def chapter(number: int | str) -> ModuleType:
    """The exercises of a chapter, as they stand in the file."""
    path = EXERCISES / f"chapter_{number}.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None or not path.exists():
        raise SystemExit(f"no chapter {number}: expected 1 to 8")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def verdicts(module: ModuleType) -> Iterator[tuple[str, str]]:
    """The name of each exercise, and ``right``, ``not done yet`` or what is wrong."""
    for name in [name.removeprefix("check_") for name in vars(module) if name.startswith("check_")]:
        try:
            vars(module)[f"check_{name}"](vars(module)[name])
        except NotImplementedError:
            yield name, "not done yet"
        except Exception as error:
            yield name, f"wrong: {error or type(error).__name__}"
        else:
            yield name, "right"


def main() -> int:
    """Print what is said of the chapters that are named; 1 unless all of it is right."""
    numbers = sys.argv[1:] or range(1, 9)
    found = [(number, *verdict) for number in numbers for verdict in verdicts(chapter(number))]
    for number, name, verdict in found:
        print(f"chapter {number}, {name}: {verdict}")
    return int(any(verdict != "right" for _, _, verdict in found))


if __name__ == "__main__":
    sys.exit(main())
