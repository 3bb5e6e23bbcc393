"""Items without faces that stand for the looks of single faces: whatever asks an item how it looks asks them too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene

_NO_FACES = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


def with_face_looks(scene: Scene) -> Scene:
    """The scene with an item without faces for every look of faces, behind all others; without looks the scene itself.

    What the faces of these items look like is asked of such an item, where they are and what they hide of their own.
    """
    if not any(item.face_looks is not None for item in scene.items):
        return scene
    items, added = [], list[Item]()
    for item in scene.items:
        looks = item.face_looks
        if looks is None or not isinstance(item.shape, Mesh):
            items.append(item)
            continue
        items.append(replace(item, face_looks=replace(looks, first=len(scene.items) + len(added))))
        for look in looks.looks:
            colour = item.colour if look.colour is None else look.colour
            material = item.material if look.material is None else look.material
            added.append(Item(item.name, _NO_FACES, colour, material, hatch=item.hatch, occludes=item.occludes))
    return replace(scene, items=(*items, *added))
