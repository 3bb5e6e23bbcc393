"""Lines of items to hatch along: parameter lines, and lines that flow, so dense that they do for the darkest places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching import LEAST_MM, FollowedLines, place_ranks, ranks
from vectorplot.errors import InputError
from vectorplot.features.cross_fields import CombedCurvature
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent
from vectorplot.features.mesh_integration import mesh_sides
from vectorplot.features.mesh_lines import MeshCurves, face_triangles
from vectorplot.features.mesh_streamlines import evenly_spaced_on_faces
from vectorplot.features.streamlines import MOST_LINES as MOST_LINES_of_streamlines
from vectorplot.features.streamlines import evenly_spaced_curves
from vectorplot.features.surface_points import USUAL_CREASE_DEG, BentFaces, FaceSites, Sites, charts, unit
from vectorplot.features.tangent_fields import (
    AsymptoticDirections,
    IsophoteDirections,
    PrincipalDirections,
    SteepestSlope,
    TangentField,
    TurnedField,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.geometry.winding import signed_volumes
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import KnownCurves, SurfaceLines
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import capped_quadric_of
from vectorplot.surfaces.surface import Surface, is_parametrised
from vectorplot.visibility.polyhedra.smooth_lines import warn_of_no_lines

if TYPE_CHECKING:
    pass


# Lines that flow over surfaces and meshes, evenly spaced, to hatch along.

SLOPES: tuple[TangentField, TangentField] = (SteepestSlope(), TurnedField(SteepestSlope(), 0.5 * np.pi))

FIELDS: dict[str, tuple[TangentField, TangentField]] = {
    "slope": SLOPES,
    "level": SLOPES[::-1],
    "curvature": (PrincipalDirections(1), PrincipalDirections(2)),
    "asymptotic": (AsymptoticDirections(1), AsymptoticDirections(2)),
}
"""What strokes follow, and those that cross them, by the word for it, where they do not follow the light."""

ISOPHOTES = "isophotes"

ON_MESHES = ("slope", "level", "curvature", "asymptotic")
"""Those of them that meshes have."""

ROUGH = 64
"""Samples along each parameter, to find how large a surface comes out on the page."""

NEARLY_ALL = 0.98
"""Of a surface; where it comes out larger yet, lines may be wider apart."""

SAMPLES = 2.5
"""So often within the distance of neighbours one looks along a line how far they are apart on the page."""

SIDES = 4.0
"""Times the distance of neighbours that normals are long where distances are measured: the two sides of a thin shape do
not keep each other's lines away."""

FEWER = 0.999
"""Of the most lines that curves are evenly spaced in."""


@dataclass(frozen=True, eq=False)
class FlowingLines:
    """Curves that cover a shape evenly; samples (s,3) on them, line (s,): of which, apart (s,): how far in mm their
    neighbours are on the page where they are evenly apart; ranks (s,): which of them are drawn first."""

    curves: SurfaceCurves | MeshCurves
    samples: Floats
    line: Ints
    apart: Floats
    ranks: Floats


def flows(item: Item, along: str) -> bool:
    """Whether there are such lines on the shape of an item."""
    if isinstance(item.shape, Mesh):
        return along in ON_MESHES and bool(item.shape.face_count)
    return (along in FIELDS or along == ISOPHOTES) and is_parametrised(item.shape)


def field_of(along: str, family: int, light: Light) -> TangentField:
    """What strokes follow, family 0, or what crosses them, 1, by the word for it; light: of isophotes."""
    if along != ISOPHOTES:
        return FIELDS[along][family]
    isophotes = IsophoteDirections(light.position, light.parallel)
    return TurnedField(isophotes, 0.5 * np.pi) if family else isophotes


