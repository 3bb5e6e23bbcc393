"""Cuspidal edges and double lines of implicit surfaces, against what is known of them in closed form."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from vectorplot.features.implicit_curves import ImplicitTracing, implicit_plane_sections, refined_line
from vectorplot.features.implicit_singular_lines import SingularLines, singular_lines
from vectorplot.features.polygonization import polygonized
from vectorplot.geometry.polylines import Polylines
from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_implicit
from vectorplot.surfaces.placed_surface import PlacedImplicit
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.testing.shapes import rotation

Off = Callable[[np.ndarray], np.ndarray]

SWALLOWTAIL = "16*x^4*z-4*x^3*y^2-128*x^2*z^2+144*x*y^2*z-27*y^4+256*z^3"
HUNT = "4*(x^2+y^2+z^2-13)^3+27*(3*x^2+y^2-4*z^2-12)^2"


def implicit(text: str, size: float) -> ImplicitSurface:
    return formula_implicit(Formulas((parse_expression(text, ("x", "y", "z")),)), [[-size] * 3, [size] * 3])


def found(surface: ImplicitSurface) -> SingularLines:
    return singular_lines(surface, polygonized(surface, 48))


@cache
def found_of(text: str, size: float) -> SingularLines:
    return found(implicit(text, size))


def length(lines: Polylines) -> float:
    steps = (np.linalg.norm(np.diff(lines[k], axis=0), axis=1).sum() for k in range(len(lines)))
    return float(sum(steps))


def along(p: np.ndarray) -> np.ndarray:
    """How far points are from the cuspidal edge (-6 t^2, 8 t^3, -3 t^4) of the swallowtail."""
    t = np.sqrt(np.maximum(-p[:, 0], 0.0) / 6.0) * np.sign(p[:, 1])
    return np.abs(p[:, 1] - 8.0 * t**3) + np.abs(p[:, 2] + 3.0 * t**4)


def hunt(p: np.ndarray) -> np.ndarray:
    square = p * p
    return np.abs(square.sum(axis=1) - 13.0) + np.abs(square @ [3.0, 1.0, -4.0] - 12.0)


EDGES: dict[str, tuple[str, float, Off, float, int]] = {
    "straight": ("y^3-z^2", 1.2, lambda p: np.hypot(p[:, 1], p[:, 2]), 2.4, 1),
    "cone over a cusp": ("x^2*z-y^3", 1.2, lambda p: np.hypot(p[:, 0], p[:, 1]), 2.4, 1),
    "in no plane of symmetry": (
        "(y-0.1)^3-(z+0.2*x)^2",
        1.2,
        lambda p: np.abs(p[:, 1] - 0.1) + np.abs(p[:, 2] + 0.2 * p[:, 0]),
        2.4 * np.sqrt(1.04),
        1,
    ),
    "ring": (
        "(x^2+y^2-0.5)^3-0.3*z^2",
        1.2,
        lambda p: np.abs(np.hypot(p[:, 0], p[:, 1]) - np.sqrt(0.5)) + np.abs(p[:, 2]),
        2.0 * np.pi * np.sqrt(0.5),
        1,
    ),
    "swallowtail": (SWALLOWTAIL, 1.0, along, 2.0 * 1.1552, 2),
    "Hunt": (HUNT, 5.0, hunt, 43.78, 2),
}

DOUBLES: dict[str, tuple[str, float, Off, float, int]] = {
    "two planes": (
        "(x+0.3*z)*(y-0.2*z)",
        1.2,
        lambda p: np.abs(p[:, 0] + 0.3 * p[:, 2]) + np.abs(p[:, 1] - 0.2 * p[:, 2]),
        2.4 * np.sqrt(1.13),
        1,
    ),
    "umbrella": ("x^2-y^2*z", 1.2, lambda p: np.hypot(p[:, 0], p[:, 1]), 1.2, 1),
    "two spheres": (
        "((x-0.4)^2+y^2+z^2-0.6)*((x+0.4)^2+y^2+z^2-0.6)",
        1.3,
        lambda p: np.abs(p[:, 0]) + np.abs(np.hypot(p[:, 1], p[:, 2]) - np.sqrt(0.44)),
        2.0 * np.pi * np.sqrt(0.44),
        1,
    ),
    "Steiner's Roman surface": (
        "x^2*y^2+y^2*z^2+z^2*x^2-x*y*z",
        0.6,
        lambda p: np.sort(np.abs(p), axis=1)[:, :2].sum(axis=1),
        3.0,
        3,
    ),
    "self-intersection of the swallowtail": (
        SWALLOWTAIL,
        1.0,
        lambda p: np.abs(p[:, 1]) + np.abs(p[:, 2] - p[:, 0] ** 2 / 4.0),
        1.0403,
        1,
    ),
}


def compared(lines: Polylines, off: Off, whole: float, count: int, size: float) -> None:
    assert len(lines) == count
    assert off(lines.points).max() < 1e-9 * size
    assert length(lines) == pytest.approx(whole, rel=0.02)


@pytest.mark.slow
@pytest.mark.hard(49)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", list(EDGES))
def test_cuspidal_edges_are_found_whole(name: str) -> None:
    text, size, off, whole, count = EDGES[name]
    lines = found_of(text, size)
    compared(lines.edges, off, whole, count, size)
    assert len(lines.doubles) == (1 if name == "swallowtail" else 0)


@pytest.mark.slow
@pytest.mark.hard(48)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", list(DOUBLES))
def test_lines_in_which_a_surface_crosses_itself_are_found_whole(name: str) -> None:
    text, size, off, whole, count = DOUBLES[name]
    lines = found_of(text, size)
    compared(lines.doubles, off, whole, count, size)
    assert len(lines.edges) == (2 if "swallowtail" in name else 0)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("away", [0.0, 1e3])
def test_wherever_the_surface_stands_and_whatever_its_size(size: float, away: float) -> None:
    matrix, shift = size * rotation(np.random.default_rng(3)), size * away * np.array([1.0, -0.7, 0.3])
    lines = found(PlacedImplicit(implicit(HUNT, 5.0), matrix, shift))
    home = (lines.edges.points - shift) @ np.linalg.inv(matrix)
    assert len(lines.edges) == 2 and lines.edges.closed.all()
    assert hunt(home).max() < 5e-9 * (1.0 + away)


@pytest.mark.slow
def test_what_has_none_has_none() -> None:
    for text in ("x^2+y^2+z^2-0.5", "x^2+y^2-z^2", "4*(x^2+y^2+z^2)+16*x*y*z-1", "x^3-z", "x*y+0.01", "y^3-z^2-0.001"):
        assert not len(found(implicit(text, 0.9))), text


@pytest.mark.slow
def test_refined_lines_keep_the_tolerance() -> None:
    lines = found_of(HUNT, 5.0)
    curves = refined_line(lines.edge_equations, lines.edges, ImplicitTracing(tolerance=1e-4))
    middles = (curves[0][1:] + curves[0][:-1]) / 2.0
    assert hunt(curves.points).max() < 1e-9
    # To first order the distance is that of the two equations.
    assert hunt(middles).max() < 1e-4 * 60.0


@pytest.mark.hard(49)
@pytest.mark.parametrize("offset", [-0.2, 0.024, 0.13])
def test_sections_have_their_cusps_on_the_edge(offset: float) -> None:
    curves = implicit_plane_sections(implicit("y^3-z^2", 1.2), (0.2, 0.3, 1.0), [offset])
    ends = curves.points[np.concatenate([curves.offsets[:-1], curves.offsets[1:] - 1])]
    place = np.array([offset / 0.2 * np.sqrt(1.13), 0.0, 0.0])
    assert not curves.closed.any() and (np.linalg.norm(ends - place, axis=1) < 1e-9).sum() == 2


@pytest.mark.hard(48)
def test_curves_go_on_beyond_a_line_in_which_the_surface_crosses_itself() -> None:
    curves = implicit_plane_sections(implicit("(x+0.3*z)*(y-0.2*z)", 1.2), (0.2, 0.3, 1.0), [0.1])
    ends = curves.points[np.concatenate([curves.offsets[:-1], curves.offsets[1:] - 1])]
    place = np.array([-0.3, 0.2, 1.0]) * 0.1 * np.sqrt(1.13)
    assert len(curves) == 4 and (np.linalg.norm(ends - place, axis=1) < 1e-9).sum() == 4
