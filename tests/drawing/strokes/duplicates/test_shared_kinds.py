"""Touching bodies whose common edges are contours of the one and creases of the other."""

import numpy as np
import pytest
from support.drawn import drawn
from support.effort import several

import vectorplot as vp
from vectorplot.geometry.mesh import Mesh
from vectorplot.testing import assert_drawings_equal
from vectorplot.testing.shapes import rotation

EYES = ((9.0, -12.0, 7.0), (9.0, -12.0, -7.0), (-8.0, -9.0, 5.0), (3.0, 14.0, 4.0))


def cut_box(low: tuple[float, ...], high: tuple[float, ...], cells: int, triangles: bool) -> Mesh:
    """A box whose faces are grids of cells x cells quadrilaterals or pairs of triangles."""
    line = np.linspace(0.0, 1.0, cells + 1)
    at = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    vertices, faces = [], []
    for number in range(6):
        axis, side = divmod(number, 2)
        points = np.zeros((cells + 1, cells + 1, 3))
        points[..., axis] = side
        points[..., (axis + 1) % 3], points[..., (axis + 2) % 3] = np.meshgrid(line, line, indexing="ij")
        vertices.append(points.reshape(-1, 3))
        faces.append((quads if side else quads[:, ::-1]) + number * at.size)
    place = np.array(low) + np.concatenate(vertices) * (np.array(high) - np.array(low))
    cell = np.concatenate(faces)
    if triangles:
        return Mesh.from_triangles(place, np.concatenate([cell[:, :3], cell[:, [0, 2, 3]]]))
    return Mesh(place, cell.ravel(), np.arange(0, cell.size + 1, 4))


def touching(cells: tuple[int, int], turn: np.ndarray, kind: type) -> vp.Scene:
    """Two boxes side by side and one on top, turned, in double or single precision."""
    boxes = (
        cut_box((0, 0, 0), (2, 2, 1), cells[0], False),
        cut_box((0, 0, 1), (2, 2, 2), cells[1], True),
        cut_box((2, 0, 0), (4, 2, 1), cells[1], True),
    )
    shapes = (Mesh((box.vertices @ turn + (0.3, 0.2, 0.7)).astype(kind), box.corners, box.offsets) for box in boxes)
    return vp.Scene(tuple(vp.Item(f"BOX{k}", shape) for k, shape in enumerate(shapes)))


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("cells", [(1, 1), (1, 7), (3, 7), (4, 8), (5, 12)])
def test_contours_of_touching_bodies_are_whole_however_they_are_cut_and_rounded(cells: tuple[int, int]) -> None:
    turn = rotation(np.random.default_rng(cells[1]))
    # Every other table of cells is seen from the first or from the last of them.
    first = several(2 * (cells[1] % 2), long=0)
    for number in range(first, first + several(2, long=4)):
        eye = EYES[number]
        place, target, up = (np.array(p) @ turn for p in (eye, (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)))
        shift = np.array((0.3, 0.2, 0.7))
        camera = vp.Camera(tuple(place + shift), tuple(target + shift), up=tuple(up), parallel=bool(number % 2))
        rounded, exact, plain = (
            vp.draw(touching(these, turn, kind), camera)
            for these, kind in ((cells, np.float32), (cells, np.float64), ((1, 1), np.float64))
        )
        assert_drawings_equal(exact, plain)
        lengths = [[drawn(d).of_kind(word).length for word in ("contour", "crease")] for d in (rounded, plain)]
        # Of two edges that cross each other again and again both may be hidden close to a crossing.
        assert np.allclose(*lengths, rtol=2e-3) and np.isclose(lengths[0][1], lengths[1][1], rtol=1e-6)


def test_a_crease_is_a_contour_only_where_a_contour_lies_on_it() -> None:
    scene = vp.Scene(
        (
            vp.Item("LOW", cut_box((0, 0, 0), (4, 1, 1), 1, False)),
            vp.Item("ON", cut_box((1, 0, 1), (2, 1, 2), 1, False)),
        )
    )
    found = drawn(vp.draw(scene, vp.Camera((2.0, -30.0, 9.0), (2.0, 0.0, 1.0)))).visible
    along = (np.abs(found.world[..., 2] - 1.0) < 1e-9).all(axis=1) & (np.abs(found.world[..., 1]) < 1e-9).all(axis=1)
    edge = found.where(along)
    assert np.isclose(edge.of_kind("contour").length, 1.0) and np.isclose(edge.of_kind("crease").length, 3.0)


def test_lines_behind_each_other_keep_their_kinds() -> None:
    boxes = [cut_box((0, y, 0), (1, y + 1, 1), 1, False) for y in (0.0, 3.0)]
    scene = vp.Scene(tuple(vp.Item(f"BOX{k}", box) for k, box in enumerate(boxes)))
    camera = vp.Camera((0.5, -9.0, 3.0), (0.5, 0.0, 0.5), parallel=True)
    alone = [drawn(vp.draw(vp.Scene((item,)), camera, hidden="solid")).of_kind("crease").length for item in scene.items]
    both = drawn(vp.draw(scene, camera, hidden="solid"))
    assert np.isclose(both.of_kind("crease").length, sum(alone), rtol=1e-9)
