"""Cast shadows as polygons on the faces they fall on: of every light, of several, and of what is transparent."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.body_shadows import LitBodies, lit_bodies, shut_out
from vectorplot.effects.decals import Decals, FaceFrames, disjoint_decals, joined_decals, no_decals
from vectorplot.effects.shadow_casters import (
    Casters,
    FacePlanes,
    LightSystem,
    Receivers,
    apart,
    candidates,
    crowds,
    light_system,
    shadow_casters,
    unlit_faces,
    unpierced_faces,
)
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget, in_turn, mapped, unresolved
from vectorplot.geometry.polygon_cuts import Crossings, Parts, crossings_of, parts_of
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements, joined
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.regions import (
    WIDTH_KEPT,
    cells_of,
    corners_of,
    polygons_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.illumination import LEVELS
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

# Shadows of several lights on the same faces: where they overlap it is darker.
#
# On every face the borders of all shadows make one arrangement of cells, each of which lacks the same lights all over.
# There are no more of them than the borders and their crossings ask for, however many lights there are.

POLYGONS_AT_ONCE = 1 << 15
"""About so many shadows are cut into cells at once; those of one face always are."""

MANY_CELLS = 100_000
"""From here on a warning tells what takes long."""

MOST_CELLS = 3_000_000
"""More are refused: a file with them would have about a gigabyte."""


@dataclass(frozen=True, eq=False)
class Shadows(LineElements):
    """Polygons on faces: points (3,c) in the view, offsets (m+1,); face (m,) of the view; lacking (m,): the lights that
    do not get there, bit k for light k; whole (m,): it is the whole face. Those that one light casts are
    convex, but for those of whole bodies."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    face: Ints = field(metadata=EACH_LINE)
    lacking: Ints = field(metadata=EACH_LINE)
    whole: Bools = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.face)

    @classmethod
    def of_light(cls, parts: Parts, face: Ints, light: int) -> Shadows:
        """Parts of faces that one light does not reach."""
        return cls(parts.points, parts.offsets, face, np.full(len(face), 1 << light, dtype=np.intp), parts.whole)

    @property
    def grade(self) -> Ints:
        """(m,) how many lights each lacks."""
        return np.bitwise_count(self.lacking).astype(np.intp)

    def without_needless(self) -> Shadows:
        """The same without those on faces that another shadow for want of the same lights covers whole."""
        order = np.lexsort((~self.whole, self.lacking, self.face))
        face, lacking = self.face[order], self.lacking[order]
        first = np.ones(len(order), dtype=np.bool_)
        first[1:] = (face[1:] != face[:-1]) | (lacking[1:] != lacking[:-1])
        leader = np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
        kept = first | ~self.whole[order][leader]
        return self if kept.all() else self.take(np.sort(order[kept]))


def joined_shadows(shadows: Sequence[Shadows]) -> Shadows:
    """All shadows one after the other."""
    none = np.zeros(0, dtype=np.intp)
    nothing = Shadows(np.zeros((3, 0)), ragged.offsets(none), none, none, none.astype(np.bool_))
    return joined((nothing, *shadows))


