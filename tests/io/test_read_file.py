import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.mesh_repair import mesh_report
from vectorplot.io.description import describe
from vectorplot.io.read_file import read

CUBE = "".join(f"v {x} {y} {z}\n" for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
FACES = ["1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def faces(chosen: list[str]) -> str:
    return "".join(f"f {face}\n" for face in chosen)


def models() -> list[Path]:
    default = Path(__file__).parents[2].parent / "shared" / "models"
    return sorted(Path(os.environ.get("VECTORPLOT_MODELS", default)).glob("*.obj"))


def test_a_closed_mesh_is_one_item_without_warning(tmp_path: Path) -> None:
    scene = read(str(written(tmp_path, "cube.OBJ", CUBE + faces(FACES))))
    assert [item.name for item in scene.items] == ["cube"]
    assert scene.items[0].shape.face_count == 6


def test_several_objects_are_several_items(tmp_path: Path) -> None:
    second = "".join(f"f {' '.join(str(int(k) + 8) for k in face.split())}\n" for face in FACES)
    text = f"o one\n{CUBE}{faces(FACES)}o two\n{CUBE.replace('v 0', 'v 5').replace('v 1', 'v 6')}{second}"
    scene = read(written(tmp_path, "pair.obj", text))
    assert [item.name for item in scene.items] == ["one", "two"]
    assert scene.items[1].shape.bounds.tolist() == [[5, 0, 0], [6, 1, 1]]
    assert all(mesh_report(item.shape).convex for item in scene.items)
    with pytest.warns(InputWarning, match=r"open.obj: open mesh \(4 boundary edges\)$"):
        scene = read(written(tmp_path, "open.obj", text.replace("f 5 6 7 8\n", "")))
    assert [item.shape.face_count for item in scene.items] == [5, 6]


def test_objects_that_share_vertices_are_one_body(tmp_path: Path) -> None:
    scene = read(written(tmp_path, "cube.obj", f"{CUBE}o top\n{faces(FACES[:3])}o rest\n{faces(FACES[3:])}"))
    assert [item.name for item in scene.items] == ["cube"]


def test_everything_that_was_mended_is_said_in_one_line(tmp_path: Path) -> None:
    text = CUBE + "v 0 0 0\nv 2 2 2\n" + faces(["9 4 3 2", *FACES[1:4], "4 3 7 8", "1 1 2", "1 7 7"])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        path = written(tmp_path, "torn.obj", text)
        scene = read(path)
    (warning,) = caught
    assert warning.category is InputWarning
    said = "welded 1 vertex, dropped 2 degenerate faces, turned 1 face round; open mesh (4 boundary edges)"
    assert str(warning.message) == f"{path}: {said}"
    assert scene.items[0].shape.bounds.tolist() == [[0, 0, 0], [1, 1, 1]]


@pytest.mark.hard(14)
def test_a_moebius_band_is_kept_and_said(tmp_path: Path) -> None:
    count = 20
    angle = np.arange(count) * 2 * np.pi / count
    lines = []
    for side in (0.3, -0.3):
        radius = 1 + side * np.cos(angle / 2)
        band = np.stack([radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2)], axis=1)
        lines += ["v {!r} {!r} {!r}".format(*point) for point in band.tolist()]
    lines += [f"f {k} {k + 1} {k + 1 + count} {k + count}" for k in range(1, count)]
    lines += [f"f {count} {count + 1} 1 {2 * count}"]
    with pytest.warns(InputWarning, match=r"open mesh \(40 boundary edges\), one-sided"):
        scene = read(written(tmp_path, "band.obj", "\n".join(lines)))
    assert scene.items[0].shape.face_count == count


@pytest.mark.parametrize(
    ("name", "content", "cause"),
    [
        ("empty.obj", "", "the file is empty"),
        ("shape", "ISO-10303-21;", "a STEP file, which is not read; give its name the suffix .step"),
        (
            "shape.fcstd",
            "PK\x03\x04",
            "a FreeCAD document, which is not read; export it as step",
        ),
        ("shape.SCAD", "cube([1,2,3]);", "an OpenSCAD program, which is not read"),
        (
            "turn.anim",
            "frames 48",
            "an animation, not a scene, which is not read; animate SCENE -a FILE moves a scene by it",
        ),
        ("shape.dxf", "0\nSECTION\n", "a DXF drawing, which is not read"),
        ("shape.gltf", "{}", "a glTF text with its data beside it, which is not read; save it as one glb file"),
        ("shape.3mf", "PK\x03\x04", "a 3MF package, which is not read"),
        ("shape.foo", "BOX bx 1 1 1", "unknown word 'bx', expected 'box' (it was read as a scene: meshes"),
        ("shape.abc", "\0\1", "a binary file, neither a scene nor a mesh"),
        ("shape.model", "  <model/>", "an XML file, which is not read"),
        ("shape.scene", "%PDF-1.4", "a PDF document, which is not read"),
        ("shape.txt", "OFF\n3 1 0", "an OFF file, which is not read; give its name the suffix .off"),
        ("flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "no face with an area (dropped 1 degenerate face)"),
        ("point.obj", "v 1 1 1\nf 1 1 1\n", "no face with an area"),
        ("huge.obj", "v 1e200 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", "out of range"),
    ],
)
def test_bad_files(tmp_path: Path, name: str, content: str, cause: str) -> None:
    path = written(tmp_path, name, content)
    with pytest.raises(InputError) as error:
        read(path)
    assert str(error.value).startswith(f"{path}:") and cause in str(error.value)


def test_missing_files_directories_and_impossible_names(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "missing.obj")
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(InputError, match="is a directory"):
        read(tmp_path / "folder.stl")
    with pytest.raises(InputError, match=r"no such file|is not a file name"):
        read("a\0b.obj")
    with pytest.raises(InputError, match=r"File name too long|no such file"):
        read("x" * 5000 + ".obj")
    with pytest.raises(InputError, match="is not a regular file"):
        read("/dev/null")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads everything")
def test_unreadable_file(tmp_path: Path) -> None:
    path = written(tmp_path, "secret.obj", CUBE)
    path.chmod(0)
    with pytest.raises(InputError, match="Permission denied"):
        read(path)


def test_info_says_counts_closedness_convexity_and_size(tmp_path: Path) -> None:
    lines = describe(read(written(tmp_path, "cube.obj", CUBE + faces(FACES))))
    assert lines == [
        "cube: 8 vertices, 12 edges, 6 faces, closed, convex, size 1 x 1 x 1, from 0,0,0 to 1,1,1",
        "1 item, 8 vertices, 12 edges, 6 faces, 0 lights, size 1 x 1 x 1, from 0,0,0 to 1,1,1",
    ]


@pytest.mark.parametrize("path", models() or [pytest.param(None, marks=pytest.mark.skip(reason="no models"))], ids=str)
def test_models_read_as_trimesh_reads_them(path: Path) -> None:
    import trimesh

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (item,) = read(path).items
        other = trimesh.load_mesh(path, process=False)
    expected = np.linalg.norm(np.cross(*(other.triangles[:, k] - other.triangles[:, 0] for k in (1, 2))), axis=1).sum()
    mesh = item.shape
    fans = np.concatenate([[[f[0], f[k], f[k + 1]] for k in range(1, len(f) - 1)] for f in mesh.polygons()])
    corners = mesh.vertices[fans]
    area = np.linalg.norm(np.cross(*(corners[:, k] - corners[:, 0] for k in (1, 2))), axis=1).sum()
    assert np.isclose(area, expected, rtol=1e-3)
    assert np.allclose(mesh.bounds, [other.triangles.min(axis=(0, 1)), other.triangles.max(axis=(0, 1))])


@pytest.mark.slow
def test_reading_a_closed_mesh_loads_neither_scipy_nor_trimesh(tmp_path: Path) -> None:
    path = written(tmp_path, "cube.obj", CUBE + faces(FACES))
    code = "import sys; from vectorplot.io.read_file import read; read(sys.argv[1]); print(*sys.modules)"
    found = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True)
    assert not {"scipy", "trimesh", "shapely", "cairo"} & set(found.stdout.split())
