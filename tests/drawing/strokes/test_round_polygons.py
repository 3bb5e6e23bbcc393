"""Polygons of meshes that stand for circles and ellipses leave as arcs of these, with the error said."""

from dataclasses import replace

import ezdxf
import numpy as np
import pytest

import vectorplot as vp
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.stroke_curves import curved_strokes, rounding_error_mm, with_round_polygons
from vectorplot.io.scene_language import parse_scene

PLAN = vp.Camera((0, 0, 1000), up=(0, 1, 0), parallel=True, height=100)


def polygon(sides, first=20.0, second=20.0, turn=0.3, part=1.0):
    t = 2.0 * np.pi * part * np.arange(sides + (part < 1.0)) / sides
    x, y = first * np.cos(t), second * np.sin(t)
    return np.column_stack([50 + np.cos(turn) * x - np.sin(turn) * y, 50 + np.sin(turn) * x + np.cos(turn) * y])


def rounded(*polygons, closed=True, tolerance_mm=0.02):
    paths = Paths.of_polylines(polygons, closed=closed)
    (layer,) = with_round_polygons([Layer("visible", Pen(), (paths,))], tolerance_mm)
    return layer


def kinds_in_dxf(layer, tmp_path):
    vp.save(Drawing(100, 100, (layer,)), tmp_path / "a.dxf")
    return list(ezdxf.readfile(tmp_path / "a.dxf").modelspace())


def test_a_polygon_on_a_circle_is_a_circle_with_the_sagitta_as_its_error(tmp_path):
    layer = rounded(polygon(48))
    assert rounding_error_mm([layer]) == pytest.approx(20.0 * (1.0 - np.cos(np.pi / 48)) + 0.002, abs=0.01)
    (circle,) = kinds_in_dxf(layer, tmp_path)
    assert circle.dxftype() == "CIRCLE" and circle.dxf.radius == pytest.approx(20.0, abs=1e-6)
    assert np.allclose([circle.dxf.center.x, circle.dxf.center.y], 50.0, atol=1e-6)


def test_numbers_of_single_precision_are_a_circle_still(tmp_path):
    (circle,) = kinds_in_dxf(rounded(polygon(48).astype(np.float32)), tmp_path)
    assert circle.dxftype() == "CIRCLE" and circle.dxf.radius == pytest.approx(20.0, abs=1e-4)


@pytest.mark.parametrize("axes", [(30.0, 10.0), (10.0, 30.0)])
def test_circles_seen_from_the_side_are_ellipses_and_parts_of_circles_arcs(axes, tmp_path):
    (ellipse,) = kinds_in_dxf(rounded(polygon(60, *axes)), tmp_path)
    assert ellipse.dxftype() == "ELLIPSE" and ellipse.dxf.ratio == pytest.approx(1.0 / 3.0)
    (arc,) = kinds_in_dxf(rounded(polygon(30, part=0.4), closed=False), tmp_path)
    assert arc.dxftype() == "ARC" and arc.dxf.radius == pytest.approx(20.0)
    assert (arc.dxf.end_angle - arc.dxf.start_angle) % 360.0 == pytest.approx(144.0)


def test_nuts_and_what_is_not_round_stay_polygons(tmp_path):
    others = (polygon(6), polygon(10), np.array([(0.0, 0.0), (90.0, 0.0), (90.0, 90.0)]))
    layer = rounded(*others)
    assert rounding_error_mm([layer]) is None
    assert {one.dxftype() for one in kinds_in_dxf(layer, tmp_path)} == {"LWPOLYLINE"}
    assert kinds_in_dxf(rounded(polygon(12)), tmp_path)[0].dxftype() == "CIRCLE"


