"""Scenes cut by planes: the faces of cuts and their hatching, parts of smooth surfaces, and near and far planes."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import product
from typing import Any

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.cut_curve import CutCurve, parts_outside
from vectorplot.drawing.pens import PENS
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.contours_and_isophotes import plane_sections
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.implicit_curves import ImplicitTracing, implicit_plane_sections
from vectorplot.features.implicit_meshes import implicit_mesh
from vectorplot.features.parameter_curves import domain_borders
from vectorplot.features.polygonization import BOXED, polygonized, sides_of
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.clipping import crossed_sides
from vectorplot.geometry.connectivity import pieces_of_faces, unbalanced_vertices
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import (
    HalfSpaces,
    PlaneFrame,
    divided_mesh,
    mesh_of_regions,
    nothing_beside,
    region_of_sides,
    section_sides,
    segments_outside,
    window,
)
from vectorplot.geometry.mesh_repair import chosen_faces
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.vectors import dot, norm, normalize
from vectorplot.geometry.weld import close_points
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.io.anything import scene_of
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.cuts import Cut
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.placement import camera_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, Section, SurfaceLines
from vectorplot.surfaces.implicit import BoxedImplicit, CutImplicit
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_hole, is_implicit, is_parametrised
from vectorplot.surfaces.trimmed import CutSurface, smooth_parts
from vectorplot.tolerances import (
    CUT_FACE_CHORD_OF_EXTENT,
    EDGE_ON_SINE,
    NO_AZIMUTH_SINE,
    ROUNDING,
    SECTION_ENDS_OF_EXTENT,
    ZERO_OF_EXTENT,
)
from vectorplot.words import unknown

# The faces that planes make in closed bodies: areas in the planes.

LOOKS = 33
"""Places along u and along v at which is looked whether a surface has holes."""


@dataclass(frozen=True, eq=False)
class Body:
    """What of an item is closed, and has an inside: its closed pieces of a mesh, or a closed surface."""

    item: Item

    @cached_property
    def closed(self) -> Mesh | Surface | ImplicitSurface | None:
        """The shape, or the part of it, that is closed; None where nothing is."""
        shape = self.item.shape
        if isinstance(shape, Mesh):
            return _closed_pieces(shape)
        if is_implicit(shape):
            return shape if is_closed_oriented(self._net) else None
        return shape if is_parametrised(shape) and _is_closed(shape) else None

    @cached_property
    def _net(self) -> Mesh:
        """The triangles of an implicit surface; none of other shapes."""
        shape = self.item.shape
        return implicit_mesh(shape, ImplicitTracing().cells).mesh if is_implicit(shape) else self.item.mesh

    @cached_property
    def is_open(self) -> bool:
        """Whether some of it is not closed."""
        closed = self.closed
        return closed is None or (isinstance(closed, Mesh) and closed.face_count < self.item.mesh.face_count)

    @cached_property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates."""
        shape = self.item.shape
        return shape.bounds if isinstance(shape, Mesh) else smooth_bounds(shape)

    def is_met_by(self, region: HalfSpaces) -> bool:
        """Whether a region reaches to the box around the body."""
        corners = self.bounds[np.array(list(np.ndindex(2, 2, 2))), np.arange(3)]
        return bool((region.heights(corners) > 0.0).any(axis=1).all())

    def is_opened_by(self, region: HalfSpaces) -> bool:
        """Whether a region takes away a part of a piece that is not closed, and leaves another."""
        shape = self.item.shape
        if is_curve(shape) or not self.is_open or not self.is_met_by(region):
            return False
        if isinstance(shape, Mesh):
            return _is_opened(shape, region)
        if is_implicit(shape):
            return _is_opened(self._net, region)
        if not is_parametrised(shape):
            return False
        u, v = np.meshgrid(*shape.domain.grid(LOOKS, LOOKS), indexing="ij")
        with np.errstate(all="ignore"):
            points = np.asarray(shape.points(u, v)).reshape(-1, 3)
        gone = (region.heights(points[np.isfinite(points).all(axis=1)]) > 0.0).all(axis=0)
        return bool(gone.any() and not gone.all())

    def face(
        self, frame: PlaneFrame, region: HalfSpaces, number: int, others: list[HalfSpaces], within: HalfSpaces | None
    ) -> Any:
        """The face that the body shows on a plane of a region when what is in the region is taken away: an area of
        shapely in the frame of the plane; nothing of it is in other regions, all of it is within one."""
        import shapely

        closed = self.closed
        if closed is None or not self.is_met_by(region):
            return shapely.Polygon()
        sides = (
            section_sides(closed, region, number)
            if isinstance(closed, Mesh)
            else _smooth_sides(closed, region, number, self.bounds)
        )
        area = region_of_sides(*frame.places(sides))
        if area.is_empty:
            return area
        left, bottom, right, top = shapely.bounds(area).tolist()
        wide = right - left, top - bottom
        around = (left - wide[0], bottom - wide[1], right + wide[0], top + wide[1])
        if len(region.normals) > 1:
            area = shapely.intersection(area, window(region, number, frame, around))
        for other in others:
            area = shapely.difference(area, window(other, -1, frame, around))
        return area if within is None else shapely.intersection(area, window(within, -1, frame, around))