def flowing_lines(
    item: Item,
    along: str,
    field: TangentField,
    spacing_mm: float,
    tolerance_mm: float,
    placement: Placement,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> FlowingLines:
    """The lines of a field on an item, so close that they do for the darkest places; along: the word for it.

    Warnings: where a mesh has no such lines. Errors: InputError, with the item's name, as of evenly_spaced_curves.
    """
    shape = item.shape
    bent = BentFaces(shape, crease_angle_deg) if isinstance(shape, Mesh) else None
    try:
        if bent is not None:
            if isinstance(field, PrincipalDirections):
                # Faces that are not plane in their parts, in whose planes strokes lie.
                bent = replace(bent, mesh=mesh_sides(bent.mesh).mesh)
                item, field = replace(item, shape=bent.mesh), CombedCurvature(bent, field.family)
                bent = _seen_of(bent, placement)
            points, area = bent.mesh.vertices, _area_of_mesh(bent, field)
            whole = float(np.ptp(bent.mesh.bounds, axis=0).max())
        else:
            assert is_parametrised(shape)
            (points, area), whole = _all_over(shape, field), extent(shape)[0]
        largest = _largest(points, placement)
        apart = max(spacing_mm / largest, whole / (FEWER * MOST_LINES_of_streamlines))
        curves: SurfaceCurves | MeshCurves
        if bent is not None:
            curves = evenly_spaced_on_faces(bent, field, apart, LONGEST * whole)
        else:
            assert is_parametrised(shape)
            curves = evenly_spaced_curves(shape, field, apart, tracing=Tracing(tolerance=tolerance_mm / largest))
    except InputError as error:
        raise InputError(f"{item.name}: hatching along {along}: {error.cause}") from None
    if bent is not None and not len(curves):
        warn_of_no_lines(item.name, field, crease_angle_deg)
    return _sampled(item, curves, area, apart, placement)


def _seen_of(bent: BentFaces, placement: Placement) -> BentFaces:
    """What can be seen of a mesh: of one that closes, from outside the box of it, the faces that face the eye."""
    mesh, eye = bent.mesh, placement.projection.world_eye
    low, high = mesh.bounds
    if not mesh.is_closed or (eye[3] > 0.0 and ((eye[:3] >= low) & (eye[:3] <= high)).all()):
        return bent
    rays = eye[:3] - eye[3] * mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    front = dot(mesh.face_normals, rays) * signed_volumes(mesh).sum() > 0.0
    present = front if mesh.present is None else front & mesh.present
    return replace(bent, mesh=Mesh(mesh.vertices, mesh.corners, mesh.offsets, present))


def _area_of_mesh(bent: BentFaces, field: TangentField) -> float:
    """How large a mesh is where a field has directions."""
    mesh = bent.mesh
    faces = face_triangles(mesh)
    corners = faces.mesh.vertices[faces.triangles]
    doubled = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    sites = FaceSites(corners.mean(axis=1), unit(mesh.face_normals)[faces.face], bent, faces.face)
    known = np.isfinite(field.tangents(sites)[0]).all(axis=1)
    return float(0.5 * doubled[known].sum())


def _all_over(surface: Surface, field: TangentField) -> tuple[Floats, float]:
    """(n,3) points all over a surface, and how large it is where a field has directions."""
    u, v = surface.domain.grid(ROUGH, ROUGH)
    middles = np.meshgrid(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij")
    sites = Sites(surface, *(each.ravel() for each in middles))
    known = np.isfinite(field.tangents(sites)[0]).all(axis=1)
    one, two, _ = sites.planes
    cells = np.nan_to_num(norm(cross(one, two))) * known
    size = float(cells.sum() * (u[1] - u[0]) * (v[1] - v[0]))
    return sites.points[np.isfinite(sites.points).all(axis=1)], size


def _largest(points: Floats, placement: Placement) -> float:
    """How many mm a unit of the world is on the page, where it is largest on nearly all of a shape."""
    ways = np.stack([on_page(points, axis, placement.page_from_world) for axis in np.eye(3)], axis=-1)
    size = np.linalg.norm(ways, ord=2, axis=(-2, -1))
    size = size[np.isfinite(size)]
    return float(np.quantile(size, NEARLY_ALL)) if len(size) else 1.0


def _sampled(
    item: Item, curves: SurfaceCurves | MeshCurves, area: float, apart: float, placement: Placement
) -> FlowingLines:
    """Curves with samples so close that the one next to a point of a curve is on that curve."""
    rounds = closed_round(curves)
    points, offsets = curves.points[rounds.index], rounds.offsets
    steps = norm(np.diff(points, axis=0, append=points[:1])) if len(points) else np.zeros(0)
    steps[offsets[1:] - 1] = 0.0
    count = np.maximum(np.ceil(SAMPLES * steps / apart), 1.0).astype(np.intp)
    count[offsets[1:] - 1] = 0
    at, share = ragged.owner(count), ragged.place(count) / count[ragged.owner(count)]
    way = points[at + 1] - points[at]
    samples = points[at] + share[:, None] * way
    line = ragged.owner(np.diff(offsets))[at]
    normals = _normals(item, curves, at)
    with np.errstate(invalid="ignore", divide="ignore"):
        aside = cross(normals, way / norm(way)[:, None])
        along, across = (on_page(samples, each, placement.page_from_world) for each in (way, aside))
        wide = apart * np.abs(cross(along, across)) / np.linalg.norm(along, axis=1)
    wide = np.nan_to_num(wide, nan=0.0, posinf=0.0)
    where = np.concatenate([samples, SIDES * apart * np.nan_to_num(normals)], axis=1)
    return FlowingLines(curves, samples, line, wide, place_ranks(where, line, steps[at] / count[at], apart, area))


def _normals(item: Item, curves: SurfaceCurves | MeshCurves, at: Ints) -> Floats:
    """(s,3) unit normals at points of curves that are led round, by their numbers (s,)."""
    rounds = closed_round(curves)
    index = rounds.index
    if isinstance(curves, MeshCurves):
        assert isinstance(item.shape, Mesh)
        normals = item.shape.face_normals[np.maximum(curves.faces[index[at]], 0)]
        return normals / norm(normals)[:, None]
    assert is_parametrised(item.shape)
    places = np.stack([curves.u[index[at]], curves.v[index[at]]], axis=1)
    return Sites(item.shape, *charts(item.shape).inside(places)).normals


def on_page(points: Floats, ways: Floats, page_from_world: Floats) -> Floats:
    """(...,2) by how many mm points of the page move where points (...,3) move along ways (...,3)."""
    rows = matmul(points, page_from_world[:, :3].T) + page_from_world[:, 3]
    step = matmul(ways, page_from_world[:, :3].T)
    depth = rows[..., 3:]
    return np.asarray(step[..., :2] / depth - rows[..., :2] * step[..., 3:] / (depth * depth))


# Lines of items to hatch along, so dense that they do for the darkest places: parameter lines, and lines that flow.

ROUGH_LINES = 96
"""Samples along each parameter, to find how far parameter lines are apart on the page."""

FEWEST, MOST_LINES = 16, 2048
"""Parameter lines of one family: the most are 0.1 mm apart on a sheet of A4."""

MOST_SAMPLES = 1 << 20
"""Of one surface, where the distance of neighbouring lines is known."""

LONGEST = 1.0
"""Curves on meshes are no longer, in extents of the mesh, to either side of where they begin: those that wind round it
again and again would take all the time and room."""

SHORTEST = 3.0
"""Times their distance that strokes are long which flow, at least: shorter ones are specks."""


def followed(item: Item, hatching: Hatching | Stippling | None) -> bool:
    """Whether an item is hatched along lines of its own."""
    if not isinstance(hatching, Hatching) or hatching.by == "none" or hatching.along == "page":
        return False
    return is_parametrised(item.shape) if hatching.along == "surface" else flows(item, hatching.along)


def followed_lines(
    scene: Scene,
    how: Sequence[Hatching | Stippling | None],
    view: View,
    placement: Placement,
    trace: Callable[[Scene], Paths],
    tolerance_mm: float,
    crease_angle_deg: float,
) -> list[FollowedLines]:
    """The visible lines to hatch along of each item that has such, and of each family where they cross.

    how: of every item; view: of the scene; trace: the visible lines of a scene in their places, as in draw;
    tolerance_mm, crease_angle_deg: as in draw.
    """
    found: list[FollowedLines] = []
    for family in (0, 1):
        spaced: dict[int, SpacedLines] = {}
        items = []
        for number, (item, one) in enumerate(zip(scene.items, how, strict=True)):
            lines: tuple[str, ...] = ()
            if isinstance(one, Hatching) and followed(item, one) and (family == 0 or one.cross):
                light = curve_light(scene, view, item)
                spaced[number] = _spaced(item, one, family, light, placement, tolerance_mm, crease_angle_deg)
                item = replace(item, curves=spaced[number].asked)
                lines = ("parameter", "integral")
            items.append(replace(item, lines=lines, patterns=()))
        if spaced:
            paths = trace(replace(scene, items=tuple(items)))
            found += [
                FollowedLines(
                    family,
                    number,
                    paths,
                    own.samples,
                    own.apart,
                    own.line,
                    own.ranks,
                    flat_ends(scene, number),
                    own.shortest_mm,
                )
                for number, own in spaced.items()
            ]
    return found


@dataclass(frozen=True, eq=False)
class SpacedLines:
    """Lines to hatch along, as an item asks for them; samples (s,3) on them, apart, line and ranks (s,) as of
    FollowedLines."""

    asked: SurfaceLines
    samples: Floats
    apart: Floats
    line: Ints
    ranks: Floats
    shortest_mm: float


def _spaced(
    item: Item,
    hatching: Hatching,
    family: int,
    light: Light,
    placement: Placement,
    tolerance_mm: float,
    crease_angle_deg: float,
) -> SpacedLines:
    """The lines of a family on an item, so close that they do for the darkest places; light: that of isophotes."""
    if hatching.along != "surface":
        field = field_of(hatching.along, family, light)
        flow = flowing_lines(
            item, hatching.along, field, hatching.spacing_mm, tolerance_mm, placement, crease_angle_deg
        )
        asked = SurfaceLines(integral=(KnownCurves(flow.curves),))
        return SpacedLines(asked, flow.samples, flow.apart, flow.line, flow.ranks, SHORTEST * hatching.spacing_mm)
    assert is_parametrised(item.shape)
    count = _count(item.shape, family, hatching.spacing_mm, placement)
    samples, apart = _samples(item.shape, family, count, placement)
    asked = SurfaceLines(columns=count) if family == 0 else SurfaceLines(rows=count)
    return SpacedLines(asked, samples, apart, *_numbered(count, len(samples)), LEAST_MM)


def _numbered(count: int, samples: int) -> tuple[Ints, Floats]:
    """(s,) the line of each sample, and its rank (s,), of count + 1 lines; the last is the first where they close."""
    line = np.repeat(np.arange(count + 1), samples // (count + 1))
    return line, ranks(line % count, count)


def flat_ends(scene: Scene, item: int) -> Floats:
    """(3,) the unit normal of the flat ends of an item that is a capped body, zero of what is none."""
    body = capped_quadric_of(scene.items[item].shape)
    return np.zeros(3) if body is None else normalize(cross(body.frame[0], body.frame[1]))


def _count(surface: Surface, family: int, spacing_mm: float, placement: Placement) -> int:
    """How many parts lines of a family have to divide a surface into, to be no farther apart than a spacing."""
    _, apart = _samples(surface, family, ROUGH_LINES, placement)
    known = apart[np.isfinite(apart)]
    widest = float(np.quantile(known, NEARLY_ALL)) if len(known) else 0.0
    return int(np.clip(np.ceil(ROUGH_LINES * widest / spacing_mm), FEWEST, MOST_LINES))


def _samples(surface: Surface, family: int, count: int, placement: Placement) -> tuple[Floats, Floats]:
    """(s,3) points on lines of a family that divide a surface into so many parts, and (s,) how far on the page their
    neighbours are; (s,) is line after line, count + 1 of them."""
    across = min(max(count, ROUGH_LINES), MOST_SAMPLES // count)
    sizes = (count, across) if family == 0 else (across, count)
    u, v = np.meshgrid(*surface.domain.grid(*sizes), indexing="ij")
    if family == 1:
        u, v = u.T, v.T
    points = surface.points(u, v)
    ways = surface.partials(u, v)
    step = surface.domain.size[family] / count
    to, along = (on_page(points, ways[k], placement.page_from_world) for k in (family, 1 - family))
    length = np.linalg.norm(along, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        apart = step * np.abs(cross(to, along)) / length
    return points.reshape(-1, 3), np.nan_to_num(apart, nan=0.0, posinf=0.0).ravel()
