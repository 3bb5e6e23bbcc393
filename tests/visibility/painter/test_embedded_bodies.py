"""Of closed bodies that cross themselves both sides of faces are seen; of all others only the outside is kept."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.geometry.boxes import overlapping_pairs
from vectorplot.scene import look
from vectorplot.visibility import projected_faces
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import body_sides, project_faces


def _closed_grid(of, across, along):
    """Triangles of a surface that closes in both parameters."""
    u, v = np.meshgrid(np.arange(across) * 2 * np.pi / across, np.arange(along) * 2 * np.pi / along, indexing="ij")
    number = np.arange(across * along).reshape(across, along)
    right, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    triangles = np.concatenate([np.stack([number, right, both], -1), np.stack([number, both, up], -1)])
    return np.stack(np.broadcast_arrays(*of(u, v)), -1).reshape(-1, 3), triangles.reshape(-1, 3)


def _eight_ring(across, turns=0.0):
    def of(u, v):
        a, b, turn = np.cos(u), np.sin(2 * u) / 2, turns * v
        a, b = a * np.cos(turn) - b * np.sin(turn), a * np.sin(turn) + b * np.cos(turn)
        return (3 + a) * np.cos(v), (3 + a) * np.sin(v), b

    return _closed_grid(of, across, 24)


def _bohemian(across):
    return _closed_grid(lambda u, v: (0.7 * np.cos(u), 0.5 * np.cos(v) + 0.7 * np.sin(u), np.sin(v)), across, 20)


def _spindle(across):
    """A spindle torus: inside, it is seen from the wrong side nowhere, but it crosses itself."""
    return _closed_grid(
        lambda u, v: ((0.6 + np.cos(u)) * np.cos(v), (0.6 + np.cos(u)) * np.sin(v), np.sin(u)), across, 20
    )


def _double_cone(across):
    """Two cones that have their apex in common, one of them wound inside out."""
    ring = np.arange(across) * 2 * np.pi / across
    circle = np.stack([np.cos(ring), np.sin(ring), 0 * ring], -1)
    points = np.concatenate([circle - (0, 0, 1), 0.6 * circle + (0, 0, 1), [(0, 0, 0), (0, 0, -1), (0, 0, 1)]])
    one, two, apex = np.arange(across), across + np.arange(across), np.full(across, 2 * across)
    after, beyond = np.roll(one, -1), np.roll(two, -1)
    parts = [(one, after, apex), (after, one, apex + 1), (two, beyond, apex), (beyond, two, apex + 2)]
    return points, np.concatenate([np.stack(part, -1) for part in parts])


def _pushed_through(depth):
    """A cube whose bottom is pushed up as a pyramid that comes out of its top."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)] + [(0.5, 0.4, depth)]
    faces = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (4, 5, 7, 6)]
    triangles = [(f[0], f[k], f[k + 1]) for f in faces for k in (1, 2)]
    triangles += [(1, 0, 8), (3, 1, 8), (2, 3, 8), (0, 2, 8)]
    return np.array(corners, dtype=float), np.array(triangles)


def _inverted_beside():
    one, two = (box((1, 1, 1), placement=(1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0)) for x in (0.0, 1.5))
    faces = np.concatenate([one.corners.reshape(-1, 4), 8 + two.corners.reshape(-1, 4)[:, ::-1]])
    triangles = np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]])
    return np.concatenate([one.vertices, 0.7 * two.vertices]), triangles


