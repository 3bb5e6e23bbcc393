"""Scenes whose polyhedra have no seams."""

from __future__ import annotations

from dataclasses import replace

from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.seams import joined_seams
from vectorplot.scene.scene import Scene


def without_seams(scene: Scene) -> Scene:
    """The scene with the seams of its polyhedra joined (see geometry.repair.seams); without seams the scene itself.

    Every verb begins with it: what arrays and other libraries' meshes say of a shape is then what a file would say.
    """
    meshes = [item.shape for item in scene.items if isinstance(item.shape, Mesh)]
    joined = joined_seams(meshes)
    if all(one is other for one, other in zip(meshes, joined, strict=True)):
        return scene
    shapes = iter(joined)
    items = (replace(item, shape=next(shapes)) if isinstance(item.shape, Mesh) else item for item in scene.items)
    return replace(scene, items=tuple(items))
