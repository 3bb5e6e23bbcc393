"""One projection and one placement a picture, the same for every verb."""

import numpy as np
import pytest

import vectorplot as vp
import vectorplot.scene.view as views
from vectorplot.drawing.painted_fills import placement_of_faces
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import FARTHEST_OFF_AXIS_DEG
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision, fitted_picture
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading.screen import picture_placement, pixel_system
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box, rotated_boxes
from vectorplot.tolerances import NEAR_OF_DISTANCE
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.polyhedra.lines import frame_of, straight_lines

PAGE = Page(120.0, 90.0, 5.0)
CAMERAS = [Camera((8.0, -9.0, 7.0), (0.5, 0.2, -0.3), twist_deg=20.0), Camera((8.0, -9.0, 7.0), parallel=True)]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize(("fit", "camera"), [(True, CAMERAS[0]), (False, CAMERAS[0]), (True, CAMERAS[1])])
@pytest.mark.parametrize("surface", [False, True])
@pytest.mark.parametrize("verb", ["draw", "paint", "erasing", "render"])
def test_a_picture_with_lines_looks_at_its_faces_once(verb, surface, camera, fit, monkeypatch):
    looks = []
    convex_faces = views.convex_faces

    def counted(points, corners, offsets, tolerance):
        looks.append(len(offsets) - 1)
        return convex_faces(points, corners, offsets, tolerance)

    monkeypatch.setattr(views, "convex_faces", counted)
    scene = Scene((Item("torus", Torus(2.0, 0.5)),)) if surface else rotated_boxes(3)
    if verb == "draw":
        vp.draw(scene, camera, page=PAGE, fit=fit)
    elif verb == "render":
        vp.render(scene, camera, size=(40, 30), fit=fit, lines="contour,crease", samples=1)
    else:
        fills = "erasing" if verb == "erasing" else "painted"
        vp.paint(scene, camera, page=PAGE, fit=fit, lines="contour,crease", fills=fills, tolerance_mm=1.0)
    assert sum(count > 0 for count in looks) == (0 if surface and verb == "draw" else 1)


def needle(depth: float, off: float, size: float) -> tuple[Scene, Camera]:
    """A cube of two units two units before the eye, and a face that begins at some depth, as far off the principal ray
    as off says of its depth, in a world where a unit is size."""
    x = off * depth
    face = np.array([(x, 0, 4 - depth), (0, 1e-3 * depth, 4 - depth), (0, 0, 4 - 2 * depth)])
    items = (
        Item("CUBE", box(-size * np.ones(3), size * np.ones(3))),
        Item("FACE", Mesh.from_polygons(face * size, [[0, 1, 2]])),
    )
    return Scene(items), Camera((0.0, 0.0, 4.0 * size), up=(0.0, 1.0, 0.0))


def places(scene: Scene, camera: Camera, fit: bool = True) -> tuple[Placement | None, Placement, Placement]:
    """What draw, paint and render make of all corners of a scene."""
    view = look(scene, camera)
    none = np.zeros(view.points.shape[1], dtype=np.intp)
    lines = straight_lines(view.points, np.roll(view.points, 1, axis=1), none, none, none)
    return (
        frame_of(view, lines, PAGE, fit),
        placement_of_faces(view, painters_order(view).faces, PAGE, fit),
        picture_placement(view, PAGE, fit),
    )


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("share", [0.7, 1.3])
def test_every_verb_has_the_same_near_plane(share, size):
    # The scene reaches from the back of the cube to the eye: five units, half of which is 1 in the unit box.
    scene, camera = needle(share * NEAR_OF_DISTANCE * 2.5, 0.01, size)
    assert camera.distance > 2.5 * size
    drawn, painted, rendered = places(scene, camera)
    assert (drawn is None, painted.whole, rendered.whole) == (share > 1.0,) * 3
    view = look(scene, camera)
    assert pixel_system(rendered).near * view.distance == pytest.approx(view.near, rel=1e-12)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("more", [-1.0, 1.0])
def test_every_verb_fits_what_is_60_degrees_off_the_principal_ray(more, size):
    scene, camera = needle(1.0, np.tan(np.radians(FARTHEST_OFF_AXIS_DEG + more)), size)
    drawn, painted, rendered = places(scene, camera)
    assert (drawn is None, painted.whole, rendered.whole) == (more < 0.0,) * 3


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("fit", [True, False])
def test_pixels_are_where_the_page_has_them(camera, fit):
    scene = rotated_boxes(4)
    view = look(scene, camera)
    placement = picture_placement(view, PAGE, fit)
    page = placement.on_page(view.image)
    h = pixel_system(placement).homogeneous(view.points.T)
    assert np.allclose(h[:, :2] / h[:, 3:], np.column_stack([page[:, 0] - 0.5, 89.5 - page[:, 1]]), atol=1e-9)
    world = np.column_stack([scene.vertices, np.ones(len(scene.vertices))]) @ placement.page_from_world.T
    assert np.allclose(world[:, :2] / world[:, 3:], page, atol=1e-9)
    if fit:
        low, high = page.min(axis=0), page.max(axis=0)
        assert np.allclose((low + high) / 2.0, (60.0, 45.0)) and np.allclose(((high - low) / (110.0, 80.0)).max(), 1.0)


@pytest.mark.parametrize("camera", CAMERAS)
def test_the_window_of_a_field_of_vision_is_the_page_inside_its_margin(camera):
    view = look(rotated_boxes(2), camera)
    for fit, height_mm in ((True, 80.0), (False, 90.0)):
        placement = field_of_vision(view, PAGE, fit)
        assert placement.scale * view.picture_height == pytest.approx(height_mm)
        corners = placement.on_page(np.transpose(placement.window))
        assert np.allclose(corners, [(5.0, 5.0), (115.0, 85.0)])
    nothing = fitted_picture(view, PAGE, np.zeros((2, 0)))
    assert nothing.whole and np.allclose(nothing.on_page(np.zeros((2, 1))), (60.0, 45.0))
