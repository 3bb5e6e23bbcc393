"""The page of stability: all hard cases, all sweeps."""

from __future__ import annotations

import importlib.util
import tomllib
from types import ModuleType

import pytest
from support.paths import ROOT
from sweeps.all_sweeps import SWEEPS


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
