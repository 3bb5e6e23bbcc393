"""The faces of a scene in the painter's order, and what is seen of them on a page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.painted_fills import shown_faces
from vectorplot.features.edge_splitting import Demand
from vectorplot.geometry.budget import Budget
from vectorplot.geometry.cameras.unit_projection import Projection
from vectorplot.painting.reports import (
    group_names,
    tell_groups,
    tell_knots,
    tell_slices,
    warn_of_guesses,
    warn_of_single_polygons,
)
from vectorplot.painting.seen import Seen, smooth_items, without_unseen_facets
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.shading.light.corner_normals import at_corners, view_normals
from vectorplot.shading.light.fineness.faceted import FacetedScene, faceted
from vectorplot.shading.light.flat_regions import plane_numbers
from vectorplot.shading.light.painted_colours import opacities
from vectorplot.stages.walk import Walk
from vectorplot.tolerances.of_the_page import SIDE_BY_SIDE_MM
from vectorplot.visibility.painter.gathering import side_by_side
from vectorplot.visibility.painter.height_fields import known_orders
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces


@dataclass(frozen=True, eq=False)
class OrderedFaces:
    """The faces of a scene, with triangles in place of smooth surfaces, back to front: their view and their faces in
    the image, and the polygons that are painted."""

    facets: FacetedScene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces


def ordered_faces(
    walk: Walk,
    scene: Scene,
    shown: Scene,
    projection: Projection,
    demand: Callable[[], Callable[[int], Demand]],
    budget: Budget,
) -> OrderedFaces:
    """The faces of a scene back to front. shown: what of it is painted; demand: how fine triangles have to be, as of
    faceted, which is asked for where there are any.

    Warns: InputWarning for items that may be in a wrong order.
    """
    if walk.calls_for("facets"):
        facets = walk.run("facets", faceted, shown, demand(), budget)
    else:
        facets = FacetedScene.of_meshes(shown)
    facets = replace(facets, scene=_with_clear_items(facets.scene))
    view = walk.run("look", view_of, facets.scene, projection)
    projected = walk.run("faces", project_faces, view)
    known, groups = known_orders(shown, view), _groups(scene)
    sliced = {number: planes for number, item in enumerate(scene.items) if (planes := item.curves.slices)}
    normals = _normals_at_corners(facets, view)
    painted = walk.run(
        "order",
        painters_order,
        view,
        projected,
        known=known,
        sliced=sliced,
        group=groups,
        normals=normals,
        budget=budget,
    )
    warn_of_guesses(scene, painted)
    tell_slices(walk, scene, sliced, painted)
    tell_knots(walk, scene, painted)
    tell_groups(walk, scene, painted)
    faces = painted.faces
    if walk.calls_for("unseen facets"):
        faces = walk.run("unseen facets", without_unseen_facets, facets, view, projected, painted, budget)
    return OrderedFaces(facets, view, projected, faces)


def seen_on_page(walk: Walk, ordered: OrderedFaces, placement: Placement, budget: Budget) -> tuple[Seen, Ints]:
    """What is seen of faces back to front on a page, and the numbers (f,) of the planes of the view.

    Warns: InputWarning for transparent items with too much on one another.
    """
    facets, view, projected, faces = ordered.facets, ordered.view, ordered.projected, ordered.faces
    if walk.calls_for("transparent sheets"):
        from vectorplot.visibility.painter.sheets.transparent_sheets import in_sheets
        from vectorplot.visibility.painter.sheets.units import connected_parts

        item = view.face_item[faces.source]
        opacity = opacities(facets.scene.items)[item]
        sheet, width = np.where(opacity < 1.0, item, -1), SIDE_BY_SIDE_MM / placement.scale
        if walk.calls_for("refraction"):
            from vectorplot.effects.glass.glass_polygons import refracting_items

            # What is seen in them is mixed, and opaque: nothing of them is blended.
            sheet = np.where(refracting_items(facets.scene, view, projected)[item], -1, sheet)
        part = connected_parts(view, faces, sheet)
        most = budget.pairs
        sheets = walk.run("transparent sheets", in_sheets, faces, sheet, part, opacity, width, view.tolerance, most)
        warn_of_single_polygons(facets.scene, sheets.single)
        faces = sheets.faces
    plane = plane_numbers(view)
    faces = faces.some(side_by_side(faces, _planes_of(facets.scene, view, faces, plane), view.tolerance))
    shown = shown_faces(faces, placement)
    return Seen(facets.scene, view, projected, shown, placement, smooth_items(facets)), plane


def _normals_at_corners(facets: FacetedScene, view: View) -> Floats | None:
    """(3,c) the normals of surfaces at the corners of the faces of a view, 0 at apexes, those of their faces for
    polyhedra; None where no surface can touch another item."""
    if len(facets.normals) < 2 or all(normals is None for normals in facets.normals):
        return None
    apex = np.zeros(view.points.shape[1], dtype=np.bool_)
    for item, own in enumerate(facets.normals):
        if own is not None:
            part = slice(view.item_vertices[item], view.item_vertices[item + 1])
            apex[part] = (own.at_vertices == 0.0).all(axis=1)
    return np.where(apex[view.corners], 0.0, at_corners(view, view_normals(view, facets.normals, 0.0)))


def _with_clear_items(scene: Scene) -> Scene:
    """The scene in which light goes through whatever one can see through."""
    clear = [item.material.is_clear for item in scene.items]
    if not any(see and item.hides for see, item in zip(clear, scene.items, strict=True)):
        return scene
    items = (replace(item, occludes=item.hides and not see) for see, item in zip(clear, scene.items, strict=True))
    return replace(scene, items=tuple(items))


def _planes_of(scene: Scene, view: View, faces: ImageFaces, plane: Ints) -> Ints:
    """(n,) the planes of painted polygons, -1 for those of transparent items, which stand together as sheets."""
    clear = opacities(scene.items)[view.face_item[faces.source]] < 1.0
    return np.where(clear, -1, plane[faces.source])


def _groups(scene: Scene) -> Ints | None:
    """(i,) the number of each item's group, -1 for none; None where there are no groups."""
    names = group_names(scene)
    number = {"": -1, **{name: k for k, name in enumerate(names)}}
    return np.array([number.get(item.group, -1) for item in scene.items], dtype=np.intp) if names else None
