"""Trapezoids and their maps: the test values of both papers, and what holds for any frustum."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.effort import several

from vectorplot.errors import InputError
from vectorplot.shading.shadow_maps import four_by_four
from vectorplot.shading.trapezoids import (
    Axis,
    adapted_size,
    focus_area,
    focus_distance,
    line_of_sight,
    projective_images,
    searched_line,
    taper_of_focus,
    tapered_map,
)
from vectorplot.textbook.trapezoid_maps import (
    LARGEST_ETA,
    bounding_trapezoid,
    column_major,
    depth_row,
    eta_of_focus,
    quadrilateral_map,
    recipe_factors,
    recipe_map,
    recipe_matrix,
    rectangle,
    side_directions,
    square_map,
    trapezoid,
    widths,
)

STEPS = several(2001, long=4001)
"""Of an eye that turns past a lamp."""

SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=np.float64)
HULL = np.array([(1, 0), (2.5, -0.5), (9, 1), (10, 6), (3, 3.5), (0.8, 1.5)])
AXIS = line_of_sight(HULL, (1.4, 0.6), (9, 4))
RECIPE = np.array([(-3, 0), (5, 1), (2, 4), (-1, 3.625)])
CLOSE = {"rtol": 0.0, "atol": 1e-12}


def area(p):
    after = np.roll(p, -1, axis=0)
    return (p[:, 0] * after[:, 1] - p[:, 1] * after[:, 0]).sum() / 2.0


def scaled(matrix):
    return matrix / matrix[2, 2]


@pytest.mark.capability("N4-matrix", "N7-test")
def test_the_first_sample_call_of_the_notes():
    found = square_map([(2, 1), (4, 0), (7, 1), (0, 4.5)])
    exact = np.array([(9, -2, -26), (9, 18, -46), (5, 10, -10)]) / 35.0
    assert np.allclose(found.matrix, exact, **CLOSE), "TV54"
    assert found.shift == pytest.approx(2.0 / np.sqrt(5.0), abs=1e-12)
    assert found.stretch == pytest.approx(0.8, abs=1e-12)
    assert np.allclose(projective_images(found.matrix, [(2, 1), (4, 0), (7, 1), (0, 4.5)]), SQUARE, **CLOSE), "TV55"
    assert np.allclose(projective_images(found.matrix, (3, 1.5)), (-0.1, 0.4), **CLOSE), "TV56"


@pytest.mark.capability("N5-rect-matrix", "N7-test")
@pytest.mark.hard(34)
def test_the_second_sample_call_of_the_notes_is_a_rectangle():
    corners = np.array([(1, 1), (3, 2), (2, 4), (0, 3)], dtype=np.float64)
    found = square_map(corners)
    assert np.allclose(found.matrix, [(0.8, 0.4, -2.2), (-0.4, 0.8, -1.4), (0, 0, 1)], **CLOSE), "TV57"
    assert np.allclose(projective_images(found.matrix, (1.5, 2)), (-0.2, -0.4), **CLOSE)
    for slant in (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-5):
        near = corners + np.array([(0, 0), (0, 0), (slant, 0), (-slant, 0)])
        matrix = square_map(near).matrix
        assert np.isfinite(matrix).all()
        assert np.abs(projective_images(matrix, near) - SQUARE).max() < 2e-4, "affine, or all but"


@pytest.mark.capability("N2-axis", "N2-topbase", "N2-eta")
def test_the_trapezoid_of_a_hull():
    assert np.hypot(*AXIS.direction) == pytest.approx(1.0, abs=1e-15)
    focus = 3.0 - AXIS.top
    found = (AXIS.top, AXIS.base, AXIS.length, focus, eta_of_focus(AXIS.length, focus))
    expected = (-0.610146936792921, 10.0554136906109, 10.6655606274038, 3.61014693679292, 1.56448118908306)
    assert np.allclose(found, expected, rtol=0.0, atol=1e-12), "TV58"
    inner = line_of_sight(np.concatenate([HULL, [(5, 2), (6, 3)]]), (1.4, 0.6), (9, 4))
    assert (inner.top, inner.base) == (AXIS.top, AXIS.base), "hull points, or all of them"


@pytest.mark.capability("N2-corners", "N2-sides")
def test_the_corners_of_the_trapezoid():
    eta = eta_of_focus(AXIS.length, 3.0 - AXIS.top)
    corners = trapezoid(HULL, AXIS, eta)
    expected = [
        (0.501400299258957, 1.11451697812704),
        (1.18321118417435, -0.409530882272069),
        (13.2379376630731, -1.23774301157519),
        (7.90800740143901, 10.6762187497246),
    ]
    assert np.allclose(corners, expected, rtol=0.0, atol=1e-12), "TV59"
    assert area(corners) > 0.0, "counter-clockwise"
    matrix = scaled(square_map(corners).matrix)
    tv60 = [
        (1.17743557809319, -2.62374692065037, -0.066908198878958),
        (1.81169169202679, 0.810493651696195, -4.21244382906505),
        (1.40075213703826, 0.626652271832905, 1),
    ]
    assert np.allclose(matrix, tv60, rtol=0.0, atol=1e-12), "TV60"
    focus = projective_images(matrix, AXIS.origin + 3.0 * AXIS.direction)
    assert np.allclose(focus, (0.0021736175159055, 0.6), rtol=0.0, atol=1e-12), "TV61"
    assert np.abs(projective_images(matrix, HULL)).max() <= 1.0 + 1e-12
    left, right = side_directions(HULL, AXIS, eta)
    assert AXIS.left @ left > AXIS.left @ right


@pytest.mark.capability("N3-rectangle")
def test_the_rectangle_of_the_same_hull():
    assert np.allclose(widths(HULL, AXIS), (1.99378723440206, -2.73845475568476), rtol=0.0, atol=1e-12), "TV62"
    corners = rectangle(HULL, AXIS)
    assert area(corners) > 0.0
    inside = projective_images(quadrilateral_map(corners), HULL)
    assert np.abs(inside).max() <= 1.0 + 1e-12
    focus = 0.8 * AXIS.length
    assert np.allclose(bounding_trapezoid(HULL, AXIS, focus), corners), "at the pole"
    assert np.allclose(bounding_trapezoid(HULL, AXIS, 0.999999 * focus), corners), "just before it"
    assert eta_of_focus(AXIS.length, focus) == np.inf
    assert eta_of_focus(AXIS.length, 0.9999 * focus) > LARGEST_ETA * AXIS.length


@pytest.mark.capability("R-matrices", "R-code", "R-gl4x4")
def test_the_recipe_as_eight_matrices_and_as_three_rows():
    factors = recipe_factors(RECIPE)
    assert len(factors) == 8
    product = recipe_matrix(RECIPE)
    # Step by step: the middle of the top line goes to the origin, the line along x, the meeting point to the origin.
    far_corners = np.column_stack([RECIPE, np.ones((4, 2))])
    assert np.allclose(factors[0] @ (far_corners[2] + far_corners[3]) / 2.0, (0, 0, 1, 1), atol=1e-14)
    turned = far_corners @ (factors[1] @ factors[0]).T
    assert turned[2, 1] == pytest.approx(turned[3, 1], abs=1e-14) and turned[2, 0] == pytest.approx(-turned[3, 0])
    assert np.allclose(np.linalg.multi_dot(factors[::-1]), product, atol=1e-13)
    rows = product[np.ix_([0, 1, 3], [0, 1, 3])]
    tv63 = [
        (0.654320987654321, 0.0987654320987653, -0.703703703703703),
        (-0.135802469135802, 1.08641975308642, -3.07407407407407),
        (0.0617283950617284, -0.493827160493827, 2.85185185185185),
    ]
    assert np.allclose(rows, tv63, rtol=0.0, atol=1e-12), "TV63"
    image = product @ (1, 2, 1, 1)
    tv64 = (0.0769230769230771, -0.538461538461539, 0.519230769230769)
    assert np.allclose(image[:3] / image[3], tv64, **CLOSE), "TV64"
    fast = recipe_map(RECIPE)
    assert np.allclose(fast / fast[2, 2], rows / rows[2, 2], **CLOSE)
    assert np.allclose(projective_images(fast, RECIPE), SQUARE, **CLOSE)
    gl = column_major(fast).reshape(4, 4).T
    assert np.allclose(gl @ (1, 2, 7, 1), (*(fast[:2] @ (1, 2, 1)), 7, fast[2] @ (1, 2, 1)), **CLOSE)
    with pytest.raises(InputError, match="parallel"):
        recipe_map([(0, 0), (2, 0), (2, 1), (0, 1)])


def test_both_papers_differ_by_half_a_turn():
    notes = square_map(RECIPE[[2, 3, 0, 1]]).matrix
    assert np.allclose(scaled(np.diag([-1, -1, 1]) @ notes), scaled(recipe_map(RECIPE)), **CLOSE)


@pytest.mark.capability("R-quad")
@given(st.integers(0, 2**32 - 1))
def test_any_convex_quadrilateral_becomes_the_square(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 4))
    if np.diff(angle).min() < 0.05 or angle[3] - angle[0] > 2.0 * np.pi - 0.05:
        return
    corners = rng.uniform(-9, 9, 2) + rng.uniform(0.1, 9) * np.stack([np.cos(angle), 0.7 * np.sin(angle)], axis=1)
    assert np.abs(projective_images(quadrilateral_map(corners), corners) - SQUARE).max() < 1e-9


@given(st.integers(0, 2**32 - 1))
def test_every_way_gives_the_same_map_of_a_trapezoid(seed):
    rng = np.random.default_rng(seed)
    top, base = np.sort(rng.uniform(0.2, 4.0, 2))
    base += 0.1
    corners = np.array([(0, 0), (top, 0), (0, 0), (0, 0)], dtype=np.float64)
    left, height = rng.uniform(-3, 3), rng.uniform(0.3, 4)
    corners[2], corners[3] = (left + base, height), (left, height)
    angle = rng.uniform(0, 7)
    turn = np.array([(np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))])
    corners = corners @ turn.T + rng.uniform(-5, 5, 2)
    inner = rng.dirichlet(np.ones(4), 20) @ corners
    images = [
        projective_images(square_map(corners).matrix, inner),
        projective_images(quadrilateral_map(corners), inner),
        -projective_images(recipe_map(corners[[2, 3, 0, 1]]), inner),
        # A base shorter than the top line, where the printed branch would leave the square (erratum N-05).
        -projective_images(square_map(corners[[2, 3, 0, 1]]).matrix, inner),
    ]
    for image in images[1:]:
        assert np.abs(image - images[0]).max() < 1e-7


def random_frustum(seed):
    """Images of the corners of a frustum, of the centres of its near and far plane, and of its focus plane."""
    rng = np.random.default_rng(seed)
    near, far, half = 1.0, rng.uniform(3, 60), rng.uniform(0.1, 0.8)
    z = np.array([near, far])[:, None]
    corners = np.stack(
        [np.concatenate([[sx * half * d, sy * half * 0.7 * d, d] for sx in (-1, 1) for sy in (-1, 1)]).reshape(4, 3)
         for d in z[:, 0]]
    ).reshape(8, 3)  # fmt: skip
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    image = corners @ turn[:, :2]
    axis = np.array([(0, 0, near), (0, 0, far), (0, 0, near + rng.uniform(0.1, 0.6) * (far - near))]) @ turn[:, :2]
    return image, axis


@pytest.mark.capability("N2-eta")
@given(st.integers(0, 2**32 - 1))
def test_the_map_without_branches_is_that_of_the_corners(seed):
    image, (near, far, focus) = random_frustum(seed)
    axis = line_of_sight(image, near, far)
    depth = float(axis.along(focus)) - axis.top
    eta = eta_of_focus(axis.length, depth)
    if not eta < 50.0 * axis.length or eta < 0.01 * axis.length:
        return
    direct = tapered_map(image, axis, axis.length / eta)
    stepwise = square_map(trapezoid(image, axis, eta)).matrix
    assert np.abs(projective_images(direct, image) - projective_images(stepwise, image)).max() < 1e-9
    assert np.abs(projective_images(direct, image)).max() <= 1.0 + 1e-9
    assert projective_images(direct, focus)[1] == pytest.approx(0.6, abs=1e-9)
    # Before it fades, as seen from the side, the taper is that of the formula.
    if axis.top >= 0.0:
        assert taper_of_focus(axis, depth) == pytest.approx(axis.length / eta, rel=1e-9)


def turning_maps(angles, beside):
    """Images of a frustum's corners in its map, and the taper, while the eye turns past the lamp, so far beside it."""
    corners = np.array([(sx * d, sy * d, d) for d in (1.0, 20.0) for sx in (-0.4, 0.4) for sy in (-0.3, 0.3)])
    centres = np.array([(0, 0, 1.0), (0, 0, 20.0), (0, 0, 6.0)])
    c, s = np.cos(beside), np.sin(beside)
    for angle in angles:
        rows = np.array([(np.cos(angle), 0.0, -np.sin(angle)), (0.0, 1.0, 0.0), (np.sin(angle), 0.0, np.cos(angle))])
        rows = np.array([(1, 0, 0), (0, c, -s), (0, s, c)]) @ rows
        image, (near, far, focus) = corners @ rows[:2].T, centres @ rows[:2].T
        axis = line_of_sight(image, near, far)
        taper = taper_of_focus(axis, float(axis.along(focus)) - axis.top)
        matrix = tapered_map(image, axis, taper)
        assert np.isfinite(matrix).all()
        assert (matrix[2, :2] @ image.T + matrix[2, 2] > 0.999999).all(), "nothing is mirrored"
        yield projective_images(matrix, image), taper


