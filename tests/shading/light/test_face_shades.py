from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading import illumination as fading
from vectorplot.shading import shaded_faces as fs
from vectorplot.shading.illumination import AMBIENT, DARK_SIDE, DIRECT_SHARE, FINISHES
from vectorplot.shading.palettes import palette
from vectorplot.testing.shapes import box, rotation, torus_mesh

CAMERA = Camera((6.0, 5.0, 4.0))
LIGHTS = (Light((5.0, -3.0, 8.0)), Light((-2.0, 4.0, 5.0), parallel=True, intensity=0.4))


def scene() -> Scene:
    """Boxes, one of them open, and a torus, of several materials."""
    open_box = Mesh(
        *(getattr(box((-1, 1, 0), (0.2, 2, 1)), name) for name in ("vertices", "corners", "offsets")),
        np.array([1, 0, 1, 1, 1, 1], dtype=bool),
    )
    return Scene(
        (
            Item("box", box((-1, -1, -0.3), (1, 0.5, 1)), "cyan", Material("metallic")),
            Item("crate", open_box, "lightorange", Material("wood")),
            Item("ring", torus_mesh(), "#3060c0", Material("plastic")),
        ),
        LIGHTS,
    )


def shaded(scene: Scene, camera: Camera = CAMERA):
    view = look(scene, camera)
    lights = fs.view_lights(view, scene.lights)
    return view, lights, fs.face_shades(view, scene.items, lights)


def by_hand(scene: Scene, camera: Camera) -> list[float]:
    """The shades of all faces in world coordinates, one after the other."""
    low, high = np.array([scene.vertices @ camera.axes[2]]).min(), (scene.vertices @ camera.axes[2]).max()
    found = []
    eye = np.array(camera.eye)
    for item in scene.items:
        finish = FINISHES[item.material.word]
        present = np.ones(item.mesh.face_count, bool) if item.mesh.present is None else item.mesh.present
        for face, there in zip(item.mesh.polygons(), present, strict=True):
            if not there:
                continue
            corners = item.mesh.vertices[face]
            middle = corners.mean(axis=0)
            normal = sum(
                np.cross(corners[k] - corners[0], corners[k + 1] - corners[0]) for k in range(1, len(face) - 1)
            )
            normal /= np.linalg.norm(normal)
            to_eye = camera.axes[2] if camera.parallel else (eye - middle) / np.linalg.norm(eye - middle)
            normal *= np.sign(normal @ to_eye)
            total = 0.0
            for light in scene.lights:
                ray = np.array(light.position) - (0 if light.parallel else middle)
                ray /= np.linalg.norm(ray)
                cosine = normal @ ray
                share = finish.diffuse * abs(cosine) ** finish.exponent * (1 if cosine > 0 else DARK_SIDE)
                beta = (2 * cosine * normal - ray) @ to_eye
                if finish.highlight and cosine > 0 and beta > 0:
                    share += finish.highlight * finish.weight * beta**finish.sharpness
                total += share * (1 / np.sqrt(2) if light.intensity is None else light.intensity)
            cue = AMBIENT * (middle @ camera.axes[2] - low) / (high - low)
            found.append(DIRECT_SHARE * min(total, 1.0) + cue)
    return found


@pytest.mark.capability("G4.5-face-shades")
@pytest.mark.parametrize("camera", [CAMERA, replace(CAMERA, parallel=True), Camera((-3.0, 1.3, 7.0), twist_deg=20.0)])
def test_face_shades_against_one_face_after_the_other(camera):
    _, _, found = shaded(scene(), camera)
    assert found.shares.shape == (2, len(found)) == found.backlit.shape
    assert np.allclose(found.total, by_hand(scene(), camera), rtol=0, atol=1e-12)
    assert found.total.min() >= 0 and found.total.max() <= 1


@pytest.mark.capability("G4.5-multilight")
def test_each_light_alone_and_all_together():
    given_scene = scene()
    _, _, found = shaded(given_scene)
    for number, light in enumerate(LIGHTS):
        _, _, alone = shaded(replace(given_scene, lights=(replace(light, intensity=found.intensity[number]),)))
        assert np.allclose(found.of_light(number), alone.total, rtol=0, atol=1e-14)
    assert (found.total >= np.maximum(found.of_light(0), found.of_light(1)) - 1e-14).all()
    fitted = found.fitted
    assert (fitted.intensity @ fitted.shares).max() == pytest.approx(1.0)
    assert (fitted.total - fitted.cue).max() == pytest.approx(DIRECT_SHARE)