def _closed_pieces(mesh: Mesh) -> Mesh | None:
    """The pieces of a mesh that close, and agree about the outside."""
    if mesh.present is not None:
        return None
    loose = unbalanced_vertices(len(mesh.vertices), mesh.corners, mesh.offsets)
    if not loose.any():
        return mesh if mesh.face_count else None
    number, piece = pieces_of_faces(len(mesh.vertices), mesh.corners, mesh.offsets)
    is_open = np.bincount(piece[mesh.corner_face], loose[mesh.corners], number) > 0
    return chosen_faces(mesh, ~is_open[piece]) if not is_open.all() else None


def _is_opened(mesh: Mesh, region: HalfSpaces) -> bool:
    """Whether a region parts a piece of a mesh that does not close."""
    number, piece = pieces_of_faces(len(mesh.vertices), mesh.corners, mesh.offsets)
    loose = unbalanced_vertices(len(mesh.vertices), mesh.corners, mesh.offsets)
    is_open = np.bincount(piece[mesh.corner_face], loose[mesh.corners], number) > 0
    if mesh.present is not None:
        is_open = np.ones(number, dtype=np.bool_)
    some = chosen_faces(mesh, is_open[piece])
    divided = divided_mesh(some, region)
    whole = divided.place >= 0
    if divided.inside.face_count and divided.outside.face_count > np.count_nonzero(whole):
        return True
    # A plane along edges parts pieces, but no face.
    number, piece = pieces_of_faces(len(some.vertices), some.corners, some.offsets)
    left = np.bincount(piece, whole, number)
    return bool(((left > 0) & (left < np.bincount(piece, minlength=number))).any())


def _is_closed(surface: Surface) -> bool:
    """Whether a surface has neither borders nor holes, as far as is looked."""
    u, v = np.meshgrid(*surface.domain.grid(LOOKS, LOOKS), indexing="ij")
    with np.errstate(all="ignore"):
        holed = is_hole(np.asarray(surface.points(u, v))).any()
    return not holed and not len(domain_borders(surface, Tracing()))


def _smooth_sides(surface: Surface | ImplicitSurface, region: HalfSpaces, number: int, bounds: Floats) -> Floats:
    """(2,s,3) chords of the section of a closed surface with a plane, their ends on it."""
    extent = float(np.ptp(bounds, axis=0).max())
    points, sides, count = [np.zeros((0, 3))], [np.zeros((2, 0), dtype=np.intp)], 0
    for found in _sections(surface, region, number, CUT_FACE_CHORD_OF_EXTENT * extent):
        points.append(found.points)
        sides.append(count + segments(found).T)
        count += len(found.points)
    every = np.concatenate(points)
    one = close_points(every, SECTION_ENDS_OF_EXTENT * extent)
    return every[one[np.concatenate(sides, axis=1)]]


