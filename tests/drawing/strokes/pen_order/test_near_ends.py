import numpy as np
import pytest

from vectorplot.drawing.pen_order import curves_through, nearer_than, separation_test

COUNT = 2000
OPPOSITE = np.arange(COUNT) ^ 1


def ends():
    rng = np.random.default_rng(4)
    return rng.random(COUNT) + 1j * rng.random(COUNT), np.repeat([0, 1], COUNT // 2)


def near(reach):
    spots, layer = ends()
    one, other, apart = nearer_than(reach, separation_test(spots, OPPOSITE, layer, curves_through(spots, layer)))
    return {(int(a), int(b)): float(d) for a, b, d in zip(one, other, apart, strict=True)}


def test_pairs_are_near_of_one_layer_and_of_two_strokes():
    spots, layer = ends()
    found = near(np.full(COUNT, 0.02))
    assert found
    for (one, other), apart in found.items():
        assert apart < 0.02 and apart == pytest.approx(abs(spots[one] - spots[other]))
        assert one not in (other, other ^ 1) and layer[one] == layer[other]


def test_nearly_all_near_ends_are_found():
    spots, layer = ends()
    apart = np.abs(spots[:, None] - spots)
    near_ones = (apart < 0.02) & (layer[:, None] == layer) & (np.arange(COUNT)[:, None] >> 1 != np.arange(COUNT) >> 1)
    assert len(near(np.full(COUNT, 0.02))) > 0.9 * np.count_nonzero(near_ones)


@pytest.mark.parametrize("share", [2, 10])
def test_those_that_look_find_the_same_however_many_look(share):
    looks = np.arange(COUNT) % share == 0
    everybody, few = near(np.full(COUNT, 0.02)), near(np.where(looks, 0.02, 0.0))
    assert few == {pair: apart for pair, apart in everybody.items() if looks[pair[0]]}


def test_no_pair_is_found_twice_but_where_a_curve_closes():
    spots, layer = ends()
    one, other, _ = nearer_than(
        np.full(COUNT, 0.02), separation_test(spots, OPPOSITE, layer, curves_through(spots, layer))
    )
    assert len(set(zip(one.tolist(), other.tolist(), strict=True))) > len(one) - 10