@pytest.mark.slow
@pytest.mark.hard(33, 34)
def test_the_map_has_neither_pole_nor_branch():
    angles = np.linspace(0.0, np.pi, STEPS)
    images, tapers = zip(*turning_maps(angles, 0.0), strict=True)
    assert np.abs(images).max() <= 1.0 + 1e-9
    assert tapers[0] == tapers[-1] == 0.0, "looking at each other: the rectangle"
    assert max(tapers) > 2.0
    speed = np.abs(np.diff(images, axis=0)).max(axis=(1, 2)) / np.diff(angles)
    assert speed[2:-2].max() < 70.0, "in halves of the map a radian: no jump"


@pytest.mark.slow
@pytest.mark.hard(33)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("beside", [0.3, 0.1, 0.03, 0.01, 0.003])
def test_beside_the_duelling_position_the_map_turns_no_faster_than_the_axis(beside):
    angles = np.linspace(-20.0 * beside, 20.0 * beside, STEPS)
    images = np.array([image for image, _ in turning_maps(angles[np.abs(angles) < 1.5], beside)])
    speed = np.abs(np.diff(images, axis=0)).max(axis=(1, 2)) / np.diff(angles)[0]
    assert speed.max() < 80.0 + 3.0 / beside


@pytest.mark.capability("N2-focus")
def test_the_focus_of_the_centre_of_its_far_plane_and_of_its_hull():
    assert focus_distance(AXIS, AXIS.origin + 3.0 * AXIS.direction) == pytest.approx(3.61014693679292, abs=1e-12), (
        "TV58"
    )
    for seed in range(60):
        image, (near, far, focus) = random_frustum(seed)
        axis = line_of_sight(image, near, far)
        share = np.linalg.norm(focus - near) / np.linalg.norm(far - near)
        far_corners = image[:4] + share * (image[4:] - image[:4])
        simple = focus_distance(axis, far_corners.mean(axis=0))
        assert simple == pytest.approx((focus - near) @ axis.direction - axis.top, abs=1e-9)
        hull = focus_distance(axis, np.concatenate([image[:4], far_corners]))
        # The farthest corner of all that is in focus, whatever order they come in, lies behind that centre.
        every = np.concatenate([image[:4], far_corners])[::-1]
        assert hull == pytest.approx(((every - axis.origin) @ axis.direction).max() - axis.top, abs=1e-9)
        assert simple - 1e-9 <= hull <= axis.length + 1e-9
        if not 0.0 < simple < 0.8 * axis.length or not hull < 0.8 * axis.length:
            continue
        for distance in (simple, hull):
            eta = eta_of_focus(axis.length, distance)
            at = axis.origin + (axis.top + distance) * axis.direction
            corners = trapezoid(image, axis, eta)
            assert projective_images(square_map(corners).matrix, at)[1] == pytest.approx(0.6, abs=1e-6), (
                "on the 80 % line"
            )