def graded(view: View, shadows: Shadows, overlapping: Bools | None = None) -> Shadows:
    """The cells of the arrangement of shadows of single lights, face by face: simple polygons, each with all the lights
    that do not get there, to be painted in the order of their grades.

    A face that lights do not reach at all comes as a whole, for want of these; other cells overlap only where one of a
    higher grade fills a hole of a lower one, and on faces overlapping (f,) that only one light throws shadows on, which
    stay as they are (None: no such faces). So at any point the polygon of the highest grade tells what lacks there.
    A shadow that is alone on its face keeps every digit; cells move by less than a few tolerances.
    Errors: InputError for more than MOST_CELLS cells; an InputWarning from MANY_CELLS on. There are as many of them as
    the arrangement has: with m shadows on a face that all cross each other about m squared.
    Edge cases: cells narrower than a few tolerances are left out.
    Source: Glaeser, section 6.3, figure 6 (shadows of higher grades).
    """
    whole = np.flatnonzero(shadows.whole)
    faces, number = np.unique(shadows.face, return_inverse=True)
    dark = np.zeros(len(faces), dtype=np.intp)
    np.bitwise_or.at(dark, number[whole], shadows.lacking[whole])
    first = np.unique(number[whole], return_index=True)[1]
    found = [_lacking(shadows.take(whole[first]), dark[number[whole[first]]])]
    part = np.flatnonzero(~shadows.whole)
    several = np.bincount(number[part], minlength=len(faces))[number[part]] > 1
    if overlapping is not None:
        lights = np.zeros(len(faces), dtype=np.intp)
        np.bitwise_or.at(lights, number[part], shadows.lacking[part])
        several &= ~overlapping[shadows.face[part]] | (np.bitwise_count(lights)[number[part]] > 1)
    alone = part[~several]
    found.append(_lacking(shadows.take(alone), shadows.lacking[alone] | dark[number[alone]]))
    crowd = part[several]
    count = 0
    for cells in mapped(lambda batch: _arranged(view, shadows.take(crowd[batch])), _batches(number[crowd])):
        count += len(cells)
        if count > MOST_CELLS:
            raise InputError(f"shadows overlap in more than {MOST_CELLS} parts: fewer lights, or the verb render")
        found.append(_lacking(cells, cells.lacking | dark[np.searchsorted(faces, cells.face)]))
    if count > MANY_CELLS:
        warnings.warn(f"shadows overlap in {count} parts: large, and slow to paint", InputWarning, stacklevel=2)
    return joined_shadows(found)


def _lacking(shadows: Shadows, lacking: Ints) -> Shadows:
    """The same polygons for want of these lights."""
    return Shadows(shadows.points, shadows.offsets, shadows.face, lacking, shadows.whole)


def _batches(group: Ints) -> Iterator[Ints]:
    """Numbers of what has some group (n,), whole groups together, in batches of about POLYGONS_AT_ONCE."""
    order = np.argsort(group, kind="stable")
    ends = np.append(np.flatnonzero(np.diff(group[order])) + 1, len(order))
    begin = 0
    while begin < len(order):
        one, many = np.searchsorted(ends, [begin, begin + POLYGONS_AT_ONCE], side="right")
        end = int(ends[max(one, many - 1)])
        yield order[begin:end]
        begin = end


def _arranged(view: View, shadows: Shadows) -> Shadows:
    """The cells of shadows that are no whole faces, several on each of their faces."""
    frames = FaceFrames.of(view, shadows.face)
    owner = ragged.owner(np.diff(shadows.offsets))
    polygons = polygons_of(frames.flat(shadows.points, owner), shadows.offsets)
    faces, leader, number = np.unique(shadows.face, return_index=True, return_inverse=True)
    light, lacking = np.unique(shadows.lacking, return_inverse=True)
    key, of = np.unique(number * len(light) + lacking, return_inverse=True)
    on, light_of = np.divmod(key, len(light))
    one = (np.bincount(on) == 1)[on]
    region = np.empty(len(key), dtype=object)
    for which, grid in ((one, view.tolerance), (~one, None)):
        mine = np.flatnonzero(which[of])
        # The borders of several regions are brought to a grid when they meet.
        region[which] = unions(polygons[mine], np.searchsorted(np.flatnonzero(which), of[mine]), grid)
    cells, cell, missing = _cells(region, on, light[light_of], view.tolerance)
    cells, which = without_holes(cells, np.arange(len(cells)))
    flat, offsets = corners_of(cells)
    lead = leader[cell[which]]
    points = frames.lifted(flat, np.repeat(lead, np.diff(offsets)))
    return Shadows(points, offsets, faces[cell[which]], missing[which], np.zeros(len(which), dtype=np.bool_))


