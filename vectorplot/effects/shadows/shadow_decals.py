"""Cast shadows as polygons on the faces they fall on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals.decal_polygons import Decals
from vectorplot.effects.shadows.light_system import FacePlanes, LightSystem, light_system
from vectorplot.effects.shadows.lit_bodies import LitBodies, lit_bodies
from vectorplot.effects.shadows.shadow_casters import Casters, shadow_casters
from vectorplot.effects.shadows.shadow_grades import Shadows, graded, joined_shadows, shadow_decals_of
from vectorplot.effects.shadows.shadow_pairs import Receivers, apart, candidates, crowds
from vectorplot.errors import InputError
from vectorplot.geometry.convex.plane_cuts import Crossings, crossings_of, parts_of
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

MOST_LIGHTS = 52
"""So many lights have each a bit of a number."""

MOST_FACES = 1024
"""A convex solid with more faces casts shadows face by face: to see that it is convex would take longer."""


@dataclass(frozen=True, eq=False)
class Cast:
    """Shadows of grade 1, and what is missing among them: left_out (3,k): the light, the item that throws none, and the
    one on which."""

    shadows: Shadows
    left_out: Ints


def cast_shadows(
    view: View,
    lights: Sequence[Light],
    *,
    casters: Bools | None = None,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
) -> Shadows:
    """The shadows of grade 1, light by light, on the faces that can be seen and are lit on the side that is seen.

    casters (i,): the items that cast shadows (None: those that occlude); receivers (f,): the faces that they may fall
    on (None: all). Where every point of a face is in the shadow of one thing, the others that shadow it from this light
    are left out.
    Errors: InputError for lights out of range, or more than MOST_LIGHTS of them.
    Degenerate: faces that the light grazes, and dark sides, have no shadows; what touches a face or lies in its plane
    casts none on it.
    Source: Glaeser, section 6.3, figures 4 and 5.
    """
    return cast_within(view, lights, np.inf, casters=casters, receivers=receivers, projected=projected).shadows


def cast_within(
    view: View,
    lights: Sequence[Light],
    pairs: float,
    *,
    casters: Bools | None = None,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
    off: Floats | None = None,
) -> Cast:
    """The shadows as of cast_shadows, but for those of one item on one, in one light, for which more than so many pairs
    would have to be looked at (see shadow_pairs.crowds). off (i,): how far the faces of items may be off the surfaces
    that they stand for (None: not at all, they are polyhedra); so far may borders of shadows be from those that the
    faces throw."""
    if len(lights) > MOST_LIGHTS:
        raise InputError(f"{len(lights)} lights cast shadows: at most {MOST_LIGHTS} can")
    projected = project_faces(view) if projected is None else projected
    items = view.occludes if casters is None else np.asarray(casters, dtype=np.bool_)
    solids = solid_items(replace(view, occludes=items), projected, most_faces=MOST_FACES)
    planes = FacePlanes.of(view)
    off = np.zeros(len(items)) if off is None else off
    seen = drawn_faces(view, projected)
    seen = seen if receivers is None else seen[receivers[seen]]
    found, missing = [], [np.zeros((3, 0), dtype=np.intp)]
    for number, light in enumerate(lights):
        system = light_system(view, light)
        facing = system.facing(planes, view.tolerance)
        lit = seen[facing[seen] * projected.facing[seen] > 0]
        bodies = lit_bodies(view, planes, system, facing, items & ~solids, off)
        bright = Receivers.of(view, lit)
        outlined, open_items, open_receivers = _of_outlines(view, system, bodies, bright, number)
        alone = items.copy()
        alone[bodies.item[bodies.convex]] = False
        inside = _whole(bright.some(bodies.within(bright)), number)
        parts = [joined_shadows([outlined, inside]).without_needless()]
        still = ~np.isin(bright.face, parts[0].face[parts[0].whole])
        for some, on in ((alone, still), (open_items, still & open_receivers)):
            dark = replace(shadow_casters(view, planes, system, facing, some, solids), known=bodies.settle)
            under = bright.some(np.flatnonzero(on))
            crowded = crowds(view, system, dark, under, pairs)
            missing.append(np.insert(crowded, 0, number, axis=0))
            parts += [_of_faces(view, system, *each, number) for each in apart(view, dark, under, crowded)]
        found.append(joined_shadows(parts).without_needless())
    return Cast(joined_shadows(found), np.concatenate(missing, axis=1))


def _of_outlines(
    view: View, system: LightSystem, bodies: LitBodies, receivers: Receivers, number: int
) -> tuple[Shadows, Bools, Bools]:
    """The shadows that bodies throw with their outlines; the items (i,) and the receivers (r,) of pairs for which these
    do not do."""
    items, on = np.zeros(len(view.item_vertices) - 1, dtype=np.bool_), np.zeros(len(receivers.face), dtype=np.bool_)

    def beyond() -> Iterator[tuple[Ints, Ints]]:
        for caster, receiver in candidates(view, system, bodies.casters, receivers):
            item, face = bodies.casters.item[caster], receivers.face[receiver]
            settled = bodies.settle(item, face)
            items[item[~settled]] = True
            on[receiver[~settled]] = True
            others = np.flatnonzero(settled & (view.face_item[face] != item))
            yield caster[others], receiver[others]

    return _thrown(view, bodies.casters, receivers, beyond(), number), items, on


def _whole(receivers: Receivers, number: int) -> Shadows:
    """The shadows of receivers that are dark as a whole."""
    count = len(receivers.face)
    lacking = np.full(count, 1 << number, dtype=np.intp)
    return Shadows(receivers.points, receivers.offsets, receivers.face, lacking, np.ones(count, dtype=np.bool_))


def _of_faces(view: View, system: LightSystem, casters: Casters, receivers: Receivers, number: int) -> Shadows:
    """The shadows that casters throw on receivers."""
    return _thrown(view, casters, receivers, candidates(view, system, casters, receivers), number)


def _thrown(
    view: View, casters: Casters, receivers: Receivers, pairs: Iterable[tuple[Ints, Ints]], number: int
) -> Shadows:
    """The shadows of pairs of casters and receivers, lot by lot; on a face that one of them darkens whole, only that
    one."""
    parts = []
    dark = np.zeros(len(receivers.face), dtype=np.bool_)
    for caster, receiver in pairs:
        light = np.flatnonzero(~dark[receiver])
        caster, receiver = caster[light], receiver[light]
        found = shadow_crossings(view, casters, receivers, caster, receiver)
        first = _first_whole(found, receiver, len(dark))
        dark[receiver[found.pair[first]]] = True
        useful = ~dark[receiver[found.pair]]
        useful[first] = True
        found = found.some(np.flatnonzero(useful))
        cut = parts_of(receivers.points, receivers.offsets, receiver, found, view.tolerance)
        parts.append(Shadows.of_light(cut, receivers.face[receiver[cut.pair]], number))
    # What was found of a face before it was found to be dark.
    return joined_shadows(parts).without_needless()


def _first_whole(found: Crossings, receiver: Ints, count: int) -> Ints:
    """Of each receiver that is dark as a whole, the first pair that says so."""
    whole = np.flatnonzero(found.whole)
    _, first = np.unique(receiver[found.pair[whole]], return_index=True)
    return whole[first]


def shadow_crossings(view: View, casters: Casters, receivers: Receivers, caster: Ints, receiver: Ints) -> Crossings:
    """Where things cut the light off from faces, pair by pair. Source: Glaeser, section 6.3, figure 4."""
    return crossings_of(receivers.points, receivers.offsets, casters.volumes, receiver, caster, view.tolerance)


def shadow_decals(
    view: View,
    lights: Sequence[Light],
    *,
    casters: Bools | None = None,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
) -> Decals:
    """The shadows of all lights on the faces of a view, in every grade, darker ones above.

    Parameters
    ----------
    view : View
        What casts the shadows, and gets them.
    lights : sequence of Light
        At most 52.
    casters : (i,) array of bool, optional
        The items that cast shadows; those that occlude where None.
    receivers : (f,) array of bool, optional
        The faces that they may fall on; all where None.
    projected : ProjectedFaces, optional
        The faces of the view in the image, where they are known.

    Returns
    -------
    Decals
        At any point the highest grade there is the number of lights that the face is turned to and does not get. The
        shadows of one light may overlap.

    Raises
    ------
    InputError
        For lights out of range, or more than 52 of them, and for shadows that overlap in too many parts.

    Warns
    -----
    InputWarning
        For shadows that overlap in so many parts that pictures become large.

    Notes
    -----
    Only faces that can be seen have shadows, on the side that is seen. Where every point of a face is in the shadow of
    one thing, the others that shadow it from this light are left out.

    Degenerate: faces that the light grazes, and dark sides, have no shadows; what touches a face or lies in its plane
    casts none on it.

    Source: Glaeser, section 6.3, figures 4 to 6.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import effects, geometry
    >>> from vectorplot.scene import look
    >>> floor = vp.Mesh.from_polygons([(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)], [(0, 1, 2, 3)])
    >>> corners = [(3, 3, 1), (5, 3, 1), (5, 5, 1), (3, 5, 1)]
    >>> roof = vp.Mesh.from_polygons(corners, [(0, 1, 2, 3)])
    >>> view = look(vp.Scene((vp.Item("floor", floor), vp.Item("roof", roof))), vp.Camera.view("top"))
    >>> shadows = effects.shadow_decals(view, [vp.Light((1, 0, 2), parallel=True)])
    >>> len(shadows), shadows.face.tolist(), shadows.grade.tolist()
    (1, [0], [1])
    """
    shadows = cast_shadows(view, lights, casters=casters, receivers=receivers, projected=projected)
    return shadow_decals_of(graded(view, shadows), FillKind.SHADOW)
