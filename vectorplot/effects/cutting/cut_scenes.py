"""Scenes that are cut: bodies without what is taken away of them, with the faces that show then."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from vectorplot.curves.curve import is_curve
from vectorplot.effects.cutting.body_sections import Body
from vectorplot.effects.cutting.cut_shapes import is_cut, smooth_part
from vectorplot.effects.cutting.hatches import (
    WAYS,
    InSpace,
    Way,
    hatch_section,
    page_hatch,
    spacings_in_space,
    turned,
    usual_page,
    ways_of_parts,
    without_overlaps,
)
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cuts.divided_meshes import divided_mesh
from vectorplot.geometry.cuts.half_spaces import HalfSpaces, nothing_beside
from vectorplot.geometry.cuts.section_faces import PlaneFrame, mesh_of_regions
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.io.anything import scene_of
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.point_of_view import camera_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines
from vectorplot.tolerances.of_angles import EDGE_ON_SINE
from vectorplot.words import unknown

MOVED = 0.5
"""Part of the scene's extent by which what is taken away is moved."""


def cut(
    scene: object,
    cuts: Cut | str | Iterable[Cut | str],
    away: str = "gone",
    colour: str | None = None,
    *,
    spacing_mm: float | None = None,
    angle_deg: float = 45.0,
    items: Iterable[str] | None = None,
) -> Scene:
    """The scene with cuts that are made where it is drawn, painted or rendered.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, or several of these
        What is cut, as of `io.scene_of`; cuts that a scene has stay.
    cuts : Cut or str, or several
        Texts as of `Cut.of`: y = 0, x + 2y > 3, or several conditions with commas between them.
    away : {"gone", "ghost", "moved"}
        What becomes of what texts take away.
    colour : str, optional
        Of the faces at cuts that are texts.
    spacing_mm, angle_deg : float
        Of the hatches of these faces, as of `Cut`.
    items : names, optional
        Of the items that texts cut; all where None.

    Returns
    -------
    Scene
        With the same items.

    Raises
    ------
    InputError
        For texts that are no conditions, unknown words, colours and items, and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> half = vp.cut(vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),)), "y = 1")
    >>> len(half.cuts), half.cuts[0].away
    (1, 'gone')
    """
    given = scene_of(scene)
    several = [cuts] if isinstance(cuts, Cut | str) else list(cuts)
    spelled = partial(Cut.of, away=away, colour=colour, spacing_mm=spacing_mm, angle_deg=angle_deg)
    names = None if items is None else _known_names(given, items)
    found = tuple(cut if isinstance(cut, Cut) else replace(spelled(cut), items=names) for cut in several)
    return replace(given, cuts=given.cuts + found)


def _known_names(scene: Scene, items: Iterable[str]) -> tuple[str, ...]:
    """Names of items. Errors: InputError for one that the scene does not have."""
    names, known = tuple([items] if isinstance(items, str) else items), [item.name for item in scene.items]
    for name in names:
        if name not in known:
            raise unknown("cut: item", name, known)
    return names