@pytest.mark.capability("N2-orientation")
@pytest.mark.parametrize("seed", range(120))
def test_corners_run_counter_clockwise_and_maps_turn_nothing_over(seed):
    image, (near, far, focus) = random_frustum(seed)
    axis = line_of_sight(image, near, far)
    for corners in (
        rectangle(image, axis),
        bounding_trapezoid(image, axis, focus_distance(axis, focus)),
        *(trapezoid(image, axis, eta * axis.length) for eta in (0.05, 0.5, 5.0)),
    ):
        assert area(corners) > 0.0
        moved = corners.mean(axis=0) + 0.3 * (corners - corners.mean(axis=0))
        found = projective_images(square_map(corners).matrix, moved)
        assert area(found) > 0.0, "a triangle that faces the lamp faces it in the map too"


@pytest.mark.capability("R-80")
def test_the_search_for_the_focus_line_never_loses_area():
    gained = 0
    for seed in range(60):
        image, (near, far, focus) = random_frustum(seed)
        axis = line_of_sight(image, near, far)
        depth = float(axis.along(focus)) - axis.top
        share = depth / axis.length
        if not 0.01 < share < 0.99:
            continue
        focus_points = np.concatenate([image[:4], image[:4] + (image[4:] - image[:4]) * share])
        line = searched_line(image, axis, depth, focus_points)
        plain, best = (
            focus_area(tapered_map(image, axis, taper_of_focus(axis, depth, p)), focus_points) for p in (0.8, line)
        )
        assert best >= plain
        gained += best > plain * 1.01
    assert gained > 0


