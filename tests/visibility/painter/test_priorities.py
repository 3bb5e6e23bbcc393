"""Decisions about whole objects against rays, their tables, and the orders made of them."""

from __future__ import annotations

import numpy as np
import pytest
from support.painted import nearest, sample_points, top_polygon
from support.strewn import STREWN, placed

from vectorplot.effects.shadows import cast_shadows
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.scene.light import Light
from vectorplot.scene.view import look
from vectorplot.testing.shapes import (
    box,
    cyclic_bars,
    interpenetrating_boxes,
    numbered,
    random_convex_solids,
    rotated_boxes,
    scene_of,
    torus_mesh,
)
from vectorplot.textbook.orders import (
    cyclic_overlap_report,
    cyclic_overlaps,
    demands,
    grouped_order,
    object_order,
    priorities,
    sphere_order,
    view_objects,
    which_first,
    wholly_hidden,
)
from vectorplot.visibility.painter.image_faces import drawn_faces, image_faces
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.priority_tests import (
    APART,
    BEHIND,
    IN_FRONT,
    STRADDLING,
    convex_bodies,
    outlined_items,
)
from vectorplot.visibility.painter.topological_order import component_ranks, topological_order
from vectorplot.visibility.projected_faces import project_faces

EYE = Camera((9.0, 7.0, 6.0), (0, 0, 0))


def seen_pairs(view, objects, samples=3000):
    """(k,k) whether the row is met before the column by some ray."""
    x, y = sample_points(view, samples)
    count = len(objects)
    heights = np.full((count, samples), -np.inf)
    sure = np.ones(samples, dtype=bool)
    for k in range(count):
        faces = np.flatnonzero(view.face_item == k)
        positions = np.concatenate([np.arange(view.offsets[f], view.offsets[f + 1]) for f in faces])
        offsets = np.concatenate([[0], np.cumsum(view.face_sizes[faces])])
        alone = type("One", (), {})()
        for name in ("points", "eye", "target", "focus", "near"):
            setattr(alone, name, getattr(view, name))
        alone.corners, alone.offsets, alone.face_sizes = view.corners[positions], offsets, np.diff(offsets)
        depth, clear = nearest(alone, x, y)
        heights[k] = np.where(depth == (-np.inf if view.eye is None else 0.0), -np.inf, depth)
        sure &= clear
    there = np.isfinite(heights)
    apart = np.where(there, heights, 0.0)[:, None] - np.where(there, heights, 0.0)[None]
    return ((apart > 1e-6) & there[:, None] & there[None] & sure).any(axis=2)


def row_and_column_apart(span):
    return (span[0][:, None] >= span[1][None]) | (span[1][:, None] <= span[0][None])


@pytest.mark.capability("G5.5-rect", "G5.5-depth", "G5.6-priorities")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_rectangles_apart_have_no_priority_and_depths_apart_decide(seed, parallel):
    scene = random_convex_solids(24, seed)
    objects = view_objects(look(scene, Camera((9, 7, 6), tuple(scene.bounds.mean(axis=0)), parallel=parallel)))
    table = priorities(objects)
    for k in range(len(objects)):
        # The boxes are those of the images of the faces that are drawn.
        mine = np.flatnonzero(objects.owner == k)
        corner = np.concatenate([np.arange(*objects.faces.offsets[[f, f + 1]]) for f in mine])
        low, high = objects.faces.points[:, corner].min(axis=1), objects.faces.points[:, corner].max(axis=1)
        assert np.array_equal(objects.box[0::2, k], low) and np.array_equal(objects.box[1::2, k], high)
    off = row_and_column_apart(objects.box[0:2]) | row_and_column_apart(objects.box[2:4])
    assert off.sum() > 200 and (table[off] == APART).all()
    nearer = ~off & (objects.box[4][:, None] >= objects.box[5][None])
    assert nearer.sum() > 5 and (table[nearer] == IN_FRONT).all() and (table.T[nearer] == BEHIND).all()
    # Of some objects the table is that part of the whole one, in the order asked for.
    some = np.random.default_rng(seed).permutation(24)[:9]
    for critical in (False, True):
        whole = priorities(objects, critical=critical)
        assert np.array_equal(priorities(objects, some, critical=critical), whole[np.ix_(some, some)])