def cut_scene(scene: Scene, camera: Camera | str | None = None, page: Callable[[Scene], InSpace] = usual_page) -> Scene:
    """The scene after its cuts: what is left of its items, then the faces that show, and what was taken away.

    Parameters
    ----------
    scene : Scene
        With its cuts.
    camera : Camera or str, optional
        Tells on which side the eye is; where None that of the scene, else default_camera.
    page : callable
        page(scene)(points) is how long a millimetre of the page is at points (n, 3), as an array (n,), where what is
        left of the scene is drawn: hatches are spaced by it. Usually the scene fills a sheet of A4.

    Returns
    -------
    Scene
        Without cuts. Its first items are those of the scene, in their order, with what is left of them. Each closed
        body that was cut has an item of its cut faces, called NAME cut, of plane faces, and a number behind that for
        each further plane, hatched otherwise than those it touches; then come ghosts and parts that were moved away.

    Raises
    ------
    InputError
        For a plane with = that is seen edge-on, and for a surface without a finite point.

    Warns
    -----
    InputWarning
        For bodies that are open, whose cut faces are unknown.

    Notes
    -----
    Parametrised surfaces stay what they are: what is cut away is a hole. The faces of cuts through them have chords of
    the true section as their border, that are off by a hundred-thousandth of its extent.

    Degenerate: a face in the plane of a cut belongs to the side where its body is.

    Source: ISO 128-50 (hatching of sections).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import effects, geometry
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> half = effects.cut_scene(vp.cut(cube, "y < 1"))
    >>> [item.name for item in half.items], half.items[1].shape.bounds.tolist()
    (['cube', 'cube cut'], [[0.0, 1.0, 0.0], [2.0, 1.0, 2.0]])
    """
    if not scene.cuts:
        return scene
    seen = camera_of(camera, scene)
    regions = [cut.region(seen) for cut in scene.cuts]
    _tell_of_nothing_left(scene, regions)
    bodies = [Body(item) for item in scene.items]
    own = [_regions_of(body, scene, regions) for body in bodies]
    kept = [_kept(body, those) for body, those in zip(bodies, own, strict=True)]
    opened = [any(map(body.is_opened_by, those)) for body, those in zip(bodies, own, strict=True)]
    _tell([body.item.name for body, is_open in zip(bodies, opened, strict=True) if is_open])
    added = _faces_of_cuts(scene, bodies, regions, page(replace(scene, items=tuple(kept), cuts=())), seen)
    for number, (cut, region) in enumerate(zip(scene.cuts, regions, strict=True)):
        if cut.away != "gone":
            for body in bodies:
                if cut.is_for(body.item.name):
                    before = _regions_of(body, scene, regions[:number])
                    added += _away(scene, cut, body, region, before)
    return replace(scene, items=(*kept, *added), cuts=())


def _regions_of(body: Body, scene: Scene, regions: list[HalfSpaces]) -> list[HalfSpaces]:
    """Those of the regions, which the first cuts of a scene make, that are taken away of a body."""
    return [region for cut, region in zip(scene.cuts, regions, strict=False) if cut.is_for(body.item.name)]


def _tell_of_nothing_left(scene: Scene, regions: list[HalfSpaces]) -> None:
    """An InputWarning for every cut that takes away the box around the whole scene."""
    if not scene.items:
        return
    corners = np.array(list(product(*scene.bounds.T)))
    for cut, region in zip(scene.cuts, regions, strict=True):
        if cut.away == "gone" and cut.items is None and region.is_inside(corners).all():
            warnings.warn(f"the cut {cut.condition} takes everything away", InputWarning, 4)


def _tell(names: list[str]) -> None:
    if names:
        named = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
        warnings.warn(f"{named}: open where cut, for there is no inside of what does not close", InputWarning, 4)


def _kept(body: Body, regions: list[HalfSpaces]) -> Item:
    """What is left of an item outside of regions."""
    item = body.item
    met = [region for region in regions if is_cut(item) and body.is_met_by(region)]
    if not met:
        return item
    lines = item.lines if item.lines is None or "cut" in item.lines else (*item.lines, "cut")
    if isinstance(item.shape, Mesh):
        mesh, place = item.shape, np.arange(item.shape.face_count)
        for region in met:
            divided = divided_mesh(mesh, region)
            mesh, place = divided.outside, np.where(place >= 0, np.append(divided.place, -1)[place], -1)
        kept = tuple(replace(p, face=int(place[p.face])) for p in item.patterns if place[p.face] >= 0)
        return replace(item, shape=mesh, patterns=kept, lines=lines, cut_by=tuple(met))
    part = smooth_part(item, tuple(met))
    if part is item.shape:
        return item
    if is_curve(item.shape):
        return replace(item, shape=part, cut_by=tuple(met))
    return replace(item, shape=part, lines=lines, cut_by=tuple(met))


