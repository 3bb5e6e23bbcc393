"""Meshes that are written are read again as they were, by this package and by others."""

import io

import numpy as np
import pytest
import trimesh

import vectorplot as vp
from vectorplot.curves import Helix
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import box, prism
from vectorplot.save import MESHES
from vectorplot.surfaces import Sphere, Torus

ANGLE = prism([(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)], (0, 0, 1))
"""Its base and its cover are not convex; its volume is 3."""


@pytest.mark.parametrize("format", MESHES)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_body_comes_back_as_it_was(tmp_path, format, scale):
    path = tmp_path / f"angle.{format}"
    vp.save(ANGLE.scaled(scale), path)
    (item,) = vp.read(path).items
    other = trimesh.load(path, force="mesh") if format != "off" else None
    assert item.mesh.is_closed
    assert item.mesh.face_count == (20 if format == "stl" else 8)
    np.testing.assert_allclose(item.mesh.bounds, ANGLE.bounds * scale, rtol=1e-7)
    assert other is None or (other.is_watertight and other.volume == pytest.approx(3.0 * scale**3))


@pytest.mark.parametrize("format", ["obj", "ply", "off"])
def test_texts_keep_every_digit(tmp_path, format):
    body = box((0.1, 1 / 3, 2e-7)).moved(1e3, 0.0, 0.0)
    vp.save(body, tmp_path / f"a.{format}")
    (item,) = vp.read(tmp_path / f"a.{format}").items
    assert np.array_equal(np.unique(item.mesh.vertices, axis=0), np.unique(body.vertices, axis=0))


def test_objects_keep_their_names_in_obj(tmp_path):
    scene = vp.Scene((vp.Item("lower part", ANGLE), vp.Item("upper", box((1, 1, 1)).moved(0, 0, 1))))
    vp.save(scene, tmp_path / "a.obj")
    assert [item.name for item in vp.read(tmp_path / "a.obj").items] == ["lower part", "upper"]


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("a\\", "a"),
        ("\\ \\", "mesh"),
        ("fl\udcfcgel", "fl?gel"),
        ("a\x00\nf 1 2 3", "a? f 1 2 3"),
        ("Ω <&> $_^{} #", ""),
    ],
)
def test_a_name_is_never_more_than_a_name_in_obj(tmp_path, name, written):
    """One that ends in a backslash would swallow the next line; names of files may hold halves of letters."""
    vp.save(vp.Scene((vp.Item(name, ANGLE), vp.Item("next", box((1, 1, 1))))), tmp_path / "a.obj")
    found = vp.read(tmp_path / "a.obj").items
    assert [item.name for item in found] == [written or name, "next"]
    assert [len(item.mesh.vertices) for item in found] == [12, 8]


def test_stl_says_when_its_digits_do_not_hold_a_shape(tmp_path):
    vp.save(ANGLE.moved(100.0, 0.3, 0.1), tmp_path / "a.stl")
    with pytest.warns(InputWarning, match="stl holds seven digits: places are off by up to 0.2; move the shape nearer"):
        vp.save(ANGLE.moved(0.0, 5.2e6 + 0.2, 0.0), tmp_path / "a.stl")


@pytest.mark.slow
def test_a_smooth_surface_is_as_near_as_is_said_and_turned_outwards(tmp_path):
    vp.save(Torus(3.0, 1.0), tmp_path / "ring.stl")
    found = trimesh.load(tmp_path / "ring.stl")
    x, y, z = found.vertices.T
    assert np.abs(np.hypot(np.hypot(x, y) - 3.0, z) - 1.0).max() < 1e-6
    # The middles of triangles lie inside, and no farther than a part of 0.00005 of the diagonal.
    x, y, z = found.triangles_center.T
    assert np.abs(np.hypot(np.hypot(x, y) - 3.0, z) - 1.0).max() < 5e-5 * np.hypot(8.0 * 2**0.5, 2.0)
    assert found.is_watertight and found.volume == pytest.approx(6.0 * np.pi**2, rel=1e-3)


def test_faces_that_are_not_there_are_not_written(tmp_path):
    open_box = next(iter(vp.read("data/removed_faces.scene").items))
    vp.save(open_box, tmp_path / "a.off")
    with pytest.warns(InputWarning, match="open mesh"):
        (item,) = vp.read(tmp_path / "a.off").items
    present = open_box.mesh.present
    assert present is not None and item.mesh.face_count == present.sum() < open_box.mesh.face_count


def test_a_list_of_shapes_is_written_into_an_open_file():
    file = io.BytesIO()
    vp.save([ANGLE, vp.Item("ball", Sphere(0.01)).moved(5, 0, 0)], file, format="STL")
    content = file.getvalue()
    assert len(content) == 84 + 50 * int.from_bytes(content[80:84], "little")
    assert not content.startswith(b"solid")


@pytest.mark.parametrize(
    ("shown", "name", "words"),
    [
        (Helix(1.0, 1.0), "a.stl", "there are no faces"),
        (vp.Scene(()), "a.obj", "there are no faces"),
        (ANGLE, "a.svg", "a Mesh is written as scene, stl, obj, ply, off, not as svg: draw, paint or render it first"),
        (vp.draw(vp.Scene((vp.Item("a", ANGLE),))), "a.stl", "a picture has no faces"),
        (ANGLE.scaled(1e60), "a.stl", "stl holds numbers up to 3.4e38"),
    ],
    ids=["curve", "empty", "mesh as svg", "drawing as stl", "too large"],
)
def test_what_is_no_mesh_is_refused_in_a_line(tmp_path, shown, name, words):
    with pytest.raises(InputError, match=words):
        vp.save(shown, tmp_path / name)
    assert not list(tmp_path.iterdir())
