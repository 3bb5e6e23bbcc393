"""The bound of how far a cubic is off a rational curve holds, and is not much larger than the distance."""

import numpy as np
import pytest

from vectorplot.curves.bezier import HIGHEST, bernstein, cubic_error, places

MANY = np.linspace(0.0, 1.0, 2001)


def bound_and_truth(control, weights, degree):
    """For curves of control points (n+1,k,2) and weights (n+1,k), or None: the bounds (k,), and the distances (k,) of
    the cubics with their ends and derivatives."""
    rational = weights is not None
    w = np.ones(control.shape[:2]) if weights is None else weights

    def curve(t):
        basis = bernstein(degree, t)
        whole = basis @ w
        return np.einsum("tn,nkd->tkd", basis, control * w[:, :, None]) / whole[..., None], whole

    leaving = degree * (w[1] / w[0])[:, None] * (control[1] - control[0]) / 3.0
    arriving = degree * (w[-2] / w[-1])[:, None] * (control[-1] - control[-2]) / 3.0
    cubic = np.stack([control[0], control[0] + leaving, control[-1] - arriving, control[-1]])

    def off(t):
        return curve(t)[0] - np.einsum("tj,jkd->tkd", bernstein(3, t), cubic)

    share = places(degree, rational)
    around = curve(np.concatenate([[0.0], share, [1.0]]))[1] if rational else None
    return cubic_error(degree, off(share), around), np.linalg.norm(off(MANY), axis=2).max(axis=0)


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degree", [2, 3, 4, 5, 7])
def test_no_curve_is_farther_off_and_short_ones_hardly_less(degree, rational):
    random = np.random.default_rng(degree)
    control = random.normal(size=(degree + 1, 200, 2))
    weights = random.uniform(0.5, 2.0, (degree + 1, 200)) if rational else None
    bound, truth = bound_and_truth(control, weights, degree)
    assert (truth <= bound * (1.0 + 1e-9) + 1e-12).all()
    if degree <= 3 and not rational:
        assert not bound.any()
    elif degree == 4 and not rational:
        np.testing.assert_allclose(bound, truth, rtol=1e-5)
    else:
        assert np.median(bound / truth) < (30.0 if rational else 3.0)


def test_weights_that_vanish_and_high_degrees_have_no_bound():
    control = np.random.default_rng(1).normal(size=(3, 1, 2))
    bound, _ = bound_and_truth(control, np.array([[1.0], [-3.0], [1.0]]), 2)
    assert np.isinf(bound).all()
    assert np.isinf(cubic_error(HIGHEST + 1, np.zeros((HIGHEST - 2, 1, 2)), None)).all()