def _faces_of_cuts(
    scene: Scene, bodies: list[Body], regions: list[HalfSpaces], in_space: InSpace, camera: Camera
) -> list[Item]:
    """An item of cut faces for each body that has such; in_space, camera: as their hatches are seen."""
    import shapely

    planes = [(one, side) for one, region in enumerate(regions) for side in range(len(region.normals))]
    frames = [PlaneFrame.of(regions[one], side, scene.bounds.mean(axis=0)) for one, side in planes]
    faces: list[list[Any]] = []
    for frame, (one, side) in zip(frames, planes, strict=True):
        areas = []
        for body in bodies:
            others = [region for region in _regions_of(body, scene, regions) if region is not regions[one]]
            is_met = scene.cuts[one].is_for(body.item.name)
            areas.append(body.face(frame, regions[one], side, others, None) if is_met else shapely.Polygon())
        faces.append(without_overlaps(areas))
    if not faces:
        return []
    faced = [k for k in range(len(bodies)) if any(not areas[k].is_empty for areas in faces)]
    if not faced:
        return []
    areas = [[every[k] for k in faced] for every in faces]
    ways = ways_of_parts(areas, nothing_beside(scene.bounds))
    own = [[turned(scene.cuts[one], way) for way in ways] for one, _ in planes]
    spacings = spacings_in_space(frames, areas, own, in_space, camera)
    result = []
    for number, (k, way) in enumerate(zip(faced, ways, strict=True)):
        shown = [n for n, every in enumerate(faces) if not every[k].is_empty]
        for count, n in enumerate(shown):
            name = f"{bodies[k].item.name} cut" + (f" {count + 1}" if count else "")
            asked, spacing = scene.cuts[planes[n][0]], float(spacings[n, number])
            for face in _face_items(bodies[k].item, name, frames[n], faces[n][k], asked, way, spacing):
                result.append(replace(face, cut_by=tuple(_regions_of(bodies[k], scene, regions))))
    return result


def _face_items(item: Item, name: str, frame: PlaneFrame, area: Any, cut: Cut, way: Way, spacing: float) -> list[Item]:
    """Cut faces in a plane as an item, if there are any: their edges are lines of the body; spacing: of strokes in
    space, where the cut does not say it."""
    mesh = mesh_of_regions([(frame, area)])
    if not mesh.face_count:
        return []
    hatch = page_hatch(cut, way)
    section = hatch_section(frame, mesh.vertices, turned(cut, way)[0], spacing) if hatch.by == "none" else None
    lines = ("section", "cut")
    curves = NO_LINES if section is None else SurfaceLines(sections=(section,))
    colour = cut.colour or item.colour
    face = Item(name, mesh, colour, item.material, (), lines, item.occludes, curves, item.group, hatch)
    return [replace(face, is_cut_face=True, normals=None)]


def _away(scene: Scene, cut: Cut, body: Body, region: HalfSpaces, before: list[HalfSpaces]) -> list[Item]:
    """What a cut takes away that no cut before it did: ghosts, or moved parts with their faces."""
    shift = _shift(scene, cut, region)
    item = body.item
    if not is_cut(item) or not body.is_met_by(region):
        return []
    met = [other for other in before if body.is_met_by(other)]
    regions = (*met, region)
    if isinstance(item.shape, Mesh):
        mesh = item.shape
        for other in met:
            mesh = divided_mesh(mesh, other).outside
        part: Any = divided_mesh(mesh, region).inside
    else:
        part = smooth_part(item, tuple(met), region)
    if isinstance(part, Mesh) and not part.face_count:
        return []
    if cut.away == "ghost":
        clear = Material("transparent", 0.0)
        name = f"{item.name} ghost"
        ghost = Item(name, part, item.colour, clear, lines=("ghost",), occludes=False, cut_by=regions)
        return [replace(ghost, hatch=Hatching("none"))]
    moved = replace(item, name=f"{item.name} moved", shape=part, patterns=(), cut_by=regions)
    result = [moved.moved(*shift)]
    for side in range(len(region.normals)):
        frame = PlaneFrame.of(region, side, scene.bounds.mean(axis=0))
        area = body.face(frame, region, side, met, None)
        name = f"{item.name} moved cut" + (f" {side + 1}" if side else "")
        for face in _face_items(item, name, frame, area, cut, WAYS[0], float(np.ptp(scene.bounds, axis=0).max())):
            bare = Hatching("none")
            shown = replace(face, shape=face.mesh.reversed(), lines=(), curves=NO_LINES, hatch=bare)
            result.append(shown.moved(*shift))
    return result


def _shift(scene: Scene, cut: Cut, region: HalfSpaces) -> tuple[float, float, float]:
    """How far what a cut takes away is moved: along its normals."""
    way = np.array(region.normals).sum(axis=0)
    length = float(norm(way))
    if cut.away == "moved" and length <= EDGE_ON_SINE:
        raise InputError("cut: what lies between parallel planes cannot be moved along their normals")
    x, y, z = (way * (MOVED * float(np.ptp(scene.bounds, axis=0).max()) / max(length, EDGE_ON_SINE))).tolist()
    return x, y, z