@pytest.mark.capability("G4.5-darkface")
def test_dark_faces_have_a_flag_for_each_light():
    """Three faces of a cube are seen; the lights stand before, beside and behind it."""
    lights = tuple(Light(p, parallel=True) for p in ((1, 1, 1), (1, -1, -1), (-1, -1, -1)))
    view, _, found = shaded(Scene((Item("box", box((-1, -1, -1), (1, 1, 1))),), lights), Camera((5.0, 6.0, 7.0)))
    outward = (view.axes.T @ fs.face_normals(view)).T
    seen = ~fs.shows_inside(view)
    for axis, flags in ((0, (False, False, True)), (1, (False, True, True)), (2, (False, True, True))):
        face = np.flatnonzero(seen & (outward[:, axis] > 0.9))
        assert found.backlit[:, face].ravel().tolist() == list(flags)


@pytest.mark.capability("G4.5-darkface")
def test_the_inside_of_a_hollow_body_is_lit_if_eye_and_light_are_on_the_same_side():
    open_box = box((-1, -1, -1), (1, 1, 1))
    bottom = Mesh(open_box.vertices, open_box.corners, open_box.offsets, np.array([1, 0, 0, 0, 0, 0], dtype=bool))
    for side, dark in ((1, False), (-1, True)):
        _, _, found = shaded(
            Scene((Item("floor", bottom),), (Light((0.1, 0.2, side), parallel=True),)), Camera((1, 2, 9))
        )
        assert found.backlit.tolist() == [[dark]]


def test_a_scene_without_lights_has_one_at_the_eyes_upper_left():
    view, lights, found = shaded(replace(scene(), lights=()), Camera((3.0, -4.0, 5.0)))
    (light,) = lights
    assert light.parallel and light.position == (-1.0, 1.0, 1.0)
    assert found.intensity.tolist() == [1.0]
    seen = ~fs.shows_inside(view)
    left = fs.face_normals(view)[0] < -0.3
    assert found.total[seen & left].mean() > found.total[seen & ~left].mean()


@pytest.mark.slow
@pytest.mark.hard(18)
@pytest.mark.hard(19)
@given(st.integers(0, 1000), st.sampled_from([1e-6, 1.0, 1e6]), st.sampled_from([0.0, 1e6]))
def test_size_place_and_turn_of_a_scene_change_nothing(seed, scale, offset):
    turn = rotation(np.random.default_rng(seed))
    shift = offset * scale * np.ones(3)

    def moved(point):
        return tuple((scale * turn @ np.asarray(point) + shift).tolist())

    _, _, before = shaded(scene(), replace(CAMERA, up=(0.0, 0.0, 1.0)))
    items = tuple(
        replace(
            item,
            shape=Mesh(
                scale * item.mesh.vertices @ turn.T + shift, item.mesh.corners, item.mesh.offsets, item.mesh.present
            ),
        )
        for item in scene().items
    )
    lights = tuple(
        replace(one, position=tuple((turn @ one.position).tolist()) if one.parallel else moved(one.position))
        for one in LIGHTS
    )
    camera = Camera(moved(CAMERA.eye), moved((0, 0, 0)), up=tuple(turn[:, 2].tolist()))
    _, _, after = shaded(Scene(items, lights), camera)
    assert np.allclose(before.total, after.total, rtol=0, atol=1e-8 if offset else 1e-12)


def test_the_order_of_items_changes_nothing():
    some = scene()
    view, _, found = shaded(some)
    other_view, _, other = shaded(replace(some, items=some.items[::-1]))
    for k, item in enumerate(some.items):
        j = len(some.items) - 1 - k
        assert np.allclose(
            found.total[view.face_item == k], other.total[other_view.face_item == j], rtol=0, atol=1e-14
        ), item


