"""Only what mirrors show is as fine as what they show has to be."""

import pytest

import vectorplot as vp
from vectorplot.io.scene_language import parse_scene

CAMERA = vp.Camera((12.0, -6.0, 4.0), (0.0, 0.0, 0.0))
BALL = "BALL red surface sphere 1\n"
MIRRORS = {
    "beside, seen from behind the ball": ("box solid 1 1 1 rotation z 20 translation 4 2.5 -1", False),
    "turned away from it": ("box solid 0.2 3 3 translation 2 -1.5 -1.5", False),
    "behind it": ("box solid 0.2 6 6 translation -3 -3 -3", True),
    "below it": ("box solid 8 8 0.2 translation -4 -4 -2", True),
}


def _triangles(text, lights=()):
    counts = {}
    vp.paint(
        parse_scene(text), CAMERA, page="80x60", lights=lights, explain=lambda one: counts.setdefault(one.name, one)
    )
    return counts["look"].count


@pytest.mark.parametrize("name", list(MIRRORS))
def test_items_are_fine_where_the_mirror_shows_them(name):
    mirror, shows = MIRRORS[name]
    alone = _triangles(f"{BALL}M cyan box {mirror.removeprefix('box ')}\n")
    with_mirror = _triangles(f"{BALL}M cyan mirror {mirror}\n")
    assert (with_mirror > 1.5 * alone) == shows, (alone, with_mirror)


def test_what_the_light_of_a_mirror_falls_on_is_fine():
    lamp = [vp.Light((3.0, -2.0, 9.0))]
    wall = "M cyan{} box solid 0.2 3 3 translation -2 -1.5 -1.5\n"
    plain, shining = (_triangles(BALL + wall.format(word), lamp) for word in ("", " mirror"))
    assert shining > 1.5 * plain
