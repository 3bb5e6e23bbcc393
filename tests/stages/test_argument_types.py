"""Arguments of a wrong type are one sentence: which one, what was expected, and what came."""

from __future__ import annotations

import inspect

import pytest

import vectorplot as vp
from vectorplot.drawing import travel_mm
from vectorplot.geometry import box

CUBE = box((1, 1, 1))
WRONG = [
    ("hatch", "tone", "hatch: expected a Hatching such as vp.Hatching('tone'), or a Stippling, got 'tone'"),
    ("pens", 0.3, "pens: expected a text such as '0.3' or 'contour=0.5:black', several, a mapping or a Pen, got 0.3"),
    ("pens", {"contour": (1, 2)}, "pen contour=(1, 2): expected WIDTH"),
    ("lines", 3, "lines: expected a text with commas between words, or several words, got 3"),
    ("lines", (3,), "lines: expected a text with commas between words, or several words, got (3,)"),
    ("layers", ("kind", "colour"), "layers: expected a text such as 'kind' or 'kind,colour', got ('kind', 'colour')"),
    ("depth_cue", True, "depth_cue: expected a DepthCue or a text such as 'width', 'shade,8' or 'none', got True"),
    ("dashes", {"hidden": (3, 1)}, "dash hidden=(3, 1): expected a text such as '3,1'"),
    ("dashes", 3.0, "dashes: expected a text such as 'hidden=3,1', several, or a mapping, got 3.0"),
    ("halo_mm", "1", "halo_mm: expected a number, got '1'"),
    ("tolerance_mm", None, "tolerance_mm: expected a number, got None"),
    ("width", (80,), "width: expected a number of mm, or a text with a unit such as '8cm', got (80,)"),
    ("title", 7, "title: expected a text, got 7"),
    ("frame", "yes", "frame: expected True or False, got 'yes'"),
    ("style", 3, "style: expected a Style or a text such as 'book', got 3"),
    ("unplotted", 3, "unplotted: expected a text with commas"),
    ("explain", True, "explain: expected a function, got True"),
    ("aura_mm", "1", "aura_mm: expected a number, got '1'"),
    ("exposure", (1,), "exposure: expected a number or 'fitted', got (1,)"),
]


@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
@pytest.mark.parametrize(("name", "given", "said"), WRONG, ids=lambda value: str(value)[:20])
def test_an_argument_of_a_wrong_type_is_one_sentence(verb, name, given, said):
    if name not in inspect.signature(verb).parameters:
        return
    with pytest.raises(vp.InputError) as told:
        verb(CUBE, **{name: given})
    assert str(told.value).startswith(said)


def test_a_panorama_has_the_same():
    with pytest.raises(vp.InputError, match="pens: expected a text"):
        vp.panorama(CUBE, (0.5, 0.5), pens=0.3)


def test_the_travel_of_the_pen_is_that_of_paths():
    with pytest.raises(vp.InputError, match="travel_mm: expected the Paths of a layer, of its strokes, got a Drawing"):
        travel_mm(vp.draw(CUBE))


def test_what_a_users_function_raises_is_the_cause():
    def fails(x, y):
        raise KeyError("depth")

    with pytest.raises(vp.InputError, match=r"function fails fails at .*KeyError: 'depth'") as told:
        vp.graph(fails)
    assert type(told.value) is vp.InputError and isinstance(told.value.__cause__, KeyError)


def test_vertices_and_faces_of_arrays_are_counted_as_arrays_are():
    with pytest.raises(vp.InputError, match="face 1 names vertex 3, there are 3, counted from 0"):
        vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 1, 3)])


def test_a_name_of_a_layer_that_is_nearly_known_is_guessed():
    with pytest.raises(vp.InputError, match="did you mean 'hidden'"):
        vp.draw(CUBE, unplotted="hiden")
