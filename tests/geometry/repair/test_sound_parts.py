"""Parts that need no mending, found all at once, as mending each by itself finds them."""

from __future__ import annotations

import numpy as np
import pytest
from support.pace import cpu_seconds

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import Mending, repaired, sound_parts
from vectorplot.testing.shapes import box
from vectorplot.tolerances import ULP


def tile(x: float = 0.0) -> Mesh:
    """An open strip of two quads."""
    places = [(x + i, j, 0.1 * i * j) for i in range(3) for j in range(2)]
    return Mesh.from_polygons(places, [(0, 2, 3, 1), (2, 4, 5, 3)])


def parts() -> dict[str, Mesh]:
    cube = box((0, 0, 0), (1, 1, 1))
    strip = tile()
    turned = strip.corners.copy()
    turned[4:] = turned[4:][::-1]
    soup = Mesh(strip.vertices[strip.corners], np.arange(8), strip.offsets)
    fan = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, -1, 0)]
    bow = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, -1, 0)]
    hollow = cube.reversed()
    close = np.concatenate([strip.vertices, strip.vertices + np.array([0.0, 0.0, 1e-16])])
    return {
        "strip": strip,
        "its neighbour": tile(2.0),
        "far": Mesh(strip.vertices + np.array([1e5, 0.0, 0.0]), strip.corners, strip.offsets),
        "cube": cube,
        "inside out": hollow,
        "in the cube": Mesh(0.25 + 0.5 * hollow.vertices, hollow.corners, hollow.offsets),
        "without winding": Mesh(strip.vertices, turned, strip.offsets),
        "soup": soup,
        "three at an edge": Mesh.from_triangles(fan, [(0, 1, 2), (0, 1, 3), (0, 1, 4)]),
        "bow": Mesh.from_triangles(bow, [(0, 1, 2), (0, 3, 4)]),
        "thin": Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)]),
        "twice": Mesh(strip.vertices, np.tile(strip.corners, 2), np.arange(0, 17, 4)),
        "close": Mesh(close, np.concatenate([strip.corners, strip.corners + 6]), np.arange(0, 17, 4)),
        "loose": Mesh(np.concatenate([strip.vertices, [(9, 9, 9)]]), strip.corners, strip.offsets),
    }


def united(meshes: list[Mesh]) -> tuple[Mesh, np.ndarray]:
    first = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    corners = np.concatenate([m.corners + k for m, k in zip(meshes, first[:-1], strict=True)])
    sizes = np.concatenate([m.face_sizes for m in meshes])
    owner = np.repeat(np.arange(len(meshes)), [m.face_count for m in meshes])
    return Mesh(np.concatenate([m.vertices for m in meshes]), corners, np.concatenate([[0], np.cumsum(sizes)])), owner


@pytest.mark.parametrize("seed", range(8))
def test_what_is_sound_mending_leaves_alone(seed: int) -> None:
    random = np.random.default_rng(seed)
    zoo = parts()
    names = random.choice(list(zoo), 30)
    meshes = [zoo[name] for name in names]
    sound, boundary = sound_parts(*united(meshes), len(meshes), ULP)
    for name, mesh, good, count in zip(names, meshes, sound, boundary, strict=True):
        after, mending = repaired(mesh, ULP)
        if good:
            assert mending == Mending(boundary_edges=int(count)), name
            assert after.corners.tolist() == mesh.corners.tolist()
            assert np.array_equal(after.vertices, mesh.vertices[: len(after.vertices)])
        else:
            assert name not in ("strip", "its neighbour", "far", "cube", "loose"), name


@pytest.mark.slow
def test_files_of_many_open_parts_are_read_as_fast_as_one_mesh(tmp_path) -> None:
    def written(meshes: list[Mesh]) -> vp.Scene:
        lines, base = [], 1
        for k, mesh in enumerate(meshes):
            lines += [f"o p{k}", *(f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist())]
            lines += [f"f {' '.join(str(base + c) for c in face)}" for face in mesh.polygons()]
            base += len(mesh.vertices)
        (tmp_path / "m.obj").write_text("\n".join(lines) + "\n")
        # Each by itself they took .9 ms.
        with cpu_seconds(1.0), pytest.warns(InputWarning, match="boundary edges"):
            return vp.read(tmp_path / "m.obj")

    zoo = list(parts().values())
    for item, mesh in zip(written(zoo).items, zoo, strict=True):
        after, _ = repaired(mesh, ULP)
        assert np.array_equal(item.mesh.vertices, after.vertices) and np.array_equal(item.mesh.corners, after.corners)
    assert len(written([tile(3.0 * k) for k in range(3000)]).items) == 3000
