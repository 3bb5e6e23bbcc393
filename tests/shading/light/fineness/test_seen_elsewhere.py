"""Only what mirrors and glass show is as fine as what they show has to be: outlines as they are seen there."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.effects.glass import items_in_glass
from vectorplot.geometry.projections import projection_of
from vectorplot.geometry.winding import face_barycentres
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.prepared_scene import with_face_looks
from vectorplot.scene.page import Page
from vectorplot.scene.placement import allowed_in_space
from vectorplot.shading.facet_resolution import faceted, picture_fineness

CAMERA = vp.Camera((12.0, -6.0, 4.0), (0.0, 0.0, 0.0))
BALL = "BALL red surface sphere 1\n"
WALL = "M gray mirror box solid 0.2 6 6 translation -3 -3 -3\n"
SQUARE = "-3 -3 -3 , -3 3 -3 , -3 3 3 , -3 -3 3"
BESIDE = {
    "seen from behind the ball": "mirror box solid 1 1 1 rotation z 20 translation 4 2.5 -1",
    "turned away from it": "mirror box solid 0.2 3 3 translation 2 -1.5 -1.5",
    "too small to show it": "mirror box solid 0.2 0.3 0.3 translation -3 3 2",
    "an open pane": "mirror vertices 0.5 4 0 , 1.5 4 0 , 1 4 1 faces 1 2 3",
    "glass with nothing behind": "transparent refraction 1.5 box solid 0.2 2 2 translation -3 2 1",
}


def _ball(given, casts=False):
    """What a picture asks of the ball that comes first, and its triangles."""
    scene = parse_scene(given) if isinstance(given, str) else given
    projection = projection_of(CAMERA, scene.bounds)
    allowed = allowed_in_space(scene, projection, Page(80, 60), True, 0.02)
    demand = picture_fineness(scene, projection, casts, allowed, 0.02, items_in_glass(scene, projection))
    return demand(0), faceted(scene, demand).scene.items[0].shape


def _off_outline(mesh, eye):
    """How far sides between triangles that show an eye (3,) their fronts and such that do not are off a ball of the
    radius 1."""
    front = ((eye - face_barycentres(mesh)) * mesh.face_normals).sum(axis=1) > 0.0
    corners = mesh.corners.reshape(-1, 3)
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2)[front].reshape(-1, 2)
    key, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    ends = mesh.vertices[key[count == 1]]
    return 1.0 - np.sqrt((ends.mean(axis=1) ** 2).sum(axis=1)).min()


@pytest.mark.parametrize("name", list(BESIDE))
def test_what_mirrors_and_glass_do_not_show_is_as_coarse_as_without_them(name):
    plain = BESIDE[name].removeprefix("mirror ").removeprefix("transparent refraction 1.5 ")
    alone, with_it = (_ball(f"{BALL}M cyan {what}\n")[1].face_count for what in (plain, BESIDE[name]))
    assert with_it == alone


def test_outlines_are_within_the_tolerance_as_mirrors_show_them_and_in_their_light():
    scene = f"light L position 9 -4 8\n{BALL}{WALL}"
    for casts, sources in ((False, [CAMERA.eye]), (True, [CAMERA.eye, (9.0, -4.0, 8.0)])):
        demand, mesh = _ball(scene, casts)
        _, plain = _ball(scene.replace("mirror ", ""), casts)
        assert len(demand.doubles) == len(sources)
        for x, y, z in sources:
            double = np.array((-5.6 - x, y, z))
            allowed = float(demand.allowed(np.zeros((1, 3)))[0])
            assert _off_outline(mesh, double) < allowed < _off_outline(plain, double)


@pytest.mark.parametrize("casts", [False, True])
def test_three_mirrors_ask_for_outlines_and_not_for_more(casts):
    others = (
        "N gray mirror box solid 6 0.2 6 translation -3 3 -3\nO gray mirror box solid 6 6 0.2 translation -3 -3 -3\n"
    )
    scene = f"light L position 9 -4 8\n{BALL}{WALL}{others}"
    plain, shown = (_ball(text, casts)[1].face_count for text in (scene.replace("mirror ", ""), scene))
    assert plain < shown < 2.5 * plain


PANES = {
    "one": f"vertices {SQUARE} faces 1 2 3 4",
    "halves": f"vertices {SQUARE} faces 1 2 3 , 1 3 4",
    "of a bent sheet": f"vertices {SQUARE} , 0 9 9 faces 1 2 3 4 , 4 3 5",
    "a look": f"vertices {SQUARE} , 0 9 9 faces 1 2 3 4 mirror , 4 3 5",
}


@pytest.mark.parametrize("name", list(PANES))
def test_faces_in_one_plane_are_one_mirror_and_those_that_do_not_shine_are_none(name):
    word = "" if name == "a look" else "mirror "
    scene = with_face_looks(parse_scene(f"{BALL}M gray {word}{PANES[name]}\n"))
    assert len(_ball(scene)[0].doubles) == (2 if name == "of a bent sheet" else 1)


def test_what_very_many_mirrors_show_is_within_the_tolerance_everywhere():
    ring = "revolution meridian 5 0 -3 , 5 0 3 order 40 hollow translation -4 0 0"
    demand, _ = _ball(f"{BALL}M gray mirror {ring}\n")
    assert demand.doubles == () and demand.deep.tolist() == [1.0]


GLASS = "G cyan transparent refraction 1.5 box solid 0.4 2 2 translation {}\n"
SEEN = {
    "behind": ("-3 -1 -1", "1 0 0", False),
    "before": ("2 -1.8 -0.5", "-1 0 0", True),
    "in it": ("-0.2 -1 -1", "0 0 0", True),
}


@pytest.mark.parametrize("name", list(SEEN))
def test_items_are_seen_in_glass_where_rays_through_it_meet_them(name):
    place, centre, shows = SEEN[name]
    scene = parse_scene(f"A red surface sphere 0.3 centre {centre}\n{GLASS.format(place)}")
    found = items_in_glass(scene, projection_of(CAMERA, scene.bounds))
    assert found.tolist() == [shows, True]
