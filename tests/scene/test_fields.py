"""Numbers of files at vertices and on faces: read, named, kept through cuts and moves, and coloured by."""

from types import SimpleNamespace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.effects import cut_scene
from vectorplot.effects.colour_maps import coloured
from vectorplot.errors import InputError
from vectorplot.geometry import box
from vectorplot.io import parse_scene
from vectorplot.io.anything import scene_of
from vectorplot.io.description import describe
from vectorplot.scene import Colouring, Fields

CUBE = box((2, 2, 2))
LINEAR = CUBE.vertices @ (1.0, 2.0, 4.0)
POLYGONS = [*CUBE.polygons(), [0, 1]]
STRESS = np.arange(7.0)


def ply(form: str, faces: list[list[int]], quality: np.ndarray) -> bytes:
    """The cube with the property quality of vertices, between x and y, and stress of faces, behind their list."""
    head = f"ply\nformat {form} 1.0\nelement vertex 8\nproperty double x\nproperty float quality\nproperty double y\n"
    head += (
        f"property double z\nelement face {len(faces)}\nproperty uchar tag\nproperty list uchar int vertex_indices\n"
    )
    head += "property double stress\nend_header\n"
    order = ">" if form == "binary_big_endian" else "<"
    body = b""
    for (x, y, z), q in zip(CUBE.vertices.tolist(), quality.tolist(), strict=True):
        record = np.array([(x, q, y, z)], dtype=f"{order}f8,{order}f4,{order}f8,{order}f8")
        body += f"{x} {q} {y} {z}\n".encode() if form == "ascii" else record.tobytes()
    for face, value in zip(faces, STRESS.tolist(), strict=False):
        if form == "ascii":
            body += f"5 {len(face)} {' '.join(map(str, face))} {value}\n".encode()
        else:
            body += bytes([5, len(face)]) + np.array(face, order + "i4").tobytes()
            body += np.array(value, order + "f8").tobytes()
    return head.encode() + body


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("count", [6, 7])
def test_properties_of_ply_files_are_fields(tmp_path, form, count):
    path = tmp_path / "part.ply"
    path.write_bytes(ply(form, POLYGONS[:count], LINEAR))
    item = vp.read(path).items[0]
    assert item.fields.names == ("quality", "tag", "stress")
    assert item.fields.at("quality", item.mesh.vertices).tolist() == LINEAR.tolist()
    middles = np.array([item.mesh.vertices[face].mean(axis=0) for face in item.mesh.polygons()])
    assert item.fields.at("stress", middles).tolist() == STRESS[:6].tolist()
    (tmp_path / "two.scene").write_text('P mesh "part.ply" translation 5 0 0 colour_by stress')
    placed = vp.read(tmp_path / "two.scene").items[0]
    assert placed.fields.at("stress", middles + np.array([5.0, 0.0, 0.0])).tolist() == STRESS[:6].tolist()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_numbers_stay_in_their_places_when_a_body_is_cut_and_moved(scale):
    item = vp.Item("C", CUBE, fields=Fields(CUBE, {"n": LINEAR})).turned("z", 90).scaled(scale).moved(scale, 0, 0)
    scene = vp.cut(vp.Scene((item,)), f"z > {1.25 * scale!r}")
    left = cut_scene(scene).items[0]
    true = ((left.mesh.vertices - (scale, 0, 0)) / scale)[:, [1, 0, 2]] * (1, -1, 1) @ (1.0, 2.0, 4.0)
    np.testing.assert_allclose(left.fields.at("n", left.mesh.vertices), true, atol=1e-9)