def ball(count: int) -> Mesh:
    """A sphere by meridians and circles, with quads and two caps of triangles."""
    u, v = np.meshgrid(
        np.linspace(0, np.pi, count + 1)[1:-1], np.linspace(0, 2 * np.pi, 2 * count, endpoint=False), indexing="ij"
    )
    ring = np.stack((np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)), axis=-1).reshape(-1, 3)
    n = 2 * count
    poles = np.array([(0.0, 0, 1), (0, 0, -1)])
    faces = [
        [r * n + k, (r + 1) * n + k, (r + 1) * n + (k + 1) % n, r * n + (k + 1) % n]
        for r in range(count - 2)
        for k in range(n)
    ]
    faces += [[len(ring), k, (k + 1) % n] for k in range(n)]
    faces += [[len(ring) + 1, (count - 2) * n + (k + 1) % n, (count - 2) * n + k] for k in range(n)]
    return Mesh.from_polygons(np.concatenate((ring, poles)), faces)


@pytest.mark.capability("G4.5-face-shades")
def test_shades_of_triangles_and_of_polygons_are_those_at_their_barycentres():
    for mesh in (torus_mesh(9, 6), box((0, 0, 0), (1, 2, 3))):
        view, _, _ = shaded(Scene((Item("body", mesh),), LIGHTS))
        means = np.array([mesh.vertices[polygon].mean(axis=0) for polygon in mesh.polygons()])
        assert np.allclose(view.world_of(fs.face_middles(view)), means, atol=1e-12)


@pytest.mark.capability("G8.5-phong")
def test_a_highlight_measured_by_angles_differs_from_vertex_to_vertex():
    measured = replace(FINISHES["plastic"], weight=((0.0, 0.0), (0.6, 0.1), (1.2, 0.6), (1.6, 1.0)))
    angles = np.linspace(0.1, 1.5, 20)
    assert np.array_equal(measured.weight_at(np.cos(angles)), np.sort(measured.weight_at(np.cos(angles))))
    # At the mirror direction the highlight is k2 w(alpha), and nothing else changes from vertex to vertex.
    from vectorplot.shading.illumination import brightness, light_cosines

    normals = np.stack((np.sin(angles / 1.0), np.zeros(20), np.cos(angles)), axis=1)
    lamp = Light((0.0, 0.0, 1.0), parallel=True)
    for normal, angle in zip(normals, angles, strict=True):
        mirrored = 2 * normal[2] * normal - (0, 0, 1)
        share = brightness(*light_cosines(np.zeros((1, 3)), normal[None], (*mirrored.tolist(), 0.0), [lamp]), measured)[
            0, 0
        ]
        expected = measured.diffuse * np.cos(angle) + measured.highlight * measured.weight_at(np.cos(np.array(angle)))
        assert share == pytest.approx(expected, abs=1e-12)


@pytest.mark.capability("G4.5-distance")
def test_light_of_lamps_fades_and_parallel_light_does_not():
    given_scene = Scene(
        (Item("floor", box((-3, -3, -1), (3, 3, 0))), Item("tower", box((-1, -1, 0), (0, 0, 3)))), LIGHTS
    )
    view, lights, found = shaded(given_scene)
    points = fs.face_middles(view)
    assert np.array_equal(fs.faded(view, found, lights, points).shares, found.shares)
    lamps = tuple(replace(light, fading=True) for light in lights)
    faded = fs.faded(view, found, lamps, points)
    assert np.array_equal(faded.shares, fs.face_shades(view, given_scene.items, lamps).shares)
    assert np.array_equal(faded.shares[1], found.shares[1])
    lamp = np.array(LIGHTS[0].position)
    farthest = np.linalg.norm(given_scene.vertices - lamp, axis=1).max()
    nearest = np.linalg.norm(np.clip(lamp, (-1, -1, 0), (0, 0, 3)) - lamp)
    far = np.linalg.norm(view.world_of(points) - lamp, axis=1)
    expected = np.minimum(1.0, max(nearest, 0.25 * farthest) / far) ** 2
    assert np.allclose(faded.shares[0], found.shares[0] * expected, rtol=1e-9) and (expected < 1.0).any()
    # With it what is matt of it, which shadows leave.
    assert np.allclose(faded.matt[0], found.matt[0] * expected, rtol=1e-9)


