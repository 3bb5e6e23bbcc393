"""Implicit surfaces with cuspidal edges and double lines in drawings: against rays, and as what is drawn of them."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from support.effort import several
from support.smooth_seen import chords_seen

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_implicit
from vectorplot.testing import assert_drawing_is_right
from vectorplot.words import LineKind

EYES = ((3.0, -5.0, 4.0), (-4.0, 3.0, 2.0), (2.0, 4.2, -3.1))

CASES = [
    ("y^3-z^2", EYES[1]),
    ("x^2*z-y^3", EYES[0]),
    ("(x+0.3*z)*(y-0.2*z)", EYES[0]),
]


def scene_of(text: str, size: float = 1.2) -> vp.Scene:
    shape = formula_implicit(Formulas((parse_expression(text, ("x", "y", "z")),)), [[-size] * 3, [size] * 3])
    sections = (vp.Section((0.2, 0.3, 1.0), (-0.35 * size, 0.02 * size, 0.4 * size)),)
    return vp.Scene((vp.Item("S", shape, curves=vp.SurfaceLines(sections=sections)),))


def drawn(scene: vp.Scene, eye: tuple[float, ...], size: float = 1.2) -> tuple[vp.Camera, vp.Drawing]:
    camera = vp.Camera(tuple((size * np.array(eye)).tolist()), (0.0, 0.0, 0.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return camera, vp.draw(scene, camera, page=vp.Page(100, 100, 5), hidden="solid")


@pytest.mark.slow
@pytest.mark.hard(49)
@pytest.mark.hard(72)
@pytest.mark.parametrize(("text", "eye"), CASES)
def test_what_hides_ends_on_singular_lines(text: str, eye: tuple[float, ...]) -> None:
    scene = scene_of(text)
    camera, drawing = drawn(scene, eye)
    assert assert_drawing_is_right(drawing, scene, camera, samples=several(200, long=400)) > 40


@pytest.mark.slow
@pytest.mark.hard(49)
def test_cuspidal_edges_are_creases_and_double_lines_intersections() -> None:
    for text, kind, straight in (
        ("y^3-z^2", LineKind.CREASE, ((-1.2, 0.0, 0.0), (1.2, 0.0, 0.0))),
        ("x*y", LineKind.INTERSECTION, ((0.0, 0.0, -1.2), (0.0, 0.0, 1.2))),
    ):
        chords = chords_seen(scene_of(text), vp.Camera(EYES[0], (0.0, 0.0, 0.0)), kinds=frozenset({kind}))
        points = np.concatenate([chords.start, chords.end])
        low, high = np.array(straight)
        assert np.abs(points[:, low == high]).max() < 1e-9, text
        assert (points.min(axis=0) <= low + 1e-9).all() and (points.max(axis=0) >= high - 1e-9).all(), text


def polynomial(random: np.random.Generator, degree: int) -> str:
    """One with random coefficients, about six in ten of those it could have."""
    powers = [(i, j, k) for i in range(degree + 1) for j in range(degree + 1 - i) for k in range(degree + 1 - i - j)]
    terms = [f"({random.normal():.3f})*x^{i}*y^{j}*z^{k}" for i, j, k in powers if random.random() < 0.6]
    return f"({'+'.join(terms) or 'x'})"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 9])
def test_products_and_discriminants_of_random_surfaces_as_rays_see_them(seed: int) -> None:
    random = np.random.default_rng(seed)
    one, two = (polynomial(random, 1 + int(random.integers(2))) for _ in range(2))
    scene = scene_of(f"{one}^3-{two}^2" if seed % 2 == 0 else f"{one}*{two}", 1.0)
    camera, drawing = drawn(scene, tuple(random.normal(size=3) * 3.0), 1.0)
    assert assert_drawing_is_right(drawing, scene, camera, samples=200) > 20