def _cells(region: Any, on: Ints, light: Ints, tolerance: float) -> tuple[Any, Ints, Ints]:
    """Regions on faces on (r,), ascending, that lack one light each, as cells: polygons (k,), their faces, and the
    lights that they lack; one region is its own cell."""
    import shapely

    one = (np.bincount(on) == 1)[on]
    parts, of = without_splinters(region[one], tolerance)
    # Where the shadow of one thing ends and that of the next begins, the border goes straight on.
    parts = shapely.simplify(parts, WIDTH_KEPT * tolerance)
    several = np.flatnonzero(~one)
    if not len(several):
        return parts, on[one][of], light[one][of]
    faces, group = np.unique(on[several], return_inverse=True)
    cells, cell = cells_of(region[several], group, tolerance)
    missing = _missing(cells, cell, region[several], group, light[several])
    cells, cell, missing = _without_filled_holes(cells, cell, missing, tolerance)
    return (
        np.concatenate([parts, cells]),
        np.concatenate([on[one][of], faces[cell]]),
        np.concatenate([light[one][of], missing]),
    )


def _missing(cells: Any, cell: Ints, region: Any, on: Ints, light: Ints) -> Ints:
    """(k,) which lights cells on faces cell (k,) lack: those with a region on face on (r,) that covers them."""
    import shapely

    inner = shapely.get_coordinates(shapely.point_on_surface(cells))
    missing = np.zeros(len(cells), dtype=np.intp)
    shapely.prepare(region)
    for bit in np.unique(light).tolist():
        own = np.flatnonzero(light == bit)
        place = np.minimum(np.searchsorted(on[own], cell), len(own) - 1)
        here = np.flatnonzero(on[own][place] == cell)
        inside = shapely.contains_xy(region[own[place[here]]], *inner[here].T)
        missing[here[inside]] |= bit
    return missing


def _without_filled_holes(cells: Any, cell: Ints, missing: Ints, tolerance: float) -> tuple[Any, Ints, Ints]:
    """The cells that lack lights, on faces cell (k,), without those holes in which all lack more of them."""
    import shapely

    grade = np.bitwise_count(missing).astype(np.intp)
    pierced = np.flatnonzero((shapely.get_num_interior_rings(cells) > 0) & (missing > 0))
    if len(pierced):
        rings, owner = shapely.get_rings(cells[pierced], return_index=True)
        outer = np.concatenate([[True], owner[1:] != owner[:-1]])
        holes, owner = shapely.polygons(rings[~outer]), owner[~outer]
        least = _least_inside(holes, cell[pierced[owner]], shapely.point_on_surface(cells), cell, grade)
        open_still = least <= grade[pierced[owner]]
        filled = shapely.polygons(rings[outer])
        left = np.unique(owner[open_still])
        if len(left):
            cut = shapely.multipolygons(holes[open_still], indices=np.searchsorted(left, owner[open_still]))
            filled[left] = shapely.difference(filled[left], cut)
        cells[pierced] = filled
    kept = np.flatnonzero(missing)
    parts, of = without_splinters(cells[kept], tolerance)
    return parts, cell[kept[of]], missing[kept[of]]


def _least_inside(holes: Any, hole_face: Ints, inner: Any, cell: Ints, grade: Ints) -> Ints:
    """(h,) the smallest grade of the cells with inner points (k,) in holes (h,) of their face."""
    import shapely

    # Side by side on a line, so that one tree holds all faces.
    width = 2.0 * float(np.ptp(shapely.get_coordinates(holes), axis=0).max(initial=0.0)) + 16.0
    places = shapely.get_coordinates(inner)
    tree = shapely.STRtree(shapely.points(places[:, 0] + width * cell, places[:, 1]))
    xy, of = shapely.get_coordinates(holes, return_index=True)
    moved = shapely.set_coordinates(holes.copy(), np.stack([xy[:, 0] + width * hole_face[of], xy[:, 1]], axis=1))
    hole, found = tree.query(moved, predicate="intersects")
    least = np.full(len(holes), np.iinfo(np.intp).max)
    np.minimum.at(least, hole, grade[found])
    return least


def shadow_decals_of(shadows: Shadows, kind: FillKind) -> Decals:
    """Shadows as decals, higher grades above, with levels between them for the steps of soft borders."""
    grade = shadows.grade
    none = np.full(len(shadows), -1, dtype=np.intp)
    light = np.where(grade == 1, np.frexp(np.maximum(shadows.lacking, 1))[1].astype(np.intp) - 1, -1)
    return Decals(
        shadows.points,
        shadows.offsets,
        shadows.face,
        np.full(len(shadows), int(kind), dtype=np.intp),
        grade,
        light,
        none,
        LEVELS * grade,
        lacking=shadows.lacking,
    )


