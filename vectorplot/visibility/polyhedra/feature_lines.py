"""The feature lines that a polyhedron shows in a view."""

from __future__ import annotations

from collections.abc import Collection

from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.clear_lines import Detail
from vectorplot.features.feature_lines.mesh_feature_lines import mesh_feature_lines
from vectorplot.features.meshes.mesh_curves import MeshCurves
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.view import View
from vectorplot.words import LineKind


def sight_in_world(view: View) -> Sight:
    """From where one looks, in world coordinates."""
    eye = None if view.eye is None else view.world_of(view.eye[:, None])[0]
    return Sight(eye, view.axes[2])


def item_feature_lines(item: Item, mesh: Mesh, view: View, kinds: Collection[LineKind]) -> dict[LineKind, MeshCurves]:
    """The lines of an item of each of some kinds of feature lines; mesh: its shape."""
    return mesh_feature_lines(mesh, sight_in_world(view), kinds, Detail(item.curves.detail))