def _ball(around, turns=1):
    """A ball with a bulge, run around so many times."""
    u = np.arange(around * turns) * 2 * np.pi / around
    v = np.linspace(-np.pi / 2, np.pi / 2, 8)[1:-1, None]
    bulge = 1.0 + 0.05 * np.cos(u / turns)
    ring = np.stack(np.broadcast_arrays(bulge * np.cos(v) * np.cos(u), bulge * np.cos(v) * np.sin(u), np.sin(v)), -1)
    number = np.arange(ring.size // 3).reshape(ring.shape[:2])
    right, south, north = np.roll(number, -1, axis=1), number.size, number.size + 1
    parts = [(number[:-1], right[:-1], right[1:]), (number[:-1], right[1:], number[1:])]
    parts += [(right[0], number[0], np.full_like(u, south)), (number[-1], right[-1], np.full_like(u, north))]
    triangles = np.concatenate([np.stack(part, -1).reshape(-1, 3) for part in parts]).astype(int)
    return np.concatenate([ring.reshape(-1, 3), [(0, 0, -1), (0, 0, 1)]]), triangles


CROSSING = {
    "a ball run around twice": _ball(12, turns=2),
    "ring of an eight": _eight_ring(16),
    "ring of an eight, double point between corners": _eight_ring(17),
    "ring of an eight that turns": _eight_ring(16, turns=2.0),
    "Bohemian dome": _bohemian(18),
    "spindle torus": _spindle(18),
    "double cone of which one half is inside out": _double_cone(9),
    "pushed through": _pushed_through(1.3),
    "a cube beside an inverted one": _inverted_beside(),
}

EMBEDDED = {
    "torus": _closed_grid(lambda u, v: ((3 + np.cos(u)) * np.cos(v), (3 + np.cos(u)) * np.sin(v), np.sin(u)), 12, 18),
    "dented": _pushed_through(0.8),
    "ball": _ball(12),
}


def _view(points, triangles, seed):
    mesh = vp.Mesh.from_triangles(points, triangles)
    way = np.random.default_rng(seed).normal(size=3)
    camera = vp.Camera(tuple(9.0 * way / np.sqrt((way * way).sum())), (0.0, 0.0, 0.0), parallel=seed % 2 == 1)
    return look(vp.Scene((vp.Item("body", mesh),)), camera)


def _nearest(view, places):
    """The nearest triangle at places (n,2) of the image, by barycentric coordinates; -1 for none."""
    corner = view.corners.reshape(-1, 3)
    x, y = view.image
    depth = view.depth if view.eye is None else -1.0 / view.depth
    a, b, c = (np.stack([x[corner[:, k]], y[corner[:, k]]]) for k in range(3))
    area = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
    at = places.T[:, :, None] - a[:, None]
    v = (at[0] * (c - a)[1] - at[1] * (c - a)[0]) / np.where(area == 0.0, np.nan, area)
    w = ((b - a)[0] * at[1] - (b - a)[1] * at[0]) / np.where(area == 0.0, np.nan, area)
    far = depth[corner]
    here = np.where(
        (v > 1e-6) & (w > 1e-6) & (v + w < 1 - 1e-6), far[:, 0] * (1 - v - w) + far[:, 1] * v + far[:, 2] * w, np.inf
    )
    best = here.argmin(axis=1)
    return np.where(np.isfinite(here.min(axis=1)), best, -1)


@pytest.mark.parametrize("inside_out", [False, True])
@pytest.mark.parametrize("name", [*CROSSING, *EMBEDDED])
def test_what_is_nearest_to_the_eye_is_kept(name, inside_out):
    points, triangles = (CROSSING | EMBEDDED)[name]
    triangles = triangles[:, ::-1] if inside_out else triangles
    for seed in range(4):
        view = _view(points, triangles, seed)
        low, high = view.image.min(axis=1), view.image.max(axis=1)
        places = low + np.random.default_rng(seed).uniform(size=(1500, 2)) * (high - low)
        nearest = _nearest(view, places)
        kept = drawn_faces(view, project_faces(view))
        assert np.isin(nearest[nearest >= 0], kept).all()


@pytest.mark.parametrize("name", list(CROSSING))
def test_bodies_that_cross_themselves_show_both_sides(name):
    assert body_sides(_view(*CROSSING[name], 0)).tolist() == [0]


@pytest.mark.parametrize("name", list(EMBEDDED))
def test_bodies_that_do_not_show_their_outside(name):
    points, triangles = EMBEDDED[name]
    side = body_sides(_view(points, triangles, 0))
    assert abs(side[0]) == 1
    assert (body_sides(_view(points, triangles[:, ::-1], 0)) == -side).all()


def test_cavities_are_no_crossings():
    outer, inner = box((3, 3, 3)), box((1, 1, 1), placement=(1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1))
    faces = np.concatenate([outer.corners.reshape(-1, 4), 8 + inner.corners.reshape(-1, 4)[:, ::-1]])
    triangles = np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]])
    assert body_sides(_view(np.concatenate([outer.vertices, inner.vertices]), triangles, 0)).tolist() == [1]


def test_bodies_seen_whole_from_their_middle_are_not_searched_for_crossings(monkeypatch):
    searched = []

    def pairs(low, high):
        searched.append(low.shape[1])
        return overlapping_pairs(low, high)

    monkeypatch.setattr(projected_faces, "overlapping_pairs", pairs)
    assert body_sides(_view(*_ball(12), 0)).tolist() == [1]
    points, triangles = EMBEDDED["torus"]
    assert body_sides(_view(points, triangles, 0)).tolist() != [0]
    assert searched == [0, len(triangles)]
