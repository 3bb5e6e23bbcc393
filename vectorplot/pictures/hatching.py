"""Faces of a scene hatched: strokes are lines on its faces, as far as they are seen and it is dark enough for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching import (
    LEAST_MM,
    LUMINANCE,
    FollowedLines,
    PageFrame,
    PlaneFrame,
    crossings,
    dark_parts,
    even_spacings,
    hatched_regions,
    plane_frame,
    thresholds,
    toned_regions,
)
from vectorplot.drawing.strokes import concatenated
from vectorplot.effects.shadow_casters import FacePlanes, light_system, light_views
from vectorplot.features.edge_splitting import Allowed, Criterion
from vectorplot.features.nearest import feet_on_triangles
from vectorplot.geometry import intervals, ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.budget import Budget, unheard, workers
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.geometry.records import joined as joined_records
from vectorplot.geometry.vectors import cross, norm
from vectorplot.pictures.fills import (
    coloured,
    fineness,
    finer,
    ordered_faces,
    seen_on_page,
    with_clear_items,
)
from vectorplot.pictures.followed_lines import flat_ends, followed, followed_lines
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_paint
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement, allowed_in_space
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of, without_coincident
from vectorplot.shading.depth_buffers import coplanar_faces
from vectorplot.shading.facet_resolution import FacetedScene, faceted, picture_fineness
from vectorplot.shading.illumination import AMBIENT, shade_numbers, shadow_shades
from vectorplot.shading.painted_colours import Lighting, corner_shades_of, opacities, painted_normals, smooth_faces
from vectorplot.shading.palettes import palette
from vectorplot.shading.shaded_faces import (
    exposed_scene,
    face_normals,
    light_colours,
    plane_numbers,
    point_shades,
    shows_inside,
)
from vectorplot.shading.shadow_rays import blocked_exactly
from vectorplot.tolerances import HATCH_GAP_MM, ROUNDING, SAME_PLANE_SINE
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.polyhedra.hidden_lines import SLIVER, Segments, visible_parts
from vectorplot.visibility.polyhedra.lines import inside, near_plane, window_planes
from vectorplot.visibility.polyhedra.occluders import face_occluders, solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, newell, project_faces
from vectorplot.words import LineKind

# How dark places on faces are.

GRAY = "gray"
"""The palette that runs from black to white."""

TONES = 64
"""So many shades flat faces have: neighbours that differ by less share their strokes."""


@dataclass(frozen=True, eq=False)
class Tone:
    """How dark the faces of a view look.

    lighting: what they are shaded with; seen (f,): which of them can be seen; crumbs (f,): which are so small that only
    what they look like together counts; turned (l,f): whether the side of a face
    that is seen is turned to each light that casts shadows, so that it may lack it.
    """

    view: View
    lighting: Lighting
    seen: Bools
    crumbs: Bools
    turned: Bools

    @cached_property
    def smooth(self) -> Bools:
        """(f,) faces that have normals of their own at their corners."""
        return smooth_faces(self.view, self.lighting.normals)

    @cached_property
    def lacking(self) -> Ints:
        """(f,) the lights that may be kept from a face, bit k for light k."""
        bits = np.left_shift(1, np.arange(len(self.turned)))[:, None]
        return np.asarray((self.turned * bits).sum(axis=0, dtype=np.intp), dtype=np.intp)

    @cached_property
    def _ramps(self) -> Floats:
        """(6,i) red, green and blue of the darkest shade of each item, and what the brightest one adds to it."""
        ends = np.array([palette(item.colour)[[0, -1]] for item in self.lighting.items], dtype=np.float64)
        return np.concatenate([ends[:, 0], ends[:, 1] - ends[:, 0]], axis=1).T / 255.0

    def shares_at(self, points: Floats, face: Ints) -> Floats:
        """(2l,n) what each light gives to points (3,n) of faces, and what without highlights."""
        found = corner_shades_of(self.view, self.lighting, points, np.arange(len(face) + 1), face)
        return np.concatenate([found.shares, found.matt])

    def shares_of(self, columns: Floats, face: Ints) -> Floats:
        """(2l,n) the same at places of faces: columns (n,k) of outlines, with values of this tone."""
        found = np.ascontiguousarray(columns[:, 6:].T)
        round_ = np.flatnonzero(self.smooth[face])
        if len(round_):
            points, normals = columns[round_, :3].T, columns[round_, 3:6].T
            found[:, round_] = self.shares(points, normals, face[round_])
        return found

    def shares(self, points: Floats, normals: Floats, face: Ints) -> Floats:
        """(2l,n) the same at points (3,n) of faces, with outer normals (3,n) of any length."""
        length = np.sqrt(dot(normals, normals))
        inwards = np.where(self._inside[face], -1.0, 1.0)
        unit = normals * (inwards / np.where(length > 0.0, length, 1.0))
        found = point_shades(
            self.view, self.lighting.items, self.lighting.lights, points.T, unit.T, self.view.shown_item[face]
        )
        return np.concatenate([found.shares, found.matt])

    @cached_property
    def _inside(self) -> Bools:
        return shows_inside(self.view)

    @cached_property
    def values(self) -> Floats:
        """(3+2l,c) at the corners of faces their normals, zero on faces of one shade each, and for crumbs what lights
        give: the mean, by area, of those around the corner."""
        normals = np.where(np.repeat(self.smooth, self.view.face_sizes), self.lighting.normals, 0.0)
        lights, corners = len(self.lighting.lights), self.view.corners
        flat = np.flatnonzero(self.crumbs)
        means = np.zeros((2 * lights, len(corners)))
        if len(flat):
            given, (area, _, _) = self.shares_at(np.zeros((3, len(flat))), flat), newell(self.view, flat)
            sizes = self.view.face_sizes[flat]
            weight = np.repeat(np.sqrt(dot(area, area)), sizes)
            at = ragged.ranges(self.view.offsets[flat], sizes)
            count = self.view.points.shape[1]
            total = np.bincount(corners[at], weight, count)
            for row, shares in zip(means, np.repeat(given, sizes, axis=1), strict=True):
                row[at] = (np.bincount(corners[at], weight * shares, count) / np.where(total > 0.0, total, 1.0))[
                    corners[at]
                ]
        return np.concatenate([normals, means])

    def darkness(self, shares: Floats, lacking: Ints, face: Ints) -> Floats:
        """(n,) how dark faces are with what lights give (2l,n), less what they lack (n,): black is 1, white 0."""
        given, matt = np.split(shares, 2)
        bit = np.arange(len(given))[:, None]
        given = np.where((lacking >> bit) & 1 == 1, matt, given)
        shade = np.atleast_2d(shadow_shades(given, self._intensity, lacking, AMBIENT))
        flat = ~(self.smooth | self.crumbs)[face]
        shade[:, flat] = shade_numbers(shade[:, flat], TONES) / (TONES - 1.0)
        item = self.view.shown_item[face]
        ramp = self._ramps[:, item]
        bright = np.zeros(len(face))
        for k, share in enumerate(LUMINANCE.tolist()):
            bright += share * (ramp[k] + ramp[3 + k] * shade[min(k, len(shade) - 1)])
        return np.asarray(np.clip((1.0 - bright) * opacities(self.lighting.items)[item], 0.0, 1.0))

    @cached_property
    def _intensity(self) -> Floats:
        return light_colours(self.lighting.lights)


# Lines on faces: where planes through the eye, or through the direction of strokes, meet them.

STEP_MM = 0.4
"""Pieces of lines on smooth faces are no longer: so far darkness is taken for linear."""


@dataclass(frozen=True, eq=False)
class FaceOutlines:
    """Faces (n,) of a view as polygons before the eye and inside the picture: columns (c,k), of each corner its place
    in the view, and what else is linear on the face; offsets (n+1,)."""

    face: Ints
    columns: Floats
    offsets: Ints

    def __len__(self) -> int:
        return len(self.face)

    @property
    def points(self) -> Floats:
        """(3,c) the corners in the view."""
        return np.ascontiguousarray(self.columns[:, :3].T)


def face_outlines(view: View, placement: Placement, face: Ints, values: Floats) -> FaceOutlines:
    """The outlines of faces (n,); values (k,c): at the corners of all faces of the view."""
    position, offsets = ragged.take(view.offsets, face)
    polygons = Polygons(np.concatenate([view.points[:, view.corners[position]], values[:, position]]).T, offsets)
    planes = near_plane(view)
    if len(planes) and not (view.depth < view.near).any():
        planes = planes[:0]
    if not placement.whole:
        planes = np.concatenate([planes, window_planes(view, *placement.window)])
    for a, b, c, d in planes:
        x, y, z = polygons.points[:, :3].T
        polygons, _ = cut_polygons(polygons, a * x + b * y + c * z - d)
    full = np.flatnonzero(np.diff(polygons.offsets))
    return FaceOutlines(face[full], polygons.points, np.append(polygons.offsets[full], len(polygons.points)))


@dataclass(frozen=True, eq=False)
class Pieces(Elements):
    """Straight pieces (n,) of lines on faces.

    start, end (3,n): in the view; depths (2,n): how far these are from the eye, where lines are straight on the page,
    or 1; begin, stop: where along its line each begins and ends, in mm; face; line: its number; family: of which lines
    that number is; spacing: how far these are apart, in mm; threshold: what has to be darker is drawn; lacking: the
    lights that a place has to lack, -1 whatever it lacks; window: darkness is its mean over so many mm; pen: its width
    in mm; shares (2l,n) and shares_end: what lights give to the ends, as in Tone.
    """

    start: Floats = field(metadata=IN_COLUMNS)
    end: Floats = field(metadata=IN_COLUMNS)
    depths: Floats = field(metadata=IN_COLUMNS)
    begin: Floats
    stop: Floats
    face: Ints
    line: Ints
    family: Ints
    spacing: Floats
    threshold: Floats
    lacking: Ints
    window: Floats
    pen: Floats
    shares: Floats = field(metadata=IN_COLUMNS)
    shares_end: Floats = field(metadata=IN_COLUMNS)

    def __len__(self) -> int:
        return len(self.face)

    def cut(self, which: Ints, low: Floats, high: Floats) -> Pieces:
        """Parts of pieces (k,) from low to high (k,), 0 to 1."""
        some = self.take(which)
        way, rise, deeper = some.end - some.start, some.shares_end - some.shares, some.depths[1] - some.depths[0]
        near, far = some.depths[0] + low * deeper, some.depths[0] + high * deeper
        length = some.stop - some.begin
        with np.errstate(invalid="ignore", divide="ignore"):
            first, last = low * some.depths[1] / near, high * some.depths[1] / far
        return replace(
            some,
            start=some.start + low * way,
            end=np.where(high < 1.0, some.start + high * way, some.end),
            depths=np.stack([near, far]),
            begin=some.begin + first * length,
            stop=np.where(high < 1.0, some.begin + last * length, some.stop),
            shares=some.shares + low * rise,
            shares_end=some.shares + high * rise,
        )

    def parameter(self, place: Floats) -> Floats:
        """(n,) which part of each piece lies before a place (n,) on its line."""
        part = np.clip((place - self.begin) / np.where(self.stop > self.begin, self.stop - self.begin, 1.0), 0.0, 1.0)
        return np.asarray(part * self.depths[0] / (part * self.depths[0] + (1.0 - part) * self.depths[1]))


@dataclass(frozen=True, eq=False)
class Scan:
    """How lines are laid on outlines: u, v, weight (c,) of the corners of these, along the lines, across them in mm,
    and by how much a place counts between two others on the page."""

    u: Floats
    v: Floats
    weight: Floats


def _page_scan(view: View, placement: Placement, outlines: FaceOutlines, angle: float) -> Scan:
    """Lines at an angle on the page."""
    points = outlines.points
    u, v = PageFrame(angle).places(placement.on_page(view.image_of(points)).T)
    return Scan(u, v, np.ones(len(u)) if view.eye is None else 1.0 / view.depth_of(points))


@dataclass(frozen=True, eq=False)
class Laid:
    """Pieces (n,) of lines on outlines: the columns (n,k) of their ends, depths (2,n), begin and stop (n,) as of
    Pieces, row (n,): which of the rows that were asked for, line (n,)."""

    first: Floats
    last: Floats
    depths: Floats
    begin: Floats
    stop: Floats
    row: Ints
    line: Ints


def _laid(outlines: FaceOutlines, scan: Scan, which: Ints, spacing: Floats, finest: Floats) -> Laid:
    """Lines on outlines which (r,), so far apart (r,) each, in pieces that are no longer than finest (r,)."""
    corner, offsets = ragged.take(outlines.offsets, which)
    row = np.arange(len(which))
    met = crossings(scan.u[corner], scan.v[corner], offsets, row, spacing)
    before, after = corner[met.side], corner[ragged.following(offsets)[met.side]]
    near, far = (1.0 - met.share) * scan.weight[before], met.share * scan.weight[after]
    columns = _between(outlines.columns[before], outlines.columns[after], far / (near + far))
    depth = 1.0 / (near + far)
    begin, stop = met.along[0::2], met.along[1::2]
    row = np.repeat(row, np.diff(offsets))[met.side[0::2]]
    count = np.where(stop > begin, np.maximum(np.ceil((stop - begin) / finest[row]), 1.0), 0.0).astype(np.intp)
    of, place = ragged.owner(count), ragged.place(count)
    first, last, near, far = columns[0::2][of], columns[1::2][of], depth[0::2][of], depth[1::2][of]
    ends = []
    for step in (place, place + 1):
        at = step / count[of]
        part = np.where(step < count[of], at * near / (at * near + (1.0 - at) * far), 1.0)
        along = np.where(step < count[of], begin[of] + at * (stop - begin)[of], stop[of])
        ends.append((_between(first, last, part), near + part * (far - near), along))
    (first, near, low), (last, far, high) = ends
    return Laid(first, last, np.stack([near, far]), low, high, row[of], met.line[0::2][of])


def _between(one: Floats, other: Floats, part: Floats) -> Floats:
    """(n,k) what is between rows (n,k), at parts (n,) of the way; exactly the other ones at 1."""
    part = part[:, None]
    return np.where(part < 1.0, one + part * (other - one), other)


# The lines that may be drawn: of plain faces those of each shade that they can have, of others all.

CRUMB = 16.0
"""Smaller planes, in squares of the distance between lines, say nothing one by one where there are many of them: their
strokes would be shorter than three distances."""

MANY_CRUMBS = 64
"""So many small planes make the surface of an item rough; fewer are faces of something small."""

WHATEVER = -1
"""What pieces lack that are drawn whatever lights they lack, as long as it is dark enough."""


@dataclass(frozen=True, eq=False)
class HatchedScene:
    """A scene whose faces are hatched, surfaces as triangles: its view, its faces in the image, which of them can be
    seen (f,), the numbers of those that are hatched, and where the picture is; tone: how dark they are, None where that
    does not matter."""

    view: View
    projected: ProjectedFaces
    seen: Bools
    face: Ints
    placement: Placement
    tone: Tone | None

    @property
    def share_rows(self) -> int:
        """How many numbers say what lights give to a place."""
        return 0 if self.tone is None else 2 * len(self.tone.lighting.lights)

    def lines(self, hatching: Hatching, mine: Bools, first: int) -> list[Pieces]:
        """The lines that hatch items (i,) in one way; first: from which number on families of lines have none yet."""
        face = self.face[mine[self.view.face_item[self.face]]]
        tone = None if hatching.by == "even" else self.tone
        none = np.zeros((0, len(self.view.corners)))
        outlines = face_outlines(self.view, self.placement, face, none if tone is None else tone.values)
        found: list[Pieces] = []
        for family in (0, 1) if hatching.cross else (0,):
            page = _page_scan(self.view, self.placement, outlines, angle_of(hatching, family))
            plain = np.ones(len(outlines), dtype=np.bool_)
            if tone is not None:
                plain = ~(tone.smooth | tone.crumbs)[outlines.face]
            parts = [self._plain_lines(tone, outlines, page, np.flatnonzero(plain), hatching, family)]
            if tone is not None:
                parts.append(self._varied_lines(tone, outlines, page, np.flatnonzero(~plain), hatching, family))
            for part in parts:
                found.append(replace(part, family=first + part.family))
                first += int(part.family.max(initial=-1)) + 1
        return found

    def _plain_lines(
        self,
        tone: Tone | None,
        outlines: FaceOutlines,
        page: Scan,
        which: Ints,
        hatching: Hatching,
        family: int,
    ) -> Pieces:
        """Lines evenly apart on outlines which (n,), for each of the shades that they can have."""
        lacking, dark = np.full(len(which), WHATEVER), np.ones(len(which))
        if tone is not None:
            which, lacking, dark = _shades_of_plain(tone, outlines, which)
        spacing = even_spacings(hatching, dark)[family]
        kept = np.isfinite(spacing)
        which, lacking, spacing = which[kept], lacking[kept], spacing[kept]
        sheet, scan = np.zeros(len(outlines), dtype=np.intp), page
        if hatching.along == "surface" and len(which):
            frame = self._plane_frame(outlines, angle_of(hatching, family))
            sheet, scan = frame.plane, Scan(*frame.places, np.ones(len(page.weight)))
        laid = _laid(outlines, scan, which, spacing, np.full(len(which), np.inf))
        group = np.unique(spacing, return_inverse=True)[1].ravel() * (int(sheet.max(initial=0)) + 1) + sheet[which]
        none = np.zeros((self.share_rows, len(laid.row)))
        zero = none.sum(axis=0)
        rest = spacing[laid.row], zero - 1.0, lacking[laid.row], zero, zero + hatching.width_mm
        return _pieces(outlines, laid, which, group[laid.row], *rest, none, none)

    def _varied_lines(
        self, tone: Tone, outlines: FaceOutlines, page: Scan, which: Ints, hatching: Hatching, family: int
    ) -> Pieces:
        """Lines on outlines which (n,), each with the darkness from which on it is drawn."""
        every = np.ones(len(which))
        laid = _laid(outlines, page, which, hatching.spacing_mm * every, STEP_MM * every)
        face = outlines.face[which][laid.row]
        ends = [tone.shares_of(columns, face) for columns in (laid.first, laid.last)]
        least = thresholds(hatching, family, laid.line)
        one, zero = np.ones(len(face), dtype=np.intp), np.zeros(len(face))
        window = np.where(tone.crumbs[face], WINDOW * hatching.spacing_mm, 0.0)
        rest = zero + hatching.spacing_mm, least, WHATEVER * one, window, zero + hatching.width_mm
        return _pieces(outlines, laid, which, 0 * one, *rest, *ends)

    def _plane_frame(self, outlines: FaceOutlines, angle: float) -> PlaneFrame:
        """Lines in the planes of outlines."""
        view, of = self.view, ragged.owner(np.diff(outlines.offsets))
        normal = matmul(face_normals(view)[:, outlines.face].T, view.axes)
        corners = view.world_of(outlines.points)
        place = corners[outlines.offsets[:-1]]
        item, world = view.face_item[outlines.face], self.placement.page_from_world
        return plane_frame(corners, of, normal, place, item, angle, world)


def _areas(places: Floats, offsets: Ints) -> Floats:
    """(n,) the areas of polygons, corners (c,2)."""
    if len(offsets) == 1:
        return np.zeros(0)
    x, y = places.T
    after = ragged.following(offsets)
    return np.asarray(0.5 * np.abs(np.add.reduceat(x * y[after] - x[after] * y, offsets[:-1])))


def _rough(view: View, normals: Floats) -> Bools:
    """(f,) the faces at all corners of which the normals (3,c) of the faces that meet there differ: a rough surface, on
    which single faces say nothing."""
    count = view.points.shape[1]
    low, high = np.full((3, count), np.inf), np.full((3, count), -np.inf)
    known = np.isfinite(normals).all(axis=0)
    for least, most, row in zip(low, high, normals, strict=True):
        np.minimum.at(least, view.corners[known], row[known])
        np.maximum.at(most, view.corners[known], row[known])
    sharp = (high - low).max(axis=0) > ROUNDING
    # Faces of one shade each have none, and differ.
    sharp[view.corners[~known]] = True
    return np.asarray(np.logical_and.reduceat(sharp[view.corners], view.offsets[:-1]), dtype=np.bool_)


def angle_of(hatching: Hatching, family: int) -> float:
    """The angle of the lines of a family, in radians."""
    return float(np.radians(hatching.angle_deg)) + family * np.pi / 2.0


def _shades_of_plain(tone: Tone, outlines: FaceOutlines, which: Ints) -> tuple[Ints, Ints, Floats]:
    """Faces of one shade each, once for each set of lights that they may lack: which, what they lack, and how dark they
    are then."""
    face = outlines.face[which]
    given = tone.shares_at(np.zeros((3, len(face))), face)
    may = tone.lacking[face]
    found = []
    for bits in range(1 << len(tone.turned)):
        some = np.flatnonzero(bits & ~may == 0)
        missing = np.full(len(some), bits, dtype=np.intp)
        found.append((which[some], missing, tone.darkness(given[:, some], missing, face[some])))
    outline, lacking, dark = (np.concatenate(column) for column in zip(*found, strict=True))
    return outline, lacking, dark


def _pieces(outlines: FaceOutlines, laid: Laid, which: Ints, family: Ints, *rest: Any) -> Pieces:
    """Pieces of lines that were laid on outlines which (r,); rest: what else is said of them, from spacing on."""
    ends = np.ascontiguousarray(laid.first[:, :3].T), np.ascontiguousarray(laid.last[:, :3].T)
    face = outlines.face[which][laid.row]
    return Pieces(*ends, laid.depths, laid.begin, laid.stop, face, laid.line, family, *rest)


# Which parts of lines are drawn: those that are dark enough, seen, and lack the lights that they have to.

WINDOW = 3.0
"""Over so many distances of lines the darkness of small faces that have one shade each is averaged: nobody could see
them one by one."""


def _dark_at_most(tone: Tone, pieces: Pieces) -> Pieces:
    """The parts of pieces that are dark enough where all lights that may lack do."""
    lacking = tone.lacking[pieces.face]
    dark = [tone.darkness(shares, lacking, pieces.face) for shares in (pieces.shares, pieces.shares_end)]
    which, low, high = _above(*(np.where(pieces.window > 0.0, 1.0, one - pieces.threshold) for one in dark))
    return pieces.cut(which, low, high)


def _above(here: Floats, there: Floats) -> tuple[Ints, Floats, Floats]:
    """Where what is linear from here to there (n,) is positive: which, and the parameters between which it is."""
    with np.errstate(divide="ignore", invalid="ignore"):
        zero = np.clip(here / (here - there), 0.0, 1.0)
    low, high = np.where(here > 0.0, 0.0, zero), np.where(there > 0.0, 1.0, zero)
    kept = np.flatnonzero(((here > 0.0) | (there > 0.0)) & (high > low))
    return kept, low[kept], high[kept]


def _on_top(scene: HatchedScene, pieces: Pieces) -> Pieces:
    """The parts of pieces on which no face of another item lies in the same plane, as painters have it: the smaller one
    is seen."""
    view = scene.view
    if len(view.occludes) < 2:
        return pieces
    coplanar = coplanar_faces(view)
    plane, item = coplanar.plane, view.face_item
    shared = np.flatnonzero(scene.seen & (plane >= 0))
    order = shared[np.lexsort((item[shared], plane[shared]))]
    mixed = np.unique(plane[order[1:]][(np.diff(plane[order]) == 0) & (np.diff(item[order]) != 0)])
    cover = shared[np.isin(plane[shared], mixed) & view.occludes[item[shared]]]
    which = np.flatnonzero(np.isin(plane[pieces.face], mixed))
    if not len(cover) or not len(which):
        return pieces
    # Boxes in the image, and each plane at a height of its own.
    one, two = (
        np.concatenate([view.image_of(ends[:, which]), plane[pieces.face[which]][None]])
        for ends in (pieces.start, pieces.end)
    )
    low, high = (np.concatenate([scene.projected.box[k::2, cover], plane[cover][None]]) for k in (0, 1))
    piece, face = overlapping_boxes(np.minimum(one, two), np.maximum(one, two), low, high)
    piece, face = which[piece], cover[face]
    below = pieces.face[piece]
    above = (item[below] != item[face]) & (coplanar.rank[below] < coplanar.rank[face])
    piece, face = piece[above], face[above]
    names, number = np.unique(face, return_inverse=True)
    outline = face_occluders(view, scene.projected, names)
    count = np.diff(outline.offsets)[number.ravel()]
    pair, side = ragged.owner(count), ragged.ranges(outline.offsets[number.ravel()], count)
    side, pair = (each[ragged.place(count) >= 1] for each in (side, pair))
    normal = outline.planes[:, side]
    here, there = (dot(normal[:3], ends[:, piece[pair]]) - normal[3] for ends in (pieces.start, pieces.end))
    low, high = np.zeros(len(piece)), np.ones(len(piece))
    with np.errstate(invalid="ignore", divide="ignore"):
        cut = here / (here - there)
    np.maximum.at(low, pair, np.where((here < 0.0) & (there > here), cut, 0.0))
    np.minimum.at(high, pair, np.where((there < 0.0) & (here > there), cut, 1.0))
    outside = np.bincount(pair, np.maximum(here, there) <= view.tolerance, len(piece)) > 0
    covered = np.flatnonzero(~outside & (low < high))
    gap = np.zeros(len(pieces))
    of, low, high = intervals.union(piece[covered], low[covered], high[covered], gap)
    return pieces.cut(*intervals.complement(len(pieces), of, low, high, gap))


@dataclass(frozen=True, eq=False)
class Runs:
    """Pieces that are seen, run after run: parts of a line of one item and family without gaps.

    run (n,): of each piece, ascending; behind (2,r): whether something in front ends a run where it begins, and where
    it stops.
    """

    pieces: Pieces
    run: Ints
    behind: Bools

    @cached_property
    def limits(self) -> Floats:
        """(2,r) where runs begin and stop."""
        first = np.flatnonzero(np.diff(self.run, prepend=-1))
        stop = np.maximum.reduceat(self.pieces.stop, first) if len(first) else self.pieces.stop
        return np.stack([self.pieces.begin[first], stop])

    def places(self, run: Ints, along: Floats) -> Floats:
        """(3,k) the points of runs (k,) at places along their lines."""
        order = np.searchsorted(self._key(self.run, self.pieces.begin), self._key(run, along), side="right") - 1
        at = np.clip(order, np.searchsorted(self.run, run), np.searchsorted(self.run, run, side="right") - 1)
        some = self.pieces.take(at)
        part = some.parameter(along)
        return np.where(part < 1.0, some.start + part * (some.end - some.start), some.end)

    def _key(self, run: Ints, along: Floats) -> Floats:
        """(k,) what grows from run to run, and along each."""
        return np.asarray(run * (2.0 * float(np.abs(self.limits).max(initial=0.0)) + 1.0) + along)


def _runs(scene: HatchedScene, pieces: Pieces, behind: Bools) -> Runs:
    """Pieces in runs; behind (2,n): whether something hides what comes before and after each."""
    item = scene.view.face_item[pieces.face]
    order = np.lexsort((pieces.begin, pieces.line, pieces.family, item))
    pieces, rows = pieces.take(order), np.stack([pieces.line, pieces.family, item])[:, order]
    same = (rows[:, 1:] == rows[:, :-1]).all(axis=0)
    new = np.ones(len(order), dtype=np.bool_)
    new[1:] = ~same | (pieces.begin[1:] > _reached(np.cumsum(~np.append(False, same)[: len(order)]), pieces)[:-1])
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(new))[: len(first)] - 1
    ends = np.stack([behind[0, order[first]], behind[1, order[last]]])
    return Runs(pieces, np.cumsum(new) - 1, ends)


def _reached(line: Ints, pieces: Pieces) -> Floats:
    """(n,) how far pieces reach up to each one on its line, by the numbers of lines (n,), ascending."""
    size = 2.0 * float(np.abs(np.stack([pieces.begin, pieces.stop])).max(initial=0.0)) + 1.0
    return np.asarray(np.maximum.accumulate(line * size + pieces.stop) - line * size + HATCH_GAP_MM)


def _drawn(scene: HatchedScene, lights: Sequence[Light], runs: Runs) -> Runs:
    """The parts of pieces that are drawn, as lights reach them or not."""
    if scene.tone is None:
        return runs
    tone, (of, low, high, lacking) = scene.tone, _lacking(scene.tone, lights, runs.pieces)
    cut = runs.pieces.cut(of, low, high)
    plain, same = cut.lacking != WHATEVER, cut.lacking == lacking
    dark = [tone.darkness(shares, lacking, cut.face) - cut.threshold for shares in (cut.shares, cut.shares_end)]
    dark = _averaged(runs.run[of], cut, *dark)
    which, low, high = _above(*(np.where(plain, np.where(same, 1.0, -1.0), one) for one in dark))
    return replace(runs, pieces=cut.cut(which, low, high), run=runs.run[of[which]])


def _averaged(run: Ints, pieces: Pieces, here: Floats, there: Floats) -> list[Floats]:
    """What is linear from here to there (n,) along pieces, run after run, averaged over their windows."""
    soft = np.flatnonzero(pieces.window > 0.0)
    if not len(soft):
        return [here, there]
    length = np.maximum(pieces.stop - pieces.begin, 0.0)
    end, total = np.cumsum(length), np.cumsum(0.5 * (here + there) * length)
    begin = end - length
    first = np.flatnonzero(np.diff(run, prepend=-1))
    last = np.append(first[1:], len(run)) - 1
    number = np.searchsorted(first, soft, side="right") - 1
    lowest, highest = begin[first][number], end[last][number]
    found = []
    for value, place in ((here, begin), (there, end)):
        half = 0.5 * pieces.window[soft]
        low, high = np.maximum(place[soft] - half, lowest), np.minimum(place[soft] + half, highest)
        sums = [np.interp(at, np.append(0.0, end), np.append(0.0, total)) for at in (low, high)]
        value = value.copy()
        value[soft] = np.where(high > low, (sums[1] - sums[0]) / np.where(high > low, high - low, 1.0), value[soft])
        found.append(value)
    return found


def _lacking(tone: Tone, lights: Sequence[Light], pieces: Pieces) -> tuple[Ints, Floats, Floats, Ints]:
    """Parts of pieces, in their order, that lack the same lights all over: of which they are, from where to where, and
    what they lack, as far as it says whether they are drawn."""
    face, none = pieces.face, np.zeros(len(pieces), dtype=np.intp)
    lit = [tone.darkness(shares, none, face) - pieces.threshold for shares in (pieces.shares, pieces.shares_end)]
    asked = (pieces.lacking != WHATEVER) | (pieces.window > 0.0) | (np.minimum(*lit) <= 0.0)
    asked &= (pieces.lacking != WHATEVER) | (pieces.threshold >= 0.0)
    begin, bits = np.arange(len(pieces)), none
    owner, at, step = [begin, begin], [none * 0.0, none + 1.0], [bits, bits]
    for number, light in enumerate(lights):
        which = np.flatnonzero(asked & tone.turned[number, face])
        of, low, high = _shadowed(tone.view, light, pieces.take(which))
        owner += [which[of], which[of]]
        at += [low, high]
        step += [np.full(len(of), 1 << number), np.full(len(of), -(1 << number))]
    of, place = np.concatenate(owner), np.concatenate(at)
    order = np.lexsort((place, of))
    of, place = of[order], place[order]
    missing = np.cumsum(np.concatenate(step)[order])
    part = np.flatnonzero((of[1:] == of[:-1]) & (place[1:] > place[:-1]))
    return of[part], place[part], place[part + 1], missing[part]


def _shadowed(view: View, light: Light, pieces: Pieces) -> tuple[Ints, Floats, Floats]:
    """Where something keeps a light from pieces: which, and the parameters between which it does."""
    gap = np.minimum(SLIVER * view.tolerance / np.maximum(norm((pieces.end - pieces.start).T), view.tolerance), 1.0)
    lit = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for image in light_views(view, light_system(view, light)):
        start, end = matmul(image.turn, pieces.start), matmul(image.turn, pieces.end)
        low, high = inside(image.planes, start, end)
        which = np.flatnonzero(low < high)
        low, size, way = low[which], (high - low)[which], (end - start)[:, which]
        segments = Segments(start[:, which] + low * way, start[:, which] + (low + size) * way)
        faces = project_faces(image.view)
        seen = visible_parts(image.view, faces, solid_items(image.view, faces), segments, unheard)
        of = seen.segment
        lit.append((which[of], low[of] + seen.low * size[of], low[of] + seen.high * size[of]))
    of, low, high = (np.concatenate(column) for column in zip(*lit, strict=True))
    of, low, high = intervals.union(of, low, high, gap)
    return intervals.complement(len(pieces), of, low, high, gap)


# How dark places are that lie on a surface, beside the faces that stand for it.

NEAREST = 4
"""Of so many triangles with the nearest middles the nearest one is that which a place counts as one of."""


def darkness_beside(scene: HatchedScene, lights: Sequence[Light], item: int) -> Callable[[Floats, Floats], Floats]:
    """How dark an item is at places (n,2) of the page and (n,3) in space: as the nearest ones of its faces that can be
    seen."""
    view, tone = scene.view, scene.tone
    fans, of = ragged.fans(view.offsets)
    corners, vertices = view.corners[fans], view.world_of(view.points)
    casts = view.occludes[view.face_item[of]]
    mine = np.flatnonzero((view.face_item[of] == item) & (tone is not None and tone.seen[of]))

    def found(_: Floats, solid: Floats) -> Floats:
        if tone is None or not len(mine):
            return np.zeros(len(solid))
        triangle, feet = _nearest(vertices[corners[mine]], solid)
        triangle = mine[triangle]
        face, lacking = of[triangle], np.zeros(len(solid), dtype=np.intp)
        # Among those that cast shadows.
        own = np.where(casts[triangle], np.cumsum(casts)[triangle] - 1, -1)
        for bit, light in enumerate(lights):
            some = np.flatnonzero(tone.turned[bit, face])
            dark = blocked_exactly(light, feet[some], own[some], vertices, corners[casts])
            lacking[some[dark]] |= 1 << bit
        return tone.darkness(tone.shares_at(view.points_of(feet), face), lacking, face)

    return found


def _nearest(corners: Floats, points: Floats) -> tuple[Ints, Floats]:
    """(n,) which of triangles (t,3,3) is the nearest one to each point (n,3), and (n,3) where in it."""
    from scipy.spatial import cKDTree

    count = min(NEAREST, len(corners))
    near = cKDTree(corners.mean(axis=1)).query(points, count, workers=workers(len(points)))[1].reshape(-1, count)
    place = np.repeat(points, count, axis=0)
    feet = feet_on_triangles(place, corners[near.ravel()])
    best = norm(feet - place).reshape(-1, count).argmin(axis=1) + count * np.arange(len(points))
    return np.asarray(near.ravel()[best], dtype=np.intp), feet[best]


# Pieces that follow each other on a line as strokes.

SHORTEST, TIP = 3.0, 1.0
"""So many distances of lines strokes are long at least that begin and end because it becomes lighter; and those that do
only one of both, as beside outlines."""

CLOSED = 1.0
"""Gaps that are shorter, in distances of lines, and only because it becomes lighter, are closed."""

BEHIND = 3.0
"""Strokes end so many widths of their pen before what is in front of them."""


def _strokes(scene: HatchedScene, seen: Runs, drawn: Runs) -> Paths:
    """The drawn pieces as strokes of two points, those that follow each other in a run as one."""
    pieces, run = drawn.pieces, drawn.run
    new = np.ones(len(run), dtype=np.bool_)
    gap = np.where(pieces.threshold >= 0.0, CLOSED * pieces.spacing, 0.0)[1:]
    new[1:] = (run[1:] != run[:-1]) | (pieces.begin[1:] > _reached(run, pieces)[:-1] + gap)
    first = np.flatnonzero(new)
    low = pieces.begin[first]
    high = np.maximum.reduceat(pieces.stop, first) if len(first) else low
    run, spacing, room = run[first], pieces.spacing[first], BEHIND * pieces.pen[first]
    begin, stop = seen.limits[:, run]
    fading = np.where(low > begin + HATCH_GAP_MM, 1, 0) + np.where(high < stop - HATCH_GAP_MM, 1, 0)
    fading[pieces.threshold[first] < 0.0] = 0
    shortest = np.maximum(np.array([0.0, TIP, SHORTEST])[fading] * spacing, LEAST_MM)
    low = np.maximum(low, begin + np.where(seen.behind[0, run], room, 0.0))
    high = np.minimum(high, stop - np.where(seen.behind[1, run], room, 0.0))
    kept = np.flatnonzero(high - low >= shortest)
    run, low, high, first = run[kept], low[kept], high[kept], first[kept]
    ends = np.stack([seen.places(run, low), seen.places(run, high)], axis=2).reshape(3, -1)
    count, none = len(kept), np.zeros(len(kept), dtype=np.intp)
    kind, open_ = np.full(count, int(LineKind.HATCH)), np.zeros(count, dtype=np.bool_)
    points, item = scene.placement.on_page(scene.view.image_of(ends)), scene.view.face_item[pieces.face[first]]
    return Paths(points, 2 * np.arange(count + 1), open_, kind, item, none, scene.view.world_of(ends))


def strokes_on_faces(
    scene: HatchedScene,
    how: Sequence[Hatching | Stippling | None],
    lights: Sequence[Light],
    progress: Callable[[float], None],
) -> Paths:
    """The strokes in what is seen of the faces of a scene. how: of every item; lights: of the scene, which cast
    shadows."""
    found: list[Pieces] = []
    for one in dict.fromkeys(how):
        if isinstance(one, Hatching) and one.by != "none":
            mine = np.array([other == one for other in how], dtype=np.bool_)
            first = max((int(part.family.max(initial=-1)) + 1 for part in found), default=0)
            found += scene.lines(one, mine, first)
    if not found:
        return Paths.empty()
    pieces = joined_records(found)
    if scene.tone is not None:
        pieces = _dark_at_most(scene.tone, pieces)
    pieces, solid = _on_top(scene, pieces), solid_items(scene.view, scene.projected)
    seen = visible_parts(scene.view, scene.projected, solid, Segments(pieces.start, pieces.end), progress)
    pieces = pieces.cut(seen.segment, seen.low, seen.high)
    runs = _runs(scene, pieces, np.stack([seen.low > 0.0, seen.high < 1.0]))
    return _strokes(scene, runs, _drawn(scene, lights, runs))


# A scene hatched: on its faces, or where these show more than light and shadow, in what is painted.

ROUGHLY = 8.0
"""Shades on round bodies may be off by so many times as much as in paintings: by a hundredth of black."""

SHADE_ERROR = 0.05
"""So much shades may change along a triangle of a surface beside a straight line."""

ENDS = 3.0
"""Strokes may end so many tolerances before outlines, or behind them: usually by less than half the width of a pen."""

MOST_LIGHTS = 6
"""Of so many lights each plain face has a shade for every set that it may lack; where there are more, faces are
painted."""


@dataclass(frozen=True, eq=False)
class HatchedPicture:
    """What is hatched: a scene, the same toned, where its picture is; trace: the visible lines of a scene in their
    places; all else as in paint."""

    scene: Scene
    toned: Scene
    placement: Placement
    trace: Callable[[Scene], Paths]
    crease_angle_deg: float
    tolerance_mm: float
    budget: Budget
    reflections: int
    progress: Callable[[float], None]

    def on_faces(self, how: Sequence[Hatching | Stippling | None]) -> Paths:
        """The strokes that hatch items (i,) as lines on their faces."""
        scene, lights = self._faces_of(how), self.toned.lights
        found = [strokes_on_faces(scene, how, lights, self.progress)]
        for one in self._followed(scene.view, how):
            hatching = how[one.item]
            assert isinstance(hatching, Hatching)
            found.append(dark_parts(one, hatching, darkness_beside(scene, lights, one.item)))
        return concatenated(tuple(found))

    def _faces_of(self, how: Sequence[Hatching | Stippling | None]) -> HatchedScene:
        """The faces that are hatched, those of items that are hatched along lines only where these have flat ends."""
        shown = without_coincident(self.toned)
        facets = FacetedScene.of_meshes(shown)
        if not all(isinstance(item.shape, Mesh) for item in shown.items):
            projection, casts = self.placement.projection, bool(self.toned.lights)
            fine = picture_fineness(shown, projection, casts, self._allowed, ROUGHLY * self.tolerance_mm)
            # Places between corners are shaded with normals of their own.
            facets = faceted(shown, lambda number: replace(fine(number), shade_error=SHADE_ERROR), self.budget)
        facets = replace(facets, scene=with_clear_items(facets.scene))
        view = view_of(facets.scene, self.placement.projection)
        projected = project_faces(view)
        face = drawn_faces(view, projected)
        seen = np.zeros(view.face_count, dtype=np.bool_)
        seen[face] = True
        toning = any(one is not None and one.by not in ("even", "none") for one in how)
        tone = self._tone(how, facets, view, projected, seen) if toning else None
        along = [followed(item, one) for item, one in zip(self.scene.items, how, strict=True)]
        if any(along):
            on_lines = np.array(along, dtype=np.bool_)[view.face_item[face]]
            ends = np.array([flat_ends(self.scene, number) for number in range(len(along))])[view.face_item[face]]
            normal = matmul(face_normals(view)[:, face].T, view.axes)
            flat = ends.any(axis=1) & (norm(cross(normal, ends)) <= SAME_PLANE_SINE)
            face = face[~on_lines | flat]
        return HatchedScene(view, projected, seen, face, self.placement, tone)

    def _tone(
        self,
        how: Sequence[Hatching | Stippling | None],
        facets: FacetedScene,
        view: View,
        projected: ProjectedFaces,
        seen: Bools,
    ) -> Tone:
        """How dark the faces (f,) of a view are, those that can be seen."""
        toned = self.toned
        _, lights = exposed_scene(view, facets.scene)
        plane = plane_numbers(view)
        # Planes have one shade each: no light varies on them.
        normals = painted_normals(view, toned.items, (), facets.normals, plane, self.crease_angle_deg)
        spacing = max(one.spacing_mm for one in how if isinstance(one, Hatching))
        areas = _areas(self.placement.on_page(view.image[:, view.corners]), view.offsets)
        crumbs = np.bincount(plane, areas * seen)[plane] < CRUMB * spacing * spacing
        crumbs &= seen & _rough(view, normals)
        crumbs &= (np.bincount(view.face_item, crumbs, len(how)) >= MANY_CRUMBS)[view.face_item]
        normals[:, np.repeat(crumbs, view.face_sizes)] = np.nan
        lighting = Lighting(toned.items, lights, normals, plane, TONES, ambient=AMBIENT)
        planes, solid = FacePlanes.of(view), opacities(toned.items)[view.shown_item] >= 1.0
        turned = np.zeros((len(toned.lights), view.face_count), dtype=np.bool_)
        for row, light in zip(turned, toned.lights, strict=True):
            if light.intensity != 0.0:
                facing = light_system(view, light).facing(planes, view.tolerance)
                row[:] = solid & (facing * projected.facing > 0)
        return Tone(view, lighting, seen, crumbs, turned)

    @property
    def _allowed(self) -> Allowed:
        page = self.placement.page, self.placement.whole
        return allowed_in_space(self.toned, self.placement.projection, *page, ENDS * self.tolerance_mm)

    def _followed(self, view: View, how: Sequence[Hatching | Stippling | None]) -> list[FollowedLines]:
        about = view, self.placement, self.trace, self.tolerance_mm, self.crease_angle_deg
        return followed_lines(self.scene, how, *about)

    def painted(self, how: Sequence[Hatching | Stippling | None]) -> Paths:
        """The strokes and dots in the visible regions of what is painted of items (i,)."""
        toned, budget, rough = self.toned, self.budget, ROUGHLY * self.tolerance_mm
        shown = without_coincident(toned)
        pipeline = Pipeline(
            plan_paint(toned, "auto", "visible", frozenset(), self.reflections),
            None,
            lambda _, part: self.progress(part),
        )
        page, projection = self.placement.page, self.placement.projection

        def criterion() -> Callable[[int], Criterion]:
            return fineness(pipeline, shown, projection, bool(toned.lights), self._allowed, rough)

        ordered = ordered_faces(pipeline, toned, shown, projection, criterion, budget)
        seen, plane = seen_on_page(pipeline, ordered, self.placement, budget)
        lit, lights = exposed_scene(seen.view, seen.scene)
        seen = replace(seen, scene=lit)
        # Planes have one shade each: no light varies on them.
        normals = painted_normals(seen.view, toned.items, (), ordered.facets.normals, plane, self.crease_angle_deg)
        lighting = Lighting(toned.items, lights, normals, plane, TONES, ambient=AMBIENT)
        seen = finer(seen, lighting, budget, rough)
        fills = coloured(pipeline, seen, lighting, page, 0.0, rough, budget, self.reflections).fills
        regions = pipeline.run("visible fills", toned_regions, fills)
        return hatched_regions(regions, how, self.placement.page_from_world, self._followed(seen.view, how))


NOT_AT_ALL = Hatching("none")


def hatched(
    scene: Scene,
    placement: Placement,
    given: Hatching | Stippling | None,
    trace: Callable[[Scene], Paths],
    *,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: Budget,
    reflections: int = 1,
    progress: Callable[[float], None] = unheard,
) -> Paths:
    """The strokes that hatch the visible faces of a scene, as they come.

    placement: of a picture of the scene; given: how items without a hatching of their own are hatched; trace: the
    visible lines of a scene in their places; crease_angle_deg and tolerance_mm as in paint. What is near is no brighter
    than what is far away, and items that are hatched by tone are gray, and without patterns. Errors and warnings as of
    paint.
    """
    how = [given if item.hatch is None else item.hatch for item in scene.items]
    toned = replace(_toned(scene, how), background=None)
    picture = HatchedPicture(
        scene, toned, placement, trace, crease_angle_deg, tolerance_mm, budget, reflections, progress
    )
    painted = [_shows_more(toned, item, one) for item, one in zip(toned.items, how, strict=True)]
    found = [Paths.empty()]
    for way, those in ((picture.painted, painted), (picture.on_faces, [not more for more in painted])):
        some = [one if mine else NOT_AT_ALL for one, mine in zip(how, those, strict=True)]
        if any(one is not None and one.by != "none" for one in some):
            found.append(way(some))
    return concatenated(tuple(found))


def _toned(scene: Scene, how: Sequence[Hatching | Stippling | None]) -> Scene:
    """The scene, in gray where only the light counts; what hides lines and bends no light hides tones too."""

    def toned(item: Item, one: Hatching | Stippling | None) -> Item:
        look = item.material
        if look.is_clear and look.refraction == 1.0 and item.hides:
            word = "shiny" if look.word == "transparent" else look.word
            item = replace(item, material=replace(look, word=word, opacity=1.0))
        return item if one is not None and one.by == "colour" else replace(item, colour=GRAY, patterns=())

    return replace(scene, items=tuple(toned(item, one) for item, one in zip(scene.items, how, strict=True)))


def _shows_more(scene: Scene, item: Item, hatching: Hatching | Stippling | None) -> bool:
    """Whether an item that is hatched shows more than its own light and shadow, or is stippled: dots need areas."""
    if hatching is None or hatching.by == "none":
        return False
    mirrors = any(other.material.is_mirror and isinstance(other.shape, Mesh) for other in scene.items)
    refracts = any(other.material.refraction != 1.0 and other.material.is_clear for other in scene.items)
    through = bool(scene.lights) and (mirrors or any(other.dims_light for other in scene.items))
    own = item.material.is_mirror or bool(item.patterns) or len(scene.lights) > MOST_LIGHTS
    return isinstance(hatching, Stippling) or refracts or own or through
