from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.drawing.strokes import NO_END, chains


@st.composite
def links(draw):
    """Ends of up to 20 strokes, some of them linked in pairs."""
    count = draw(st.integers(1, 20))
    order = draw(st.permutations(range(2 * count)))
    mate = np.full(2 * count, NO_END)
    for k in range(draw(st.integers(0, count))):
        a, b = order[2 * k], order[2 * k + 1]
        mate[a], mate[b] = b, a
    return mate


@given(links())
def test_chains_follow_the_links_and_hold_every_stroke_once(mate):
    result = chains(mate)
    assert sorted((result.entry >> 1).tolist()) == list(range(len(mate) // 2))
    for begin, end, cyclic in zip(result.offsets[:-1], result.offsets[1:], result.cyclic, strict=True):
        entry = result.entry[begin:end]
        for one, two in pairwise(entry):
            assert mate[one ^ 1] == two
        outside = mate[entry[-1] ^ 1], mate[entry[0]]
        assert outside == ((entry[0], entry[-1] ^ 1) if cyclic else (NO_END, NO_END))


def test_a_long_chain_and_a_long_ring_are_walked_whole():
    count = 10000
    order = np.random.default_rng(4).permutation(count)
    mate = np.full(2 * count, NO_END)
    mate[2 * order[:-1] + 1], mate[2 * order[1:]] = 2 * order[1:], 2 * order[:-1] + 1
    line = chains(mate)
    assert len(line.offsets) == 2 and not line.cyclic[0]
    assert np.array_equal(line.entry >> 1, order) or np.array_equal(line.entry >> 1, order[::-1])
    mate[2 * order[-1] + 1], mate[2 * order[0]] = 2 * order[0], 2 * order[-1] + 1
    ring = chains(mate)
    assert ring.cyclic.all() and len(ring.offsets) == 2
    np.testing.assert_array_equal(ring.entry >> 1, np.roll(order, -int(np.flatnonzero(order == 0)[0])))