@pytest.mark.capability("G5.5-which-first")
@pytest.mark.parametrize("light", [Light((3.0, -2.0, 5.0), parallel=True), Light((4.0, -3.0, 7.0))])
@pytest.mark.parametrize("seed", range(3))
def test_in_the_system_of_a_light_what_is_in_front_shadows_what_is_behind(light, seed):
    scene = random_convex_solids(9, seed)
    middle = scene.bounds.mean(axis=0)
    place = middle + light.position if light.parallel else light.position
    view = look(scene, Camera(tuple(place), tuple(middle), parallel=light.parallel))
    objects, count = view_objects(view), len(scene.items)
    first, second = (index.ravel() for index in np.indices((count, count)))
    codes = which_first(objects, first, second, critical=True).reshape(count, count)
    # The shadows of one body after the other: they lie on bodies behind it only.
    seen = look(scene, Camera((6.0, 5.0, 9.0), tuple(middle)))
    shadowed = np.zeros((count, count), dtype=bool)
    for caster in range(count):
        cast = cast_shadows(seen, (light,), casters=np.arange(count) == caster)
        shadowed[caster, seen.face_item[cast.face]] = True
    assert shadowed.sum() > 3
    assert np.isin(codes[shadowed], (IN_FRONT, STRADDLING)).all()


