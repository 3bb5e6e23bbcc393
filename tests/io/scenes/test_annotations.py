"""Axes, dimensions and centre lines in scene files: what the functions of Python make, in all verbs, and mistakes."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.io import parse_scene
from vectorplot.io.scene_words import ANNOTATION_WORDS

A, B, C = (0.0, 0.0, 0.0), (3.0, 4.0, 0.0), (0.0, 0.0, -2.0)
ALIKE = {
    "axes 4 2 3 ticks 1 origin 1 1 1 names u v w size 2": vp.axes(
        (4, 2, 3), ticks=1, origin=(1, 1, 1), names=("u", "v", "w"), size_mm=2
    ),
    "axes 2": vp.axes(2.0),
    'arrow "F" from 0 0 0 to 3 4 0': vp.arrow(A, B, "F"),
    "dimension from 0,0,0 to 3,4,0 offset 0,0,-2 gap 0.5 beyond 1": vp.dimension(A, B, C, gap=0.5, beyond=1),
    'dimension "a" from 0 0 0 to 3 4 0 offset 0 0 -2 size 10pt': vp.dimension(A, B, C, "a", size_mm="10pt"),
    "radius at 0 0 0 to 3 4 0": vp.radius(A, B),
    'diameter "10 H7" at 0 0 0 to 3 4 0': vp.diameter(A, B, "10 H7"),
    "angle at 0 0 0 from 3 4 0 to 0 0 -2 radius 1": vp.angle(A, B, C, 1),
    'leader "hole" at 0 0 0 to 3 4 0': vp.leader(A, B, "hole"),
    "centre_line from 0 0 0 to 3 4 0": vp.centre_line(A, B),
    "centre_mark at 0 0 0 radius 2 axis 3 4 0": vp.centre_mark(A, 2, B),
    "chain_dimension at 0 0 0, 3 4 0, 6 8 0 offset 0 0 -2 gap 0.5 beyond 1": vp.chain_dimension(
        [A, B, (6, 8, 0)], C, gap=0.5, beyond=1
    ),
    "baseline_dimension at 0 0 0, 3 4 0, 6 8 0 offset 0 0 -2 step 1.5": vp.baseline_dimension(
        [A, B, (6, 8, 0)], C, step=1.5
    ),
    "ordinate_dimension at 0 0 0, 3 4 0, 6 8 0 offset 0 0 -2 apart 6 size 2": vp.ordinate_dimension(
        [A, B, (6, 8, 0)], C, apart=6, size_mm=2
    ),
    'chamfer "<> x 45" from 0 0 2 to 2 0 0 at 5 0 5': vp.chamfer((0, 0, 2), (2, 0, 0), (5, 0, 5), "<> x 45"),
    "thread from 0 0 0 to 3 4 0 radius 2": vp.thread(A, B, 2),
    "threaded_hole from 0 0 0 to 3 4 0 radius 2": vp.threaded_hole(A, B, 2),
}


@pytest.mark.parametrize("text", ALIKE)
def test_a_word_is_what_its_function_is(text):
    found, expected = parse_scene(f"BALL red surface sphere radius 2 {text} BOX red box solid 1 1 1"), ALIKE[text]
    assert [item.name for item in found.items[:2]] == ["BALL", "BOX"]
    assert found.labels == expected.labels
    for item, other in zip(found.items[2:], expected.items, strict=True):
        assert (item.name, item.lines, item.group) == (other.name, other.lines, other.group)
        ends = np.array([item.shape.start, item.shape.end])
        assert np.allclose(item.shape.points(ends), other.shape.points(ends))


def test_every_word_is_tried():
    assert {text.split()[0] for text in ALIKE} == set(ANNOTATION_WORDS)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("dimension from 0 0 0 to 1 0 0", "expected 'offset', got the end of the file"),
        ("dimension from 0 0 0 from 1 0 0", "a second 'from'"),
        ("dimension from 0 0 0 to 1 0 0 ofset 0 1 0", r"unknown word 'ofset' \(did you mean 'offset'\?\)"),
        ("dimension from 0 0 0 to 0 0 0 offset 0 1 0", "two different points"),
        ("dimension from 0 0 0 to 1 0 0 offset 0 1 0 gap 3", "a gap before"),
        ("leader at 0 0 0 to 1 0 0", "expected a text in quotes, got 'at'"),
        ("radius at 1 1 1 to 1 1 1", "two different points"),
        ("axes 0", "one positive length"),
        ("angle at 0 0 0 from 1 0 0 to 2 0 0 radius 1", "not in one line"),
        ("centre_mark at 0 0 0 radius 0", "a positive radius"),
        ("chain_dimension at 0 0 0 offset 0 0 -2", "two points or more"),
        ("chain_dimension at 0 0 0, 0 0 -1 offset 0 0 -2", "in line with the offset"),
        ("chain_dimension at 0 0 0, 1 0 -3 offset 0 0 -2", "beyond the dimension line"),
        ("baseline_dimension at 0 0 0, 1 0 0 offset 0 0 -2 step 0", "a step of 0"),
        ("ordinate_dimension at 0 0 0, 1 0 0 offset 0 0 -2 apart -1", "-1 apart"),
        ("chamfer from 0 0 0 to 1 1 1 at 5 5 5", "slopes along two"),
        ("thread from 0 0 0 to 0 0 5 radius 0", "a positive radius"),
        ("measures", "expected decimals, zeros or comma"),
        ("measures decimals 12", "expected 0 to 9"),
        ("measures zeros zeros", "a second 'zeros'"),
        ("arrow from 0 0 to 1 0 0", "expected a number for from"),
    ],
)
def test_mistakes_are_told_with_their_line(text, cause):
    with pytest.raises(vp.InputError, match=r"file:2: \w+: .*" + cause):
        parse_scene(f"BALL red surface sphere 2\n{text}", "file")


SOLID = "BOX gray box solid 10 10 10\ncentre_line from 5 5 -4 to 5 5 14\ndimension from 0 0 0 to 10 0 0 offset 0 0 -3\n"
CAMERA = vp.Camera((30, -50, 30), target=(5, 5, 5), parallel=True)


def centre_strokes(drawing):
    return np.concatenate(
        [paths.points3d for layer in drawing.layers if layer.name == "centre" for paths in layer.strokes]
    )


@pytest.mark.slow
@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
@pytest.mark.parametrize(
    "body", ["", "CAN red surface rod 2 points 5 5 5 5 5 9\n", "EGG red surface sphere 3 translation 5 5 5\n"]
)
def test_nothing_hides_a_centre_line_and_it_is_dashed_with_dots(verb, body):
    found = verb(parse_scene(SOLID + body), CAMERA, tolerance_mm=1.0)
    places = centre_strokes(found)
    assert np.isclose(places[:, 2].min(), -4.0) and np.isclose(places[:, 2].max(), 14.0)
    (paths,) = [paths for layer in found.layers if layer.name == "centre" for paths in layer.strokes]
    lengths = np.array([np.hypot(*np.ptp(part, axis=0)) for part in np.split(paths.points, paths.offsets[1:-1])])
    dots, dashes = lengths[lengths < 1.0], lengths[lengths > 1.0]
    assert len(dashes) == len(dots) + 1 and np.ptp(dots) < 1e-6
    assert (paths.hidden_by == 0).all()


def test_paint_and_render_show_annotations_and_make_room_for_them():
    told = parse_scene(SOLID)
    found = vp.paint(told, CAMERA)
    kinds = {int(kind) for layer in found.layers for paths in layer.strokes for kind in paths.kind}
    assert kinds == {int(vp.LineKind.LABEL), int(vp.LineKind.CENTRE)}
    points = np.concatenate([paths.points for layer in found.layers for paths in layer.strokes])
    assert (points >= 0).all() and (points <= (found.width_mm, found.height_mm)).all()
    pixels = vp.render(told, CAMERA, size=(160, 120), background="#ffffff").pixels
    dark = pixels.max(axis=2) < 200
    rows = np.flatnonzero(dark.any(axis=1))
    # The centre line reaches from above the body to the dimension line below it.
    assert rows[0] < 10 and rows[-1] > 110 and dark[rows[0] + 2].sum() < 4


def test_files_that_are_written_have_them_too(tmp_path):
    scene = parse_scene(SOLID)
    vp.save(scene, tmp_path / "again.scene")
    again = vp.read(tmp_path / "again.scene")
    assert [(item.name, item.lines, item.group) for item in again.items] == [
        (item.name, item.lines, item.group) for item in scene.items
    ]
    assert again.labels == scene.labels