@pytest.mark.capability("R-nonsquare")
def test_the_side_of_a_map_follows_the_focus_area():
    sizes = [adapted_size(512, share, 0.5, 4096) for share in np.linspace(0.6, 0.0, 601)]
    assert sizes[0] == 512
    assert sizes[-1] == 4096
    assert (np.diff(sizes) >= 0).all()
    assert sizes[475] ** 2 * 0.125 == pytest.approx(512**2 * 0.5, rel=0.01)


@pytest.mark.capability("N2-zrow")
def test_the_row_for_z_carries_the_ends_to_the_clip_range():
    row = depth_row(2.0, 30.0)
    assert row @ (5, 6, -2.0, 1) == pytest.approx(-1.0, abs=1e-15)
    assert row @ (5, 6, -30.0, 1) == pytest.approx(1.0, abs=1e-15)
    with pytest.raises(InputError, match="no range"):
        depth_row(1.0, 1.0)


def test_what_is_no_trapezoid_is_refused():
    for corners in ([(0, 0), (1, 0), (2, 0), (3, 0)], [(0, 0)] * 4, [(0, 0), (1, 0), (1, np.nan), (0, 1)], [(0, 0)]):
        for build in (square_map, recipe_map, quadrilateral_map):
            with pytest.raises(InputError, match="quadrilateral"):
                build(corners)
    with pytest.raises(InputError, match="point"):
        line_of_sight(np.zeros((0, 2)), (0, 0), (1, 0))
    with pytest.raises(InputError, match="meet"):
        trapezoid(HULL, AXIS, np.inf)
    with pytest.raises(InputError, match="range"):
        eta_of_focus(1.0, -1.0)


def test_points_on_a_line_and_a_single_point_still_have_a_map():
    for points in ([(3.0, 4.0)], [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)], [(0.0, 0.0), (0.0, 5.0)]):
        axis = line_of_sight(points, points[0], points[-1])
        matrix = tapered_map(points, axis, 1.5)
        assert np.isfinite(matrix).all()
        assert np.linalg.matrix_rank(matrix) == 3
        assert np.abs(projective_images(matrix, points)).max() <= 1.0 + 1e-9


def test_a_matrix_of_the_plane_is_one_of_space():
    assert four_by_four(np.eye(3)).tolist() == np.eye(4).tolist()
    assert isinstance(AXIS, Axis)
