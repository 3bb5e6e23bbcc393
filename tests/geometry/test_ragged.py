"""Groups of different lengths against lists of lists."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.geometry import component_arrays as columns
from vectorplot.geometry import ragged, vectors

SIZES = st.lists(st.integers(0, 5), max_size=12)


def groups(offsets):
    """The numbers of the elements, group by group."""
    return [list(range(low, high)) for low, high in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True)]


@given(SIZES)
def test_offsets_starts_owner_and_place(sizes):
    offsets = ragged.offsets(sizes)
    assert offsets.dtype == np.intp and [len(group) for group in groups(offsets)] == sizes
    assert ragged.starts(sizes).tolist() == offsets[:-1].tolist()
    assert ragged.owner(sizes).tolist() == [k for k, size in enumerate(sizes) for _ in range(size)]
    assert ragged.place(np.array(sizes, dtype=np.intp)).tolist() == [k for size in sizes for k in range(size)]


def test_offsets_of_a_mask_count_what_is_kept():
    assert ragged.offsets(np.array([True, False, True])).tolist() == [0, 1, 1, 2]


@given(SIZES, st.data())
def test_ranges_and_take(sizes, data):
    offsets = ragged.offsets(sizes)
    which = data.draw(st.lists(st.integers(0, len(sizes) - 1), max_size=8)) if sizes else []
    index = np.array(which, dtype=np.intp)
    position, ends = ragged.take(offsets, index)
    assert [position[a:b].tolist() for a, b in pairwise(ends)] == [groups(offsets)[k] for k in which]
    mask = np.isin(np.arange(len(sizes)), index)
    assert ragged.take(offsets, mask)[0].tolist() == ragged.take(offsets, np.flatnonzero(mask))[0].tolist()
    first, count = offsets[:-1][index], np.diff(offsets)[index]
    assert ragged.ranges(first, count).tolist() == position.tolist()


@given(SIZES)
def test_following_and_preceding_go_round_in_every_group(sizes):
    offsets = ragged.offsets(sizes)
    after = [group[(k + 1) % len(group)] for group in groups(offsets) for k in range(len(group))]
    assert ragged.following(offsets).tolist() == after
    assert ragged.preceding(offsets)[ragged.following(offsets)].tolist() == list(range(sum(sizes)))


@given(SIZES)
def test_fans_have_two_triangles_less_than_corners(sizes):
    offsets = ragged.offsets(sizes)
    triangles, owner = ragged.fans(offsets)
    expected = [
        ((group[0], group[k], group[k + 1]), number)
        for number, group in enumerate(groups(offsets))
        for k in range(1, len(group) - 1)
    ]
    assert list(zip(map(tuple, triangles.tolist()), owner.tolist(), strict=True)) == expected


def test_products_by_component_are_those_by_row():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(2, 3, 40))
    assert np.allclose(columns.dot(a, b), vectors.dot(a.T, b.T), rtol=1e-15, atol=1e-15)
    assert np.array_equal(columns.cross(a, b).T, vectors.cross(a.T, b.T))
    assert np.array_equal(columns.cross(a[:, 0], b), columns.cross(np.repeat(a[:, :1], 40, axis=1), b))


@given(SIZES, st.integers(1, 9))
def test_batches_follow_each_other_and_exceed_the_size_by_one_group_at_the_most(sizes, most):
    runs = list(ragged.batches(sizes, most))
    assert [k for low, high in runs for k in range(low, high)] == list(range(len(sizes)))
    assert all(low < high and sum(sizes[low : high - 1]) < most + 5 for low, high in runs)