def _sections(surface: Surface | ImplicitSurface, region: HalfSpaces, number: int, tolerance: float) -> list[Any]:
    """The sections of the smooth parts of a surface with a plane, their chords within a tolerance."""
    normal, offset = region.normals[number], region.offsets[number]
    if is_implicit(surface):
        return [implicit_plane_sections(surface, normal, offset, tracing=ImplicitTracing(tolerance=tolerance))]
    assert is_parametrised(surface)
    tracing = Tracing(tolerance=tolerance)
    return [plane_sections(part.surface, normal, offset, tracing=tracing) for part in smooth_parts(surface)]


# Smooth surfaces and curves of which parts are cut away.

SAMPLES_OF_RANGE = 64
"""Cells along u and along v at whose corners is looked whether anything of a surface is left."""

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))
"""What is left of a shape that is cut away as a whole."""


def is_cut(item: Item) -> bool:
    """Whether cuts go through an item: not through axes, dimensions, leaders, centre lines and traces, which are no
    material."""
    return not is_annotation(item) and item.lines != ("trace",)


def smooth_part(
    item: Item, gone: tuple[HalfSpaces, ...], within: HalfSpaces | None = None
) -> Mesh | Surface | ImplicitSurface | Curve:
    """What of the smooth surface or the curve of an item is outside of some regions, and inside of one; a mesh without
    faces where that is nothing."""
    shape = item.shape
    assert not isinstance(shape, Mesh)
    if is_curve(shape):
        parts = parts_outside(shape, gone, within)
        whole = len(parts) == 1 and parts[0].tolist() == [shape.start, shape.end]
        return shape if whole else CutCurve(shape, parts) if len(parts) else NOTHING
    if is_parametrised(shape):
        return _part_of_surface(CutSurface(shape, gone, within))
    assert is_implicit(shape)
    return _part_of_implicit(shape, gone, within)


def _part_of_implicit(
    shape: ImplicitSurface, gone: tuple[HalfSpaces, ...], within: HalfSpaces | None
) -> ImplicitSurface | Mesh:
    """The surface in a smaller box, as far as planes are across x, y or z, and cut by the others; a mesh without faces
    where nothing is left of it."""
    box, oblique, inner = np.array(shape.box, dtype=np.float64), [], within
    for region in (*gone, *([] if within is None else [within])):
        if (side := _across_axis(region)) is None:
            oblique += [region] if region is not within else []
            continue
        inner = None if region is within else inner
        axis, sign, at = side
        is_low = (sign > 0.0) == (region is within)
        row = 0 if is_low else 1
        box[row, axis] = max(box[row, axis], at) if is_low else min(box[row, axis], at)
    if not (box[0] < box[1]).all():
        return NOTHING
    boxed = shape if np.array_equal(box, shape.box) else BoxedImplicit(shape, box)
    if not oblique and inner is None:
        return boxed
    part = CutImplicit(boxed, tuple(oblique), inner)
    whole, left = polygonized(boxed, SAMPLES_OF_RANGE), polygonized(part, SAMPLES_OF_RANGE)
    untouched = left.face_count == whole.face_count and not sides_of(part).on(left.vertices)[:, BOXED:].any()
    return boxed if untouched else part if left.face_count else NOTHING


def _part_of_surface(surface: CutSurface) -> CutSurface | Mesh:
    """The surface; a mesh without faces where nothing is left of it."""
    u, v = np.meshgrid(*surface.domain.grid(SAMPLES_OF_RANGE, SAMPLES_OF_RANGE), indexing="ij")
    with np.errstate(all="ignore"):
        left = np.isfinite(surface.points(u, v)).any()
    return surface if left else NOTHING


def _across_axis(region: HalfSpaces) -> tuple[int, float, float] | None:
    """The axis that the only plane of a region is across, whether the region is above (1) or below (-1) it, and where
    it is; None for other regions."""
    normal: Floats = np.array(region.normals[0])
    axis = int(np.argmax(np.abs(normal)))
    if len(region.normals) > 1 or (np.abs(np.delete(normal, axis)) > ROUNDING).any():
        return None
    sign = float(np.sign(normal[axis]))
    return axis, sign, sign * region.offsets[0]


# How cut faces are hatched: each part otherwise than those it touches.

ANGLES_DEG = (45.0, 135.0)
"""From what is level in the plane."""

FACTORS = (1.0, 0.6, 1.5)
"""How far apart strokes are, as multiples of what is usual. None is another one halved, however often."""

