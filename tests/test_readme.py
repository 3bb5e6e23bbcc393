"""The README's commands and snippets are what the project has, and the pages written by programs are fresh."""

from __future__ import annotations

import importlib.util
import re
import shlex
import shutil
import stat
from pathlib import Path

import pytest
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.main import run

README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", README, flags=re.DOTALL)


def shell_blocks():
    return [text.strip() for language, text in BLOCKS if language == "sh"]


def test_the_readme_starts_with_a_picture_and_two_commands():
    picture = re.match(r"!\[[^\]]+\]\(([^)]+)\)", README)
    assert picture is not None
    assert (ROOT / picture.group(1)).is_file()
    assert shell_blocks()[0] == "sh setup.sh && .venv/bin/vectorplot draw data/pencil.scene -o pencil.svg"
    assert shell_blocks()[1] == "sh setup.sh test"


def test_ci_runs_the_test_command_of_the_readme():
    run = ROOT / ".ci" / "run"
    assert shell_blocks()[1] in run.read_text(encoding="utf-8")
    assert run.stat().st_mode & stat.S_IXUSR


def test_the_links_of_the_readme_and_the_docs_lead_somewhere():
    for page in (ROOT / "README.md", ROOT / "docs" / "index.md"):
        for target in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_python_of_the_readme_runs(tmp_path, monkeypatch):
    shutil.copytree(ROOT / "data", tmp_path / "data")
    monkeypatch.chdir(tmp_path)
    (code,) = (text for language, text in BLOCKS if language == "python")
    exec(compile(code, "README.md", "exec"), {})
    assert (tmp_path / "crate.pdf").read_bytes().startswith(b"%PDF")


def test_the_drawing_of_the_readme_is_the_picture_beside_it():
    text = next(text for language, text in BLOCKS if language == "text" and "page A5" in text)
    assert (ROOT / "data" / "house.scene").read_text(encoding="utf-8").endswith(text)
    commands = next(block for block in shell_blocks() if "mine.scene" in block).splitlines()
    assert commands[0] == ". .venv/bin/activate" and all(line.startswith("vectorplot ") for line in commands[1:])


def test_the_certificate_of_the_readme_is_checked_as_it_says(tmp_path, monkeypatch):
    scene = next(text for language, text in BLOCKS if language == "text" and "page A5" in text)
    commands = next(block for block in shell_blocks() if "--certificate" in block).splitlines()[1:]
    draw, check = (shlex.split(command) for command in commands)
    assert draw[:1] == ["vectorplot"] and check[:2] == ["python", "-m"]
    main = importlib.import_module(check[2]).main
    monkeypatch.chdir(tmp_path)
    Path("mine.scene").write_text(scene, encoding="utf-8")
    assert run(draw[1:]) == 0
    assert main(check[3:]) == 0


def test_the_stages_of_the_readme_are_those_of_its_pictures():
    (text,) = (text for language, text in BLOCKS if language == "text" and "--explain" in text)
    head, *rows = text.splitlines()
    middle = head.rindex("$")
    for start, end in ((0, middle), (middle, None)):
        words = head[start:end].split()
        reports = []
        getattr(vp, words[2])(ROOT / words[3], explain=reports.append)
        told = {report.name: report.why for report in reports}
        shown = [row[start:end] for row in rows if row[start:end].strip()]
        names = [re.split(r"  +", row)[0] for row in shown]
        assert names == [
            name for name in dict.fromkeys(report.name for report in reports) if name not in {"look", "faces"}
        ]
        assert all(re.split(r"  +", row.rstrip())[1] in told[name] for name, row in zip(names, shown, strict=True))


def test_every_dependency_is_in_the_readme():
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = [name for extra in project["optional-dependencies"].values() for name in extra]
    for requirement in (*project["dependencies"], *extras):
        assert re.split(r"[<>=[]", requirement)[0] in README, requirement


@pytest.mark.slow
def test_the_page_of_coverage_is_fresh():
    spec = importlib.util.spec_from_file_location("coverage_page", ROOT / "docs" / "coverage.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.PAGE.read_text(encoding="utf-8") == module.page(), "run: python docs/coverage.py"
