"""What is installed elsewhere is whole: the wheel of the source distribution works without the checkout."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from support.paths import DATA, ROOT

SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))

BUILD = "import sys, setuptools.build_meta as backend\nprint(getattr(backend, sys.argv[1])(sys.argv[2]))\n"
"""What pip and other installers ask of the project, in its folder."""


def files_in(folder):
    """The files of a folder of the checkout that are its own, by their places in that folder."""
    paths = (path.relative_to(folder) for path in sorted(folder.rglob("*")) if path.is_file())
    return [path.as_posix() for path in paths if "__pycache__" not in path.parts]


def built(kind, folder, place):
    """The file that the project in a folder is built as, put into a place."""
    command = [sys.executable, "-c", BUILD, kind, str(place)]
    told = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)
    assert told.returncode == 0, told.stderr
    return place / told.stdout.splitlines()[-1]


@pytest.fixture(scope="module")
def source_distribution(tmp_path_factory):
    """The source distribution, of a copy of the checkout: builders leave things behind."""
    copy = tmp_path_factory.mktemp("checkout")
    for name in ("vectorplot", "data", "docs/course"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "MANIFEST.in", "README.md", "CHANGELOG.md", "LICENSE"):
        shutil.copy(ROOT / name, copy)
    return built("build_sdist", copy, tmp_path_factory.mktemp("sdist"))


@pytest.fixture(scope="module")
def wheel(source_distribution, tmp_path_factory):
    """The wheel that is built of the source distribution."""
    folder = tmp_path_factory.mktemp("unpacked")
    subprocess.run([sys.executable, "-m", "tarfile", "-e", source_distribution, folder], check=True)
    (unpacked,) = folder.iterdir()
    return built("build_wheel", unpacked, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """A folder with what the wheel brings, compiled as far as the checkout is, and nothing else."""
    place = tmp_path_factory.mktemp("installed")
    words = ["install", "--quiet", "--no-deps", "--no-index", "--no-compile", "--disable-pip-version-check"]
    subprocess.run([sys.executable, "-m", "pip", *words, "--target", place, wheel], check=True, timeout=600)
    for source in (ROOT / "vectorplot").rglob("*.py"):
        compiled = Path(importlib.util.cache_from_source(str(source)))
        if compiled.is_file():
            copy = place / compiled.relative_to(ROOT)
            copy.parent.mkdir(exist_ok=True)
            shutil.copy2(compiled, copy)
            # By its time Python tells whether what is compiled is of this source.
            shutil.copystat(source, place / source.relative_to(ROOT))
    return place


def run(installed, folder, *words):
    """Python in a folder far from the checkout, with the installed files on its path."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["PYTHONPATH"] = str(installed)
    command = [sys.executable, "-W", "error", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)


@pytest.mark.slow
def test_a_wheel_holds_every_file_of_the_package_and_the_samples(wheel):
    """A room that pyproject.toml does not list would be missing."""
    expected = {f"vectorplot/{name}" for name in files_in(ROOT / "vectorplot")}
    expected |= {f"vectorplot/samples/{name}" for name in files_in(DATA)}
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert held == expected and "vectorplot/py.typed" in held and "vectorplot/samples/pencil.scene" in held


@pytest.mark.slow
def test_a_source_distribution_holds_the_course(source_distribution):
    with tarfile.open(source_distribution) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    assert held >= {f"docs/course/{name}" for name in files_in(ROOT / "docs" / "course")}
    assert {"data/Learn.1", "CHANGELOG.md", "LICENSE"} <= held


@pytest.mark.slow
def test_the_metadata_say_whose_it_is_and_what_it_needs(installed):
    (folder,) = installed.glob("*.dist-info")
    found = importlib.metadata.Distribution.at(folder)
    told = found.metadata
    assert (told["Name"], told["License-Expression"]) == ("vectorplot3d", "MIT")
    assert told["Author"] == "The vectorplot authors" and "pen plotter" in told["Keywords"]
    assert "Programming Language :: Python :: 3.11" in told.get_all("Classifier")
    assert set(told.get_all("Provides-Extra")) == set(SETTINGS["project"]["optional-dependencies"])
    always = {line for line in found.requires if "extra ==" not in line}
    assert always == {line.replace(" ", "") for line in SETTINGS["project"]["dependencies"]}
    assert not [line for line in always if line.startswith(("pycairo", "vectorplot"))]
    assert "What it stands on" in told.get_payload()


WORDS = [
    ["draw", "pencil", "-o", "pencil.svg"],
    ["paint", "TORUS", "-o", "torus.pdf"],
    ["render", "data/town.scene", "-o", "town.png", "--size", "40x30"],
    ["animate", "cubes", "-a", "CUBES", "-o", "cubes.svg", "--frames", "2"],
    ["replay", "Pencil.vd1", "-o", "again.svg"],
    ["sheet", "flange.stl", "-o", "flange.dxf"],
    ["info", "learn.1"],
    ["info", "table.scene"],
]
"""Names of samples, and of a file in the folder that is called like one."""

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
    (folder / "table.scene").write_text("DIE red box 1 1 1", encoding="utf-8")
    return folder, run(installed, folder, "-c", WORK)


@pytest.mark.slow
def test_the_installed_command_finds_the_samples_in_any_folder(installed, worked):
    folder, result = worked
    assert result.stderr == "" and result.stdout.splitlines()[-2] == "0 0 0 0 0 0 0 0"
    assert all((folder / words[words.index("-o") + 1]).stat().st_size > 100 for words in WORDS if "-o" in words)
    assert "DIE: 8 vertices" in result.stdout, "what lies in the folder comes first"
    told = run(installed, folder, str(installed / "bin" / "vectorplot"), "--help")
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