# Cast shadows as polygons on the faces they fall on.

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
    Edge cases: faces that the light grazes, and dark sides, have no shadows; what touches a face or lies in its plane
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
    """The shadows as in cast_shadows, but for those of one item on one, in one light, for which more than so many pairs
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
    seen, sides = drawn_faces(view, projected), projected.sides
    seen = seen if receivers is None else seen[receivers[seen]]
    unpierced = unpierced_faces(view, items & ~solids, sides)
    found, missing = [], [np.zeros((3, 0), dtype=np.intp)]
    for number, light in in_turn(enumerate(lights)):
        system = light_system(view, light)
        facing = system.facing(planes, view.tolerance)
        lit = seen[facing[seen] * projected.facing[seen] > 0]
        bodies = lit_bodies(view, planes, system, facing, items & ~solids, off, sides, lit)
        bright = Receivers.of(view, lit)
        outlined, open_items, open_receivers = _of_outlines(view, system, bodies, bright, number)
        alone = items.copy()
        alone[bodies.item[bodies.convex]] = False
        within, receiver, points, offsets = bodies.beyond(bright)
        unlit = unlit_faces(view, system, items, unpierced & alone[view.face_item], pairs)
        within = np.union1d(np.union1d(within, shut_out(view, system, items, bright)), np.flatnonzero(unlit[lit]))
        inside = _whole(bright.take(within), number)
        lacking = np.full(len(receiver), 1 << number, dtype=np.intp)
        beyond = Shadows(points, offsets, bright.face[receiver], lacking, np.zeros(len(receiver), dtype=np.bool_))
        parts = [joined_shadows([outlined, inside, beyond]).without_needless()]
        still = ~np.isin(bright.face, parts[0].face[parts[0].whole])
        # What lies in the shadow of something keeps no light away but what that does.
        facing = np.where(unlit, 0, facing)
        for casters, on in ((alone, still), (open_items, still & open_receivers)):
            dark = replace(shadow_casters(view, planes, system, facing, casters, solids, sides), known=bodies.settle)
            under = bright.take(np.flatnonzero(on))
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
    """The shadows of pairs of casters and receivers, batch by batch; on a face that one of them darkens whole, only
    that one."""
    parts = []
    dark = np.zeros(len(receivers.face), dtype=np.bool_)
    for caster, receiver in in_turn(pairs):
        light = np.flatnonzero(~dark[receiver])
        caster, receiver = caster[light], receiver[light]
        found = shadow_crossings(view, casters, receivers, caster, receiver)
        first = _first_whole(found, receiver, len(dark))
        dark[receiver[found.pair[first]]] = True
        useful = ~dark[receiver[found.pair]]
        useful[first] = True
        found = found.take(np.flatnonzero(useful))
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

    Edge cases: faces that the light grazes, and dark sides, have no shadows; what touches a face or lies in its plane
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


# Telling which shadows a picture lacks.


def tell_missing_shadows(items: Sequence[Item], lights: Sequence[Light], left_out: Ints) -> None:
    """Warn of shadows that are left out, with one InputWarning for each item that throws them and one on which.

    left_out (3,k): as in Cast.
    """
    for one, other in np.unique(left_out[1:], axis=1).T.tolist():
        number = left_out[0, (left_out[1] == one) & (left_out[2] == other)]
        of = ", ".join(lights[k].name or f"light {k + 1}" for k in number.tolist())
        on = "itself" if one == other else items[other].name
        text = unresolved(f"more shadows on {on} than can be cut out are left out, in {of}; the verb render has them")
        warnings.warn(f"{items[one].name}: {text}", InputWarning, stacklevel=2)


# Shadows of what is transparent: light that is dimmed and coloured.
#
# In them half of what their light would give is left, in the colour of what dims it, as far as that is opaque.

CLEAR_LEVEL = 1 << 20
"""The level of these shadows: they come after all other decals of a face."""


def transparent_shadows(
    view: View,
    scene: Scene,
    lights: Sequence[Light],
    shadows: Decals | None = None,
    *,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
    budget: Budget = USUAL,
) -> Decals:
    """The shadows of the transparent items of a scene that do not occlude: decals of the items' colours and opacities,
    each with one light, to be drawn after the shadows of what is not transparent.

    shadows: those; where they keep a light away nothing dims it, and where they keep others away those lack, too.
    Things of one colour and opacity dim a light once. They fall on opaque items only. receivers, errors and degenerate
    cases as in cast_shadows; an InputWarning names the items for which the budget did not do.
    Source: Glaeser, section 6.6.
    """
    groups: dict[tuple[str, float], Bools] = {}
    for number, item in enumerate(scene.items):
        if item.dims_light and not view.occludes[number]:
            same = (item.colour, item.material.opacity)
            groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
    if not groups:
        return joined_decals()
    projected = project_faces(view) if projected is None else projected
    dark = no_decals() if shadows is None else shadows.of(np.flatnonzero(shadows.kind == FillKind.SHADOW))
    # Light goes through what is transparent, and leaves no shadow on it.
    opaque = np.array([item.material.opacity >= 1.0 for item in scene.items], dtype=np.bool_)[view.shown_item]
    shown = opaque if receivers is None else receivers & opaque
    found = []
    for (colour, opacity), items in groups.items():
        found_here = cast_within(view, lights, budget.pairs, casters=items, receivers=shown, projected=projected)
        tell_missing_shadows(scene.items, lights, found_here.left_out)
        cast = found_here.shadows
        here = dark.of(np.flatnonzero(np.isin(dark.face, cast.face)))
        found.append(_dimmed(view, cast, disjoint_decals(view, here), colour, opacity))
    return joined_decals(*found)


def _dimmed(view: View, cast: Shadows, dark: Decals, colour: str, opacity: float) -> Decals:
    """Where things of one colour and opacity throw shadows of single lights, cut along disjoint dark ones."""
    import shapely

    if not len(cast):
        return no_decals()
    dark = dark.of(np.argsort(dark.face, kind="stable"))
    frames = FaceFrames.of(view, cast.face)
    polygons = polygons_of(frames.flat(cast.points, _owner(cast.offsets)), cast.offsets)
    _, leader, group = np.unique(
        np.stack([cast.face, cast.lacking], axis=1), axis=0, return_index=True, return_inverse=True
    )
    region = unions(polygons, group.ravel(), view.tolerance)
    face, light = cast.face[leader], cast.lacking[leader]
    others = polygons_of(FaceFrames.of(view, dark.face).flat(dark.points, _owner(dark.offsets)), dark.offsets)
    first, last = (np.searchsorted(dark.face, face, side=side) for side in ("left", "right"))
    mine = ragged.owner(last - first)
    other = np.arange(len(mine)) - np.repeat(np.cumsum(last - first) - last, last - first)
    bright = region.copy()
    covered = np.flatnonzero(last > first)
    if len(covered):
        around = unions(others[other], np.searchsorted(covered, mine), view.tolerance)
        bright[covered] = shapely.difference(region[covered], around, grid_size=view.tolerance)
    still = np.flatnonzero(dark.lights_lacking[other] & light[mine] == 0)
    mine, other = mine[still], other[still]
    inner = shapely.intersection(region[mine], others[other], grid_size=view.tolerance)
    every = np.concatenate([bright, inner])
    number = np.concatenate([np.arange(len(region)), mine])
    lacking = np.concatenate([light, light[mine] | dark.lights_lacking[other]])
    parts, of = without_splinters(every, view.tolerance)
    parts, of = without_holes(parts, of)
    flat, offsets = corners_of(parts)
    lead = leader[number[of]]
    none = np.zeros(len(of), dtype=np.intp)
    return Decals(
        frames.lifted(flat, np.repeat(lead, np.diff(offsets))),
        offsets,
        cast.face[lead],
        none + int(FillKind.CLEAR_SHADOW),
        none,
        np.frexp(light[number[of]])[1].astype(np.intp) - 1,
        none,
        none + CLEAR_LEVEL,
        (colour,),
        lacking[of],
        np.full(len(of), opacity),
    )


def _owner(offsets: Ints) -> Ints:
    return ragged.owner(np.diff(offsets))
