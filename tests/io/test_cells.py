"""Files of VTK: their faces, the outer ones of volumes, and their fields."""

from __future__ import annotations

import builtins
from pathlib import Path

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.errors import InputError
from vectorplot.io import parse_scene
from vectorplot.scene import Colouring

TWO_CUBES = """# vtk DataFile Version 3.0
two cubes
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 12 double
0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 0 0 2 1 0 2 1 1 2 0 1 2
CELLS 2 18
8 0 1 2 3 4 5 6 7
8 4 5 6 7 8 9 10 11
CELL_TYPES 2
12
12
POINT_DATA 12
SCALARS heat double 1
LOOKUP_TABLE default
0 0 0 0 1 1 1 1 2 2 2 2
CELL_DATA 2
SCALARS part double 1
LOOKUP_TABLE default
7 8
"""


@pytest.fixture
def cubes(tmp_path: Path) -> Path:
    file = tmp_path / "cubes.vtk"
    file.write_text(TWO_CUBES)
    return file


def test_volumes_are_their_outer_faces_with_fields(cubes: Path) -> None:
    pytest.importorskip("meshio")
    (item,) = vp.read(cubes).items
    assert (item.name, item.mesh.face_count, len(item.mesh.vertices)) == ("cubes", 10, 12)
    assert np.linalg.norm(item.mesh.area_vectors, axis=1).sum() / 2 == pytest.approx(10.0)
    assert set(item.fields.names) == {"heat", "part"}
    places = np.array([(0.5, 0.0, 0.5), (1.0, 0.5, 1.75), (0.5, 0.5, 2.0)])
    np.testing.assert_allclose(item.fields.at("heat", places), (0.5, 1.75, 2.0))
    np.testing.assert_allclose(item.fields.at("part", places), (7.0, 8.0, 8.0))
    picture = vp.paint(vp.Scene((item,), colouring=Colouring("heat", at=(0, 1, 2))), "front", page="80x60")
    assert picture.layers[-1].name == "colour bar"


def test_a_scene_file_names_them(cubes: Path) -> None:
    pytest.importorskip("meshio")
    scene = cubes.with_name("cubes.scene")
    scene.write_text('colour_by heat\nCUBES gray mesh "cubes.vtk" translation 5 0 0')
    (item,) = vp.read(scene).items
    assert item.fields.at("heat", np.array([(5.5, 0.0, 1.5)])).tolist() == [1.5]


def test_what_is_no_such_file_is_told_in_a_line(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    for name, text in (
        ("a.vtk", TWO_CUBES.replace("DATASET UNSTRUCTURED_GRID", "DATASET NONE")),
        ("b.vtu", "<VTKFile"),
        ("c.vtk", "hello"),
    ):
        file = tmp_path / name
        file.write_text(text)
        with pytest.raises(InputError, match=rf"{name}.*meshio cannot read it: .") as found:
            vp.read(file)
        assert "\n" not in str(found.value)
    (tmp_path / "d.vtk").write_text(TWO_CUBES.replace("1 1 2 0 1 2", "1 1 nan 0 1 2"))
    with pytest.raises(InputError, match="not finite"):
        vp.read(tmp_path / "d.vtk")


def test_without_meshio_it_is_told_what_to_install(cubes: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    load = builtins.__import__

    def without(name: str, *rest: object, **more: object) -> object:
        if name == "meshio":
            raise ImportError(name)
        return load(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"needs meshio: pip install '\.\[vtk\]'"):
        vp.read(cubes)


GRID = "ncols 3\nnrows 2\nxllcenter 10\nyllcenter 20\ncellsize 5\n1 2 3\n4 5 6\n"


def test_a_scene_file_names_heights(tmp_path: Path) -> None:
    (tmp_path / "hill.asc").write_text(GRID)
    scene = tmp_path / "hill.scene"
    scene.write_text('HILL green terrain "hill.asc" exaggeration 2 translation 1 0 0 level_lines 3 BOX gray box 1 1 1')
    hill, _ = vp.read(scene).items
    assert hill.mesh.bounds.tolist() == [[11.0, 20.0, 2.0], [21.0, 25.0, 12.0]]
    finer = tmp_path / "finer.scene"
    finer.write_text('HILL green terrain "hill.asc" densified 4')
    assert len(vp.read(finer).items[0].mesh.vertices) == 9 * 5


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('terrain "no.asc"', "no such file"),
        ('terrain "../hill.asc"', "outside the folder"),
        ('terrain "hill.obj"', "ends in .asc, .xyz"),
        ('terrain "bad.asc"', "bad.asc"),
        ('terrain "hill.asc" cells 3 3', "cells"),
    ],
)
def test_what_is_wrong_with_named_heights_is_told(text: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "hill.asc").write_text(GRID)
    (tmp_path / "bad.asc").write_text(GRID.replace("4 5 6", "4 5"))
    scene = tmp_path / "hill.scene"
    scene.write_text(f"HILL green {text}")
    with pytest.raises(InputError, match=told):
        vp.read(scene)
    with pytest.raises(InputError, match="names no files"):
        parse_scene('HILL green terrain "hill.asc"')


def test_what_is_no_file_of_vtk_is_said_in_one_line(tmp_path, capfd):
    pytest.importorskip("meshio")
    (tmp_path / "bad.vtk").write_text("hello")
    assert run(["draw", str(tmp_path / "bad.vtk"), "-o", str(tmp_path / "x.svg")]) == 1
    assert len(capfd.readouterr().err.splitlines()) == 1
    assert not (tmp_path / "x.svg").exists()