WAYS = tuple((angle, factor) for factor in FACTORS for angle in ANGLES_DEG)
"""Those of ISO 128-50, in the order in which they are taken: first the direction changes, then the spacing."""

USUAL_MM = 2.4
"""From stroke to stroke on the page, where nothing is asked for; half as much on narrow faces."""

NARROW_MM = 8.0
"""A square on the page with narrower sides, or a strip half as wide, is narrow."""

FINEST_MM = 0.7
"""No strokes are closer on the page (ISO 128-50), unless it is asked for."""

FLATTEST = 0.1
"""Planes that seem to be more foreshortened are hatched like those that are as much so: they are slivers."""

DEFAULT_PAGE_MM = 216.0
"""How large a scene is on its page, where nobody knows: an A4 sheet within its margins."""

INK = 0.5
"""Of a hatch that is closer than its pen is wide, at most so much of the paper is black."""

Way = tuple[float, float]
"""An angle in degrees, and a factor."""

InSpace = Callable[[Floats], Floats]
"""How long a millimetre of the page is at points (n,3) in space, across the sight: (n,)."""


def ways_of_parts(faces: list[list[Any]], tolerance: float) -> tuple[Way, ...]:
    """The angle and the spacing for each part: no two parts that touch have the same, as long as there are enough.

    faces: for each plane the areas (of shapely) of the parts in it, one each.
    Neighbours in the list of parts begin with different directions.
    """
    import shapely

    count = len(faces[0]) if faces else 0
    if not count:
        return ()
    touching: list[set[int]] = [set() for _ in range(count)]
    for areas in faces:
        tree = shapely.STRtree(areas)
        for one, other in tree.query(areas, predicate="dwithin", distance=tolerance).T.tolist():
            if one != other:
                touching[one].add(other)
    chosen: list[int] = []
    for part in range(count):
        taken = {chosen[other] for other in touching[part] if other < part}
        order = np.roll(np.arange(len(WAYS)).reshape(-1, 2), part % 2, axis=1).ravel().tolist()
        chosen.append(next((way for way in order if way not in taken), order[0]))
    return tuple(WAYS[way] for way in chosen)


def without_overlaps(areas: list[Any]) -> list[Any]:
    """The areas of shapely of several parts in a plane; where some overlap the smallest is left as it is."""
    import shapely

    every = np.array(areas, dtype=object)
    if not len(every):
        return []
    sizes = shapely.area(every)
    one, other = shapely.STRtree(every).query(every, predicate="intersects")
    smaller = (sizes[other] < sizes[one]) | ((sizes[other] == sizes[one]) & (other > one))
    for part in np.unique(one[smaller]).tolist():
        inner = [areas[k] for k in other[smaller & (one == part)].tolist()]
        every[part] = shapely.difference(areas[part], shapely.union_all(inner))
    return list(every)


def turned(cut: Cut, way: Way) -> Way:
    """A way of a part, turned to the angle that a cut asks for."""
    return cut.angle_deg + way[0] - ANGLES_DEG[0], way[1]


def page_hatch(cut: Cut, way: Way) -> Hatching:
    """The hatch of the faces of a part, if a cut asks for a spacing on the page; else none."""
    if cut.spacing_mm is None:
        return Hatching("none")
    spacing = cut.spacing_mm * way[1]
    width = min(PENS["hatch"].width_mm, INK * spacing)
    return Hatching("even", spacing, turned(cut, way)[0], along="surface", width_mm=width)


def default_page(scene: Scene) -> InSpace:
    """What a millimetre is where a scene fills a page of usual size."""
    extent = float(np.ptp(scene.bounds, axis=0).max())
    return lambda points: np.full(len(points), extent / DEFAULT_PAGE_MM)


