"""The course: its figures are those of its pages, its exercises have solutions, and wrong answers are found out."""

import importlib.util
import re
import subprocess
import sys

import pytest
from course.solutions import RIGHT, WRONG
from support.paths import ROOT

DOCS = ROOT / "docs"


def module(path):
    spec = importlib.util.spec_from_file_location(f"of_{path.stem}", path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


FIGURES = module(DOCS / "course.py")
CHECK = module(DOCS / "course" / "check.py")


def verdict(number, name, answer):
    exercises = CHECK.chapter(number)
    setattr(exercises, name, answer)
    return dict(CHECK.verdicts(exercises))[name]


@pytest.mark.slow
@pytest.mark.parametrize("page", FIGURES.PAGES, ids=lambda page: page.stem)
def test_the_figures_of_a_page_are_those_that_its_python_draws(page):
    figures = FIGURES.figures_of(page)
    assert figures
    for name, content in figures.items():
        assert (FIGURES.FIGURES / name).read_bytes() == content, f"{name}: python docs/course.py {page.stem}"


def test_every_figure_is_shown():
    shown = {name for page in FIGURES.PAGES for name in re.findall(r"figures/(\w+\.svg)\)", page.read_text("utf-8"))}
    assert {path.name for path in FIGURES.FIGURES.glob("*")} == shown


def test_every_chapter_has_three_exercises_which_its_page_names():
    for number, page in enumerate(FIGURES.PAGES[:8], start=1):
        names = [name for name, _ in CHECK.verdicts(CHECK.chapter(number))]
        assert names == [answer.__name__ for answer in RIGHT[number]] and len(names) == 3
        assert re.findall(r"^\d\. `(\w+)`:", page.read_text("utf-8"), re.MULTILINE) == names


@pytest.mark.slow
@pytest.mark.parametrize("number, answer", [(n, answer) for n in RIGHT for answer in RIGHT[n]])
def test_solutions_are_right(number, answer):
    assert verdict(number, answer.__name__, answer) == "right"


@pytest.mark.slow
@pytest.mark.parametrize("number, name, answer, reason", WRONG, ids=lambda value: getattr(value, "__name__", None))
def test_wrong_answers_are_found_out(number, name, answer, reason):
    said = verdict(number, name, answer)
    assert said.startswith("wrong: ") and re.search(reason, said), said


def test_every_exercise_has_a_wrong_answer_too():
    assert {(number, name) for number, name, *_ in WRONG} == {
        (n, answer.__name__) for n in RIGHT for answer in RIGHT[n]
    }


def test_what_is_not_filled_in_is_not_done_yet():
    command = [sys.executable, str(DOCS / "course" / "check.py"), "3"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and done.stderr == ""
    assert done.stdout.splitlines() == [f"chapter 3, {answer.__name__}: not done yet" for answer in RIGHT[3]]
