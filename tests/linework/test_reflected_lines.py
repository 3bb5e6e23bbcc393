import json

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.effort import several
from support.mirror_rays import Room, missing, nearest, on_page, reflected_strokes, unfounded

import vectorplot as vp
from vectorplot import testing
from vectorplot.backends.json import json_bytes
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.solids import prism
from vectorplot.scene import FaceLook, FaceLooks
from vectorplot.surfaces import Sphere, Torus
from vectorplot.testing.shapes import box

MIRROR = vp.Material("mirror")
CAMERA = vp.Camera((2, -12, 5), (0, 0, 1), fov_deg=40)
SQUARE = vp.Page(120, 120)


def room(*things: vp.Item, lights: tuple[vp.Light, ...] = ()) -> vp.Scene:
    """Things before a mirror in the plane y = 2."""
    return vp.Scene((*things, vp.Item("MIRROR", box((-6, 2, -3), (6, 2.1, 6)), material=MIRROR)), lights)


CUBE = vp.Item("CUBE", box((-0.5, -0.5, 0), (0.5, 0.5, 1)))


def layer(drawing: vp.Drawing, name: str):
    return next(layer for layer in drawing.layers if layer.name == name).strokes[0]


def apart(one: np.ndarray, other: np.ndarray) -> float:
    """How far points of each set are from those of the other one, at most."""
    return max(cKDTree(one).query(other)[0].max(), cKDTree(other).query(one)[0].max())


@pytest.mark.parametrize("seed", several(range(3), long=range(24)))
def test_what_bouncing_rays_see_is_drawn_and_nothing_else(seed):
    assert missing(seed, 2, 40)[0] == 0
    wrong, looked_at = unfounded(seed, 2, 300)
    assert wrong == 0 and looked_at > 250


def test_the_double_of_a_cube_is_as_far_behind_the_mirror():
    drawing = vp.draw(room(CUBE), CAMERA, page=SQUARE, lines="contour,crease", curves="polyline")
    corners = CUBE.mesh.vertices * (1, -1, 1) + (0, 4, 0)
    # One lower corner is hidden by the double, two more by the cube itself.
    places = on_page(drawing, corners)
    segments, items = reflected_strokes(drawing)
    off = nearest(segments[items == 0], places)
    assert (off < 1e-5).sum() >= 5


@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
def test_without_reflections_a_mirror_is_a_plain_face(verb):
    told = {"lines": "contour,crease", "reflections": 0}
    seen = []
    told |= {"size": (60, 40)} if verb is vp.render else {"page": SQUARE}
    scene = room(CUBE)
    verb(scene, CAMERA, **told, explain=lambda report: seen.append(report.name))
    assert not {"reflections", "reflected lines", "mirrors"} & {*seen}
    if verb is vp.draw:
        plain = vp.Scene(tuple(vp.Item(item.name, item.shape) for item in scene.items))
        assert json_bytes(verb(scene, CAMERA, **told)) == json_bytes(verb(plain, CAMERA, **told))


def test_a_scene_without_mirrors_keeps_its_lines_and_stages():
    seen = []
    made = [vp.draw(vp.Scene((CUBE,)), CAMERA, reflections=n, explain=lambda r: seen.append(r.name)) for n in (0, 3)]
    assert json_bytes(made[0]) == json_bytes(made[1])
    assert "reflected lines" not in seen


@pytest.mark.parametrize("wrong", [-1, 9, 1.5, "two", None, float("nan")])
@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
def test_reflections_are_a_small_whole_number(verb, wrong):
    with pytest.raises(InputError, match="reflections"):
        verb(room(CUBE), CAMERA, reflections=wrong)


