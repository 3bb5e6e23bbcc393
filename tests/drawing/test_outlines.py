"""The outline of what is seen: one closed path around each region, one around each hole, exact, and right in DXF."""

import ezdxf
import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot import geometry
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces import Sphere
from vectorplot.words import LineKind

TOP = "page 100x100 margin 0\ncamera eye 0 0 100 target 0 0 0 up 0 1 0 parallel height 100\n"
"""A unit is a millimetre, and the origin in the middle of the page."""

DRILLED = """PLATE gray translation base_points -30 -20 0, 30 -20 0, 30 20 0, -30 20 0 trans_vector 0 0 6
  bore -22 -12 0 3, 22 -12 0 3
  bore 0 0 0 9
  cutout -24 2 0, -20 2 0, -20 12 0, -14 12 0, -14 15 0, -28 15 0, -28 12 0, -24 12 0
"""


def outline(scene, **how):
    """The outline of a scene: the polygons of its paths, and the areas these go around, holes negative."""
    drawing = vp.draw(scene, lines="outline", **how)
    (paths,) = [strokes for layer in drawing.layers for strokes in layer.strokes if len(strokes)]
    assert paths.closed.all() and (paths.kind == LineKind.OUTLINE).all() and not paths.hidden_by.any()
    rings = [paths.points[low:high] for low, high in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)]
    areas = [shapely.LinearRing(ring).is_ccw * 2.0 - 1.0 for ring in rings]
    return drawing, rings, [sign * shapely.Polygon(ring).area for sign, ring in zip(areas, rings, strict=True)]


def test_a_plate_with_bores_and_a_letter_cut_out_is_closed_contours_at_its_size(tmp_path):
    drawing, _, areas = outline(parse_scene(TOP + DRILLED), fit=False)
    around = sum(1 for area in areas if area > 0.0)
    assert (around, len(areas)) == (1, 5)
    drawing.save(tmp_path / "plate.dxf")
    entities = list(ezdxf.readfile(tmp_path / "plate.dxf").modelspace())
    assert [entity.dxftype() for entity in entities] == ["LWPOLYLINE"] * 5 and all(one.closed for one in entities)
    sizes = sorted(shapely.Polygon([point[:2] for point in one]).area for one in entities)
    bores = [24.0 * np.sin(2.0 * np.pi / 48) * radius**2 for radius in (3.0, 3.0, 9.0)]
    assert np.allclose(sizes, sorted([2400.0, 14.0 * 3.0 + 4.0 * 10.0, *bores]), atol=2e-2)


@pytest.mark.parametrize(
    "name", ["flange.stl", "cubes.scene", "three_bars.scene", "interpenetrating.scene", "rabbit.ply"]
)
@pytest.mark.parametrize("camera", [None, "top", "iso"])
def test_the_outline_of_meshes_is_that_of_the_union_of_their_faces(name, camera):
    scene = vp.read(f"data/{name}")
    drawing, rings, areas = outline(scene, camera=camera)
    faces = []
    for item in scene.items:
        mesh = item.shape
        places = np.column_stack([mesh.vertices, np.ones(len(mesh.vertices))]) @ drawing.page_from_world.T
        page = places[:, :2] / places[:, 3:]
        corners = [page[mesh.corners[low:high]] for low, high in zip(mesh.offsets[:-1], mesh.offsets[1:], strict=True)]
        faces.extend(shapely.Polygon(one).buffer(0) for one in corners)
    whole = shapely.union_all(faces)
    assert sum(areas) == pytest.approx(whole.area, abs=0.05)
    outer = shapely.union_all([shapely.Polygon(ring) for ring, area in zip(rings, areas, strict=True) if area > 0.0])
    holes = shapely.union_all([shapely.Polygon(ring) for ring, area in zip(rings, areas, strict=True) if area < 0.0])
    assert shapely.area(shapely.symmetric_difference(outer.difference(holes), whole)) < 0.1


def test_balls_leave_as_circles_and_two_that_overlap_as_one_path(tmp_path):
    balls = "A red surface sphere radius 10\nB red surface sphere radius 10 translation 12 0 0\n"
    apart = "C blue surface sphere radius 5 translation -30 0 0\n"
    drawing, _, areas = outline(parse_scene(TOP + balls + apart), fit=False)
    lens = 2.0 * 100.0 * np.arccos(0.6) - 6.0 * np.sqrt(400.0 - 144.0)
    assert np.allclose(sorted(areas), [np.pi * 25.0, np.pi * 200.0 - lens], rtol=3e-3)
    drawing.save(tmp_path / "balls.dxf")
    entities = {entity.dxftype(): entity for entity in ezdxf.readfile(tmp_path / "balls.dxf").modelspace()}
    assert set(entities) == {"CIRCLE", "SPLINE"}
    assert entities["CIRCLE"].dxf.radius == pytest.approx(5.0, abs=1e-5)


def test_the_outline_of_a_ring_is_two_circles_from_above():
    drawing, _, areas = outline(parse_scene(TOP + "RING red surface torus 20 5\n"), fit=False)
    assert len(areas) == 2 and np.allclose(sorted(areas), [-np.pi * 225.0, np.pi * 625.0], rtol=1e-3)
    (mark,) = [mark for layer in drawing.layers for mark in layer.marks if len(mark)]
    assert np.allclose(np.sort(np.linalg.norm(mark.arcs.first, axis=1)), [15.0, 25.0], atol=1e-5)