def test_of_a_circle_that_is_not_whole_the_rest_stays_straight(tmp_path):
    bent = polygon(48)
    bent[7] += 0.01
    for ring, straight in ((polygon(48)[np.r_[0:20, 24:48]], 1), (bent, 2)):
        layer = rounded(ring)
        (line,) = kinds_in_dxf(layer, tmp_path)
        bulges = np.array([point[2] for point in line.get_points("xyb")])
        assert line.dxftype() == "LWPOLYLINE" and line.closed and (bulges == 0.0).sum() == straight
        turned = 4.0 * np.arctan(bulges).sum()
        lost = 5 if straight == 1 else 2
        assert turned == pytest.approx(2 * np.pi * (48 - lost) / 48, abs=1e-2)
        assert 0.04 < rounding_error_mm([layer]) < 0.06


def test_smooth_strokes_stay_as_they_are_beside_polygons():
    ball = parse_scene("BALL red surface sphere radius 20\n")
    scene = vp.Scene((*ball.items, *vp.read("data/flange.stl").items))
    plain, arcs = (vp.draw(scene, PLAN, curves=how) for how in ("bezier", "arcs"))
    for one, other in zip(plain.layers, arcs.layers, strict=True):
        for before, after in zip(one.marks, other.marks, strict=True):
            if isinstance(before, CurvedStrokes):
                kept = after.arcs.take(np.isin(after.arcs.stroke, before.arcs.stroke))
                assert np.array_equal(kept.centre, before.arcs.centre)
                assert np.array_equal(kept.stroke, before.arcs.stroke)


def test_the_plan_of_a_flange_for_the_laser_is_six_circles(tmp_path):
    reports = []
    drawing = vp.draw(
        "data/flange.stl",
        PLAN,
        page=vp.Page(100, 100, 0),
        fit=False,
        lines="outline",
        curves="arcs",
        explain=reports.append,
    )
    drawing.save(tmp_path / "flange.dxf")
    circles = list(ezdxf.readfile(tmp_path / "flange.dxf").modelspace())
    assert {circle.dxftype() for circle in circles} == {"CIRCLE"}
    assert sorted(round(circle.dxf.radius, 4) for circle in circles) == [4.0, 4.0, 4.0, 4.0, 10.0, 40.0]
    (error,) = [one.error for one in reports if one.name == "arcs" and one.error is not None]
    assert 40.0 * (1.0 - np.cos(np.pi / 96)) < error < 0.03


def smooth_slot(bulge):
    """A slot of radius 3 with 12 between the middles of its ends, as one smooth stroke; bulge: of its long sides."""
    turn = np.linspace(-0.5, 0.5, 17) * np.pi
    end = np.column_stack([6.0 + 3.0 * np.cos(turn), 3.0 * np.sin(turn)])
    ahead = np.tile(turn + 0.5 * np.pi, (2, 1)).T
    lean = np.arctan2(4.0 * bulge, 12.0)
    ahead[-1, 1], ahead[0, 0] = np.pi - lean, lean
    points = 50.0 + np.concatenate([end, -end])
    paths = Paths.of_polylines((points,), closed=True)
    return replace(paths, smooth=np.array([True]), directions=np.concatenate([ahead, ahead + np.pi]))


def test_smooth_strokes_of_arcs_and_straight_lines_have_the_radius_of_their_arcs(tmp_path):
    (layer,) = with_round_polygons([Layer("visible", Pen(), (curved_strokes(smooth_slot(0.0), 0.02),))], 0.02)
    (slot,) = kinds_in_dxf(layer, tmp_path)
    rows = [(x, y, bulge) for x, y, _, _, bulge in slot.get_points()]
    assert (
        slot.closed
        and [round(float(bulge), 6) for *_, bulge in rows if bulge] == [pytest.approx(np.tan(np.pi / 8), abs=1e-3)] * 4
    )
    assert rounding_error_mm([layer]) is None
    curves = curved_strokes(smooth_slot(0.5), 0.02)
    (layer,) = with_round_polygons([Layer("visible", Pen(), (curves,))], 0.02)
    assert np.array_equal(layer.marks[0].beziers.control, curves.beziers.control)
