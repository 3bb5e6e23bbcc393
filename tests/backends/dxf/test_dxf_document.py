"""DXF as the library reads it that others read it by."""

from __future__ import annotations

import io

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.path import make_path

import vectorplot as vp
from vectorplot.backends.dxf import dxf_bytes
from vectorplot.geometry import prism
from vectorplot.surfaces import Sphere


def read_back(drawing):
    document = ezdxf.read(io.StringIO(dxf_bytes(drawing).decode("utf-8")))
    audit = document.audit()
    assert not audit.errors and not audit.fixes
    return document


def chords_of(lines):
    """(n,2,2) the ends of all chords of polylines (k,2)."""
    return np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])


def lines_of(document, layer):
    """What one layer draws, as chords that are off by less than a hundredth of a mm."""
    found = document.modelspace().query(f'*[layer=="{layer}"]')
    return chords_of([np.array([(p.x, p.y) for p in make_path(e).flattening(0.01)]) for e in found])


def furthest(chords, others):
    """The largest distance of an end or a middle of chords (n,2,2) from others."""
    places = shapely.points(np.concatenate([chords.reshape(-1, 2), chords.mean(axis=1)]))
    tree = shapely.STRtree(shapely.linestrings(others))
    return tree.query_nearest(places, all_matches=False, return_distance=True)[1].max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pencil", "curves", "torus"])
def test_every_stroke_is_where_it_was_drawn(name):
    drawing = vp.draw(vp.read(f"data/{name}.scene"), hidden="solid", page=vp.Page(90, 64, 4))
    document = read_back(drawing)
    corner = document.modelspace().dxf.extmax
    assert document.units == ezdxf.units.MM and corner.isclose((drawing.width_mm, drawing.height_mm, 0.0))
    for number, layer in enumerate(drawing.layers, start=1):
        strokes = [
            paths.points[[*range(a, b), *[a] * bool(closed)]]
            for paths in layer.strokes
            for a, b, closed in zip(paths.offsets[:-1], paths.offsets[1:], paths.closed, strict=True)
        ]
        known = document.layers.get(f"{number} {layer.name}")
        assert known.rgb == tuple(bytes.fromhex(layer.pen.colour[1:])) and known.dxf.lineweight > 0
        if strokes:
            ours, theirs = chords_of(strokes), lines_of(document, known.dxf.name)
            assert max(furthest(ours, theirs), furthest(theirs, ours)) < 0.03


@pytest.mark.slow
def test_circles_and_arcs_are_exact_and_other_curves_are_splines():
    ball = vp.Scene((vp.Item("ball", Sphere(2.0)),))
    space = read_back(vp.draw(ball, vp.Camera.view("front"))).modelspace()
    (circle,) = space.query("CIRCLE")
    assert len(space) == 1 and circle.dxf.radius > 10.0
    curves = read_back(vp.draw(vp.read("data/torus.scene"))).modelspace()
    assert len(curves.query("SPLINE")) > 0 and len(curves.query("ELLIPSE")) > 0


def test_polygons_are_hatches_with_their_colours_and_transparency():
    box = vp.Mesh.from_triangles(
        [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    glass = vp.Material("transparent", opacity=0.4)
    drawing = vp.paint(vp.Scene((vp.Item("B", box, "blue", material=glass),)), vp.Camera((6, -9, 5), (1, 0, 1)))
    hatches = read_back(drawing).modelspace().query("HATCH")
    assert len(hatches) >= 1 and all(hatch.transparency == pytest.approx(0.6, abs=0.01) for hatch in hatches)
    assert all(hatch.rgb[2] > hatch.rgb[0] for hatch in hatches)


def test_same_drawing_same_bytes_and_names_that_the_format_forbids():
    layer = vp.Layer('a<b>/"|', vp.Pen(0.3, "#12ab34"), (vp.Paths.empty(),), plotted=False)
    drawing = vp.Drawing(100.0, 80.0, (layer,), title="x")
    assert dxf_bytes(drawing) == dxf_bytes(drawing)
    (known,) = [some for some in read_back(drawing).layers if some.dxf.name.startswith("1 ")]
    assert known.dxf.plot == 0 and np.isin(list('<>/"|'), list(known.dxf.name)).sum() == 0
    assert ezdxf.options.write_fixed_meta_data_for_testing is False


def test_straight_lines_of_smooth_surfaces_are_lines_and_closed_curves_closed_splines():
    above = vp.draw(vp.read("data/torus.scene"), "top")
    found = {entity.dxftype() for entity in read_back(above).modelspace()}
    assert found == {"LWPOLYLINE", "CIRCLE"}
    outline = read_back(vp.draw(vp.read("data/implicit.scene"), lines="outline")).modelspace()
    assert [entity.dxftype() for entity in outline] == ["SPLINE"] * 4 and all(entity.closed for entity in outline)


def rounded_plate(corner, sides):
    """A plate with round corners, each of so many sides, seen from above on a page in its own size."""
    angles = np.linspace(0, np.pi / 2, sides + 1)
    ring = []
    for k, (x, y) in enumerate([(30, 15), (-30, 15), (-30, -15), (30, -15)]):
        turn = angles + k * np.pi / 2
        ring.append(np.stack([x + corner * np.cos(turn), y + corner * np.sin(turn), 0 * turn], axis=1))
    plate = vp.Item("plate", prism(np.concatenate(ring), (0, 0, 4)))
    camera = vp.Camera((0, 0, 100), (0, 0, 2), up=(0, 1, 0), parallel=True, height=60)
    return vp.draw(plate, camera, page=vp.Page(100, 60, 0), fit=False, lines="outline", curves="arcs")


def test_straight_lines_and_arcs_in_turn_are_one_polyline_with_bulges():
    drawing = rounded_plate(8, 12)
    (line,) = read_back(drawing).modelspace()
    corners = np.array([point[:] for point in line.get_points("xyb")])
    assert line.dxftype() == "LWPOLYLINE" and line.closed
    arcs = corners[:, 2] != 0
    assert arcs.sum() == (~arcs).sum() == 4
    assert corners[arcs, 2] == pytest.approx(np.tan(np.pi / 8), abs=1e-3)
    ends = np.roll(corners[:, :2], -1, axis=0)
    chords = np.linalg.norm(ends - corners[:, :2], axis=1)
    assert sorted(chords) == pytest.approx(sorted([*[8 * 2**0.5] * 4, 60, 60, 30, 30]), abs=2e-3)


def test_corners_of_few_sides_stay_polygons():
    (line,) = read_back(rounded_plate(8, 2)).modelspace()
    assert line.dxftype() == "LWPOLYLINE" and not any(bulge for *_, bulge in line.get_points("xyb"))