def spacings_in_space(
    frames: Sequence[PlaneFrame], faces: list[list[Any]], ways: list[list[Way]], in_space: InSpace, camera: Camera
) -> Floats:
    """(n,k) how far apart the strokes of each of k parts are in each of n planes.

    faces: for each plane the areas (of shapely) of the parts in it; ways: of these, as their cuts have turned them.
    A part has one spacing in all planes, but for planes that are seen so flat that some part of them would be hatched
    too closely: there all are wider apart.
    """
    import shapely

    areas = np.array(faces, dtype=object)
    shown = ~shapely.is_empty(areas)
    middle = np.zeros((*shown.shape, 2))
    middle[shown] = np.nan_to_num(shapely.get_coordinates(shapely.centroid(areas[shown])))
    points = np.stack([frame.points(places) for frame, places in zip(frames, middle, strict=True)])
    mm = in_space(points.reshape(-1, 3)).reshape(shown.shape)
    length = np.where(shown, shapely.length(areas), 1.0)
    wide = np.where(shown, 4.0 * shapely.area(areas) / (length * mm), 0.0).max(axis=0)
    angles, factors = np.moveaxis(np.array(ways, dtype=np.float64), -1, 0)
    usual = np.where(wide < NARROW_MM, 0.5, 1.0) * USUAL_MM * factors[0]
    apart = usual * np.where(shown, mm, 0.0).max(axis=0)
    flat = np.stack([_foreshortened(*one, camera) for one in zip(frames, points, angles, strict=True)])
    closest = np.where(shown, apart * flat / mm, np.inf).min(axis=1)
    return np.asarray(apart * np.maximum(FINEST_MM / closest, 1.0)[:, None])


def _foreshortened(frame: PlaneFrame, points: Floats, angles_deg: Floats, camera: Camera) -> Floats:
    """(k,) what share of their distance strokes at angles through points (k,3) of a plane seem to have."""
    sight = np.broadcast_to(camera.axes[2], points.shape) if camera.parallel else normalize(camera.eye - points)
    along = np.stack([stroke_axes(frame, angle)[0] for angle in angles_deg.tolist()])
    seen = np.sqrt(np.maximum(1.0 - dot(along, sight) ** 2, FLATTEST**2))
    return np.asarray(np.maximum(np.abs(matmul(sight, np.cross(*frame.axes))) / seen, FLATTEST))


def stroke_axes(frame: PlaneFrame, angle_deg: float) -> Floats:
    """(2,3) the unit vectors along strokes and across them, at an angle from what is level in a plane."""
    normal = np.cross(*frame.axes)
    level = np.array([-normal[1], normal[0], 0.0])
    if float(norm(level)) <= NO_AZIMUTH_SINE:
        level = np.array([1.0, 0.0, 0.0])
    level -= normal * float(matmul(normal, level))
    level /= norm(level)
    upward, angle = np.cross(normal, level), np.radians(angle_deg)
    return np.asarray(np.cos(angle) * np.stack([level, upward]) + np.sin(angle) * np.stack([upward, -level]))


def hatch_section(frame: PlaneFrame, points: Floats, angle_deg: float, spacing: float) -> Section:
    """The planes, so far apart, whose sections of a plane face with corners points (n,3) are its hatch."""
    _, across = stroke_axes(frame, angle_deg)
    # Counted from the frame, so that all faces of a part in a plane have one set of strokes.
    base = float(matmul(frame.origin, across))
    heights = matmul(points - frame.origin, across)
    numbers = np.arange(np.ceil(heights.min() / spacing - 0.5), np.floor(heights.max() / spacing - 0.5) + 1.0)
    x, y, z = across.tolist()
    return Section((x, y, z), tuple((base + (numbers + 0.5) * spacing).tolist()))


# Scenes that are cut: bodies without what is taken away of them, with the faces that show then.

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
        What is cut, see `io.scene_of`; cuts that a scene has stay.
    cuts : Cut or str, or several
        Texts as in `Cut.of`: y = 0, x + 2y > 3, or several conditions with commas between them.
    away : {"gone", "ghost", "moved"}
        What becomes of what texts take away.
    colour : str, optional
        Of the faces at cuts that are texts.
    spacing_mm, angle_deg : float
        Of the hatches of these faces, see `Cut`.
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