def test_surfaces_and_meshes_have_one_outline_together():
    together = "BALL red surface sphere radius 10\nBEAM gray box 40 4 4\n  translation -20 -2 -2\n"
    _, rings, areas = outline(parse_scene(TOP + together), fit=False)
    ball = 2.0 * (100.0 * np.arcsin(0.2) + 2.0 * np.sqrt(96.0))
    assert len(rings) == 1 and areas[0] == pytest.approx(100.0 * np.pi + 160.0 - ball, rel=1e-3)


@pytest.mark.parametrize("seed", range(8))
def test_random_boxes_and_balls_have_the_outline_of_the_union_of_their_images(seed):
    random = np.random.default_rng(seed)
    items, images = [], []
    for _ in range(random.integers(3, 9)):
        place = random.uniform(-25.0, 25.0, 3)
        if random.random() < 0.5:
            radius = random.uniform(2.0, 12.0)
            items.append(vp.Item("BALL", Sphere(radius)).moved(*place))
            images.append(shapely.Point(place[:2] + 50.0).buffer(radius, quad_segs=2000))
        else:
            box = vp.Item("BOX", geometry.box(tuple(random.uniform(2.0, 25.0, 3))))
            items.append(box.turned(random.normal(size=3), random.uniform(0.0, 360.0)).moved(*place))
            images.append(shapely.convex_hull(shapely.multipoints(items[-1].shape.vertices[:, :2] + 50.0)))
    whole = shapely.union_all(images)
    how = {"camera": vp.Camera((0, 0, 100), up=(0, 1, 0), parallel=True, height=100), "page": vp.Page(100, 100, 0)}
    _, rings, areas = outline(vp.Scene(tuple(items)), fit=False, tolerance_mm=0.005, **how)
    assert sum(areas) == pytest.approx(whole.area, abs=0.0025 * whole.length)
    assert len(rings) == len(shapely.get_rings(shapely.get_parts(whole)))


@pytest.mark.parametrize(
    "shape", ["cylinder radius 3 top 9", "cone radius 4 height 8", "cylinder radius 3 top 9 capped"]
)
def test_of_an_open_body_the_inside_counts_as_covered(shape):
    camera = "page 100x100 margin 0\ncamera eye 40 -90 60 target 0 0 0 field_of_vision 30\n"
    scene = parse_scene(f"{camera}A red surface {shape}\n  rotation y 46\n  translation -10 4 10\n")
    _, rings, areas = outline(scene, fit=False)
    painted = [fills for layer in vp.paint(scene, fit=False, tolerance_mm=0.005).layers for fills in layer.fills]
    polygons = [
        shapely.Polygon(fills.points[low:high]).buffer(0)
        for fills in painted
        for low, high in zip(fills.offsets[:-1], fills.offsets[1:], strict=True)
        if high - low > 2
    ]
    assert len(rings) == 1 and areas[0] == pytest.approx(shapely.union_all(polygons, grid_size=1e-4).area, abs=0.5)


def test_items_may_ask_for_an_outline_of_their_own():
    scene = parse_scene(TOP + "A red lines outline box 10 10 10\nB red box 10 10 10\n  translation 5 5 0\n")
    drawing = vp.draw(scene, lines="none", fit=False)
    (paths,) = [strokes for layer in drawing.layers for strokes in layer.strokes if len(strokes)]
    assert len(paths) == 1 and len(paths.points) == 4 and np.ptp(paths.points, axis=0) == pytest.approx([10.0, 10.0])


def test_a_picture_of_outlines_fills_its_page():
    scene = vp.read("data/mixed.scene")
    _, rings, _ = outline(scene, page="200x100", camera="iso")
    whole = vp.draw(scene, lines="contour,boundary", page="200x100", camera="iso")
    own, others = np.concatenate(rings), np.concatenate([s.points for layer in whole.layers for s in layer.strokes])
    assert np.allclose([own.min(axis=0), own.max(axis=0)], [others.min(axis=0), others.max(axis=0)], atol=0.02)


def test_other_verbs_draw_outlines_on_top():
    scene = parse_scene(TOP + DRILLED)
    painted = vp.paint(scene, lines="outline", fit=False)
    assert sum(len(strokes) for layer in painted.layers for strokes in layer.strokes) == 5
    dark = np.asarray(vp.render(scene, size=(60, 60), lines="outline").pixels).sum(axis=2).min()
    assert dark < np.asarray(vp.render(scene, size=(60, 60)).pixels).sum(axis=2).min()
    with pytest.raises(vp.InputError, match="erasing"):
        vp.paint(scene, lines="outline", fills="erasing")


def test_amid_the_scene_there_is_no_outline():
    around = parse_scene("camera eye 0 0 0 target 1 0 0\nROOM gray box 10 10 10\n  translation -5 -5 -5\n")
    with pytest.raises(vp.InputError, match="behind the eye"):
        vp.draw(around, lines="outline")
    assert not vp.draw(vp.Scene(()), lines="outline").layers


@pytest.mark.parametrize(
    "how",
    [
        {"style": "wireframe"},
        {"style": "depth-cue"},
        {"layers": "object"},
        {"layers": "colour"},
        {"hidden": "dashed"},
        {"pens": "outline=0.7:red"},
        {"curves": "polyline"},
        {"curves": "arcs"},
    ],
)
def test_outlines_stay_closed_in_all_looks(how):
    drawing = vp.draw(vp.read("data/mixed.scene"), lines="outline", **how)
    found = [strokes for layer in drawing.layers for strokes in layer.strokes]
    assert sum(map(len, found)) == 3 and all(strokes.closed.all() for strokes in found)