def test_bands_have_the_areas_of_the_numbers_and_what_has_none_keeps_its_colour():
    strip = vp.Mesh.from_polygons(
        [(x, y, 0) for x in range(4) for y in range(2)], [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(3)]
    )
    at = {"t": np.repeat([0.0, 1.0, 2.0, np.nan], 2)}
    other = vp.Item("O", CUBE, "blue")
    for by in ("t", "f"):
        fields = Fields.of(strip, at, {"f": [0.0, 3.0, np.inf]})
        after, bar = coloured(vp.Scene((vp.Item("S", strip, "red", fields=fields), other)), Colouring(by, steps=2))
        area = {one.name: float(np.linalg.norm(one.mesh.area_vectors, axis=1).sum()) / 2.0 for one in after.items}
        assert area == pytest.approx({"S 0": 1.0, "S 1": 1.0, "S 2": 1.0, "O": 24.0})
        assert [one.colour for one in after.items if one.name in ("S 0", "O")] == ["red", "blue"]
        assert (bar.low, bar.high) == ((0.0, 2.0) if by == "t" else (0.0, 3.0))


def test_meshes_of_other_libraries_bring_theirs():
    like_trimesh = SimpleNamespace(
        vertices=CUBE.vertices,
        faces=np.array(CUBE.polygons()),
        vertex_attributes={"flow": CUBE.vertices, "names": np.array(["a"] * 8), "few": np.zeros(3)},
        face_attributes={"stress": STRESS[:6]},
    )
    fields = scene_of(like_trimesh).items[0].fields
    assert fields.names == ("flow", "flow.x", "flow.y", "flow.z", "stress")
    assert fields.at("flow", np.array([(2.0, 2.0, 1.0)])) == pytest.approx(np.sqrt(12.0) / 2.0 + np.sqrt(8.0) / 2.0)
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)], dtype=float)
    like_meshio = SimpleNamespace(
        points=points,
        cells=[("tetra", np.array([(0, 1, 2, 3), (1, 4, 2, 3)]))],
        point_data={"t": points[:, 0]},
        cell_data={"p": [np.array([1.0, 2.0])]},
    )
    fields = scene_of(like_meshio).items[0].fields
    assert fields.mesh.face_count == 6 and fields.names == ("t", "p")
    assert fields.at("p", np.array([(0.2, 0.2, 0.0), (2 / 3, 2 / 3, 1 / 3)])).tolist() == [1.0, 2.0]


@pytest.mark.slow
def test_every_verb_knows_them_by_name_and_an_unknown_name_gets_its_nearest(tmp_path, capsys):
    path = tmp_path / "part.ply"
    path.write_bytes(ply("ascii", POLYGONS[:6], np.where(LINEAR > 12.0, np.nan, LINEAR)))
    for verb, out in (("draw", "a.svg"), ("paint", "a.pdf"), ("render", "a.png")):
        small = ["--size", "80x60"] if verb == "render" else []
        assert run([verb, str(path), "--colour-by", "quality", *small, "-q", "-o", str(tmp_path / out)]) == 0
    assert run(["draw", str(path), "--colour-by", "qualty", "-q", "-o", str(tmp_path / "b.svg")]) == 1
    said = capsys.readouterr().err
    assert "curvature, quality, tag, stress, or a formula (did you mean 'quality'?)" in said
    assert run(["info", str(path), "--up", "y"]) == 0
    assert "part: fields quality, tag, stress" in capsys.readouterr().out
    with pytest.raises(InputError, match="nothing in the scene has a finite number"):
        item = vp.Item("C", CUBE, fields=Fields(CUBE, {"n": np.full(8, np.nan)}))
        vp.draw(vp.Scene((item,), colouring=Colouring("n")))


def test_info_tells_of_cuts_and_of_parts_that_are_moved_apart():
    text = 'A box 2 2 2  S box 1 1 3  cut "x + 2*y > 3" ghost of "A"  cut "y = 0"  explode z 2'
    assert describe(parse_scene(text))[2:5] == [
        "cut 0.5x + y > 1.5, ghost, of A",
        "cut y = 0, gone",
        "parts moved apart by 2, then size 2 x 2 x 7.5, from 0,0,0 to 2,2,7.5",
    ]
