"""Drawings that several tests of the backends use."""

from __future__ import annotations

import numpy as np
import pytest
from support.backend_samples import drawing_of, paths_of

from vectorplot.drawing.drawing import Drawing, Paths


@pytest.fixture(scope="session")
def sample() -> Drawing:
    """A fan of lines, a closed star and a curve that leaves the page, on three layers."""
    angle = np.linspace(0.0, np.pi / 2, 12)
    fan = [[(10, 10), (10 + 90 * np.cos(a), 10 + 60 * np.sin(a))] for a in angle]
    turn = np.arange(5) * 4 * np.pi / 5
    star = np.column_stack((85 + 20 * np.sin(turn), 50 + 20 * np.cos(turn)))
    x = np.linspace(-20.0, 140.0, 200)
    wave = np.column_stack((x, 40 + 50 * np.sin(x / 9)))
    return drawing_of(
        paths_of(*fan), paths_of(star, closed=True), paths_of(wave, hidden_by=1), title="A sample (of lines)"
    )


@pytest.fixture(scope="session")
def empty() -> Drawing:
    return drawing_of(Paths.empty())
