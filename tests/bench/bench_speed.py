"""What is not time: how pictures grow, what they cost in bare work of the same run, and their memory.

Run with ``pytest tests/bench/bench_speed.py -s``. Limits are about twice what is measured, growth a fifth more than it:
noise of a busy machine passes, an engine that looks at all pairs, or is half as fast again and again, does not.
"""

from __future__ import annotations

import pytest

from vectorplot.speed.measure import SERIES, measured, on_threads
from vectorplot.speed.results import point_cost

pytestmark = pytest.mark.bench

LIMITS = {
    "boxes": (1.15, 1000, 300, 6),
    "boxes, a layer each": (1.15, 1500, 100, 0.8),
    "bars": (1.15, 8000, 400, 17),
    "weave": (1.15, 600, 700, 27),
    "one mesh": (1.15, 6, 200, 0.1),
    "hatched mesh": (1.15, 130, 400, 0.1),
    "spheres": (1.2, 1800, 200, 1.2),
    "tori": (2.0, 4e6, 200, 1),
    "boxes in colour": (1.2, 4000, 100, 0.7),
    "balls in colour": (1.15, 120000, 300, 16),
    "molecule in colour": (1.15, 110000, 400, 22),
    "tori in colour": (1.15, 1e7, 500, 28),
    "rough mesh in colour": (1.15, 500, 250, 16),
    "terrain in colour": (1.15, 650, 200, 21),
    "pixels of one mesh": (1.15, 45, 300, 1),
    "pixels of spheres": (1.15, 2200, 150, 1),
    "pixels of a molecule": (1.15, 15000, 250, 1),
}
"""Growth exponent, points projected and sorted for each thing, megabytes of memory, and of the file."""


@pytest.mark.parametrize("series", SERIES, ids=lambda series: series.name)
def test_growth_cost_and_memory(series) -> None:
    growth, points, memory, size = LIMITS[series.name]
    found, point = measured(series), point_cost()
    print(
        f"\n{series.name}: growth {found.exponent:.2f}, {found.points(point):.1f} points, {found.memory_mb:.0f} MB",
        end="",
    )
    print(f", file {found.file_mb:.2f} MB")
    assert found.exponent < growth
    assert found.points(point) < points
    assert found.memory_mb < memory
    assert found.file_mb < size


def test_every_picture_has_its_limits() -> None:
    assert set(LIMITS) == {series.name for series in SERIES}


def test_two_threads_take_no_longer_than_one() -> None:
    (mesh,) = (series for series in SERIES if series.name == "one mesh")
    found = on_threads(mesh, 2)
    print(f"\none thread {found.one:.3f} s, two {found.several:.3f} s")
    assert found.several < 1.2 * found.one
