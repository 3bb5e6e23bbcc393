"""Parts of CAD systems that are drawn from the surfaces of their faces, where OpenCASCADE is there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support import cad_parts
from support.cad_parts import PARTS, agrees, axes, explored, occ, samples, write_step

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.anything import scene_of
from vectorplot.io.cad_files import EdgeKind

pytest.importorskip("OCP")

MAPPED = ["bracket", "rounded tee", "loft to a circle", "turned spline", "prism of a spline", "half turned"]
"""One for each kind of surface at least."""


@pytest.mark.slow
@pytest.mark.parametrize("name", MAPPED)
def test_lines_are_where_rays_see_them(name: str):
    shape = PARTS[name]()
    scene = scene_of(shape, parts="exact")
    assert all(item.exact is not None for item in scene.items)
    middle, extent = scene.bounds.mean(axis=0), float(np.linalg.norm(np.ptp(scene.bounds, axis=0)))
    for eye in ((0.3, -1.0, 0.45), (0.0, -1.0, 0.0)):
        way = np.array(eye) / np.linalg.norm(eye)
        camera = vp.Camera(tuple(middle + 20.0 * extent * way), tuple(middle), parallel=True)
        places = samples(vp.draw(scene, camera, hidden="solid"))
        assert len(places) > 3
        wrong = [place for place, seen in places if not agrees(shape, place, way, seen, extent)]
        assert not wrong, wrong[:3]


@pytest.mark.slow
def test_lengths_are_those_of_fine_triangles():
    for name in ("box with a bore", "flange"):
        camera = vp.Camera((220.0, -330.0, 180.0), (10.0, 10.0, 10.0))
        totals = []
        for parts in ("triangles", "exact"):
            drawing = vp.draw(scene_of(PARTS[name](), parts=parts), camera, page="A4")
            totals.append(
                {
                    layer.name: sum(float(np.hypot(*np.diff(p.points, axis=0).T).sum()) for p in layer.strokes)
                    for layer in drawing.layers
                }
            )
        assert set(totals[0]) == set(totals[1])
        assert sum(totals[1].values()) == pytest.approx(sum(totals[0].values()), rel=0.01)


def test_edges_of_faces_lie_on_them_and_have_kinds():
    (item,) = scene_of(PARTS["bracket"](), parts="exact").items
    body = item.exact
    assert body is not None and body.mesh is item.shape
    edges = body.edges
    rows = [slice(*edges.offsets[k : k + 2]) for k in range(len(edges.edge))]
    off = [
        np.abs(body.trimmed_faces[face].surface.points(*edges.places[own].T) - edges.points[own]).max()
        for face, own in zip(edges.face.tolist(), rows, strict=True)
    ]
    assert max(off) < 1e-6
    kinds = np.bincount(edges.kind, minlength=3)
    assert kinds[EdgeKind.SHARP] > 0 and kinds[EdgeKind.TANGENT] > 0
    assert (np.bincount(edges.edge) == 2).all()


def test_an_assembly_shares_what_it_places(tmp_path: Path):
    both = cad_parts.Assembly()
    pin = both.part("pin", cad_parts.rod(3, 10))
    both.group("pins", (pin, (0, 0, 0)), (pin, (10, 0, 0)))
    one, two = vp.read(both.write(tmp_path / "pins.step"), parts="exact").items
    assert one.exact is not None and two.exact is not None
    assert np.allclose(two.exact.edges.points - one.exact.edges.points, (10, 0, 0))
    assert two.exact.mesh is two.shape


def test_what_has_no_counterpart_is_drawn_from_triangles_and_said():
    offset = occ("Geom", "Geom_OffsetSurface")(
        occ("Geom", "Geom_SurfaceOfLinearExtrusion")(
            occ("Geom", "Geom_Ellipse")(axes(0, 0, 0), 6.0, 3.0), occ("gp", "gp_Dir")(0, 0, 1)
        ),
        1.0,
    )
    face = occ("BRepBuilderAPI", "BRepBuilderAPI_MakeFace")(offset, 0.0, 3.0, 0.0, 5.0, 1e-6).Face()
    with pytest.warns(InputWarning, match="drawn from triangles, not exactly: topods_face: a face on what OpenCASCADE"):
        (item,) = scene_of(face, parts="exact").items
    assert item.exact is None and item.mesh.face_count


def test_open_faces_have_borders():
    (face, *_) = explored(cad_parts.rod(10, 40), "FACE")
    (item,) = scene_of(face, parts="exact").items
    drawing = vp.draw(item, vp.Camera((120.0, -160.0, 150.0), (0.0, 0.0, 20.0)))
    assert {"boundary"} <= {
        vp.words.LineKind(int(kind)).word for layer in drawing.layers for p in layer.strokes for kind in p.kind
    }


@pytest.mark.slow
def test_the_command_writes_circles(tmp_path: Path):
    path, out = write_step(PARTS["flange"](), tmp_path / "flange.step"), tmp_path / "flange.dxf"
    assert run(["draw", str(path), "-o", str(out), "--quiet", "--parts", "exact", "--view", "top"]) == 0
    words = out.read_text().split("\n")
    assert words.count("CIRCLE") >= 9 and not words.count("SPLINE") and not words.count("LWPOLYLINE")


def test_a_way_of_drawing_is_for_parts_only(tmp_path: Path):
    path = tmp_path / "box.scene"
    path.write_text("BOX red box 1 2 3")
    with pytest.raises(InputError, match="a way of drawing parts is for CAD parts only"):
        vp.read(path, parts="exact")
    with pytest.raises(InputError, match="way of drawing parts 'exakt': expected one of triangles, exact"):
        scene_of(cad_parts.rod(10, 40), parts="exakt")
