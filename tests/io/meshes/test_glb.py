import json
import struct
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import trimesh
from fuzz.fuzz_meshes import random_tree

from vectorplot.errors import InputError
from vectorplot.io.glb import read_glb
from vectorplot.io.read_file import read

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype="<f4")
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype="<u2")


def tree() -> dict[str, Any]:
    """Two nodes that show the same tetrahedron."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"mesh": 0, "name": "left"},
            {"mesh": 0, "name": "right", "translation": [5, 0, 0], "scale": [2, 2, 2]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 24},
        ],
        "buffers": [{"byteLength": 72}],
    }


def glb(folder: Path, content: dict[str, Any], *, points: np.ndarray = POINTS, faces: np.ndarray = FACES) -> Path:
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    data = points.tobytes() + faces.tobytes()
    path = folder / "shape.glb"
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
    path.write_bytes(head + text + struct.pack("<II", len(data), 0x004E4942) + data)
    return path


def test_nodes_are_items_with_z_up(tmp_path: Path) -> None:
    scene = read(glb(tmp_path, tree()))
    assert [item.name for item in scene.items] == ["left", "right"]
    left, right = (item.shape for item in scene.items)
    assert left.face_count == right.face_count == 4
    assert left.bounds.tolist() == [[0, -1, 0], [1, 0, 1]]
    assert right.bounds.tolist() == [[5, -2, 0], [7, 0, 2]]
    # The triangle that was y = 0 before, which looked along -y, now looks along -z.
    assert (left.face_normals @ np.array([0, 0, -1])).max() == 1.0


def test_primitives_of_a_node_are_one_body_in_the_order_of_the_file(tmp_path: Path) -> None:
    content = tree()
    half = {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}
    content["accessors"] += [half, {**half, "byteOffset": 12}]
    primitives = [{"attributes": {"POSITION": 0}, "indices": k} for k in (2, 3)]
    content["meshes"].append({"primitives": [*primitives, {"attributes": {"POSITION": 0}, "mode": 0}]})
    content["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]})
    content["nodes"] += [{"mesh": 1, "name": "left"}, {"mesh": 2, "name": "points"}]
    content["nodes"][0]["children"] = [2, 3]
    parts = read_glb(glb(tmp_path, content))
    assert parts.names == ("left", "right", "left")
    assert parts.first_faces == (0, 4, 8)
    corners = parts.mesh.vertices[parts.mesh.corners].reshape(3, 12, 3)
    assert np.array_equal(corners[0], corners[2])


def test_a_mirrored_node_keeps_its_outside(tmp_path: Path) -> None:
    content = tree()
    content["nodes"][1]["scale"] = [-2, 2, 2]
    shape = read(glb(tmp_path, content)).items[1].shape
    centre = shape.vertices.mean(axis=0)
    assert (((shape.vertices[shape.corners[::3]] - centre) * shape.face_normals).sum(axis=1) > 0).all()


@pytest.mark.hard(64)
@pytest.mark.parametrize("uri", ["../../etc/passwd", "file:///etc/passwd", "http://localhost/x.bin"])
def test_model_uri_is_not_followed(tmp_path: Path, uri: str) -> None:
    content = tree()
    content["images"] = [{"uri": uri}]
    content["textures"] = [{"source": 0}]
    content["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    content["meshes"][0]["primitives"][0]["material"] = 0
    path = glb(tmp_path, content)
    assert len(read(path).items) == 2
    content["buffers"][0]["uri"] = uri
    with pytest.raises(InputError, match=r"buffer 0 lies outside the binary chunk .*: not followed"):
        read_glb(glb(tmp_path, content))


def changed(path: list[Any], value: Any) -> dict[str, Any]:
    content = tree()
    place = content
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return content


@pytest.mark.hard(65)
@pytest.mark.parametrize(
    ("path", "value", "cause"),
    [
        (["accessors", 0, "count"], 10**12, "accessor 0 announces 1000000000000 items"),
        (["accessors", 1, "count"], -1, "accessor 1 announces -1 items"),
        (["accessors", 0, "count"], "4", "accessor 0 announces 4 items"),
        (["accessors", 0, "byteOffset"], 8, "accessor 0 announces 4 items"),
        (["accessors", 0, "sparse"], {}, "accessor 0 is sparse or empty"),
        (["bufferViews", 0, "byteLength"], 10**12, "buffer view 0 reaches beyond"),
        (["bufferViews", 1, "byteOffset"], -4, "buffer view 1 reaches beyond"),
        (["nodes", 0, "children"], [0], "a node has two parents"),
        (["nodes", 0, "children"], [7], "damaged glTF"),
        (["nodes", 0, "mesh"], 3, "node 0 shows mesh 3, which does not exist"),
        (["meshes", 0, "primitives", 0, "attributes"], {}, "damaged glTF"),
        (["meshes", 0, "primitives", 0, "indices"], 9, "damaged glTF"),
        (["meshes"], "no", "damaged glTF"),
        (["extensionsRequired"], ["KHR_draco_mesh_compression"], "needs the extension KHR_draco"),
        (["nodes"], [], "damaged glTF|no triangles"),
    ],
)
def test_lying_sizes_in_glb_are_refused(tmp_path: Path, path: list[Any], value: Any, cause: str) -> None:
    with pytest.raises(InputError, match=cause) as error:
        read_glb(glb(tmp_path, changed(path, value)))
    assert str(error.value).isprintable()


@pytest.mark.hard(53)
def test_nan_and_wild_indices_in_glb_are_refused(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[1, 1] = np.inf
    with pytest.raises(InputError, match="a coordinate is not a finite number"):
        read_glb(glb(tmp_path, tree(), points=points))
    faces = FACES.copy()
    faces[3, 2] = 4
    with pytest.raises(InputError, match=r"shape.glb: "):
        read_glb(glb(tmp_path, tree(), faces=faces))


@pytest.mark.parametrize("seed", range(60))
def test_any_tree_is_read_as_trimesh_reads_it(tmp_path: Path, seed: int) -> None:
    content, binary = random_tree(Random(seed))
    content["meshes"][0]["primitives"][0].update(mode=(4, 5)[seed % 2], indices=1)
    path = glb(tmp_path, content, points=np.frombuffer(binary, np.uint8), faces=np.zeros(0, np.uint8))
    expected = trimesh.load_scene(path, process=False).to_geometry()
    if not len(getattr(expected, "faces", ())):
        with pytest.raises(InputError, match="no triangles"):
            read_glb(path)
        return
    x, y, z = read_glb(path).mesh.vertices[read_glb(path).mesh.corners].T
    found = np.stack([x, z, -y], axis=1).reshape(-1, 9)
    assert np.allclose(turned(found), turned(np.asarray(expected.triangles).reshape(-1, 9)), atol=1e-6)


def turned(triangles: np.ndarray) -> np.ndarray:
    """Triangles (t,9) with their smallest corner first, in ascending order, for a comparison."""
    corners = np.round(triangles.reshape(-1, 3, 3), 5) + 0.0
    ways = np.stack([np.roll(corners, -k, axis=1).reshape(-1, 9) for k in range(3)], axis=1).tolist()
    return np.array(sorted(min(way) for way in ways))


@pytest.mark.parametrize("cut", [3, 15, 100, -5])
def test_truncated_file(tmp_path: Path, cut: int) -> None:
    path = glb(tmp_path, tree())
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(InputError, match=r"truncated|not a glb file"):
        read_glb(path)
