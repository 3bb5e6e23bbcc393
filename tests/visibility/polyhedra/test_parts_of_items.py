"""Parts of items: what hangs together is not searched for intersections, however many faces it has."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import connectivity as pieces
from vectorplot.geometry import mesh_repair
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import MANY_FACES, joined_seams
from vectorplot.testing.shapes import box, bumpy_icosphere

BALL = bumpy_icosphere(5, bump=0.2)
FAR = BALL.transformed([(1, 0, 0, 1.1), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)])
CAMERA = vp.Camera((5, -7, 4), target=(0.5, 0, 0))


def together(*meshes: Mesh) -> Mesh:
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = np.concatenate([mesh.corners + k for mesh, k in zip(meshes, first[:-1], strict=True)])
    sizes = np.concatenate([mesh.face_sizes for mesh in meshes])
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), corners, np.cumsum([0, *sizes]))


def drawn(*meshes: Mesh) -> vp.Drawing:
    scene = vp.Scene(tuple(vp.Item(str(k), mesh) for k, mesh in enumerate(meshes)))
    return vp.draw(scene, CAMERA, lines="intersection", page=vp.Page(100, 100))


def points_of(drawing: vp.Drawing) -> list[tuple[float, float]]:
    return sorted({tuple(p) for layer in drawing.layers for m in layer.marks for p in np.round(m.points, 6).tolist()})


@pytest.mark.slow
def test_large_meshes_meet_whether_they_are_items_or_pieces_of_one_beside_small_ones_or_alone() -> None:
    assert BALL.face_count >= MANY_FACES
    two = points_of(drawn(BALL, FAR))
    assert len(two) > 20
    assert points_of(drawn(together(BALL, FAR))) == two
    bent = together(box((-9, 0, -9), (-8, 1, -8)), box((-9, 2, -9), (-8, 3, -8)))
    assert points_of(drawn(bent, BALL, FAR)) == two
    assert not drawn(BALL, bent).layers


def test_a_large_mesh_is_looked_through_once_from_the_file_to_the_drawing(monkeypatch: pytest.MonkeyPatch) -> None:
    looks: list[int] = []
    sides = pieces.pieces_of_sides
    monkeypatch.setattr(
        pieces, "pieces_of_sides", lambda vertices, *rest: looks.append(vertices) or sides(vertices, *rest)
    )
    mesh, _ = mesh_repair.repaired(Mesh(BALL.vertices, BALL.corners, BALL.offsets), 2.0**-23)
    drawn(mesh)
    # Where a mesh may meet itself is found in patches of it, whose vertices are other ones.
    assert looks.count(len(BALL.vertices)) == 1
    assert joined_seams([mesh])[0] is mesh
    assert "is_closed" in mesh.__dict__
