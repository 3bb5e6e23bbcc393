"""Polynomials of degree two and four over [0, 1] in Bernstein form, many at once: values and roots."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.tolerances.of_numbers import ULP

HALVINGS = 26
"""After so many halvings roots that still lie together are one double root, at which nothing changes."""

ROUNDS = 60
"""Steps of the search for a root between two ends; halving alone takes 53."""


def squares(a: Floats) -> Floats:
    """(5,n) coefficients of the squares of polynomials (3,n)."""
    return np.stack([a[0] * a[0], a[0] * a[1], (a[0] * a[2] + 2.0 * a[1] * a[1]) / 3.0, a[1] * a[2], a[2] * a[2]])


def value_of_two(c: Floats, t: Floats) -> Floats:
    """Values at t of polynomials of degree two, coefficients first (3,...)."""
    s = 1.0 - t
    return np.asarray((c[0] * s + 2.0 * c[1] * t) * s + c[2] * t * t)


def value_of_four(c: Floats, t: Floats) -> Floats:
    """Values at t of polynomials of degree four, coefficients first (5,...)."""
    s = 1.0 - t
    tt, ss = t * t, s * s
    return np.asarray((c[0] * ss + 4.0 * c[1] * s * t + 6.0 * c[2] * tt) * ss + (4.0 * c[3] * s + c[4] * t) * tt * t)


def roots_of_two(c: Floats) -> Floats:
    """(2,n) the roots within (0, 1) of polynomials (3,n); 1 where there is none."""
    a, b = c[0] - 2.0 * c[1] + c[2], c[1] - c[0]
    square = b * b - a * c[0]
    with np.errstate(all="ignore"):
        q = -(b + np.where(b >= 0.0, 1.0, -1.0) * np.sqrt(np.maximum(square, 0.0)))
        roots = np.stack([q / a, c[0] / q])
        inside = (roots > 0.0) & (roots < 1.0) & (square >= 0.0)
    return np.where(inside, roots, 1.0)


def roots_of_four(c: Floats) -> tuple[Ints, Floats]:
    """Which polynomial (r,), and where (r,), of all roots within (0, 1) of polynomials (5,n) that change their sign.

    Halved until each part has one change of sign among its coefficients, or none: then it has as many roots. Source:
    Descartes' rule in Bernstein form.
    """
    index, low, width = np.arange(c.shape[1]), np.zeros(c.shape[1]), np.ones(c.shape[1])
    single = [(index[:0], low[:0], width[:0], c[:, :0])]
    for _ in range(HALVINGS):
        changes = _sign_changes(c)
        one = np.flatnonzero(changes == 1)
        single.append((index[one], low[one], width[one], c[:, one]))
        more = np.flatnonzero(changes > 1)
        if not len(more):
            break
        index, low, width = index[more], low[more], 0.5 * width[more]
        left, right = _halves(c[:, more])
        c = np.concatenate([left, right], axis=1)
        index, low, width = np.tile(index, 2), np.concatenate([low, low + width]), np.tile(width, 2)
    index, low, width, c = (np.concatenate(column, axis=-1) for column in zip(*single, strict=True))
    return index, low + width * _single_roots(c)


def _sign_changes(c: Floats) -> Ints:
    """(n,) changes of sign along the coefficients (5,n); zeros have the sign before them."""
    sign = np.sign(c)
    for k in range(1, 5):
        sign[k] = np.where(sign[k] == 0.0, sign[k - 1], sign[k])
    return np.asarray((sign[1:] * sign[:-1] < 0.0).sum(axis=0))


def _halves(c: Floats) -> tuple[Floats, Floats]:
    """Coefficients of both halves of polynomials (5,n). Source: de Casteljau."""
    levels = [c]
    for _ in range(4):
        levels.append(0.5 * (levels[-1][:-1] + levels[-1][1:]))
    return np.stack([level[0] for level in levels]), np.stack([level[-1] for level in reversed(levels)])


def _single_roots(c: Floats) -> Floats:
    """(n,) the root of each polynomial (5,n) that has one: Newton's steps, halving where they leave the bracket."""
    low, high = np.zeros(c.shape[1]), np.ones(c.shape[1])
    rising = np.where(c[0] != 0.0, c[0] < 0.0, c[4] > 0.0)
    with np.errstate(all="ignore"):
        t = c[0] / (c[0] - c[4])
    t = np.where((t > 0.0) & (t < 1.0), t, 0.5)
    slope = 4.0 * (c[1:] - c[:-1])
    found, who = t.copy(), np.arange(len(t))
    for _ in range(ROUNDS):
        value, s = value_of_four(c, t), 1.0 - t
        rate = ((slope[0] * s + 3.0 * slope[1] * t) * s + 3.0 * slope[2] * t * t) * s + slope[3] * t * t * t
        below = (value < 0.0) == rising
        low, high = np.where(below, t, low), np.where(below, high, t)
        with np.errstate(all="ignore"):
            new = t - value / rate
        # The end of the bracket may be the root.
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        new = np.where(value == 0.0, t, new)
        busy = np.flatnonzero(np.abs(new - t) > 2.0 * ULP)
        found[who] = t = new
        if not len(busy):
            break
        who, t, low, high, rising = who[busy], t[busy], low[busy], high[busy], rising[busy]
        c, slope = c[:, busy], slope[:, busy]
    return found
