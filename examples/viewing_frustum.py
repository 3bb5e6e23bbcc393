"""The viewing frustum in the world, and the box it becomes under T2.

What a camera sees lies in a frustum; after the collineation T2 the same bodies lie in a box, their faces still flat,
and clipping is a matter of comparing coordinates. Source: Glaeser, section 2.5, figure 11.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import (
    Box,
    CoordinateSystem,
    Window,
    box,
    collineate,
    polyhedron_intersection,
    revolution,
    rotation_about,
    translated,
)
from vectorplot.textbook import Frustum

PAGE = vp.Page(140, 110, 6)


def bodies() -> dict[str, vp.Mesh]:
    """A cube, a tall prism and a cone; two of them reach out of the picture."""
    cube = box((0.9, 0.9, 0.9))
    turned = translated(cube.vertices @ rotation_about((0, 0, 1), 0.6), (-0.4, -0.9, -0.5))
    tower = revolution([(0.4, 0, -0.8), (0.4, 0, 2.6)], 6)
    behind = translated(tower.vertices, (-0.9, 1.0, 0))
    cone = revolution([(0.6, 0, 0), (0, 0, 1.3)], 24)
    beside = translated(cone.vertices, (1.5, 0.5, -0.7))
    return {
        "CUBE": replace(cube, vertices=turned),
        "TOWER": replace(tower, vertices=behind),
        "CONE": replace(cone, vertices=beside),
    }


def items(frame: vp.Mesh, shapes: dict[str, vp.Mesh]) -> vp.Scene:
    """Bodies in a frame that hides nothing."""
    solid = tuple(vp.Item(name, mesh) for name, mesh in shapes.items())
    return vp.Scene((*solid, vp.Item("FRAME", frame, occludes=False)))


def main(folder: Path) -> None:
    system = CoordinateSystem.of_image(vp.Camera(eye=(0.6, -5.2, 1.4)))
    frustum = Frustum(system, Box(Window(-1.5, 1.5, -1.1, 1.1), min_z=-0.28, max_z=0.4))
    inside = {name: polyhedron_intersection(mesh, frustum.mesh) for name, mesh in bodies().items()}

    def after_t2(mesh: vp.Mesh) -> vp.Mesh:
        return replace(mesh, vertices=collineate(system.rotated(mesh.vertices), system.distance, factor=1.0))

    stretched = frustum.box_mesh.transformed(np.diag([1, 1, system.distance, 1]))
    world = vp.Camera(eye=(15, -8, 9), target=(0, -1, 0.2), fov_deg=20)
    rays = vp.Mesh.from_polygons([system.centre, *frustum.corners[4:]], [(0, 1, 2), (0, 2, 4), (0, 4, 3), (0, 3, 1)])
    seen = items(frustum.mesh, inside)
    with_eye = vp.Scene((*seen.items, vp.Item("RAYS", rays, occludes=False)), title="Viewing frustum")
    vp.save(vp.draw(with_eye, world, page=PAGE), folder / "viewing_frustum.svg")
    back = system.inverse_rotation.T
    along = vp.Camera(eye=tuple(back.T @ world.eye), up=tuple(back.T @ (0, 0, 1)), parallel=True)
    boxed = items(stretched, {name: after_t2(mesh) for name, mesh in inside.items()})
    vp.save(vp.draw(boxed, along, page=PAGE), folder / "viewing_frustum_t2.svg")

    corners = after_t2(frustum.mesh).vertices
    assert np.allclose(corners, stretched.vertices, atol=1e-12), "the frustum becomes a box"
    low, high = stretched.bounds
    for item in boxed.items:
        assert (item.shape.vertices > low - 1e-9).all() and (item.shape.vertices < high + 1e-9).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
