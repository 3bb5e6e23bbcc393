"""Scenes without smooth surfaces: triangles so small that pictures show no corners, with true normals at theirs."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.errors import InputWarning
from vectorplot.features.edge_splitting import Demand
from vectorplot.geometry.budget import USUAL, Budget, unresolved
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.unbounded_items import tell_of_empty_surface
from vectorplot.shading.light.corner_normals import TrueNormals, unit
from vectorplot.surfaces.surface import is_implicit, is_parametrised

if TYPE_CHECKING:
    from vectorplot.features.facets import Facets


@dataclass(frozen=True, eq=False)
class FacetedScene:
    """A scene without smooth surfaces; the triangles in their place are no plane mirrors. normals: for every item those
    of its surface; None where its faces are those of a polyhedron."""

    scene: Scene
    normals: tuple[TrueNormals | None, ...]

    @classmethod
    def of_meshes(cls, scene: Scene) -> FacetedScene:
        """A scene that has no smooth surfaces."""
        return cls(scene, tuple(_normals_of(item) for item in scene.items))


def faceted(scene: Scene, demand: Callable[[int], Demand], budget: Budget = USUAL) -> FacetedScene:
    """The scene with meshes in place of smooth surfaces. demand: how fine the triangles of an item have to be, by its
    number; budget: how many there may be. An InputWarning names the items for which it did not do.

    Errors: as of features.facets. Degenerate: a curve has no faces.
    Source: Glaeser, section 8.4 (polygonised surfaces and their normals).
    """
    smooth = [number for number, item in enumerate(scene.items) if _is_smooth(item)]
    found: dict[int, Facets] = {}
    if smooth:
        # Of polyhedra nothing is asked that takes surfaces to be loaded.
        from vectorplot.features.stacked_facets import facets_of_all

        shapes = [scene.items[number].shape for number in smooth]
        made_of = facets_of_all(shapes, lambda k: demand(smooth[k]), budget.facets)
        found = dict(zip(smooth, made_of, strict=True))
    made = [_faceted_item(item, found.get(number)) for number, item in enumerate(scene.items)]
    return FacetedScene(replace(scene, items=tuple(item for item, _ in made)), tuple(normals for _, normals in made))


def without_curved_mirror(item: Item) -> Item:
    """The item, but shiny if it is a mirror that is curved: it shows something else at every point, and its triangles
    are no mirrors."""
    if not item.material.is_mirror or not _is_smooth(item):
        return item
    return replace(item, material=replace(item.material, word="shiny"))


def _is_smooth(item: Item) -> bool:
    return is_parametrised(item.shape) or is_implicit(item.shape)


def _faceted_item(item: Item, found: Facets | None) -> tuple[Item, TrueNormals | None]:
    if found is None:
        return replace(item, shape=item.mesh), _normals_of(item)
    if not found.complete:
        text = unresolved("the surface is shown by triangles that are coarser than the tolerance")
        warnings.warn(f"{item.name}: {text}", InputWarning, stacklevel=5)
    if not found.mesh.face_count:
        tell_of_empty_surface(item, stacklevel=6)
    normals = TrueNormals(np.nan_to_num(found.normals), found.sharp)
    return replace(without_curved_mirror(item), shape=found.mesh), normals


def _normals_of(item: Item) -> TrueNormals | None:
    """The normals at the vertices of a mesh: those of the surface that it is a part of, if it is one of one."""
    known, points = item.normals, item.mesh.vertices
    if known is None or not len(points):
        return None
    place, corners, weights, _ = known.triangles.places(points)
    normals, on_edge = np.zeros(points.shape), np.ones(len(points), dtype=np.bool_)
    normals[place] = unit(np.einsum("kc,kcx->kx", weights, known.at_vertices[corners]))
    on_edge[place] = ((weights > 0.0) & known.on_edge[corners]).any(axis=1)
    return TrueNormals(normals, on_edge)