@pytest.mark.slow
@pytest.mark.capability("G5.5-rect", "G5.5-depth", "G5.5-outlines", "G5.5-which-first", "G5.6-priorities")
@pytest.mark.spread
@pytest.mark.parametrize("critical", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_tables_agree_with_rays(seed, critical):
    random = np.random.default_rng(seed)
    mixed = numbered([placed(torus_mesh(12, 7, 1.0, 0.3), random), *(i.shape for i in rotated_boxes(7, seed).items)])
    for scene in (random_convex_solids(9, seed), mixed, STREWN["aligned_boxes"](random)):
        view = look(scene, Camera((9, 7, 6), tuple(scene.bounds.mean(axis=0)), parallel=seed % 2 == 1))
        objects = view_objects(view)
        table = priorities(objects, critical=critical)
        met = seen_pairs(view, objects)
        opposite = np.select([table == IN_FRONT, table == BEHIND], [BEHIND, IN_FRONT], table)
        assert (table.T == opposite).all()
        assert np.isin(table[met & ~met.T], (IN_FRONT, STRADDLING)).all()
        assert (table[met & met.T] == STRADDLING).all()
        if critical:
            assert met.sum() > 0.5 * np.isin(table, (IN_FRONT, STRADDLING)).sum(), "no priority without an overlap"


def test_critical_decisions_are_made_only_where_images_overlap():
    scene = scene_of(
        NEAR=box((0, -5, 0), (1, -4, 1)), FAR=box((1.2, 4, 0), (2.2, 5, 1)), HIGH=box((0, 0, 3), (2.2, 1, 4))
    )
    view = look(scene, Camera.view("front", (1, 0, 1), 40.0))
    objects = view_objects(view)
    assert (priorities(objects) == APART).all()
    tilted = look(scene, Camera((30, -30, 5), (1, 0, 1)))
    quick, slow = (priorities(view_objects(tilted), critical=c) for c in (False, True))
    assert (quick[slow != APART] == slow[slow != APART]).all()


def test_a_subset_and_the_light_s_system():
    scene = scene_of(A=box((0, 0, 0), (1, 1, 1)), B=box((0, 0, 2), (1, 1, 3)), C=box((0, 0, 4), (1, 1, 5)))
    lamp = look(scene, Camera((0.4, 0.6, 30.0), (0.5, 0.5, 0)))
    table = priorities(view_objects(lamp))
    assert table.tolist() == [[0, BEHIND, BEHIND], [IN_FRONT, 0, BEHIND], [IN_FRONT, IN_FRONT, 0]]
    assert priorities(view_objects(lamp), [2, 0]).tolist() == [[0, IN_FRONT], [BEHIND, 0]]
    assert which_first(view_objects(lamp), np.array([2]), np.array([1])).tolist() == [IN_FRONT]
    both = view_objects(lamp, [0, -1, 0])
    assert (len(both), priorities(both).tolist()) == (1, [[0]])
    with pytest.raises(InputError, match="as many"):
        view_objects(lamp, [0, 1])


@pytest.mark.hard(22)
@pytest.mark.capability("G5.5-outlines")
@pytest.mark.parametrize("seed", range(6))
def test_what_one_convex_body_hides_needs_no_drawing(seed):
    random = np.random.default_rng(seed)
    small = [placed(box((0, 0, 0), random.uniform(0.1, 0.5, 3)), random, 2.5) for _ in range(30)]
    scene = numbered([*small, placed(box((-1.5, -1.5, -1.5), (1.5, 1.5, 1.5)), random, 0.5)])
    view = look(scene, EYE)
    hidden = wholly_hidden(view_objects(view))
    faces = painters_order(view).faces
    x, y = sample_points(view, 6000)
    shown = set(view.face_item[faces.source[top_polygon(faces, x, y)]].tolist())
    assert 3 < hidden.sum() < 28
    assert not shown & set(np.flatnonzero(hidden).tolist())
    # Left out, they are not missed.
    kept = faces.take(np.flatnonzero(~hidden[view.face_item[faces.source]]))
    assert (
        np.append(kept.source, -1)[top_polygon(kept, x, y)] == np.append(faces.source, -1)[top_polygon(faces, x, y)]
    ).all()


def test_nothing_is_hidden_by_what_is_not_convex_nor_by_two_together():
    back = box((-0.4, 3, -0.4), (0.4, 3.5, 0.4))
    ring = torus_mesh(16, 8, 3.0, 2.5)
    halves = [box((-2, 0, -2), (0, 0.1, 2)), box((0, 0, -2), (2, 0.1, 2))]
    front = Camera.view("front", (0, 0, 0), 20.0)
    for shapes, expected in (([back, ring], 0), ([back, *halves], 0), ([back, box((-2, 0, -2), (2, 0.1, 2))], 1)):
        assert wholly_hidden(view_objects(look(numbered(shapes), front))).sum() == expected
    away = view_objects(look(numbered([back, box((0, -90, 0), (1, -80, 1))]), Camera((0, -20, 0), (0, 0, 0))))
    assert wholly_hidden(away).tolist() == [False, True]


@pytest.mark.capability("G5.6-mikado")
def test_a_circle_of_three_is_isolated_from_fifty():
    random = np.random.default_rng(0)
    order = random.permutation(50)
    first, second = np.triu_indices(50, 1)
    kept = random.random(len(first)) < 0.1
    before, after = order[first[kept]], order[second[kept]]
    plain = topological_order(50, before, after)
    place = np.argsort(plain.order)
    assert (place[before] < place[after]).all()
    assert len(plain.cycle) == 0
    low, middle, high = order[[20, 24, 28]]
    before = np.append(before, [low, middle, high])
    after = np.append(after, [middle, high, low])
    cycles = cyclic_overlaps(50, before, after)
    assert len(cycles) == 1
    assert {low, middle, high} <= set(cycles[0].tolist())
    rank = component_ranks(50, before, after)
    assert (rank[before] <= rank[after]).all()
    only = cyclic_overlaps(50, np.array([7, 8, 9, 1]), np.array([8, 9, 7, 7]))
    assert [k.tolist() for k in only] == [[7, 8, 9]]
    isolated = topological_order(50, np.array([7, 8, 9, 1]), np.array([8, 9, 7, 7]))
    assert isolated.cycle.tolist() == [7, 8, 9]
    assert sorted(isolated.order.tolist()) == list(range(50))


@pytest.mark.capability("G5.6-mikado")
def test_knots_are_reported_by_name():
    view = look(cyclic_bars(), Camera.view("top", (0, 0, 0), 8.0))
    names = [item.name for item in cyclic_bars().items]
    with pytest.warns(InputWarning, match="circle") as caught:
        result = object_order(view, names)
    assert [k.tolist() for k in result.cycles] == [[0, 1, 2]]
    assert all(name in str(caught[0].message) for name in names)
    assert cyclic_overlap_report(result.cycles, "XYZ") == (
        "X, Y and Z lie on one another in a circle, or pierce each other",
    )


@pytest.mark.capability("G5.6-two-pass")
def test_the_second_pass_undoes_knots_that_only_quick_decisions_make():
    row = numbered([box((k, 0, 0), (k + 0.9, 1, 1)) for k in range(6)])
    plain = object_order(look(row, EYE), [str(k) for k in range(6)])
    assert plain.order.tolist() == list(range(6))
    assert (len(plain.cycles), plain.critical) == (0, False)
    for seed in (9, 25, 31):
        random = np.random.default_rng(seed)
        bars = numbered([placed(box((-2, -0.01, -0.01), (2, 0.01, 0.01)), random, 1.5) for _ in range(6)])
        view = look(bars, EYE)
        quick, slow = (priorities(view_objects(view), critical=c) for c in (False, True))
        assert len(cyclic_overlaps(6, *demands(quick))) > 0
        result = object_order(view, [str(k) for k in range(6)])
        assert result.critical
        place = np.argsort(result.order)
        assert all(place[a] < place[b] for a, b in zip(*demands(slow), strict=True))


def test_boxes_through_each_other_are_a_knot():
    view = look(interpenetrating_boxes(), EYE)
    with pytest.warns(InputWarning, match="pierce"):
        assert len(object_order(view, ["A", "B"]).cycles) == 1


@pytest.mark.capability("G5.7-groups")
def test_groups_give_the_same_picture():
    random = np.random.default_rng(1)
    houses = []
    for x in range(3):
        for y in range(3):
            houses += [
                box((3 * x, 3 * y, 0), (3 * x + 2, 3 * y + 2, 1)),
                box((3 * x + 0.5, 3 * y + 0.5, 1), (3 * x + 1, 3 * y + 1, 2)),
            ]
    order = random.permutation(len(houses))
    view = look(numbered([houses[k] for k in order]), Camera((-5, -9, 7), (4, 4, 0)))
    objects = view_objects(view)
    before, after = demands(priorities(objects, critical=True))
    group = order // 2
    result = grouped_order(len(houses), before, after, group)
    assert (result.undone, result.cycles) == ((), ())
    along = group[result.order]
    assert (np.diff(np.flatnonzero(np.diff(along, prepend=-1))) == 2).all(), "groups stay together"
    place = np.argsort(result.order)
    assert (place[before] < place[after]).all()
    pictures = []
    for ranks in (place, np.argsort(topological_order(len(houses), before, after).order)):
        faces = objects.faces.take(np.argsort(ranks[objects.owner], kind="stable"))
        x, y = sample_points(view, 1500)
        top = top_polygon(faces, x, y)
        pictures.append(np.append(faces.source, -1)[top])
    assert (pictures[0] == pictures[1]).all()


@pytest.mark.capability("G5.7-groups")
def test_a_group_that_makes_a_knot_is_undone():
    # 0 and 2 are a group, with 1 between them; 3 and 4 another one.
    result = grouped_order(5, np.array([0, 1, 3]), np.array([1, 2, 4]), np.array([7, -1, 7, 4, 4]))
    assert result.undone == (7,)
    place = np.argsort(result.order)
    assert place[0] < place[1] < place[2]
    assert abs(place[3] - place[4]) == 1
    assert result.cycles == ()
    circle = grouped_order(3, np.array([0, 1, 2]), np.array([1, 2, 0]), np.array([-1, -1, -1]))
    assert [k.tolist() for k in circle.cycles] == [[0, 1, 2]]
    assert grouped_order(0, np.zeros(0, int), np.zeros(0, int), np.zeros(0, int)).order.tolist() == []
    with pytest.raises(InputError, match="as many groups"):
        grouped_order(2, np.zeros(0, int), np.zeros(0, int), np.zeros(3, int))


@pytest.mark.capability("G5.5-soap")
@pytest.mark.parametrize("parallel", [False, True])
def test_the_order_of_spheres_is_right_or_refused(parallel):
    def ordered(scene):
        view = look(scene, Camera((30.0, 22.0, 18.0), tuple(scene.bounds.mean(axis=0)), parallel=parallel))
        projected = project_faces(view)
        faces = image_faces(view, drawn_faces(view, projected))
        bodies = convex_bodies(view, faces, np.flatnonzero(outlined_items(view, projected)))
        return view, sphere_order(view, faces, bodies)

    random = np.random.default_rng(2)
    lattice = np.stack(np.meshgrid(*[np.arange(5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * 2.0
    sizes = random.uniform(0.1, 1.1, (125, 3))
    view, order = ordered(numbered([box(p, p + s) for p, s in zip(lattice, sizes, strict=True)]))
    assert order is not None
    place = np.argsort(order)
    table = priorities(view_objects(view), critical=True)
    before, after = demands(table)
    assert len(before) > 80
    assert (place[before] < place[after]).all()
    flat = scene_of(
        FLOOR=box((-5, -5, -0.1), (5, 5, 0)), BOX=box((3, 3, 0), (4, 4, 1)), LOW=box((-4, -4, 0), (-3, -3, 1))
    )
    assert ordered(flat)[1] is None or parallel
    # Slabs whose spheres overlap: where the outlines say the same as the spheres, their order stands.
    slabs = numbered([box((0, 0, 3 * k), (4, 4, 3 * k + 0.5)) for k in (2, 0, 1)])
    assert ordered(slabs)[1].tolist() == [1, 2, 0]
    assert ordered(interpenetrating_boxes())[1] is None
