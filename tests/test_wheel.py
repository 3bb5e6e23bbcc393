"""What is installed elsewhere is whole: a wheel holds every file of the package, and works without the checkout."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest
from support.paths import ROOT

SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def package_files():
    """The files of the package, as paths in the checkout."""
    return [
        path.relative_to(ROOT)
        for path in sorted((ROOT / "vectorplot").rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    ]


def goes_into_wheels(path: Path) -> bool:
    """By setuptools' rules: a module whose folders are all packages, or a file declared as data of the package."""
    if not all((ROOT / folder / "__init__.py").is_file() for folder in path.parents if folder.parts):
        return False
    declared = SETTINGS["tool"]["setuptools"]["package-data"].get("vectorplot", [])
    return path.suffix == ".py" or any(fnmatch(path.relative_to("vectorplot").as_posix(), one) for one in declared)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A folder with what a wheel brings, compiled as far as the checkout is, and nothing else of it."""
    place = tmp_path_factory.mktemp("installed")
    for path in filter(goes_into_wheels, package_files()):
        compiled = Path(importlib.util.cache_from_source(str(path)))
        (place / compiled).parent.mkdir(parents=True, exist_ok=True)
        for file in filter(Path.is_file, (ROOT / path, ROOT / compiled)):
            # With its time, by which Python tells whether what is compiled is of this source.
            shutil.copy2(file, place / file.relative_to(ROOT))
    return place


def run(installed, folder, *words):
    """Python in a folder far from the checkout, with the installed files on its path."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["PYTHONPATH"] = str(installed)
    command = [sys.executable, "-W", "error", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=60)


@pytest.mark.slow
def test_a_wheel_holds_every_file_of_the_package():
    assert [str(path) for path in package_files() if not goes_into_wheels(path)] == []
    assert Path("vectorplot/py.typed") in package_files()
    assert SETTINGS["tool"]["setuptools"]["packages"]["find"]["include"] == ["vectorplot*"]


WORDS = [
    ["draw", "table.scene", "-o", "table.svg"],
    ["paint", "table.scene", "-o", "table.pdf"],
    ["render", "table.scene", "-o", "table.png", "--size", "40x30"],
    ["info", "table.scene"],
]

WORK = (
    "import importlib, pkgutil, vectorplot as vp, vectorplot.testing as testing\n"
    "from vectorplot.cli.main import run\n"
    f"print(*(run(words) for words in {WORDS}))\n"
    "print(vp.__file__)\n"
    "[getattr(vp, name) for name in vp.__all__], [getattr(testing, name) for name in testing.__all__]\n"
    "names = [found.name for found in pkgutil.walk_packages(vp.__path__, 'vectorplot.')]\n"
    "[importlib.import_module(name) for name in names if not name.endswith('__main__')]\n"
)
"""The command, several times, and then every module: in one process, as to begin takes longer than to draw."""


@pytest.fixture(scope="module")
def worked(installed, tmp_path_factory):
    """A folder in which the installed files have done this work, and the process."""
    folder = tmp_path_factory.mktemp("worked") / "a folder"
    folder.mkdir()
    shutil.copy(ROOT / "data" / "table.scene", folder / "table.scene")
    return folder, run(installed, folder, "-c", WORK)


@pytest.mark.slow
def test_the_installed_command_works_in_any_folder(installed, worked):
    folder, result = worked
    assert result.stderr == "" and result.stdout.splitlines()[-2] == "0 0 0 0"
    assert all((folder / each[3]).stat().st_size > 100 for each in WORDS[:3])
    told = run(installed, folder, "-m", "vectorplot", "--help")
    assert (told.returncode, told.stderr) == (0, "") and "Usage:" in told.stdout


@pytest.mark.slow
def test_every_installed_module_is_found_and_imported(installed, worked):
    _, result = worked
    assert (result.returncode, result.stderr) == (0, "")
    assert Path(result.stdout.splitlines()[-1]).is_relative_to(installed)


def test_the_entry_point_leads_to_the_command():
    module, _, name = SETTINGS["project"]["scripts"]["vectorplot"].partition(":")
    assert importlib.util.find_spec(module) is not None
    assert callable(getattr(importlib.import_module(module), name))
