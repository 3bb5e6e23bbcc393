"""Non-convex shapes as unions of convex parts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.geometry.convex_bodies import split_faces
from vectorplot.geometry.convex_polygons import convex_polygon_parts, is_convex_polygon, signed_area
from vectorplot.geometry.solids import has_convex_outline, prism, revolution
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.textbook.polyhedra import body_record, convex_prism_parts, convex_revolution_parts

LETTER = np.array([[0, 0, 0], [4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 3, 0], [4, 3, 0], [4, 4, 0], [0, 4, 0]], dtype=float)


def check(parts, volume):
    assert all(has_convex_outline(part) and is_closed_oriented(part) for part in parts)
    assert sum(body_record(part).volume for part in parts) == pytest.approx(volume, rel=1e-9)
    # Parts of the right volume in all overlap nowhere if no vertex of one lies inside another.
    for one in parts:
        for other in parts:
            if one is other:
                continue
            first = other.vertices[other.corners[other.offsets[:-1]]]
            depth = np.einsum("fk,vfk->vf", other.face_normals, one.vertices.mean(axis=0)[None, None] - first[None])
            assert depth.max() > -1e-9


@pytest.mark.capability("G3.5-split")
def test_a_prism_over_a_letter_is_three_convex_prisms():
    parts = convex_prism_parts(LETTER, [0.5, 0, 2])
    assert len(parts) == 3
    check(parts, body_record(prism(LETTER, [0.5, 0, 2])).volume)
    # Wherever it stands.
    for part, moved in zip(parts, convex_prism_parts(np.add(LETTER, (5, -7, 3)), [0.5, 0, 2]), strict=True):
        assert np.allclose(moved.vertices, np.add(part.vertices, (5, -7, 3)), atol=1e-12)


@pytest.mark.capability("G3.5-split")
@settings(max_examples=examples(40))
@given(st.lists(st.floats(0.2, 2), min_size=4, max_size=14), st.booleans())
def test_areas_of_the_parts_of_a_star_add_up(radii, backwards):
    turn = 2 * np.pi * np.arange(len(radii)) / len(radii)
    star = np.column_stack([np.cos(turn), np.sin(turn)]) * np.array(radii)[:, None]
    parts = convex_polygon_parts(star)
    assert sum(signed_area(star[part]) for part in parts) == pytest.approx(signed_area(star))
    assert all(is_convex_polygon(star[part]) for part in parts)
    base = np.column_stack([star, np.zeros(len(star))])
    check(convex_prism_parts(base[::-1] if backwards else base, [0, 0, 1]), signed_area(star))


WAVES = [[1, 0, 0], [3, 0, 1], [1, 0, 2], [3, 0, 3]]
RING = [[2, 0, 0], [3, 0, 0], [3, 0, 1], [2, 0, 1], [2, 0, 0]]
MUSHROOM = [[0, 0, 0], [1, 0, 0], [1, 0, 2], [3, 0, 1.5], [0, 0, 4]]


@pytest.mark.capability("G3.4-split")
@pytest.mark.parametrize(
    ("meridian", "angle", "count"),
    [(WAVES, 360, 2), (WAVES, 120, 2), (WAVES, 180, 2), (WAVES, 300, None), (RING, 360, 12), (MUSHROOM, 360, None)],
)
def test_parts_of_a_body_of_revolution_are_convex_and_fill_it(meridian, angle, count):
    parts = convex_revolution_parts(meridian, 12, angle_deg=angle)
    check(parts, body_record(revolution(meridian, 12, angle_deg=angle)).volume)
    assert count is None or len(parts) == count


@pytest.mark.capability("G3.4-split")
def test_slices_lie_where_the_meridian_is_hollow():
    lower, upper = convex_revolution_parts(WAVES, 12)
    assert lower.bounds[:, 2].tolist() == [0, 2] and upper.bounds[:, 2].tolist() == [2, 3]


def test_a_convex_body_is_its_own_part():
    (part,) = convex_revolution_parts([[2, 0, -5], [3, 0, -2], [3, 0, 3], [0, 0, 5]], 20)
    assert part.face_count == 61


def test_split_faces_keep_the_rest_and_the_area():
    body = prism(LETTER, [0, 0, 2], caps=("bottom",))
    split = split_faces(body, body.face_sizes > 4)
    assert split.face_count == 8 + 2 * 3 and is_closed_oriented(split)
    assert np.count_nonzero(~split.present) == 3
    assert body_record(split).area == pytest.approx(body_record(body).area)