@pytest.mark.capability("G4.5-distance")
def test_a_fading_lamp_amid_the_scene_lights_what_is_near_and_less_what_is_far():
    things = Scene((Item("floor", box((-3, -3, -1), (3, 3, 0))), Item("tower", box((-1, -1, 0), (0, 0, 3)))))
    for place in ((0.5, 0.5, 0.1), (0.5, 0.5, 2.9), (2.0, 2.0, 2.5)):
        nearest = min(place[2], np.linalg.norm(np.clip(place, (-1, -1, 0), (0, 0, 3)) - place))
        reach = max(nearest, 0.25 * np.linalg.norm(things.vertices - place, axis=1).max())
        view, (lamp,), found = shaded(replace(things, lights=(Light(place, fading=True),)))
        assert fading.lamp_reach(view, lamp) * view.scale == pytest.approx(reach)
        points = fs.face_middles(view)
        far = np.linalg.norm(view.world_of(points) - place, axis=1)
        plain = shaded(replace(things, lights=(Light(place),)))[2]
        assert np.allclose(found.shares[0], plain.shares[0] * np.minimum(1.0, reach / far) ** 2, rtol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_distances_from_triangles_are_those_of_their_nearest_points(seed):
    random = np.random.default_rng(seed)
    points, place = random.normal(size=(3, 30)), random.normal(size=3)
    corners = random.integers(0, 30, (40, 3))
    found = fading._distances(place, points, corners)
    weights = random.dirichlet((0.4, 0.4, 0.4), 20000)
    sampled = np.einsum("wk,ctk->cwt", weights, points[:, corners])
    nearest = np.sqrt(((sampled - place[:, None, None]) ** 2).sum(axis=0)).min(axis=0)
    assert (found <= nearest + 1e-12).all() and np.allclose(found, nearest, atol=0.03)


@pytest.mark.capability("G4.5-depth")
def test_near_faces_are_a_fifth_of_the_palette_brighter():
    posts = Scene(
        tuple(Item(f"post{k}", box((k, 0, 0), (k + 0.5, 1, 1))) for k in range(8)),
        (Light((1.0, 2.0, 3.0), parallel=True),),
    )
    view, _, found = shaded(posts, Camera((40.0, 0.5, 0.5), (0.0, 0.5, 0.5)))
    front = np.flatnonzero(fs.face_normals(view)[2] > 0.99)
    assert np.allclose(found.shares[0, front], found.shares[0, front[0]])
    assert (np.diff(found.total[front]) > 0.01).all()
    assert found.cue.min() >= 0 and found.cue.max() == pytest.approx(AMBIENT)


@pytest.mark.capability("G4.4-depthcue")
def test_depths_count_up_to_limits_that_go_with_the_eyes_distance():
    long = Scene((Item("beam", box((-100, -1, -1), (9.5, 1, 1))),))
    view = look(long, Camera((10.0, 0.0, 0.0)))
    low, high = fs.depth_limits(view)
    world = view.scale * (np.array((low, high)) - view.target[2])
    assert world == pytest.approx((-40.0, 8.0))


def test_colours_are_those_of_the_palettes():
    given_scene = scene()
    view, _, found = shaded(given_scene)
    colours = fs.face_colours(view, given_scene.items, found.total)
    assert colours.shape == (view.face_count, 3) and colours.dtype == np.uint8
    for k, item in enumerate(given_scene.items):
        own = view.face_item == k
        numbers = np.clip(np.floor(found.total[own] * 32 + 0.5), 0, 31).astype(int)
        assert np.array_equal(colours[own], palette(item.colour)[numbers])
    with pytest.raises(InputError, match="nocolour"):
        fs.item_colours([Item("a", box((0, 0, 0), (1, 1, 1)), "nocolour")], np.zeros(1, int), np.ones(1))


def test_points_on_faces_are_shaded_by_their_faces():
    given_scene = scene()
    view, lights, found = shaded(given_scene)
    which = np.array([3, 0, 40])
    again = fs.decal_shades(view, given_scene.items, lights, fs.face_middles(view)[:, which], which)
    assert np.array_equal(again.total, found.total[which])


@pytest.mark.hard(16)
@pytest.mark.hard(55)
def test_nothing_and_faces_without_area_give_no_nan():
    _, _, found = shaded(Scene((), LIGHTS))
    assert len(found) == 0 and found.total.shape == (0,) and found.shares.shape == (2, 0)
    flat = Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [[0, 1, 3], [0, 1, 2]])
    _, _, found = shaded(Scene((Item("flat", flat),), LIGHTS))
    assert np.isfinite(found.total).all()
