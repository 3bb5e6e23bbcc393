import numpy as np

from vectorplot.drawing.pen_order import curves_through, mutual_nearest

COUNT = 500


def ends():
    rng = np.random.default_rng(5)
    return rng.random(COUNT) + 1j * rng.random(COUNT), np.repeat([0, 3], COUNT // 2)


def code(x, y):
    """Of two coordinates below 2 the bits of sixteen digits each, alternating."""
    digits = [(int(x * 2**15) >> k & 1, int(y * 2**15) >> k & 1) for k in range(16)]
    return sum(a << 2 * k | b << 2 * k + 1 for k, (a, b) in enumerate(digits))


def test_curves_go_through_one_layer_after_the_other_cell_by_cell():
    spots, layer = ends()
    unit = (spots - complex(spots.real.min(), spots.imag.min())) / max(np.ptp(spots.real), np.ptp(spots.imag))
    for curve, shift in zip(curves_through(spots, layer), (0.0, (1 + 1j) / 3, (2 + 2j) / 3), strict=True):
        moved = unit + shift
        keys = [(int(layer[k]), code(moved[k].real, moved[k].imag), k) for k in range(COUNT)]
        assert curve.tolist() == [key[2] for key in sorted(keys)]


def test_ends_are_joined_that_are_each_others_nearest_nearly_everywhere():
    spots, layer = ends()
    other = np.arange(COUNT) ^ 1
    mate, apart = mutual_nearest(spots, other, layer, curves_through(spots, layer))
    joined = np.flatnonzero(mate >= 0)
    assert (mate[mate[joined]] == joined).all() and (layer[mate[joined]] == layer[joined]).all()
    assert (mate[joined] != other[joined]).all()
    np.testing.assert_allclose(apart[joined], np.abs(spots[joined] - spots[mate[joined]]), rtol=1e-15)
    every = np.where(layer[:, None] == layer, np.abs(spots[:, None] - spots), np.inf)
    every[np.arange(COUNT), np.arange(COUNT)] = every[np.arange(COUNT), other] = np.inf
    nearest = every.argmin(axis=1)
    right = np.flatnonzero(nearest[nearest] == np.arange(COUNT))
    assert np.count_nonzero(mate[right] == nearest[right]) > 0.97 * len(right)


def test_ends_that_are_all_as_far_apart_are_joined_in_pairs():
    spots, layer = np.arange(400) + 0j, np.zeros(400, dtype=np.intp)
    mate, _ = mutual_nearest(spots, np.arange(400), layer, curves_through(spots, layer))
    joined = np.flatnonzero(mate >= 0)
    assert len(joined) and (mate[mate[joined]] == joined).all()
