"""Lines that lie on a sheet several times: seams that the domain does not know of, and lines in multiple curves."""

import numpy as np
import pytest
from support.smooth_seen import ALL, chords_seen

import vectorplot as vp
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import look
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.surface import Domain
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.words import LineKind

TURN = 2 * np.pi
EYES = ((4.75, 0.79, -3.58), (-11.6, -16.4, 15.7), (8.8, 23.8, 2.3))


def ball(u, v):
    return np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)


def klein_bottle(u, v):
    r = 3 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    return r * np.cos(u), r * np.sin(u), np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)


def clover_ring(u, v):
    r = 3 + np.cos(3 * v) * np.cos(v)
    return r * np.cos(u), r * np.sin(u), np.cos(3 * v) * np.sin(v)


def ring(u, v):
    return (2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)


def seen(points, domain, eye, kind, **lines):
    """Visible chords of a kind in the half plane y = 0, x > 0."""
    item = vp.Item("IT", surface_of_function(points, domain), curves=SurfaceLines(**lines))
    found = chords_seen(vp.Scene((item,)), vp.Camera(eye=eye, target=(0, 0, 0)), kinds=ALL | {LineKind.PARAMETER})
    there = (np.abs(found.start[:, 1]) < 1e-9) & (np.abs(found.end[:, 1]) < 1e-9) & (found.start[:, 0] > 0)
    return found.length[there & (found.kind == kind) & (found.hidden_by == 0)].sum()


@pytest.mark.parametrize("eye", EYES)
def test_the_seam_of_a_ball_is_seen_where_it_faces_the_eye(eye):
    v = np.linspace(-np.pi / 2, np.pi / 2, 100_001)
    true = np.pi * np.mean(np.stack(ball(0 * v, v), axis=1) @ np.array(eye) > 1.0)
    found = seen(ball, Domain(0, TURN, -np.pi / 2, np.pi / 2), eye, LineKind.BOUNDARY) / 2
    assert abs(found - true) < 2e-3


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize(("points", "start"), [(ring, 0.3), (klein_bottle, -np.pi)])
def test_a_seam_is_seen_as_the_same_line_amid_the_surface(points, start, eye):
    true = seen(points, Domain(-np.pi, np.pi, start, start + TURN), eye, LineKind.PARAMETER, columns=2)
    found = seen(points, Domain(0, TURN, start, start + TURN), eye, LineKind.BOUNDARY) / 2
    assert true > 0.01 and abs(found - true) < 2e-3


def crossed(x, way, start):
    """Which rays from points x (n,3) meet the clover ring, by the signs of its equation, from start on."""
    at = x[:, None] + np.geomspace(start, 30.0, 3000)[:, None] * way[:, None]
    x, z = np.hypot(at[..., 0], at[..., 1]) - 3, at[..., 2]
    sign = np.sign((x * x + z * z) ** 2 - x**3 + 3 * x * z * z)
    return (sign[:, 1:] * sign[:, :-1] < 0.0).any(axis=1)


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize(("start", "closed"), [(0.0, True), (np.pi / 6, False)])
def test_a_line_in_which_three_sheets_meet_is_seen_where_its_equation_says_so(start, closed, eye):
    domain = Domain(0, TURN, start, start + np.pi, closed_u=True, closed_v=closed)
    item = vp.Item("IT", surface_of_function(clover_ring, domain), curves=SurfaceLines(rows=6))
    found = chords_seen(vp.Scene((item,)), vp.Camera(eye=eye, target=(0, 0, 0)), kinds=ALL | {LineKind.PARAMETER})
    middle = (found.start + found.end) / 2
    kept = (np.abs(np.hypot(middle[:, 0], middle[:, 1]) - 3) < 1e-3) & (np.abs(middle[:, 2]) < 1e-6)
    kept = np.flatnonzero(kept)[::7]
    middle, hidden = middle[kept], found.hidden_by[kept] > 0
    middle[:, :2] *= 3 / np.hypot(middle[:, 0], middle[:, 1])[:, None]
    way = np.array(eye) - middle
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    true, also = (crossed(middle, way, start) for start in (1e-3, 4e-3))
    assert len(kept) > 300 and np.mean(hidden[true == also] != true[true == also]) < 5e-3


def test_a_line_lies_on_another_sheet_as_far_as_that_goes():
    wave = surface_of_function(lambda u, v: (u, v, 0.1 * np.sin(3 * v)), Domain(-1, 1, -1, 1))
    wall = surface_of_function(lambda u, v: (0.4 * v, u, v + 0.1 * np.sin(3 * u)), Domain(-0.5, 0.3, -0.4, 0.6))
    scene = vp.Scene((vp.Item("WAVE", wave, curves=SurfaceLines(columns=2)), vp.Item("WALL", wall)))
    view = look(scene, vp.Camera(eye=(4, 0.3, 3), target=(0, 0, 0)))
    traced = traced_scene(scene, view, scene_sheets(scene, view), ALL | {LineKind.PARAMETER}, 1e-4)
    found = traced.stretches.curves
    y = view.world_of(found.points.T)[:, 1]
    assert len(found) == 1 and -0.5 <= y.min() < -0.4 and 0.25 < y.max() <= 0.3