def cut_scene(
    scene: Scene, camera: Camera | str | None = None, page: Callable[[Scene], InSpace] = default_page
) -> Scene:
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

    Edge cases: a face in the plane of a cut belongs to the side where its body is.

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
    # Bodies of one group that look alike are one part; what turns or is moved together may be of several.
    parts: dict[Hashable, list[int]] = {}
    for k in faced:
        item = bodies[k].item
        parts.setdefault((item.group, item.colour, item.material) if item.group else k, []).append(k)
    part = {k: number for number, own in enumerate(parts.values()) for k in own}
    areas = [[shapely.union_all([every[k] for k in own]) for own in parts.values()] for every in faces]
    ways = ways_of_parts(areas, nothing_beside(scene.bounds))
    turns = [[turned(scene.cuts[one], way) for way in ways] for one, _ in planes]
    spacings = spacings_in_space(frames, areas, turns, in_space, camera)
    result = []
    for k in faced:
        number, way = part[k], ways[part[k]]
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


def between_planes(scene: Scene, camera: Camera) -> Scene:
    """The scene cut at the camera's near and far plane, bodies open where they are.

    Edge cases: a face in one of the planes stays.
    Source: Glaeser, section 2.5 (Hodgman and Sutherland); errata G2-10 to G2-12.
    """
    extent = float(np.ptp(scene.bounds, axis=0).max())
    limits = [
        _Limit(_depths_beyond(camera, side, limit), _beyond(camera, side, limit)) for side, limit in _planes(camera)
    ]
    return replace(scene, items=tuple(_within(item, limits, ZERO_OF_EXTENT * extent) for item in scene.items))


def between(item: Item, normals: Floats, points: Floats, tolerance: float) -> Item:
    """What of an item is on the sides of all of some planes that unit normals (n,3) lead to from points (n,3) of them,
    bodies open where they are cut; what is no farther on the other side than a tolerance is in the plane, and stays."""
    limits = []
    for normal, point in zip(normals, points, strict=True):
        x, y, z = (-normal).tolist()
        limits.append(_Limit(_heights_above(normal, point), HalfSpaces(((x, y, z),), (-float(dot(normal, point)),))))
    return _within(item, limits, tolerance)


def _heights_above(normal: Floats, point: Floats) -> Callable[[Floats], Floats]:
    return lambda points: np.asarray(matmul(points - point, normal))


def before_plane(item: Item, normal: Floats, point: Floats, tolerance: float) -> Item:
    """What of an item is before a plane, see between; faces in the plane are not before it."""
    kept, heights = between(item, normal[None], point[None], tolerance), _heights_above(normal, point)
    if not isinstance(kept.shape, Mesh) or not kept.shape.face_count:
        return kept
    before = np.maximum.reduceat(heights(kept.shape.vertices)[kept.shape.corners], kept.shape.offsets[:-1]) > tolerance
    if before.all():
        return kept
    place = np.where(before, np.cumsum(before) - 1, -1)
    patterns = tuple(replace(one, face=int(place[one.face])) for one in kept.patterns if place[one.face] >= 0)
    return replace(kept, shape=chosen_faces(kept.shape, before), patterns=patterns)


@dataclass(frozen=True)
class _Limit:
    """A plane at which things end: how far points (n,3) are on the side that is kept (n,), and what is beyond it."""

    heights: Callable[[Floats], Floats]
    beyond: HalfSpaces


def _depths_beyond(camera: Camera, side: float, limit: float) -> Callable[[Floats], Floats]:
    return lambda points: side * (depths(points, camera) - limit)


def _within(item: Item, limits: Sequence[_Limit], tolerance: float) -> Item:
    if isinstance(item.shape, Mesh):
        mesh, place = item.shape, np.arange(item.shape.face_count)
        for limit in limits:
            mesh, next_place = _cut(mesh, limit.heights(mesh.vertices), tolerance)
            place = np.where(place >= 0, np.append(next_place, -1)[place], -1)
        if item.added_edges is not None and len(item.added_edges):
            beyond = [limit.beyond for limit in limits]
            start, end, _ = segments_outside(item.added_edges[:, 0], item.added_edges[:, 1], beyond)
            item = replace(item, added_edges=np.stack([start, end], axis=1))
        if mesh is item.shape:
            return item
        kept = tuple(replace(p, face=int(place[p.face])) for p in item.patterns if place[p.face] >= 0)
        # Contours by the normals of the whole would reach beyond what is left.
        normals = None if item.curves.smooth_contours else item.normals
        return replace(item, shape=mesh, patterns=kept, normals=normals)
    low, high = smooth_bounds(item.shape)
    corners = np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, high, low)
    met = []
    for limit in limits:
        inside = limit.heights(corners)
        if (inside < -tolerance).all():
            return replace(item, shape=NOTHING, patterns=())
        if (inside < -tolerance).any():
            met.append(limit.beyond)
    return replace(item, shape=smooth_part(item, tuple(met)), patterns=()) if met else item


