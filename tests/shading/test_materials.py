"""What the words of materials change in painted and rendered pictures, from scene files."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.backends.raster import painted
from vectorplot.cli.options import ItemMaterial, LineOptions
from vectorplot.errors import InputError
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.save import write
from vectorplot.scene.material import FINISH_WORDS
from vectorplot.scene.view import look
from vectorplot.shading.illumination import Finish, finish_of
from vectorplot.shading.palettes import palette
from vectorplot.shading.shaded_faces import face_normals, face_shades, view_eye, view_lights
from vectorplot.words import PALETTES

WORDS = ("normal", "metallic", "shiny", "mat", "wood", "plastic", "transparent", "mirror")
SAME = {"reflecting": "shiny", "matte": "mat"}
FIG_18 = ("plastic", "metallic", "wood", "normal")

SCENE = """camera eye 1 -10 4 field_of_vision 26
light LAMP direction -3 -4 4 intensity 1
BEHIND green box 3 0.2 3 translation -1.5 1.4 -1.5
BODY orange {word} {body}
"""
BODIES = {
    "a smooth body of revolution": 'surface revolution curve "0.75 + 0.3*sin(1.7*t)" "0" "t" t -1.6 1.6',
    "a body of revolution": "revolution meridian 0.1 0 -1.5, 1 0 -1.2, 0.8 0 0, 1.1 0 0.9, 0.3 0 1.4 order 16",
    "a box": "box 1.4 1.4 1.4 translation -0.7 -0.7 -0.7",
}


@cache
def picture(verb: str, word: str, body: str) -> np.ndarray:
    """(rows, columns, 3) what a verb shows of a scene with a body of this material."""
    scene = parse_scene(SCENE.format(word=word, body=BODIES[body]))
    if verb == "render":
        return vp.render(scene, size=(64, 48), samples=1, shadows="none").pixels.astype(int)
    drawing = vp.paint(scene, page=vp.Page(96, 72, 2), tolerance_mm=0.2)
    return painted(np.full((144, 192, 3), 255, dtype=np.uint8), drawing).astype(int)


@pytest.mark.slow
@pytest.mark.capability("G3.L-physical")
@pytest.mark.parametrize(
    ("verb", "body"),
    [
        ("paint", "a body of revolution"),
        ("paint", "a box"),
        ("render", "a smooth body of revolution"),
        ("render", "a box"),
    ],
)
def test_every_word_for_a_material_changes_the_shading(verb, body):
    found = {word: picture(verb, word, body) for word in WORDS}
    for number, one in enumerate(WORDS):
        for other in WORDS[number + 1 :]:
            # These two differ in the size of a highlight, which a few flat faces may not have.
            if {one, other} == {"plastic", "shiny"} and "smooth" not in body:
                continue
            assert (np.abs(found[one] - found[other]).max(axis=2) > 2).mean() > 0.002, (one, other)
    for word, meant in SAME.items():
        assert np.array_equal(picture(verb, word, body), found[meant])


@pytest.mark.capability("G3.L-physical")
@pytest.mark.parametrize("verb", ["paint", "render"])
def test_what_is_behind_is_seen_through_transparent_things_only(verb):
    body = "a box"
    hidden = {}
    for word in WORDS[:-1]:
        seen = []
        for colour in ("green", "blue"):
            text = SCENE.replace("BEHIND green", f"BEHIND {colour}")
            scene = parse_scene(text.format(word=word, body=BODIES[body]))
            scene = vp.Scene(scene.items, (), scene.camera)
            if verb == "render":
                pixels = vp.render(scene, size=(80, 60), samples=1).pixels
            else:
                pixels = painted(np.full((60, 80, 3), 255, np.uint8), vp.paint(scene, page=vp.Page(80, 60, 2)))
            seen.append(pixels[29:32, 39:42].astype(int))
        hidden[word] = np.abs(seen[0] - seen[1]).max() < 3
    assert hidden == {word: word != "transparent" for word in WORDS[:-1]}


@pytest.mark.slow
@pytest.mark.capability("G8.5-fig18")
@pytest.mark.parametrize(
    ("verb", "body"), [("paint", "a body of revolution"), ("render", "a smooth body of revolution")]
)
def test_plastic_metal_wood_and_normal_differ_as_their_laws_say(verb, body):
    found = {word: picture(verb, word, body) for word in FIG_18}
    shown = np.abs(found["normal"] - picture(verb, "transparent", body)).max(axis=2) > 6
    levels = {word: one.sum(axis=2)[shown] for word, one in found.items()}
    for number, one in enumerate(FIG_18):
        for other in FIG_18[number + 1 :]:
            assert np.abs(levels[one] - levels[other]).mean() > 6, (one, other)
    # The smaller the exponent of the cosine, the more even; a highlight is small, and brighter than its surroundings.
    assert np.std(levels["wood"]) < np.std(levels["normal"])
    assert np.median(levels["metallic"]) < np.median(levels["wood"])
    assert (levels["plastic"] > np.quantile(levels["plastic"], 0.5) + 150).mean() < 0.35
    assert levels["plastic"].mean() < levels["normal"].mean()


@pytest.mark.capability("G3.L-light-dark", "G3.L-colour")
@pytest.mark.parametrize(("verb", "name"), [*(("paint", name) for name in PALETTES), ("render", "magenta")])
def test_a_light_or_dark_colour_has_the_upper_or_lower_half_of_its_palette(verb, name):
    parent = palette(name, 256).astype(int)
    for word, part in (("", parent), ("light", parent[127:]), ("dark", parent[:129])):
        scene = parse_scene(f"camera eye 4 -7 5 light L position 3 -6 8 BODY {word}{name} {BODIES['a box']}")
        if verb == "render":
            shown = vp.render(scene, size=(40, 30), samples=1).pixels.reshape(-1, 3).astype(int)
            shown = shown[(shown != 255).any(axis=1)]
        else:
            shown = vp.paint(scene).layers[0].fills[0].colours.astype(int)
        assert len(shown) > 5 and len(np.unique(shown, axis=0)) >= 3
        # Every colour of the picture is one of that part of the ramp, to the rounding of its shade.
        off = np.abs(shown[:, None] - part).max(axis=2).min(axis=1)
        assert off.max() <= 4, (word, off.max())


OWN = "exponent 1.5 diffuse 0.6 highlight 2 sharpness 12"


@pytest.mark.capability("G4.5-material", "G8.5-phong")
@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("wood exponent 3", Finish(3.0, 0.9)),
        ("material metallic diffuse 0 highlight 1 sharpness 5", Finish(2.0, 0.0, 1.0, 5.0)),
        ("normal sharpness 32", Finish(1.0, 1.0, 5.0, 32.0)),
        ("shiny highlight 3", Finish(1.0, 0.5, 3.0, 8.0)),
        ("mirror sharpness 0.5", Finish(1.0, 0.2, 0.0, 0.5)),
        (OWN.join(("plastic ", "")), Finish(1.5, 0.6, 2.0, 12.0)),
    ],
)
def test_numbers_stand_for_those_of_the_word(said, expected):
    scene = parse_scene(f"A orange {said} box 1 1 1")
    found = finish_of(scene.items[0].material)
    assert [getattr(found, name) for name in FINISH_WORDS] == pytest.approx(
        [getattr(expected, name) for name in FINISH_WORDS], rel=1e-15
    )
    assert parse_scene(write_scene(scene)).items[0].material == scene.items[0].material


@pytest.mark.capability("G4.5-material", "G8.5-phong")
@pytest.mark.parametrize(
    "verb", [vp.paint, partial(vp.render, size=(40, 30), samples=1), partial(vp.draw, hatch=vp.Hatching("tone", 0.7))]
)
def test_numbers_of_materials_are_the_same_by_word_command_and_python_in_every_verb(verb):
    scene = parse_scene("light L direction -1 -2 3 intensity 0.9\nA orange wood surface sphere 1\nB blue box 1 1 2")
    by_word = parse_scene(write_scene(scene).replace("wood", f"wood {OWN}"))
    numbers = dict(zip(OWN.split()[::2], map(float, OWN.split()[1::2]), strict=True))
    first = replace(scene.items[0], material=vp.Material("wood", **numbers))
    in_python = replace(scene, items=(first, *scene.items[1:]))
    option = "A=wood," + ",".join(f"{name}={value}" for name, value in numbers.items())
    by_command = LineOptions(materials=(ItemMaterial.read(option),)).with_materials(scene)
    assert by_word.items[0].material == by_command.items[0].material == in_python.items[0].material
    bytes_of = [_contents(verb(one)) for one in (scene, by_word, by_command, in_python)]
    assert bytes_of[0] != bytes_of[1] and bytes_of[1] == bytes_of[2] == bytes_of[3]


def _contents(made):
    return made.pixels.tobytes() if hasattr(made, "pixels") else write(made, "svg")


@pytest.mark.capability("G4.5-material", "G8.5-phong")
@pytest.mark.parametrize("exponent", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("sharpness", [1.5, 20.0])
def test_painted_shades_follow_the_law_with_the_numbers_of_the_material(exponent, sharpness):
    k1, k2 = 0.7, 2.5
    material = vp.Material("wood", exponent=exponent, diffuse=k1, highlight=k2, sharpness=sharpness)
    body = "A orange convex vertices 0 0 0, 3 0 1, 1 2 0, 0 1 3 faces 1 2 3, 1 2 4, 2 3 4, 3 1 4"
    item = replace(parse_scene(body).items[0], material=material)
    view = look(vp.Scene((item,)), vp.Camera((2.0, 1.0, 3.0), parallel=True))
    lights = view_lights(view, [vp.Light((0.3, 0.5, 1.0), parallel=True, intensity=1.0)])
    found = face_shades(view, (item,), lights).shares[0]
    to_eye, to_light = (np.array(v) / np.linalg.norm(v) for v in (view_eye(view)[:3], lights[0].position))
    normals = face_normals(view).T
    normals = np.where((normals @ to_eye)[:, None] < 0, -normals, normals)
    alpha = normals @ to_light
    beta = np.maximum((2 * alpha[:, None] * normals - to_light) @ to_eye, 0) * (alpha > 0)
    lit = np.where(alpha > 0, 1.0, 0.3) * np.abs(alpha) ** exponent
    assert np.allclose(found, k1 * lit + k2 * 0.1 * beta**sharpness, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("said", "cause"),
    [
        ("wood exponent 0", "exponent 0: expected a positive"),
        ("wood diffuse -1", "diffuse -1: expected 0 or a positive"),
        ("wood sharpness 2 sharpness 3", "a second sharpness"),
    ],
)
def test_numbers_out_of_range_are_named(said, cause):
    with pytest.raises(InputError, match=cause):
        parse_scene(f"A {said} box 1 1 1")


def test_items_may_be_called_as_the_numbers_of_materials():
    scene = parse_scene("A wood box 1 1 1\nsharpness blue box 1 1 2\ndiffuse wood exponent 2 box 1 1 3")
    assert [item.name for item in scene.items] == ["A", "sharpness", "diffuse"]
    assert scene.items[2].material.exponent == 2.0