@pytest.mark.parametrize("lights", [(), (vp.Light((3, -6, 8)),), (vp.Light((1, -2, 1), parallel=True),)])
def test_smooth_things_show_contours_and_isophotes_of_their_doubles_in_doubled_light(lights):
    def things(sign: float) -> tuple[vp.Item, ...]:
        lines = vp.SurfaceLines(isophotes=(sign * 0.2, sign * 0.6))
        ring, ball = vp.Item("RING", Torus(0.8, 0.3), curves=lines), vp.Item("BALL", Sphere(0.5), curves=lines)
        return ring.moved(-1.2, 0, 0.5), ball.moved(1, 0, 0.6)

    # Nothing stands before its double, seen from so high.
    camera = vp.Camera((1, -9, 12), (0, 1, 0), fov_deg=40)
    told = {"page": SQUARE, "fit": False, "curves": "polyline", "lines": "contour,isophote"}
    shown = layer(vp.draw(room(*things(1.0), lights=lights), camera, **told), "reflected")
    flip = np.diag([1.0, -1.0, 1.0, 1.0])
    flip[1, 3] = 4.0
    seen = lights
    if not lights:
        # The light of scenes without any comes from the eye's upper left.
        x, y, z = (np.asarray(camera.axes).T @ (-1.0, 1.0, 1.0)).tolist()
        seen = (vp.Light((x, y, z), parallel=True),)
    doubled = []
    for light in seen:
        x, y, z = light.position
        doubled.append(vp.Light((x, -y if light.parallel else 4 - y, z), parallel=light.parallel))
    # Normals of mirrored surfaces are on their other sides.
    scene = vp.Scene(tuple(item.transformed(flip) for item in things(-1.0)), tuple(doubled))
    alone = vp.draw(scene, camera, **told)
    expected = [ends_of(paths) for one in alone.layers for paths in one.strokes if one.name != "hidden"]
    own = ends_of(shown)[np.repeat(shown.item < 2, np.diff(shown.offsets) - 1 + shown.closed)]
    every = np.concatenate(expected)
    assert nearest(every, own[:, 0]).max() < 0.02 and nearest(own, every[:, 0]).max() < 0.02


def ends_of(paths) -> np.ndarray:
    """(n,2,2) the ends of the segments of strokes."""
    return paths.points[segments(paths)]


def test_hidden_lines_of_a_mirror_are_dashed_inside_of_it():
    drawing = vp.draw(room(CUBE), CAMERA, page=SQUARE, hidden="solid", curves="polyline")
    hidden = layer(drawing, "hidden")
    reflected = hidden.kind == int(vp.LineKind.REFLECTED)
    assert reflected.any() and (hidden.hidden_by[reflected] > 0).all()
    free = vp.draw(room(CUBE), CAMERA, page=SQUARE, curves="polyline")
    assert apart(layer(free, "reflected").points, layer(drawing, "reflected").points) < 1e-3


def test_a_single_face_that_mirrors_shows_what_is_before_it():
    wall = box((-6, 2, -3), (6, 4, 6))
    front = next(k for k in range(6) if np.allclose(wall.face_normals[k], (0, -1, 0)))
    looks = FaceLooks.of(wall, {front: FaceLook(material=MIRROR)})
    scene = vp.Scene((CUBE, vp.Item("WALL", wall, face_looks=looks)))
    one = layer(vp.draw(scene, CAMERA, page=SQUARE, fit=False), "reflected")
    other = layer(vp.draw(room(CUBE), CAMERA, page=SQUARE, fit=False), "reflected")
    assert len(one) and apart(one.points, other.points) < 1e-6


def test_a_hole_in_a_mirror_shows_nothing():
    hole = [(-1, 1), (1, 1), (1, 2.4), (-1, 2.4)]
    around = [(-4, 0, -2), (4, 0, -2), (4, 0, 5), (-4, 0, 5)]
    board = prism(around, (0, 0.1, 0), holes=[[(x, 0, z) for x, z in hole]])
    scene = vp.Scene((CUBE, vp.Item("BOARD", board, material=MIRROR).moved(0, 2, 0)))
    drawing = vp.draw(scene, CAMERA, page=SQUARE, curves="polyline")
    shown = layer(drawing, "reflected")
    corners = on_page(drawing, np.array([(x, 2.0, y) for x, y in hole]))
    low, high = corners.min(axis=0) + 0.5, corners.max(axis=0) - 0.5
    middle = 0.5 * (shown.points[:-1] + shown.points[1:])
    along = np.repeat(np.arange(len(shown)), np.diff(shown.offsets))
    same = along[1:] == along[:-1]
    assert len(shown) and not ((middle > low) & (middle < high)).all(axis=1)[same].any()