def _beyond(camera: Camera, side: float, limit: float) -> HalfSpaces:
    """What lies on the other side of a plane than what is kept."""
    toward = camera.axes[2]
    offset = float(matmul(toward, np.asarray(camera.target))) + camera.distance - limit
    return HalfSpaces((tuple((side * toward).tolist()),), (side * offset,))


def depths(points: Floats, camera: Camera) -> Floats:
    """(n,) how far points (n,3) are from the eye along the line to the target, in world units."""
    return np.asarray(camera.distance - matmul(points - np.asarray(camera.target), camera.axes[2]))


def _planes(camera: Camera) -> list[tuple[float, float]]:
    """The side that is kept, 1 beyond and -1 before, and the depth of each plane."""
    limits = ((1.0, camera.near), (-1.0, camera.far))
    return [(side, limit) for side, limit in limits if limit is not None]


def _cut(mesh: Mesh, distance: Floats, tolerance: float) -> tuple[Mesh, Ints]:
    """The part of a mesh where a distance (v,) from a plane is not negative, and (f,) where each face is then found, -1
    if it is gone or cut. New vertices lie on edges, one for both faces."""
    inside = np.where(np.abs(distance) <= tolerance, 0.0, distance)
    if (inside >= 0.0).all():
        return mesh, np.arange(mesh.face_count)
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    outside = np.bincount(mesh.corner_face, inside[mesh.corners] < 0.0, mesh.face_count) > 0
    whole, touched = np.flatnonzero(present & ~outside), np.flatnonzero(present & outside)
    own = [_some(mesh, which) for which in (whole, touched)]
    flat = max(tolerance, ZERO_OF_EXTENT * float(np.ptp(mesh.vertices, axis=0).max(initial=0.0)))
    pieces = convex_faces(np.ascontiguousarray(mesh.vertices.T), *own[1], flat)
    corners, offsets, made = _parts(pieces.corners, pieces.offsets, inside, mesh.vertices)
    every = np.concatenate([own[0][0], corners])
    used, number = np.unique(every, return_inverse=True)
    ends = np.concatenate([own[0][1], own[0][1][-1] + offsets[1:]])
    place = np.full(mesh.face_count, -1, dtype=np.intp)
    place[whole] = np.arange(len(whole))
    return Mesh(np.concatenate([mesh.vertices, made])[used], number, ends), place


def _some(mesh: Mesh, which: Ints) -> tuple[Ints, Ints]:
    """Corners and offsets of some faces."""
    kept = np.zeros(mesh.face_count, dtype=np.bool_)
    kept[which] = True
    return mesh.corners[kept[mesh.corner_face]], ragged.offsets(mesh.face_sizes[which])


def _parts(corners: Ints, offsets: Ints, inside: Floats, vertices: Floats) -> tuple[Ints, Ints, Floats]:
    """Corners and offsets of the parts of convex faces where inside (v,) is not negative, and the new vertices."""
    here, there = corners, corners[ragged.following(offsets)]
    crossing = inside[here] * inside[there] < 0.0
    (low, high), share, which = crossed_sides(here, there, crossing, inside)
    made = vertices[low] + share[:, None] * (vertices[high] - vertices[low])
    slots = np.stack([here, len(vertices) + which], axis=1)
    kept = np.stack([inside[here] >= 0.0, crossing], axis=1)
    # Of a face that only touches the plane an edge or a corner would be left.
    face = ragged.owner(np.diff(offsets))
    area = np.bincount(face, inside[here] > 0.0, len(offsets) - 1) > 0
    kept &= area[face][:, None]
    sizes = np.bincount(face, kept.sum(axis=1), len(offsets) - 1).astype(np.intp)
    return slots[kept], ragged.offsets(sizes[sizes > 0]), made
