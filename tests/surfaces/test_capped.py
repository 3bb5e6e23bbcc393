"""Bodies between flat ends: what they are, and how every verb shows them."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.features.edge_splitting import Within
from vectorplot.features.tessellation import facets
from vectorplot.geometry.vectors import dot
from vectorplot.io.description import describe
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.extent import smooth_bounds
from vectorplot.surfaces import (
    Capped,
    Cone,
    Cylinder,
    Ellipsoid,
    Frustum,
    Hyperboloid,
    PlacedSurface,
    Sphere,
    Torus,
    TrimmedSurface,
    rod,
    unit_normals,
)
from vectorplot.surfaces.quadrics import Paraboloid
from vectorplot.surfaces.trimmed import creases, smooth_parts

BODIES = {
    "cylinder": Capped(Cylinder(1.0, -1.0, 2.0)),
    "elliptic cylinder": Capped(Cylinder(1.0, 0.0, 2.0, (3, 4, 5), depth=0.5)),
    "cone": Capped(Cone.standing(1.0, 2.0)),
    "cone on its apex": Capped(Cone(0.5, 0.0, 2.0)),
    "frustum": Capped(Frustum(1.0, 0.3, 2.0, (1, 2, 3))),
    "frustum of a cone": Capped(Cone(0.5, -3.0, -1.0)),
    "dome": Capped(Sphere(2.0), (0.0, 0.5 * np.pi)),
    "bowl": Capped(Sphere(2.0), (-0.5 * np.pi, 0.2)),
    "zone": Capped(Ellipsoid((1.0, 2.0, 1.5)), (-0.4, 1.0)),
    "hyperboloid": Capped(Hyperboloid((1.0, 1.0, 1.0))),
    "paraboloid": Capped(Paraboloid(1.0, 1.0, 1.0)),
    "rod": rod((1, 2, 3), (4, -2, 5), 0.3),
    "mirrored": PlacedSurface(Capped(Frustum()), np.diag([1.0, 1.0, -2.0])),
}

VOLUMES = {
    "cylinder": 3.0 * np.pi,
    "elliptic cylinder": np.pi,
    "cone": 2.0 / 3.0 * np.pi,
    "cone on its apex": 2.0 / 3.0 * np.pi,
    "frustum": 2.0 * np.pi / 3.0 * (1.0 + 0.3 + 0.09),
    "frustum of a cone": np.pi / 4.0 * 26.0 / 3.0,
    "dome": 16.0 / 3.0 * np.pi,
    "paraboloid": 0.5 * np.pi,
    "rod": np.pi * 0.09 * np.linalg.norm([3, -4, 2]),
}


@pytest.mark.parametrize("name", BODIES)
def test_a_body_is_watertight_and_its_triangles_turn_outwards(name):
    mesh = facets(BODIES[name], Within(lambda points: np.full(points.shape[:-1], 4e-3))).mesh
    corners = mesh.corners.reshape(-1, 3)
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    _, uses = np.unique(sides, axis=0, return_counts=True)
    assert (uses == 2).all()
    a, b, c = (mesh.vertices[corners[:, k]] - mesh.vertices.mean(axis=0) for k in range(3))
    volume = dot(a, np.cross(b, c)).sum() / 6.0
    if name == "mirrored":
        volume = -volume
    assert volume > 0.0
    if name in VOLUMES:
        assert volume == pytest.approx(VOLUMES[name], rel=1e-2)


def test_caps_are_flat_up_to_rims_at_which_normals_turn_by_little():
    mesh = facets(BODIES["zone"], Within(lambda points: np.full(points.shape[:-1], 1e-2))).mesh
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    on_top = (corners[..., 2] > mesh.vertices[:, 2].max() - 1e-9).all(axis=1)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert on_top.sum() < 0.3 * len(corners) and sides.min() > 0.02


@pytest.mark.parametrize("name", BODIES)
def test_parts_are_those_of_the_body_and_smooth_up_to_its_rims(name):
    body = BODIES[name]
    parts = smooth_parts(body)
    assert len(parts) == len(creases(body)) + 1
    ends = [(part.surface.domain.v_start, part.surface.domain.v_end) for part in parts]
    assert [low for low, _ in ends[1:]] == [high for _, high in ends[:-1]] == creases(body).tolist()
    for part in parts:
        domain = part.surface.domain
        u, v = (a.ravel() for a in np.meshgrid(*domain.grid(8, 8), indexing="ij"))
        assert part.surface.points(u, v) == pytest.approx(body.points(u, v), abs=1e-12)
        inner = (v > domain.v_start) & (v < domain.v_end)
        assert unit_normals(part.surface, u[inner], v[inner]) == pytest.approx(
            unit_normals(body, u[inner], v[inner]), abs=1e-12
        )
        assert np.isfinite(unit_normals(part.surface, u, v)).all()
    assert [part.is_cap for part in parts].count(True) == len(creases(body))


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_those_of_the_body_however_it_is_placed(name, seed):
    rng = np.random.default_rng(seed)
    body = PlacedSurface(BODIES[name], rng.normal(size=(3, 3)), rng.normal(size=3))
    u, v = (a.ravel() for a in np.meshgrid(*body.domain.grid(360, 120), indexing="ij"))
    points = body.points(u, v)
    low, high = smooth_bounds(body)
    assert (points >= low - 2e-3).all() and (points <= high + 2e-3).all()
    assert np.stack([points.min(axis=0), points.max(axis=0)]) == pytest.approx(np.stack([low, high]), abs=5e-3)


def test_a_part_of_a_body_keeps_the_rims_inside_of_it():
    body = BODIES["cylinder"]
    open_below = TrimmedSurface(body, None, (0.0, body.domain.v_end))
    assert [part.is_cap for part in smooth_parts(open_below)] == [False, True]
    assert creases(open_below).tolist() == [2.0]


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (lambda: Capped(Torus(3.0, 1.0)), "Torus cannot be capped"),
        (lambda: Capped(PlacedSurface(Cylinder(), np.eye(3))), "place it afterwards"),
        (lambda: Capped(BODIES["cylinder"]), "cannot be capped"),
        (lambda: Capped(Sphere(1.0)), "nothing to cap"),
        (lambda: Capped(Cone(1.0, -1.0, 1.0)), "through an apex"),
        (lambda: Capped(Sphere(1.0), (0.0, 2.0)), "leaves the range"),
        (lambda: Capped(Sphere(1.0), (1.0, 0.0)), "is empty"),
        (lambda: Frustum(0.0, 0.0), "the larger radius must be positive"),
        (lambda: Frustum(-1.0, 1.0), "must not be negative"),
        (lambda: Frustum(1.0, 1.0, 0.0), "height must be positive"),
        (lambda: rod((1, 2, 3), (1, 2, 3), 1.0), "the same point"),
        (lambda: rod((1, 2, 3), (1, 2, 4), 0.0), "radius must be positive"),
    ],
)
def test_what_cannot_be_closed_is_said_in_a_line(make, cause):
    with pytest.raises(InputError, match=cause):
        make()


SCENE = """
CAN blue surface cylinder 1 0 2 capped parameter_lines 12 4
HAT red surface cone 1 2 capped translation 3 0 0
POT green surface frustum 1 0.5 1.5 capped translation -3 0 0
DOME yellow surface sphere 1 v 0 90 capped translation 0 3 0
ROD cyan surface rod 0.2 points -4 3 0, -1 4 2
ZONE pink surface ellipsoid 1 0.7 1 capped v -30 45 translation 0 -3 0.5
CUP pink surface frustum radii 0.5 1 height 2 translation 5 -3 0.5
"""


def test_bodies_have_words_and_are_written_with_them():
    scene = parse_scene(SCENE, "a.scene")
    again = parse_scene(write_scene(scene), "b.scene")
    for one, two in zip(scene.items, again.items, strict=True):
        domain = one.shape.domain
        assert two.shape.domain == domain
        u, v = np.meshgrid(*domain.grid(7, 9), indexing="ij")
        assert two.shape.points(u, v) == pytest.approx(one.shape.points(u, v), abs=1e-12)
    told = describe(scene)
    assert told[0] == "CAN: surface (cylinder), 2 caps, 12 + 4 parameter lines, size 2 x 2 x 2, from -1,-1,0 to 1,1,2"
    assert told[1] == "HAT: surface (cone), 1 cap, size 2 x 2 x 2, from 2,-1,0 to 4,1,2"
    assert "closed in u" in told[6]


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("cylinder 1 0 2 capped u 0 90", "a.scene:1: A: 'capped' needs the whole turn, without 'u'"),
        ("sphere 1 capped", "a.scene:1: A: capped: the surface is closed, there is nothing to cap"),
        ("sphere 1 v 0 100 capped", "a.scene:1: A: 'v 0 100' is no part of v -90 to 90 degrees"),
        ("rod 0.2", "a.scene:1: A: rod: expected 'points', got the end of the file"),
        ("frustum 1 -1 2 capped", "a.scene:1: A: frustum: radii must not be negative"),
    ],
)
def test_mistakes_are_said_with_file_and_line(words, cause):
    with pytest.raises(InputError) as error:
        parse_scene(f"A surface {words}", "a.scene")
    assert str(error.value) == cause


@pytest.mark.slow
def test_every_verb_shows_bodies():
    scene = parse_scene("A surface cylinder 1 0 2 capped\nlight L direction -1 -2 3", "a.scene")
    camera = vp.Camera((8, -10, 7), (0, 0, 1))
    kinds = {
        vp.LineKind(int(kind)) for layer in vp.draw(scene, camera).layers for p in layer.strokes for kind in p.kind
    }
    assert kinds == {vp.LineKind.CONTOUR, vp.LineKind.CREASE}
    assert vp.paint(scene, camera).layers
    assert vp.render(scene, camera, size=(60, 40)).pixels.std() > 0.0
