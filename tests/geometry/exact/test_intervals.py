import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.geometry.intervals import complement, coverage, union

NO_GAP = np.zeros(1)


def one_owner(zones: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    low, high = np.array(zones).reshape(-1, 2).T
    return np.zeros(len(low), dtype=np.intp), low, high


@pytest.mark.capability("G7.2-visible")
def test_visible_intervals_of_the_test_values() -> None:
    zones = union(*one_owner([(0.5, 0.7), (0.1, 0.3), (0.25, 0.55), (0.8, 1.0)]), NO_GAP)
    _, low, high = complement(1, *zones, NO_GAP)
    assert np.allclose(np.column_stack([low, high]), [[0.0, 0.1], [0.7, 0.8]], atol=1e-15)


@pytest.mark.capability("G7.2-visible")
def test_two_zones_leave_three_intervals() -> None:
    _, low, high = complement(1, *union(*one_owner([(0.2, 0.3), (0.6, 0.7)]), NO_GAP), NO_GAP)
    assert np.column_stack([low, high]).tolist() == [[0.0, 0.2], [0.3, 0.6], [0.7, 1.0]]


@pytest.mark.capability("G7.2-zones")
def test_a_whole_zone_leaves_nothing_and_no_zone_leaves_all() -> None:
    assert len(complement(1, *union(*one_owner([(0.0, 1.0)]), NO_GAP), NO_GAP)[0]) == 0
    owner, low, high = complement(2, *union(*one_owner([(0.0, 1.0)]), np.zeros(2)), np.zeros(2))
    assert owner.tolist() == [1] and low.tolist() == [0.0] and high.tolist() == [1.0]


ZONES = st.lists(st.tuples(st.integers(0, 3), st.integers(0, 64), st.integers(0, 64)), max_size=20)


@pytest.mark.capability("G7.2-visible")
@given(ZONES)
def test_every_point_is_in_the_union_or_the_complement(raw: list[tuple[int, int, int]]) -> None:
    owner = np.array([zone[0] for zone in raw], dtype=np.intp)
    ends = np.sort(np.array([zone[1:] for zone in raw]).reshape(-1, 2), axis=1) / 64.0
    gap = np.zeros(4)
    hidden = union(owner, ends[:, 0], ends[:, 1], gap)
    free = complement(4, *hidden, gap)
    at = (np.arange(64) + 0.5) / 64.0
    for who in range(4):
        covered = ((ends[owner == who, 0][:, None] < at) & (ends[owner == who, 1][:, None] > at)).any(axis=0)
        for (of, low, high), expected in ((hidden, covered), (free, ~covered)):
            inside = ((low[of == who][:, None] < at) & (high[of == who][:, None] > at)).sum(axis=0)
            assert (inside == expected).all()


@given(ZONES, st.lists(st.sampled_from([-1, 0, 1]), min_size=20, max_size=20))
def test_coverage_counts_the_weaker_side(raw: list[tuple[int, int, int]], sides: list[int]) -> None:
    owner = np.array([zone[0] for zone in raw], dtype=np.intp)
    ends = np.sort(np.array([zone[1:] for zone in raw]).reshape(-1, 2), axis=1) / 64.0
    side = np.array(sides[: len(raw)], dtype=np.intp)
    of, low, high, count = coverage(owner, ends[:, 0], ends[:, 1], side)
    at = (np.arange(64) + 0.5) / 64.0
    for who in range(4):
        within = (ends[:, 0][:, None] < at) & (ends[:, 1][:, None] > at) & (owner == who)[:, None]
        left, right = within[side != -1].sum(axis=0), within[side != 1].sum(axis=0)
        mine = (((low[:, None] < at) & (high[:, None] > at) & (of == who)[:, None]) * count[:, None]).sum(axis=0)
        assert np.array_equal(mine, np.minimum(left, right))


def test_zones_closer_than_the_gap_are_one() -> None:
    zones = one_owner([(0.1, 0.2), (0.2 + 1e-9, 0.3)])
    assert len(union(*zones, np.array([1e-8]))[0]) == 1
    assert len(union(*zones, np.array([1e-10]))[0]) == 2


def test_a_gap_as_long_as_its_owner_does_not_reach_the_next_one() -> None:
    owner, low, high = np.array([0, 1, 1]), np.array([0.0, 0.0, 0.75]), np.array([1.0, 0.25, 1.0])
    found = union(owner, low, high, np.array([1.0, 0.0]))
    assert found[0].tolist() == [0, 1, 1]
    assert found[1].tolist() == [0.0, 0.0, 0.75]
    assert found[2].tolist() == [1.0, 0.25, 1.0]


def test_places_below_zero_by_rounding_are_at_the_beginning():
    owner, low, high = union(np.array([0, 0, 1]), np.array([0.5, -1e-9, 0.0]), np.array([0.6, 0.2, 1.0]), np.zeros(2))
    assert owner.tolist() == [0, 0, 1]
    assert (low.tolist(), high.tolist()) == ([-1e-9, 0.5, 0.0], [0.2, 0.6, 1.0])


@pytest.mark.slow
def test_no_owner_of_millions_is_forgotten():
    count = (1 << 22) + 5
    quarter = np.full(count, 0.25)
    owner, low, high = union(np.arange(count), quarter, 2.0 * quarter, np.zeros(count))
    assert np.array_equal(owner, np.arange(count))
    assert (low == 0.25).all() and (high == 0.5).all()
