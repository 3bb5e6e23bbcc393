"""The page of stability: all hard cases, all sweeps."""

from __future__ import annotations

import importlib.util
import tomllib
from types import ModuleType

import pytest
from support.paths import ROOT
from sweeps.all_sweeps import SWEEPS

from vectorplot.save import write


@pytest.fixture(scope="module")
def stability() -> ModuleType:
    spec = importlib.util.spec_from_file_location("stability_page", ROOT / "docs" / "stability.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_the_table_of_hard_cases_is_fresh(stability: ModuleType) -> None:
    page = stability.PAGE.read_text(encoding="utf-8")
    assert page.endswith(stability.hard_cases()), "run: python docs/stability.py"
    assert page.startswith(stability.INTRODUCTION)


@pytest.mark.slow
def test_every_hard_case_that_a_test_holds_is_told(stability: ModuleType) -> None:
    rooms = tomllib.loads((ROOT / "docs" / "hard_cases.toml").read_text(encoding="utf-8")).values()
    assert sorted(int(number) for room in rooms for number in room) == sorted(stability.proofs())


def test_every_sweep_has_its_plot_on_the_page(stability: ModuleType) -> None:
    page = stability.PAGE.read_text(encoding="utf-8")
    plots = [f"stability/{stability.slug(sweep.name)}.svg" for sweep in SWEEPS]
    assert all(f"]({plot})" in page and (ROOT / "docs" / plot).stat().st_size > 5000 for plot in plots)
    assert len(list((ROOT / "docs" / "stability").iterdir())) == len(plots)


def test_hard_cases_have_their_pictures(stability: ModuleType) -> None:
    page, folder = stability.PAGE.read_text(encoding="utf-8"), ROOT / "docs" / "hard_cases"
    stored = {path.name: path for path in folder.iterdir()}
    assert set(stored) == {f"{number}.svg" for number in stability.PICTURES}
    assert all(f"](hard_cases/{name})" in page and 800 < path.stat().st_size < 40_000 for name, path in stored.items())


@pytest.mark.parametrize("number", [7, 12, 21, 26, 71])
def test_pictures_of_hard_cases_are_fresh(stability: ModuleType, number: int) -> None:
    stored = (ROOT / "docs" / "hard_cases" / f"{number}.svg").read_bytes()
    assert write(stability.PICTURES[number].drawing(), "svg") == stored, "run: python docs/hard_case_pictures.py"
