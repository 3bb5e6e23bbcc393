"""The course: its figures are those of its pages, its exercises have solutions, and wrong answers are found out."""

import importlib.util
import re
import subprocess
import sys

import numpy as np
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


def changed(stem, old, new):
    """What the first block of a page leaves, with one of its numbers changed, as the page asks its readers to."""
    (page,) = (page for page in FIGURES.PAGES if page.stem == stem)
    block = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), flags=re.DOTALL)[0]
    assert old in block
    names = {}
    exec(compile(block.replace(old, new), page.name, "exec"), names)
    return names


def test_a_line_moved_before_the_triangle_pierces_it_as_the_page_says():
    found = changed("2-hidden-line", "p, q = np.array([-2.0, 4.0, 0.0])", "p, q = np.array([-2.0, -1.0, 0.0])")
    (piece,) = np.flatnonzero(found["is_hidden"])
    begin = found["p"] + found["t"][piece] * (found["q"] - found["p"])
    assert abs(found["heights"](begin)[3]) < 1e-12, "on the plane of the triangle"
    found = changed("2-hidden-line", "p, q = np.array([-2.0, 4.0, 0.0])", "p, q = np.array([-2.0, -2.0, 0.0])")
    assert not found["is_hidden"].any()


def test_a_line_that_no_plate_hides_is_one_gap():
    found = changed("3-zone", "np.array([-7.0, 4.0, -0.6])", "np.array([-7.0, 4.0, 60.0])")
    assert found["gaps"]([]).tolist() == [[0.0, 1.0]]


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


def test_a_chapter_that_there_is_not_is_said():
    command = [sys.executable, str(DOCS / "course" / "check.py"), "nine"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 1 and done.stderr == "no chapter nine: expected 1 to 8\n"


def test_what_is_not_filled_in_is_not_done_yet():
    command = [sys.executable, str(DOCS / "course" / "check.py"), "3"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 1 and done.stderr == ""
    assert done.stdout.splitlines() == [f"chapter 3, {answer.__name__}: not done yet" for answer in RIGHT[3]]
