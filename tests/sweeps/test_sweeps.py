"""Every sweep through a degeneracy: the answer is right at each distance from it, and changes where the truth does."""

from __future__ import annotations

import numpy as np
import pytest
from support.effort import several
from sweeps.all_sweeps import SWEEPS
from sweeps.sweep import Sweep

FEW = several(2, long=4)
"""Values of each sweep that are tried with the other tests; docs/stability.py tries all."""


def few_values(sweep: Sweep) -> list[float]:
    """Values all over a sweep, and those next to its limit."""
    values = np.asarray(sweep.values)
    some = set(values[np.linspace(0, len(values) - 1, FEW).astype(int)].tolist())
    if sweep.limit is not None:
        nearest = values[np.argsort(np.abs(np.log(values / sweep.limit[0])))[:2]]
        some |= set(nearest.tolist())
    return sorted(some)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
@pytest.mark.parametrize("sweep", SWEEPS, ids=[sweep.name for sweep in SWEEPS])
def test_the_answer_changes_only_where_the_truth_does(sweep: Sweep) -> None:
    errors = {value: sweep.error(value) for value in few_values(sweep)}
    wrong = {value: error for value, error in errors.items() if not error <= sweep.room(value)}
    assert not wrong, f"{sweep.answer} over {sweep.knob}: {wrong}"


def test_names_of_sweeps_differ() -> None:
    assert len({sweep.name for sweep in SWEEPS}) == len(SWEEPS)
