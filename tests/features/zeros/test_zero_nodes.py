"""Nodes and touching points of zero manifolds wherever they lie on the grid: at its points, at those of its
subdivisions, between them."""

import numpy as np
import pytest

from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.surfaces.surface import Domain

TURN = 2 * np.pi
WITH_NODES = {
    "saddle": (lambda u, v: u * u - v * v, [(0, 0)]),
    "product": (lambda u, v: u * v, [(0, 0)]),
    "slanted lines": (lambda u, v: (u - 0.5 * v) * (v + 0.25 * u), [(0, 0)]),
    "lemniscate": (lambda u, v: (u * u + v * v) ** 2 - 0.5 * (u * u - v * v), [(0, 0)]),
    "loop": (lambda u, v: v * v - u * u * (u + 0.5), [(0, 0)]),
    "circle and line": (lambda u, v: (u * u + v * v - 0.25) * u, [(0, -0.5), (0, 0.5)]),
    "four lines": (lambda u, v: (u * u - 0.25) * (v * v - 0.25), [(a, b) for a in (-0.5, 0.5) for b in (-0.5, 0.5)]),
}


def distances(found, expected):
    """Of each expected point from the nearest found one."""
    return np.linalg.norm(np.asarray(expected)[:, None] - found[None], axis=2).min(axis=1, initial=np.inf)


@pytest.mark.hard(38)
@pytest.mark.spread
@pytest.mark.parametrize("cells", [8, 11, 12, 25, 32, 47])
@pytest.mark.parametrize(("f", "nodes"), WITH_NODES.values(), ids=WITH_NODES.keys())
def test_nodes_at_lattice_points_are_found(f, nodes, cells):
    # On the second domain the nodes lie at points of the grid or of a subdivision, on the third mostly beside them.
    for (u, v), end in (((0.0, 0.0), (1.0, 1.0)), ((1000.0, -3.0), (1.0, 1.0)), ((0.0, 0.0), (1.25, 1.125))):
        domain = Domain(u - 1.0, u + end[0], v - 1.0, v + end[1])
        curve = zero_manifold_of_f_uv(lambda x, y, u=u, v=v: f(x - u, y - v), domain, columns=cells, rows=cells)
        assert len(curve.nodes) == len(nodes) and not len(curve.isolated) and not len(curve.touching)
        assert distances(curve.nodes - (u, v), nodes).max() < 1e-8


@pytest.mark.hard(38)
@pytest.mark.parametrize("cells", [8, 9, 11, 12, 20, 32, 47])
@pytest.mark.parametrize(
    "f", [lambda u, v: u**3 - 3 * u * v * v, lambda u, v: (u - v) * (u + v) * (u - 2 * v)], ids=["monkey", "lines"]
)
def test_nodes_of_three_branches_at_lattice_points_are_found(f, cells):
    curve = zero_manifold_of_f_uv(f, Domain(-1, 1, -1, 1), columns=cells, rows=cells)
    assert len(curve) == 3 and len(curve.nodes) == 1 and not len(curve.isolated)
    assert np.abs(curve.nodes).max() < 1e-3


@pytest.mark.hard(38)
@pytest.mark.parametrize("degrees", [12, 20, 40, 70])
@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, 2.5])
def test_branches_at_a_small_angle_go_straight_through_their_node(degrees, turn):
    a, b = turn, turn + np.radians(degrees)
    at = np.array([0.25, -0.125])

    def f(u, v):
        x, y = u - at[0], v - at[1]
        return (np.sin(a) * x - np.cos(a) * y) * (np.sin(b) * x - np.cos(b) * y)

    curve = zero_manifold_of_f_uv(f, Domain(-1, 1, -1, 1), columns=16, rows=16)
    assert len(curve) == 2 and len(curve.nodes) == 1 and np.abs(curve.nodes - at).max() < 1e-9
    for k in range(2):
        p = curve[k] - at
        along = p[np.argmax(np.linalg.norm(p, axis=1))]
        assert np.abs(p[:, 0] * along[1] - p[:, 1] * along[0]).max() < 1e-9


@pytest.mark.hard(39)
@pytest.mark.parametrize("cells", [8, 9, 11, 12, 20, 32, 47])
@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["valley", "hill"])
def test_single_points_at_lattice_points_are_found(sign, cells):
    curve = zero_manifold_of_f_uv(
        lambda u, v: sign * (u * u + 3 * v * v + u * v), Domain(-1, 1, -1, 1), columns=cells, rows=cells
    )
    assert len(curve) == 0 and curve.isolated.shape == (1, 2) and np.abs(curve.isolated).max() < 1e-9


@pytest.mark.hard(39)
@pytest.mark.spread
@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["valley", "hill"])
@pytest.mark.parametrize("share", [(0, 0.5), (0.5, 0.5), (0.25, 0), (1 / 3, 0), (0.1875, 0.25), (0.2718, 1 / 512)])
def test_single_points_anywhere_in_a_cell_are_found_whether_hills_or_valleys(share, sign):
    for cells in (7, 8, 45):
        at = -1.0 + 2.0 * (cells // 2 + np.array(share)) / cells
        curve = zero_manifold_of_f_uv(
            lambda u, v, at=at: sign * ((u - at[0]) ** 2 + (v - at[1]) ** 2),
            Domain(-1, 1, -1, 1),
            columns=cells,
            rows=cells,
        )
        assert len(curve) == 0 and curve.isolated.shape == (1, 2) and np.abs(curve.isolated - at).max() < 1e-8


@pytest.mark.hard(38)
@pytest.mark.spread
@pytest.mark.parametrize("cells", [8, 9, 10, 24, 25, 47])
@pytest.mark.parametrize("start", [0.0, 1.0])
@pytest.mark.parametrize(
    ("f", "count"),
    [
        (lambda u, v: np.sin(u) * np.sin(v), 4),
        (lambda u, v: np.cos(u) - np.cos(v), 2),
        (lambda u, v: np.sin(u) - np.sin(v), 2),
    ],
)
def test_nodes_of_periodic_functions_are_found(f, count, start, cells):
    ring = Domain(start, start + TURN, -start, TURN - start, closed_u=True, closed_v=True)
    curve = zero_manifold_of_f_uv(f, ring, columns=cells, rows=cells)
    assert len(curve.nodes) == count and curve.closed.all() and not len(curve.isolated)


@pytest.mark.hard(39)
@pytest.mark.parametrize("cells", [8, 9, 25, 47])
@pytest.mark.parametrize("start", [0.0, 1.0])
def test_a_single_point_on_the_seam_is_found_once(start, cells):
    ring = Domain(start, start + TURN, -start, TURN - start, closed_u=True, closed_v=True)
    curve = zero_manifold_of_f_uv(lambda u, v: 2 - np.cos(u) - np.cos(v), ring, columns=cells, rows=cells)
    assert len(curve) == 0 and curve.isolated.shape == (1, 2)


def test_lines_through_all_grid_points_are_no_area_of_zeros():
    # Every grid point is a node.
    curve = zero_manifold_of_f_uv(
        lambda u, v: np.sin(np.pi * u) * np.sin(np.pi * v), Domain(-0.0, 4.0, 0.0, 4.0), columns=4, rows=4
    )
    inner = [(a, b) for a in (1, 2, 3) for b in (1, 2, 3)]
    assert distances(curve.nodes, inner).max() < 1e-8 and not any("zero all over" in text for text in curve.doubts)
    assert np.abs(np.sin(np.pi * curve.points[:, 0]) * np.sin(np.pi * curve.points[:, 1])).max() < 1e-11
