"""Exercises of chapter 8, a film.

Fill in the functions; ``python docs/course/check.py 8`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import Akima1DInterpolator

import vectorplot as vp


def frame_times(frames: int, loop: bool) -> np.ndarray:
    """(frames,) the time of each frame, 0 for the first; in a loop the first one follows the last one.

    A single frame is at 0.
    """
    raise NotImplementedError


def between_keys(times: np.ndarray, values: np.ndarray, t: np.ndarray, closed: bool) -> np.ndarray:
    """(n,) values at times t (n,), straight from key to key; keys (k,) with ascending times from 0 to 1.

    Before the first key and behind the last one the value stays. If it is closed, the first key follows the last one,
    one unit of time after its own time, and the value runs on to it.
    """
    raise NotImplementedError


def akima(times: np.ndarray, values: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(n,) values at times t (n,) within the keys, smooth, by Akima's rule; five or more keys (k,).

    The chords between keys have the slopes m[0] ... m[k-2]. Two more are put at either end: m[-1] = 2 m[0] - m[1],
    m[-2] = 2 m[-1] - m[0], likewise on the right. The slope at key i is (w1 m[i-1] + w2 m[i]) / (w1 + w2) with
    w1 = |m[i+1] - m[i]| and w2 = |m[i-1] - m[i-2]|; where both are 0, the mean of m[i-1] and m[i]. Between two keys
    runs the cubic with these values and slopes.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_frame_times(answer: Callable[..., np.ndarray]) -> None:
    """Against a film of the package."""
    for frames in (1, 2, 5, 24):
        for loop in (False, True):
            motion = vp.Animation(lambda time: vp.Scene(()), frames=frames, loop=loop)
            expected = [motion.time(k) for k in range(frames)]
            found = np.asarray(answer(frames, loop), dtype=float)
            assert found.shape == (frames,), f"expected an array ({frames},), found {found.shape}"
            assert np.allclose(found, expected), f"{frames} frames, loop={loop}: expected {expected}"


def check_between_keys(answer: Callable[..., np.ndarray]) -> None:
    """Against the definition, key by key."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        times, values = np.sort(rng.uniform(0, 1, 5)), rng.normal(size=5)
        t = np.sort(np.r_[rng.uniform(0, 1, 40), times, 0.0, 1.0])
        expected = np.interp(t, times, values)
        assert np.allclose(answer(times, values, t, False), expected), "open: the value stays outside the keys"
        ahead = (t >= times[-1]) | (t < times[0])
        part = np.mod(t - times[-1], 1.0) / (1.0 - times[-1] + times[0])
        expected = np.where(ahead, values[-1] + part * (values[0] - values[-1]), expected)
        assert np.allclose(answer(times, values, t, True), expected), "closed: from the last key on to the first"


def check_akima(answer: Callable[..., np.ndarray]) -> None:
    """Against scipy, and where something stands still."""
    rng = np.random.default_rng(3)
    for k in (5, 8, 12):
        times, values = np.sort(rng.uniform(0, 1, k)), rng.normal(size=k)
        t = np.linspace(times[0], times[-1], 60)
        expected = Akima1DInterpolator(times, values)(t)
        found = np.asarray(answer(times, values, t))
        assert found.shape == (60,), f"expected an array (60,), found {found.shape}"
        assert np.allclose(found, expected), f"{k} keys: off by up to {np.abs(found - expected).max():.3g}"
    times, values = np.linspace(0, 1, 8), np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0])
    with np.errstate(all="raise"):
        still = np.asarray(answer(times, values, np.array([0.1, 0.2, 0.4, 0.6, 0.8, 0.95])))
    assert np.allclose(still, [0, 0, 0, 1, 1, 1]), "what stands still at keys stays still between them"
