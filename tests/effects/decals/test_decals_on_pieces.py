from dataclasses import replace

import numpy as np
import pytest
from support.seen_rays import topmost

from vectorplot.effects.decals import joined_decals, laid, no_decals
from vectorplot.effects.mirrors import mirrors, reflections
from vectorplot.effects.patterns import pattern_decals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import interpenetrating_boxes
from vectorplot.visibility.painter.image_faces import image_points
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import project_faces

SQUARE = np.array([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]])
CAMERA = Camera(eye=(9.0, -12.0, 7.0))


def covered(scene: Scene) -> Scene:
    """The scene with patterns that cover all faces, and smaller ones on them."""
    items = []
    for item in scene.items:
        faces = range(item.mesh.face_count)
        wide = tuple(Pattern(f"W{k}", "white", k, SQUARE) for k in faces)
        small = tuple(Pattern(f"S{k}", "black", k, SQUARE / 40.0) for k in faces)
        items.append(replace(item, patterns=(*wide, *small)))
    return Scene(tuple(items))


@pytest.mark.hard(21)
def test_decals_go_with_the_pieces_that_faces_are_cut_into() -> None:
    scene = covered(interpenetrating_boxes())
    view = look(scene, CAMERA)
    faces = painters_order(view).faces
    decals = pattern_decals(scene, view)
    parts = laid(view, decals, faces.points, faces.offsets, faces.source)
    assert (np.diff(parts.piece) >= 0).all()
    assert (decals.face[parts.decal] == faces.source[parts.piece]).all()
    same = np.diff(parts.piece) == 0
    assert (np.diff(decals.level[parts.decal])[same] >= 0).all()
    # Every piece is wholly covered by the part of the pattern that covers its face.
    low, high = view.image.min(axis=1), view.image.max(axis=1)
    samples = low[:, None] + np.random.default_rng(0).uniform(size=(2, 1000)) * (high - low)[:, None]
    piece = topmost(faces.points, faces.offsets, samples)
    part = topmost(parts.points, parts.offsets, samples)
    assert ((piece >= 0) == (part >= 0)).all()
    assert (parts.piece[part[part >= 0]] == piece[piece >= 0]).all()


def test_decals_are_mirrored_onto_the_doubles_of_their_faces() -> None:
    floor = Mesh.from_polygons([(-6, -6, -3), (6, -6, -3), (6, 6, -3), (-6, 6, -3)], [[0, 1, 2, 3]])
    scene = covered(interpenetrating_boxes())
    scene = Scene((*scene.items, Item("M", floor, material=Material("mirror"))))
    view = look(scene, CAMERA)
    projected = project_faces(view)
    faces = painters_order(view, projected).faces
    planes = mirrors(scene, view, projected)
    seen = reflections(view, planes, faces)
    decals = pattern_decals(scene, view)
    mirrored = replace(decals, points=planes.reflected(0, decals.points))
    parts = laid(view, mirrored, seen.points, seen.offsets, seen.source)
    assert len(parts) >= len(seen) > 0
    for double in range(len(seen)):
        ring = seen.points[:2, seen.offsets[double] : seen.offsets[double + 1]]
        middle = ring.mean(axis=1, keepdims=True)
        mine = [parts.points[:, parts.offsets[k] : parts.offsets[k + 1]] for k in np.flatnonzero(parts.piece == double)]
        assert any(topmost(p, np.array([0, p.shape[1]]), middle)[0] == 0 for p in mine)


@pytest.mark.hard(5)
def test_decals_that_reach_behind_the_eye_end_at_the_near_plane() -> None:
    floor = Mesh.from_polygons([(-6, -60, 0), (6, -60, 0), (6, 60, 0), (-6, 60, 0)], [[0, 1, 2, 3]])
    scene = Scene((Item("F", floor, patterns=(Pattern("P", "red", 0, np.array([(-50.0, -1), (50, -1), (50, 1)])),)),))
    view = look(scene, Camera(eye=(0.0, 0.0, 1.0), target=(0.0, 5.0, 0.0)))
    faces = painters_order(view).faces
    parts = laid(view, pattern_decals(scene, view), faces.points, faces.offsets, faces.source)
    assert len(parts) == 1 and np.isfinite(parts.points).all()
    # Of the band below y = x / 50 what lies before the near plane, which the floor meets along a line of one y.
    away = np.sqrt(26.0)
    near = (view.near * view.scale * away - 1.0) / 5.0
    corners = np.array([(-6.0, near, 0.0), (6.0, near, 0.0), (6.0, 0.12, 0.0), (-6.0, -0.12, 0.0)])
    expected = view.image_of(view.points_of(corners)).T
    found = parts.points[:2].T
    apart = np.abs(found[:, None] - expected).max(axis=2) / np.abs(expected).max(axis=1)
    assert found.shape == (4, 2) and apart.min(axis=0).max() < 1e-9 and apart.min(axis=1).max() < 1e-9
    assert len(laid(view, no_decals(), faces.points, faces.offsets, faces.source)) == 0
    assert len(laid(view, joined_decals(), faces.points, faces.offsets, faces.source)) == 0


def test_uncut_faces_keep_their_decals_as_they_are() -> None:
    scene = covered(Scene(interpenetrating_boxes().items[:1]))
    view = look(scene, CAMERA)
    faces = painters_order(view).faces
    decals = pattern_decals(scene, view)
    parts = laid(view, decals, faces.points, faces.offsets, faces.source)
    for k, decal in enumerate(parts.decal):
        small = decals.points[:, decals.offsets[decal] : decals.offsets[decal + 1]]
        shown = parts.points[:, parts.offsets[k] : parts.offsets[k + 1]]
        assert np.allclose(np.sort(shown[0]), np.sort(image_points(view, small)[0]), atol=1e-8)
