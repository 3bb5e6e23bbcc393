"""Scenes without smooth surfaces: triangles so small that pictures show no corners, with true normals at theirs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.features.facets import Allowed, facets
from vectorplot.geometry.mesh import Floats
from vectorplot.scene.scene import Item, Scene
from vectorplot.surfaces.surface import is_implicit, is_parametrised


@dataclass(frozen=True, eq=False)
class FacetedScene:
    """A scene without smooth surfaces; the triangles in their place are no plane mirrors. normals: for every item the
    unit normals (v, 3) at its vertices, zero where the surface has none; None where its faces are those of a
    polyhedron."""

    scene: Scene
    normals: tuple[Floats | None, ...]


def faceted(scene: Scene, allowed: Allowed) -> FacetedScene:
    """The scene with meshes in place of smooth surfaces. allowed: how far triangles may be off the true surface.

    Errors: as of features.facets. Degenerate: a curve has no faces.
    Source: Glaeser, section 8.4 (polygonised surfaces and their normals).
    """
    made = [_faceted_item(item, allowed) for item in scene.items]
    return FacetedScene(replace(scene, items=tuple(item for item, _ in made)), tuple(normals for _, normals in made))


def _faceted_item(item: Item, allowed: Allowed) -> tuple[Item, Floats | None]:
    shape = item.shape
    if not (is_parametrised(shape) or is_implicit(shape)):
        return replace(item, shape=item.mesh), None
    found = facets(shape, allowed)
    # A mirror that is curved shows something else at every point: its triangles are no mirrors.
    word = "shiny" if item.material.is_mirror else item.material.word
    return replace(item, shape=found.mesh, material=replace(item.material, word=word)), np.nan_to_num(found.normals)
