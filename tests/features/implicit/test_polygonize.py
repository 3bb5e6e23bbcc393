"""Implicit surfaces as meshes."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.polygonization import polygonized, settled_mesh
from vectorplot.geometry.winding import edge_uses, is_closed_oriented
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.quadrics import implicit_cone, implicit_cylinder, implicit_plane, implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus, ImplicitTorusByDistance
from vectorplot.textbook.polyhedra import body_record

BOX = np.array([[-2.0] * 3, [2.0] * 3])


def euler(mesh):
    return len(mesh.vertices) - len(edge_uses(mesh).first) + mesh.face_count


def distance(surface, mesh):
    """Of the vertices, to first order, as a part of the box."""
    slope = np.linalg.norm(surface.gradients(mesh.vertices), axis=1)
    return (np.abs(surface.values(mesh.vertices)) / slope).max() / np.ptp(surface.box)


@pytest.mark.parametrize(
    ("surface", "characteristic"),
    [(implicit_sphere(1.0, (3, 2, 1)), 2), (ImplicitTorus(3, 1), 0), (ImplicitTorusByDistance(3, 1), 0)],
)
def test_vertices_lie_on_the_surface_and_faces_look_to_where_f_is_positive(surface, characteristic):
    mesh = polygonized(surface, 24)
    assert distance(surface, mesh) < 1e-12
    assert is_closed_oriented(mesh) and euler(mesh) == characteristic
    middles = mesh.vertices[mesh.corners.reshape(-1, 3)].mean(axis=1)
    assert ((mesh.area_vectors * surface.gradients(middles)).sum(axis=1) >= 0.0).all()


def test_volumes_converge_with_the_square_of_the_cell():
    errors = []
    for cells in (10, 20, 40):
        volume = body_record(polygonized(ImplicitTorus(3, 1), cells)).volume
        errors.append(abs(volume - 6.0 * np.pi**2))
    assert errors[0] / errors[1] > 3.0 and errors[1] / errors[2] > 3.0


def test_where_the_surface_leaves_its_box_its_border_is_on_the_sides_to_the_last_bit():
    surface = implicit_cylinder(1.0, (0.1, 0.2, 0.3), (0, 0, 1), BOX)
    mesh = polygonized(surface, 16)
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first[uses.count == 1]]
    rim = mesh.vertices[mesh.corners[corner]]
    assert len(rim) and set(rim[:, 2]) == {-2.0, 2.0}
    assert euler(mesh) == 0


def test_a_plane_through_the_points_of_the_lattice_is_met_once():
    mesh = polygonized(implicit_plane((0, 0, 0), (0, 0, 1), BOX), 8)
    assert mesh.face_count == 128 and (mesh.vertices[:, 2] == 0.0).all()
    assert abs(body_record(mesh).area - 16.0) < 1e-12


def test_holes_stay_holes_and_poles_are_no_surface():
    def capped(x, y, z):
        return np.where(x > 0.3, np.nan, x * x + y * y + z * z - 1.0)

    mesh = polygonized(implicit_of_function(capped, BOX), 24)
    assert mesh.face_count and mesh.vertices[:, 0].max() <= 0.3
    assert polygonized(implicit_of_function(lambda x, y, z: 1.0 / (x - 0.013), BOX), 24).face_count == 0
    assert polygonized(implicit_of_function(lambda x, y, z: np.full_like(x, np.nan), BOX), 8).face_count == 0


@pytest.mark.hard(42)
def test_one_sign_gives_an_empty_mesh():
    for sign in (1.0, -1.0):
        mesh = polygonized(implicit_of_function(lambda x, y, z, s=sign: s * (x * x + 1.0), BOX), 8)
        assert mesh.face_count == 0 and len(mesh.vertices) == 0


@pytest.mark.hard(68)
@pytest.mark.parametrize("cells", [1, 0, -3, 10**9, 300])
def test_wild_counts_of_cells_are_refused_before_anything_is_allocated(cells):
    with pytest.raises(InputError, match="cells"):
        polygonized(implicit_sphere(1.0), cells)


def test_values_of_the_wrong_shape_are_an_error():
    class Odd:
        box = BOX

        def values(self, points):
            return np.zeros(3)

        def gradients(self, points):
            return np.zeros_like(points)

    with pytest.raises(InputError, match="shape"):
        polygonized(Odd(), 4)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_scaled_and_shifted_surfaces_give_the_same_mesh(scale, offset):
    centre = np.array([offset, 0.0, 0.0]) * scale
    surface = ImplicitTorus(3 * scale, scale, centre)
    mesh, plain = polygonized(surface, 20), polygonized(ImplicitTorus(3, 1), 20)
    assert np.array_equal(mesh.corners, plain.corners) or offset
    assert distance(surface, mesh) < (1e-12 if not offset else 1e-9) and euler(mesh) == 0


def test_cells_are_refined_until_the_parts_of_the_surface_stay_the_same():
    # Two spheres so close that few cells join them.
    def pair(x, y, z):
        return np.minimum((x - 0.77) ** 2, (x + 0.77) ** 2) + y * y + z * z - 0.5625

    surface = implicit_of_function(pair, BOX)
    mesh, doubts = settled_mesh(surface, 12)
    assert not doubts and euler(mesh) == 4
    assert not settled_mesh(implicit_cone(0.5, (0, 0, 0), (0, 0, 1), BOX), 16)[1]


@pytest.mark.parametrize("shift", [0.0, 1e-17, 1e-11])
def test_a_plane_through_points_of_the_lattice_ends_on_the_sides_of_its_box(shift: float) -> None:
    plane = implicit_plane((0.0, 0.0, shift), (1.0, 0.5, 2.0), [(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)])
    mesh = polygonized(plane, 48)
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first[uses.count == 1]]
    ends = np.stack([mesh.vertices[mesh.corners[corner]], mesh.vertices[mesh.corners[mesh.next_corner[corner]]]])
    assert len(corner) and (np.abs(ends) == 1.0).all(axis=0).any(axis=1).all()