def corner_room() -> vp.Scene:
    """A red cube in a corner of two mirrors."""
    walls = (box((-4, 2, -1), (4, 2.1, 5)), box((-4.1, -4, -1), (-4, 2, 5)))
    mirrors = (vp.Item(f"M{k}", wall, "white", MIRROR) for k, wall in enumerate(walls))
    return vp.Scene((vp.Item("RED", box((-2.5, -0.5, 0), (-1, 0.5, 2)), "red"), *mirrors), (vp.Light((9, -9, 12)),))


CORNER = vp.Camera((6, -9, 5), (-2, 0, 1.5), fov_deg=40)


def seen_twice(room: Room, scene: vp.Scene) -> tuple[np.ndarray, np.ndarray]:
    """Points inside the faces of the red cube that are seen by way of both mirrors, and where they seem to be."""
    random = np.random.default_rng(2)
    points = np.asarray(scene.items[0].mesh.vertices)[scene.items[0].mesh.corners.reshape(-1, 4)]
    shares = random.dirichlet(np.full(4, 3.0), 30)
    inner = np.einsum("sk,fkx->fsx", shares, points).reshape(-1, 3)
    facing = [
        k
        for k, normal in enumerate(room.normal)
        if np.abs(normal[1]) > 0.9 and room.base[k][1] == 2.0 and normal[1] < 0
    ]
    side = [k for k, normal in enumerate(room.normal) if normal[0] > 0.9 and room.base[k][0] == -4.0]
    found, images = [], []
    for order in ((facing[0], side[0]), (side[0], facing[0])):
        inside = room.seen(inner, order)
        found.append(inner[inside])
        images.append(room.reflected(order[0], room.reflected(order[1], inner[inside])))
    return np.concatenate(found), np.concatenate(images)


def test_what_two_mirrors_show_is_painted_and_rendered_with_two_reflections():
    scene = corner_room()
    _, images = seen_twice(Room(scene, CORNER), scene)
    assert len(images) > 5
    for count in (1, 2):
        drawing = vp.paint(scene, CORNER, page=SQUARE, reflections=count, shadows="none", smooth=False)
        fills = drawing.layers[0].marks[0]
        red = []
        for place in on_page(drawing, images):
            import shapely

            shapes = [shapely.Polygon(p) for p in np.split(fills.points, fills.offsets[1:-1])]
            over = [k for k, shape in enumerate(shapes) if shape.is_valid and shape.contains(shapely.Point(place))]
            r, g, _ = fills.colours[fills.offsets[over[-1]]].tolist()
            red.append(r > 2 * g)
        assert all(red) if count == 2 else not any(red)
    pixels = [
        vp.render(scene, CORNER, size=(150, 150), reflections=n, samples=1, shadows="none").pixels for n in (1, 2)
    ]
    reds = [int((one[..., 0].astype(int) > 2 * one[..., 1].astype(int)).sum()) for one in pixels]
    assert reds[1] > reds[0] > 0


def test_lines_over_a_painting_are_those_of_the_drawing():
    told = {"page": SQUARE, "fit": False, "lines": "contour,crease", "reflections": 2}
    drawn, painted = (verb(corner_room(), CORNER, **told) for verb in (vp.draw, vp.paint))
    one, other = layer(drawn, "reflected"), layer(painted, "reflected")
    assert len(one) and apart(one.points, other.points) < 1e-6


def test_certificates_say_that_reflected_lines_are_not_proved():
    made = testing.certificate(room(CUBE), vp.draw(room(CUBE), CAMERA), CAMERA)
    assert "strokes of the kind reflected" in made.unproved


def test_a_small_budget_says_that_mirrors_are_left_out():
    places = [(-6, 2.0), (-3, 2.2), (0, 2.4), (3, 2.6)]
    boards = (vp.Item(f"M{x}", box((x, y, 0), (x + 2.9, y + 0.1, 3)), material=MIRROR) for x, y in places)
    with pytest.warns(InputWarning, match="mirrors that are not looked into"):
        vp.draw(vp.Scene((CUBE, *boards)), CAMERA, budget=0.005)


def test_the_json_of_a_reflected_line_names_its_owner():
    strokes = json.loads(json_bytes(vp.draw(room(CUBE), CAMERA)))["strokes"]
    shown = [stroke for stroke in strokes if stroke["kind"] == "reflected"]
    assert {stroke["item"] for stroke in shown} == {"CUBE"}
